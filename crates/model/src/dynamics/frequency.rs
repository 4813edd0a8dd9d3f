//! The lowest natural frequency of a stiffness with a mass (docs/model.md, section 15.4).

use crate::lanes::Real;

/// Returns the natural frequency of the softest vibration of a block with its mass, both as upper triangles \[Hz\]; no number where the
/// stiffness is not positive definite.
#[inline(always)]
pub(super) fn lowest_frequency<V: Real>(stiffness: &[V; 6], mass: &[V; 6]) -> V {
    let compliance_of_mass = reduced(stiffness, mass);
    let largest = largest_eigenvalue(compliance_of_mass);
    let one = largest.splat(1.0);
    one / (largest.sqrt() * largest.splat(2.0 * std::f64::consts::PI))
}

/// Returns `L⁻¹ M L⁻ᵀ` of a mass, with the Cholesky factor `L` of a stiffness.
#[inline(always)]
fn reduced<V: Real>(k: &[V; 6], m: &[V; 6]) -> [V; 6] {
    let factor = V::cholesky(k);
    // Columns of `L⁻¹ M`, and then rows.
    let left = [
        forward(&factor, [m[0], m[1], m[2]]),
        forward(&factor, [m[1], m[3], m[4]]),
        forward(&factor, [m[2], m[4], m[5]]),
    ];
    let rows = [
        forward(&factor, [left[0][0], left[1][0], left[2][0]]),
        forward(&factor, [left[0][1], left[1][1], left[2][1]]),
        forward(&factor, [left[0][2], left[1][2], left[2][2]]),
    ];
    [rows[0][0], rows[0][1], rows[0][2], rows[1][1], rows[1][2], rows[2][2]]
}

/// Returns the solution of `L x = b` with a lower triangle, given by its columns.
#[inline(always)]
fn forward<V: Real>(&[a, b, c, d, e, f]: &[V; 6], [x, y, z]: [V; 3]) -> [V; 3] {
    let first = x / a;
    let second = (y - b * first) / d;
    let third = (z - c * first - e * second) / f;
    [first, second, third]
}

/// Sweeps of the rotations; the third one already leaves nothing but rounding.
const SWEEPS: usize = 5;

/// Returns the largest eigenvalue of a symmetric matrix, given as an upper triangle, by Jacobi's rotations.
#[inline(always)]
fn largest_eigenvalue<V: Real>(matrix: [V; 6]) -> V {
    let [mut a, mut b, mut c, mut d, mut e, mut f] = matrix;
    for _ in 0..SWEEPS {
        (a, d, b, c, e) = rotated(a, d, b, c, e);
        (a, f, c, b, e) = rotated(a, f, c, b, e);
        (d, f, e, b, c) = rotated(d, f, e, b, c);
    }
    a.larger(d.larger(f))
}

/// Makes the entry `off` between two diagonal entries 0; `p` and `q` are the entries of both with the third coordinate.
#[inline(always)]
fn rotated<V: Real>(first: V, second: V, off: V, p: V, q: V) -> (V, V, V, V, V) {
    let (zero, one) = (first.splat(0.0), first.splat(1.0));
    let is_off = off.abs().exceeds(zero);
    let theta = (second - first) / (off + off);
    let tangent = one / (theta.abs() + (theta * theta + one).sqrt());
    let tangent = tangent.select(theta.at_least(zero), -tangent).select(is_off, zero);
    let cosine = one / (tangent * tangent + one).sqrt();
    let sine = tangent * cosine;
    (
        first - tangent * off,
        second + tangent * off,
        zero,
        cosine * p - sine * q,
        sine * p + cosine * q,
    )
}
