//! RRR: crank `A_iB_i` of length `L_a` and link `B_iC_i` of length `L_b` (docs/model.md, section 2.4).

use glam::DVec2;

use crate::enclosure::{Interval, PlanarModel, TaylorModel, dot};
use crate::lanes::{Planar, Real};
use crate::mechanism::{
    Assembly, BarPosture, Chain, ChainDescription, ChainEnclosure, ChainLanes, DesignVariable, JointKind, JointPoint,
    LegSizes, LegToEnclose, LockedKind, LockedLeg, MemberKind, ProximalLanes, Shortfall, Solved, Within,
};
use crate::spatial::unit;

/// Chain of a leg with a crank and a link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RrrChain;

/// Returns `(L_a² − L_b²)/2` \[m²\], which is 0 for equal lengths.
fn skew_of(leg: &LegSizes) -> f64 {
    0.5 * (leg.proximal - leg.link) * (leg.proximal + leg.link)
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

    fn solve(leg: &LegSizes, c: DVec2, _: DVec2) -> Result<Solved, Shortfall> {
        let chord = c - leg.frame.anchor;
        let distance = chord.length();
        let shortest = (leg.proximal - leg.link).abs();
        let mut margin = leg.proximal + leg.link - distance;
        if shortest > 0.0 {
            margin = margin.min(distance - shortest);
        }
        if margin < 0.0 {
            return Err(Shortfall::out_of_reach(margin));
        }
        if distance == 0.0 {
            return Err(Shortfall::degenerate());
        }
        let foot = 0.5 * distance + skew_of(leg) / distance;
        let elbow = leg.frame.sign * ((leg.proximal - foot) * (leg.proximal + foot)).max(0.0).sqrt();
        let crank = chord * (foot / distance) + chord.perp() / distance * elbow;
        let b = leg.frame.anchor + crank;
        Ok(Solved {
            b,
            proximal: Some(BarPosture::new(crank / leg.proximal, leg.proximal)),
            distal: BarPosture::new((c - b) / leg.link, leg.link),
            guides: [None; 3],
            within: Within { margin, beyond: None },
        })
    }

    fn locked(leg: &LegSizes, driven: usize, value: f64) -> LockedLeg {
        let (a, c) = (leg.frame.anchor, leg.frame.platform_joint);
        let (crank, link) = (leg.proximal, leg.link);
        let (platform, base, radius) = match driven {
            0 => (c, a + unit(value) * crank, link),
            1 => (c, a, (DVec2::X * crank + unit(value) * link).length()),
            _ => (c - unit(-value) * link, a, crank),
        };
        LockedLeg::new(platform, base, LockedKind::Circle(radius))
    }

    #[inline(always)]
    fn lanes<V: Real>(leg: &LegSizes, position: Planar<V>, arm: Planar<V>) -> ChainLanes<V> {
        let like = position.x;
        let chord = leg.chord(position, arm);
        let square = chord.dot(chord);
        let (zero, one, half) = (like.splat(0.0), like.splat(1.0), like.splat(0.5));
        let (crank, link) = (like.splat(leg.proximal), like.splat(leg.link));
        // Distance of the foot of B on the chord from A, as a fraction of the chord. With equal lengths it is one half, and a
        // division is saved.
        let skew = skew_of(leg);
        let foot = if skew == 0.0 {
            half
        } else {
            half + like.splat(skew) / square
        };
        let rest = one - foot;
        // Square of the ratio of the elbow's distance from the chord to the chord's length. Out of reach it is negative
        // and its root is NaN, for which every comparison is false.
        let ratio = (like.splat(leg.proximal * leg.proximal) - foot * foot * square) / square;
        let elbow = like.splat(leg.frame.sign) * ratio.sqrt();
        let to_unit = like.splat(1.0 / leg.link);
        let tangent = chord.scaled(rest).minus(chord.perp().scaled(elbow)).scaled(to_unit);
        // (B − A) × u = (B − A) × (C − A)/L, to which only the component of B − A normal to the chord contributes.
        let lever = -(elbow * square * to_unit);

        let longest = leg.proximal + leg.link;
        let shortest = (leg.proximal - leg.link).abs();
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
                direction: vector.scaled(like.splat(1.0 / leg.proximal)),
                length: crank,
                share: one,
                distal_share: like.splat(leg.link / leg.proximal),
            }),
            guides: [None; 3],
            limit_margin: limit_margin.larger(zero).select(reachable, limit_margin.smaller(zero)),
            reachable,
        }
    }

    /// With lengths in units of `L_b`, `v` leads from `A_i` to `C_i`, `S = |v|²`, `λ = L_a/L_b`, and `f = 1/2 + (λ² − 1)/(2S)` is
    /// the foot of `B_i`: `u = (1 − f) v − τ v⊥` with `τ = σ √(λ²/S − f²)`.
    fn enclose(leg: &LegToEnclose<'_>, position: PlanarModel, arm: PlanarModel) -> ChainEnclosure {
        let frame = leg.frame;
        let [x, y] = frame.vector(position, arm);
        let one = TaylorModel::exactly(1.0);
        let square = dot([x, y], [x, y]);
        let chain = |reach, tangent, vector, lever_square| ChainEnclosure {
            proximal: Some(frame.crank(vector)),
            lever_square: Some(lever_square),
            ..ChainEnclosure::new(reach, tangent, [one, one], [None; 3])
        };
        if leg.design.proximal_length() == leg.design.link_length() {
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

    fn assembly(leg: &LegSizes) -> Assembly {
        leg.assembly(0.5 * (leg.proximal + leg.link), 0.5 * leg.frame.anchor_distance)
    }
}
