//! What the search knew as it went on: curves over the number of evaluations.

use egui::{ComboBox, Ui};
use egui_plot::{Line, Plot, PlotPoints};

use crate::explorer::{Session, theme};
use crate::study::GenerationSummary;
use crate::text;
use kinefront_model::mechanism::Architecture;

/// Number of intervals of evaluations in which candidates are counted.
const INTERVALS: usize = 60;

/// Largest number of points of a curve, about as many as a screen can show.
const MOST_POINTS: usize = 600;

/// Height below which a plot has no room for the names of its axes \[points\].
const NAMED: f32 = 115.0;

/// What is plotted over the number of evaluations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum ProgressCurve {
    #[default]
    Hypervolume,
    FeasibleShare,
    FrontSize,
    Architectures,
}

impl ProgressCurve {
    const ALL: [ProgressCurve; 4] = [
        ProgressCurve::Hypervolume,
        ProgressCurve::FeasibleShare,
        ProgressCurve::FrontSize,
        ProgressCurve::Architectures,
    ];

    fn title(self) -> &'static str {
        match self {
            ProgressCurve::Hypervolume => "hypervolume [kg·m]",
            ProgressCurve::FeasibleShare => "feasible designs [%]",
            ProgressCurve::FrontSize => "designs on the front",
            ProgressCurve::Architectures => "candidates of each architecture [%]",
        }
    }

    /// Returns the value after a generation, for the curves that have one.
    fn value(self, generation: &GenerationSummary) -> Option<f64> {
        match self {
            ProgressCurve::Hypervolume => Some(generation.hypervolume),
            ProgressCurve::FeasibleShare => {
                Some(100.0 * generation.feasible as f64 / generation.evaluations.max(1) as f64)
            }
            ProgressCurve::FrontSize => Some(generation.front_size as f64),
            ProgressCurve::Architectures => None,
        }
    }
}

/// Numbers of candidates of each architecture in equal intervals of evaluations. Designs are counted once, as they arrive.
#[derive(Default)]
struct ArchitectureCounts {
    /// Store and width of the intervals for which they hold.
    of: (u64, usize),
    counted: usize,
    intervals: Vec<[u32; Architecture::ALL.len()]>,
}

impl ArchitectureCounts {
    fn update(&mut self, session: &Session) {
        let store = session.store();
        let budget = session.study().optimizer.evaluations.max(store.len());
        let of = (session.era(), budget.div_ceil(INTERVALS).max(1));
        if self.of != of || self.counted > store.len() {
            *self = Self { of, ..Self::default() };
        }
        for id in self.counted..store.len() {
            let interval = id / of.1;
            if interval >= self.intervals.len() {
                self.intervals.resize(interval + 1, [0; Architecture::ALL.len()]);
            }
            self.intervals[interval][theme::index(store.architecture(id))] += 1;
        }
        self.counted = store.len();
    }

    /// Returns the share of an architecture over the number of evaluations \[%\].
    fn share(&self, architecture: Architecture) -> Vec<[f64; 2]> {
        let index = theme::index(architecture);
        let share = |(interval, counts): (usize, &[u32; Architecture::ALL.len()])| {
            let all: u32 = counts.iter().sum();
            let middle = (interval as f64 + 0.5) * self.of.1 as f64;
            [middle, 100.0 * f64::from(counts[index]) / f64::from(all.max(1))]
        };
        self.intervals.iter().enumerate().map(share).collect()
    }
}

/// The plot of the search's progress.
#[derive(Default)]
pub(super) struct ProgressPlot {
    shown: ProgressCurve,
    counts: ArchitectureCounts,
}

impl ProgressPlot {
    /// Draws the plot, and a field to choose what it shows.
    pub(super) fn ui(&mut self, ui: &mut Ui, session: &Session) {
        ComboBox::from_id_salt("progress")
            .selected_text(self.shown.title())
            .width(220.0)
            .show_ui(ui, |ui| {
                for curve in ProgressCurve::ALL {
                    ui.selectable_value(&mut self.shown, curve, curve.title());
                }
            });
        let lines = self.lines(ui, session);
        let height = ui.available_height().clamp(60.0, 160.0);
        let mut plot = Plot::new("progress plot")
            .height(height)
            .allow_drag(false)
            .allow_zoom(false)
            .allow_scroll(false)
            .allow_boxed_zoom(false)
            .include_y(0.0);
        if height >= NAMED {
            plot = plot.x_axis_label("evaluations");
        }
        let shown = plot.show(ui, |plot| {
            for line in lines {
                plot.line(line);
            }
        });
        let name = format!("{} over evaluations", self.shown.title());
        shown
            .response
            .widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Image, true, &name));
    }

    fn lines(&mut self, ui: &Ui, session: &Session) -> Vec<Line<'static>> {
        if self.shown == ProgressCurve::Architectures {
            self.counts.update(session);
            let dark = ui.visuals().dark_mode;
            let of = |architecture: &Architecture| {
                let points = PlotPoints::from(self.counts.share(*architecture));
                Line::new(text::architecture(*architecture), points)
                    .color(theme::architecture(*architecture, dark))
                    .width(1.6)
            };
            return session.study().architectures.iter().map(of).collect();
        }
        let generations = session.generations();
        let every = generations.len().div_ceil(MOST_POINTS).max(1);
        let points: Vec<[f64; 2]> = generations
            .iter()
            .step_by(every)
            .chain(generations.last())
            .filter_map(|generation| Some([generation.evaluations as f64, self.shown.value(generation)?]))
            .collect();
        let line = Line::new(self.shown.title(), PlotPoints::from(points));
        vec![line.color(theme::good(ui)).width(1.6)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_an_interval_sum_to_the_whole() {
        let mut intervals = vec![[0; Architecture::ALL.len()]; 2];
        intervals[0][0] = 3;
        intervals[0][1] = 1;
        intervals[1][1] = 5;
        let counts = ArchitectureCounts {
            of: (0, 10),
            counted: 9,
            intervals,
        };
        assert_eq!(counts.share(Architecture::ALL[0]), [[5.0, 75.0], [15.0, 0.0]]);
        assert_eq!(counts.share(Architecture::ALL[1]), [[5.0, 25.0], [15.0, 100.0]]);
    }

    #[test]
    fn values_are_those_of_the_generation() {
        let generation = GenerationSummary {
            generation: 2,
            evaluations: 80,
            feasible: 20,
            front_size: 7,
            hypervolume: 3.5,
        };
        let values = ProgressCurve::ALL.map(|curve| curve.value(&generation));
        assert_eq!(values, [Some(3.5), Some(25.0), Some(7.0), None]);
    }
}
