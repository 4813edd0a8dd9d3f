//! How loads pass from the platform to the base: the bars of a leg, its joints between them, and where its mass lies (docs/model.md,
//! sections 14.1 and 14.4).

use super::LegLoadPath;
use super::bars::{BarLanes, Span};
use crate::lanes::{Planar, Real};
use crate::mechanism::{Design, JointKind, JointPoint, LegSettings, MemberKind};
use crate::spatial::LEGS;
use crate::stiffness::BarCompliance;

/// Number of bars of a leg, from the base: `AB`, `BC` (or `AC` of a telescopic leg), `CP`.
pub(crate) const BARS: usize = 3;

/// `BC`, or `AC` of a telescopic leg.
pub(crate) const DISTAL: usize = 1;

/// `CP`.
pub(crate) const PLATFORM: usize = 2;

/// What the strength of a bar depends on besides its load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BarSection {
    /// Compliances per length.
    pub compliance: BarCompliance,
    /// `1/A_s` \[1/m²\].
    pub per_area: f64,
    /// `ρ/I` \[1/m³\].
    pub bending: f64,
    /// `ρ_t/I_x` \[1/m³\].
    pub torsion: f64,
    /// Whether the stress is largest at a corner, where both bending moments add up.
    pub is_square: bool,
    /// Mass per length \[kg/m\].
    pub mass_per_length: f64,
}

/// End of a bar, from which positions are measured into the bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    /// The end at the base.
    Base,
    /// The end at the platform.
    Platform,
}

/// A part of uniform mass on the line of a bar.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    end: End,
    /// Where it begins and ends \[m\].
    from: f64,
    to: f64,
    /// Mass per length \[kg/m\].
    density: f64,
    /// Whether it lies between the ends of the bar at all poses that the leg reaches.
    is_within: bool,
}

/// A joint of a leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PathJoint {
    pub kind: JointKind,
    /// Where the joint is.
    pub point: JointPoint,
    /// The bar that follows it towards the platform.
    pub before: usize,
    /// Whether it is the bush in which the rod of a telescopic leg slides.
    pub is_bush: bool,
    pub is_driven: bool,
}

/// A leg as its loads see it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LegPath {
    /// The first bar: 0, or 1 in a chain without a bar `AB`.
    pub first: usize,
    /// The joints from the base.
    pub joints: [PathJoint; 3],
    /// Kinds of the members that the bars are.
    pub members: [MemberKind; BARS],
    pieces: [[Option<Piece>; 2]; BARS],
    /// Length of the tube of a telescopic leg \[m\].
    tube: f64,
    /// `L_a` \[m\].
    proximal_length: f64,
}

impl LegPath {
    /// Describes leg `index` of a design, whose bars have the given masses per length.
    pub fn new(design: &Design, settings: &LegSettings, index: usize, densities: [f64; 2]) -> Self {
        let architecture = design.architecture();
        let chain = architecture.chain();
        Self {
            first: if chain.has_proximal_bar { 0 } else { DISTAL },
            joints: [0, 1, 2].map(|place| PathJoint {
                kind: chain.joints[place],
                point: chain.points[place],
                before: match chain.points[place] {
                    JointPoint::A => 0,
                    JointPoint::B => DISTAL,
                    JointPoint::C => PLATFORM,
                },
                is_bush: chain.distal == MemberKind::TelescopicLeg && chain.joints[place] == JointKind::Prismatic,
                is_driven: architecture.driven() == place,
            }),
            members: [
                chain.proximal.unwrap_or(MemberKind::Crank),
                chain.distal,
                MemberKind::PlatformBar,
            ],
            pieces: pieces(design, settings, index, densities),
            tube: settings.tube_length(design.link_length()),
            proximal_length: design.proximal_length(),
        }
    }

    /// Returns the bars and joints at several poses at once, relative to `P`.
    #[inline(always)]
    pub fn at<V: Real>(&self, leg: &LegLoadPath<V>, arm: Planar<V>) -> PathLanes<V> {
        let like = leg.moment;
        let tangent = leg.tangent;
        let c = arm;
        let b = c.minus(tangent.scaled(leg.offset));
        let nothing = like.splat(0.0);
        let (a, proximal) = match &leg.proximal {
            Some((direction, share)) => {
                let direction = into_base(tangent, *direction);
                let offset = *share * like.splat(self.proximal_length);
                let a = b.minus(direction.scaled(offset));
                (a, self.bar(0, a, direction, offset))
            }
            None => (b, self.bar(0, b, tangent, nothing)),
        };
        let length = arm.dot(arm).sqrt();
        let to_p = arm.scaled(like.splat(-1.0) / length);
        let bars = [
            proximal,
            self.bar(DISTAL, b, tangent, leg.offset),
            self.bar(PLATFORM, c, to_p, length),
        ];
        let bush = b.plus(tangent.scaled(like.splat(self.tube).smaller(leg.offset)));
        let mut joints = [bush; LEGS];
        let mut slides = [Planar::new(nothing, nothing); LEGS];
        for place in 0..LEGS {
            joints[place] = match self.joints[place].point {
                _ if self.joints[place].is_bush => bush,
                JointPoint::A => a,
                JointPoint::B => b,
                JointPoint::C => c,
            };
            if let Some(guide) = leg.guides[place] {
                slides[place] = into_base(tangent, guide);
            }
        }
        if let Some(rail) = leg.rail {
            slides[0] = rail;
        }
        PathLanes { bars, joints, slides }
    }

    /// Returns the twist of the platform at `P` for a unit rate of a joint: both components of the velocity, and the rotation.
    #[inline(always)]
    pub fn twist<V: Real>(&self, path: &PathLanes<V>, joint: usize) -> [V; 3] {
        let like = path.joints[joint].x;
        if self.is_revolute(joint) {
            let turned = path.joints[joint].perp();
            [-turned.x, -turned.y, like.splat(1.0)]
        } else {
            let slide = path.slides[joint];
            [slide.x, slide.y, like.splat(0.0)]
        }
    }

    /// Returns the moment of the line of the leg about an end of a bar, given as it follows from the coordinates: it is 0 at a passive
    /// revolute joint, through which the line passes.
    #[inline(always)]
    pub fn lever<V: Real>(&self, bar: usize, end: End, lever: V) -> V {
        match self.is_free(bar, end) {
            true => lever.known_to_be(0.0),
            false => lever,
        }
    }

    /// Returns whether the line of the leg passes through both ends of a bar.
    #[inline(always)]
    pub fn is_on_line(&self, bar: usize) -> bool {
        self.is_free(bar, End::Base) && self.is_free(bar, End::Platform)
    }

    /// Returns whether a passive revolute joint is at an end of a bar.
    #[inline(always)]
    fn is_free(&self, bar: usize, end: End) -> bool {
        let place = match end {
            End::Base => bar,
            End::Platform => bar + 1,
        };
        // A leg without a first bar begins with the second one.
        let at = |joint: &PathJoint| match joint.point {
            JointPoint::A => self.first,
            JointPoint::B => DISTAL,
            JointPoint::C => PLATFORM,
        };
        let is_passive = |joint: &&PathJoint| joint.kind == JointKind::Revolute && !joint.is_driven;
        self.joints.iter().filter(is_passive).any(|joint| at(joint) == place)
    }

    /// Returns whether a joint is revolute.
    pub fn is_revolute(&self, joint: usize) -> bool {
        self.joints[joint].kind == JointKind::Revolute
    }

    /// Returns a bar from `base` along `direction` to `offset`, which may be negative: its axis leads to the platform.
    #[inline(always)]
    fn bar<V: Real>(&self, place: usize, base: Planar<V>, direction: Planar<V>, offset: V) -> BarLanes<V> {
        let (zero, one) = (offset.splat(0.0), offset.splat(1.0));
        let sign = one.select(offset.at_least(zero), -one);
        let length = offset.abs();
        let [first, second] = &self.pieces[place];
        BarLanes {
            base,
            axis: direction.scaled(sign),
            length,
            pieces: [span(first, sign, length), span(second, sign, length)],
            is_uniform: matches!(
                self.members[place],
                MemberKind::Crank | MemberKind::Link | MemberKind::PlatformBar
            ),
        }
    }
}

/// Returns where the mass of each bar lies, of bars with the given masses per length.
fn pieces(
    design: &Design,
    settings: &LegSettings,
    index: usize,
    [of_leg, of_platform]: [f64; 2],
) -> [[Option<Piece>; 2]; BARS] {
    let chain = design.architecture().chain();
    let geometry = &settings.geometry;
    let piece = |end: End, [from, to]: [f64; 2], density: f64, is_within: bool| {
        Some(Piece {
            end,
            from,
            to,
            density,
            is_within,
        })
    };
    let bar = |length: f64, density: f64| [piece(End::Base, [0.0, length], density, true), None];
    // The mass of a guide is that of its full length, spread over its travel.
    let guide = |end: End, length: f64| {
        let [from, to] = geometry.travel(length);
        [piece(end, [from, to], of_leg * length / (to - from), false), None]
    };
    let (proximal_length, link_length) = (design.proximal_length(), design.link_length());
    let tube = settings.tube_length(link_length);
    let proximal = match chain.proximal {
        Some(MemberKind::TurningGuide) => guide(End::Base, proximal_length),
        _ if chain.has_proximal_bar => bar(proximal_length, of_leg),
        _ => [None; 2],
    };
    let distal = match chain.distal {
        MemberKind::TelescopicLeg => {
            let is_within = |to: f64| to <= settings.telescopic_shortest * link_length;
            let own = |end: End, to: f64| piece(end, [0.0, to], of_leg, is_within(to));
            [own(End::Base, tube), own(End::Platform, link_length - tube)]
        }
        // The guide belongs to the platform if the last joint slides, otherwise to the slider.
        MemberKind::Guide if chain.joints[2] == JointKind::Prismatic => guide(End::Platform, link_length),
        MemberKind::Guide => guide(End::Base, link_length),
        _ => bar(link_length, of_leg),
    };
    let arm = geometry.platform_joint(index, design.platform_radius()).length();
    [proximal, distal, bar(arm, of_platform)]
}

/// Returns a vector of the distal axes in base axes.
#[inline(always)]
fn into_base<V: Real>(tangent: Planar<V>, vector: Planar<V>) -> Planar<V> {
    tangent.scaled(vector.x).plus(tangent.perp().scaled(vector.y))
}

/// Returns where a piece begins and ends along a bar of the given length.
#[inline(always)]
fn span<V: Real>(piece: &Option<Piece>, sign: V, length: V) -> Span<V> {
    let zero = sign.splat(0.0);
    let Some(piece) = piece else {
        return Span {
            from: zero,
            to: zero,
            density: 0.0,
            is_within: true,
        };
    };
    let (from, to) = (sign * sign.splat(piece.from), sign * sign.splat(piece.to));
    let (from, to) = match piece.end {
        End::Base => (from, to),
        End::Platform => (length - from, length - to),
    };
    Span {
        from: from.smaller(to),
        to: from.larger(to),
        density: piece.density,
        is_within: piece.is_within,
    }
}

/// A leg at several poses at once, relative to `P`.
#[derive(Clone, Copy)]
pub(crate) struct PathLanes<V> {
    pub bars: [BarLanes<V>; BARS],
    /// Where the joints are \[m\].
    pub joints: [Planar<V>; LEGS],
    /// Directions of the prismatic joints.
    pub slides: [Planar<V>; LEGS],
}
