//! A leg: a chain with one actuated joint. The force that it transmits follows from the two passive joints by one rule, for every
//! chain (docs/model.md, section 2.8).
//!
//! With its actuated joint locked, a leg transmits a force along one line. Two passive revolute joints leave the line through both;
//! a passive prismatic joint leaves the line normal to its direction, through the passive revolute joint.

use std::ops::{Add, Mul, Neg, Sub};

use glam::DVec2;

use super::chain::{Assembly, Chain, ChainDescription, ChainLanes, DistalLanes};
use super::joint::{JointKind, JointPoint};
use super::leg::{BarLoads, Leg, LegLanes, LegPosture, LineLoads};
use super::leg_enclosure::{EnclosedLoads, LegEnclosure};
use super::{Design, LegFrame, LegFrameEnclosure, LegSettings, Members, Shortfall};
use crate::enclosure::{PlanarModel, PoseEnclosure, TaylorModel, cross as cross_models, dot};
use crate::lanes::{Planar, Real};
use crate::spatial::cross;

/// A leg whose joint `DRIVEN` (0, 1, 2 from the base) is driven.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrivenLeg<C, const DRIVEN: usize> {
    pub(super) chain: C,
}

/// Number to which the rule applies: a double, several at once, or an enclosure.
trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self> {
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
struct DistalGeometry<T> {
    /// `C_i − P`.
    arm: [T; 2],
    /// Distance from `B_i` to `C_i` along the x axis.
    offset: T,
    /// Vector from `A_i` to `B_i`, and unit vector along it.
    proximal: Option<[[T; 2]; 2]>,
    /// Unit vector from `A_i` to `C_i`, if the line may lead along it.
    chord: Option<[T; 2]>,
    /// Directions of the prismatic joints.
    guides: [Option<[T; 2]>; 3],
}

/// Line along which a leg transmits a force, in the distal axes.
struct ForceLine<T> {
    /// `u_i`, unit vector along the line.
    u: [T; 2],
    /// Transmission `B_ii`.
    transmission: T,
    /// Moments of `u_i` on the line about `A_i`, `B_i`, `C_i` and `P`.
    moments: [T; 4],
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

    /// Returns the line by the rule.
    #[inline(always)]
    fn line<T: Number>(geometry: &DistalGeometry<T>) -> ForceLine<T> {
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

    /// Returns the transmission for a line along the distal bar: the x component of the guide, or the lever of the first joint.
    #[inline(always)]
    fn distal_transmission<V: Real>(chain: &ChainLanes<V>) -> V {
        match (chain.guides[DRIVEN], &chain.proximal) {
            (Some(guide), _) => guide.x,
            (None, Some(bar)) => -bar.vector.y,
            (None, None) => chain.offset.splat(0.0),
        }
    }
}

impl<C: Chain, const DRIVEN: usize> DrivenLeg<C, DRIVEN> {
    /// Returns the place of the actuated joint: 0, 1 or 2 from the base.
    pub(super) fn driven(&self) -> usize {
        DRIVEN
    }

    /// Solves the inverse kinematics like [`Leg::inverse`], also beyond the limits of joints; tells which limit is violated, if one
    /// is.
    ///
    /// # Errors
    /// Returns the [`Shortfall`] if the working mode has no real solution, or if a direction of the leg is undefined.
    pub(super) fn solve(&self, c: DVec2, arm: DVec2) -> Result<(LegPosture, Option<Shortfall>), Shortfall> {
        let (chain, beyond) = self.chain.solve(c, arm)?;
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
        Ok((posture, beyond))
    }

    /// Encloses the leg over a box of poses.
    pub(super) fn enclose(
        frame: &LegFrameEnclosure,
        design: &Design,
        settings: &LegSettings,
        pose: &PoseEnclosure,
    ) -> LegEnclosure {
        let arm = frame.arm(pose);
        let chain = C::enclose(frame, design, settings, pose.position, arm);
        // As multiples of r: along the distal bar, and the moment of its line.
        let multiple = frame.arm_multiple;
        let (along, across) = (
            dot(arm, chain.tangent).scaled(multiple),
            cross_models(arm, chain.tangent).scaled(multiple),
        );
        if Self::IS_ALONG_DISTAL {
            let transmission_square = match (chain.lever_square, chain.guides[DRIVEN], chain.proximal) {
                (Some(square), ..) => square,
                (None, Some([x, _]), _) => x.squared(),
                (None, None, Some(bar)) => bar.vector[1].squared(),
                (None, None, None) => TaylorModel::exactly(0.0),
            };
            return LegEnclosure {
                u: chain.tangent,
                moment: across,
                along,
                across,
                transmission_square,
                loads: None,
                arm,
                chain,
            };
        }
        let radius = frame.platform_radius;
        let chord: Option<PlanarModel> = chain.proximal.filter(|_| Self::IS_ALONG_CHORD).map(|bar| {
            let chord = [bar.vector[0] + chain.offset, bar.vector[1]];
            let to_unit = dot(chord, chord).sqrt().reciprocal();
            chord.map(|part| part * to_unit)
        });
        let line = Self::line(&DistalGeometry {
            arm: [along.scaled(radius), -across.scaled(radius)],
            offset: chain.offset,
            proximal: chain.proximal.map(|bar| [bar.vector, bar.direction]),
            chord,
            guides: chain.guides,
        });
        let [x, y] = line.u;
        let normal = [-chain.tangent[1], chain.tangent[0]];
        let [about_a, about_b, about_c, about_p] = line.moments;
        LegEnclosure {
            u: [0, 1].map(|k| chain.tangent[k] * x + normal[k] * y),
            moment: about_p.scaled(frame.per_platform_radius),
            along,
            across,
            transmission_square: line.transmission.squared(),
            loads: Some(EnclosedLoads {
                distal: [x, about_c + chain.signed_beam * y, about_c],
                proximal: [
                    chain
                        .proximal
                        .map_or(TaylorModel::exactly(0.0), |bar| dot(line.u, bar.direction)),
                    about_a,
                    about_b,
                ],
                platform: [x * along - y * across, about_c, about_p],
            }),
            arm,
            chain,
        }
    }
}

impl<C: Chain, const DRIVEN: usize> Leg for DrivenLeg<C, DRIVEN> {
    const MAY_BE_ON_RAILS: bool = Self::CHAIN.is_on_rails();

    fn new(design: &Design, settings: &LegSettings, index: usize) -> Self {
        let frame = LegFrame::new(design, &settings.geometry, index);
        Self {
            chain: C::new(frame, design, settings),
        }
    }

    fn inverse(&self, c: DVec2, arm: DVec2) -> Result<LegPosture, Shortfall> {
        let (posture, beyond) = self.solve(c, arm)?;
        beyond.map_or(Ok(posture), Err)
    }

    #[inline(always)]
    #[allow(
        clippy::manual_map,
        reason = "a closure that is not inlined is compiled for the baseline processor"
    )]
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> LegLanes<V> {
        let chain = self.chain.lanes(position, arm);
        if Self::IS_ALONG_DISTAL {
            return LegLanes {
                u: chain.tangent,
                moment: chain.across,
                transmission: Self::distal_transmission(&chain),
                loads: None,
                chain,
            };
        }
        let pair = |vector: Planar<V>| [vector.x, vector.y];
        let chord = if Self::IS_ALONG_CHORD
            && let Some(bar) = chain.proximal
        {
            let chord = Planar::new(bar.vector.x + chain.offset, bar.vector.y);
            let to_unit = chain.offset.splat(1.0) / chord.dot(chord).sqrt();
            Some(pair(chord.scaled(to_unit)))
        } else {
            None
        };
        let [first, second, third] = chain.guides;
        let line = Self::line(&DistalGeometry {
            arm: [chain.along, -chain.across],
            offset: chain.offset,
            proximal: match chain.proximal {
                Some(bar) => Some([pair(bar.vector), pair(bar.direction)]),
                None => None,
            },
            chord,
            guides: [
                if let Some(guide) = first {
                    Some(pair(guide))
                } else {
                    None
                },
                if let Some(guide) = second {
                    Some(pair(guide))
                } else {
                    None
                },
                if let Some(guide) = third {
                    Some(pair(guide))
                } else {
                    None
                },
            ],
        });
        let u = Planar::new(line.u[0], line.u[1]);
        let [about_a, about_b, about_c, moment] = line.moments;
        LegLanes {
            u: chain.tangent.scaled(u.x).plus(chain.tangent.perp().scaled(u.y)),
            moment,
            transmission: line.transmission,
            loads: Some(LineLoads {
                distal: BarLoads {
                    force: u.x,
                    // A telescopic leg whose beam is longer than the leg begins behind `B_i`.
                    moments: [about_c + chain.signed_beam * u.y, about_c],
                },
                proximal: BarLoads {
                    force: match chain.proximal {
                        Some(bar) => u.dot(bar.direction),
                        None => moment.splat(0.0),
                    },
                    moments: [about_a, about_b],
                },
                platform: BarLoads {
                    force: u.x * chain.along - u.y * chain.across,
                    moments: [about_c, moment],
                },
            }),
            chain,
        }
    }

    #[inline(always)]
    fn members<V: Real>(&self, c: Planar<V>, distal: &DistalLanes<V>) -> Members<V> {
        self.chain.members(c, distal)
    }

    fn frame(&self) -> &LegFrame {
        self.chain.frame()
    }

    fn reach_box(&self) -> [DVec2; 2] {
        self.chain.reach_box()
    }

    fn assembly(&self) -> Assembly {
        self.chain.assembly()
    }
}
