//! The two decoupled 3×3 blocks of the stiffness at `P` in base axes, as upper triangles: sums over legs and bars, and inverses
//! (docs/model.md, sections 4.3 and 4.4).

use nalgebra::Matrix3;

use super::BarCompliance;
use crate::kinematics::Jacobian;
use crate::lanes::{Planar, Real};
use crate::spatial::LEGS;

/// Computes `Σ w wᵀ k`, where `w` are the rows of the direct Jacobian and `k` the stiffnesses along the legs' lines;
/// upper triangle, ordered as in [`PlanarStiffness::in_plane`](super::PlanarStiffness::in_plane).
#[inline(always)]
pub(crate) fn in_plane_block<V: Real>(jacobian: &Jacobian<V>, stiffness: &[V; LEGS]) -> [V; 6] {
    let mut k = [stiffness[0].splat(0.0); 6];
    for i in 0..LEGS {
        let (x, y, m) = (jacobian.ux[i], jacobian.uy[i], jacobian.moment[i]);
        let (kx, ky, km) = (x * stiffness[i], y * stiffness[i], m * stiffness[i]);
        k[0] = k[0] + x * kx;
        k[1] = k[1] + x * ky;
        k[2] = k[2] + x * km;
        k[3] = k[3] + y * ky;
        k[4] = k[4] + y * km;
        k[5] = k[5] + m * km;
    }
    k
}

/// Adds the compliance of a bar along `axis` with its distal end at `P − to_p` to `s`, the out-of-plane compliance at `P`. Of the
/// two lengths, the second one has the sign of the way along `axis` to the distal end.
#[inline(always)]
pub(crate) fn add_bar<V: Real>(
    s: &mut [V; 6],
    section: &BarCompliance,
    axis: Planar<V>,
    [length, signed]: [V; 2],
    to_p: Planar<V>,
) {
    let (half, twelfth) = (length.splat(0.5), length.splat(1.0 / 12.0));
    let bend = length * length.splat(section.bending);
    let twist = length * length.splat(section.torsion);
    let normal = axis.perp();
    // A rotation ω at the tip displaces P along z by ωx·dy − ωy·dx = lever·ω; `lever_x` and `lever_y` are its
    // components in the bar's axes.
    let lever = Planar::new(to_p.y, -to_p.x);
    let lever_x = lever.dot(axis);
    let lever_y = lever.dot(normal);
    // At the middle of the bar, the bending compliances are decoupled: L/(EI) for rotation, L³/(12EI) along z.
    let arm = lever_y - half * signed;
    s[0] = s[0] + bend * (length * length * twelfth + arm * arm) + twist * lever_x * lever_x;
    let (x, y) = (twist * lever_x, bend * arm);
    s[1] = s[1] + x * axis.x + y * normal.x;
    s[2] = s[2] + x * axis.y + y * normal.y;
    s[3] = s[3] + twist * axis.x * axis.x + bend * normal.x * normal.x;
    s[4] = s[4] + twist * axis.x * axis.y + bend * normal.x * normal.y;
    s[5] = s[5] + twist * axis.y * axis.y + bend * normal.y * normal.y;
}

/// Returns the matrix of an upper triangle.
pub(super) fn symmetric(k: &[f64; 6]) -> Matrix3<f64> {
    Matrix3::new(k[0], k[1], k[2], k[1], k[3], k[4], k[2], k[4], k[5])
}

/// Computes the first entry of the inverse of a symmetric positive definite 3×3 matrix, given as upper triangle.
#[inline]
pub(super) fn first_of_inverse(s: &[f64; 6]) -> f64 {
    let minor = s[3] * s[5] - s[4] * s[4];
    let determinant = s[0] * minor - s[1] * (s[1] * s[5] - s[4] * s[2]) + s[2] * (s[1] * s[4] - s[3] * s[2]);
    minor / determinant
}

/// Computes the stiffness along z with free rotations, `1/(K⁻¹)_zz`; it is at least 0, and 0 if the block of the
/// rotations is singular.
#[inline(always)]
pub(super) fn vertical_schur<V: Real>(k: &[V; 6]) -> V {
    let (zero, two) = (k[0].splat(0.0), k[0].splat(2.0));
    let minor = k[3] * k[5] - k[4] * k[4];
    let taken = (k[1] * k[1] * k[5] - two * k[1] * k[2] * k[4] + k[2] * k[2] * k[3]) / minor;
    (k[0] - taken).larger(zero).select(minor.exceeds(zero), zero)
}
