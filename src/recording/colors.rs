//! Colours of the palette as the viewer takes them, and those of overlays.

use rerun::Color;

use kinefront_model::mechanism::{Architecture, ReachReason};
use crate::palette;
use crate::scene::{Part, Scale};

/// The architecture's colour.
pub(super) fn architecture(architecture: Architecture) -> Color {
    rgb(palette::architecture(architecture))
}

/// The part's colour.
pub(super) fn part(part: Part) -> Color {
    rgb(palette::part(part))
}

/// The regular workspace.
pub(super) const WORKSPACE: [u8; 3] = [255, 255, 255];
/// Where a field has its threshold.
pub(super) const THRESHOLD: [u8; 3] = [255, 70, 200];
/// Parallel singularities.
pub(super) const SINGULAR: [u8; 3] = [255, 40, 40];
/// Poses that stop the workspace from growing.
pub(super) const LIMIT: [u8; 3] = [255, 70, 60];
/// Text and ticks.
pub(super) const TEXT: [u8; 3] = [205, 208, 214];
/// Text on a light ground.
pub(super) const INK: [u8; 3] = [12, 14, 18];
/// Ellipsoids.
pub(super) const ELLIPSOID: [u8; 3] = [255, 235, 140];

/// Edge of the reachable workspace: red where a leg is stretched out, which is a serial singularity.
pub(super) fn edge(reason: ReachReason) -> Color {
    rgb(match reason {
        ReachReason::OutOfReach | ReachReason::Degenerate => [255, 140, 60],
        ReachReason::BelowLimit | ReachReason::AboveLimit => [150, 156, 168],
    })
}

pub(super) fn rgb([r, g, b]: [u8; 3]) -> Color {
    Color::from_rgb(r, g, b)
}

/// A range of values spread over viridis, which is even to the eye and in print.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ColorMap {
    scale: Scale,
    low: f64,
    high: f64,
}

/// Most decades that a logarithmic map covers: beyond them differences do not matter.
const DECADES: f64 = 4.0;

impl ColorMap {
    /// A map over `range`; a logarithmic one keeps the decades on the side of `threshold`.
    pub(super) fn new(scale: Scale, [low, high]: [f64; 2], threshold: f64) -> Self {
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

    /// Place of a value in the map, 0 to 1.
    fn share(&self, value: f64) -> f64 {
        let share = match self.scale {
            Scale::Linear => (value - self.low) / (self.high - self.low),
            Scale::Logarithmic => libm::log(value.max(f64::MIN_POSITIVE) / self.low) / libm::log(self.high / self.low),
        };
        share.clamp(0.0, 1.0)
    }

    /// Colour of a value.
    pub(super) fn color(&self, value: f64) -> Color {
        Self::at(self.share(value))
    }

    /// Colour at a place of the map.
    pub(super) fn at(share: f64) -> Color {
        let color = colorous::VIRIDIS.eval_continuous(share.clamp(0.0, 1.0));
        Color::from_rgb(color.r, color.g, color.b)
    }

    /// Place of a value if it lies inside the map.
    pub(super) fn place(&self, value: f64) -> Option<f64> {
        (self.low..=self.high).contains(&value).then(|| self.share(value))
    }

    /// Round values to write beside the map, with their places.
    pub(super) fn ticks(&self) -> Vec<(f64, f64)> {
        const FEWEST: usize = 3;
        let place = |values: Vec<f64>| -> Vec<(f64, f64)> {
            values
                .into_iter()
                .filter_map(|value| Some((value, self.place(value)?)))
                .collect()
        };
        match self.scale {
            Scale::Linear => place(self.even()),
            Scale::Logarithmic => {
                let decades = place(self.decades());
                // A map within a decade has no powers of ten to show.
                if decades.len() < FEWEST {
                    place(self.even())
                } else {
                    decades
                }
            }
        }
    }

    /// Multiples of a round step.
    fn even(&self) -> Vec<f64> {
        let span = self.high - self.low;
        let decade = libm::pow(10.0, libm::floor(libm::log10(span)));
        let step = [0.1, 0.2, 0.25, 0.5, 1.0]
            .into_iter()
            .map(|share| share * decade)
            .find(|step| span / step <= 6.0)
            .unwrap_or(decade);
        let (first, last) = ((self.low / step).ceil() as i64, (self.high / step).floor() as i64);
        (first..=last).map(|k| k as f64 * step).collect()
    }

    /// Powers of ten, with twos and fives between them where there are few.
    fn decades(&self) -> Vec<f64> {
        let first = libm::log10(self.low).floor() as i32;
        let last = libm::log10(self.high).ceil() as i32;
        let steps: &[f64] = if last - first <= 3 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        (first..=last)
            .flat_map(|decade| steps.iter().map(move |step| step * libm::pow(10.0, f64::from(decade))))
            .collect()
    }
}
