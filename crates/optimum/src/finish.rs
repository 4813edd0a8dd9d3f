//! The last steps to an optimum, by Newton's method on its conditions: near an optimum, the decrease of what is minimised drowns in
//! rounding before the multipliers are exact.

use nalgebra::{DMatrix, DVector};

use super::multipliers::Multipliers;
use super::place::Density;
use super::problem::LocalProblem;
use super::requirement::Critical;
use super::survey::{FOLLOWED, missed};

/// Residual of the multipliers that is not made smaller, and largest one that is.
const EXACT: f64 = 1e-9;
const UNEXPLAINED: f64 = 1e-3;

/// Residual up to which more exact critical poses may explain less than those before.
const LOST: f64 = 1e-5;

/// Largest number of steps.
const STEPS: usize = 4;

/// Largest change of an unknown in a step.
const SLIGHT: f64 = 1e-3;

/// First step by which a critical pose is followed to a design that is very near.
const NEAR: f64 = 1e-3;

/// Distance from a bound at which an unknown stays there.
const AT_BOUND: f64 = 1e-9;

/// A design that is nearly an optimum.
struct Finishing {
    unknowns: Vec<f64>,
    survey: Vec<Critical>,
    multipliers: Multipliers,
}

impl LocalProblem {
    /// Returns unknowns that are nearer to an optimum than the given ones, with the critical poses there; those that were given if there
    /// are none that keep the requirements to `held`.
    pub(crate) fn finished(&self, unknowns: Vec<f64>, survey: Vec<Critical>, held: f64) -> (Vec<f64>, Vec<Critical>) {
        let before = Multipliers::new(self, &unknowns, &survey).residual;
        let first = self.finishing(unknowns.clone(), &survey, held);
        // Of two critical poses that are near each other, the more exact ones may be one pose, which explains less.
        let Some(mut best) = first.filter(|first| first.multipliers.residual <= before.max(LOST)) else {
            return (unknowns, survey);
        };
        for _ in 0..STEPS {
            let residual = best.multipliers.residual;
            if residual <= EXACT || residual > UNEXPLAINED {
                break;
            }
            let Some(change) = self.newton_step(&best).filter(|change| change.amax() <= SLIGHT) else {
                break;
            };
            let moved = best.unknowns.iter().zip(change.iter()).zip(self.bounds());
            let moved = moved.map(|((value, change), [lower, upper])| (value + change).clamp(lower, upper));
            match self.finishing(moved.collect(), &best.survey, held) {
                Some(next) if next.multipliers.residual < residual => best = next,
                _ => break,
            }
        }
        (best.unknowns, best.survey)
    }

    /// Surveys a design near one whose critical poses are known; `None` if it misses a requirement by more than `held`.
    fn finishing(&self, unknowns: Vec<f64>, known: &[Critical], held: f64) -> Option<Finishing> {
        let prepared = self.prepare(&unknowns)?;
        let mut survey = self.survey_from(&prepared, Density::Fine, known, NEAR);
        let is_near = |critical: &Critical| critical.requirement.is_of_poses(self) && critical.slack < FOLLOWED;
        for critical in survey.iter_mut().filter(|critical| is_near(critical)) {
            *critical = self.sharpened(&prepared, critical);
        }
        (missed(&survey) <= held).then(|| Finishing {
            multipliers: Multipliers::new(self, &unknowns, &survey),
            unknowns,
            survey,
        })
    }

    /// Returns the step of Newton's method on the conditions of an optimum: the gradient of the Lagrangian is 0, and the active
    /// requirements are met exactly. Unknowns at a bound stay there.
    fn newton_step(&self, at: &Finishing) -> Option<DVector<f64>> {
        let count = at.unknowns.len();
        let (critical, weights): (Vec<Critical>, Vec<f64>) = at
            .multipliers
            .critical_with_values()
            .filter(|(_, multiplier)| *multiplier > 0.0)
            .map(|(critical, multiplier)| (*critical, multiplier))
            .unzip();
        let free: Vec<usize> = at
            .unknowns
            .iter()
            .zip(self.bounds())
            .enumerate()
            .filter(|(_, (value, [lower, upper]))| **value > lower + AT_BOUND && **value < upper - AT_BOUND)
            .map(|(place, _)| place)
            .collect();
        if critical.len() > free.len() {
            return None;
        }
        let (gradient, rows) = self.derivatives(&at.unknowns, &critical);
        let values = self.values_of(&at.unknowns, &critical);
        // The critical poses move with the design.
        let followed = |moved: &[f64]| -> Option<Vec<Critical>> {
            let prepared = self.prepare(moved)?;
            let follow = |critical: &Critical| match critical.requirement.is_of_poses(self) {
                true => self.sharpened(&prepared, critical),
                false => *critical,
            };
            Some(critical.iter().map(follow).collect())
        };
        let hessian = self.hessian_of_lagrangian(&at.unknowns, &DVector::from_vec(weights), followed)?;
        let size = free.len() + critical.len();
        let mut system = DMatrix::zeros(size, size);
        let mut right = DVector::zeros(size);
        for (row, &unknown) in free.iter().enumerate() {
            for (column, &other) in free.iter().enumerate() {
                system[(row, column)] = hessian[(unknown, other)];
            }
            right[row] = -gradient[unknown];
            for place in 0..critical.len() {
                let slope = rows[(place, unknown)];
                system[(row, free.len() + place)] = -slope;
                system[(free.len() + place, row)] = slope;
            }
        }
        for (place, value) in values.iter().enumerate() {
            right[free.len() + place] = -value;
        }
        let solved = system.lu().solve(&right)?;
        let mut change = DVector::zeros(count);
        for (row, &unknown) in free.iter().enumerate() {
            change[unknown] = solved[row];
        }
        change.iter().all(|number: &f64| number.is_finite()).then_some(change)
    }
}
