//! The best design near a given one: a semi-infinite programme, in which every pose of the region is a constraint.
//!
//! The poses at which a requirement is nearest to being missed become constraints, a sequential quadratic programme finds the best design
//! that keeps these, and its own critical poses are added, until none is missed.

use kinefront_model::mechanism::Design;

use super::exchange::Exchange;
use super::polished::Polished;
use super::problem::LocalProblem;

/// Amount by which a design may miss a requirement that is still near to one that holds.
const HOPELESS: f64 = 1e-2;

/// Residual of the multipliers above which the search starts again from stronger designs.
const STALLED: f64 = 1e-5;

/// The same where some slack is asked for.
const QUICKLY_STALLED: f64 = 3e-2;

/// Increases of bars and lengths with which it starts again.
const RESTARTS: [[f64; 2]; 3] = [[0.003, 0.002], [0.01, 0.006], [-0.004, 0.01]];

impl LocalProblem {
    /// Returns the best design near one with a home orientation \[rad\]; `None` if there is none that keeps the requirements.
    pub fn polish(&self, design: &Design, home: f64) -> Option<Polished> {
        self.polish_from(&self.unknowns(design, home))
    }

    /// Returns the best design near some unknowns.
    pub(crate) fn polish_from(&self, start: &[f64]) -> Option<Polished> {
        let mut best: Option<Polished> = None;
        let mut from = start.to_vec();
        let stalled = if self.question().slack > 0.0 {
            QUICKLY_STALLED
        } else {
            STALLED
        };
        for [bars, lengths] in std::iter::once([0.0; 2]).chain(RESTARTS) {
            if let Some(found) = Exchange::new(self, &self.strengthened(&from, bars, lengths)).run() {
                let key = |found: &Polished| (!found.is_feasible(), self.minimised(&found.unknowns));
                if best.as_ref().is_none_or(|best| key(&found) < key(best)) {
                    from.clone_from(&found.unknowns);
                    best = Some(found);
                }
            }
            // Nothing near a design that misses a requirement by much is likely to hold, and a design that is an optimum needs no other.
            let is_enough = best.as_ref().is_none_or(|best| {
                best.missed > HOPELESS || best.is_feasible() && best.multipliers.residual <= stalled
            });
            if is_enough {
                break;
            }
        }
        best.filter(|best| best.missed <= best.allowed.max(1e-6))
    }

    /// Returns unknowns with thicker bars and larger lengths.
    fn strengthened(&self, unknowns: &[f64], bars: f64, lengths: f64) -> Vec<f64> {
        let mut changed = unknowns.to_vec();
        for (value, free) in changed.iter_mut().zip(&self.question().variables) {
            if free.variable.may_be_zero() {
                *value += bars;
            } else if !free.variable.is_angle() {
                *value += lengths;
            }
        }
        for (value, [lower, upper]) in changed.iter_mut().zip(self.bounds()) {
            *value = value.clamp(lower, upper);
        }
        changed
    }
}
