//! An axis of the scatter: its quantity, range and ticks.

use egui_plot::{GridInput, GridMark, PlotBounds};
use kinefront_model::evaluation::Better;
use kinefront_study::Column;

use crate::Store;

/// Column and scale of an axis.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(from = "(String, bool)", into = "(String, bool)")]
pub struct ScatterAxis {
    pub(super) quantity: Column,
    pub(super) log: bool,
}

/// Returns a pair of axes; the first is logarithmic if `log` is true.
pub fn axes(x: Column, y: Column, log: bool) -> [ScatterAxis; 2] {
    [
        ScatterAxis { quantity: x, log },
        ScatterAxis {
            quantity: y,
            log: false,
        },
    ]
}

impl From<ScatterAxis> for (String, bool) {
    fn from(axis: ScatterAxis) -> Self {
        (axis.quantity.name().into_owned(), axis.log)
    }
}

impl From<(String, bool)> for ScatterAxis {
    fn from((key, log): (String, bool)) -> Self {
        Self {
            quantity: Column::find_quantity(&key).unwrap_or(Column::Violation),
            log,
        }
    }
}

impl ScatterAxis {
    /// Returns the axis of a quantity with the scale that is usual for it.
    pub fn usual(quantity: Column) -> Self {
        let log = quantity.is_logarithmic();
        Self { quantity, log }
    }

    /// Returns the place of a value on the axis: on a logarithmic one, its decimal logarithm.
    pub fn place(self, value: f64) -> f64 {
        if self.log { value.max(1e-12).log10() } else { value }
    }

    /// Returns the value at a place of the plot.
    pub(super) fn value(self, place: f64) -> f64 {
        if self.log { libm::exp10(place) } else { place }
    }

    pub(super) fn title(self) -> String {
        let better = match self.quantity.better() {
            Some(Better::Lower) => "  ◀ better",
            Some(Better::Higher) => "  better ▶",
            None => "",
        };
        format!("{}{better}", self.quantity.title())
    }
}

/// Range of the feasible designs on both axes, updated with those that were added to the store.
#[derive(Default)]
pub(super) struct Extent {
    axes: Option<[ScatterAxis; 2]>,
    era: u64,
    seen: usize,
    low: [f64; 2],
    high: [f64; 2],
}

impl Extent {
    pub(super) fn update(&mut self, axes: [ScatterAxis; 2], era: u64, store: &Store) {
        if self.axes != Some(axes) || self.era != era || self.seen > store.len() {
            *self = Self {
                axes: Some(axes),
                era,
                seen: 0,
                low: [f64::INFINITY; 2],
                high: [f64::NEG_INFINITY; 2],
            };
        }
        let columns = axes.map(|axis| store.column(axis.quantity));
        for id in self.seen..store.len() {
            if store.is_feasible(id) {
                self.include([0, 1].map(|k| axes[k].place(columns[k][id])));
            }
        }
        self.seen = store.len();
    }

    fn include(&mut self, place: [f64; 2]) {
        if place.iter().all(|value| value.is_finite()) {
            for k in 0..2 {
                self.low[k] = self.low[k].min(place[k]);
                self.high[k] = self.high[k].max(place[k]);
            }
        }
    }

    pub(super) fn bounds(&self) -> PlotBounds {
        let range = |k: usize| {
            let (low, high) = (self.low[k], self.high[k]);
            if low > high {
                return [0.0, 1.0];
            }
            let margin = 0.05 * (high - low).max(1e-3 * high.abs()).max(1e-9);
            [low - margin, high + margin]
        };
        let ([x0, x1], [y0, y1]) = (range(0), range(1));
        PlotBounds::from_min_max([x0, y0], [x1, y1])
    }
}

pub(super) fn tick(axis: ScatterAxis, mark: GridMark) -> String {
    if axis.log {
        let value = 10f64.powf(mark.value);
        if !(1e-3..1e5).contains(&value) {
            format!("{value:.0e}")
        } else {
            // Rounding removes the rounding error of the power.
            format!("{}", (value * 1e6).round() / 1e6)
        }
    } else {
        let digits = (-mark.step_size.abs().log10().floor()).clamp(0.0, 8.0) as usize;
        format!("{:.digits$}", mark.value)
    }
}

/// Returns grid marks at 1, 2 and 5 times the powers of ten; those at 2 and 5 show only where there is room.
pub(super) fn decades(input: GridInput) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    let mut marks = Vec::new();
    for decade in low.floor() as i32..=high.ceil() as i32 {
        for (factor, step) in [(1.0f64, 1.0), (2.0, 0.3), (5.0, 0.3)] {
            let value = f64::from(decade) + factor.log10();
            if (low..=high).contains(&value) {
                marks.push(GridMark { value, step_size: step });
            }
        }
    }
    marks
}
