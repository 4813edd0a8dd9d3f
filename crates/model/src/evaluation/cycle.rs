//! The shortest cycle of a motion that the limits of a study allow a design (docs/model.md, section 15.10).

use super::{Evaluation, Model, Quantity, QuantityLimit, TaskOutcome, quantities};
use crate::dynamics::{Task, TaskTiming};

/// The shortest cycle that a design can be asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShortestCycle {
    /// Its time, with the rests \[s\].
    pub time: f64,
    /// The limit that a shorter one would miss.
    pub limit: QuantityLimit,
}

/// Largest factor by which the cycle of the study is made shorter or longer.
const MOST: f64 = 1e3;

/// Number of halvings of the interval of the logarithm of the time: the result is right to a millionth.
const HALVINGS: u32 = 24;

/// Quantities that a faster motion makes worse.
const GROWING: [Quantity; 10] = [
    Quantity::CycleEnergy,
    Quantity::CornerPower,
    Quantity::PathSpeed,
    Quantity::PathRate,
    Quantity::PathForce,
    Quantity::PathTorque,
    Quantity::PathForceRms,
    Quantity::PathTorqueRms,
    Quantity::DriveMass,
    Quantity::DriveUtilization,
];

impl Model {
    /// Returns the shortest cycle of the motion of the study in which an evaluated design keeps all limits of the motion, by bisection: a
    /// faster motion is taken to ask for more. `None` without a motion that the design follows, without a limit of it, and if no cycle
    /// keeps them, because gravity or the tool alone asks for more.
    pub fn shortest_cycle(&self, evaluation: &Evaluation) -> Option<ShortestCycle> {
        let task = self.settings().task.as_ref()?;
        let limits = self.settings().limits.iter().filter(|limit| {
            limit.margin(f64::INFINITY) < 0.0
                && GROWING.contains(&limit.quantity)
                && limit.quantity.is_of(&evaluation.design)
        });
        let limits: Vec<QuantityLimit> = limits.copied().collect();
        if limits.is_empty() {
            return None;
        }
        let (outcome, _) = self.follow(evaluation, task);
        let now = outcome.motion?.cycle_time();
        let missed = |factor: f64| self.missed(evaluation, task, now * factor, &limits);
        let (mut slow, mut fast) = (1.0, 1.0);
        let mut set_by = missed(1.0)?;
        match set_by {
            // A cycle that keeps all limits becomes shorter until one is missed, and another one longer until none is.
            None => loop {
                fast *= 0.5;
                if fast * MOST < 1.0 {
                    return None;
                }
                match missed(fast) {
                    Some(None) => slow = fast,
                    Some(found) => {
                        set_by = found;
                        break;
                    }
                    // The rests alone take longer.
                    None => return None,
                }
            },
            Some(_) => loop {
                slow *= 2.0;
                if slow > MOST {
                    return None;
                }
                match missed(slow)? {
                    None => break,
                    found => (fast, set_by) = (slow, found),
                }
            },
        }
        for _ in 0..HALVINGS {
            let middle = (slow * fast).sqrt();
            match missed(middle)? {
                None => slow = middle,
                found => (fast, set_by) = (middle, found),
            }
        }
        Some(ShortestCycle {
            time: now * slow,
            limit: set_by?,
        })
    }

    /// Returns the limit that a cycle of a time misses by most, or that it misses none; `None` if there is no such cycle.
    fn missed(
        &self,
        evaluation: &Evaluation,
        task: &Task,
        time: f64,
        limits: &[QuantityLimit],
    ) -> Option<Option<QuantityLimit>> {
        let task = Task {
            timing: TaskTiming::Cycle(time),
            ..task.clone()
        };
        let (outcome, _) = self.follow(evaluation, &task);
        let margin = |limit: &QuantityLimit| {
            self.value_in(limit.quantity, evaluation, &outcome)
                .map(|value| limit.margin(value))
        };
        let margins: Option<Vec<f64>> = limits.iter().map(margin).collect();
        let worst = margins?.into_iter().zip(limits).min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(Some(*worst.1).filter(|_| worst.0 < 0.0))
    }

    /// Returns a quantity of a motion that came out.
    fn value_in(&self, quantity: Quantity, evaluation: &Evaluation, outcome: &TaskOutcome) -> Option<f64> {
        let figures = outcome.result.as_ref()?.as_ref().ok()?;
        let time = outcome.motion.as_ref()?.cycle_time();
        let drive = outcome.drive.and_then(|selected| {
            let drive = self.settings().drive_catalogue.get(selected.place)?;
            Some((drive.mass, selected.utilization))
        });
        quantities::of_task(quantity, &evaluation.design, figures, time, drive)
    }
}
