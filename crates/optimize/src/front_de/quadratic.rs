//! Local quadratic models, fitted by weighted ridge regression.

use nalgebra::{DMatrix, DVector};

/// Weights with which the linear and the quadratic coefficients are drawn towards 0, relative to the sum of the weights of the data:
/// they decide directions in which the data say nothing.
const RIDGE: [f64; 2] = [1e-6, 1e-4];

/// Number of functions that are fitted together.
const FUNCTIONS: usize = 2;

/// A point with its distance from the centre, and the values of the functions there.
#[derive(Debug, Clone, Copy)]
pub struct Datum<'a> {
    pub point: &'a [f64],
    pub distance: f64,
    pub values: [f64; FUNCTIONS],
}

/// Two functions of the same variables as quadratics around a centre.
#[derive(Debug, Clone)]
pub struct Quadratics {
    centre: Vec<f64>,
    /// Distance in which offsets are measured.
    radius: f64,
    /// Coefficients of each function, in the order of [`fill_terms`].
    coefficients: [DVector<f64>; FUNCTIONS],
    terms: Vec<f64>,
}

impl Quadratics {
    /// Returns the number of coefficients of a quadratic in `variables` variables.
    pub fn count_terms(variables: usize) -> usize {
        (variables + 1) * (variables + 2) / 2
    }

    /// Fits the quadratics to data that are ordered by their distances; the farthest one has almost no weight. Returns `None`
    /// without data, or if the equations have no solution.
    pub fn fit(centre: Vec<f64>, data: &[Datum]) -> Option<Self> {
        let radius = data.last()?.distance.max(1e-6);
        let count = Self::count_terms(centre.len());
        let mut terms = Vec::with_capacity(count);
        let mut normal = DMatrix::zeros(count, count);
        let mut right = [(); FUNCTIONS].map(|()| DVector::<f64>::zeros(count));
        let mut sum = 0.0;
        for datum in data {
            let share = datum.distance / radius;
            let inside = (1.0 - 0.95 * share * share).max(0.0);
            let weight = inside * inside + 1e-3;
            sum += weight;
            fill_terms(&mut terms, &centre, radius, datum.point);
            for i in 0..count {
                let weighted = weight * terms[i];
                for (right, value) in right.iter_mut().zip(datum.values) {
                    right[i] += weighted * value;
                }
                // The factorization reads the lower triangle alone.
                for j in 0..=i {
                    normal[(i, j)] += weighted * terms[j];
                }
            }
        }
        for i in 1..count {
            normal[(i, i)] += sum * RIDGE[usize::from(i > centre.len())];
        }
        let factor = normal.cholesky()?;
        for right in &mut right {
            factor.solve_mut(right);
        }
        let is_finite = right
            .iter()
            .flat_map(|right| right.iter())
            .all(|value| value.is_finite());
        is_finite.then_some(Self {
            centre,
            radius,
            coefficients: right,
            terms,
        })
    }

    /// Returns the values of the functions at a point.
    pub fn at(&mut self, point: &[f64]) -> [f64; FUNCTIONS] {
        fill_terms(&mut self.terms, &self.centre, self.radius, point);
        let terms = &self.terms;
        let value = |coefficients: &DVector<f64>| terms.iter().zip(coefficients.iter()).map(|(term, c)| term * c).sum();
        [value(&self.coefficients[0]), value(&self.coefficients[1])]
    }
}

/// Replaces `terms` by 1, the offsets of a point in units of the radius, and their products.
fn fill_terms(terms: &mut Vec<f64>, centre: &[f64], radius: f64, point: &[f64]) {
    terms.clear();
    terms.push(1.0);
    terms.extend(point.iter().zip(centre).map(|(at, centre)| (at - centre) / radius));
    for i in 1..=centre.len() {
        for j in 1..=i {
            terms.push(terms[i] * terms[j]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two quadratics in two variables are recovered from points around a centre, as far as the ridge lets them.
    #[test]
    fn quadratics_are_recovered() {
        let of = |x: f64, y: f64| [1.0 + 2.0 * x - y + 3.0 * x * y, x * x - 0.5 * y * y];
        let grid = (0..49).map(|i| [0.1 * f64::from(i / 7), 0.1 * f64::from(i % 7)]);
        let mut points: Vec<([f64; 2], f64)> = grid.map(|[x, y]| ([x, y], libm::hypot(x - 0.3, y - 0.3))).collect();
        points.sort_by(|a, b| a.1.total_cmp(&b.1));
        let data: Vec<Datum> = points
            .iter()
            .map(|(point, distance)| Datum {
                point,
                distance: *distance,
                values: of(point[0], point[1]),
            })
            .collect();
        let mut fitted = Quadratics::fit(vec![0.3, 0.3], &data).expect("a fit");
        for (x, y) in [(0.3, 0.3), (0.1, 0.5), (0.62, 0.0)] {
            for (found, expected) in fitted.at(&[x, y]).into_iter().zip(of(x, y)) {
                assert!((found - expected).abs() < 5e-3, "{found} is not {expected}");
            }
        }
    }

    #[test]
    fn a_direction_without_data_is_flat() {
        let points: Vec<[f64; 2]> = (0..12).map(|i| [0.05 * f64::from(i), 1.0]).collect();
        let data: Vec<Datum> = points
            .iter()
            .map(|point| Datum {
                point,
                distance: point[0],
                values: [point[0], 2.0],
            })
            .collect();
        let mut fitted = Quadratics::fit(vec![0.0, 1.0], &data).expect("a fit");
        let [along, beside] = [fitted.at(&[0.2, 1.0])[0], fitted.at(&[0.2, 0.9])[0]];
        assert!((along - 0.2).abs() < 1e-3 && (beside - along).abs() < 1e-3);
    }
}
