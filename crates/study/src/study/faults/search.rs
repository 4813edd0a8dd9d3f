//! What is wrong with the grids, the optimizer, and the designs that a study refers to.

use super::Fault;
use crate::settings::wrong_name;
use crate::study::Study;
use kinefront_model::workspace::{Grid, GridError};

pub(super) fn check_grids(study: &Study, faults: &mut Vec<Fault>) {
    let range = study.workspace.rotation_range_deg;
    for (name, section) in [("reference", &study.grid.reference), ("fine", &study.grid.fine)] {
        let key = format!("grid.{name}.phi_step_deg");
        // A number that is invalid by itself has its fault already.
        let has_fault = |key: &str| faults.iter().any(|fault| fault.key == key);
        if has_fault(&key) || has_fault("workspace.rotation_range_deg") {
            continue;
        }
        // The range depends on the step alone, so the fault is told even if another number of the grid is invalid.
        let fits = Grid::new(section.phi_step_deg, 1, 1, 0).and_then(|grid| grid.half_window(range));
        let fault = match fits.and_then(|_| Grid::try_from(section).map(|_| ())) {
            Ok(()) | Err(GridError::Empty(_)) => continue,
            Err(GridError::WindowNotWhole {
                half_range_deg,
                step_deg,
            }) => Fault::new(
                "workspace.rotation_range_deg",
                format!("is {range}; half of it, {half_range_deg}°, must be a whole multiple of {key}, {step_deg}°"),
            ),
            Err(error @ GridError::WindowTooWide(_)) => {
                Fault::new("workspace.rotation_range_deg", format!("is invalid: {error} of {key}"))
            }
            Err(error @ GridError::TooFine { .. }) => Fault::new(
                format!("grid.{name}"),
                format!("has too many poses: {error}; increase phi_step_deg, or use fewer directions or ray_steps"),
            ),
            Err(error @ GridError::TurnNotWhole(_)) => Fault::new(key, format!("is invalid: {error}")),
        };
        faults.push(fault);
    }
}

pub(super) fn check_moga2(study: &Study, faults: &mut Vec<Fault>) {
    let moga2 = &study.optimizer.moga2;
    let sum = moga2.directional_crossover + moga2.selection + moga2.mutation;
    if sum > 1.0 + 1e-12 {
        faults.push(Fault::new(
            "optimizer.moga2.directional_crossover",
            format!("gives a sum of {sum} with selection and mutation; the sum of the probabilities must not exceed 1"),
        ));
    }
}

pub(super) fn check_references(study: &Study, faults: &mut Vec<Fault>) {
    for reference in &study.references {
        let name = &reference.name;
        if let Some(message) = wrong_name(name) {
            faults.push(Fault::new("references", format!("hold a name that {message}")));
            continue;
        }
        if let Err(error) = reference.parse(study.working_mode) {
            faults.push(Fault::new("references", format!("`{name}`: {error}")));
        }
        for (key, value) in [
            ("mass_kg", reference.mass_kg),
            ("workspace_radius_m", reference.workspace_radius_m),
        ] {
            if let Some(value) = value.filter(|value| !(0.0..=1e15).contains(value)) {
                let message = format!("`{name}`: `{key}` is {value}; it must be at least 0 (and at most 1e15)");
                faults.push(Fault::new("references", message));
            }
        }
    }
}
