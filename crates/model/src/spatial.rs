//! Poses, planar vectors and the one table of notation and frames.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `O`, base frame | circumcentre of `A1A2A3`, `Ox` parallel to `A1A2` | – |
//! | `P`, platform frame | circumcentre of `C1C2C3`, `PX` parallel to `C1C2` | – |
//! | pose `(x, y, φ)` | `P` in the base frame, angle from `Ox` to `PX` | m, m, rad |
//! | twist | `[vx vy vz ωx ωy ωz]`, **linear first**, of the platform at `P`, in base axes | m/s, rad/s |
//! | wrench | `[fx fy fz mx my mz]`, **linear first**, at `P`, in base axes | N, N·m |
//! | `A_i`, `B_i`, `C_i` | base, intermediate and platform joint of leg `i` | m |
//! | `u_i` | unit vector along the last link of leg `i`, towards `C_i` | – |
//! | `m_i` | moment of that unit vector about `P`: `(C_i − P) × u_i` | m |
//! | `K`, `S` | Cartesian stiffness and compliance at `P` | N/m, N, N·m/rad |
//!
//! SI units and radians everywhere inside; degrees only where a name ends in `_deg`.

use glam::DVec2;

use crate::lanes::Real;

/// Number of legs of the manipulators under study.
pub const LEGS: usize = 3;

/// Directions of the anchors `A_i` and `C_i` on their circles: 210°, 330° and 90°, exact in their symmetry.
pub const ANCHOR_DIRECTIONS: [DVec2; LEGS] = [
    DVec2::new(-HALF_SQRT_3, -0.5),
    DVec2::new(HALF_SQRT_3, -0.5),
    DVec2::new(0.0, 1.0),
];

/// √3/2, the cosine of 30°.
pub const HALF_SQRT_3: f64 = 0.866_025_403_784_438_6;

/// Pose of the platform frame in the base frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Position of `P` in the base frame \[m\].
    pub position: DVec2,
    /// Angle from `Ox` to `PX` \[rad\].
    pub phi: f64,
}

impl Pose {
    /// The pose with `P` at `(x, y)` \[m\] and orientation `phi` \[rad\].
    pub fn new(x: f64, y: f64, phi: f64) -> Self {
        Self {
            position: DVec2::new(x, y),
            phi,
        }
    }
}

/// Where on the segment from `from` to `to` the point nearest to `at` lies, from 0 to 1; 0 where the ends coincide.
pub fn nearest_on_segment(at: DVec2, from: DVec2, to: DVec2) -> f64 {
    let way = to - from;
    let share = (at - from).dot(way) / way.length_squared();
    if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }
}

/// Planar cross product: the z component of `a × b`.
#[inline]
pub fn cross(a: DVec2, b: DVec2) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Unit vector at `angle` \[rad\] from the x axis, through `libm` so that every machine agrees.
pub fn unit(angle: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(angle);
    DVec2::new(cos, sin)
}

/// Rotation by `angle` \[rad\], its sine and cosine taken once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotation {
    cos: f64,
    sin: f64,
}

impl Rotation {
    /// The rotation by `angle` \[rad\].
    pub fn new(angle: f64) -> Self {
        let (sin, cos) = libm::sincos(angle);
        Self { cos, sin }
    }

    /// `v` turned by this rotation.
    #[inline]
    pub fn apply(&self, v: DVec2) -> DVec2 {
        DVec2::new(self.cos * v.x - self.sin * v.y, self.sin * v.x + self.cos * v.y)
    }
}

/// Smaller eigenvalue of the symmetric matrix `[[xx, xy], [xy, yy]]`.
#[inline(always)]
pub fn smaller_eigenvalue<V: Real>(xx: V, xy: V, yy: V) -> V {
    let half = xx.splat(0.5);
    let half_trace = half * (xx + yy);
    let half_gap = half * (xx - yy);
    let root = (half_gap * half_gap + xy * xy).sqrt();
    let larger = half_trace + root;
    // det/larger instead of a difference: no cancellation when the matrix is nearly singular.
    ((xx * yy - xy * xy) / larger).where_set(larger.exceeds(xx.splat(0.0)), half_trace - root)
}

impl std::str::FromStr for Pose {
    type Err = String;

    /// Reads `x=0.1 y=0.2 phi_deg=30`.
    fn from_str(text: &str) -> Result<Self, String> {
        const KEYS: [&str; 3] = ["x", "y", "phi_deg"];
        let mut values = [None; KEYS.len()];
        for word in text.split_whitespace() {
            let (key, value) = word
                .split_once('=')
                .ok_or_else(|| format!("`{word}` is not of the form key=value"))?;
            let index = KEYS
                .iter()
                .position(|&known| known == key)
                .ok_or_else(|| format!("unknown key `{key}`; a pose has x, y (m) and phi_deg"))?;
            let number: f64 = value
                .parse()
                .map_err(|_| format!("`{value}` is not a number (key {key})"))?;
            if !number.is_finite() {
                return Err(format!("{key} is {number}; it must be finite"));
            }
            if values[index].replace(number).is_some() {
                return Err(format!("`{key}` is given twice"));
            }
        }
        let value = |index: usize| {
            values[index].ok_or_else(|| format!("`{}` is missing; a pose has x, y (m) and phi_deg", KEYS[index]))
        };
        Ok(Pose::new(value(0)?, value(1)?, value(2)?.to_radians()))
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
    fn smaller_eigenvalue_of_known_matrices() {
        assert_eq!(smaller_eigenvalue(3.0, 0.0, 5.0), 3.0);
        assert!((smaller_eigenvalue(2.0, 1.0, 2.0) - 1.0).abs() < 1e-15);
        assert_eq!(smaller_eigenvalue(0.0, 0.0, 0.0), 0.0);
    }
}
