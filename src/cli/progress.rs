//! Progress display of a run: a progress bar if standard error is a terminal, otherwise plain lines, and nothing with
//! `--quiet`.

use std::io::IsTerminal;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::Builder;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use kinefront_scene::text;
use kinefront_study::{ConclusionPart, GenerationSummary, Study};

use super::say;

/// Progress of a run.
pub enum Progress {
    /// Nothing is shown (`--quiet`).
    Quiet,
    /// A progress bar on a terminal.
    Bar {
        /// The bar.
        bar: ProgressBar,
        /// The part of the end of the run that it shows.
        concluding: Option<ConclusionPart>,
    },
    /// A line of text for each twentieth of the budget.
    Lines {
        /// Total number of evaluations.
        budget: usize,
        /// Number of twentieths of the budget reported so far.
        reported: usize,
        /// What was told last of the end of the run.
        concluding: Option<Told>,
        /// What prints the lines.
        printer: Printer,
    },
}

/// What was told of a part of the end of a run.
pub struct Told {
    part: ConclusionPart,
    since: Instant,
    /// Number of designs at the beginning.
    first: usize,
    fifths: usize,
}

impl Told {
    fn new(part: ConclusionPart, first: usize) -> Self {
        Self {
            part,
            since: Instant::now(),
            first,
            fifths: 0,
        }
    }

    /// Returns the time that is left \[s\] if another fifth is done.
    fn next(&mut self, done: usize, total: usize) -> Option<f64> {
        let (new, all) = (done.saturating_sub(self.first), total - self.first);
        let fifths = 5 * new / all.max(1);
        if new == 0 || fifths <= self.fifths {
            return None;
        }
        self.fifths = fifths;
        Some(self.since.elapsed().as_secs_f64() * (total - done) as f64 / new as f64)
    }
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
                concluding: None,
                printer,
            };
        }
        let bar = ProgressBar::with_draw_target(Some(budget as u64), ProgressDrawTarget::stderr_with_hz(10))
            .with_style(style(
                "{bar:30.cyan/blue} {pos}/{len} evaluations  {per_sec:.0}  {eta} left  {msg}",
            ));
        keep_ticking(&bar);
        Self::Bar { bar, concluding: None }
    }

    /// Reports a complete generation.
    pub fn generation(&mut self, study: &Study, summary: &GenerationSummary) {
        match self {
            Self::Quiet => {}
            Self::Bar { bar, .. } => {
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

    /// Reports the progress of a part of the end of the run.
    pub fn conclusion(&mut self, part: ConclusionPart, done: usize, total: usize) {
        let (doing, is_done) = match part {
            ConclusionPart::Verification => ("verifying", "verified"),
            ConclusionPart::Proofs => ("proving", "proved"),
        };
        match self {
            Self::Quiet => {}
            Self::Bar { bar, concluding } => {
                if *concluding != Some(part) {
                    *concluding = Some(part);
                    bar.set_style(style(&format!(
                        "{{bar:30.cyan/blue}} {{pos}}/{{len}} designs {is_done}  {{eta}} left"
                    )));
                    bar.reset();
                }
                bar.set_length(total as u64);
                bar.set_position(done as u64);
            }
            Self::Lines {
                printer, concluding, ..
            } => match concluding {
                Some(told) if told.part == part => {
                    if let Some(left) = told.next(done, total) {
                        printer.print(format!("{is_done} {done}/{total} designs, about {left:.0} s left"));
                    }
                }
                _ => {
                    *concluding = Some(Told::new(part, done));
                    printer.print(format!("{doing} {} designs of the front", total - done));
                }
            },
        }
    }

    /// Removes the progress bar, or waits for the last lines.
    pub fn finish(&mut self) {
        match self {
            Self::Quiet => {}
            Self::Bar { bar, .. } => bar.finish_and_clear(),
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
