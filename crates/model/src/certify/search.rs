//! Branch and bound over boxes of positions and orientations.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use super::examiner::{BadPose, Examination, Examiner, examined_box};
use super::forms::ProvedForms;
use super::patch::Patch;
use super::pose_box::PoseBox;
use super::{BoxOutcome, Certificate, CertifyError, CertifyOptions, ProofObserver, Verdict};
use crate::enclosure::VARIABLES;
use crate::evaluation::Model;
use crate::mechanism::Design;
use crate::workers::{Workers, map};

/// A box narrower than this multiple of `R` is not divided.
const NARROWEST: f64 = 1e-11;

/// Number of boxes after which a proof asks whether it goes on.
const BOXES_BETWEEN_QUESTIONS: usize = 64;

/// Number of boxes of a prescribed region that each worker examines before the results are looked at.
const AHEAD: usize = 8;

pub(super) fn certify(
    model: &Model,
    design: &Design,
    options: &CertifyOptions,
    observer: &mut dyn ProofObserver,
    workers: &dyn Workers,
) -> Result<Certificate, CertifyError> {
    let examiner = Examiner::new(model, design, options, observer.watches_boxes())?;
    let bad = match options.blind_radius {
        Some(_) => None,
        None if examiner.is_prescribed() => examiner.try_boundary(),
        None => examiner.find_bad_poses(),
    };
    let mut proof = Proof {
        design,
        options,
        observer,
        workers,
        examiner,
        bad,
        heap: BinaryHeap::new(),
        ahead: BTreeMap::new(),
        aside: f64::INFINITY,
        proved: 0.0,
        boxes: 0,
        created: 0,
        is_out_of_budget: false,
    };
    proof.divide();
    proof.report_rest();
    Ok(proof.certificate())
}

struct Proof<'a> {
    design: &'a Design,
    options: &'a CertifyOptions,
    observer: &'a mut dyn ProofObserver,
    workers: &'a dyn Workers,
    examiner: Examiner<'a>,
    /// The nearest bad pose that is known.
    bad: Option<BadPose>,
    heap: BinaryHeap<Reverse<PoseBox>>,
    /// What boxes of the heap have shown, by their numbers.
    ahead: BTreeMap<usize, Examination>,
    /// Least distance of the boxes that were put aside.
    aside: f64,
    /// Everything nearer than this is proved, apart from the boxes that were put aside.
    proved: f64,
    boxes: usize,
    created: usize,
    is_out_of_budget: bool,
}

impl Proof<'_> {
    fn target(&self) -> f64 {
        self.examiner.target(self.bad)
    }

    fn upper(&self) -> Option<f64> {
        self.bad.map(|bad| bad.distance)
    }

    /// Pushes the boxes with which the search begins; those of a disc begin at the distance `from`.
    fn push_whole(&mut self, from: f64) {
        let [first, last] = self.examiner.window;
        for patch in self.examiner.region.map_or(vec![Patch::Disc], Patch::of) {
            let [along, across] = patch.ranges(self.target(), self.examiner.sector);
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

    /// Divides the region until everything within the target is proved, or the number of boxes is used up.
    fn divide(&mut self) {
        let is_enough = |proof: &Self| match proof.examiner.region {
            Some(_) => proof.bad.is_some(),
            None => proof.upper().is_some_and(|upper| upper < proof.options.enough),
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
                    let shown = self.examine(part);
                    self.take(shown);
                }
                _ if self.examiner.is_prescribed() => return,
                _ => {
                    self.proved = self.proved.max(self.target());
                    // The claimed radius may lie between the bounds: then they are brought closer.
                    let is_decided = !matches!(self.verdict(), Verdict::OpenPrecision | Verdict::OpenBudget);
                    if is_decided
                        || self.options.blind_radius.is_some()
                        || self.aside <= self.proved
                        || self.examiner.gap <= NARROWEST
                    {
                        return;
                    }
                    self.examiner.gap *= 0.1;
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

    /// Returns what a box shows. The boxes of a prescribed region do not depend on each other, so that those that come next are examined
    /// at the same time.
    fn examine(&mut self, part: PoseBox) -> Examination {
        if let Some(known) = self.ahead.remove(&part.number) {
            return known;
        }
        let count = self.workers.count();
        if count < 2 || !self.examiner.is_prescribed() {
            return self.examiner.examine(part, self.bad);
        }
        let (mut parts, mut popped) = (vec![part], Vec::new());
        while popped.len() < 2 * AHEAD * count
            && parts.len() < AHEAD * count
            && let Some(Reverse(next)) = self.heap.pop()
        {
            if !self.ahead.contains_key(&next.number) {
                parts.push(next);
            }
            popped.push(Reverse(next));
        }
        self.heap.extend(popped);
        let examiner = &self.examiner;
        let shown = map(self.workers, &parts, |part| examiner.examine(*part, self.bad));
        let numbers = parts.iter().map(|part| part.number);
        self.ahead.extend(numbers.zip(shown));
        let own = self.ahead.remove(&part.number);
        own.unwrap_or_else(|| self.examiner.examine(part, self.bad))
    }

    /// Takes what a box has shown, and divides what is left of it.
    fn take(&mut self, shown: Examination) {
        self.bad = shown.bad;
        self.boxes += shown.boxes;
        for told in &shown.told {
            self.observer.examined(told);
        }
        if let Some(part) = shown.left {
            self.halve(part);
        }
    }

    /// Tells the observer, if it watches, what became of a box.
    fn report(&mut self, part: &PoseBox, outcome: BoxOutcome) {
        if self.examiner.is_watched {
            self.observer.examined(&examined_box(part, outcome, None, self.bad));
        }
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
            self.report(&part, outcome);
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
            self.report(&part, BoxOutcome::Undecided);
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
        !self.is_out_of_budget && self.bad.is_none() && self.aside == f64::INFINITY
    }

    fn lower(&self) -> f64 {
        if let Some(region) = self.examiner.region {
            let inscribed = region.inscribed_radius().filter(|_| self.holds_region());
            return inscribed.unwrap_or(0.0);
        }
        match self.upper() {
            Some(0.0) => 0.0,
            _ => self.proved.min(self.aside).max(0.0),
        }
    }

    fn verdict(&self) -> Verdict {
        if self.examiner.is_prescribed() {
            return match self.bad {
                Some(_) => Verdict::Refuted,
                None if self.holds_region() => Verdict::Proved,
                None if self.is_out_of_budget => Verdict::OpenBudget,
                None => Verdict::OpenPrecision,
            };
        }
        let claim = (1.0 - self.options.tolerance) * self.options.claimed_radius;
        if self.lower() >= claim {
            Verdict::Proved
        } else if self.upper().is_some_and(|upper| upper < claim) {
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
            upper: self.upper(),
            verdict: self.verdict(),
            violation: self.bad.map(|bad| bad.violation),
            boxes: self.boxes,
        }
    }
}
