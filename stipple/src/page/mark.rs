//! What is drawn for each dot.

/// What is drawn where dots are, with its sizes in the sheet's unit.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark {
    /// A filled circle of this diameter.
    Disc(f64),
    /// A stroke without a length, of this width.
    Tap(f64),
    /// Circles of these radii around the dot, drawn by a pen of this width.
    Ring { radii: Vec<f64>, pen: f64 },
    /// One line of this width through all dots.
    Line(f64),
}

impl Mark {
    /// The circles that fill a dot of this diameter, which is at least the pen's.
    pub fn ring(dot: f64, pen: f64) -> Self {
        let mut radii = vec![(dot - pen) / 2.0];
        // A circle's inner border is half a pen nearer to the center than its radius says.
        while let Some(&inner) = radii.last().filter(|radius| **radius > 0.5 * pen) {
            radii.push((inner - pen).max(0.0));
        }
        Self::Ring { radii, pen }
    }

    /// The width of what the pen leaves, all strokes of a dot together.
    pub fn width(&self) -> f64 {
        match self {
            Self::Disc(width) | Self::Tap(width) | Self::Line(width) => *width,
            Self::Ring { radii, pen } => 2.0 * radii.first().unwrap_or(&0.0) + pen,
        }
    }

    /// The width of one stroke.
    pub fn stroke(&self) -> f64 {
        match self {
            Self::Ring { pen, .. } => *pen,
            _ => self.width(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_fill_a_dot_and_stay_within_it() {
        for dot in [0.3, 0.31, 0.5, 0.6, 0.75, 0.9, 1.0, 1.2, 2.05] {
            let pen = 0.3;
            let mark = Mark::ring(dot, pen);
            assert!((mark.width() - dot).abs() < 1e-12 && mark.stroke() == pen);
            let Mark::Ring { radii, .. } = mark else { panic!() };
            let mut inner = dot / 2.0;
            for radius in radii {
                assert!(radius >= 0.0 && radius + pen / 2.0 >= inner - 1e-12, "{dot}");
                inner = radius - pen / 2.0;
            }
            assert!(inner <= 1e-12, "{dot}: a hole of {inner}");
        }
    }
}
