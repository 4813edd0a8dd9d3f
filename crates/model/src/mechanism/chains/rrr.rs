//! RRR: crank `A_iB_i` of length `L_a` and link `B_iC_i` of length `L_b` (docs/model.md, section 2.4).

use glam::DVec2;

use super::{angle_of, box_about, crank_body, enclosed_members_on_crank, link_body, members_on_crank, wrapped};
use crate::enclosure::{AxisEnclosure, Interval, MembersEnclosure, PlanarModel, TaylorModel, difference, dot};
use crate::lanes::{Planar, Real};
use crate::mechanism::{
    Assembly, BarPosture, Chain, ChainDescription, ChainEnclosure, ChainLanes, ChainPosture, Design, DesignVariable,
    DistalLanes, JointKind, JointPoint, LegBody, LegFrame, LegFrameEnclosure, LegSettings, LockedKind, LockedLeg,
    MemberAxis, MemberKind, Members, ProximalLanes, ReachReason, Shortfall, Solved, Travel,
};
use crate::spatial::unit;

/// Chain of a leg with a crank and a link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RrrChain {
    frame: LegFrame,
    crank: f64,
    link: f64,
}

impl RrrChain {
    /// Returns `(L_a² − L_b²)/2` \[m²\], which is 0 for equal lengths.
    fn skew(&self) -> f64 {
        0.5 * (self.crank - self.link) * (self.crank + self.link)
    }
}

impl Chain for RrrChain {
    const DESCRIPTION: ChainDescription = ChainDescription {
        name: "RRR",
        joints: [JointKind::Revolute; 3],
        points: [JointPoint::A, JointPoint::B, JointPoint::C],
        has_working_modes: true,
        has_proximal_bar: true,
        proximal: Some(MemberKind::Crank),
        distal: MemberKind::Link,
        variables: &[DesignVariable::ProximalLength],
    };

    fn new(frame: LegFrame, design: &Design, _: &LegSettings) -> Self {
        Self {
            frame,
            crank: design.proximal_length(),
            link: design.link_length(),
        }
    }

    fn frame(&self) -> &LegFrame {
        &self.frame
    }

    fn solve(&self, c: DVec2, _: DVec2) -> Result<Solved, Shortfall> {
        let chord = c - self.frame.anchor;
        let distance = chord.length();
        let shortest = (self.crank - self.link).abs();
        let mut limit_margin = self.crank + self.link - distance;
        if shortest > 0.0 {
            limit_margin = limit_margin.min(distance - shortest);
        }
        if limit_margin < 0.0 {
            return Err(Shortfall {
                limit_margin,
                reason: ReachReason::OutOfReach,
            });
        }
        if distance == 0.0 {
            return Err(Shortfall {
                limit_margin: 0.0,
                reason: ReachReason::Degenerate,
            });
        }
        let foot = 0.5 * distance + self.skew() / distance;
        let elbow = self.frame.sign * ((self.crank - foot) * (self.crank + foot)).max(0.0).sqrt();
        let crank = chord * (foot / distance) + chord.perp() / distance * elbow;
        let b = self.frame.anchor + crank;
        let posture = ChainPosture {
            a: self.frame.anchor,
            b,
            c,
            slider: None,
            proximal: Some(BarPosture {
                direction: crank / self.crank,
                offset: self.crank,
            }),
            distal: BarPosture {
                direction: (c - b) / self.link,
                offset: self.link,
            },
            beam: self.link,
            guides: [None; 3],
            limit_margin,
        };
        Ok((posture, None))
    }

    fn locked(&self, driven: usize, value: f64) -> LockedLeg {
        let (a, c) = (self.frame.anchor, self.frame.platform_joint);
        let (platform, base, radius) = match driven {
            0 => (c, a + unit(value) * self.crank, self.link),
            1 => (c, a, (DVec2::X * self.crank + unit(value) * self.link).length()),
            _ => (c - unit(-value) * self.link, a, self.crank),
        };
        LockedLeg {
            platform,
            base,
            kind: LockedKind::Circle(radius),
        }
    }

    #[inline(always)]
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> ChainLanes<V> {
        let like = position.x;
        let chord = position.plus(arm.minus(Planar::splat(like, self.frame.anchor)));
        let square = chord.dot(chord);
        let (zero, one, half) = (like.splat(0.0), like.splat(1.0), like.splat(0.5));
        let (crank, link) = (like.splat(self.crank), like.splat(self.link));
        // Distance of the foot of B on the chord from A, as a fraction of the chord. With equal lengths it is one half, and a
        // division is saved.
        let skew = self.skew();
        let foot = if skew == 0.0 {
            half
        } else {
            half + like.splat(skew) / square
        };
        let rest = one - foot;
        // Square of the ratio of the elbow's distance from the chord to the chord's length. Out of reach it is negative
        // and its root is NaN, for which every comparison is false.
        let ratio = (like.splat(self.crank * self.crank) - foot * foot * square) / square;
        let elbow = like.splat(self.frame.sign) * ratio.sqrt();
        let to_unit = like.splat(1.0 / self.link);
        let tangent = chord.scaled(rest).minus(chord.perp().scaled(elbow)).scaled(to_unit);
        // (B − A) × u = (B − A) × (C − A)/L, to which only the component of B − A normal to the chord contributes.
        let lever = -(elbow * square * to_unit);

        let longest = self.crank + self.link;
        let shortest = (self.crank - self.link).abs();
        let distance = square.sqrt();
        let mut reachable = like.splat(longest * longest).at_least(square) & square.exceeds(zero);
        let mut limit_margin = like.splat(longest) - distance;
        if shortest > 0.0 {
            reachable = reachable & square.at_least(like.splat(shortest * shortest));
            limit_margin = limit_margin.smaller(distance - like.splat(shortest));
        }
        let vector = Planar::new((foot * rest - ratio) * square * to_unit, -lever);
        ChainLanes {
            tangent,
            along: arm.dot(tangent),
            across: arm.cross(tangent),
            offset: link,
            beam: link,
            signed_beam: link,
            proximal: Some(ProximalLanes {
                vector,
                direction: vector.scaled(like.splat(1.0 / self.crank)),
                length: crank,
                share: one,
                distal_share: like.splat(self.link / self.crank),
            }),
            guides: [None; 3],
            limit_margin: limit_margin.larger(zero).select(reachable, limit_margin.smaller(zero)),
            reachable,
        }
    }

    /// With lengths in units of `L_b`, `v` leads from `A_i` to `C_i`, `S = |v|²`, `λ = L_a/L_b`, and `f = 1/2 + (λ² − 1)/(2S)` is
    /// the foot of `B_i`: `u = (1 − f) v − τ v⊥` with `τ = σ √(λ²/S − f²)`.
    fn enclose(
        frame: &LegFrameEnclosure,
        design: &Design,
        _: &LegSettings,
        position: PlanarModel,
        arm: PlanarModel,
    ) -> ChainEnclosure {
        let [x, y] = frame.vector(position, arm);
        let one = TaylorModel::exactly(1.0);
        let square = dot([x, y], [x, y]);
        let chain = |reach, tangent, vector, lever_square| ChainEnclosure {
            reach,
            tangent,
            offset: one,
            beam: one,
            signed_beam: one,
            slider: None,
            proximal: Some(frame.crank(vector)),
            guides: [None; 3],
            lever_square: Some(lever_square),
        };
        if design.proximal_length() == design.link_length() {
            let elbow = one - square.times(0.25);
            let turn = (square.reciprocal() - one.times(0.25)).sqrt().times(frame.sign);
            let tangent = [x.times(0.5) + turn * y, y.times(0.5) - turn * x];
            let vector = [square.times(0.5) - one, turn * square];
            return chain([square, elbow, one, one], tangent, vector, square * elbow);
        }
        let half = Interval::exactly(0.5);
        let crank = frame.proximal.square();
        let skew = (crank - Interval::exactly(1.0)) * half;
        let inverse = square.reciprocal();
        let foot = inverse.scaled(skew).plus(half);
        // λ² S − (S f)², the square of twice the area of the triangle A_iB_iC_i.
        let along = square.times(0.5).plus(skew);
        let lever_square = square.scaled(crank) - along.squared();
        let turn = (inverse.scaled(crank) - foot.squared()).sqrt().times(frame.sign);
        let rest = one - foot;
        let longest = (frame.proximal + Interval::exactly(1.0)).square();
        let shortest = (frame.proximal - Interval::exactly(1.0)).square();
        let tangent = [rest * x + turn * y, rest * y - turn * x];
        let vector = [
            square.times(0.5).plus(-((crank + Interval::exactly(1.0)) * half)),
            turn * square,
        ];
        let reach = [
            square,
            TaylorModel::constant(longest) - square,
            square.plus(-shortest),
            one,
        ];
        chain(reach, tangent, vector, lever_square)
    }

    fn enclose_members(
        frame: &LegFrameEnclosure,
        _: &Design,
        _: &LegSettings,
        chain: &ChainEnclosure,
        anchor: PlanarModel,
        tip: PlanarModel,
    ) -> MembersEnclosure {
        let elbow = difference(tip, chain.tangent);
        let link = AxisEnclosure::between(elbow, tip, chain.tangent);
        enclosed_members_on_crank(frame, [anchor, elbow], link)
    }

    #[inline(always)]
    fn members<V: Real>(&self, c: Planar<V>, distal: &DistalLanes<V>) -> Members<V> {
        let link = MemberAxis::back_from(c, distal.tangent, c.x.splat(self.link));
        members_on_crank(&self.frame, self.crank, link.from, link)
    }

    fn joint_values(&self, posture: &ChainPosture, arm: DVec2) -> [f64; 3] {
        let (crank, link) = (angle_of(posture.b - posture.a), angle_of(posture.distal.direction));
        [
            crank,
            wrapped(link - crank),
            wrapped(self.frame.orientation(arm) - link),
        ]
    }

    fn joint_limits(&self) -> [Option<[f64; 2]>; 3] {
        [None; 3]
    }

    fn bodies(&self, posture: &ChainPosture, arm: DVec2, driven: usize) -> Vec<LegBody> {
        let [crank, elbow, _] = self.joint_values(posture, arm);
        vec![
            crank_body([posture.a, posture.b], crank, driven == 0),
            link_body([posture.b, posture.c], MemberKind::Crank, elbow, driven),
        ]
    }

    fn travels(&self, _: &ChainPosture) -> Vec<Travel> {
        Vec::new()
    }

    fn reach_box(&self) -> [DVec2; 2] {
        box_about([self.frame.anchor; 2], self.crank + self.link)
    }

    fn assembly(&self) -> Assembly {
        Assembly {
            value: 0.5 * (self.crank + self.link) + self.frame.arm_length,
            threshold: 0.5 * self.frame.anchor_distance,
        }
    }
}
