//! The shortest cycle of a motion that the limits of a study allow a design (docs/model.md, section 15.10).

use super::{Evaluation, Model, Quantity, QuantityLimit, quantities};
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

impl Model {
    /// Returns the shortest cycle of the motion of the study in which an evaluated design keeps all limits of the motion, by bisection: a
    /// faster motion is taken to ask for more. `None` without a motion that the design follows, without a limit of it, and if no cycle
    /// keeps them, because gravity or the tool alone asks for more.
    pub fn shortest_cycle(&self, evaluation: &Evaluation) -> Option<ShortestCycle> {
        let task = self.settings().task.as_ref()?;
        let limits = self.settings().limits.iter().filter(|limit| {
            let is_worse_if_faster = Quantity::OF_TASK.contains(&limit.quantity)
                && ![Quantity::CycleTime, Quantity::PathReach].contains(&limit.quantity);
            is_worse_if_faster && limit.bound.most().is_some() && limit.quantity.is_of(&evaluation.design)
        });
        let limits: Vec<QuantityLimit> = limits.copied().collect();
        if limits.is_empty() {
            return None;
        }
        let now = task.motion(&self.frame_of_task(evaluation))?.cycle_time();
        let worst = |factor: f64| self.worst_limit(evaluation, task, now * factor, &limits);
        let (margin, mut limit) = worst(1.0)?;
        let is_kept = margin >= 0.0;
        // A cycle that keeps all limits becomes shorter until one is missed, and another one longer until none is.
        let ratio = if is_kept { 0.5 } else { 2.0 };
        let (mut near, mut beyond) = (1.0, ratio);
        loop {
            if !(1.0 / MOST..=MOST).contains(&beyond) {
                return None;
            }
            let (margin, found) = worst(beyond)?;
            if margin < 0.0 {
                limit = found;
            }
            if (margin >= 0.0) != is_kept {
                break;
            }
            (near, beyond) = (beyond, beyond * ratio);
        }
        let (mut slow, mut fast) = if is_kept { (near, beyond) } else { (beyond, near) };
        for _ in 0..HALVINGS {
            let middle = (slow * fast).sqrt();
            let (margin, found) = worst(middle)?;
            if margin >= 0.0 {
                slow = middle;
            } else {
                (fast, limit) = (middle, found);
            }
        }
        Some(ShortestCycle {
            time: now * slow,
            limit,
        })
    }

    /// Returns the limit with the least margin in a cycle of a time, and this margin; `None` if the design does not follow such a cycle.
    fn worst_limit(
        &self,
        evaluation: &Evaluation,
        task: &Task,
        time: f64,
        limits: &[QuantityLimit],
    ) -> Option<(f64, QuantityLimit)> {
        let task = Task {
            timing: TaskTiming::Cycle(time),
            ..task.clone()
        };
        let (outcome, _) = self.follow(evaluation, &task);
        let margin = |limit: &QuantityLimit| {
            let value = quantities::of_task(limit.quantity, self, &evaluation.design, &outcome)?;
            Some((limit.margin(value), *limit))
        };
        let margins: Option<Vec<(f64, QuantityLimit)>> = limits.iter().map(margin).collect();
        margins?.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))
    }
}
