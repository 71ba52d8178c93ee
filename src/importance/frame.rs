//! Which way the image of an environment map faces: the conventions of renderers, by name.

use core::ops::Neg as _;

use glam::DVec3;

/// How a latitude–longitude image lies in a renderer's coordinates: which directions its upper border,
/// its left border and a quarter of its width are.
///
/// All renderers show such an image unmirrored from within; what differs is which axis is up, which
/// direction the seam is, and whether coordinates are right-handed. With u from 0 at the left border
/// to 1 at the right one, v from 0 above to 1 below, φ = 2πu and θ = πv:
///
/// | name | direction | center (u = ½) | right of it (u = ¾) | up | hand |
/// |---|---|---|---|---|---|
/// | [`PBRT`](Self::PBRT) | (sin θ cos φ, sin θ sin φ, cos θ) | −x | −y | +z | left |
/// | [`MITSUBA`](Self::MITSUBA) | (sin θ sin φ, cos θ, −sin θ cos φ) | +z | −x | +y | right |
/// | [`BLENDER`](Self::BLENDER) | (−sin θ cos φ, sin θ sin φ, cos θ) | +x | −y | +z | right |
/// | [`GLTF`](Self::GLTF) | (−sin θ cos φ, cos θ, −sin θ sin φ) | +x | +z | +y | right |
/// | [`OPENEXR`](Self::OPENEXR) | (sin θ sin φ, cos θ, −sin θ cos φ) | +z | −x | +y | right |
///
/// ```
/// use glam::DVec3;
/// use twelvefold::light::Frame;
/// // What lies right of the image's center in pbrt's coordinates, in Blender's: as seen from within.
/// let right = Frame::PBRT.to_image(DVec3::NEG_Y);
/// assert_eq!(Frame::BLENDER.to_world(right), DVec3::NEG_Y);
/// assert_eq!(Frame::BLENDER.rotated(90.0).to_world(right), DVec3::X);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The direction of the left border, of a quarter of the width, and of the upper border.
    seam: DVec3,
    quarter: DVec3,
    up: DVec3,
}

impl Frame {
    /// pbrt: z up, left-handed, the left border is +x. What this crate means unless told otherwise.
    ///
    /// pbrt-v3's infinite light, and how pbrt-v4 reads such an image: `imgtool makeequiarea` looks up
    /// (`SphericalPhi` / 2π, `SphericalTheta` / π) (`src/pbrt/cmd/imgtool.cpp`,
    /// `src/pbrt/util/vecmath.h`).
    pub const PBRT: Self = Self { seam: DVec3::X, quarter: DVec3::Y, up: DVec3::Z };

    /// Mitsuba 3's `envmap`: y up, right-handed, the image's center is +z. The same as
    /// [`OPENEXR`](Self::OPENEXR).
    ///
    /// `src/emitters/envmap.cpp`: u = atan2(x, −z) / 2π, v = acos(y) / π.
    pub const MITSUBA: Self = Self::OPENEXR;

    /// Blender's and Cycles' environment texture: z up, right-handed, the image's center is +x.
    ///
    /// `intern/cycles/kernel/camera/projection.h`: `direction_to_equirectangular` is
    /// u = (atan2(y, x) − π) / −2π, and v = (acos z − π) / −π from below.
    pub const BLENDER: Self = Self { seam: DVec3::NEG_X, quarter: DVec3::Y, up: DVec3::Z };

    /// glTF's tools and three.js: y up, right-handed, the image's center is +x.
    ///
    /// glTF itself has no such images; Khronos' glTF-IBL-Sampler reads them with
    /// u = ½ + atan2(z, x) / 2π (`dirToUV` in `lib/shaders/filter.frag`), as does three.js
    /// (`equirectUv` in `src/renderers/shaders/ShaderChunk/common.glsl.js`).
    pub const GLTF: Self = Self { seam: DVec3::NEG_X, quarter: DVec3::NEG_Z, up: DVec3::Y };

    /// OpenEXR's latitude–longitude maps, and USD's `DomeLight`, which quotes them: y up,
    /// right-handed, the image's center is +z.
    ///
    /// `ImfEnvmap.h`: longitude falls from π at the left to −π at the right; longitude 0 is +z and
    /// π/2 is +x. (OpenEXR puts the *centers* of the outermost pixels on the seam and the poles; here, as
    /// in all the renderers, their outer borders lie there: half a pixel's difference.)
    pub const OPENEXR: Self = Self { seam: DVec3::NEG_Z, quarter: DVec3::X, up: DVec3::Y };

    /// The frame in which the image's left border, a quarter of its width, and its upper border are
    /// these directions. `None` unless they are of length 1 and at right angles, to 10⁻⁹.
    #[must_use]
    pub fn from_axes(seam: DVec3, quarter: DVec3, up: DVec3) -> Option<Self> {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        let unit = [seam, quarter, up].iter().all(|axis| near(axis.length_squared(), 1.0));
        let square = [seam.dot(quarter), quarter.dot(up), up.dot(seam)];
        (unit && square.iter().all(|cosine| near(*cosine, 0.0))).then_some(Self {
            seam,
            quarter,
            up,
        })
    }

    /// The surroundings turned about the frame's up axis by the renderer's own rotation matrix, as if its
    /// scene said "rotate by `degrees` about up": counterclockwise seen from above where coordinates
    /// are right-handed, clockwise where they are left-handed. Exact for multiples of 90°. A number that
    /// is not finite turns nothing.
    #[must_use]
    pub fn rotated(self, degrees: f64) -> Self {
        if !degrees.is_finite() {
            return self;
        }
        // Exact, and within ±360.
        let turn = degrees % 360.0;
        let (sine, cosine) = if turn % 90.0 == 0.0 {
            let quarters = (turn / 90.0) as i32;
            match quarters.rem_euclid(4) {
                0 => (0.0, 1.0),
                1 => (1.0, 0.0),
                2 => (0.0, -1.0),
                _ => (-1.0, 0.0),
            }
        } else {
            libm::sincos(turn.to_radians())
        };
        // Rodrigues' formula for a vector at right angles to the axis.
        let turned = |axis: DVec3| axis * cosine + self.up.cross(axis) * sine;
        Self { seam: turned(self.seam), quarter: turned(self.quarter), up: self.up }
    }

    /// From the image's own coordinates, those of [`PBRT`](Self::PBRT), to the renderer's.
    #[must_use]
    pub fn to_world(&self, direction: DVec3) -> DVec3 {
        self.seam * direction.x + self.quarter * direction.y + self.up * direction.z
    }

    /// From the renderer's coordinates to the image's own, those of [`PBRT`](Self::PBRT).
    #[must_use]
    pub fn to_image(&self, direction: DVec3) -> DVec3 {
        DVec3::new(self.seam.dot(direction), self.quarter.dot(direction), self.up.dot(direction))
    }

    /// Whether these are left-handed coordinates, given that the image shows the world as seen from
    /// within.
    #[must_use]
    pub fn is_left_handed(&self) -> bool {
        // Rightwards along the image is from the seam over the quarter to the opposite of the seam.
        let (forwards, rightwards) = (self.seam.neg(), self.quarter.neg());
        rightwards.dot(forwards.cross(self.up)) < 0.0
    }
}

impl Default for Frame {
    fn default() -> Self {
        Self::PBRT
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{PI, TAU};

    use super::*;

    const ALL: [Frame; 5] =
        [Frame::PBRT, Frame::MITSUBA, Frame::BLENDER, Frame::GLTF, Frame::OPENEXR];

    /// The image's own direction at (u, v).
    fn at(u: f64, v: f64) -> DVec3 {
        let (azimuth, angle) = (TAU * u, PI * v);
        let sine = libm::sin(angle);
        DVec3::new(sine * libm::cos(azimuth), sine * libm::sin(azimuth), libm::cos(angle))
    }

    /// (u, v) of a direction by each renderer's own formula, v from above.
    fn lookup(frame: Frame, d: DVec3) -> (f64, f64) {
        let (u, up) = if frame == Frame::PBRT {
            (libm::atan2(d.y, d.x) / TAU, d.z)
        } else if frame == Frame::OPENEXR {
            (libm::atan2(d.x, -d.z) / TAU, d.y)
        } else if frame == Frame::BLENDER {
            ((libm::atan2(d.y, d.x) - PI) / -TAU, d.z)
        } else {
            (0.5 + libm::atan2(d.z, d.x) / TAU, d.y)
        };
        (u.rem_euclid(1.0), libm::acos(up.clamp(-1.0, 1.0)) / PI)
    }

    #[test]
    fn each_frame_is_its_renderers_own_lookup() {
        for frame in ALL {
            for i in 0..400 {
                let (u, v) = ((f64::from(i) * 0.618) % 1.0, (f64::from(i) + 0.5) / 400.0);
                let (found_u, found_v) = lookup(frame, frame.to_world(at(u, v)));
                assert!((found_v - v).abs() < 1e-7, "{frame:?} {u} {v}");
                // Near the poles longitude keeps few digits.
                assert!((found_u - u).abs() * libm::sin(PI * v) < 1e-7, "{frame:?} {u} {v}");
            }
        }
    }

    #[test]
    fn left_right_up_and_the_seam_lie_where_the_table_says() {
        let table = [
            (Frame::PBRT, DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z, true),
            (Frame::MITSUBA, DVec3::Z, DVec3::NEG_X, DVec3::Y, false),
            (Frame::BLENDER, DVec3::X, DVec3::NEG_Y, DVec3::Z, false),
            (Frame::GLTF, DVec3::X, DVec3::Z, DVec3::Y, false),
            (Frame::OPENEXR, DVec3::Z, DVec3::NEG_X, DVec3::Y, false),
        ];
        for (frame, center, right, up, left_handed) in table {
            assert_eq!(frame.to_world(DVec3::NEG_X), center);
            assert_eq!(frame.to_world(DVec3::NEG_Y), right);
            assert_eq!(frame.to_world(DVec3::Y), -right);
            assert_eq!(frame.to_world(DVec3::Z), up);
            assert_eq!(frame.to_world(DVec3::X), -center);
            assert_eq!(frame.is_left_handed(), left_handed);
            // Unmirrored: looking at the center, right is where a right hand says, or a left one.
            let hand = if left_handed { up.cross(center) } else { center.cross(up) };
            assert_eq!(hand, right);
        }
    }

    #[test]
    fn frames_are_undone_and_turn_about_up() {
        for frame in ALL {
            for degrees in [0.0, 90.0, -90.0, 450.0, 17.5, -721.25, 1e9] {
                let turned = frame.rotated(degrees);
                assert!(Frame::from_axes(turned.seam, turned.quarter, turned.up).is_some());
                assert_eq!(turned.is_left_handed(), frame.is_left_handed());
                let direction = at(0.37, 0.4);
                assert!((turned.to_image(turned.to_world(direction)) - direction).length() < 1e-15);
                let back = turned.rotated(-degrees);
                assert!((back.to_world(direction) - frame.to_world(direction)).length() < 1e-14);
            }
            assert_eq!(frame.rotated(360.0), frame);
            assert_eq!(frame.rotated(f64::NAN), frame);
        }
        // In right-handed z-up coordinates a quarter turn takes +x to +y.
        assert_eq!(Frame::BLENDER.rotated(90.0).to_world(DVec3::NEG_X), DVec3::Y);
        assert_eq!(Frame::GLTF.rotated(90.0).to_world(DVec3::NEG_X), DVec3::NEG_Z);
    }

    #[test]
    fn crooked_axes_are_no_frame() {
        assert_eq!(Frame::from_axes(DVec3::X, DVec3::Y, DVec3::Z), Some(Frame::PBRT));
        assert_eq!(Frame::from_axes(DVec3::X, DVec3::X, DVec3::Z), None);
        assert_eq!(Frame::from_axes(2.0 * DVec3::X, DVec3::Y, DVec3::Z), None);
        assert_eq!(Frame::from_axes(DVec3::NAN, DVec3::Y, DVec3::Z), None);
    }
}
