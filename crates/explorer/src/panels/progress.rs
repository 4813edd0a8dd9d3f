//! What the search knew as it went on: curves over the number of evaluations.

use egui::{ComboBox, Ui};
use egui_plot::{HoverPosition, Line, Plot, PlotPoints, Points};
use std::time::Duration;

use crate::{Session, theme};
use kinefront_model::mechanism::Architecture;
use kinefront_scene::text;
use kinefront_study::{GenerationSummary, Study};

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
    TimePerDesign,
    Architectures,
}

impl ProgressCurve {
    const ALL: [ProgressCurve; 5] = [
        ProgressCurve::Hypervolume,
        ProgressCurve::FeasibleShare,
        ProgressCurve::FrontSize,
        ProgressCurve::TimePerDesign,
        ProgressCurve::Architectures,
    ];

    fn title(self, study: &Study) -> String {
        let with_unit = |name: &str, unit: &str| match unit {
            "" => name.to_owned(),
            unit => format!("{name} [{unit}]"),
        };
        match self {
            ProgressCurve::Hypervolume => match study.objectives()[..] {
                [objective] => {
                    let entry = objective.quantity.entry();
                    with_unit(&format!("best {}", entry.label), entry.unit)
                }
                _ => with_unit("hypervolume", &study.hypervolume_unit()),
            },
            ProgressCurve::FeasibleShare => "feasible designs [%]".to_owned(),
            ProgressCurve::FrontSize => "designs on the front".to_owned(),
            ProgressCurve::TimePerDesign => "time for each design [ms]".to_owned(),
            ProgressCurve::Architectures => "candidates of each architecture [%]".to_owned(),
        }
    }

    /// Returns the value after a generation, for the curves that have one.
    fn value(self, study: &Study, generation: &GenerationSummary) -> Option<f64> {
        match self {
            ProgressCurve::Hypervolume if study.objectives.len() == 1 => {
                study.best_value(generation.hypervolume).map(|(_, value)| value)
            }
            ProgressCurve::Hypervolume => Some(generation.hypervolume),
            ProgressCurve::FeasibleShare => {
                Some(100.0 * generation.feasible as f64 / generation.evaluations.max(1) as f64)
            }
            ProgressCurve::FrontSize => Some(generation.front_size as f64),
            ProgressCurve::TimePerDesign | ProgressCurve::Architectures => None,
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
        // A run that is extended beyond its budget gets wider intervals only when they would be twice as many.
        let mut width = session.study().optimizer.evaluations.div_ceil(INTERVALS).max(1);
        while store.len() > 2 * INTERVALS * width {
            width *= 2;
        }
        let of = (session.era(), width);
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
            .selected_text(self.shown.title(session.study()))
            .width(220.0)
            .show_ui(ui, |ui| {
                for curve in ProgressCurve::ALL {
                    ui.selectable_value(&mut self.shown, curve, curve.title(session.study()));
                }
            });
        let curves = self.curves(ui, session);
        if curves.iter().all(|curve| curve.points.is_empty()) {
            ui.weak(self.why_empty(session));
            return;
        }
        let generations = marks(session.generations());
        let height = ui.available_height().clamp(60.0, 160.0);
        let mut plot = Plot::new("progress plot")
            .height(height)
            .allow_drag(false)
            .allow_zoom(false)
            .allow_scroll(false)
            .allow_boxed_zoom(false)
            .label_formatter(move |pointed| label(pointed, &generations));
        if self.shown != ProgressCurve::Hypervolume || session.study().objectives.len() > 1 {
            plot = plot.include_y(0.0);
        }
        if height >= NAMED {
            plot = plot.x_axis_label("evaluations");
        }
        let shown = plot.show(ui, |plot| {
            for curve in curves {
                let points = PlotPoints::from(curve.points.clone());
                plot.line(Line::new(curve.name.clone(), points).color(curve.color).width(1.6));
                // A mark at the end of each generation, while they can be told apart.
                if curve.points.len() <= INTERVALS {
                    let marks = Points::new(curve.name, PlotPoints::from(curve.points));
                    plot.points(marks.color(curve.color).radius(2.2));
                }
            }
        });
        let name = format!("{} over evaluations", self.shown.title(session.study()));
        shown
            .response
            .widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Image, true, &name));
    }

    /// Says why there is no curve.
    fn why_empty(&self, session: &Session) -> &'static str {
        match self.shown {
            ProgressCurve::TimePerDesign if !session.generations().is_empty() => "an opened run has no timing data",
            _ => "the curve begins with the first generation of a run",
        }
    }

    fn curves(&mut self, ui: &Ui, session: &Session) -> Vec<Curve> {
        if self.shown == ProgressCurve::Architectures {
            self.counts.update(session);
            let dark = ui.visuals().dark_mode;
            let of = |architecture: &Architecture| Curve {
                name: text::architecture(*architecture),
                points: self.counts.share(*architecture),
                color: theme::architecture(*architecture, dark),
            };
            return session.study().architectures.iter().map(of).collect();
        }
        let generations = session.generations();
        let points = if self.shown == ProgressCurve::TimePerDesign {
            times(generations, session.generation_times())
        } else {
            let every = generations.len().div_ceil(MOST_POINTS).max(1);
            let kept = generations.iter().step_by(every);
            let last = generations
                .last()
                .filter(|_| !(generations.len() - 1).is_multiple_of(every));
            kept.chain(last)
                .filter_map(|generation| {
                    Some([
                        generation.evaluations as f64,
                        self.shown.value(session.study(), generation)?,
                    ])
                })
                .collect()
        };
        vec![Curve {
            name: self.shown.title(session.study()),
            points,
            color: theme::good(ui),
        }]
    }
}

/// A curve over the number of evaluations.
struct Curve {
    name: String,
    points: Vec<[f64; 2]>,
    color: egui::Color32,
}

/// Returns the time that a design took over the last generations \[ms\], over the number of evaluations.
fn times(generations: &[GenerationSummary], ends: &[Duration]) -> Vec<[f64; 2]> {
    let every = ends.len().div_ceil(INTERVALS).max(1);
    let mut before = (0, Duration::ZERO);
    let mut points = Vec::new();
    for (generation, &end) in generations.iter().zip(ends).skip(every - 1).step_by(every) {
        let designs = generation.evaluations.saturating_sub(before.0);
        if designs > 0 {
            let time = 1e3 * end.saturating_sub(before.1).as_secs_f64() / designs as f64;
            points.push([generation.evaluations as f64, time]);
        }
        before = (generation.evaluations, end);
    }
    points
}

/// Returns the number of evaluations at the end of each generation, with the number of the generation.
fn marks(generations: &[GenerationSummary]) -> Vec<(usize, usize)> {
    let mark = |generation: &GenerationSummary| (generation.evaluations, generation.generation);
    generations.iter().map(mark).collect()
}

/// Says which point of a curve the pointer is near: its generation, its number of evaluations, and its value.
fn label(pointed: &HoverPosition<'_>, generations: &[(usize, usize)]) -> Option<String> {
    let HoverPosition::NearDataPoint {
        plot_name, position, ..
    } = pointed
    else {
        return None;
    };
    let place = generations.partition_point(|(evaluations, _)| (*evaluations as f64) < position.x);
    let (_, generation) = generations.get(place).or(generations.last())?;
    Some(format!(
        "generation {generation}, {:.0} evaluations\n{plot_name}: {}",
        position.x,
        theme::number(position.y)
    ))
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
        let ends = [Duration::from_millis(800)];
        assert_eq!(times(&[generation], &ends), [[80.0, 10.0]]);
        assert_eq!(times(&[generation], &[]), [] as [[f64; 2]; 0], "a run that was opened");
        let values = ProgressCurve::ALL.map(|curve| curve.value(&Study::default(), &generation));
        assert_eq!(values, [Some(3.5), Some(25.0), Some(7.0), None, None]);
    }
}
