//! The proof of a workspace: the boxes of poses into which it was divided, and the infeasible pose that ends it.

use glam::DVec2;

use kinefront_model::certify::{BoxOutcome, Certificate, CertifyOptions, ExaminedBox, Patch, ProofObserver};
use kinefront_model::evaluation::{Evaluation, Model, PoseScalar};
use kinefront_model::mechanism::Design;

/// Largest number of boxes of a proof that is shown.
const MOST_BOXES: usize = 50_000;

/// The proof of the workspace of a design, with its boxes.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkspaceProof {
    /// The design.
    pub design: Design,
    /// What was to be proved.
    pub claim: CertifyOptions,
    /// What was proved.
    pub certificate: Certificate,
    /// The boxes, in the order in which they were decided.
    pub boxes: Vec<ExaminedBox>,
    /// Centre of the workspace \[m\].
    pub centre: DVec2,
}

/// A box in the configuration space: its middle and half its sides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProofCell {
    /// Position of its middle in the base frame \[m\].
    pub position: DVec2,
    /// Orientation of its middle \[rad\].
    pub phi: f64,
    /// Half the side along `theta` and half the side across \[m\]; for a part of a triangle, whose sides are not at right angles, about.
    pub half: [f64; 2],
    /// Half the range of orientations \[rad\].
    pub half_phi: f64,
    /// Direction in which the first coordinate of the patch moves the middle \[rad\].
    pub theta: f64,
    /// What became of the box.
    pub outcome: BoxOutcome,
    /// The scalar whose limit was proved last, or is not proved.
    pub scalar: PoseScalar,
}

struct Collector<'a> {
    boxes: Vec<ExaminedBox>,
    goes_on: &'a dyn Fn() -> bool,
}

impl ProofObserver for Collector<'_> {
    fn goes_on(&mut self) -> bool {
        (self.goes_on)()
    }

    fn watches_boxes(&self) -> bool {
        true
    }

    fn examined(&mut self, part: &ExaminedBox) {
        self.boxes.push(*part);
    }
}

/// Proves the workspace of an evaluated design; `None` if it has none, or once `goes_on` returns false.
pub fn workspace_proof(model: &Model, evaluation: &Evaluation, goes_on: &dyn Fn() -> bool) -> Option<WorkspaceProof> {
    let claim = CertifyOptions {
        max_boxes: MOST_BOXES,
        ..model.claim(evaluation)?
    };
    let mut collector = Collector {
        boxes: Vec::new(),
        goes_on,
    };
    let certificate = model
        .certify_observed(&evaluation.design, &claim, &mut collector)
        .ok()?;
    goes_on().then_some(WorkspaceProof {
        design: evaluation.design,
        claim,
        certificate,
        boxes: collector.boxes,
        centre: model.settings().workspace.centre,
    })
}

impl WorkspaceProof {
    /// The boxes up to a distance from the centre, as cells; those beyond it are of no interest.
    pub fn cells(&self) -> impl Iterator<Item = ProofCell> {
        let limit = match self.claim.is_of_region {
            true => f64::INFINITY,
            false => 1.05 * self.certificate.upper.unwrap_or(f64::INFINITY),
        };
        let near = self.boxes.iter().filter(move |part| part.lower[0] < limit);
        near.map(|part| {
            let middle = |k: usize| 0.5 * (part.lower[k] + part.upper[k]);
            let half = |k: usize| 0.5 * (part.upper[k] - part.lower[k]);
            let place = [middle(0), middle(1)];
            let scale = part.patch.scale(place);
            ProofCell {
                position: self.centre + part.patch.position(place),
                phi: middle(2),
                half: [scale[0] * half(0), scale[1] * half(1)],
                half_phi: half(2),
                theta: part.patch.direction(place),
                outcome: part.outcome,
                scalar: part.scalar,
            }
        })
    }

    /// The outlines of the boxes that contain an orientation, as closed strips of positions, each with its box.
    pub fn outlines(&self, phi: f64) -> impl Iterator<Item = (&ExaminedBox, Vec<DVec2>)> {
        let centre = self.centre;
        let at_phi = self
            .boxes
            .iter()
            .filter(move |part| part.lower[2] <= phi && phi < part.upper[2]);
        at_phi.map(move |part| {
            let corners = match part.patch {
                Patch::Disc => ((part.upper[1] - part.lower[1]) / 0.05).ceil().max(1.0) as u32,
                Patch::Rectangle(_) | Patch::Triangle(_) => 1,
            };
            let arc = |first: f64, from: f64, to: f64| {
                (0..=corners).map(move |corner| {
                    let second = from + (to - from) * f64::from(corner) / f64::from(corners);
                    centre + part.patch.position([first, second])
                })
            };
            let mut outline: Vec<DVec2> = arc(part.lower[0], part.lower[1], part.upper[1]).collect();
            outline.extend(arc(part.upper[0], part.upper[1], part.lower[1]));
            outline.extend(outline.first().copied());
            (part, outline)
        })
    }
}
