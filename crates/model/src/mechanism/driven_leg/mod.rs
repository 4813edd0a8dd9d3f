//! A leg: a chain with one actuated joint. The force that it transmits follows from the two passive joints by one rule, for every
//! chain (docs/model.md, section 2.8).
//!
//! With its actuated joint locked, a leg transmits a force along one line. Two passive revolute joints leave the line through both;
//! a passive prismatic joint leaves the line normal to its direction, through the passive revolute joint.

mod enclosure;
mod lanes;
mod line;

use std::marker::PhantomData;

use glam::DVec2;

use super::joint::{JointKind, JointPoint};
use super::{
    Assembly, Chain, ChainDescription, ChainPosture, Design, DistalLanes, Leg, LegBody, LegLanes, LegPosture,
    LegSettings, LegSizes, LockedLeg, Members, Shortfall, Solved,
};
use crate::lanes::{Planar, Real};
use crate::spatial::cross;
use line::{DistalGeometry, ForceLine};

/// A leg whose joint `DRIVEN` (0, 1, 2 from the base) is driven.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrivenLeg<C, const DRIVEN: usize> {
    sizes: LegSizes,
    chain: PhantomData<C>,
}

impl<C: Chain, const DRIVEN: usize> DrivenLeg<C, DRIVEN> {
    const CHAIN: ChainDescription = C::DESCRIPTION;

    /// The two passive joints.
    const PASSIVE: [usize; 2] = match DRIVEN {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    };

    /// Whether the passive joint of each place is revolute.
    const REVOLUTE: [bool; 2] = [
        matches!(Self::CHAIN.joints[Self::PASSIVE[0]], JointKind::Revolute),
        matches!(Self::CHAIN.joints[Self::PASSIVE[1]], JointKind::Revolute),
    ];

    /// Points of the passive joints.
    const POINTS: [JointPoint; 2] = [
        Self::CHAIN.points[Self::PASSIVE[0]],
        Self::CHAIN.points[Self::PASSIVE[1]],
    ];

    /// Whether the line is that of the distal bar, because both its ends are passive revolute joints.
    const IS_ALONG_DISTAL: bool = Self::REVOLUTE[0]
        && Self::REVOLUTE[1]
        && matches!(Self::POINTS[0], JointPoint::B)
        && matches!(Self::POINTS[1], JointPoint::C);

    /// Whether the line is that from `A_i` to `C_i`.
    const IS_ALONG_CHORD: bool = Self::REVOLUTE[0]
        && Self::REVOLUTE[1]
        && matches!(Self::POINTS[0], JointPoint::A)
        && matches!(Self::POINTS[1], JointPoint::C);

    /// Returns what the leg requires of the platform while its actuated joint is locked at a value \[m or rad\].
    pub(super) fn locked(&self, value: f64) -> LockedLeg {
        C::locked(&self.sizes, DRIVEN, value)
    }

    /// Returns the rigid bodies of the leg, from the base to the platform, for the values of its joints.
    pub(super) fn bodies(&self, posture: &ChainPosture, values: [f64; 3]) -> Vec<LegBody> {
        C::bodies(&self.sizes, posture, values, DRIVEN)
    }

    /// Returns the posture of the chain with the end of the leg at `c`.
    fn posture(&self, c: DVec2, found: &Solved) -> ChainPosture {
        let frame = &self.sizes.frame;
        ChainPosture {
            a: frame.anchor,
            b: found.b,
            c,
            slider: Self::CHAIN.is_on_rails().then(|| frame.from_rail_ends(found.b.into())),
            proximal: found.proximal,
            distal: found.distal,
            beam: self.sizes.beam.unwrap_or(found.distal.offset.abs()),
            guides: found.guides,
            limit_margin: found.within.margin,
        }
    }

    /// Solves the inverse kinematics like [`Leg::inverse`], also beyond the limits of joints; tells which limit is violated, if one
    /// is.
    ///
    /// # Errors
    /// Returns the [`Shortfall`] if the working mode has no real solution, or if a direction of the leg is undefined.
    pub(super) fn solve(&self, c: DVec2, arm: DVec2) -> Result<(LegPosture, Option<Shortfall>), Shortfall> {
        let found = C::solve(&self.sizes, c, arm)?;
        let chain = self.posture(c, &found);
        let tangent = chain.distal.direction;
        let enter = |vector: DVec2| [tangent.dot(vector), cross(tangent, vector)];
        let chord = chain.c - chain.a;
        let line = if Self::IS_ALONG_DISTAL {
            let across = cross(arm, tangent);
            let lever = |point: DVec2| cross(chain.c - point, tangent);
            ForceLine {
                u: [1.0, 0.0],
                transmission: match chain.guides[DRIVEN] {
                    Some(guide) => tangent.dot(guide),
                    None => lever(chain.a),
                },
                moments: [lever(chain.a), 0.0, 0.0, across],
            }
        } else {
            Self::line(&DistalGeometry {
                arm: enter(arm),
                offset: chain.distal.offset,
                proximal: chain
                    .proximal
                    .map(|bar| [enter(bar.direction * bar.offset), enter(bar.direction)]),
                chord: Self::IS_ALONG_CHORD.then(|| enter(chord / chord.length())),
                guides: chain.guides.map(|guide| guide.map(enter)),
            })
        };
        let [x, y] = line.u;
        let [about_a, about_b, about_c, moment] = line.moments;
        let posture = LegPosture {
            u: tangent * x + tangent.perp() * y,
            moment,
            transmission: line.transmission,
            about: [about_a, about_b, about_c],
            arm,
            chain,
        };
        Ok((posture, found.within.beyond))
    }
}

impl<C: Chain, const DRIVEN: usize> Leg for DrivenLeg<C, DRIVEN> {
    const MAY_BE_ON_RAILS: bool = Self::CHAIN.is_on_rails();

    fn new(design: &Design, settings: &LegSettings, index: usize) -> Self {
        Self {
            sizes: LegSizes::new(design, settings, index),
            chain: PhantomData,
        }
    }

    fn inverse(&self, c: DVec2, arm: DVec2) -> Result<LegPosture, Shortfall> {
        let (posture, beyond) = self.solve(c, arm)?;
        beyond.map_or(Ok(posture), Err)
    }

    #[inline(always)]
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> LegLanes<V> {
        Self::add_line(C::lanes(&self.sizes, position, arm))
    }

    #[inline(always)]
    fn members<V: Real>(&self, c: Planar<V>, distal: &DistalLanes<V>) -> Members<V> {
        C::members(&self.sizes, c, distal)
    }

    #[inline(always)]
    fn sizes(&self) -> &LegSizes {
        &self.sizes
    }

    fn assembly(&self) -> Assembly {
        C::assembly(&self.sizes)
    }
}
