//! Real roots of polynomials.
//!
//! The companion matrix of a linear algebra library would give them too, but its iteration rounds differently on different
//! processors; here every operation is a plain one.

/// Returns the real roots of a polynomial, in ascending order; `coefficients` begin with the constant. Where the polynomial touches
/// zero to rounding without crossing it, the point is returned once.
///
/// Between two roots of the derivative, the polynomial is monotone and has at most one root, which bisection finds.
pub(super) fn real_roots(coefficients: &[f64]) -> Vec<f64> {
    let largest = coefficients.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    let degree = coefficients.iter().rposition(|value| value.abs() > 1e-14 * largest);
    let Some(degree) = degree.filter(|&degree| degree > 0) else {
        return Vec::new();
    };
    let coefficients = &coefficients[..=degree];
    if degree == 1 {
        return vec![-coefficients[0] / coefficients[1]];
    }
    let derivative: Vec<f64> = coefficients
        .iter()
        .enumerate()
        .skip(1)
        .map(|(power, value)| power as f64 * value)
        .collect();
    // No root is farther from 0 than this.
    let bound = 1.0
        + coefficients[..degree]
            .iter()
            .fold(0.0f64, |most, value| most.max((value / coefficients[degree]).abs()));
    let inner = real_roots(&derivative);
    let stations: Vec<f64> = std::iter::once(-bound).chain(inner).chain([bound]).collect();
    let mut roots: Vec<f64> = Vec::new();
    for pair in stations.windows(2) {
        let (low, high) = (value(coefficients, pair[0]), value(coefficients, pair[1]));
        if low == 0.0 {
            roots.push(pair[0]);
        } else if high != 0.0 && low.signum() != high.signum() {
            roots.push(bisected(coefficients, [pair[0], pair[1]], low));
        }
    }
    // A root of even multiplicity: an extremum at zero.
    for &station in &stations[1..stations.len() - 1] {
        let magnitude = coefficients
            .iter()
            .rev()
            .fold(0.0, |sum, value| sum * station.abs() + value.abs());
        if value(coefficients, station).abs() < 1e-11 * magnitude {
            roots.push(station);
        }
    }
    roots.sort_by(f64::total_cmp);
    roots.dedup();
    roots
}

fn value(coefficients: &[f64], at: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, value| sum * at + value)
}

/// Halves an interval at whose ends the polynomial has different signs until its ends are neighbouring doubles.
fn bisected(coefficients: &[f64], [mut low, mut high]: [f64; 2], at_low: f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        let found = value(coefficients, middle);
        if found == 0.0 {
            return middle;
        }
        if found.signum() == at_low.signum() {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_of_known_polynomials() {
        // (x − 1)(x − 2)(x − 3)(x² + 1)
        let roots = real_roots(&[-6.0, 11.0, -12.0, 12.0, -6.0, 1.0]);
        assert_eq!(roots.len(), 3);
        for (root, wanted) in roots.iter().zip([1.0, 2.0, 3.0]) {
            assert!((root - wanted).abs() < 1e-12);
        }
        // (x − 1)²(x + 2)
        let roots = real_roots(&[2.0, -3.0, 0.0, 1.0]);
        assert!(roots.iter().any(|root| (root - 1.0).abs() < 1e-7));
        assert!(roots.iter().any(|root| (root + 2.0).abs() < 1e-12));
        assert!(real_roots(&[1.0, 0.0, 1.0]).is_empty());
        assert!(real_roots(&[5.0]).is_empty() && real_roots(&[]).is_empty());
        assert_eq!(real_roots(&[0.0, 0.0, 1.0]), [0.0]);
    }
}
