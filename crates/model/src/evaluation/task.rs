//! What a motion asks of the drives of a design (docs/model.md, section 15.6).

use super::{Evaluation, Model, PosedDesign};
use crate::dynamics::{Response, Task, TaskFrame, TaskInstant, TaskMotion};
use crate::mechanism::{Design, JointKind, ReachReason};
use crate::spatial::LEGS;
use crate::workspace::Region;

/// A sample of a motion with what the actuators do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskSample {
    /// The moment.
    pub instant: TaskInstant,
    /// Values of the actuators \[m or rad\]; angles are not wrapped.
    pub actuators: [f64; LEGS],
    /// What they do.
    pub response: Response,
}

/// Why a motion ends before its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TaskFault {
    /// A leg does not reach a pose.
    Reach,
    /// A joint is beyond a limit.
    Limit,
    /// The motion crosses a parallel singularity.
    Singularity,
}

impl TaskFault {
    /// Returns the name that JSON uses.
    pub fn name(self) -> &'static str {
        match self {
            TaskFault::Reach => "reach",
            TaskFault::Limit => "limit",
            TaskFault::Singularity => "singularity",
        }
    }
}

/// A motion that cannot be followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskFailure {
    /// Piece, from 0.
    pub piece: usize,
    /// Time from the beginning of the cycle \[s\].
    pub time: f64,
    /// Index of the leg, from 0; `None` at a parallel singularity, which all legs have in common.
    pub leg: Option<usize>,
    /// Why.
    pub fault: TaskFault,
    /// Distance from the end of reach \[m\], negative; −1 at a singularity.
    pub path_reach: f64,
}

/// Figures of a motion that a design follows.
#[derive(Debug, Clone, PartialEq)]
pub struct TaskFigures {
    /// Least distance to a joint limit or to the end of reach over the motion \[m\].
    pub path_reach: f64,
    /// Whether all of it lies in the workspace and its rotation range.
    pub inside_workspace: bool,
    /// Largest speed of each actuator \[m/s or rad/s\].
    pub peak_speed: [f64; LEGS],
    /// Largest acceleration of each actuator \[m/s² or rad/s²\].
    pub peak_acceleration: [f64; LEGS],
    /// Largest force or torque of each actuator \[N or N·m\].
    pub peak_force: [f64; LEGS],
    /// Root mean square of the force or torque of each actuator over the cycle \[N or N·m\].
    pub rms_force: [f64; LEGS],
    /// Largest power of each actuator \[W\].
    pub peak_power: [f64; LEGS],
    /// Largest force times largest speed of any actuator: the power of one type of motor for all \[W\].
    pub corner_power: f64,
    /// Largest power of all actuators together \[W\].
    pub peak_power_total: f64,
    /// Energy of a cycle if no drive recovers any \[J\].
    pub energy_each: f64,
    /// Energy of a cycle if the drives share what they recover \[J\].
    pub energy_shared: f64,
    /// Energy of a cycle if all of it is recovered \[J\].
    pub energy_net: f64,
    /// Range of the values of each actuator \[m or rad\].
    pub stroke: [f64; LEGS],
}

/// A drive of the catalogue, for all actuators of a design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SelectedDrive {
    /// Its place in the catalogue.
    pub place: usize,
    /// Largest share of its limits that the motion uses; above 1, no drive of the catalogue carries the motion, and this one misses by
    /// least.
    pub utilization: f64,
}

impl SelectedDrive {
    /// Returns whether the drive carries the motion.
    pub fn carries(&self) -> bool {
        self.utilization <= 1.0
    }
}

/// What came of a motion.
#[derive(Debug, Clone, PartialEq)]
pub struct TaskOutcome {
    /// The motion in time; `None` if there is none, because the path has no length or is scaled to a workspace that does not exist.
    pub motion: Option<TaskMotion>,
    /// The figures, or where the motion ends; `None` without a motion.
    pub result: Option<Result<TaskFigures, TaskFailure>>,
    /// The drive that the design selects for the motion, if the study has a catalogue.
    pub drive: Option<SelectedDrive>,
}

impl TaskOutcome {
    /// Returns the figures of a motion that the design follows to its end.
    pub fn figures(&self) -> Option<&TaskFigures> {
        self.result.as_ref()?.as_ref().ok()
    }
}

/// Sums over a motion.
struct Tally {
    samples: Vec<TaskSample>,
    figures: TaskFigures,
    squares: [f64; LEGS],
}

/// Returns the largest absolute value that any of the three legs has.
pub fn largest_of_legs(values: [f64; LEGS]) -> f64 {
    values.iter().fold(0.0f64, |most, value| most.max(value.abs()))
}

fn larger(most: &mut [f64; LEGS], values: &[f64; LEGS]) {
    for (most, value) in most.iter_mut().zip(values) {
        *most = most.max(value.abs());
    }
}

impl TaskSample {
    /// Returns the power of each actuator \[W\].
    pub fn powers(&self) -> [f64; LEGS] {
        [0, 1, 2].map(|leg: usize| self.response.forces[leg] * self.response.speeds[leg])
    }

    /// Returns the powers as the three energies count them: no recuperation, a common link, and all.
    fn counted_powers(&self) -> [f64; 3] {
        let powers = self.powers();
        let total = powers[0] + powers[1] + powers[2];
        [powers.iter().map(|power| power.max(0.0)).sum(), total.max(0.0), total]
    }
}

impl TaskFigures {
    /// Returns the figures of a motion whose samples have other forces; nothing is said of reach and workspace.
    pub(super) fn with_forces(
        samples: &[TaskSample],
        forces: impl Iterator<Item = [f64; LEGS]>,
        motion: &TaskMotion,
    ) -> TaskFigures {
        let mut tally = Tally::new();
        for (sample, forces) in samples.iter().zip(forces) {
            let response = Response {
                forces,
                ..sample.response
            };
            tally.add(TaskSample { response, ..*sample });
        }
        tally.finish(motion).0
    }
}

impl Tally {
    fn new() -> Self {
        Self {
            samples: Vec::new(),
            figures: TaskFigures {
                path_reach: f64::INFINITY,
                inside_workspace: true,
                peak_speed: [0.0; LEGS],
                peak_acceleration: [0.0; LEGS],
                peak_force: [0.0; LEGS],
                rms_force: [0.0; LEGS],
                peak_power: [0.0; LEGS],
                corner_power: 0.0,
                peak_power_total: 0.0,
                energy_each: 0.0,
                energy_shared: 0.0,
                energy_net: 0.0,
                stroke: [0.0; LEGS],
            },
            squares: [0.0; LEGS],
        }
    }

    fn add(&mut self, sample: TaskSample) {
        let figures = &mut self.figures;
        larger(&mut figures.peak_speed, &sample.response.speeds);
        larger(&mut figures.peak_acceleration, &sample.response.accelerations);
        larger(&mut figures.peak_force, &sample.response.forces);
        larger(&mut figures.peak_power, &sample.powers());
        let total: f64 = sample.powers().iter().sum();
        figures.peak_power_total = figures.peak_power_total.max(total.abs());
        // Within a piece by the trapezoidal rule; between pieces there is nothing but a dwell.
        let last = self.samples.last().copied();
        if let Some(last) = last.filter(|last| last.instant.piece == sample.instant.piece) {
            let half = 0.5 * (sample.instant.time - last.instant.time);
            self.count(&[(&last, half), (&sample, half)]);
        }
        self.samples.push(sample);
    }

    /// Adds samples with the times for which they stand.
    fn count(&mut self, samples: &[(&TaskSample, f64)]) {
        let mut energies = [0.0; 3];
        for (sample, time) in samples {
            for (sum, force) in self.squares.iter_mut().zip(sample.response.forces) {
                *sum += force * force * time;
            }
            for (sum, power) in energies.iter_mut().zip(sample.counted_powers()) {
                *sum += power * time;
            }
        }
        self.figures.energy_each += energies[0];
        self.figures.energy_shared += energies[1];
        self.figures.energy_net += energies[2];
    }

    fn finish(mut self, motion: &TaskMotion) -> (TaskFigures, Vec<TaskSample>) {
        let ends: Vec<TaskSample> = self
            .samples
            .chunk_by(|a, b| a.instant.piece == b.instant.piece)
            .filter_map(|piece| piece.last().copied())
            .collect();
        for end in &ends {
            self.count(&[(end, motion.dwell())]);
        }
        let time = motion.cycle_time();
        let figures = &mut self.figures;
        figures.rms_force = self.squares.map(|square| (square / time).sqrt());
        figures.corner_power = largest_of_legs(figures.peak_force) * largest_of_legs(figures.peak_speed);
        figures.stroke = [0, 1, 2].map(|leg: usize| {
            let values = self.samples.iter().map(|sample| sample.actuators[leg]);
            let [least, most] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], value| {
                [least.min(value), most.max(value)]
            });
            most - least
        });
        (self.figures, self.samples)
    }
}

impl Model {
    /// Moves an evaluated design along the motion of the study, scaled to its workspace; `None` if the study states none.
    pub fn follow_task(&self, evaluation: &Evaluation) -> Option<(TaskOutcome, Vec<TaskSample>)> {
        Some(self.follow(evaluation, self.settings().task.as_ref()?))
    }

    /// Moves an evaluated design along any motion, scaled to its workspace.
    pub fn follow(&self, evaluation: &Evaluation, task: &Task) -> (TaskOutcome, Vec<TaskSample>) {
        self.follow_driven(&evaluation.design, task, &self.frame_of_task(evaluation))
    }

    /// Returns the workspace of an evaluated design, to which a motion is scaled.
    pub fn frame_of_task(&self, evaluation: &Evaluation) -> TaskFrame {
        let home_phi_deg = evaluation.home_phi_deg.unwrap_or(0.0);
        self.task_frame(&evaluation.design, evaluation.workspace_radius(), home_phi_deg)
    }

    /// Returns the workspace of a design to which a motion is scaled.
    pub(super) fn task_frame(&self, design: &Design, radius: f64, home_phi_deg: f64) -> TaskFrame {
        let workspace = &self.settings().workspace;
        TaskFrame {
            centre: workspace.centre,
            radius,
            polygon: match &workspace.region {
                Region::Polygon(polygon) => Some(polygon.clone()),
                Region::Largest | Region::Disc(_) => None,
            },
            home_phi: home_phi_deg.to_radians(),
            half_range: 0.5 * workspace.rotation_range_deg.to_radians(),
            lever: design.platform_radius(),
        }
    }
}

impl PosedDesign {
    /// Moves the design along a task in a workspace, and returns what came of it with all samples up to its end.
    pub fn follow(&self, task: &Task, frame: &TaskFrame) -> (TaskOutcome, Vec<TaskSample>) {
        let motion = task.motion(frame);
        let found = motion.as_ref().map(|motion| match self.tally(motion, frame) {
            Ok(tally) => {
                let (figures, samples) = tally.finish(motion);
                (Ok(figures), samples)
            }
            Err((failure, samples)) => (Err(failure), samples),
        });
        let (result, samples) = found.unzip();
        let outcome = TaskOutcome {
            motion,
            result,
            drive: None,
        };
        (outcome, samples.unwrap_or_default())
    }

    /// Moves the design along a motion in equal steps of time \[s\], and returns the samples.
    ///
    /// # Errors
    /// Where the motion ends early, and why.
    pub fn trajectory(&self, motion: &TaskMotion, step: f64) -> Result<Vec<TaskSample>, TaskFailure> {
        let mut samples: Vec<TaskSample> = Vec::new();
        let mut sign = None;
        for instant in motion.at_steps(step) {
            let (sample, _) = self.sample(&instant, &mut sign, samples.last())?;
            samples.push(sample);
        }
        Ok(samples)
    }

    fn tally(&self, motion: &TaskMotion, frame: &TaskFrame) -> Result<Tally, (TaskFailure, Vec<TaskSample>)> {
        let mut tally = Tally::new();
        let mut sign = None;
        for instant in motion.instants() {
            match self.sample(&instant, &mut sign, tally.samples.last()) {
                Ok((sample, reach)) => {
                    let figures = &mut tally.figures;
                    figures.path_reach = figures.path_reach.min(reach);
                    figures.inside_workspace &= frame.contains(&instant);
                    tally.add(sample);
                }
                Err(failure) => return Err((failure, tally.samples)),
            }
        }
        Ok(tally)
    }

    /// Returns a sample with its distance from the end of reach.
    fn sample(
        &self,
        instant: &TaskInstant,
        sign: &mut Option<f64>,
        last: Option<&TaskSample>,
    ) -> Result<(TaskSample, f64), TaskFailure> {
        let failure = |leg, fault, path_reach| TaskFailure {
            piece: instant.piece,
            time: instant.time,
            leg,
            fault,
            path_reach,
        };
        let singular = || failure(None, TaskFault::Singularity, -1.0);
        let dynamics = self.dynamics_at(&instant.pose).map_err(|unreachable| {
            let fault = match unreachable.shortfall.reason {
                ReachReason::OutOfReach | ReachReason::Degenerate => TaskFault::Reach,
                ReachReason::BelowLimit | ReachReason::AboveLimit => TaskFault::Limit,
            };
            failure(Some(unreachable.leg), fault, unreachable.shortfall.limit_margin)
        })?;
        let dynamics = dynamics.ok_or_else(singular)?;
        let determinant = dynamics.determinant();
        let expected = *sign.get_or_insert(determinant.signum());
        let response = dynamics.response(&instant.motion);
        let numbers = response
            .forces
            .iter()
            .chain(&response.speeds)
            .chain(&response.accelerations);
        if determinant * expected <= 0.0 || !numbers.into_iter().all(|number| number.is_finite()) {
            return Err(singular());
        }
        let mut actuators = dynamics.actuators();
        if let (Some(last), JointKind::Revolute) = (last, self.actuator()) {
            let turn = 2.0 * std::f64::consts::PI;
            for (value, last) in actuators.iter_mut().zip(last.actuators) {
                *value -= turn * ((*value - last) / turn).round();
            }
        }
        let sample = TaskSample {
            instant: *instant,
            actuators,
            response,
        };
        Ok((sample, dynamics.limit_margin()))
    }
}

impl TaskFrame {
    /// Returns whether a moment of a motion lies in the workspace, up to rounding.
    fn contains(&self, instant: &TaskInstant) -> bool {
        let at = instant.pose.position - self.centre;
        let is_held = match &self.polygon {
            Some(polygon) => polygon.contains(at) || polygon.distance_to_boundary(at) <= 1e-9 * self.radius,
            None => at.length() <= self.radius * (1.0 + 1e-9),
        };
        let turn = libm::remainder(instant.pose.phi - self.home_phi, 2.0 * std::f64::consts::PI);
        is_held && turn.abs() <= self.half_range * (1.0 + 1e-9) + 1e-12
    }
}
