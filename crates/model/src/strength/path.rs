//! How loads pass from the platform to the base: the bars of a leg, its joints between them, and where its mass lies (docs/model.md,
//! sections 14.1 and 14.4).

use super::LegLoadPath;
use crate::lanes::{Planar, Real};
use crate::mechanism::{Architecture, Design, Geometry, JointKind, JointPoint, LegSettings, MemberKind};
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
    pub fn new(design: &Design, settings: &LegSettings, index: usize, [of_leg, of_platform]: [f64; 2]) -> Self {
        let architecture: Architecture = design.architecture();
        let chain = architecture.chain();
        let geometry: &Geometry = &settings.geometry;
        let bar = |length: f64, density: f64| {
            [
                Some(Piece {
                    end: End::Base,
                    from: 0.0,
                    to: length,
                    density,
                    is_within: true,
                }),
                None,
            ]
        };
        // The mass of a guide is that of its full length, spread over its travel.
        let guide = |end: End, length: f64| {
            let [from, to] = geometry.travel(length);
            let piece = Piece {
                end,
                from,
                to,
                density: of_leg * length / (to - from),
                is_within: false,
            };
            [Some(piece), None]
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
                let piece = |end: End, to: f64| {
                    Some(Piece {
                        end,
                        from: 0.0,
                        to,
                        density: of_leg,
                        is_within: to <= settings.telescopic_shortest * link_length,
                    })
                };
                [piece(End::Base, tube), piece(End::Platform, link_length - tube)]
            }
            // The guide belongs to the platform if the last joint slides, otherwise to the slider.
            MemberKind::Guide if chain.joints[2] == JointKind::Prismatic => guide(End::Platform, link_length),
            MemberKind::Guide => guide(End::Base, link_length),
            _ => bar(link_length, of_leg),
        };
        let arm = geometry.platform_joint(index, design.platform_radius()).length();
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
            pieces: [proximal, distal, bar(arm, of_platform)],
            tube,
            proximal_length,
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

/// Part of uniform mass along a bar at several poses at once.
#[derive(Clone, Copy)]
pub(crate) struct Span<V> {
    /// Distances from the end of the bar at the base \[m\].
    pub from: V,
    pub to: V,
    /// Mass per length \[kg/m\].
    pub density: f64,
    /// Whether it lies between the ends of the bar at all poses that the leg reaches.
    pub is_within: bool,
}

impl<V: Real> Span<V> {
    /// Returns the mass from a distance on, and the distance of its middle.
    #[inline(always)]
    fn mass_from(&self, distance: V) -> (V, V) {
        let from = self.from.larger(distance);
        let length = (self.to - from).larger(from.splat(0.0));
        let mass = length * from.splat(self.density);
        (mass, from + length * from.splat(0.5))
    }
}

/// A bar at several poses at once, relative to `P`.
#[derive(Clone, Copy)]
pub(crate) struct BarLanes<V> {
    /// End at the base \[m\].
    pub base: Planar<V>,
    /// Unit vector towards the platform.
    pub axis: Planar<V>,
    /// Length \[m\].
    pub length: V,
    pub pieces: [Span<V>; 2],
    /// Whether one piece covers the bar.
    pub is_uniform: bool,
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

/// Mass beyond a place, towards the platform, and its first moment about `P`.
#[derive(Clone, Copy)]
pub(crate) struct Beyond<V> {
    pub mass: V,
    pub moment: Planar<V>,
}

impl<V: Real> Beyond<V> {
    #[inline(always)]
    pub fn nothing(like: V) -> Self {
        let zero = like.splat(0.0);
        Self {
            mass: zero,
            moment: Planar::new(zero, zero),
        }
    }

    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        Self {
            mass: self.mass + other.mass,
            moment: self.moment.plus(other.moment),
        }
    }
}

impl<V: Real> BarLanes<V> {
    /// Returns the place at a distance from the end at the base.
    #[inline(always)]
    pub fn place(&self, distance: V) -> Planar<V> {
        self.base.plus(self.axis.scaled(distance))
    }

    /// Returns a mass whose middle is at a distance from the end at the base.
    #[inline(always)]
    fn at(&self, (mass, middle): (V, V)) -> Beyond<V> {
        Beyond {
            mass,
            moment: self.place(middle).scaled(mass),
        }
    }

    /// Returns the mass of a piece.
    #[inline(always)]
    pub fn mass_of_piece(&self, piece: usize) -> Beyond<V> {
        let piece = &self.pieces[piece];
        self.at(piece.mass_from(piece.from))
    }

    /// Returns the mass on the line of the bar.
    #[inline(always)]
    pub fn mass(&self) -> Beyond<V> {
        self.mass_of_piece(0).and(self.mass_of_piece(1))
    }

    /// Returns the mass on the line of the bar from a distance on, and its first moment about that place along the bar.
    #[inline(always)]
    pub fn mass_on(&self, distance: V) -> (V, V) {
        let [first, second] = &self.pieces;
        let (mass, middle) = first.mass_from(distance);
        let moment = mass * (middle - distance);
        if second.density == 0.0 {
            return (mass, moment);
        }
        let (more, middle) = second.mass_from(distance);
        (mass + more, moment + more * (middle - distance))
    }

    /// Returns the mass on the line of the bar from a distance on.
    #[inline(always)]
    pub fn mass_from(&self, distance: V) -> Beyond<V> {
        let [first, second] = &self.pieces;
        let mass = self.at(first.mass_from(distance));
        if second.density == 0.0 {
            return mass;
        }
        mass.and(self.at(second.mass_from(distance)))
    }
}
