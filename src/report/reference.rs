//! The designs that a study refers to: as their source states them, as this model finds them, and what beats them.

use super::{Fronts, ReportError};
use kinefront_model::evaluation::{Evaluation, GridChoice, Model};
use kinefront_model::mechanism::{Design, VARIABLES};
use crate::study::Study;

/// A design that the study refers to.
#[derive(Debug, Clone)]
pub struct Reference {
    /// Its name.
    pub name: String,
    /// Mass that its source states \[kg\].
    pub stated_mass: Option<f64>,
    /// `R_w` that its source states \[m\].
    pub stated_radius: Option<f64>,
    /// On the reference grid.
    pub coarse: Evaluation,
    /// On the fine grid.
    pub fine: Evaluation,
    /// Mass at the two ends of what rounds to its bar radii, were they printed to a millimetre \[kg\].
    pub mass_range: [f64; 2],
    /// The lightest design found with at least its `R_w` on the fine grid.
    pub beaten_by: Option<Evaluation>,
}

/// The study's references.
///
/// # Errors
/// A grid that does not fit.
pub(super) fn all(study: &Study, fronts: &Fronts) -> Result<Vec<Reference>, ReportError> {
    let model = study.model();
    study
        .references
        .iter()
        // A study was read without faults.
        .filter_map(|reference| Some((reference, reference.parse(study.working_mode).ok()?)))
        .map(|(reference, design)| {
            let fine = model.evaluate(&design, GridChoice::Fine)?;
            let beaten_by = fronts.together.lightest(fine.workspace_radius);
            Ok(Reference {
                name: reference.name.clone(),
                stated_mass: reference.mass_kg,
                stated_radius: reference.workspace_radius_m,
                coarse: model.evaluate(&design, GridChoice::Reference)?,
                mass_range: [-1.0, 1.0].map(|side| mass_of(&model, &design, side * 0.0005)),
                beaten_by: beaten_by
                    .filter(|found| fine.is_feasible() && found.mass < fine.mass)
                    .cloned(),
                fine,
            })
        })
        .collect()
}

/// Mass with both bar radii that much larger.
fn mass_of(model: &Model, design: &Design, more: f64) -> f64 {
    let mut values = design.values();
    for variable in VARIABLES.into_iter().filter(|variable| variable.may_be_zero()) {
        let value = &mut values[variable as usize];
        *value = (*value + more).max(0.0);
    }
    Design::new(design.architecture, design.working_mode, values).map_or(0.0, |design| model.mass(&design))
}
