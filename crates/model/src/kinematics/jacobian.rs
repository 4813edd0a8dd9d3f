//! The velocity equation `A t = B q̇` with `t = (vx, vy, ω)`, and the dexterity, computed from its normalised form
//! (docs/model.md, section 3).

use nalgebra::Matrix3;

use crate::lanes::Real;
use crate::mechanism::{LegLanes, Posture};
use crate::spatial::LEGS;

/// Definition of the characteristic length `ℓ`, which makes the rotational part of the Jacobian comparable with the
/// translational part (docs/model.md, section 3.3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CharacteristicLength {
    /// `ℓ = r`.
    PlatformRadius,
    /// `ℓ = √2·max|w|`, where `w` is the moment of a leg's line about `P`; the maximum is over the legs and over the
    /// orientations of the reference grid that are reachable with `P` at `O`.
    Isotropic,
    /// `ℓ` is the given length \[m\].
    Fixed(f64),
}

/// Direct (`A`) and inverse (`B`) Jacobian at one pose or at several poses at once, with one row per leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jacobian<V = f64> {
    /// First column of `A`: `x` components of `u_i`.
    pub ux: [V; LEGS],
    /// Second column of `A`: `y` components of `u_i`.
    pub uy: [V; LEGS],
    /// Third column of `A`: moments of the legs' lines about `P` \[m\].
    pub moment: [V; LEGS],
    /// Diagonal of `B`: the transmissions.
    pub transmission: [V; LEGS],
}

impl Jacobian {
    /// Computes the Jacobians at a posture.
    #[inline]
    pub fn new(posture: &Posture) -> Self {
        let legs = &posture.legs;
        Self {
            ux: [legs[0].u.x, legs[1].u.x, legs[2].u.x],
            uy: [legs[0].u.y, legs[1].u.y, legs[2].u.y],
            moment: [legs[0].moment, legs[1].moment, legs[2].moment],
            transmission: [legs[0].transmission, legs[1].transmission, legs[2].transmission],
        }
    }

    /// Returns `A` as a matrix with the rows `[u_ix, u_iy, m_i]`, where `m_i` is the moment of the leg's line about `P`.
    pub fn direct(&self) -> Matrix3<f64> {
        Matrix3::from_fn(|i, column| [self.ux[i], self.uy[i], self.moment[i]][column])
    }
}

impl<V: Real> Jacobian<V> {
    /// Computes the Jacobians from the legs.
    #[inline(always)]
    pub(crate) fn of_lanes(legs: &[LegLanes<V>; LEGS]) -> Self {
        Self {
            ux: [legs[0].u.x, legs[1].u.x, legs[2].u.x],
            uy: [legs[0].u.y, legs[1].u.y, legs[2].u.y],
            moment: [legs[0].moment, legs[1].moment, legs[2].moment],
            transmission: [legs[0].transmission, legs[1].transmission, legs[2].transmission],
        }
    }

    /// Computes `det A` \[m\], which is 0 at a parallel singularity.
    #[inline(always)]
    pub fn determinant(&self) -> V {
        let adjugate = self.adjugate_row_xy();
        self.moment[0] * adjugate[0] + self.moment[1] * adjugate[1] + self.moment[2] * adjugate[2]
    }

    /// Computes the third row of `adj A`: `u_j × u_k` for each leg, where `j` and `k` follow the leg in cyclic order.
    #[inline(always)]
    fn adjugate_row_xy(&self) -> [V; LEGS] {
        let (ux, uy) = (&self.ux, &self.uy);
        [
            ux[1] * uy[2] - uy[1] * ux[2],
            ux[2] * uy[0] - uy[2] * ux[0],
            ux[0] * uy[1] - uy[0] * ux[1],
        ]
    }

    /// Computes the dexterity `κ_F⁻¹(J)` of `J = diag(1, 1, ℓ) A⁻¹B`, in \[0, 1\]: 1 at an isotropic pose, 0 at any
    /// singularity (docs/model.md, section 3.2).
    ///
    /// `length` is `ℓ` \[m\]. The value is `3 |det A · det B| / √(Σ a_i² Σ b_i²)`, where `a_i` are the entries of
    /// `det A · J` and `b_i` those of `det B · J⁻¹`. It contains no inverse of `A` or `B`, so that a singular pose
    /// gives 0 and no division by zero.
    #[inline(always)]
    pub fn inverse_condition(&self, length: f64) -> V {
        let planar = self.adjugate_row_xy();
        let (ux, uy, m, d) = (&self.ux, &self.uy, &self.moment, &self.transmission);
        let like = ux[0];
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        let (length, to_lever) = (like.splat(length), like.splat(1.0 / (length * length)));
        let squared = [d[0] * d[0], d[1] * d[1], d[2] * d[2]];
        let mut forward = zero;
        let mut inverse = zero;
        let mut determinant = zero;
        for i in 0..LEGS {
            let (j, k) = ((i + 1) % LEGS, (i + 2) % LEGS);
            let vx = uy[j] * m[k] - m[j] * uy[k];
            let vy = m[j] * ux[k] - ux[j] * m[k];
            let w = length * planar[i];
            determinant = determinant + m[i] * planar[i];
            forward = forward + squared[i] * (vx * vx + vy * vy + w * w);
            inverse = inverse + squared[j] * squared[k] * (one + m[i] * m[i] * to_lever);
        }
        let serial = d[0] * d[1] * d[2];
        let scale = forward * inverse;
        let condition = like.splat(LEGS as f64) * (determinant * serial).abs() / scale.sqrt();
        // At an isotropic pose, rounding may give a value above 1.
        condition.smaller(one).select(scale.exceeds(zero), zero)
    }
}
