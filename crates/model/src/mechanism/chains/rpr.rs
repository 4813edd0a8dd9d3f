//! RPR: telescopic leg `A_iC_i` whose length `ρ_i` lies between a fraction of `L_b` and `L_b` (docs/model.md, section 2.3).

use glam::DVec2;

use super::margin_within;
use crate::enclosure::{AxisEnclosure, Interval, MembersEnclosure, PlanarModel, TaylorModel, difference, dot};
use crate::lanes::{Planar, Real};
use crate::mechanism::chain::bodies::{pin, prismatic, revolute};
use crate::mechanism::{
    Assembly, BarLength, BarPosture, Chain, ChainDescription, ChainEnclosure, ChainLanes, ChainPosture, DistalLanes,
    JointKind, JointPoint, LegBody, LegPart, LegSizes, LegToEnclose, LockedKind, LockedLeg, MemberAxis, MemberKind,
    Members, Shortfall, Solved, Within,
};
use crate::spatial::unit;

/// Chain of a telescopic leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RprChain;

impl Chain for RprChain {
    const DESCRIPTION: ChainDescription = ChainDescription {
        name: "RPR",
        joints: [JointKind::Revolute, JointKind::Prismatic, JointKind::Revolute],
        points: [JointPoint::B, JointPoint::B, JointPoint::C],
        has_working_modes: false,
        has_proximal_bar: false,
        proximal: None,
        distal: MemberKind::TelescopicLeg,
        variables: &[],
    };

    fn solve(leg: &LegSizes, c: DVec2, _: DVec2) -> Result<Solved, Shortfall> {
        let chord = c - leg.frame.anchor;
        let length = chord.length();
        if length == 0.0 {
            return Err(Shortfall::degenerate());
        }
        let direction = chord / length;
        Ok(Solved {
            b: leg.frame.anchor,
            proximal: None,
            distal: BarPosture::new(direction, length),
            guides: [None, Some(direction), None],
            within: Within::limits(length, leg.travels[0]),
        })
    }

    fn locked(leg: &LegSizes, driven: usize, value: f64) -> LockedLeg {
        let kind = match driven {
            0 => LockedKind::BaseLine(unit(value).perp()),
            1 => LockedKind::Circle(value),
            _ => LockedKind::PlatformLine(unit(-value).perp()),
        };
        LockedLeg::new(leg.frame.platform_joint, leg.frame.anchor, kind)
    }

    #[inline(always)]
    fn lanes<V: Real>(leg: &LegSizes, position: Planar<V>, arm: Planar<V>) -> ChainLanes<V> {
        let like = position.x;
        let chord = leg.chord(position, arm);
        let length = chord.dot(chord).sqrt();
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        let limit_margin = margin_within(length, leg.travels[0]);
        let u = chord.scaled(one / length);
        let beam = match leg.beam {
            Some(longest) => like.splat(longest),
            None => length,
        };
        let guides = [None, Some(Planar::new(one, zero)), None];
        let chain = ChainLanes::new(u, [arm.dot(u), arm.cross(u)], [length, beam], guides, limit_margin);
        ChainLanes {
            signed_beam: beam,
            reachable: chain.reachable & length.exceeds(zero),
            ..chain
        }
    }

    /// The leg is the vector `v` from `A_i` to `C_i`.
    fn enclose(leg: &LegToEnclose<'_>, position: PlanarModel, arm: PlanarModel) -> ChainEnclosure {
        let chord = leg.frame.vector(position, arm);
        let (one, zero) = (TaylorModel::exactly(1.0), TaylorModel::exactly(0.0));
        let square = dot(chord, chord);
        let shortest = Interval::exactly(leg.settings.telescopic_shortest);
        let length = square.sqrt();
        let to_unit = length.reciprocal();
        let beam = match leg.settings.telescopic_bar {
            BarLength::Current => length,
            BarLength::Longest => one,
        };
        let from_shortest = square - TaylorModel::constant(shortest.square());
        ChainEnclosure {
            signed_beam: beam,
            lever_square: Some(one),
            ..ChainEnclosure::new(
                [from_shortest, one - square, one, one],
                chord.map(|part| part * to_unit),
                [length, beam],
                [None, Some([one, zero]), None],
            )
        }
    }

    /// The rod, of constant length, ends at `C_i`. Where it protrudes behind `A_i`, the axis begins at its inner end.
    fn enclose_members(
        leg: &LegToEnclose<'_>,
        chain: &ChainEnclosure,
        anchor: PlanarModel,
        tip: PlanarModel,
    ) -> MembersEnclosure {
        let shortest = leg.settings.telescopic_shortest;
        // A rod that never protrudes counts as one that ends at `A_i`.
        let inner = if shortest < 0.5 {
            let rod = Interval::exactly(1.0) - Interval::exactly(shortest);
            difference(tip, chain.tangent.map(|part| part.scaled(rod)))
        } else {
            anchor
        };
        MembersEnclosure {
            proximal: None,
            distal: AxisEnclosure {
                points: [anchor, inner, tip],
                direction: chain.tangent,
            },
            rail: None,
        }
    }

    #[inline(always)]
    fn members<V: Real>(leg: &LegSizes, c: Planar<V>, distal: &DistalLanes<V>) -> Members<V> {
        let like = c.x;
        let u = distal.tangent;
        let anchor = Planar::splat(like, leg.frame.anchor);
        let length = c.minus(anchor).dot(u);
        let rod = leg.link - leg.tube;
        let (from, length) = if rod > leg.travels[0][0] {
            // Length by which the rod protrudes behind the joint at the base.
            let behind = (like.splat(rod) - length).larger(like.splat(0.0));
            (anchor.minus(u.scaled(behind)), length + behind)
        } else {
            (anchor, length)
        };
        Members {
            proximal: None,
            distal: MemberAxis {
                from,
                direction: u,
                length,
            },
            rail: None,
        }
    }

    fn bodies(leg: &LegSizes, posture: &ChainPosture, values: [f64; 3], driven: usize) -> Vec<LegBody> {
        let [swing, length, _] = values;
        let (a, c, u) = (posture.a, posture.c, posture.distal.direction);
        let along = |length: f64| a + u * length;
        let mouth = along(leg.tube);
        let kind = MemberKind::TelescopicLeg;
        vec![
            LegBody {
                name: "tube",
                kind,
                origin: a,
                axis: u,
                joint: revolute(swing, driven == 0),
                parts: vec![
                    LegPart::Tube { from: a, to: mouth },
                    pin(a, driven == 0, [kind; 2]),
                    LegPart::Joint {
                        at: mouth,
                        actuated: driven == 1,
                        joins: [kind; 2],
                        kind: JointKind::Prismatic,
                    },
                ],
            },
            LegBody {
                name: "rod",
                kind,
                origin: c,
                axis: u,
                joint: prismatic(length, leg.travels[0], driven == 1),
                parts: vec![
                    LegPart::Rod {
                        from: along(length - (leg.link - leg.tube)),
                        to: c,
                    },
                    pin(c, driven == 2, [kind, MemberKind::PlatformBar]),
                ],
            },
        ]
    }

    fn assembly(leg: &LegSizes) -> Assembly {
        leg.assembly(leg.link, 0.5 * leg.frame.anchor_distance)
    }
}
