//! The constraints as functions that are positive, all those of one together, where it holds strictly (docs/model.md, section 13.3).
//!
//! They are cleared of roots and quotients where this keeps the enclosures narrow, and most are written apart from those that the
//! evaluation uses. Where the evaluation has many formulas (`strength`, `motion`, `reach`), these run on enclosed
//! numbers.

mod bars;
mod clearance;
mod compliances;
mod motion;
mod out_of_plane;
mod plain;
mod rails;
mod reach;
mod stiffness;
mod strength;
mod travel;

use clearance::{MemberBoxes, Separations};
use compliances::Compliances;
use motion::MotionForms;
use reach::ReachForms;
use strength::StrengthForms;
pub(super) use travel::{Travel, TravelForms};

use super::CertifyError;
use crate::enclosure::{Interval, PoseEnclosure, TaylorModel, VARIABLES, cross, dot};
use crate::evaluation::{Model, PoseScalar, Thresholds};
use crate::kinematics::CharacteristicLength;
use crate::mechanism::{AnyLeg, Design, JointKind, LegEnclosure, LegFrameEnclosure};
use crate::pose::{PoseChecker, ScalarSet};
use crate::spatial::{LEGS, Pose};

/// Returns a limited scalar that has no form, such as one of the region as a whole.
pub(super) fn uncovered(thresholds: &Thresholds) -> Option<PoseScalar> {
    let mut limited = thresholds.iter().map(|(scalar, _)| scalar);
    limited.find(|scalar| !scalar.entry().is_enclosed)
}

/// The scalars whose limits are proved on a box, and therefore on every part of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct ProvedForms(ScalarSet);

impl ProvedForms {
    /// Everything but the limit of one scalar, where no other is of interest.
    pub fn all_but(scalar: PoseScalar) -> Self {
        Self(ScalarSet::default().with(scalar).complement())
    }

    /// Adds the constraints that, of those that are open on a box, its polynomials tell to hold at `ε`.
    pub fn with_those_that_hold_at(self, found: &Enclosures, epsilon: [f64; VARIABLES]) -> Self {
        if !found.is_complete {
            return self;
        }
        let fails = found.open().filter(|(_, value)| {
            // A comparison with NaN is false: nothing is told then.
            let holds = value.value(epsilon) - value.remainder > 0.0;
            !holds
        });
        let fails: ScalarSet = fails.map(|(scalar, _)| *scalar).collect();
        Self(self.0.or(fails.complement()))
    }

    /// Whether every constraint is proved.
    pub fn is_all(self) -> bool {
        self.0 == ScalarSet::all()
    }

    /// Whether the limit of a scalar is proved.
    pub fn contains(self, scalar: PoseScalar) -> bool {
        self.0.contains(scalar)
    }

    /// Adds what is proved on a box on which `found` was enclosed.
    pub fn with(self, found: &Enclosures) -> Self {
        // Where a leg may not reach, nothing is known of the others.
        if !found.is_complete {
            return self;
        }
        let open: ScalarSet = found.open().map(|(scalar, _)| *scalar).collect();
        // What a leg reaches is part of every other constraint, and is enclosed in any case.
        Self(self.0.or(open.with(PoseScalar::Reach).complement()))
    }
}

/// The constraints over a box of poses.
#[derive(Debug, Clone)]
pub(super) struct Enclosures {
    values: Vec<(PoseScalar, TaylorModel)>,
    /// Places of the values that are not proved to be positive.
    open: Vec<usize>,
    /// Whether every constraint could be evaluated: where a leg may not reach, the others have no value.
    pub is_complete: bool,
    /// Whether the forms tell of every part of the box by themselves, so that parts on which they are positive may be cut off.
    pub may_contract: bool,
    /// Constraints that need no form.
    proved: ProvedForms,
}

impl Enclosures {
    fn new(proved: ProvedForms) -> Self {
        Self {
            values: Vec::with_capacity(3 * LEGS + 8),
            open: Vec::new(),
            is_complete: true,
            may_contract: true,
            proved,
        }
    }

    fn push(&mut self, scalar: PoseScalar, value: TaylorModel) {
        if !value.is_positive() {
            self.open.push(self.values.len());
        }
        self.values.push((scalar, value));
    }

    fn count(&self) -> usize {
        self.values.len()
    }

    fn needs(&self, scalar: PoseScalar) -> bool {
        !self.proved.contains(scalar)
    }

    /// The constraints that are not proved, with their values.
    pub fn open(&self) -> impl Iterator<Item = &(PoseScalar, TaylorModel)> {
        self.open.iter().map(|&place| &self.values[place])
    }

    /// The constraints that are proved to be violated, of those at a pose.
    pub fn violated(&self) -> impl Iterator<Item = PoseScalar> {
        let violated = self.iter().filter(|(_, value)| value.is_negative());
        violated.map(|&(scalar, _)| scalar)
    }

    /// The constraints with their values.
    pub fn iter(&self) -> impl Iterator<Item = &(PoseScalar, TaylorModel)> {
        self.values.iter()
    }
}

/// How closely constraints are enclosed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Detail {
    /// The enclosures contain the values.
    Values,
    /// The enclosures tell where the constraints hold, and need not contain values that are better than the limit.
    Limits,
}

/// The constraints of one design, prepared for many boxes.
pub(super) struct Forms<'a> {
    /// Sign of `det A` at the home pose.
    sign: f64,
    design: &'a Design,
    model: &'a Model,
    frames: [LegFrameEnclosure; LEGS],
    compliance: Compliances,
    /// `r / ℓ`.
    to_length: Interval,
    /// What g7 needs, if the study requires a clearance.
    separations: Option<Separations>,
    /// What a limit of the distance to the joint limits needs, if there is one.
    reach: Option<ReachForms>,
    /// What the limits of the strength need, if there are any.
    strength: Option<StrengthForms>,
    /// What the limits of a motion need, if there are any.
    motion: Option<MotionForms>,
    /// The design in plain numbers, if there are limits that take long.
    slow: Option<PoseChecker<AnyLeg>>,
}

impl<'a> Forms<'a> {
    /// Prepares the forms of a design; the sign of `det A` counts as positive.
    pub fn new(model: &'a Model, design: &'a Design) -> Result<Self, CertifyError> {
        let frames = [0, 1, 2].map(|index| LegFrameEnclosure::new(design, &model.settings().legs.geometry, index));
        let (strength, motion) = (StrengthForms::new(model, design), MotionForms::new(model, design));
        let slow = model.thresholds_of(design).that_take_long();
        Ok(Self {
            sign: 1.0,
            design,
            model,
            compliance: Compliances::new(model, design)?,
            to_length: Interval::exactly(design.platform_radius()) / characteristic_length(model, design, &frames),
            separations: Separations::new(model, design),
            reach: ReachForms::new(model, design),
            slow: (!slow.is_empty()).then(|| model.checker(design)),
            strength,
            motion,
            frames,
        })
    }

    /// Takes the sign of `det A` from a pose; if it cannot be told there, it stays positive.
    pub fn with_sign_at(mut self, pose: &Pose) -> Self {
        if let Ok(found) = self.model.pose(self.design, pose)
            && found.values[PoseScalar::Determinant] < 0.0
        {
            self.sign = -1.0;
        }
        self
    }

    /// Encloses the constraints over a box of poses, but for those that are proved there: a constraint holds where all its values are
    /// positive.
    pub fn enclose(&self, pose: &PoseEnclosure, proved: ProvedForms) -> Enclosures {
        self.enclose_with(pose, proved, (Detail::Values, Separations::enclose))
    }

    /// Encloses the constraints over a box of poses, but for those that are proved there, no closer than it takes to tell where they hold.
    pub fn enclose_limits(&self, pose: &PoseEnclosure, proved: ProvedForms) -> Enclosures {
        self.enclose_with(pose, proved, (Detail::Limits, Separations::enclose))
    }

    /// Encloses the constraints over a box without width, but for those that are proved there, and for limits that take long and that plain
    /// numbers keep: each value is negative only where the constraint is violated.
    pub fn enclose_pose(&self, pose: &PoseEnclosure, proved: ProvedForms) -> Enclosures {
        let proved = self.with_those_kept_at(proved, pose);
        self.enclose_with(pose, proved, (Detail::Values, Separations::enclose_pose))
    }

    fn enclose_with(
        &self,
        pose: &PoseEnclosure,
        proved: ProvedForms,
        (detail, separate): (Detail, fn(&Separations, &MemberBoxes, &mut Enclosures)),
    ) -> Enclosures {
        let mut found = Enclosures::new(proved);
        let legs = enclose_legs(self.model, self.design, &self.frames, pose);
        for reach in legs.iter().flat_map(|leg| leg.chain.reach) {
            found.push(PoseScalar::Reach, reach);
            found.is_complete &= reach.is_positive();
        }
        if found.is_complete {
            if found.needs(self.dexterity()) {
                self.enclose_dexterity(&legs, &mut found);
            }
            self.enclose_transmission(&legs, &mut found);
            self.enclose_stiffness(&legs, &mut found);
            if let Some(separations) = &self.separations
                && found.needs(PoseScalar::Clearance)
            {
                let boxes = separations.lay_out(self.design, &self.frames, pose, &legs);
                separate(separations, &boxes, &mut found);
            }
            found.is_complete = found.values.iter().all(|(_, value)| !value.range()[0].is_nan());
            if found.is_complete {
                self.enclose_reach(pose, &legs, &mut found);
                self.enclose_strength(&legs, (detail, &mut found));
                self.enclose_motion(pose, &legs, &mut found);
            }
        }
        found
    }

    /// The limit of a scalar; 0 without one.
    fn limit(&self, scalar: PoseScalar) -> f64 {
        self.model.settings().thresholds.get(scalar).unwrap_or(0.0)
    }

    /// The scalar that keeps poses away from singularities: that of g3, or `det A` if g3 has no threshold.
    fn dexterity(&self) -> PoseScalar {
        if self.limit(PoseScalar::Dexterity) > 0.0 {
            PoseScalar::Dexterity
        } else {
            PoseScalar::Determinant
        }
    }

    /// g3, `9 D² − t² Σ β_i² (μ_j² + μ_k² − 2 μ_j μ_k C_i + w_i²) Σ (1 + μ_i²)/β_i²`, where `t` is the threshold. If that is 0,
    /// `det A` takes its place, with the sign that it has at the home pose.
    fn enclose_dexterity(&self, legs: &[LegEnclosure; LEGS], found: &mut Enclosures) {
        let one = TaylorModel::exactly(1.0);
        // Legs are large, and `map` would copy them.
        let moments = [0, 1, 2].map(|i| legs[i].moment.scaled(self.to_length));
        let squares = moments.map(|moment| moment.squared());
        let mut determinant = TaylorModel::exactly(0.0);
        let (mut forward, mut inverse) = (TaylorModel::exactly(0.0), TaylorModel::exactly(0.0));
        for i in 0..LEGS {
            let [j, k] = others(i);
            let (turn, cosine) = (turn(legs, i), dot(legs[j].u, legs[k].u));
            determinant = determinant + moments[i] * turn;
            let mixed = (moments[j] * moments[k] * cosine).times(2.0);
            let row = squares[j] + squares[k] - mixed + turn.squared();
            forward = forward + legs[i].transmission_square * row;
            inverse = inverse + (one + squares[i]) * legs[i].transmission_square.reciprocal();
        }
        let scalar = self.dexterity();
        let value = if scalar == PoseScalar::Dexterity {
            let threshold = Interval::exactly(self.limit(PoseScalar::Dexterity));
            determinant.squared().times(9.0) - (forward * inverse).scaled(threshold.square())
        } else {
            determinant.times(self.sign)
        };
        found.push(scalar, value);
    }

    /// The least transmission, `B_ii² − (t a)²` of each leg, where `t` is the threshold and `a` the lever of a revolute actuator.
    fn enclose_transmission(&self, legs: &[LegEnclosure; LEGS], found: &mut Enclosures) {
        let threshold = self.limit(PoseScalar::Transmission);
        if threshold <= 0.0 || !found.needs(PoseScalar::Transmission) {
            return;
        }
        let architecture = self.design.architecture();
        let lever = match architecture.actuator() {
            JointKind::Prismatic => Interval::exactly(1.0),
            JointKind::Revolute => Interval::exactly(architecture.longest_lever(self.design)) * self.frames[0].to_unit,
        };
        let least = (Interval::exactly(threshold) * lever).square();
        for leg in legs {
            found.push(PoseScalar::Transmission, leg.transmission_square.plus(-least));
        }
    }
}

/// Encloses the legs of a design over a box of poses.
fn enclose_legs(
    model: &Model,
    design: &Design,
    frames: &[LegFrameEnclosure; LEGS],
    pose: &PoseEnclosure,
) -> [LegEnclosure; LEGS] {
    let leg = |index: usize| AnyLeg::enclose(&frames[index], design, &model.settings().legs, pose);
    [leg(0), leg(1), leg(2)]
}

/// The two legs after leg `i`, in turn.
fn others(i: usize) -> [usize; 2] {
    [(i + 1) % LEGS, (i + 2) % LEGS]
}

/// `w_i = u_j × u_k`.
fn turn(legs: &[LegEnclosure; LEGS], i: usize) -> TaylorModel {
    let [j, k] = others(i);
    cross(legs[j].u, legs[k].u)
}

fn sum_of_legs(term: impl Fn(usize) -> TaylorModel) -> TaylorModel {
    term(0) + term(1) + term(2)
}

/// Encloses `det A` as a multiple of `r`.
fn determinant(legs: &[LegEnclosure; LEGS]) -> TaylorModel {
    sum_of_legs(|i| legs[i].moment * turn(legs, i))
}

/// Encloses the characteristic length \[m\].
///
/// The isotropic length is the largest of a finite set: the moments at the orientations of the reference grid with `P` at `O`. An
/// orientation of which it is not known whether it is reached may or may not count.
fn characteristic_length(model: &Model, design: &Design, frames: &[LegFrameEnclosure; LEGS]) -> Interval {
    let platform = Interval::exactly(design.platform_radius());
    match model.settings().characteristic_length {
        CharacteristicLength::PlatformRadius => platform,
        CharacteristicLength::Fixed(length) => Interval::exactly(length),
        CharacteristicLength::Isotropic => {
            let grid = &model.settings().reference_grid;
            // The largest moment of the orientations that are reached for certain, and of all that may be.
            let ([mut certain_least, mut certain_largest], mut possible) = ([0.0_f64; 2], 0.0_f64);
            let mut is_certain = false;
            for k in 0..grid.orientations() {
                let phi = Interval::radians(k as f64 * grid.phi_step_deg());
                let pose = PoseEnclosure::point([Interval::exactly(0.0); 2], phi);
                let legs = enclose_legs(model, design, frames, &pose);
                let mut limits = legs.iter().flat_map(|leg| leg.chain.reach).map(|limit| limit.range());
                if limits.clone().any(|[_, upper]| upper < 0.0) {
                    continue;
                }
                let is_reached = limits.all(|[lower, _]| lower > 0.0);
                is_certain |= is_reached;
                for [lower, upper] in legs.iter().map(|leg| leg.moment.range()) {
                    if lower.is_nan() || upper.is_nan() {
                        return Interval::exactly(f64::NAN);
                    }
                    let (least, largest) = (lower.max(-upper).max(0.0), upper.max(-lower));
                    possible = possible.max(largest);
                    if is_reached {
                        certain_least = certain_least.max(least);
                        certain_largest = certain_largest.max(largest);
                    }
                }
            }
            let to_length = Interval::exactly(2.0).sqrt() * platform;
            let largest = Interval::new(certain_least, certain_largest.max(possible)) * to_length;
            if is_certain && largest.lower() > 0.0 {
                largest
            } else if possible == 0.0 {
                platform
            } else {
                // It may also be that no orientation is reached, for which the length is r.
                Interval::new(
                    platform.lower().min(largest.lower()),
                    platform.upper().max(largest.upper()),
                )
            }
        }
    }
}
