//! Why a point of the objectives cannot be had: the best design near the front for it, and what each requirement would have to give.

use kinefront_model::evaluation::{Evaluation, Quantity};
use kinefront_model::mechanism::{Architecture, Design};
use kinefront_optimum::Polished;

use super::{Drivers, DriversOptions, LocalDesign, LocalFault};
use crate::DesignProblem;

/// Designs of an architecture from which the best one for a point is looked for: those whose other objectives are nearest.
const NEAREST: usize = 3;

impl DesignProblem {
    /// Returns why a value of the first objective cannot be had with the values `held` of other objectives (or for the region of the
    /// study), or that it can: `why_not` of the answer has a deficit that is not negative then. An objective that is not held keeps the value
    /// of the design of the front that is nearest. `designs` are those of a front.
    ///
    /// # Errors
    /// [`LocalFault`] if no design near the front holds these values.
    pub fn why(&self, designs: &[Design], held: &[(Quantity, f64)], wished: f64) -> Result<Drivers, LocalFault> {
        let mut best: Option<(LocalDesign, Polished)> = None;
        let mut fault = LocalFault::Unknown("workspace radius");
        for evaluation in self.nearest(designs, held) {
            let found = self.local_of(&evaluation, held).and_then(|local| {
                let polished = local.best()?;
                Ok((local, polished))
            });
            match found {
                Ok((local, polished)) if polished.is_feasible() => {
                    let sign = local.problem.goal_sign();
                    if best
                        .as_ref()
                        .is_none_or(|(_, other)| sign * polished.objective < sign * other.objective)
                    {
                        best = Some((local, polished));
                    }
                }
                Ok(_) => fault = LocalFault::Infeasible(Box::new(evaluation.design)),
                Err(error) => fault = error,
            }
        }
        let (local, polished) = best.ok_or(fault)?;
        let options = DriversOptions {
            wish: Some(wished),
            ..DriversOptions::default()
        };
        Ok(local.drivers_of(&local.problem, &polished, options))
    }

    /// Returns evaluations of the designs of each architecture whose values are nearest to those that are held; of a study with one
    /// objective, those of the best designs.
    fn nearest(&self, designs: &[Design], held: &[(Quantity, f64)]) -> Vec<Evaluation> {
        let distance = |evaluation: &Evaluation| {
            let off = |(quantity, value): &(Quantity, f64)| {
                let own = evaluation.quantities.get(*quantity).unwrap_or(f64::INFINITY);
                (own - value).abs() / value.abs().max(f64::MIN_POSITIVE)
            };
            match held {
                [] => evaluation.objectives.first().copied().unwrap_or(0.0),
                held => held.iter().map(off).fold(0.0, f64::max),
            }
        };
        // A design of a front may hold on the fine grid alone, on which its home orientation is.
        let mut evaluated: Vec<(f64, Evaluation)> = self
            .evaluate_on_fine_grid(designs)
            .into_iter()
            .filter(Evaluation::is_feasible)
            .map(|evaluation| (distance(&evaluation), evaluation))
            .collect();
        evaluated.sort_by(|a, b| a.0.total_cmp(&b.0));
        let of = |architecture: &'static Architecture| {
            let own = evaluated.iter().map(|(_, evaluation)| evaluation);
            own.filter(|evaluation| evaluation.design.architecture() == *architecture)
                .take(NEAREST)
        };
        Architecture::ALL.iter().flat_map(of).cloned().collect()
    }
}
