//! Stronger designs in place of one that misses a requirement by little.

use super::{BARS, DesignProblem, Dimensions, LENGTHS};
use kinefront_model::mechanism::{Design, DesignVariable};

/// Relative increases of the bars of a design whose proved radius falls short; the first that restores it is taken.
const INCREASES: [f64; 5] = [1e-4, 2e-4, 3e-4, 5e-4, 1e-3];

/// Relative increases of the dimensions of a design that misses a requirement somewhere in a prescribed region.
const REGION_INCREASES: [f64; 7] = [1e-6, 1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2];

impl DesignProblem {
    /// Returns designs near one that misses a requirement by little, in the order in which they are tried, each with the relative increase
    /// of its dimensions: with ever thicker bars; for a prescribed region then ever larger as a whole, and with the next bar of a list.
    pub(crate) fn strengthened(&self, design: &Design) -> Vec<(Design, f64)> {
        let bars: Vec<DesignVariable> = BARS.into_iter().filter(|bar| self.is_free(*bar)).collect();
        let lengths = LENGTHS.iter().filter(|length| self.is_free(**length));
        let all: Vec<DesignVariable> = lengths.chain(&bars).copied().collect();
        let mut found = Vec::new();
        let mut take = |changed: Option<Dimensions>, increase: f64| {
            let of_values = |values| design.with_dimensions(self.settled(values)).ok();
            let other = changed.and_then(of_values).filter(|other| other != design);
            found.extend(other.map(|other| (other, increase)));
        };
        let increases = if self.is_prescribed {
            &REGION_INCREASES[..]
        } else {
            &INCREASES
        };
        for &increase in increases {
            take(self.times(design, &bars, 1.0 + increase), increase);
        }
        if self.is_prescribed {
            for increase in REGION_INCREASES {
                take(self.times(design, &all, 1.0 + increase), increase);
            }
            for bar in BARS {
                let radius = design.values()[bar as usize];
                let listed = self.listed[bar as usize].iter().flatten().copied();
                if let Some(next) = listed.filter(|other| *other > radius).reduce(f64::min) {
                    // Listed bars are within their bounds; the nearest entry of the list is the next one.
                    take(self.times(design, &[bar], next / radius), next / radius - 1.0);
                }
            }
        }
        found
    }

    /// Returns the dimensions of a design with some of them multiplied, if the bounds allow it.
    fn times(&self, design: &Design, variables: &[DesignVariable], factor: f64) -> Option<Dimensions> {
        let mut values = design.values();
        for &variable in variables {
            let value = &mut values[variable as usize];
            *value *= factor;
            if *value > self.ranges[variable as usize][1] {
                return None;
            }
        }
        (!variables.is_empty()).then_some(values)
    }
}
