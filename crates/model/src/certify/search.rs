//! Branch and bound over boxes of positions and orientations.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec2;

use super::forms::{Enclosures, Forms, ProvedForms};
use super::patch::Patch;
use super::pose_box::PoseBox;
use super::{BoxOutcome, Certificate, CertifyError, CertifyOptions, ExaminedBox, ProofObserver, Verdict, Violation};
use crate::enclosure::{Interval, PoseEnclosure, TaylorModel, VARIABLES};
use crate::evaluation::{Model, PoseScalar};
use crate::mechanism::Design;
use crate::spatial::Pose;
use crate::workspace::Region;

/// A box narrower than this multiple of `R` is not divided.
const NARROWEST: f64 = 1e-11;

/// Largest number of contractions of one box.
const CONTRACTIONS: usize = 4;

/// A contraction is worth another one if it leaves less than this part of the box.
const WORTHWHILE: f64 = 0.3;

/// Number of boxes after which a proof asks whether it goes on.
const BOXES_BETWEEN_QUESTIONS: usize = 64;

/// Radius beyond all reach, as a multiple of the sizes of the design.
const BEYOND: f64 = 4.0;

pub(super) fn certify(
    model: &Model,
    design: &Design,
    options: &CertifyOptions,
    observer: &mut dyn ProofObserver,
) -> Result<Certificate, CertifyError> {
    let mut proof = Proof::new(model, design, options, observer)?;
    if options.blind_radius.is_none() {
        if proof.is_prescribed() {
            proof.try_boundary();
        } else {
            proof.find_bad_poses();
        }
    }
    proof.divide();
    proof.report_rest();
    Ok(proof.certificate())
}

struct Proof<'a> {
    model: &'a Model,
    design: &'a Design,
    options: &'a CertifyOptions,
    observer: &'a mut dyn ProofObserver,
    forms: Forms<'a>,
    /// Orientations of the window, rounded outwards for boxes and inwards for poses \[rad\].
    window: [f64; 2],
    inner_window: [f64; 2],
    /// Range of the direction `θ` \[rad\].
    sector: f64,
    /// The prescribed region, if the claim is about that.
    region: Option<&'a Region>,
    upper: Option<f64>,
    violation: Option<Violation>,
    heap: BinaryHeap<Reverse<PoseBox>>,
    /// Least distance of the boxes that were put aside.
    aside: f64,
    /// Everything nearer than this is proved, apart from the boxes that were put aside.
    proved: f64,
    /// Relative gap between the bounds at which the search ends.
    gap: f64,
    boxes: usize,
    created: usize,
    is_out_of_budget: bool,
}

impl<'a> Proof<'a> {
    fn new(
        model: &'a Model,
        design: &'a Design,
        options: &'a CertifyOptions,
        observer: &'a mut dyn ProofObserver,
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
            observer,
            window: [first.lower(), last.upper()],
            inner_window: [first.upper(), last.lower()],
            sector: Interval::radians(turn).upper(),
            upper: None,
            violation: None,
            heap: BinaryHeap::new(),
            aside: f64::INFINITY,
            proved: 0.0,
            gap: options.tolerance,
            boxes: 0,
            created: 0,
            is_out_of_budget: false,
        })
    }

    /// The radius up to which boxes must be proved.
    fn target(&self) -> f64 {
        match self.region {
            Some(Region::Disc(radius)) => return *radius,
            Some(_) => return f64::INFINITY,
            None => {}
        }
        if let Some(radius) = self.options.blind_radius {
            return radius;
        }
        match self.upper {
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
        self.forms.enclose(&pose, part.proved)
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

    /// Lowers the upper bound if the pose at a point is bad; returns a constraint that it violates, of those that are not proved
    /// there.
    fn try_point(&mut self, point: [f64; VARIABLES], proved: ProvedForms) -> Option<PoseScalar> {
        self.try_point_of(Patch::Disc, point, proved)
    }

    /// Does what [`Proof::try_point`] does with a point of a patch.
    fn try_point_of(&mut self, patch: Patch, point: [f64; VARIABLES], proved: ProvedForms) -> Option<PoseScalar> {
        // In a window without width, no double is known to lie.
        let [first, last] = self.inner_window;
        if self.options.blind_radius.is_some() || first > last || proved.is_all() {
            return None;
        }
        let pose = self.pose_at(patch, point);
        let scalar = self.violated_at(&pose, proved)?;
        let distance = self.distance(&pose);
        if self.upper.is_none_or(|upper| distance < upper) {
            self.upper = Some(distance);
            self.violation = Some(Violation { pose, scalar });
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
    fn find_bad_poses(&mut self) {
        const DIRECTIONS: usize = 24;
        const ORIENTATIONS: usize = 5;
        let [first, last] = self.inner_window;
        if first > last {
            return;
        }
        let limit = self.target();
        let mut radius = if self.options.claimed_radius > 0.0 {
            1.005 * self.options.claimed_radius
        } else {
            0.05 * self.design.base_radius()
        };
        for place in 0..=4 * ORIENTATIONS {
            let phi = first + (last - first) * place as f64 / (4 * ORIENTATIONS) as f64;
            self.try_point([0.0, 0.0, phi], ProvedForms::default());
        }
        while self.upper.is_none() && radius < limit {
            for place in 0..DIRECTIONS * ORIENTATIONS {
                let theta = self.sector * (place % DIRECTIONS) as f64 / DIRECTIONS as f64;
                let phi = first + (last - first) * (place / DIRECTIONS) as f64 / (ORIENTATIONS - 1) as f64;
                let point = [radius, theta, phi];
                if self.upper.is_none_or(|upper| radius <= upper)
                    && let Some(scalar) = self.try_point(point, ProvedForms::default())
                {
                    self.move_inwards(point, scalar);
                }
            }
            radius *= 1.5;
        }
    }

    /// Moves a bad point towards the centre while it stays bad: along the ray by halving, and sideways by a pattern search.
    /// Only the constraint that it violates is looked at, which any bad pose nearer to the centre may violate.
    fn move_inwards(&mut self, mut point: [f64; VARIABLES], scalar: PoseScalar) {
        let others = ProvedForms::all_but(scalar);
        let [first, last] = self.inner_window;
        let mut steps = [0.05, 0.2 * (last - first)];
        for _ in 0..40 {
            point[0] = self.nearest_bad(point, scalar);
            let mut has_moved = false;
            for (k, &step) in [1, 2].iter().zip(&steps) {
                for direction in [-1.0, 1.0] {
                    let mut moved = point;
                    moved[*k] += direction * step;
                    moved[2] = moved[2].clamp(first, last);
                    moved[0] *= 1.0 - 1e-6;
                    if self.try_point(moved, others).is_some() {
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
        self.nearest_bad(point, scalar);
    }

    /// Returns the least radius found at which the pose in the direction of a bad point violates the same constraint.
    fn nearest_bad(&mut self, point: [f64; VARIABLES], scalar: PoseScalar) -> f64 {
        let others = ProvedForms::all_but(scalar);
        let (mut good, mut bad) = (0.95 * point[0], point[0]);
        for _ in 0..18 {
            let middle = 0.5 * (good + bad);
            if self.try_point([middle, point[1], point[2]], others).is_some() {
                bad = middle;
            } else {
                good = middle;
            }
        }
        bad
    }

    /// Tries poses of the boundary of a prescribed region: those at which a constraint is most often missed.
    fn try_boundary(&mut self) {
        const POSITIONS: usize = 48;
        const ORIENTATIONS: usize = 5;
        let Some(region) = self.region else { return };
        let [first, last] = self.inner_window;
        for position in region.outline(POSITIONS) {
            for place in 0..ORIENTATIONS {
                let phi = first + (last - first) * place as f64 / (ORIENTATIONS - 1) as f64;
                let at = Patch::Rectangle([position; 2]);
                self.try_point_of(at, [position.x, position.y, phi], ProvedForms::default());
            }
        }
    }

    /// Pushes the boxes with which the search begins; those of a disc begin at the distance `from`.
    fn push_whole(&mut self, from: f64) {
        let [first, last] = self.window;
        for patch in self.region.map_or(vec![Patch::Disc], Patch::of) {
            let [along, across] = patch.ranges(self.target(), self.sector);
            let least = along[0].max(from);
            self.push(&PoseBox {
                patch,
                lower: [least, across[0], first],
                upper: [along[1], across[1], last],
                proved: ProvedForms::default(),
                depth: 0,
                number: 0,
            });
        }
    }

    /// Whether the claim is about the region that the study prescribes.
    fn is_prescribed(&self) -> bool {
        self.region.is_some()
    }

    /// Divides the region until everything within the target is proved, or the number of boxes is used up.
    fn divide(&mut self) {
        let is_enough = |proof: &Self| match proof.region {
            Some(_) => proof.violation.is_some(),
            None => proof.upper.is_some_and(|upper| upper < proof.options.enough),
        };
        self.push_whole(f64::NEG_INFINITY);
        loop {
            match self.heap.pop() {
                Some(Reverse(part)) if part.lower[0] < self.target() => {
                    self.proved = self.proved.max(part.lower[0]);
                    let is_ended = self.boxes.is_multiple_of(BOXES_BETWEEN_QUESTIONS) && !self.observer.goes_on();
                    if self.boxes >= self.options.max_boxes || is_ended || is_enough(self) {
                        self.is_out_of_budget = true;
                        self.heap.push(Reverse(part));
                        return;
                    }
                    self.examine(part);
                }
                _ if self.is_prescribed() => return,
                _ => {
                    self.proved = self.proved.max(self.target());
                    // The claimed radius may lie between the bounds: then they are brought closer.
                    let is_decided = !matches!(self.verdict(), Verdict::OpenPrecision | Verdict::OpenBudget);
                    if is_decided
                        || self.options.blind_radius.is_some()
                        || self.aside <= self.proved
                        || self.gap <= NARROWEST
                    {
                        return;
                    }
                    self.gap *= 0.1;
                    // What lies beyond the former target was not examined, or cut off there.
                    self.heap.clear();
                    self.push_whole(self.proved);
                }
            }
        }
    }

    fn push(&mut self, part: &PoseBox) {
        self.created += 1;
        self.heap.push(Reverse(PoseBox {
            number: self.created,
            ..*part
        }));
    }

    /// Proves, contracts or divides one box.
    fn examine(&mut self, mut part: PoseBox) {
        for _ in 0..=CONTRACTIONS {
            if part.lower[0] >= self.target() {
                self.report(&part, BoxOutcome::Beyond, || None);
                return;
            }
            // The box is cut before it is enclosed: what is found refers to the box as enclosed.
            part.upper[0] = part.upper[0].min(self.target());
            self.boxes += 1;
            let found = self.enclose_box(&part);
            let open: Vec<&(PoseScalar, TaylorModel)> = found.open().collect();
            if found.is_complete && open.is_empty() {
                self.report(&part, BoxOutcome::Proved, || weakest(found.iter()));
                return;
            }
            part.proved = part.proved.with(&found);
            // What the polynomials tell of a pose need not be tried.
            let known_at = |epsilon| part.proved.with_those_that_hold_at(&found, epsilon);
            let middle = part.point([0.0; VARIABLES]);
            self.try_point_of(part.patch, middle, known_at([0.0; VARIABLES]));
            if part.lower[0] == 0.0 && part.patch == Patch::Disc {
                self.try_point([0.0, 0.0, middle[2]], part.proved);
            }
            let worst = weakest(open.iter().copied());
            if let Some(least) = worst.map(|(_, value)| value.least_point()) {
                let point = part.point(least);
                if let Some(scalar) = self.try_point_of(part.patch, point, known_at(least))
                    && !self.is_prescribed()
                {
                    self.nearest_bad(point, scalar);
                }
            }
            if part.lower[0] >= self.target() {
                self.report(&part, BoxOutcome::Beyond, || worst);
                return;
            }
            if !found.is_complete || !found.may_contract {
                break;
            }
            let before = part;
            let open: Vec<&TaylorModel> = open.iter().map(|(_, value)| value).collect();
            if !part.contract(&open) {
                self.report(&before, BoxOutcome::Proved, || worst);
                return;
            }
            if self.observer.watches_boxes() {
                for part in before.cut_to(&part) {
                    self.report(&part, BoxOutcome::Proved, || worst);
                }
            }
            if part.volume() >= WORTHWHILE * before.volume() {
                break;
            }
        }
        self.halve(part);
    }

    /// Tells the observer, if it watches, what became of a box; `decisive` is the constraint that is nearest to its threshold on it.
    fn report<'b>(
        &mut self,
        part: &PoseBox,
        outcome: BoxOutcome,
        decisive: impl FnOnce() -> Option<&'b (PoseScalar, TaylorModel)>,
    ) {
        if !self.observer.watches_boxes() {
            return;
        }
        let decisive = decisive().map(|&(scalar, _)| scalar);
        self.observer.examined(&ExaminedBox {
            patch: part.patch,
            lower: part.lower,
            upper: part.upper,
            outcome,
            scalar: decisive
                .or(self.violation.map(|violation| violation.scalar))
                .unwrap_or(PoseScalar::Reach),
            depth: part.depth,
        });
    }

    /// Tells the observer the boxes that are left.
    fn report_rest(&mut self) {
        let target = self.target();
        for Reverse(part) in std::mem::take(&mut self.heap) {
            let outcome = if part.lower[0] >= target {
                BoxOutcome::Beyond
            } else {
                BoxOutcome::Undecided
            };
            self.report(&part, outcome, || None);
        }
    }

    /// Halves a box along its longest side; a box that is too narrow is put aside.
    fn halve(&mut self, part: PoseBox) {
        let side = |k: usize| part.upper[k] - part.lower[k];
        let scale = part.patch.scale([part.upper[0], part.upper[1]]);
        let sides = [
            scale[0] * side(0),
            scale[1] * side(1),
            self.design.platform_radius() * side(2),
        ];
        let widest = (0..VARIABLES).fold(0, |best, k| if sides[k] > sides[best] { k } else { best });
        let middle = 0.5 * (part.lower[widest] + part.upper[widest]);
        let is_narrow = sides[widest] < NARROWEST * self.design.base_radius();
        if is_narrow || middle <= part.lower[widest] || middle >= part.upper[widest] {
            self.aside = self.aside.min(part.lower[0]);
            self.report(&part, BoxOutcome::Undecided, || None);
            return;
        }
        let [mut below, mut above] = [part; 2].map(|part| PoseBox {
            depth: part.depth + 1,
            ..part
        });
        below.upper[widest] = middle;
        above.lower[widest] = middle;
        self.push(&below);
        self.push(&above);
    }

    /// Whether every pose of the prescribed region is proved feasible, once its boxes were examined.
    fn holds_region(&self) -> bool {
        !self.is_out_of_budget && self.violation.is_none() && self.aside == f64::INFINITY
    }

    fn lower(&self) -> f64 {
        if let Some(region) = self.region {
            let inscribed = region.inscribed_radius().filter(|_| self.holds_region());
            return inscribed.unwrap_or(0.0);
        }
        match self.upper {
            Some(0.0) => 0.0,
            _ => self.proved.min(self.aside).max(0.0),
        }
    }

    fn verdict(&self) -> Verdict {
        if self.is_prescribed() {
            return match self.violation {
                Some(_) => Verdict::Refuted,
                None if self.holds_region() => Verdict::Proved,
                None if self.is_out_of_budget => Verdict::OpenBudget,
                None => Verdict::OpenPrecision,
            };
        }
        let claim = (1.0 - self.options.tolerance) * self.options.claimed_radius;
        if self.lower() >= claim {
            Verdict::Proved
        } else if self.upper.is_some_and(|upper| upper < claim) {
            Verdict::Refuted
        } else if self.is_out_of_budget && self.aside > self.proved {
            Verdict::OpenBudget
        } else {
            Verdict::OpenPrecision
        }
    }

    fn certificate(&self) -> Certificate {
        Certificate {
            lower: self.lower(),
            upper: self.upper,
            verdict: self.verdict(),
            violation: self.violation,
            boxes: self.boxes,
        }
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
