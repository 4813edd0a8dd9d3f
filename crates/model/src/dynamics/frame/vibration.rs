//! The lowest natural frequency of a platform with three legs, which meet in the platform alone: each is factorized by itself.

use nalgebra::{Cholesky, DMatrix, Dyn, Matrix3, MatrixXx3};

use super::OF_PLATFORM;
use crate::dynamics::frequency::lowest_frequency;

/// Relative change of a frequency at which the iteration ends.
const CONVERGED: f64 = 1e-12;

/// Most steps of the iteration.
const STEPS: usize = 100;

/// The platform with its legs.
///
/// No product of matrices here has more than three rows or columns on one side. nalgebra computes larger ones with fused multiply-add where
/// the processor has it.
pub(super) struct Frame {
    mass: Matrix3<f64>,
    /// Stiffness at `P` at rest.
    stiffness: Matrix3<f64>,
    legs: Vec<Leg>,
}

/// A leg whose stiffness is factorized.
struct Leg {
    /// Factor of the stiffness of its own coordinates.
    factor: Cholesky<f64, Dyn>,
    /// Displacements of its own coordinates for a unit of each coordinate of the platform, at rest.
    at_rest: MatrixXx3<f64>,
    mass: DMatrix<f64>,
}

/// Three displacements of the frame: of the platform, and of the own coordinates of each leg.
struct Displacements {
    platform: Matrix3<f64>,
    legs: Vec<MatrixXx3<f64>>,
}

impl Frame {
    /// Returns a platform with a mass and without legs.
    pub fn new(mass: Matrix3<f64>) -> Self {
        Self {
            mass,
            stiffness: Matrix3::zeros(),
            legs: Vec::new(),
        }
    }

    /// Adds a leg with its stiffness and mass, of which the coordinates of the platform come first; `None` if it is a mechanism.
    pub fn add(&mut self, [stiffness, mass]: [DMatrix<f64>; 2]) -> Option<()> {
        let own = stiffness.nrows() - OF_PLATFORM;
        let coupling = stiffness.fixed_columns::<3>(0).rows(OF_PLATFORM, own).into_owned();
        let factor = Cholesky::new(stiffness.view((OF_PLATFORM, OF_PLATFORM), (own, own)).into_owned())?;
        let at_rest = -factor.solve(&coupling);
        self.stiffness += stiffness.fixed_view::<3, 3>(0, 0) + coupling.tr_mul(&at_rest);
        self.legs.push(Leg { factor, at_rest, mass });
        Some(())
    }

    /// Returns the lowest natural frequency \[Hz\]; `None` at a singular pose. A subspace of three displacements is iterated, which begins
    /// with those of the platform at rest.
    pub fn lowest_frequency(&self) -> Option<f64> {
        let factor = self.stiffness.cholesky()?;
        let mut shapes = Displacements {
            platform: Matrix3::identity(),
            legs: self.legs.iter().map(|leg| leg.at_rest.clone()).collect(),
        };
        let mut last = f64::INFINITY;
        for _ in 0..STEPS {
            let forces = self.inertia(&shapes);
            let next = self.displacements(&factor, &forces);
            let (stiffness, mass) = (next.products(&forces), next.products(&self.inertia(&next)));
            let frequency = lowest_frequency(&upper(&stiffness), &upper(&mass));
            if !frequency.is_finite() {
                return None;
            }
            if (frequency - last).abs() <= CONVERGED * frequency {
                break;
            }
            last = frequency;
            shapes = next.times(&mass.cholesky()?.l().try_inverse()?.transpose());
        }
        Some(last)
    }

    /// Returns the product of the mass with displacements.
    fn inertia(&self, displacements: &Displacements) -> Displacements {
        let mut platform = self.mass * displacements.platform;
        let legs = self.legs.iter().zip(&displacements.legs).map(|(leg, own)| {
            let mut moved = MatrixXx3::zeros(leg.mass.nrows());
            moved.rows_mut(0, OF_PLATFORM).copy_from(&displacements.platform);
            moved.rows_mut(OF_PLATFORM, own.nrows()).copy_from(own);
            let forces = &leg.mass * moved;
            platform += forces.fixed_rows::<3>(0);
            forces.rows(OF_PLATFORM, own.nrows()).into_owned()
        });
        let legs = legs.collect();
        Displacements { platform, legs }
    }

    /// Returns the displacements at rest under forces.
    fn displacements(&self, factor: &Cholesky<f64, nalgebra::U3>, forces: &Displacements) -> Displacements {
        let of_legs = self.legs.iter().zip(&forces.legs);
        let carried: Matrix3<f64> = of_legs.clone().map(|(leg, own)| leg.at_rest.tr_mul(own)).sum();
        let platform = factor.solve(&(forces.platform + carried));
        Displacements {
            platform,
            legs: of_legs
                .map(|(leg, own)| leg.factor.solve(own) + &leg.at_rest * platform)
                .collect(),
        }
    }
}

impl Displacements {
    /// Returns the products of all displacements with forces.
    fn products(&self, forces: &Displacements) -> Matrix3<f64> {
        let of_legs = self.legs.iter().zip(&forces.legs);
        let sum: Matrix3<f64> = of_legs.map(|(own, forces)| own.tr_mul(forces)).sum();
        self.platform.tr_mul(&forces.platform) + sum
    }

    /// Returns combinations of the displacements.
    fn times(&self, by: &Matrix3<f64>) -> Self {
        Self {
            platform: self.platform * by,
            legs: self.legs.iter().map(|own| own * by).collect(),
        }
    }
}

/// Returns the upper triangle of a symmetric matrix.
fn upper(matrix: &Matrix3<f64>) -> [f64; 6] {
    let at = |row: usize, column: usize| matrix[(row, column)];
    [at(0, 0), at(0, 1), at(0, 2), at(1, 1), at(1, 2), at(2, 2)]
}
