//! The interface of a chain: three joints from the base to the platform, whichever of them is driven.

pub(super) mod bodies;
pub(super) mod members;
mod sizes;

pub use sizes::LegSizes;

use glam::DVec2;

use super::chain_enclosure::{ChainEnclosure, LegToEnclose};
use super::joint::{JointKind, JointPoint};
use super::{DesignVariable, LegBody, MemberKind, Members, Shortfall, Within};
use crate::enclosure::{MembersEnclosure, PlanarModel};
use crate::lanes::{Planar, Real};
use crate::spatial::{Pose, Rotation};
use bodies::leg_bodies;
use members::{enclosed_members, members_of};

/// Static description of a chain, independent of its lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainDescription {
    /// Letters of the joints from base to platform, for example `PRR`.
    pub name: &'static str,
    /// Kinds of the joints.
    pub joints: [JointKind; 3],
    /// Points at which the joints are; that of a prismatic joint is where its actuator is drawn.
    pub points: [JointPoint; 3],
    /// Whether the inverse kinematics has two solutions, so that a working mode has to be set.
    pub has_working_modes: bool,
    /// Whether a bar, which bends, leads from `A_i` to `B_i`.
    pub has_proximal_bar: bool,
    /// Kind of the proximal member (the one before the distal member), for chains that have one.
    pub proximal: Option<MemberKind>,
    /// Kind of the distal member, which leads to the platform.
    pub distal: MemberKind,
    /// Variables beyond the five that every architecture has, in the order of [`FURTHER_VARIABLES`](super::FURTHER_VARIABLES).
    pub variables: &'static [DesignVariable],
}

impl ChainDescription {
    /// Returns whether the first joint is a slider on a rail of the base.
    pub const fn is_on_rails(&self) -> bool {
        matches!(self.joints[0], JointKind::Prismatic)
    }

    /// Returns whether the last joint is a carriage on a guide of the platform.
    const fn has_platform_guide(&self) -> bool {
        matches!(self.joints[2], JointKind::Prismatic)
    }
}

/// A bar in the plane at a posture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BarPosture {
    /// Unit vector along the bar.
    pub direction: DVec2,
    /// Distance from its proximal to its distal end along this vector \[m\], which is negative on the far side of a guide.
    pub offset: f64,
}

impl BarPosture {
    /// Creates the bar of a direction and an offset.
    pub(super) fn new(direction: DVec2, offset: f64) -> Self {
        Self { direction, offset }
    }
}

/// Points and directions of a chain at a pose that it reaches, in the base frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainPosture {
    /// `A_i` \[m\].
    pub a: DVec2,
    /// `B_i` \[m\].
    pub b: DVec2,
    /// `C_i` \[m\].
    pub c: DVec2,
    /// Distances of the slider from the two ends of its rail, for chains on rails \[m\]; negative beyond an end.
    pub slider: Option<[f64; 2]>,
    /// Bar from `A_i` to `B_i`, for chains that have one.
    pub proximal: Option<BarPosture>,
    /// Bar from `B_i` to `C_i`.
    pub distal: BarPosture,
    /// Length of the distal bar in the beam model \[m\], ≥ 0.
    pub beam: f64,
    /// Unit vectors along which the prismatic joints move the platform.
    pub guides: [Option<DVec2>; 3],
    /// Limit margin: smallest distance to a joint limit or to the end of reach \[m\], ≥ 0.
    pub limit_margin: f64,
}

/// What the inverse kinematics of a chain finds, from which its [`ChainPosture`] follows.
#[derive(Debug, Clone, Copy)]
pub struct Solved {
    /// `B_i` \[m\].
    pub b: DVec2,
    /// Bar from `A_i` to `B_i`, for chains that have one.
    pub proximal: Option<BarPosture>,
    /// Bar from `B_i` to `C_i`.
    pub distal: BarPosture,
    /// Unit vectors along which the prismatic joints move the platform.
    pub guides: [Option<DVec2>; 3],
    /// The joints between their limits.
    pub within: Within,
}

/// What a leg with a locked joint requires of the platform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LockedLeg {
    /// A point of the platform, in its frame \[m\].
    pub platform: DVec2,
    /// A point of the base \[m\].
    pub base: DVec2,
    /// How they are bound to each other.
    pub kind: LockedKind,
}

/// How a point of the platform and a point of the base are bound to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LockedKind {
    /// They are this far apart \[m\].
    Circle(f64),
    /// The point of the platform stays on a line of the base through the other point; its normal in the base frame.
    BaseLine(DVec2),
    /// The point of the base stays on a line of the platform through the other point; its normal in the platform frame.
    PlatformLine(DVec2),
}

impl LockedLeg {
    /// Creates what is required of a point of the platform and a point of the base.
    pub(super) fn new(platform: DVec2, base: DVec2, kind: LockedKind) -> Self {
        Self { platform, base, kind }
    }

    /// Returns the radius of the circle, 0 for a line.
    pub fn radius(&self) -> f64 {
        match self.kind {
            LockedKind::Circle(radius) => radius,
            _ => 0.0,
        }
    }

    /// Returns the normal of the line, zero for a circle.
    pub fn normal(&self) -> DVec2 {
        match self.kind {
            LockedKind::BaseLine(normal) | LockedKind::PlatformLine(normal) => normal,
            LockedKind::Circle(_) => DVec2::ZERO,
        }
    }

    /// Returns by how much a pose misses the constraint, and the derivatives with respect to `x`, `y` and `φ`, with lengths in units
    /// of `scale`; `turn` is the rotation of the pose.
    pub fn constraint(&self, pose: &Pose, turn: &Rotation, scale: f64) -> (f64, [f64; 3]) {
        let arm = turn.apply(self.platform) / scale;
        let way = (pose.position - self.base) / scale;
        match self.kind {
            LockedKind::Circle(radius) => {
                let apart = way + arm;
                let error = apart.length_squared() - (radius / scale) * (radius / scale);
                (error, [2.0 * apart.x, 2.0 * apart.y, 2.0 * apart.dot(arm.perp())])
            }
            LockedKind::BaseLine(normal) => (normal.dot(way + arm), [normal.x, normal.y, normal.dot(arm.perp())]),
            LockedKind::PlatformLine(normal) => {
                let turned = turn.apply(normal);
                let error = -turned.dot(way) - normal.dot(self.platform) / scale;
                (error, [-turned.x, -turned.y, -turned.perp().dot(way)])
            }
        }
    }
}

/// Bar from `A_i` to `B_i` at several poses at once. Vectors are given in the leg's distal axes: the x axis leads from `B_i` to
/// `C_i`.
#[derive(Clone, Copy)]
pub struct ProximalLanes<V> {
    /// Vector from `A_i` to `B_i` \[m\].
    pub vector: Planar<V>,
    /// Unit vector along the bar.
    pub direction: Planar<V>,
    /// Length of the bar \[m\].
    pub length: V,
    /// Distance from `A_i` to `B_i` along `direction`, as a multiple of `L_a`.
    pub share: V,
    /// Length of the distal bar in the beam model with the sign of its offset, as a multiple of `L_a`.
    pub distal_share: V,
}

/// A chain at several poses at once; valid in the lanes where it reaches the pose. The distal axes have their x axis along the
/// distal bar, from `B_i` to `C_i`.
#[derive(Clone, Copy)]
pub struct ChainLanes<V: Real> {
    /// Unit vector along the distal bar, in the base frame.
    pub tangent: Planar<V>,
    /// `(C_i − P) · tangent` \[m\].
    pub along: V,
    /// `(C_i − P) × tangent` \[m\].
    pub across: V,
    /// Distance from `B_i` to `C_i` along `tangent` \[m\].
    pub offset: V,
    /// Length of the distal bar in the beam model \[m\], ≥ 0.
    pub beam: V,
    /// The same length with the sign of `offset`.
    pub signed_beam: V,
    /// Bar from `A_i` to `B_i`, for chains that have one.
    pub proximal: Option<ProximalLanes<V>>,
    /// Unit vectors along which the prismatic joints move the platform, in the distal axes.
    pub guides: [Option<Planar<V>>; 3],
    /// Limit margin: smallest distance to a joint limit or to the end of reach \[m\]; not above 0 where the chain does not reach the
    /// pose.
    pub limit_margin: V,
    /// Lanes where the chain reaches the pose.
    pub reachable: V::Mask,
}

impl<V: Real> ChainLanes<V> {
    /// Creates a chain without a bar from `A_i` to `B_i` that reaches the poses where its limit margin is not negative; `beam` is the
    /// length of the distal bar in the beam model.
    #[inline(always)]
    pub(super) fn new(
        tangent: Planar<V>,
        [along, across]: [V; 2],
        [offset, beam]: [V; 2],
        guides: [Option<Planar<V>>; 3],
        limit_margin: V,
    ) -> Self {
        Self {
            tangent,
            along,
            across,
            offset,
            beam,
            signed_beam: offset,
            proximal: None,
            guides,
            limit_margin,
            reachable: limit_margin.at_least(limit_margin.splat(0.0)),
        }
    }
}

/// Distal bar of a leg, as the members of the leg need it.
#[derive(Clone, Copy)]
pub struct DistalLanes<V> {
    /// Unit vector along the bar, in the base frame.
    pub tangent: Planar<V>,
    /// Distance from `B_i` to `C_i` along it \[m\].
    pub offset: V,
}

/// Two lengths of which the first must not be smaller than the second, or `P` cannot reach `O` (g1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assembly {
    /// What the leg and the platform bridge together \[m\].
    pub value: f64,
    /// What they have to bridge \[m\].
    pub threshold: f64,
}

/// A chain of three joints: its formulas, for a leg of given sizes.
pub trait Chain: Copy + std::fmt::Debug + PartialEq + Send + Sync {
    /// What is known of the chain without any lengths.
    const DESCRIPTION: ChainDescription;

    /// Solves the inverse kinematics with `C_i` at `c` in the base frame and `arm` = `C_i − P` \[m\] (docs/model.md, section 2.5), and
    /// tells which limit a joint is beyond, if one is.
    ///
    /// # Errors
    /// Returns the [`Shortfall`] if the working mode has no real solution, or if a direction of the chain is undefined.
    fn solve(leg: &LegSizes, c: DVec2, arm: DVec2) -> Result<Solved, Shortfall>;

    /// Returns what the leg requires of the platform while joint `driven` is locked at a value \[m or rad\]
    /// (docs/model.md, section 2.9).
    fn locked(leg: &LegSizes, driven: usize, value: f64) -> LockedLeg;

    /// Solves the inverse kinematics at several poses at once, with `C_i` at `position + arm`.
    ///
    /// It is optimized for speed and may work in the chain's own axes. It rounds differently from [`Chain::solve`] and does not give
    /// the reason why a pose is not reached.
    fn lanes<V: Real>(leg: &LegSizes, position: Planar<V>, arm: Planar<V>) -> ChainLanes<V>;

    /// Encloses the chain of a leg over a box of poses, with `P` at `position` \[m\] and `arm` the unit vector from `P` to `C_i`.
    ///
    /// The formulas are written apart from those of [`Chain::lanes`], so that each checks the other.
    fn enclose(leg: &LegToEnclose<'_>, position: PlanarModel, arm: PlanarModel) -> ChainEnclosure;

    /// Returns what g1 compares.
    fn assembly(leg: &LegSizes) -> Assembly;

    /// Returns the axes of the members at several poses at once, with the end of the leg at `c`; by default those of a slider or crank
    /// with a link or a guide.
    #[inline(always)]
    fn members<V: Real>(leg: &LegSizes, c: Planar<V>, distal: &DistalLanes<V>) -> Members<V> {
        members_of::<Self, V>(leg, c, distal)
    }

    /// Encloses the axes of the members over a box of poses, relative to `P` and in multiples of `L_b`: `anchor` is `A_i`, and `tip`
    /// is `C_i`. The default is that of [`Chain::members`].
    fn enclose_members(
        leg: &LegToEnclose<'_>,
        chain: &ChainEnclosure,
        anchor: PlanarModel,
        tip: PlanarModel,
    ) -> MembersEnclosure {
        enclosed_members(leg, chain, anchor, tip)
    }

    /// Returns the rigid bodies of the leg, from the base to the platform, with the `driven` joint marked; by default a slider or crank
    /// with a link, or with a carriage and the guide on the platform.
    fn bodies(leg: &LegSizes, posture: &ChainPosture, values: [f64; 3], driven: usize) -> Vec<LegBody> {
        leg_bodies(leg, posture, values, driven)
    }
}
