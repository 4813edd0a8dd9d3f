//! The colours of a field, and its legend.

use super::Field;
use kinefront_model::evaluation::Scale;

/// What the legend of a field shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldLegend {
    /// The field.
    pub field: Field,
    /// Its colours.
    pub map: ColorMap,
    /// Value at which a pose ceases to be feasible, in the SI unit.
    pub threshold: f64,
}

/// Maps a range of values to the colour map viridis, which is perceptually uniform on screen and in print.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColorMap {
    scale: Scale,
    low: f64,
    high: f64,
}

/// Largest number of decades that a logarithmic map covers; differences beyond that range do not matter.
const DECADES: f64 = 4.0;

impl ColorMap {
    /// Creates a map over the range from `low` to `high`; a logarithmic map keeps the decades next to `threshold`.
    pub fn new(scale: Scale, [low, high]: [f64; 2], threshold: f64) -> Self {
        match scale {
            Scale::Linear => Self {
                scale,
                low,
                high: if high > low { high } else { low + 1.0 },
            },
            Scale::Logarithmic => {
                let most = libm::pow(10.0, DECADES);
                let threshold = threshold.max(f64::MIN_POSITIVE);
                let low = low.max(threshold / most.sqrt()).max(high / (most * most));
                let high = high.min(low * most).max(low * 1.001);
                Self { scale, low, high }
            }
        }
    }

    /// Returns the smallest and the largest value that the map distinguishes.
    pub fn range(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// Returns the position of a value in the map, from 0 to 1.
    fn fraction(&self, value: f64) -> f64 {
        let fraction = match self.scale {
            Scale::Linear => (value - self.low) / (self.high - self.low),
            Scale::Logarithmic => libm::log(value.max(f64::MIN_POSITIVE) / self.low) / libm::log(self.high / self.low),
        };
        fraction.clamp(0.0, 1.0)
    }

    /// Returns the colour of a value as red, green and blue.
    pub fn color(&self, value: f64) -> [u8; 3] {
        Self::at(self.fraction(value))
    }

    /// Returns the colour at a position in the map, from 0 to 1.
    pub fn at(fraction: f64) -> [u8; 3] {
        let color = colorous::VIRIDIS.eval_continuous(fraction.clamp(0.0, 1.0));
        [color.r, color.g, color.b]
    }

    /// Returns the position of a value in the map, if the map's range contains it.
    pub fn place(&self, value: f64) -> Option<f64> {
        (self.low..=self.high).contains(&value).then(|| self.fraction(value))
    }

    /// Returns round values for the tick labels of the map, with their positions.
    pub fn ticks(&self) -> Vec<(f64, f64)> {
        const FEWEST: usize = 3;
        let place = |values: Vec<f64>| -> Vec<(f64, f64)> {
            values
                .into_iter()
                .filter_map(|value| Some((value, self.place(value)?)))
                .collect()
        };
        let decades = match self.scale {
            Scale::Linear => Vec::new(),
            Scale::Logarithmic => place(self.decades()),
        };
        // A narrow range contains too few decades.
        match decades.len() < FEWEST {
            true => place(self.even()),
            false => decades,
        }
    }

    /// Returns the multiples of a round step.
    fn even(&self) -> Vec<f64> {
        let span = self.high - self.low;
        let decade = libm::pow(10.0, libm::floor(libm::log10(span)));
        let step = [0.1, 0.2, 0.25, 0.5, 1.0]
            .into_iter()
            .map(|fraction| fraction * decade)
            .find(|step| span / step <= 6.0)
            .unwrap_or(decade);
        let (first, last) = ((self.low / step).ceil() as i64, (self.high / step).floor() as i64);
        (first..=last).map(|k| k as f64 * step).collect()
    }

    /// Returns the powers of ten, with 2 and 5 times each if there are few.
    fn decades(&self) -> Vec<f64> {
        let first = libm::log10(self.low).floor() as i32;
        let last = libm::log10(self.high).ceil() as i32;
        let steps: &[f64] = if last - first <= 3 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        (first..=last)
            .flat_map(|decade| steps.iter().map(move |step| step * libm::pow(10.0, f64::from(decade))))
            .collect()
    }
}
