//! Progress display of a run: a progress bar if standard error is a terminal, otherwise plain lines, and nothing with
//! `--quiet`.

use std::io::IsTerminal;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use kinefront::study::GenerationSummary;

use super::say;

/// Progress of a run.
pub enum Progress {
    /// Nothing is shown (`--quiet`).
    Quiet,
    /// A progress bar on a terminal.
    Bar(ProgressBar),
    /// A line of text for each twentieth of the budget.
    Lines {
        /// Total number of evaluations.
        budget: usize,
        /// Number of twentieths of the budget reported so far.
        reported: usize,
    },
}

impl Progress {
    /// Creates the progress display of a run of `budget` evaluations, of which `done` are done already.
    pub fn new(budget: usize, done: usize, quiet: bool) -> Self {
        if quiet {
            return Self::Quiet;
        }
        if !std::io::stderr().is_terminal() {
            if done > 0 {
                say(format_args!("resumed at {done}/{budget} evaluations"));
            }
            let reported = 20 * done / budget;
            return Self::Lines { budget, reported };
        }
        let style =
            ProgressStyle::with_template("{bar:30.cyan/blue} {pos}/{len} evaluations  {per_sec:.0}  {eta} left  {msg}")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = ProgressBar::with_draw_target(Some(budget as u64), ProgressDrawTarget::stderr_with_hz(10))
            .with_style(style);
        bar.enable_steady_tick(Duration::from_millis(200));
        Self::Bar(bar)
    }

    /// Reports a complete generation.
    pub fn generation(&mut self, summary: &GenerationSummary) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => {
                bar.set_position(summary.evaluations as u64);
                bar.set_message(format!(
                    "front {}  hypervolume {:.1}",
                    summary.front_size, summary.hypervolume
                ));
            }
            Self::Lines { budget, reported } => {
                let reached = 20 * summary.evaluations / *budget;
                if reached > *reported {
                    *reported = reached;
                    say(format_args!(
                        "generation {}: {}/{budget} evaluations, {} feasible, front {}, hypervolume {:.1} kg m",
                        summary.generation,
                        summary.evaluations,
                        summary.feasible,
                        summary.front_size,
                        summary.hypervolume
                    ));
                }
            }
        }
    }

    /// Reports the progress of the verification of the front.
    pub fn verifying(&mut self, done: usize, total: usize) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => bar.set_message(format!("verifying the front on the fine grid: {done}/{total}")),
            Self::Lines { .. } if done == 0 => {
                say(format_args!("verifying {total} designs of the front on the fine grid"));
            }
            Self::Lines { .. } => {}
        }
    }

    /// Removes the progress bar.
    pub fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}
