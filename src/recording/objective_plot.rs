//! The plot of other objectives than mass and the largest workspace: the first two of them, or the only one over the evaluations.

use rerun::Transform3D;
use rerun::datatypes::{Range1D, Range2D};

use super::plot::{HEIGHT, PlotGrid, PlotPoint, decade_label, tick_label};
use crate::study::Column;
use crate::text::number;
use kinefront_model::evaluation::{Better, Objective, Quantity};
use kinefront_optimize::Objectives;

/// Width of the plot in the view, which has the height [`HEIGHT`].
const WIDTH: f32 = 4.0;

/// Largest number of steps of an axis that is not logarithmic.
const STEPS: f64 = 8.0;

/// Smallest value that has a place on a logarithmic axis.
const LEAST: f64 = 1e-9;

/// The plot: what its axes show, and how far they reach. It never shrinks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ObjectivePlot {
    objectives: [Option<Objective>; 3],
    axes: [ObjectiveAxis; 2],
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct ObjectiveAxis {
    shows: Shows,
    /// Smallest and largest coordinate so far; `None` before the first design.
    range: Option<[f64; 2]>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Shows {
    Evaluations,
    Objective(usize, Objective),
}

/// Ends of an axis and the distance of its ticks.
#[derive(Debug, Clone, Copy, PartialEq)]
struct AxisScale {
    low: f64,
    high: f64,
    step: f64,
}

impl ObjectivePlot {
    pub fn new(objectives: &[Objective]) -> Self {
        let axis = |shows: Shows| ObjectiveAxis { shows, range: None };
        let of = |place: usize| {
            objectives
                .get(place)
                .map(|objective| Shows::Objective(place, *objective))
        };
        let shown = match (of(0), of(1)) {
            (Some(first), Some(second)) => [first, second],
            (Some(only), None) => [Shows::Evaluations, only],
            (None, _) => [Shows::Evaluations; 2],
        };
        Self {
            objectives: [0, 1, 2].map(|place| objectives.get(place).copied()),
            axes: shown.map(axis),
        }
    }

    pub fn include(&mut self, point: &PlotPoint) -> bool {
        let before = self.axes.map(|axis| axis.scale());
        if point.is_feasible {
            for axis in &mut self.axes {
                axis.include(point);
            }
        }
        self.axes.map(|axis| axis.scale()) != before
    }

    pub fn holds(&self, point: &PlotPoint) -> bool {
        self.axes.iter().all(|axis| {
            let AxisScale { low, high, .. } = axis.scale();
            axis.coordinate(point).is_some_and(|at| (low..=high).contains(&at))
        })
    }

    pub fn position(&self, point: &PlotPoint) -> Option<[f32; 2]> {
        let [x, y] = self.axes.map(|axis| axis.coordinate(point));
        Some([x? as f32, y? as f32])
    }

    /// Returns the transform that maps the axes to the view: y points upwards.
    pub fn transform(&self) -> Transform3D {
        let [x, y] = self.axes.map(|axis| axis.scale());
        let [wide, high] = [
            f64::from(WIDTH) / (x.high - x.low),
            f64::from(HEIGHT) / (y.high - y.low),
        ];
        Transform3D::from_translation_scale(
            [(-x.low * wide) as f32, (y.low * high) as f32, 0.0],
            [wide as f32, -high as f32, 1.0],
        )
    }

    pub fn bounds() -> Range2D {
        let (width, height) = (f64::from(WIDTH), f64::from(HEIGHT));
        Range2D {
            x_range: Range1D([-0.13 * width, 1.07 * width]),
            y_range: Range1D([-1.16 * height, 0.2 * height]),
        }
    }

    pub fn grid(&self) -> PlotGrid {
        let [x, y] = self.axes.map(|axis| axis.scale());
        let [mut x_ticks, mut y_ticks] = self.axes.map(|axis| axis.ticks());
        // The lower end of the vertical axis meets the other one, whose first label is there.
        y_ticks.remove(0);
        if x_ticks.len() > 12 {
            x_ticks = x_ticks.into_iter().step_by(2).collect();
        }
        PlotGrid {
            x: [x.low as f32, x.high as f32],
            y: [y.low as f32, y.high as f32],
            x_ticks,
            y_ticks,
            titles: self.axes.map(|axis| axis.title()),
        }
    }

    /// States the values of the objectives.
    pub fn words(&self, objectives: &Objectives) -> String {
        let values = self.objectives.iter().flatten().zip(objectives.iter());
        let words = values.map(|(objective, minimised)| {
            let entry = objective.quantity.entry();
            let value = number(objective.value(*minimised));
            format!("{} {value} {}", entry.label, entry.unit).trim_end().to_owned()
        });
        words.collect::<Vec<_>>().join(", ")
    }
}

impl ObjectiveAxis {
    /// Whether the axis is logarithmic: masses and stiffness span decades.
    fn is_logarithmic(&self) -> bool {
        let Shows::Objective(_, objective) = self.shows else {
            return false;
        };
        matches!(
            objective.quantity,
            Quantity::Mass
                | Quantity::LegsMass
                | Quantity::PlatformMass
                | Quantity::StiffnessXy
                | Quantity::StiffnessZ
                | Quantity::StiffnessPhiZ
                | Quantity::DisplacementMax
        )
    }

    /// Returns the coordinate of a design: its value or the decade of it.
    fn coordinate(&self, point: &PlotPoint) -> Option<f64> {
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

    fn include(&mut self, point: &PlotPoint) {
        if let Some(at) = self.coordinate(point) {
            let [low, high] = self.range.unwrap_or([at, at]);
            self.range = Some([low.min(at), high.max(at)]);
        }
    }

    /// Returns the ends of the axis and the distance of its ticks, which are multiples of it.
    fn scale(&self) -> AxisScale {
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

    fn ticks(&self) -> Vec<(f32, String)> {
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

    fn title(&self) -> String {
        let Shows::Objective(_, objective) = self.shows else {
            return "evaluations".to_owned();
        };
        let title = Column::of_quantity(objective.quantity).title();
        let better = match (objective.goal, objective.quantity) {
            (Better::Lower, Quantity::Mass) => "lighter",
            (Better::Lower, _) => "smaller",
            (Better::Higher, _) => "larger",
        };
        format!("{title}, {better} is better")
    }
}
