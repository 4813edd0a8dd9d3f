//! Proofs that a design follows a motion at every moment, not only at its samples (docs/model.md, section 15.11).
//!
//! Time is divided into intervals. Over each, the poses, velocities and accelerations are polynomials with a remainder, on which
//! the formulas of the evaluation run. An interval is halved until everything is decided on it.

use super::forms::{Travel, TravelForms};
use crate::dynamics::TaskMotion;
use crate::enclosure::TaylorModel;
use crate::evaluation::{Model, Quantity, TaskFigures, TaskOutcome, largest_of_legs};
use crate::mechanism::{Design, JointKind};

/// Share by which a bound may exceed the figure that it encloses.
const SLACK: f64 = 1e-3;

/// Shortest interval, as a share of the time of a piece.
const SHORTEST: f64 = 1e-9;

/// Largest number of intervals.
const MOST_INTERVALS: usize = 200_000;

/// Number of open moments after which a proof ends.
const MOST_OPEN: usize = 8;

/// What is proved about a motion of a design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionCertificate {
    /// Verdict.
    pub verdict: MotionVerdict,
    /// Number of intervals that were examined.
    pub intervals: usize,
}

/// Bounds of what a motion asks for at every moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionBounds {
    /// The distance to the joint limits and the ends of reach is nowhere smaller \[m\].
    pub reach: f64,
    /// No actuator is ever faster \[m/s or rad/s\].
    pub speed: f64,
    /// No actuator ever gives more \[N or N·m\].
    pub force: f64,
}

/// Verdict on a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MotionVerdict {
    /// The design follows the motion at every moment: all legs reach, no joint passes its limits, no parallel singularity is met, and the
    /// limits of distance, speed and force are kept, those of the selected drive included. The figures have these bounds.
    Proved(MotionBounds),
    /// A claim is proved to be wrong at a moment.
    Refuted(MotionMoment),
    /// A claim could not be decided at a moment.
    Open(MotionMoment),
}

impl MotionVerdict {
    /// Returns the name that JSON uses.
    pub fn name(&self) -> &'static str {
        match self {
            MotionVerdict::Proved(_) => "proved",
            MotionVerdict::Refuted(_) => "refuted",
            MotionVerdict::Open(_) => "open",
        }
    }

    /// Returns the bounds of the figures, if the motion is proved.
    pub fn bounds(&self) -> Option<&MotionBounds> {
        match self {
            MotionVerdict::Proved(bounds) => Some(bounds),
            MotionVerdict::Refuted(_) | MotionVerdict::Open(_) => None,
        }
    }

    /// Returns where a claim is wrong or open, unless the motion is proved.
    pub fn moment(&self) -> Option<&MotionMoment> {
        match self {
            MotionVerdict::Proved(_) => None,
            MotionVerdict::Refuted(moment) | MotionVerdict::Open(moment) => Some(moment),
        }
    }
}

/// A moment of a motion at which a claim about it does not hold, or may not hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionMoment {
    /// Piece, from 0.
    pub piece: usize,
    /// Time from the beginning of the cycle \[s\].
    pub time: f64,
    /// The claim.
    pub claim: MotionClaim,
}

/// A claim about a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MotionClaim {
    /// All legs reach, and no joint passes its limits.
    Reach,
    /// No parallel singularity is met.
    Singularity,
    /// The speeds of the actuators are bounded.
    Speed,
    /// The forces of the actuators are bounded.
    Force,
    /// The limit of a quantity is kept.
    Limit(Quantity),
}

impl MotionClaim {
    /// Returns the name that JSON uses.
    pub fn name(self) -> &'static str {
        match self {
            MotionClaim::Reach => "reach",
            MotionClaim::Singularity => "singularity",
            MotionClaim::Speed => "speed",
            MotionClaim::Force => "force",
            MotionClaim::Limit(quantity) => quantity.entry().key,
        }
    }
}

/// A figure of a motion that a bound encloses.
struct Figure {
    /// Limits of the study and of the drive, in the direction in which the figure grows.
    limits: Vec<(Quantity, f64)>,
    /// Value up to which a bound is close enough to the samples.
    near: f64,
    /// Largest upper end of an accepted interval.
    most: f64,
}

impl Figure {
    /// A figure whose largest sample is `peak`.
    fn new(peak: f64, limits: Vec<(Quantity, f64)>) -> Self {
        Self {
            limits,
            near: peak + SLACK * peak.abs(),
            most: f64::NEG_INFINITY,
        }
    }

    /// Returns the limit that is missed somewhere if the figure reaches a value.
    fn missed_at(&self, value: f64) -> Option<Quantity> {
        let missed = self.limits.iter().find(|(_, limit)| value > *limit);
        missed.map(|(quantity, _)| *quantity)
    }

    /// Decides the figure over an interval by its range there, or returns the claim that is open or wrong.
    fn decide(&self, claim: MotionClaim, [lower, upper]: [f64; 2]) -> Result<(), (MotionClaim, bool)> {
        if let Some(quantity) = self.missed_at(lower) {
            return Err((MotionClaim::Limit(quantity), true));
        }
        if let Some(quantity) = self.missed_at(upper) {
            return Err((MotionClaim::Limit(quantity), false));
        }
        // Between the samples, the figure may pass all of them. A comparison with NaN is false.
        let is_close = upper <= self.near || upper - lower <= SLACK * upper.abs();
        if is_close { Ok(()) } else { Err((claim, false)) }
    }
}

/// A proof in progress.
struct Proof<'a> {
    forms: TravelForms<'a>,
    motion: &'a TaskMotion,
    /// The distance to the limits with the opposite sign, the speed, and the force.
    figures: [Figure; 3],
    intervals: usize,
}

/// Returns the range of the magnitude of an enclosed number.
fn magnitude(value: &TaylorModel) -> [f64; 2] {
    let [lower, upper] = value.range();
    [lower.max(-upper).max(0.0), upper.max(-lower)]
}

/// Returns the range of the largest of some numbers; it is not a number if one of them is not.
fn largest(ranges: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    ranges.fold([f64::NEG_INFINITY; 2], |[lower, upper], [low, high]| {
        let is_known = !(low.is_nan() || high.is_nan() || lower.is_nan());
        if is_known {
            [lower.max(low), upper.max(high)]
        } else {
            [f64::NAN; 2]
        }
    })
}

impl Proof<'_> {
    /// Decides the claims over an interval of a piece, or returns the claim that is open or wrong there.
    fn examine(&mut self, piece: usize, interval: [f64; 2]) -> Result<(), (MotionClaim, bool)> {
        self.intervals += 1;
        let travel = self.forms.enclose(&self.motion.enclose(piece, interval));
        let Travel {
            reach,
            determinant,
            drives,
        } = travel.map_err(|is_beyond| (MotionClaim::Reach, is_beyond))?;
        if !determinant.is_positive() {
            return Err((MotionClaim::Singularity, determinant.is_negative()));
        }
        let ranges = [
            largest(reach.iter().map(|value| (-*value).range())),
            largest(drives.iter().map(|[speed, _]| magnitude(speed))),
            largest(drives.iter().map(|[_, force]| magnitude(force))),
        ];
        let claims = [MotionClaim::Reach, MotionClaim::Speed, MotionClaim::Force];
        for ((figure, claim), range) in self.figures.iter().zip(claims).zip(&ranges) {
            figure.decide(claim, *range)?;
        }
        for (figure, [_, upper]) in self.figures.iter_mut().zip(ranges) {
            figure.most = figure.most.max(upper);
        }
        Ok(())
    }

    /// Returns the bounds of the figures on the accepted intervals.
    fn bounds(&self) -> MotionBounds {
        let [reach, speed, force] = self.figures.each_ref().map(|figure| figure.most);
        MotionBounds {
            reach: -reach,
            speed,
            force,
        }
    }

    /// Decides the claims over all moments in turn. What is wrong counts more than what is open: where a figure passes its limit, the
    /// moment itself is open, and only what follows is refuted.
    fn run(&mut self) -> MotionVerdict {
        let mut open = Vec::new();
        let motion = self.motion;
        let mut stretches = motion.stretches();
        stretches.reverse();
        for (piece, (duration, begin)) in motion.durations().iter().zip(motion.begins()).enumerate() {
            let mut waiting = stretches.clone();
            while let Some([from, to]) = waiting.pop() {
                let Err((claim, is_wrong)) = self.examine(piece, [from, to]) else {
                    continue;
                };
                let middle = 0.5 * (from + to);
                let moment = MotionMoment {
                    piece,
                    time: begin + middle * duration,
                    claim,
                };
                if is_wrong {
                    return MotionVerdict::Refuted(moment);
                }
                let is_used_up = self.intervals >= MOST_INTERVALS;
                if to - from > SHORTEST && !is_used_up {
                    waiting.extend([[middle, to], [from, middle]]);
                    continue;
                }
                open.push(moment);
                if is_used_up || open.len() == MOST_OPEN {
                    return MotionVerdict::Open(open[0]);
                }
            }
        }
        match open.first() {
            Some(moment) => MotionVerdict::Open(*moment),
            None => MotionVerdict::Proved(self.bounds()),
        }
    }
}

impl Model {
    /// Proves that a design follows its motion at every moment, with the drive that it selects, and bounds the distance to the joint
    /// limits, and the speeds and forces of the actuators. `None` if the design does not follow the motion at its samples already, or if
    /// its bars have no usable stiffness.
    ///
    /// Root mean squares, powers and energies are those of the samples: of them nothing is proved.
    pub fn certify_motion(&self, design: &Design, outcome: &TaskOutcome) -> Option<MotionCertificate> {
        let (motion, figures) = (outcome.motion.as_ref()?, outcome.figures()?);
        let driven = self.driven_by(outcome.drive.map(|drive| drive.place));
        let begin = motion.rests().next()?.pose;
        let mut proof = Proof {
            forms: TravelForms::new(&driven, design, &begin)?,
            motion,
            figures: self.claims(design, outcome, figures),
            intervals: 0,
        };
        Some(MotionCertificate {
            verdict: proof.run(),
            intervals: proof.intervals,
        })
    }

    /// Returns the figures of a motion that are to be bounded, with their limits.
    fn claims(&self, design: &Design, outcome: &TaskOutcome, figures: &TaskFigures) -> [Figure; 3] {
        let bounds = |quantity: Quantity| {
            let limits = self.settings().limits.iter();
            limits
                .filter(move |limit| limit.quantity == quantity)
                .map(|limit| limit.bound)
        };
        let at_most = |quantity: Quantity| bounds(quantity).filter_map(move |bound| Some((quantity, bound.most()?)));
        let reach = bounds(Quantity::PathReach).filter_map(|bound| Some((Quantity::PathReach, -bound.least()?)));
        let [speed, force] = match design.architecture().actuator() {
            JointKind::Prismatic => [Quantity::PathSpeed, Quantity::PathForce],
            JointKind::Revolute => [Quantity::PathRate, Quantity::PathTorque],
        };
        let (mut speeds, mut forces): (Vec<_>, Vec<_>) = (at_most(speed).collect(), at_most(force).collect());
        let selected = outcome.drive.filter(|drive| drive.carries());
        if let Some(drive) = selected.and_then(|selected| self.settings().drive_catalogue.get(selected.place)) {
            speeds.push((Quantity::DriveUtilization, drive.speed));
            forces.push((Quantity::DriveUtilization, drive.peak));
        }
        [
            Figure::new(-figures.path_reach, reach.collect()),
            Figure::new(largest_of_legs(figures.peak_speed), speeds),
            Figure::new(largest_of_legs(figures.peak_force), forces),
        ]
    }
}
