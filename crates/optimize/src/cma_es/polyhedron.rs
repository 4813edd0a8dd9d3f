//! Minimum of the largest of several linear functions in a box, by the simplex method.
//!
//! The programs have a few dozen rows and at most a dozen columns, for which a dense tableau is all that is needed.

/// A linear function: its value at a point, and its slopes.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    pub point: Vec<f64>,
    pub value: f64,
    pub slopes: Vec<f64>,
}

/// Largest number of pivots.
const PIVOTS: usize = 500;

/// Entries of the tableau that are smaller count as 0.
const NOTHING: f64 = 1e-12;

impl Plane {
    /// Returns the value of the function at a point.
    pub fn at(&self, x: &[f64]) -> f64 {
        let terms = self.slopes.iter().zip(x.iter().zip(&self.point));
        terms.fold(self.value, |sum, (slope, (x, at))| sum + slope * (x - at))
    }
}

/// Returns the largest value of the functions at a point.
pub fn largest(planes: &[Plane], x: &[f64]) -> f64 {
    planes.iter().map(|plane| plane.at(x)).fold(f64::NEG_INFINITY, f64::max)
}

/// Returns the point between `low` and `high` at which the largest of the functions is smallest.
///
/// The variables of the linear program are the distances from `low`, and the height of the point over a bound from below.
pub fn lowest_point(planes: &[Plane], low: &[f64], high: &[f64]) -> Vec<f64> {
    let count = low.len();
    let height = count;
    let least_of = |plane: &Plane| {
        let falls = plane.slopes.iter().zip(low.iter().zip(high));
        falls.fold(plane.at(low), |sum, (slope, (low, high))| {
            sum + slope.min(0.0) * (high - low)
        })
    };
    let bound = planes.iter().map(least_of).fold(f64::NEG_INFINITY, f64::max);
    // Each row states a basic variable by the others: coefficients, and the right side at the end.
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(planes.len() + count);
    for plane in planes {
        let mut row = plane.slopes.clone();
        row.extend([-1.0, bound - plane.at(low)]);
        rows.push(row);
    }
    for k in 0..count {
        let mut row = vec![0.0; count + 2];
        row[k] = 1.0;
        row[count + 1] = high[k] - low[k];
        rows.push(row);
    }
    let mut cost = vec![0.0; count + 2];
    cost[height] = 1.0;
    let mut tableau = Tableau {
        columns: (0..=count).collect(),
        basis: (count + 1..count + 1 + rows.len()).collect(),
        rows,
        cost,
    };
    tableau.solve(planes.len(), height);
    let mut x = low.to_vec();
    for (row, &variable) in tableau.rows.iter().zip(&tableau.basis) {
        if variable < count {
            x[variable] = (low[variable] + row[count + 1]).clamp(low[variable], high[variable]);
        }
    }
    x
}

struct Tableau {
    /// Variables of the columns and of the rows.
    columns: Vec<usize>,
    basis: Vec<usize>,
    rows: Vec<Vec<f64>>,
    cost: Vec<f64>,
}

impl Tableau {
    fn solve(&mut self, planes: usize, height: usize) {
        let right = self.columns.len();
        // The height over the bound makes every row hold: it enters at the row that is missed most.
        let missed = (0..planes).min_by(|&a, &b| self.rows[a][right].total_cmp(&self.rows[b][right]));
        match missed {
            Some(row) if self.rows[row][right] < 0.0 => self.pivot(row, height),
            _ => return,
        }
        for _ in 0..PIVOTS {
            // Bland's rule, which cannot cycle: the first variable of those that lower the cost, and of those that leave.
            let entering = (0..right)
                .filter(|&column| self.cost[column] < -NOTHING)
                .min_by_key(|&column| self.columns[column]);
            let Some(column) = entering else { return };
            let ratio = |row: usize| self.rows[row][right].max(0.0) / self.rows[row][column];
            let leaving = (0..self.rows.len())
                .filter(|&row| self.rows[row][column] > NOTHING)
                .min_by(|&a, &b| ratio(a).total_cmp(&ratio(b)).then(self.basis[a].cmp(&self.basis[b])));
            let Some(row) = leaving else { return };
            self.pivot(row, column);
        }
    }

    /// Exchanges the variable of a row with that of a column.
    fn pivot(&mut self, row: usize, column: usize) {
        let pivot = self.rows[row][column];
        for (k, entry) in self.rows[row].iter_mut().enumerate() {
            *entry = if k == column { 1.0 / pivot } else { *entry / pivot };
        }
        let pivot_row = self.rows[row].clone();
        let others = self.rows.iter_mut().enumerate().filter(|(other, _)| *other != row);
        for entries in others.map(|(_, entries)| entries).chain([&mut self.cost]) {
            let factor = entries[column];
            if factor != 0.0 {
                for (k, entry) in entries.iter_mut().enumerate() {
                    *entry = if k == column {
                        -factor * pivot_row[k]
                    } else {
                        *entry - factor * pivot_row[k]
                    };
                }
            }
        }
        std::mem::swap(&mut self.basis[row], &mut self.columns[column]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn planes(count: usize) -> impl Strategy<Value = Vec<Plane>> {
        let plane = (
            prop::collection::vec(-1.0..1.0f64, count),
            -1.0..1.0f64,
            prop::collection::vec(-3.0..3.0f64, count),
        );
        let plane = plane.prop_map(|(point, value, slopes)| Plane { point, value, slopes });
        prop::collection::vec(plane, 1..12)
    }

    proptest! {
        /// No point of the box is lower than the one that is found.
        #[test]
        fn no_point_is_lower(planes in planes(3), others in prop::collection::vec(prop::collection::vec(-1.0..1.0f64, 3), 50)) {
            let found = lowest_point(&planes, &[-1.0; 3], &[1.0; 3]);
            prop_assert!(found.iter().all(|x| (-1.0..=1.0).contains(x)));
            let least = largest(&planes, &found);
            // Towards each of the other points, too: near the found point they are as fine as one wishes.
            for other in others {
                for fraction in [1.0, 0.1, 1e-3] {
                    let point: Vec<f64> = found.iter().zip(&other).map(|(a, b)| a + fraction * (b - a)).collect();
                    prop_assert!(largest(&planes, &point) >= least - 1e-9, "{point:?} is lower than {found:?}");
                }
            }
        }
    }

    #[test]
    fn a_pyramid_has_its_lowest_point_at_its_tip() {
        let plane = |x: f64, y: f64| Plane {
            point: vec![0.3, -0.2],
            value: 5.0,
            slopes: vec![x, y],
        };
        let planes = [plane(1.0, 0.0), plane(-1.0, 2.0), plane(-1.0, -20.0)];
        let found = lowest_point(&planes, &[-1.0; 2], &[1.0; 2]);
        assert!(
            (found[0] - 0.3).abs() < 1e-12 && (found[1] + 0.2).abs() < 1e-12,
            "{found:?}"
        );
    }
}
