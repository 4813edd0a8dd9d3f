//! The plot of `R_w` over mass, in `log₁₀(mass/kg)` and metres.

use rerun::Transform3D;
use rerun::datatypes::{Range1D, Range2D};

use super::plot::{FrontPoint, HEIGHT, PlotGrid, decade_label, tick_label};
use crate::study::Study;

/// Returns the position of a design in the plot.
pub(super) fn position(mass: f64, radius: f64) -> [f32; 2] {
    // The mass of a massless design (both bar radii 0) has no logarithm and is replaced by 0.1 g.
    [libm::log10(mass.max(1e-4)) as f32, radius as f32]
}

/// Range of the plot: decades of mass and metres of `R_w`. It never shrinks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlotRange {
    decades: (i32, i32),
    /// Number of ticks above 0 on the `R_w` axis.
    ticks: u32,
    tick: f64,
}

impl PlotRange {
    /// Creates the range for a study: four decades of mass up to the decade of the hypervolume's reference mass, and
    /// `R_w` up to 65 % of the largest base radius.
    pub(super) fn new(study: &Study) -> Self {
        let top = libm::log10(study.hypervolume.reference_mass_kg).ceil() as i32;
        let largest = 0.65 * study.bounds.R_m[1];
        let decade = libm::pow(10.0, libm::floor(libm::log10(largest)));
        let tick = [0.1, 0.2, 0.5]
            .into_iter()
            .map(|fraction| fraction * decade)
            .find(|tick| largest / tick <= 14.0)
            .unwrap_or(decade);
        Self {
            decades: (top - 4, top),
            ticks: (largest / tick).ceil() as u32,
            tick,
        }
    }

    /// Extends the range to contain a design; returns whether the range changed.
    pub(super) fn include(&mut self, mass: f64, radius: f64) -> bool {
        let before = *self;
        let [x, y] = position(mass, radius);
        if radius > 0.0 {
            self.decades.0 = self.decades.0.min(x.floor() as i32);
            self.decades.1 = self.decades.1.max(x.ceil() as i32);
        }
        self.ticks = self.ticks.max((f64::from(y) / self.tick).ceil() as u32);
        *self != before
    }

    /// Returns whether the mass of a design lies within the range; infeasible designs outside it are not drawn.
    pub(super) fn holds(&self, mass: f64, radius: f64) -> bool {
        let [x, _] = position(mass, radius);
        (self.decades.0 as f32..=self.decades.1 as f32).contains(&x)
    }

    /// Returns the transform from plot coordinates to those of the view: y points upwards, and the `R_w` axis is as
    /// high as [`HEIGHT`] decades of mass are wide.
    pub(super) fn transform(&self) -> Transform3D {
        let height = self.tick as f32 * self.ticks as f32;
        Transform3D::from_scale([1.0, -HEIGHT / height, 1.0])
    }

    /// Returns the visible range of the view, in its own coordinates: the plot, with space for its tick labels.
    pub(super) fn bounds(&self) -> Range2D {
        let (left, right) = (f64::from(self.decades.0), f64::from(self.decades.1));
        let (width, height) = (right - left, f64::from(HEIGHT));
        Range2D {
            x_range: Range1D([left - 0.13 * width, right + 0.07 * width]),
            y_range: Range1D([-1.16 * height, 0.2 * height]),
        }
    }

    /// Returns the boundary of the region that the front dominates, from its lightest design to the right end of the plot.
    pub(super) fn staircase(&self, front: &[FrontPoint]) -> Vec<[f32; 2]> {
        let mut strip: Vec<[f32; 2]> = Vec::new();
        for member in front {
            let [x, y] = position(member.mass, member.radius);
            strip.push([x, strip.last().map_or(0.0, |last| last[1])]);
            strip.push([x, y]);
        }
        if let Some(&[_, y]) = strip.last() {
            strip.push([self.decades.1 as f32, y]);
        }
        strip
    }

    /// Returns the axes and their ticks.
    pub(super) fn grid(&self) -> PlotGrid {
        let decade = |decade: i32| (decade as f32, decade_label(decade));
        let tick = |k: u32| {
            let at = self.tick * f64::from(k);
            (at as f32, tick_label(at))
        };
        PlotGrid {
            x: [self.decades.0 as f32, self.decades.1 as f32],
            y: [0.0, (self.tick * f64::from(self.ticks)) as f32],
            x_ticks: (self.decades.0..=self.decades.1).map(decade).collect(),
            y_ticks: (1..=self.ticks).map(tick).collect(),
            titles: [
                "mass in motion [kg], lighter is better".to_owned(),
                "regular workspace radius R_w [m], larger is better".to_owned(),
            ],
        }
    }
}
