//! The least value of a strictly convex quadratic function under linear constraints, by the dual method of Goldfarb and Idnani (1983).
//!
//! In the coordinates `z = Lᵀx` with the Cholesky factor `L` of the Hessian, the answer is the point of a polyhedron that is nearest to a
//! given one. The method starts there and adds violated constraints one by one. A search takes hundreds of steps, each with a dozen
//! variables, of which an interior-point method for large sparse programs would take most of the time.

use nalgebra::{DMatrix, DVector};

use super::convex::ConvexProgram;

/// A violation that is rounding, as a share of the lengths that are compared.
const ROUNDING: f64 = 1e-13;

/// Part of the length of a normal below which it depends on those of other constraints.
const DEPENDENT: f64 = 1e-11;

/// Number of times that the diagonal of a Hessian is increased until it is positive definite, a hundredfold each time.
const SHIFTS: usize = 4;

/// Number of changes of the active constraints, as a multiple of the number of all, after which the method has failed.
const CHANGES: usize = 8;

/// Where a program has its least value.
#[derive(Debug, Clone)]
pub(crate) struct QuadraticSolution {
    /// `x`.
    pub x: DVector<f64>,
    /// Multipliers of `C x ≥ d`, at least 0.
    pub multipliers: Vec<f64>,
}

impl ConvexProgram {
    /// Solves a strictly convex program without equations; `None` if no point satisfies the constraints, if `P` is not positive definite, or
    /// if rounding prevents an answer.
    pub fn solve_strictly(&self) -> Option<QuadraticSolution> {
        debug_assert!(self.equal.is_empty(), "an equation is left out");
        let factor = self.factor()?;
        let normals: Option<Vec<DVector<f64>>> = self
            .at_least
            .iter()
            .map(|(row, _)| factor.solve_lower_triangular(row))
            .collect();
        let normals = normals?;
        let start = -factor.solve_lower_triangular(&self.linear)?;
        let sides: Vec<f64> = self.at_least.iter().map(|(_, side)| *side).collect();
        let mut search = Projection::new(&normals, &sides, start);
        search.run()?;
        search.settle();
        let x = factor.transpose().solve_upper_triangular(&search.z)?;
        let mut multipliers = vec![0.0f64; sides.len()];
        for (place, multiplier) in search.active.iter().zip(&search.multipliers) {
            multipliers[*place] = multiplier.max(0.0);
        }
        let is_finite = x.iter().chain(&multipliers).all(|number| number.is_finite());
        is_finite.then_some(QuadraticSolution { x, multipliers })
    }

    /// Returns the Cholesky factor of `P`, to which as much is added as rounding has taken from its least eigenvalue.
    fn factor(&self) -> Option<DMatrix<f64>> {
        let largest = self.quadratic.diagonal().amax();
        let mut added = 0.0;
        for _ in 0..=SHIFTS {
            let shifted = DMatrix::from_diagonal_element(self.linear.len(), self.linear.len(), added);
            if let Some(factor) = (&self.quadratic + shifted).cholesky() {
                return Some(factor.unpack());
            }
            added = (100.0 * added).max(f64::EPSILON * largest);
        }
        None
    }
}

/// The search for the point of `nᵢᵀz ≥ dᵢ` that is nearest to a start.
struct Projection<'a> {
    normals: &'a [DVector<f64>],
    lengths: Vec<f64>,
    sides: &'a [f64],
    start: DVector<f64>,
    z: DVector<f64>,
    /// Active constraints, with their multipliers.
    active: Vec<usize>,
    multipliers: Vec<f64>,
    /// Orthonormal columns that span the normals of the active constraints, and these normals in their terms.
    basis: Vec<DVector<f64>>,
    triangle: Vec<Vec<f64>>,
}

impl<'a> Projection<'a> {
    fn new(normals: &'a [DVector<f64>], sides: &'a [f64], start: DVector<f64>) -> Self {
        Self {
            normals,
            lengths: normals.iter().map(|normal| normal.norm()).collect(),
            sides,
            z: start.clone(),
            start,
            active: Vec::new(),
            multipliers: Vec::new(),
            basis: Vec::new(),
            triangle: Vec::new(),
        }
    }

    /// Adds violated constraints, the most violated one first, until there is none.
    fn run(&mut self) -> Option<()> {
        let mut left = CHANGES * (self.normals.len() + self.z.len());
        while let Some(next) = self.most_violated() {
            let mut multiplier = 0.0;
            loop {
                left = left.checked_sub(1)?;
                let normal = &self.normals[next];
                let (across, parts) = self.split(normal);
                let rates = self.solve_triangle(&parts);
                let room = across.norm_squared();
                let is_dependent = room.sqrt() <= DEPENDENT * self.lengths[next];
                let missing = self.sides[next] - normal.dot(&self.z);
                let whole = if is_dependent { f64::INFINITY } else { missing / room };
                let (blocking, part) = self.blocking(&rates);
                let step = whole.min(part);
                if !step.is_finite() {
                    return None;
                }
                for (own, rate) in self.multipliers.iter_mut().zip(&rates) {
                    *own -= step * rate;
                }
                multiplier += step;
                if !is_dependent {
                    self.z += &across * step;
                }
                if whole <= part {
                    self.add(next, multiplier, across, parts);
                    break;
                }
                self.remove(blocking);
            }
        }
        Some(())
    }

    /// Returns the constraint that is violated most, as a distance.
    fn most_violated(&self) -> Option<usize> {
        let distance_of_z = self.z.norm();
        let mut most: Option<(f64, usize)> = None;
        for (place, (normal, side)) in self.normals.iter().zip(self.sides).enumerate() {
            let length = self.lengths[place];
            let missing = side - normal.dot(&self.z);
            if missing > ROUNDING * (side.abs() + length * distance_of_z) && !self.active.contains(&place) {
                let distance = if length > 0.0 { missing / length } else { f64::INFINITY };
                if most.is_none_or(|(largest, _)| distance > largest) {
                    most = Some((distance, place));
                }
            }
        }
        most.map(|(_, place)| place)
    }

    /// Returns the part of a vector that is perpendicular to the normals of the active constraints, and its components along the basis. It
    /// is made perpendicular twice, because of rounding.
    fn split(&self, vector: &DVector<f64>) -> (DVector<f64>, Vec<f64>) {
        let mut across = vector.clone();
        let mut parts = vec![0.0; self.basis.len()];
        for _ in 0..2 {
            for (part, direction) in parts.iter_mut().zip(&self.basis) {
                let along = direction.dot(&across);
                across.axpy(-along, direction, 1.0);
                *part += along;
            }
        }
        (across, parts)
    }

    /// Returns the coefficients of the active normals of which a vector in the basis is the sum.
    fn solve_triangle(&self, parts: &[f64]) -> Vec<f64> {
        let mut found = parts.to_vec();
        for place in (0..found.len()).rev() {
            found[place] /= self.triangle[place][place];
            let value = found[place];
            for (other, element) in found[..place].iter_mut().zip(&self.triangle[place]) {
                *other -= element * value;
            }
        }
        found
    }

    /// Returns the active constraint whose multiplier becomes 0 first, and the step to that; the step is infinite if there is none.
    fn blocking(&self, rates: &[f64]) -> (usize, f64) {
        let steps = self.multipliers.iter().zip(rates).enumerate();
        let steps = steps
            .filter(|(_, (_, rate))| **rate > 0.0)
            .map(|(place, (own, rate))| (place, own.max(0.0) / rate));
        steps.fold(
            (0, f64::INFINITY),
            |least, next| if next.1 < least.1 { next } else { least },
        )
    }

    fn add(&mut self, constraint: usize, multiplier: f64, across: DVector<f64>, mut parts: Vec<f64>) {
        let length = across.norm();
        parts.push(length);
        self.basis.push(across / length);
        self.triangle.push(parts);
        self.active.push(constraint);
        self.multipliers.push(multiplier);
    }

    fn remove(&mut self, place: usize) {
        self.active.remove(place);
        self.multipliers.remove(place);
        // The later normals are added again.
        let later = self.active.split_off(place);
        let of_later = self.multipliers.split_off(place);
        self.basis.truncate(place);
        self.triangle.truncate(place);
        for (constraint, multiplier) in later.into_iter().zip(of_later) {
            let (across, parts) = self.split(&self.normals[constraint]);
            self.add(constraint, multiplier, across, parts);
        }
    }

    /// Determines the point and its multipliers from the active constraints, without the rounding of the steps that led there, unless these
    /// constraints depend on each other so much that a multiplier becomes negative.
    fn settle(&mut self) {
        let missing = self
            .active
            .iter()
            .map(|&place| self.sides[place] - self.normals[place].dot(&self.start));
        // `TᵀT λ = d`, with the triangle `T` by columns.
        let mut along: Vec<f64> = missing.collect();
        for place in 0..along.len() {
            let column = &self.triangle[place];
            let known: f64 = along[..place].iter().zip(column).map(|(a, b)| a * b).sum();
            along[place] = (along[place] - known) / column[place];
        }
        let multipliers = self.solve_triangle(&along);
        if multipliers.iter().all(|multiplier| *multiplier >= 0.0) {
            self.multipliers = multipliers;
            self.z.clone_from(&self.start);
            for (part, direction) in along.iter().zip(&self.basis) {
                self.z.axpy(*part, direction, 1.0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_of_a_half_plane_has_the_multiplier_of_its_distance() {
        // The point of x + y ≥ 2 that is nearest to the origin.
        let mut program = ConvexProgram::new(2);
        program.quadratic.fill_with_identity();
        program.at_least.push((DVector::from_vec(vec![1.0, 1.0]), 2.0));
        program.bound_below(0, -5.0);
        let found = program.solve_strictly().expect("the half plane is not empty");
        assert!((found.x[0] - 1.0).abs() < 1e-14 && (found.x[1] - 1.0).abs() < 1e-14);
        assert!((found.multipliers[0] - 1.0).abs() < 1e-14 && found.multipliers[1] == 0.0);
        program.bound_above(0, 0.5);
        program.bound_above(1, 0.5);
        assert!(program.solve_strictly().is_none());
    }

    /// Programs like those of a step, with constraints that occur twice and with more active ones than variables, have the solution of an
    /// interior-point method.
    #[test]
    fn the_solution_is_that_of_an_interior_point_method() {
        let mut state = 7u64;
        let mut number = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let mut solved = 0;
        for case in 0..300 {
            let count = 2 + case % 9;
            let square = DMatrix::from_fn(count, count, |_, _| number());
            let mut program = ConvexProgram::new(count);
            program.quadratic = &square * square.transpose() + DMatrix::identity(count, count) * 0.01;
            program.linear = DVector::from_fn(count, |_, _| number());
            let point = DVector::from_fn(count, |_, _| 0.5 * number());
            for place in 0..4 * count {
                let row = DVector::from_fn(count, |_, _| number());
                // Many pass through one point.
                let room = if place % 3 == 0 { 0.0 } else { 0.3 * number().abs() };
                let side = row.dot(&point) - room;
                program.at_least.push((row.clone(), side));
                if place % 5 == 0 {
                    program.at_least.push((&row * 2.0, 2.0 * side));
                }
                if case % 7 == 0 && place == 3 {
                    program.at_least.push((-row, 0.01 - side));
                }
            }
            for variable in 0..count {
                program.bound_below(variable, -0.5);
                program.bound_above(variable, 0.5);
            }
            match (program.solve_strictly(), program.solve()) {
                (Some(found), Some(expected)) => {
                    solved += 1;
                    assert!((&found.x - &expected).amax() < 1e-7, "case {case}");
                    let rows = program.at_least.iter().zip(&found.multipliers);
                    let pull = rows.fold(DVector::zeros(count), |sum, ((row, _), own)| sum + row * *own);
                    let gradient = &program.quadratic * &found.x + &program.linear;
                    assert!((gradient - pull).amax() < 1e-9, "case {case}");
                    let missed = program.at_least.iter().map(|(row, side)| side - row.dot(&found.x));
                    assert!(missed.fold(f64::NEG_INFINITY, f64::max) < 1e-12, "case {case}");
                }
                (None, None) => {}
                (found, expected) => panic!("case {case}: {found:?}, {expected:?}"),
            }
        }
        assert_eq!(solved, 300 - 43);
    }
}
