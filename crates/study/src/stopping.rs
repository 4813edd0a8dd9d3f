//! Rules that end a search before its budget is used up.

use std::time::Duration;

use super::{EndReason, GenerationSummary, OptimizerSection, Stagnation};

/// Returns the reason why a search of this duration and history ends before its budget is used up, or `None` if it continues.
pub(super) fn reason_to_end(
    optimizer: &OptimizerSection,
    elapsed: Duration,
    history: &[GenerationSummary],
) -> Option<EndReason> {
    if optimizer
        .time_limit_s
        .is_some_and(|limit| elapsed.as_secs_f64() >= limit)
    {
        return Some(EndReason::TimeUp);
    }
    let Stagnation { evaluations, gain } = optimizer.stagnation?;
    let last = history.last()?;
    let since = last.evaluations.checked_sub(evaluations)?;
    // The latest state that is at least that many evaluations old; if there is none, no gain can be measured yet.
    let before = history.iter().rev().find(|summary| summary.evaluations <= since)?;
    let stagnated = before.hypervolume > 0.0 && last.hypervolume < before.hypervolume * (1.0 + gain);
    stagnated.then_some(EndReason::Stagnated)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn history(hypervolumes: &[f64]) -> Vec<GenerationSummary> {
        hypervolumes
            .iter()
            .zip(1..)
            .map(|(&hypervolume, generation)| GenerationSummary {
                generation,
                evaluations: 30 * generation,
                feasible: 0,
                front_size: 0,
                hypervolume,
            })
            .collect()
    }

    #[test]
    fn stagnation_is_too_little_gain_over_the_evaluations_given() {
        let optimizer = OptimizerSection {
            stagnation: Some(Stagnation {
                evaluations: 60,
                gain: 0.01,
            }),
            ..OptimizerSection::default()
        };
        let reason = |hypervolumes: &[f64]| reason_to_end(&optimizer, Duration::ZERO, &history(hypervolumes));
        assert_eq!(
            reason(&[100.0, 100.0]),
            None,
            "no 60 evaluations have passed since the first state"
        );
        assert_eq!(reason(&[100.0, 100.0, 100.5]), Some(EndReason::Stagnated));
        assert_eq!(reason(&[100.0, 100.0, 101.5]), None);
        assert_eq!(reason(&[0.0, 0.0, 0.0, 0.0]), None, "nothing feasible yet");
    }

    #[test]
    fn the_time_limit_is_looked_at_after_a_generation() {
        let optimizer = OptimizerSection {
            time_limit_s: Some(2.0),
            ..OptimizerSection::default()
        };
        let reason = |seconds: u64| reason_to_end(&optimizer, Duration::from_secs(seconds), &history(&[1.0]));
        assert_eq!(reason(1), None);
        assert_eq!(reason(2), Some(EndReason::TimeUp));
    }
}
