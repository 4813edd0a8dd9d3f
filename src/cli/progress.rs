//! Progress display of a run: a progress bar if standard error is a terminal, otherwise plain lines, and nothing with
//! `--quiet`.

use std::io::IsTerminal;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::Builder;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use kinefront_scene::text;
use kinefront_study::{GenerationSummary, Study};

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
        /// When the verification of the front began, and the number of its fifths reported so far.
        verifying: Option<(Instant, usize)>,
        /// What prints the lines.
        printer: Printer,
    },
}

/// Prints lines on a thread of its own, so that a terminal that is held, for example by Ctrl-S, does not hold the run. Lines
/// that do not fit are left out.
pub struct Printer {
    lines: Option<SyncSender<String>>,
    ended: Receiver<()>,
}

impl Printer {
    fn new() -> Self {
        let (lines, waiting) = sync_channel::<String>(32);
        let (end, ended) = sync_channel(1);
        let printing = Builder::new().name("kinefront-progress".to_owned()).spawn(move || {
            waiting.into_iter().for_each(say);
            let _ = end.send(());
        });
        Self {
            lines: printing.is_ok().then_some(lines),
            ended,
        }
    }

    fn print(&self, line: String) {
        if let Some(lines) = &self.lines {
            let _ = lines.try_send(line);
        }
    }

    /// Waits for the lines that are still to be printed, but not for a terminal that is held.
    fn finish(&mut self) {
        const PATIENCE: Duration = Duration::from_millis(500);
        self.lines = None;
        let _ = self.ended.recv_timeout(PATIENCE);
    }
}

impl Progress {
    /// Creates the progress display of a run of `budget` evaluations, of which `done` are done already.
    pub fn new(budget: usize, done: usize, quiet: bool) -> Self {
        if quiet {
            return Self::Quiet;
        }
        if !std::io::stderr().is_terminal() {
            let printer = Printer::new();
            if done > 0 {
                printer.print(format!("resumed at {done}/{budget} evaluations"));
            }
            let reported = 20 * done / budget;
            return Self::Lines {
                budget,
                reported,
                verifying: None,
                printer,
            };
        }
        let bar = ProgressBar::with_draw_target(Some(budget as u64), ProgressDrawTarget::stderr_with_hz(10))
            .with_style(style(
                "{bar:30.cyan/blue} {pos}/{len} evaluations  {per_sec:.0}  {eta} left  {msg}",
            ));
        keep_ticking(&bar);
        Self::Bar(bar)
    }

    /// Reports a complete generation.
    pub fn generation(&mut self, study: &Study, summary: &GenerationSummary) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => {
                bar.set_position(summary.evaluations as u64);
                bar.set_message(reached(study, summary));
            }
            Self::Lines {
                budget,
                reported,
                printer,
                ..
            } => {
                let twentieths = 20 * summary.evaluations / *budget;
                if twentieths > *reported {
                    *reported = twentieths;
                    printer.print(format!(
                        "generation {}: {}/{budget} evaluations, {} feasible, {}",
                        summary.generation,
                        summary.evaluations,
                        summary.feasible,
                        reached(study, summary)
                    ));
                }
            }
        }
    }

    /// Reports the progress of the verification and the proofs of the designs that are reported.
    pub fn verifying(&mut self, done: usize, total: usize) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => {
                if done == 0 {
                    bar.set_style(style(
                        "{bar:30.cyan/blue} {pos}/{len} designs verified and proved  {eta} left",
                    ));
                    bar.reset();
                }
                bar.set_length(total as u64);
                bar.set_position(done as u64);
            }
            Self::Lines { printer, verifying, .. } => match verifying {
                None => {
                    *verifying = Some((Instant::now(), 0));
                    printer.print(format!("verifying and proving {total} designs of the front"));
                }
                Some((since, fifths)) if 5 * done / total > *fifths => {
                    *fifths = 5 * done / total;
                    let left = since.elapsed().as_secs_f64() * (total - done) as f64 / done as f64;
                    printer.print(format!(
                        "verified and proved {done}/{total} designs, about {left:.0} s left"
                    ));
                }
                Some(_) => {}
            },
        }
    }

    /// Removes the progress bar, or waits for the last lines.
    pub fn finish(&mut self) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => bar.finish_and_clear(),
            Self::Lines { printer, .. } => printer.finish(),
        }
    }
}

/// What a search has reached: the best value of the only objective, or the front and its hypervolume.
fn reached(study: &Study, summary: &GenerationSummary) -> String {
    if let Some((objective, value)) = study.best_value(summary.hypervolume) {
        return format!("best {}", text::quantity(objective.quantity, value));
    }
    if study.objectives.len() == 1 {
        return "none yet".to_owned();
    }
    let hypervolume = text::number(summary.hypervolume);
    let unit = study.hypervolume_unit();
    format!("front {}, hypervolume {hypervolume} {unit}", summary.front_size)
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

/// Redraws a display five times a second until it has finished. Without a thread to spare it stands still in between.
pub fn keep_ticking(bar: &ProgressBar) {
    let bar = bar.downgrade();
    let tick = move || {
        while let Some(bar) = bar.upgrade().filter(|bar| !bar.is_finished()) {
            bar.tick();
            drop(bar);
            std::thread::sleep(Duration::from_millis(200));
        }
    };
    let _ = std::thread::Builder::new()
        .name("kinefront-progress".to_owned())
        .spawn(tick);
}
