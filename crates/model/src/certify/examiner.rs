//! What one box of positions and orientations shows: it is proved, lies beyond what matters, or is left to be divided.

use glam::DVec2;

use super::forms::{Enclosures, Forms, ProvedForms};
use super::patch::Patch;
use super::pose_box::PoseBox;
use super::{BoxOutcome, CertifyError, CertifyOptions, ExaminedBox, Violation};
use crate::enclosure::{Interval, PoseEnclosure, TaylorModel, VARIABLES};
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

    /// The pose at a point of a patch, within the window.
    fn pose_at(&self, patch: Patch, [first, second, phi]: [f64; VARIABLES]) -> Pose {
        Pose {
            position: self.model.settings().workspace.centre + patch.position([first, second]),
            phi: phi.clamp(self.inner_window[0], self.inner_window[1]),
        }
    }

    /// Returns a constraint that is proved to be violated at a pose, of those that are not proved there.
    fn violated_at(&self, pose: &Pose, proved: ProvedForms) -> Option<PoseScalar> {
        let position = pose.position.to_array().map(Interval::exactly);
        let pose = PoseEnclosure::point(position, Interval::exactly(pose.phi));
        self.forms.enclose_pose(&pose, proved).violated().next()
    }

    /// Takes the pose at a point if it is bad and nearer than the one that is known; returns a constraint that it violates, of those that are
    /// not proved there.
    fn try_point(&self, bad: &mut Option<BadPose>, point: [f64; VARIABLES], proved: ProvedForms) -> Option<PoseScalar> {
        self.try_point_of(bad, Patch::Disc, point, proved)
    }

    /// Does what [`Examiner::try_point`] does with a point of a patch.
    fn try_point_of(
        &self,
        bad: &mut Option<BadPose>,
        patch: Patch,
        point: [f64; VARIABLES],
        proved: ProvedForms,
    ) -> Option<PoseScalar> {
        // In a window without width, no double is known to lie.
        let [first, last] = self.inner_window;
        if self.options.blind_radius.is_some() || first > last || proved.is_all() {
            return None;
        }
        let pose = self.pose_at(patch, point);
        let scalar = self.violated_at(&pose, proved)?;
        let distance = self.distance(&pose);
        if bad.is_none_or(|bad| distance < bad.distance) {
            let violation = Violation { pose, scalar };
            *bad = Some(BadPose { distance, violation });
        }
        Some(scalar)
    }

    /// Returns the distance of a pose from the centre, rounded up.
    fn distance(&self, pose: &Pose) -> f64 {
        let centre = self.model.settings().workspace.centre;
        if pose.position == centre {
            return 0.0;
        }
        let part = |at: f64, of: f64| (Interval::exactly(at) - Interval::exactly(of)).square();
        let square = part(pose.position.x, centre.x) + part(pose.position.y, centre.y);
        square.sqrt().upper()
    }

    /// Looks for bad poses: those of a ring just beyond the claimed radius, each moved inwards as long as it stays bad.
    pub fn find_bad_poses(&self) -> Option<BadPose> {
        const DIRECTIONS: usize = 24;
        const ORIENTATIONS: usize = 5;
        let [first, last] = self.inner_window;
        let mut bad = None;
        if first > last {
            return bad;
        }
        let limit = self.target(bad);
        let mut radius = if self.options.claimed_radius > 0.0 {
            1.005 * self.options.claimed_radius
        } else {
            0.05 * self.design.base_radius()
        };
        for place in 0..=4 * ORIENTATIONS {
            let phi = first + (last - first) * place as f64 / (4 * ORIENTATIONS) as f64;
            self.try_point(&mut bad, [0.0, 0.0, phi], ProvedForms::default());
        }
        while bad.is_none() && radius < limit {
            for place in 0..DIRECTIONS * ORIENTATIONS {
                let theta = self.sector * (place % DIRECTIONS) as f64 / DIRECTIONS as f64;
                let phi = first + (last - first) * (place / DIRECTIONS) as f64 / (ORIENTATIONS - 1) as f64;
                let point = [radius, theta, phi];
                if bad.is_none_or(|bad| radius <= bad.distance)
                    && let Some(scalar) = self.try_point(&mut bad, point, ProvedForms::default())
                {
                    self.move_inwards(&mut bad, point, scalar);
                }
            }
            radius *= 1.5;
        }
        bad
    }

    /// Moves a bad point towards the centre while it stays bad: along the ray by halving, and sideways by a pattern search.
    /// Only the constraint that it violates is looked at, which any bad pose nearer to the centre may violate.
    fn move_inwards(&self, bad: &mut Option<BadPose>, mut point: [f64; VARIABLES], scalar: PoseScalar) {
        let others = ProvedForms::all_but(scalar);
        let [first, last] = self.inner_window;
        let mut steps = [0.05, 0.2 * (last - first)];
        for _ in 0..40 {
            point[0] = self.nearest_bad(bad, point, scalar);
            let mut has_moved = false;
            for (k, &step) in [1, 2].iter().zip(&steps) {
                for direction in [-1.0, 1.0] {
                    let mut moved = point;
                    moved[*k] += direction * step;
                    moved[2] = moved[2].clamp(first, last);
                    moved[0] *= 1.0 - 1e-6;
                    if self.try_point(bad, moved, others).is_some() {
                        point = moved;
                        has_moved = true;
                        break;
                    }
                }
            }
            if !has_moved {
                steps = steps.map(|step| 0.3 * step);
            }
            if steps[0] < 1e-6 {
                break;
            }
        }
        self.nearest_bad(bad, point, scalar);
    }

    /// Returns the least radius found at which the pose in the direction of a bad point violates the same constraint.
    fn nearest_bad(&self, known: &mut Option<BadPose>, point: [f64; VARIABLES], scalar: PoseScalar) -> f64 {
        let others = ProvedForms::all_but(scalar);
        let (mut good, mut bad) = (0.95 * point[0], point[0]);
        for _ in 0..18 {
            let middle = 0.5 * (good + bad);
            if self.try_point(known, [middle, point[1], point[2]], others).is_some() {
                bad = middle;
            } else {
                good = middle;
            }
        }
        bad
    }

    /// Tries poses of the boundary of a prescribed region: those at which a constraint is most often missed.
    pub fn try_boundary(&self) -> Option<BadPose> {
        const POSITIONS: usize = 48;
        const ORIENTATIONS: usize = 5;
        let mut bad = None;
        let region = self.region?;
        let [first, last] = self.inner_window;
        for position in region.outline(POSITIONS) {
            for place in 0..ORIENTATIONS {
                let phi = first + (last - first) * place as f64 / (ORIENTATIONS - 1) as f64;
                let at = Patch::Rectangle([position; 2]);
                self.try_point_of(&mut bad, at, [position.x, position.y, phi], ProvedForms::default());
            }
        }
        bad
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

    /// Tries the poses of a box that are likely to be bad: its middle, and the one at which the polynomial of the weakest constraint is
    /// least.
    fn try_poses(
        &self,
        bad: &mut Option<BadPose>,
        part: &PoseBox,
        found: &Enclosures,
        worst: Option<&(PoseScalar, TaylorModel)>,
    ) {
        // What the polynomials tell of a pose need not be tried.
        let known_at = |epsilon| part.proved.with_those_that_hold_at(found, epsilon);
        let middle = part.point([0.0; VARIABLES]);
        self.try_point_of(bad, part.patch, middle, known_at([0.0; VARIABLES]));
        if part.lower[0] == 0.0 && part.patch == Patch::Disc {
            self.try_point(bad, [0.0, 0.0, middle[2]], part.proved);
        }
        if let Some(least) = worst.map(|(_, value)| value.least_point()) {
            let point = part.point(least);
            if let Some(scalar) = self.try_point_of(bad, part.patch, point, known_at(least))
                && !self.is_prescribed()
            {
                self.nearest_bad(bad, point, scalar);
            }
        }
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
