//! The questions that threads answer: what drives the mass of a design and of a front, a wish, why a point cannot be had, and what a
//! motion asks of the drives.

use std::sync::Arc;
use std::time::Duration;

use kinefront_model::certify::MotionCertificate;
use kinefront_model::dynamics::DriveCatalogue;
use kinefront_model::evaluation::{Evaluation, Quantity, TaskOutcome, TaskSample};
use kinefront_model::mechanism::Design;
use kinefront_scene::{MotionPath, PathColor};
use kinefront_study::{
    DesignProblem, DriveSection, Drivers, DriversAlong, DriversOptions, Hindrance, LoadSection, PayloadSection,
    PreparedStudy, Study, TaskSection, Wish, WishOutcome,
};

use super::answering::Question;

/// The study of a question. Two runs of one study are different.
#[derive(Debug, Clone)]
pub struct StudyOfRun(pub Arc<PreparedStudy>);

impl PartialEq for StudyOfRun {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl StudyOfRun {
    fn problem(&self) -> Result<DesignProblem, String> {
        DesignProblem::new(self.0.study()).map_err(|error| error.to_string())
    }
}

/// What drives the first objective of a design that was evaluated on the fine grid?
#[derive(Clone, PartialEq)]
pub struct DriversQuestion {
    /// The study.
    pub study: StudyOfRun,
    /// The design.
    pub evaluation: Arc<Evaluation>,
    /// Whether it is optimized again after finite steps of each parameter, which takes a second or two.
    pub steps: bool,
}

impl Question for DriversQuestion {
    type Answer = Result<Drivers, String>;
    const THREAD: &'static str = "kinefront-drivers";
    const RESTING: Duration = Duration::from_millis(120);

    fn answer(&self) -> Self::Answer {
        let local = self.study.problem()?.local_of(&self.evaluation, &[]);
        let options = DriversOptions {
            steps: self.steps,
            alternatives: self.steps,
            ..DriversOptions::default()
        };
        let drivers = local.and_then(|local| local.drivers(options));
        drivers.map_err(|error| error.to_string())
    }
}

/// What drives the first objective along a front?
#[derive(Clone)]
pub struct AlongQuestion {
    /// The study.
    pub study: StudyOfRun,
    /// Number of the front.
    pub front: u64,
    /// The designs of the front.
    pub designs: Arc<Vec<Design>>,
}

impl PartialEq for AlongQuestion {
    fn eq(&self, other: &Self) -> bool {
        (&self.study, self.front) == (&other.study, other.front)
    }
}

impl Question for AlongQuestion {
    type Answer = Result<Vec<DriversAlong>, String>;
    const THREAD: &'static str = "kinefront-prices";
    const RESTING: Duration = Duration::from_millis(300);

    fn answer(&self) -> Self::Answer {
        let problem = self.study.problem()?;
        Ok(problem.drivers_along(&problem.evaluate_on_fine_grid(&self.designs)))
    }
}

/// Which design is the nearest one that has what is wished for?
#[derive(Clone, PartialEq)]
pub struct WishQuestion {
    /// The study.
    pub study: StudyOfRun,
    /// Number of the wish: the same wish may be stated again.
    pub number: u64,
    /// The design from which the wish starts.
    pub design: Design,
    /// The wish.
    pub wish: Wish,
}

impl Question for WishQuestion {
    type Answer = Result<WishOutcome, String>;
    const THREAD: &'static str = "kinefront-wish";
    const RESTING: Duration = Duration::ZERO;

    fn answer(&self) -> Self::Answer {
        let granted = self.study.problem()?.grant(&self.design, &self.wish);
        granted.map_err(|error| error.to_string())
    }
}

/// Why can a value of the first objective not be had with these values of the others?
#[derive(Clone)]
pub struct WhyQuestion {
    /// The study.
    pub study: StudyOfRun,
    /// Number of the front.
    pub front: u64,
    /// The designs of the front.
    pub designs: Arc<Vec<Design>>,
    /// Values of other objectives.
    pub held: Vec<(Quantity, f64)>,
    /// Value of the first objective.
    pub wished: f64,
}

impl PartialEq for WhyQuestion {
    fn eq(&self, other: &Self) -> bool {
        (&self.study, self.front, &self.held, self.wished) == (&other.study, other.front, &other.held, other.wished)
    }
}

impl Question for WhyQuestion {
    type Answer = Result<Drivers, String>;
    const THREAD: &'static str = "kinefront-why";
    const RESTING: Duration = Duration::from_millis(120);

    fn answer(&self) -> Self::Answer {
        let found = self.study.problem()?.why(&self.designs, &self.held, self.wished);
        found.map_err(|error| error.to_string())
    }
}

/// What stands in the way of a study of which no design is feasible?
#[derive(Clone)]
pub struct HindrancesQuestion {
    /// The study.
    pub study: StudyOfRun,
    /// The designs that miss the requirements least, each with its violation.
    pub designs: Arc<Vec<(f64, Design)>>,
}

impl PartialEq for HindrancesQuestion {
    fn eq(&self, other: &Self) -> bool {
        self.study == other.study
    }
}

impl Question for HindrancesQuestion {
    type Answer = Result<Vec<Hindrance>, String>;
    const THREAD: &'static str = "kinefront-hindrances";
    const RESTING: Duration = Duration::ZERO;

    fn answer(&self) -> Self::Answer {
        Ok(self.study.problem()?.hindrances(&self.designs))
    }
}

/// The sections of a study that describe a motion and what moves.
#[derive(Clone, PartialEq)]
pub struct MotionSections {
    task: TaskSection,
    payload: PayloadSection,
    drives: DriveSection,
    loads: LoadSection,
}

impl From<&Study> for MotionSections {
    fn from(study: &Study) -> Self {
        Self {
            task: study.task.clone(),
            payload: study.payload.clone(),
            drives: study.drives.clone(),
            loads: study.loads.clone(),
        }
    }
}

/// What does a motion ask of the drives of a design?
#[derive(Clone, PartialEq)]
pub struct MotionQuestion {
    /// The study that was run.
    pub study: StudyOfRun,
    /// The motion, which takes the place of that of the study.
    pub sections: MotionSections,
    /// What the colours of the path tell; without, there is no path.
    pub color: Option<PathColor>,
    /// The design.
    pub evaluation: Arc<Evaluation>,
}

/// A motion that a design follows, or where it ends.
#[derive(Debug)]
pub struct FollowedMotion {
    /// What came of it.
    pub outcome: TaskOutcome,
    /// The samples up to its end.
    pub samples: Vec<TaskSample>,
    /// The path with its colours.
    pub path: Option<MotionPath>,
    /// The catalogue that the drive of the outcome is one of.
    pub catalogue: DriveCatalogue,
    /// What is proved about the motion at every moment, if the design follows it.
    pub proof: Option<MotionCertificate>,
}

/// The answer: no motion if the study states none.
pub type MotionAnswer = Result<Option<FollowedMotion>, String>;

impl Question for MotionQuestion {
    type Answer = MotionAnswer;
    const THREAD: &'static str = "kinefront-motion";
    const RESTING: Duration = Duration::ZERO;

    fn answer(&self) -> Self::Answer {
        let mut study = self.study.0.study().clone();
        let sections = self.sections.clone();
        study.task = sections.task;
        study.payload = sections.payload;
        study.drives = sections.drives;
        study.loads = sections.loads;
        let model = study.model().map_err(|error| error.to_string())?;
        let Some((outcome, samples)) = model.follow_task(&self.evaluation) else {
            return Ok(None);
        };
        let color = self.color;
        let path = color.and_then(|color| MotionPath::new(&model, &self.evaluation.design, &samples, color));
        let catalogue = model.settings().drive_catalogue.clone();
        let proof = model.certify_motion(&self.evaluation.design, &outcome);
        Ok(Some(FollowedMotion {
            outcome,
            samples,
            path,
            catalogue,
            proof,
        }))
    }
}
