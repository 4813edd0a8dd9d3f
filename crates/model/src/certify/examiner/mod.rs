//! What one box of positions and orientations shows: it is proved, lies beyond what matters, or is left to be divided.

mod bad_poses;

use glam::DVec2;

use super::forms::{Enclosures, Forms};
use super::pose_box::PoseBox;
use super::{BoxOutcome, CertifyError, CertifyOptions, ExaminedBox, Violation};
use crate::enclosure::{Interval, PoseEnclosure, TaylorModel};
use crate::evaluation::{Model, PoseScalar};
use crate::mechanism::Design;
use crate::spatial::Pose;
use crate::workspace::Region;

/// Largest number of contractions of one box.
const CONTRACTIONS: usize = 4;

/// A contraction is worth another one if it leaves less than this part of the box.
const WORTHWHILE: f64 = 0.3;

/// Radius beyond all reach, as a multiple of the sizes of the design.
const BEYOND: f64 = 4.0;

/// An infeasible pose.
#[derive(Debug, Clone, Copy)]
pub(super) struct BadPose {
    /// Its distance from the centre, rounded up \[m\].
    pub distance: f64,
    pub violation: Violation,
}

/// What the examination of a box has shown.
pub(super) struct Examination {
    /// The bad pose that is known, nearer than before if the box has one.
    pub bad: Option<BadPose>,
    /// Number of boxes that were enclosed.
    pub boxes: usize,
    /// What is told to an observer that watches.
    pub told: Vec<ExaminedBox>,
    /// The part that is to be divided.
    pub left: Option<PoseBox>,
}

/// Encloses boxes and tries poses of one design.
pub(super) struct Examiner<'a> {
    model: &'a Model,
    design: &'a Design,
    options: &'a CertifyOptions,
    forms: Forms<'a>,
    /// Orientations of the window, rounded outwards for boxes and inwards for poses \[rad\].
    pub window: [f64; 2],
    inner_window: [f64; 2],
    /// Range of the direction `θ` \[rad\].
    pub sector: f64,
    /// The prescribed region, if the claim is about that.
    pub region: Option<&'a Region>,
    /// Relative gap between the bounds at which the search ends.
    pub gap: f64,
    /// Whether an observer watches.
    pub is_watched: bool,
}

impl<'a> Examiner<'a> {
    pub fn new(
        model: &'a Model,
        design: &'a Design,
        options: &'a CertifyOptions,
        is_watched: bool,
    ) -> Result<Self, CertifyError> {
        let middle = Interval::exactly(options.phi_deg);
        let half = Interval::exactly(model.settings().workspace.rotation_range_deg) / Interval::exactly(2.0);
        let to_radians = Interval::PI / Interval::exactly(180.0);
        let [first, last] = [(middle - half) * to_radians, (middle + half) * to_radians];
        let turn = if model.is_symmetric(design) { 120.0 } else { 360.0 };
        let workspace = &model.settings().workspace;
        let region = Some(&workspace.region).filter(|region| options.is_of_region && region.is_prescribed());
        let within = match region {
            Some(Region::Polygon(polygon)) => polygon.corners()[0],
            _ => DVec2::ZERO,
        };
        Ok(Self {
            forms: Forms::new(model, design)?.with_sign_at(&Pose {
                position: workspace.centre + within,
                phi: options.phi_deg.to_radians(),
            }),
            region,
            model,
            design,
            options,
            window: [first.lower(), last.upper()],
            inner_window: [first.upper(), last.lower()],
            sector: Interval::radians(turn).upper(),
            gap: options.tolerance,
            is_watched,
        })
    }

    /// Whether the claim is about the region that the study prescribes.
    pub fn is_prescribed(&self) -> bool {
        self.region.is_some()
    }

    /// The radius up to which boxes must be proved, where a bad pose is known or none.
    pub fn target(&self, bad: Option<BadPose>) -> f64 {
        match self.region {
            Some(Region::Disc(radius)) => return *radius,
            Some(_) => return f64::INFINITY,
            None => {}
        }
        if let Some(radius) = self.options.blind_radius {
            return radius;
        }
        match bad.map(|bad| bad.distance) {
            // A few places more, so that rounding does not make the gap wider than the tolerance.
            Some(upper) => upper * (1.0 - self.gap) * (1.0 + 16.0 * f64::EPSILON),
            None => {
                let design = self.design;
                let centre = self.model.settings().workspace.centre.length();
                BEYOND * (self.model.extent(design) + centre)
            }
        }
    }

    fn enclose_box(&self, part: &PoseBox) -> Enclosures {
        let (phi, by_phi) = part.middle_and_radius(2);
        let (phi_sine, phi_cosine) = TaylorModel::sine_and_cosine(2, phi, by_phi);
        let centre = self.model.settings().workspace.centre;
        let [x, y] = part.patch.enclose([0, 1].map(|k| part.middle_and_radius(k)));
        let pose = PoseEnclosure {
            position: [x.plus(Interval::exactly(centre.x)), y.plus(Interval::exactly(centre.y))],
            cosine: phi_cosine,
            sine: phi_sine,
        };
        self.forms.enclose_limits(&pose, part.proved)
    }

    /// Proves or contracts one box. `bad` is the bad pose that is known.
    pub fn examine(&self, mut part: PoseBox, bad: Option<BadPose>) -> Examination {
        let mut shown = Examination {
            bad,
            boxes: 0,
            told: Vec::new(),
            left: None,
        };
        for _ in 0..=CONTRACTIONS {
            if part.lower[0] >= self.target(shown.bad) {
                return self.told(shown, &part, BoxOutcome::Beyond, None);
            }
            // The box is cut before it is enclosed: what is found refers to the box as enclosed.
            part.upper[0] = part.upper[0].min(self.target(shown.bad));
            shown.boxes += 1;
            let found = self.enclose_box(&part);
            let open: Vec<&(PoseScalar, TaylorModel)> = found.open().collect();
            if found.is_complete && open.is_empty() {
                let decisive = weakest(found.iter().filter(|_| self.is_watched));
                return self.told(shown, &part, BoxOutcome::Proved, decisive);
            }
            part.proved = part.proved.with(&found);
            let worst = weakest(open.iter().copied());
            self.try_poses(&mut shown.bad, &part, &found, worst);
            if part.lower[0] >= self.target(shown.bad) {
                return self.told(shown, &part, BoxOutcome::Beyond, worst);
            }
            if !found.is_complete || !found.may_contract {
                break;
            }
            let before = part;
            let open: Vec<&TaylorModel> = open.iter().map(|(_, value)| value).collect();
            if !part.contract(&open) {
                return self.told(shown, &before, BoxOutcome::Proved, worst);
            }
            if self.is_watched {
                for part in before.cut_to(&part) {
                    shown = self.told(shown, &part, BoxOutcome::Proved, worst);
                }
            }
            if part.volume() >= WORTHWHILE * before.volume() {
                break;
            }
        }
        shown.left = Some(part);
        shown
    }

    /// Adds what became of a box, if an observer watches; `decisive` is the constraint that is nearest to its threshold on it.
    fn told(
        &self,
        mut shown: Examination,
        part: &PoseBox,
        outcome: BoxOutcome,
        decisive: Option<&(PoseScalar, TaylorModel)>,
    ) -> Examination {
        if self.is_watched {
            let scalar = decisive.map(|&(scalar, _)| scalar);
            shown.told.push(examined_box(part, outcome, scalar, shown.bad));
        }
        shown
    }
}

/// Returns what became of a box, with the constraint that is nearest to its threshold on it, or that a bad pose violates.
pub(super) fn examined_box(
    part: &PoseBox,
    outcome: BoxOutcome,
    decisive: Option<PoseScalar>,
    bad: Option<BadPose>,
) -> ExaminedBox {
    ExaminedBox {
        patch: part.patch,
        lower: part.lower,
        upper: part.upper,
        outcome,
        scalar: decisive
            .or(bad.map(|bad| bad.violation.scalar))
            .unwrap_or(PoseScalar::Reach),
        depth: part.depth,
    }
}

/// Returns the constraint that is nearest to its threshold, relative to the size of its value.
fn weakest<'a>(values: impl Iterator<Item = &'a (PoseScalar, TaylorModel)>) -> Option<&'a (PoseScalar, TaylorModel)> {
    values.min_by(|(_, a), (_, b)| relative_least(a).total_cmp(&relative_least(b)))
}

/// Lower bound of a value as a multiple of its size, by which the values of different constraints are compared.
fn relative_least(value: &TaylorModel) -> f64 {
    let [lower, upper] = value.range();
    lower / upper.abs().max(lower.abs()).max(f64::MIN_POSITIVE)
}
