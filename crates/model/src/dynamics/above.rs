//! Proof that all natural frequencies are above a limit (docs/model.md, section 15.8).

use super::DynamicsModel;
use super::displacement::{Coordinates, Displacement, Row, add_square, column, lift, times};
use super::legs::{DynamicsInputs, MovingLeg};
use crate::enclosure::{EnclosedNumber, TaylorModel};
use crate::lanes::{Real, dot, scaled, sum};
use crate::spatial::{LEGS, inverse_factor};
use crate::strength::LegStiffness;

/// Coordinates in which the stiffness in the middle of a box is the identity.
///
/// In the coordinates of the platform, a manipulator that is stiff in one direction and soft in another has a matrix whose small eigenvalue
/// is a difference of large entries, and an enclosure of these loses it. Here, rows are brought to the same size before they are squared.
#[derive(Clone, Copy)]
struct Even(Displacement<EnclosedNumber>);

impl Even {
    /// Returns the coordinates for a stiffness, given as an upper triangle; those of the platform where it is not positive definite in the
    /// middle.
    fn of_stiffness(stiffness: &[EnclosedNumber; 6]) -> Self {
        let rows = inverse_factor(&stiffness.map(|entry| entry.0.constant));
        let [first, second, third] = rows.unwrap_or([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        let columns = [0, 1, 2].map(|k| [first[k], second[k], third[k]]);
        Self(columns.map(|row| row.map(|entry| EnclosedNumber(TaylorModel::exactly(entry)))))
    }

    /// Returns the displacements out of the plane, and the forces of a leg, at the point where its force and moments are almost decoupled; at
    /// `P` if none is known.
    fn where_decoupled(self, stiffness: &LegStiffness<EnclosedNumber>) -> [Displacement<EnclosedNumber>; 2] {
        let (moved, stiffness) = match &stiffness.at_centre {
            Some((centre, at_centre)) => ([lift(&self.0, *centre), self.0[1], self.0[2]], at_centre),
            None => (self.0, &stiffness.at_platform),
        };
        [moved, times(stiffness, &moved)]
    }

    /// Encloses the stiffness in the plane.
    fn in_plane(
        self,
        inputs: &DynamicsInputs<EnclosedNumber>,
        legs: &[MovingLeg<EnclosedNumber>; LEGS],
    ) -> [EnclosedNumber; 6] {
        let one = inputs.legs.along[0].splat(1.0);
        let mut stiffness = [one.splat(0.0); 6];
        for (leg, along) in legs.iter().zip(inputs.legs.along) {
            add_square(&mut stiffness, &self.of(&leg.wrench), one / along);
        }
        stiffness
    }

    /// Encloses the stiffness out of the plane.
    fn out_of_plane(self, inputs: &DynamicsInputs<EnclosedNumber>) -> [EnclosedNumber; 6] {
        let mut sum = [inputs.legs.along[0].splat(0.0); 6];
        for leg in &inputs.legs.stiffness {
            let [moved, forces] = self.where_decoupled(leg);
            let pairs = [[0, 0], [0, 1], [0, 2], [1, 1], [1, 2], [2, 2]];
            for (sum, [i, k]) in sum.iter_mut().zip(pairs) {
                *sum = *sum + dot(&column(&moved, i), &column(&forces, k));
            }
        }
        sum
    }
}

impl Coordinates<EnclosedNumber> for Even {
    const AT_SHARES: bool = true;

    fn of(self, row: &Row<EnclosedNumber>) -> Row<EnclosedNumber> {
        let [x, y, z] = self.0;
        sum(&sum(&scaled(&x, row[0]), &scaled(&y, row[1])), &scaled(&z, row[2]))
    }

    fn platform(self, _: EnclosedNumber) -> Displacement<EnclosedNumber> {
        self.0
    }

    fn forces(self, stiffness: &LegStiffness<EnclosedNumber>) -> Displacement<EnclosedNumber> {
        let [_, forces] = self.where_decoupled(stiffness);
        let Some((centre, _)) = &stiffness.at_centre else {
            return forces;
        };
        let [force, first, second] = forces;
        [
            force,
            sum(&first, &scaled(&force, centre.y)),
            sum(&second, &scaled(&force, -centre.x)),
        ]
    }
}

impl DynamicsModel {
    /// Encloses both blocks of `K − (2πf)² M` over a box of poses, as upper triangles in some coordinates: they are positive definite where
    /// all natural frequencies are above `f`.
    pub fn enclose_stiffness_above(
        &self,
        inputs: &DynamicsInputs<EnclosedNumber>,
        legs: &[MovingLeg<EnclosedNumber>; LEGS],
        frequency: f64,
    ) -> [[EnclosedNumber; 6]; 2] {
        let rate = 2.0 * std::f64::consts::PI * frequency;
        let less = |stiffness: [EnclosedNumber; 6], mass: [EnclosedNumber; 6]| {
            let square = stiffness[0].splat(rate * rate);
            std::array::from_fn(|entry| stiffness[entry] - square * mass[entry])
        };
        let in_plane = Even::of_stiffness(&inputs.legs.in_plane());
        let out_of_plane = Even::of_stiffness(&inputs.legs.out_of_plane());
        [
            less(
                in_plane.in_plane(inputs, legs),
                self.mass_in_plane(inputs, legs, in_plane),
            ),
            less(
                out_of_plane.out_of_plane(inputs),
                self.mass_out_of_plane(inputs, legs, out_of_plane),
            ),
        ]
    }
}
