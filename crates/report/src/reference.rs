//! The reference designs of a study: the values that their source states, the values that this model computes, and the design that
//! replaces each of them.

use super::{Front, Fronts};
use kinefront_model::evaluation::{Evaluation, GridChoice, Model, Quantity};
use kinefront_study::{ReferenceDesign, Study};

/// A reference design of the study.
#[derive(Debug, Clone)]
pub struct EvaluatedReference {
    /// The design as the study states it.
    pub stated: ReferenceDesign,
    /// Evaluation on the reference grid.
    pub coarse: Evaluation,
    /// Evaluation on the fine grid.
    pub fine: Evaluation,
    /// The design found that is best in the first objective of those at least as good in the others as this design on the fine grid,
    /// if it is better than this design and this design is feasible.
    pub better: Option<Evaluation>,
}

impl EvaluatedReference {
    /// Returns a quantity as the source of the design states it.
    pub fn stated(&self, quantity: Quantity) -> Option<f64> {
        match quantity {
            Quantity::Mass => self.stated.mass_kg,
            Quantity::WorkspaceRadius => self.stated.workspace_radius_m,
            _ => None,
        }
    }
}

/// Evaluates the reference designs of the study.
pub(super) fn all(study: &Study, model: &Model, fronts: &Fronts) -> Vec<EvaluatedReference> {
    study
        .references
        .iter()
        // The study was validated when it was read, so every reference can be parsed.
        .filter_map(|reference| Some((reference, reference.parse(study.working_mode).ok()?)))
        .map(|(reference, design)| {
            let fine = model.evaluate(&design, GridChoice::Fine);
            EvaluatedReference {
                stated: reference.clone(),
                coarse: model.evaluate(&design, GridChoice::Reference),
                better: better(&fronts.together, &fine).cloned(),
                fine,
            }
        })
        .collect()
}

/// Returns the design of a front that is best in the first objective of those at least as good in the others as a reference design, if
/// the reference design is feasible and not as good.
pub(super) fn better<'a>(front: &'a Front, reference: &Evaluation) -> Option<&'a Evaluation> {
    front
        .best_with(&reference.objectives[1..])
        .filter(|found| reference.is_feasible() && found.objectives[0] < reference.objectives[0])
}
