//! What the numbers of a file mean as colors: transfer curves, primaries and ICC profiles, all taken
//! to linear sRGB light.

use std::sync::Arc;

use moxcms::{
    ColorProfile, DataColorSpace, Layout, ToneReprCurve, TransformF32Executor, TransformOptions,
};

use super::srgb;

/// Linear light of an encoded value, both with full scale at 1.
pub(super) type Curve = Arc<dyn Fn(f64) -> f64 + Send + Sync>;

/// Rows of a product with a color as a column.
pub(super) type Matrix = [[f64; 3]; 3];

/// Chromaticities x and y of white, red, green and blue.
pub(super) type Primaries = [[f64; 2]; 4];

const D65: [f64; 2] = [0.3127, 0.3290];
/// How much red, green and blue of Rec. 709 and sRGB add to luma and to luminance.
pub(super) const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

pub(super) const SRGB: Primaries = [D65, [0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];

/// What colors of a file are, as far as it says; by default sRGB in integers and linear light of the
/// sRGB primaries in floats.
#[derive(Clone, Default)]
pub(super) struct Space {
    /// One curve for each of red, green and blue.
    pub(super) curves: Option<[Curve; 3]>,
    /// From linear colors to linear sRGB.
    pub(super) matrix: Option<Matrix>,
    /// From device values straight to encoded sRGB, in place of the other two.
    pub(super) table: Option<Arc<TransformF32Executor>>,
}

impl Space {
    /// A space of one curve, of the sRGB primaries.
    pub(super) fn of_curve(curve: Curve) -> Self {
        Self { curves: Some([curve.clone(), curve.clone(), curve]), ..Self::default() }
    }

    /// With other primaries; as it is if these make no space of colors.
    pub(super) fn with_primaries(mut self, primaries: &Primaries) -> Self {
        self.matrix = to_srgb(primaries).filter(|matrix| !near_identity(matrix));
        self
    }

    /// The default, if nobody can see the difference: what most profiles of photographs come to.
    fn simplified(mut self) -> Self {
        self.matrix = self.matrix.filter(|matrix| !near_identity(matrix));
        if self.matrix.is_none() && self.curves.as_ref().is_some_and(|c| c.iter().all(near_srgb)) {
            self.curves = None;
        }
        self
    }
}

/// Reads an ICC profile for pictures of `channels` colors: 1 gray, 3 red, green and blue, 4 inks.
///
/// # Errors
/// Why it cannot be used, as the end of a sentence.
pub(super) fn profile(bytes: &[u8], channels: usize) -> Result<Space, String> {
    let profile = ColorProfile::new_from_slice(bytes).map_err(|error| error.to_string())?;
    let (expected, layout) = match channels {
        1 => (DataColorSpace::Gray, Layout::Gray),
        3 => (DataColorSpace::Rgb, Layout::Rgb),
        _ => (DataColorSpace::Cmyk, Layout::Rgba),
    };
    if profile.color_space != expected {
        return Err(format!("it is for {:?} pictures", profile.color_space));
    }
    if channels == 1
        && let Some(gray) = &profile.gray_trc
    {
        let curve = icc_curve(gray)?;
        let curve: Curve = if profile.pcs == DataColorSpace::Lab {
            // Its values are lightness.
            Arc::new(move |value| of_lightness(100.0 * curve(value)))
        } else {
            curve
        };
        return Ok(Space::of_curve(curve).simplified());
    }
    // A profile of curves and a matrix may have tables as well, for other renderings.
    if let (3, Some(red), Some(green), Some(blue)) =
        (channels, &profile.red_trc, &profile.green_trc, &profile.blue_trc)
    {
        let curves = [icc_curve(red)?, icc_curve(green)?, icc_curve(blue)?];
        let colorants = [profile.red_colorant, profile.green_colorant, profile.blue_colorant];
        let of = |axis: fn(&moxcms::Xyzd) -> f64| {
            [axis(&colorants[0]), axis(&colorants[1]), axis(&colorants[2])]
        };
        let to_xyz = [of(|c| c.x), of(|c| c.y), of(|c| c.z)];
        // Both in the connection space, whose white is D50.
        let Some(from_xyz) = of_d50() else {
            return Err("its colors cannot be told apart".to_owned());
        };
        let matrix = product(&from_xyz, &to_xyz);
        if matrix.iter().flatten().any(|value| !value.is_finite() || value.abs() > 100.0) {
            return Err("its primaries are out of range".to_owned());
        }
        return Ok(Space { curves: Some(curves), matrix: Some(matrix), table: None }.simplified());
    }
    let table = profile
        .create_transform_f32(
            layout,
            &ColorProfile::new_srgb(),
            Layout::Rgb,
            TransformOptions::default(),
        )
        .map_err(|error| error.to_string())?;
    Ok(Space { table: Some(table), ..Space::default() })
}

/// From colors in the connection space, whose white is D50, to linear sRGB.
pub(super) fn of_d50() -> Option<Matrix> {
    inverse(&to_d50(&SRGB)?)
}

fn icc_curve(curve: &ToneReprCurve) -> Result<Curve, String> {
    let evaluator = curve.make_linear_evaluator().map_err(|error| error.to_string())?;
    Ok(Arc::new(move |value| {
        let light = f64::from(evaluator.evaluate_value(value.clamp(0.0, 1.0) as f32));
        if light.is_finite() { light.clamp(0.0, 1.0) } else { 0.0 }
    }))
}

/// The luminance, of 1, that has this CIE lightness, of 100.
fn of_lightness(lightness: f64) -> f64 {
    of_root((lightness + 16.0) / 116.0)
}

/// The inverse of the function by which CIE makes lightness of light.
pub(super) fn of_root(root: f64) -> f64 {
    const BEND: f64 = 6.0 / 29.0;
    if root > BEND { root * root * root } else { 3.0 * BEND * BEND * (root - 4.0 / 29.0) }
}

/// A power law, as PNG's gAMA chunk gives it: `exponent` of light to encoded value.
pub(super) fn power(exponent: f64) -> Curve {
    Arc::new(move |value| libm::pow(value.clamp(0.0, 1.0), 1.0 / exponent))
}

fn near_srgb(curve: &Curve) -> bool {
    // Half a step of eight bits.
    (0..=32).all(|i| {
        let encoded = f64::from(i) / 32.0;
        (srgb::encode(curve(encoded)) - encoded).abs() < 0.5 / 255.0
    })
}

fn near_identity(matrix: &Matrix) -> bool {
    // Published sRGB profiles round their primaries, each in its own way.
    (0..9).all(|i| (matrix[i / 3][i % 3] - f64::from(u8::from(i / 3 == i % 3))).abs() < 0.004)
}

/// From linear colors of these primaries to linear sRGB, white to white.
fn to_srgb(primaries: &Primaries) -> Option<Matrix> {
    let matrix = product(&of_d50()?, &to_d50(primaries)?);
    matrix.iter().flatten().all(|value| value.is_finite() && value.abs() < 100.0).then_some(matrix)
}

/// From linear colors to XYZ, their white taken to D50 as ICC profiles do (Bradford).
fn to_d50(primaries: &Primaries) -> Option<Matrix> {
    const D50: [f64; 3] = [0.9642, 1.0, 0.8249];
    const BRADFORD: Matrix =
        [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];
    let (to_xyz, white) = to_xyz(primaries)?;
    let (from, to) = (apply(&BRADFORD, white), apply(&BRADFORD, D50));
    let mut scaled = BRADFORD;
    for i in 0..3 {
        scaled[i] = scaled[i].map(|value| value * to[i] / from[i]);
    }
    Some(product(&product(&inverse(&BRADFORD)?, &scaled), &to_xyz))
}

/// From linear colors to XYZ, and the white in XYZ.
fn to_xyz(&[white, red, green, blue]: &Primaries) -> Option<(Matrix, [f64; 3])> {
    if white[1] <= 0.0 {
        return None;
    }
    let white = [white[0] / white[1], 1.0, (1.0 - white[0] - white[1]) / white[1]];
    let of = |i: usize| [red, green, blue].map(|[x, y]| [x, y, 1.0 - x - y][i]);
    let mixed = [of(0), of(1), of(2)];
    let amounts = apply(&inverse(&mixed)?, white);
    Some((mixed.map(|row| [0, 1, 2].map(|i| row[i] * amounts[i])), white))
}

/// How much red, green and blue of these primaries add to luminance, if each does.
pub(super) fn luminance(primaries: &Primaries) -> Option<[f64; 3]> {
    let ([_, weights, _], _) = to_xyz(primaries)?;
    weights.iter().all(|weight| weight.is_finite() && *weight > 1e-3).then_some(weights)
}

pub(super) fn apply(matrix: &Matrix, [a, b, c]: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * a + row[1] * b + row[2] * c)
}

fn product(left: &Matrix, right: &Matrix) -> Matrix {
    left.map(|row| {
        [0, 1, 2].map(|i| row[0] * right[0][i] + row[1] * right[1][i] + row[2] * right[2][i])
    })
}

fn inverse(m: &Matrix) -> Option<Matrix> {
    let minor = |row: usize, column: usize| {
        let (r, s) = ((row + 1) % 3, (row + 2) % 3);
        let (c, d) = ((column + 1) % 3, (column + 2) % 3);
        m[r][c] * m[s][d] - m[r][d] * m[s][c]
    };
    let determinant: f64 = (0..3).map(|column| m[0][column] * minor(0, column)).sum();
    if !determinant.is_finite() || determinant.abs() < 1e-9 {
        return None;
    }
    Some([0, 1, 2].map(|row| [0, 1, 2].map(|column| minor(column, row) / determinant)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_stays_white_between_primaries_and_red_of_a_wider_space_is_outside() {
        let p3 = [D65, [0.68, 0.32], [0.265, 0.69], [0.15, 0.06]];
        let matrix = to_srgb(&p3).unwrap();
        assert!(apply(&matrix, [1.0; 3]).iter().all(|value| (value - 1.0).abs() < 1e-9));
        let [red, green, blue] = apply(&matrix, [1.0, 0.0, 0.0]);
        // As published for Display P3.
        assert!((red - 1.2249).abs() < 1e-3 && (green + 0.0420).abs() < 1e-3);
        assert!((blue + 0.0197).abs() < 1e-3);
        assert!(near_identity(&to_srgb(&SRGB).unwrap()));
        assert!(to_srgb(&[D65, [0.3, 0.3], [0.3, 0.3], [0.3, 0.3]]).is_none());
    }

    #[test]
    fn gray_profiles_that_give_lightness_are_followed() {
        let mut gray = ColorProfile::new_gray_with_gamma(1.0);
        gray.pcs = DataColorSpace::Lab;
        let curves = profile(&gray.encode().unwrap(), 1).unwrap().curves.unwrap();
        assert!((curves[0](0.5) - 0.1842).abs() < 1e-3);
        assert!((curves[0](0.05) - 0.0055).abs() < 1e-3);
        assert_eq!(curves[0](1.0), 1.0);
    }

    #[test]
    fn profiles_of_the_usual_space_change_nothing_and_others_do() {
        let bytes = ColorProfile::new_srgb().encode().unwrap();
        let space = profile(&bytes, 3).unwrap();
        assert!(space.curves.is_none() && space.matrix.is_none() && space.table.is_none());
        assert!(profile(&bytes, 1).is_err() && profile(&bytes, 4).is_err());
        let bytes = ColorProfile::new_display_p3().encode().unwrap();
        let space = profile(&bytes, 3).unwrap();
        let red = apply(&space.matrix.unwrap(), [1.0, 0.0, 0.0])[0];
        assert!((red - 1.2249).abs() < 3e-3, "{red}");
        let bytes = ColorProfile::new_gray_with_gamma(1.0).encode().unwrap();
        let curves = profile(&bytes, 1).unwrap().curves.unwrap();
        assert!((curves[0](0.25) - 0.25).abs() < 1e-3);
        for end in (0..bytes.len()).step_by(7) {
            assert!(profile(&bytes[..end], 1).is_err());
        }
    }
}
