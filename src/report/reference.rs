//! The reference designs of a study: the values that their source states, the values that this model computes, and the
//! lightest design that replaces each of them.

use super::{Front, Fronts};
use crate::study::Study;
use kinefront_model::evaluation::{Evaluation, GridChoice, Model};
use kinefront_model::mechanism::{DESIGN_VARIABLES, Design};

/// A reference design of the study.
#[derive(Debug, Clone)]
pub struct EvaluatedReference {
    /// Name of the design.
    pub name: String,
    /// Mass stated by the source of the design \[kg\].
    pub stated_mass: Option<f64>,
    /// `R_w` stated by the source of the design \[m\].
    pub stated_radius: Option<f64>,
    /// Evaluation on the reference grid.
    pub coarse: Evaluation,
    /// Evaluation on the fine grid.
    pub fine: Evaluation,
    /// Smallest and largest mass for bar radii that round to the stated ones to the nearest millimetre \[kg\].
    pub mass_range: [f64; 2],
    /// The lightest design found with at least the `R_w` of this design on the fine grid, if it is lighter than this
    /// design and this design is feasible.
    pub lighter: Option<Evaluation>,
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
                name: reference.name.clone(),
                stated_mass: reference.mass_kg,
                stated_radius: reference.workspace_radius_m,
                coarse: model.evaluate(&design, GridChoice::Reference),
                mass_range: [-1.0, 1.0].map(|side| mass_with_thicker_bars(model, &design, side * 0.0005)),
                lighter: lighter(&fronts.together, &fine).cloned(),
                fine,
            }
        })
        .collect()
}

/// Returns the lightest design of a front with at least the `R_w` of a reference design, if the reference design is
/// feasible and heavier.
pub(super) fn lighter<'a>(front: &'a Front, reference: &Evaluation) -> Option<&'a Evaluation> {
    front
        .lightest(reference.workspace_radius)
        .filter(|found| reference.is_feasible() && found.mass < reference.mass)
}

/// Computes the mass with both bar radii increased by `more` \[m\].
fn mass_with_thicker_bars(model: &Model, design: &Design, more: f64) -> f64 {
    let mut values = design.values();
    for variable in DESIGN_VARIABLES.into_iter().filter(|variable| variable.may_be_zero()) {
        let value = &mut values[variable as usize];
        *value = (*value + more).max(0.0);
    }
    design.with_dimensions(values).map_or(0.0, |design| model.mass(&design))
}
