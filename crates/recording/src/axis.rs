//! An axis of the plot of a run: an objective, or the evaluations.

use super::point::PlotPoint;
use kinefront_model::evaluation::{Better, Objective, Quantity, Scale};
use kinefront_study::Column;

/// Largest number of steps of an axis that is not logarithmic.
const STEPS: f64 = 8.0;

/// Smallest value that has a place on a logarithmic axis.
const LEAST: f64 = 1e-9;

/// An axis: what it shows, and how far it reaches. It never shrinks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlotAxis {
    shows: Shows,
    /// Smallest and largest coordinate so far; `None` before the first design.
    range: Option<[f64; 2]>,
}

/// What an axis shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shows {
    /// The number of the evaluation.
    Evaluations,
    /// The objective in a place.
    Objective(usize, Objective),
}

/// Ends of an axis and the distance of its ticks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AxisScale {
    pub low: f64,
    pub high: f64,
    pub step: f64,
}

impl PlotAxis {
    pub fn new(shows: Shows) -> Self {
        // What is to be large is seen from 0 on.
        let from_zero = |objective: Objective| objective.goal == Better::Higher && !is_logarithmic(objective);
        let range = match shows {
            Shows::Objective(_, objective) if from_zero(objective) => Some([0.0; 2]),
            _ => None,
        };
        Self { shows, range }
    }

    /// Returns the worst end of the axis; that of the evaluations is the first.
    pub fn worst_end(&self) -> f64 {
        let AxisScale { low, high, .. } = self.scale();
        match self.shows {
            Shows::Objective(_, objective) if objective.goal == Better::Lower => high,
            _ => low,
        }
    }

    fn is_logarithmic(&self) -> bool {
        matches!(self.shows, Shows::Objective(_, objective) if is_logarithmic(objective))
    }

    /// Returns the coordinate of a design: its value or the decade of it.
    pub fn coordinate(&self, point: &PlotPoint) -> Option<f64> {
        let value = match self.shows {
            Shows::Evaluations => point.id? as f64 + 1.0,
            Shows::Objective(place, objective) => objective.value(*point.objectives.get(place)?),
        };
        let at = if self.is_logarithmic() {
            libm::log10(value.max(LEAST))
        } else {
            value
        };
        at.is_finite().then_some(at)
    }

    pub fn include(&mut self, point: &PlotPoint) {
        if let Some(at) = self.coordinate(point) {
            let [low, high] = self.range.unwrap_or([at, at]);
            self.range = Some([low.min(at), high.max(at)]);
        }
    }

    /// Returns the ends of the axis and the distance of its ticks, which are multiples of it.
    pub fn scale(&self) -> AxisScale {
        let [low, high] = match (self.shows, self.range) {
            (Shows::Evaluations, Some([_, last])) => [0.0, last],
            (Shows::Objective(..), Some(range)) => range,
            (_, None) => [0.0, 1.0],
        };
        if self.is_logarithmic() {
            let low = low.floor();
            return AxisScale {
                low,
                high: high.ceil().max(low + 1.0),
                step: 1.0,
            };
        }
        // Equal values get an axis that has a length, too.
        let span = (high - low).max(1e-6 * high.abs()).max(1e-9);
        let decade = libm::pow(10.0, libm::floor(libm::log10(span)));
        let steps = [0.1, 0.2, 0.5, 1.0, 2.0].map(|part| part * decade);
        let step = steps.into_iter().find(|step| span / step <= STEPS).unwrap_or(decade);
        let low = (low / step).floor() * step;
        AxisScale {
            low,
            high: ((high / step).ceil() * step).max(low + step),
            step,
        }
    }

    pub fn ticks(&self) -> Vec<(f32, String)> {
        let AxisScale { low, high, step } = self.scale();
        let count = ((high - low) / step).round() as usize;
        let label = |at: f64| {
            if self.is_logarithmic() {
                decade_label(at as i32)
            } else {
                tick_label(at)
            }
        };
        (0..=count)
            .map(|k| low + k as f64 * step)
            .map(|at| (at as f32, label(at)))
            .collect()
    }

    pub fn title(&self) -> String {
        let Shows::Objective(_, objective) = self.shows else {
            return "evaluations".to_owned();
        };
        let title = Column::Quantity(objective.quantity).title();
        let better = match (objective.goal, objective.quantity) {
            (Better::Lower, Quantity::Mass) => "lighter",
            (Better::Lower, _) => "smaller",
            (Better::Higher, _) => "larger",
        };
        format!("{title}, {better} is better")
    }
}

/// Whether the values of an objective span decades.
fn is_logarithmic(objective: Objective) -> bool {
    objective.quantity.entry().scale == Scale::Logarithmic
}

/// Returns the label of a decade on a logarithmic axis.
fn decade_label(decade: i32) -> String {
    match decade {
        0..=4 => format!("{}", 10u32.pow(decade.unsigned_abs())),
        _ => format!("1e{decade}"),
    }
}

/// Returns the label of a value on an axis that is not logarithmic, without the rounding errors of multiples of a step.
fn tick_label(value: f64) -> String {
    format!("{}", (value * 1e6).round() / 1e6)
}
