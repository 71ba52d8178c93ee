//! What tones of a photograph become dots: options of every subcommand that draws one.

use clap::Args;
use twelvefold_files::failure::Failure;
use twelvefold_files::picture::{Levels, Tone};

/// How dark a photograph counts as.
#[derive(Debug, Args)]
pub(crate) struct ToneOptions {
    /// The gray level, of 255, from which on the photograph counts as white: 250 for paper that was
    /// scanned a little gray.
    ///
    /// Levels are encoded sRGB also with --linear, which takes the light of this level as white.
    #[arg(long, value_name = "LEVEL", value_parser = level)]
    pub(crate) white: Option<f64>,

    /// The gray level, of 255, up to which the photograph counts as black; below that of --white.
    #[arg(long, value_name = "LEVEL", value_parser = level)]
    pub(crate) black: Option<f64>,

    /// Lighten (above 1) or darken the middle: brightness from 0 to 1, after --black and --white, is
    /// raised to 1/GAMMA.
    #[arg(long, value_name = "GAMMA", value_parser = positive)]
    pub(crate) gamma: Option<f64>,

    /// Multiply the light of a float file by 2 to this power, before anything else.
    #[arg(long, value_name = "STOPS", value_parser = stops, allow_hyphen_values = true)]
    pub(crate) exposure: Option<f64>,

    /// Put dots where the photograph is light, and draw them white on black.
    #[arg(long)]
    pub(crate) invert: bool,

    /// Follow linear light instead of encoded values: averaged over an area, the dots then reflect as
    /// much light as the photograph.
    #[arg(long)]
    pub(crate) linear: bool,
}

impl ToneOptions {
    /// The tone that the options ask for.
    ///
    /// # Errors
    /// [`Failure`] if black is not below white.
    pub(crate) fn tone(&self) -> Result<Tone, Failure> {
        let plain = Levels::default();
        let levels = Levels {
            black: self.black.unwrap_or(plain.black),
            white: self.white.unwrap_or(plain.white),
            gamma: self.gamma.unwrap_or(plain.gamma),
        };
        if levels.black >= levels.white {
            let reason = format!("{} is not below --white {}", levels.black, levels.white);
            return Err(Failure::about("--black", reason));
        }
        Ok(Tone {
            linear: self.linear,
            invert: self.invert,
            levels: (levels != plain).then_some(levels),
            exposure: self.exposure,
        })
    }
}

/// Reads a gray level.
fn level(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(level) if (0.0..=255.0).contains(&level) => Ok(level),
        _ => Err("not a number from 0 to 255".to_owned()),
    }
}

/// Reads a number of stops.
fn stops(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(stops) if (-128.0..=128.0).contains(&stops) => Ok(stops),
        _ => Err("not a number from -128 to 128".to_owned()),
    }
}

/// Reads a finite number above zero.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err("not a finite number above zero".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_must_be_finite_and_above_zero() {
        assert_eq!(positive("2.5"), Ok(2.5));
        for bad in ["0", "-1", "NaN", "inf", "1e999", "", "3px"] {
            assert!(positive(bad).is_err(), "{bad}");
        }
    }
}
