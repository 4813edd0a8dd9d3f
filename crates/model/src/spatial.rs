//! Poses, planar vectors, and the notation and frames that the whole crate uses (docs/model.md, section 1).
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `O`, base frame | circumcentre of `A1A2A3`, `Ox` parallel to `A1A2` | – |
//! | `P`, platform frame | circumcentre of `C1C2C3`, `PX` parallel to `C1C2` | – |
//! | pose `(x, y, φ)` | `P` in the base frame, angle from `Ox` to `PX` | m, m, rad |
//! | twist | `[vx vy vz ωx ωy ωz]`, **linear first**, of the platform at `P`, in base axes | m/s, rad/s |
//! | wrench | `[fx fy fz mx my mz]`, **linear first**, at `P`, in base axes | N, N·m |
//! | `A_i`, `B_i`, `C_i` | base, intermediate and platform joint of leg `i` | m |
//! | `u_i` | unit vector along the distal link of leg `i`, towards `C_i` | – |
//! | `m_i` | moment of that unit vector about `P`: `(C_i − P) × u_i` | m |
//! | `K` | Cartesian stiffness at `P` | N/m, N, N·m/rad |
//! | `S` | Cartesian compliance at `P` | m/N, 1/N, rad/(N·m) |
//!
//! All values are in SI units and radians; only names that end in `_deg` hold degrees.

use glam::DVec2;

use crate::lanes::Real;

/// Number of legs of the manipulators under study.
pub const LEGS: usize = 3;

/// Directions of the anchors `A_i` and `C_i` on their circles: 210°, 330° and 90°. They are constants so that their
/// mirror symmetry is exact.
pub const ANCHOR_DIRECTIONS: [DVec2; LEGS] = [
    DVec2::new(-HALF_SQRT_3, -0.5),
    DVec2::new(HALF_SQRT_3, -0.5),
    DVec2::new(0.0, 1.0),
];

/// √3/2, the cosine of 30°.
pub const HALF_SQRT_3: f64 = 0.866_025_403_784_438_6;

/// Largest magnitude of a reported distance, and upper limit for the dimensions of members \[m\].
pub(crate) const NUMBER_LIMIT: f64 = 1e100;

/// Pose of the platform frame in the base frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Position of `P` in the base frame \[m\].
    pub position: DVec2,
    /// Angle from `Ox` to `PX` \[rad\].
    pub phi: f64,
}

impl Pose {
    /// Creates the pose with `P` at `(x, y)` \[m\] and orientation `phi` \[rad\].
    pub fn new(x: f64, y: f64, phi: f64) -> Self {
        Self {
            position: DVec2::new(x, y),
            phi,
        }
    }
}

/// Returns the position of the point nearest to `at` on the segment from `from` to `to`, as a fraction of the segment:
/// 0 at `from`, 1 at `to`, and 0 if the ends coincide.
pub fn nearest_on_segment(at: DVec2, from: DVec2, to: DVec2) -> f64 {
    let way = to - from;
    let fraction = (at - from).dot(way) / way.length_squared();
    if fraction.is_finite() {
        fraction.clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// Returns the planar cross product, which is the z component of `a × b`.
#[inline]
pub fn cross(a: DVec2, b: DVec2) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Returns the unit vector at `angle` \[rad\] from the x axis, computed with `libm` so that every machine gives the
/// same bits.
pub fn unit(angle: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(angle);
    DVec2::new(cos, sin)
}

/// Returns the unit vector at `angle` \[deg\] from the x axis, with exact mirror symmetry at multiples of 30°.
pub fn direction_deg(angle: f64) -> DVec2 {
    let turned = angle.rem_euclid(360.0);
    let thirds = turned / 30.0;
    if thirds.fract() != 0.0 {
        return unit(turned.to_radians());
    }
    let cosine = |thirds: u32| match thirds % 12 {
        0 => 1.0,
        1 | 11 => HALF_SQRT_3,
        2 | 10 => 0.5,
        3 | 9 => 0.0,
        4 | 8 => -0.5,
        5 | 7 => -HALF_SQRT_3,
        _ => -1.0,
    };
    let thirds = thirds as u32;
    DVec2::new(cosine(thirds), cosine(thirds + 9))
}

/// Planar rotation that stores the sine and cosine of its angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotation {
    cos: f64,
    sin: f64,
}

impl Rotation {
    /// Creates the rotation by `angle` \[rad\].
    pub fn new(angle: f64) -> Self {
        let (sin, cos) = libm::sincos(angle);
        Self { cos, sin }
    }

    /// Creates the rotation that turns the x axis to `direction`, a unit vector.
    pub fn by(direction: DVec2) -> Self {
        Self {
            cos: direction.x,
            sin: direction.y,
        }
    }

    /// Returns `v` rotated by this rotation.
    #[inline]
    pub fn apply(&self, v: DVec2) -> DVec2 {
        DVec2::new(self.cos * v.x - self.sin * v.y, self.sin * v.x + self.cos * v.y)
    }
}

/// Returns the rows of the inverse of the Cholesky factor of a symmetric matrix, given as an upper triangle, if it is positive definite.
pub(crate) fn inverse_factor(matrix: &[f64; 6]) -> Option<[[f64; 3]; 3]> {
    let [a, b, c, d, e, f] = f64::cholesky(matrix);
    let second = [-b / (a * d), 1.0 / d, 0.0];
    let third = [(b * e / d - c) / (a * f), -e / (d * f), 1.0 / f];
    let rows = [[1.0 / a, 0.0, 0.0], second, third];
    rows.as_flattened()
        .iter()
        .all(|entry| entry.is_finite())
        .then_some(rows)
}

/// Returns the smaller eigenvalue of the symmetric matrix `[[xx, xy], [xy, yy]]`.
#[inline(always)]
pub fn smaller_eigenvalue<V: Real>(xx: V, xy: V, yy: V) -> V {
    let half = xx.splat(0.5);
    let half_trace = half * (xx + yy);
    let half_gap = half * (xx - yy);
    let root = (half_gap * half_gap + xy * xy).sqrt();
    let larger = half_trace + root;
    // The quotient det/larger, unlike the difference, suffers no cancellation if the matrix is nearly singular.
    ((xx * yy - xy * xy) / larger).select(larger.exceeds(xx.splat(0.0)), half_trace - root)
}

/// Why a text is not a pose, or not the values of three joints.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PoseTextError {
    /// A word without `=`.
    #[error("`{0}` is not of the form key=value")]
    NoEquals(String),
    /// An unknown key.
    #[error("unknown key `{key}`; expected {expected}")]
    UnknownKey {
        /// The key.
        key: String,
        /// The keys that there are.
        expected: &'static str,
    },
    /// A value that is not a number.
    #[error("`{text}` is not a number (key {key})")]
    NotANumber {
        /// Key of the value.
        key: &'static str,
        /// The text found.
        text: String,
    },
    /// A value that is infinite or NaN.
    #[error("{key} is {number}; it must be finite")]
    NotFinite {
        /// Key of the value.
        key: &'static str,
        /// The value.
        number: f64,
    },
    /// A key that is given twice.
    #[error("`{0}` is given twice")]
    Repeated(&'static str),
    /// A key that is not given.
    #[error("`{key}` is missing; expected {expected}")]
    Missing {
        /// The key.
        key: &'static str,
        /// The keys that there are.
        expected: &'static str,
    },
}

/// Parses finite numbers with keys, in any order; `expected` names the keys and units in messages.
fn numbers<const N: usize>(
    text: &str,
    keys: [&'static str; N],
    expected: &'static str,
) -> Result<[Option<f64>; N], PoseTextError> {
    let mut values = [None; N];
    for word in text.split_whitespace() {
        let (key, value) = word
            .split_once('=')
            .ok_or_else(|| PoseTextError::NoEquals(word.to_owned()))?;
        let index = keys
            .iter()
            .position(|&known| known == key)
            .ok_or_else(|| PoseTextError::UnknownKey {
                key: key.to_owned(),
                expected,
            })?;
        let key = keys[index];
        let number: f64 = value.parse().map_err(|_| PoseTextError::NotANumber {
            key,
            text: value.to_owned(),
        })?;
        if !number.is_finite() {
            return Err(PoseTextError::NotFinite { key, number });
        }
        if values[index].replace(number).is_some() {
            return Err(PoseTextError::Repeated(key));
        }
    }
    Ok(values)
}

/// Parses three finite numbers with keys, in any order; `expected` names the keys and units in messages.
fn three_numbers(text: &str, keys: [&'static str; 3], expected: &'static str) -> Result<[f64; 3], PoseTextError> {
    let values = numbers(text, keys, expected)?;
    let value = |index: usize| {
        values[index].ok_or(PoseTextError::Missing {
            key: keys[index],
            expected,
        })
    };
    Ok([value(0)?, value(1)?, value(2)?])
}

impl std::str::FromStr for Pose {
    type Err = PoseTextError;

    /// Parses a pose from text such as `x=0.1 y=0.2 phi_deg=30`.
    fn from_str(text: &str) -> Result<Self, PoseTextError> {
        let expected = "x, y (m) and phi_deg";
        let [x, y, phi_deg] = three_numbers(text, ["x", "y", "phi_deg"], expected)?;
        Ok(Pose::new(x, y, phi_deg.to_radians()))
    }
}

/// Values of the actuated joints of legs 1, 2, 3 \[m or rad\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointValues(pub [f64; LEGS]);

impl std::str::FromStr for JointValues {
    type Err = PoseTextError;

    /// Parses values from text such as `q1=0.9 q2=1.0 q3=1.1`.
    fn from_str(text: &str) -> Result<Self, PoseTextError> {
        three_numbers(text, ["q1", "q2", "q3"], "q1, q2 and q3 (m or rad)").map(Self)
    }
}

/// A wrench that the surroundings exert on the platform at `P`, in base axes: `f_x`, `f_y`, `f_z` \[N\], `m_x`, `m_y`, `m_z` \[N·m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wrench(pub [f64; 6]);

impl std::str::FromStr for Wrench {
    type Err = PoseTextError;

    /// Parses a wrench from text such as `fx=100 mz=-5`; what is absent is 0.
    fn from_str(text: &str) -> Result<Self, PoseTextError> {
        let expected = "fx, fy, fz (N), mx, my and mz (N·m)";
        let values = numbers(text, ["fx", "fy", "fz", "mx", "my", "mz"], expected)?;
        Ok(Self(values.map(Option::unwrap_or_default)))
    }
}

/// A twist of the platform at `P`, in base axes: `v_x`, `v_y` \[m/s\], `ω` \[rad/s\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Twist(pub [f64; 3]);

impl std::str::FromStr for Twist {
    type Err = PoseTextError;

    /// Parses a twist from text such as `vx=1 omega=0.5`; what is absent is 0.
    fn from_str(text: &str) -> Result<Self, PoseTextError> {
        let values = numbers(text, ["vx", "vy", "omega"], "vx, vy (m/s) and omega (rad/s)")?;
        Ok(Self(values.map(Option::unwrap_or_default)))
    }
}

/// An acceleration of the platform at `P`, in base axes: `a_x`, `a_y` \[m/s²\], `α` \[rad/s²\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Acceleration(pub [f64; 3]);

impl std::str::FromStr for Acceleration {
    type Err = PoseTextError;

    /// Parses an acceleration from text such as `ax=1 alpha=0.5`; what is absent is 0.
    fn from_str(text: &str) -> Result<Self, PoseTextError> {
        let values = numbers(text, ["ax", "ay", "alpha"], "ax, ay (m/s²) and alpha (rad/s²)")?;
        Ok(Self(values.map(Option::unwrap_or_default)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotation_keeps_length_and_turns_by_its_angle() {
        let v = Rotation::new(0.3).apply(unit(0.4));
        assert!((v - unit(0.7)).length() < 1e-15);
    }

    #[test]
    fn directions_in_degrees_are_exact_at_multiples_of_thirty() {
        for (angle, wanted) in [(210.0, 0), (330.0, 1), (90.0, 2), (-150.0, 0), (450.0, 2)] {
            assert_eq!(direction_deg(angle), ANCHOR_DIRECTIONS[wanted]);
        }
        for angle in [-725.5f64, -30.0, 0.0, 17.25, 60.0, 149.999, 240.0, 359.0] {
            assert!(
                (direction_deg(angle) - unit(angle.to_radians())).length() < 1e-14,
                "{angle}"
            );
        }
    }

    #[test]
    fn smaller_eigenvalue_of_known_matrices() {
        assert_eq!(smaller_eigenvalue(3.0, 0.0, 5.0), 3.0);
        assert!((smaller_eigenvalue(2.0, 1.0, 2.0) - 1.0).abs() < 1e-15);
        assert_eq!(smaller_eigenvalue(0.0, 0.0, 0.0), 0.0);
    }
}
