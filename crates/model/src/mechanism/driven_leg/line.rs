//! The rule that gives the line along which a leg transmits a force, and the loads of its bars by a unit force on it.

use std::ops::{Add, Mul, Neg, Sub};

use super::DrivenLeg;
use crate::enclosure::TaylorModel;
use crate::lanes::Real;
use crate::mechanism::{Chain, JointKind, JointPoint};

/// Number to which the rule applies: a double, several at once, or an enclosure.
pub(super) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// Returns 0.
    fn zero(self) -> Self;
}

impl<V: Real> Number for V {
    #[inline(always)]
    fn zero(self) -> Self {
        self.splat(0.0)
    }
}

impl Number for TaylorModel {
    fn zero(self) -> Self {
        TaylorModel::exactly(0.0)
    }
}

/// A chain in its distal axes: the origin is `C_i`, and the x axis leads along the distal bar.
pub(super) struct DistalGeometry<T> {
    /// `C_i − P`.
    pub(super) arm: [T; 2],
    /// Distance from `B_i` to `C_i` along the x axis.
    pub(super) offset: T,
    /// Vector from `A_i` to `B_i`, and unit vector along it.
    pub(super) proximal: Option<[[T; 2]; 2]>,
    /// Unit vector from `A_i` to `C_i`, if the line may lead along it.
    pub(super) chord: Option<[T; 2]>,
    /// Directions of the prismatic joints.
    pub(super) guides: [Option<[T; 2]>; 3],
}

/// Line along which a leg transmits a force, in the distal axes.
pub(super) struct ForceLine<T> {
    /// `u_i`, unit vector along the line.
    pub(super) u: [T; 2],
    /// Transmission `B_ii`.
    pub(super) transmission: T,
    /// Moments of `u_i` on the line about `A_i`, `B_i`, `C_i` and `P`.
    pub(super) moments: [T; 4],
}

#[inline(always)]
fn cross_of<T: Number>(a: [T; 2], b: [T; 2]) -> T {
    a[0] * b[1] - a[1] * b[0]
}

#[inline(always)]
fn dot_of<T: Number>(a: [T; 2], b: [T; 2]) -> T {
    a[0] * b[0] + a[1] * b[1]
}

#[inline(always)]
fn less<T: Number>(a: [T; 2], b: [T; 2]) -> [T; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

impl<T: Number> ForceLine<T> {
    /// Returns the loads of the distal, the proximal and the platform bar by a unit force along the line: of each, the component of the
    /// force along the bar, then the moments about its proximal and its distal end. The component along the platform bar is multiplied by
    /// its length, in the unit of the components of `C_i − P` along and across the distal bar.
    #[inline(always)]
    pub(super) fn loads(&self, geometry: &DistalGeometry<T>, [along, across]: [T; 2], signed_beam: T) -> [[T; 3]; 3] {
        let [x, y] = self.u;
        let [about_a, about_b, about_c, about_p] = self.moments;
        let along_proximal = match geometry.proximal {
            Some([_, direction]) => dot_of(self.u, direction),
            None => x.zero(),
        };
        [
            // A telescopic leg whose beam is longer than the leg begins behind `B_i`.
            [x, about_c + signed_beam * y, about_c],
            [along_proximal, about_a, about_b],
            [x * along - y * across, about_c, about_p],
        ]
    }
}

impl<C: Chain, const DRIVEN: usize> DrivenLeg<C, DRIVEN> {
    /// Returns the line by the rule.
    #[inline(always)]
    pub(super) fn line<T: Number>(geometry: &DistalGeometry<T>) -> ForceLine<T> {
        let zero = geometry.offset.zero();
        let c = [zero, zero];
        let b = [-geometry.offset, zero];
        let a = match geometry.proximal {
            Some([vector, _]) => less(b, vector),
            None => b,
        };
        let at = |point: JointPoint| match point {
            JointPoint::A => a,
            JointPoint::B => b,
            JointPoint::C => c,
        };
        let guide = |joint: usize| geometry.guides[joint].unwrap_or([zero, zero]);
        // The guide on the platform counts along `g`, although `σ` moves the platform against it: this keeps `det A` continuous.
        let normal_to = |joint: usize| {
            let [x, y] = guide(joint);
            if joint == 2 { [y, -x] } else { [-y, x] }
        };
        let (u, through) = match Self::REVOLUTE {
            [true, true] => {
                let along_proximal = geometry.proximal.map_or([zero, zero], |[_, direction]| direction);
                let u = match geometry.chord {
                    Some(chord) if Self::IS_ALONG_CHORD => chord,
                    _ => along_proximal,
                };
                (u, at(Self::POINTS[1]))
            }
            [true, false] => (normal_to(Self::PASSIVE[1]), at(Self::POINTS[0])),
            [false, _] => (normal_to(Self::PASSIVE[0]), at(Self::POINTS[1])),
        };
        let p = [-geometry.arm[0], -geometry.arm[1]];
        let about = |point: [T; 2]| cross_of(less(through, point), u);
        let moments = [about(a), about(b), about(c), about(p)];
        let transmission = match Self::CHAIN.joints[DRIVEN] {
            JointKind::Prismatic => dot_of(u, guide(DRIVEN)),
            JointKind::Revolute => match Self::CHAIN.points[DRIVEN] {
                JointPoint::A => moments[0],
                JointPoint::B => moments[1],
                JointPoint::C => moments[2],
            },
        };
        ForceLine {
            u,
            transmission,
            moments,
        }
    }
}
