//! What the motion of the study asks of designs of the fronts, and how short its cycle may be.

use kinefront_model::certify::MotionVerdict;
use kinefront_model::evaluation::{Evaluation, Model, ShortestCycle, largest_of_legs};
use kinefront_model::mechanism::{Architecture, Design, JointKind};
use rayon::prelude::*;

use super::Fronts;
use super::question::Question;

/// Largest number of designs of a front.
const DESIGNS: usize = 6;

/// A design that follows the motion of the study.
#[derive(Debug, Clone)]
pub(super) struct DesignMotion {
    pub design: Design,
    /// Values of the objectives.
    pub objectives: Vec<f64>,
    /// What the motion asks of the actuators; `None` if the design does not follow it.
    pub figures: Option<MotionFigures>,
    /// Name of the drive that the design selects from the catalogue of the study.
    pub drive: Option<String>,
    /// The shortest cycle that the limits of the study allow, if there are any.
    pub shortest: Option<ShortestCycle>,
    /// What is proved about the motion at every moment, if the design follows it.
    pub proof: Option<MotionVerdict>,
}

/// What a motion asks of the actuator that has to give most.
#[derive(Debug, Clone, Copy)]
pub(super) struct MotionFigures {
    /// Time of a cycle \[s\].
    pub cycle_time: f64,
    /// Largest speed \[m/s or rad/s\].
    pub speed: f64,
    /// Largest force \[N or N·m\].
    pub force: f64,
    /// Largest root mean square of the force \[N or N·m\].
    pub rms_force: f64,
    /// Largest force times largest speed \[W\].
    pub power: f64,
    /// Energy of a cycle, of drives on a common link \[J\].
    pub energy: f64,
}

impl DesignMotion {
    fn new(model: &Model, question: &Question, evaluation: &Evaluation) -> Option<Self> {
        let (outcome, _) = model.follow_task(evaluation)?;
        let proof = model.certify_motion(&evaluation.design, &outcome);
        let drive = evaluation
            .drive
            .and_then(|place| model.settings().drive_catalogue.get(place));
        let found = outcome.motion.as_ref().zip(outcome.figures());
        let figures = found.map(|(motion, figures)| MotionFigures {
            cycle_time: motion.cycle_time(),
            speed: largest_of_legs(figures.peak_speed),
            force: largest_of_legs(figures.peak_force),
            rms_force: largest_of_legs(figures.rms_force),
            power: figures.corner_power,
            energy: figures.energy_shared,
        });
        Some(Self {
            design: evaluation.design,
            objectives: (0..question.objectives.len())
                .map(|objective| question.value(objective, evaluation))
                .collect(),
            figures,
            drive: drive.map(|drive| drive.name.clone()),
            shortest: model.shortest_cycle(evaluation),
            proof: proof.map(|proof| proof.verdict),
        })
    }

    /// Returns the architecture.
    pub fn architecture(&self) -> Architecture {
        self.design.architecture()
    }

    /// Returns the kind of the actuators.
    pub fn actuator(&self) -> JointKind {
        self.architecture().actuator()
    }
}

/// Lets designs of the front of each architecture, evenly spread, follow the motion of the study; none if it states none.
pub(super) fn all(model: &Model, question: &Question, fronts: &Fronts) -> Vec<DesignMotion> {
    if model.settings().task.is_none() {
        return Vec::new();
    }
    let designs = fronts.alone.iter().flat_map(|(_, front)| front.spread(DESIGNS));
    let designs: Vec<Evaluation> = designs.collect();
    designs
        .par_iter()
        .filter_map(|evaluation| DesignMotion::new(model, question, evaluation))
        .collect()
}
