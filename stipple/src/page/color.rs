//! Colors of paper and ink.

use std::str::FromStr;

/// An opaque color in encoded sRGB.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Color(pub [u8; 3]);

impl Color {
    pub const BLACK: Self = Self([0; 3]);
    pub const WHITE: Self = Self([255; 3]);

    /// The color as SVG has it, short where that is shorter.
    pub fn svg(self) -> String {
        match self {
            Self::BLACK => "black".to_owned(),
            Self::WHITE => "white".to_owned(),
            Self([red, green, blue]) => format!("#{red:02x}{green:02x}{blue:02x}"),
        }
    }

    pub fn is_gray(self) -> bool {
        let [red, green, blue] = self.0;
        red == green && green == blue
    }
}

impl FromStr for Color {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let color = csscolorparser::parse(text)
            .map_err(|_| "not a color; write a name such as ivory, or #f8f4e8")?;
        let [red, green, blue, alpha] = color.to_rgba8();
        if alpha < 255 {
            return Err(
                "paper is not transparent; leave the option out for no background".to_owned()
            );
        }
        Ok(Self([red, green, blue]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_are_names_or_numbers_and_opaque() {
        assert_eq!("ivory".parse(), Ok(Color([255, 255, 240])));
        assert_eq!("#C33".parse::<Color>().unwrap().svg(), "#cc3333");
        assert_eq!("white".parse::<Color>().unwrap().svg(), "white");
        for bad in ["", "papyrus", "#12", "transparent", "#ffffff80"] {
            assert!(bad.parse::<Color>().is_err(), "{bad}");
        }
    }
}
