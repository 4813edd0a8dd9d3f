//! Invalid values of a study.

use super::{Bounds, LengthChoice, settings};
use crate::study::Study;
use kinefront_model::mechanism::Design;
use kinefront_model::workspace::{Grid, GridError};

/// A key with an invalid value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Dotted key.
    pub key: String,
    /// What is wrong and what would be right.
    pub message: String,
}

impl Fault {
    fn new(key: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            key: key.into(),
            message: message.into(),
        }
    }
}

/// Rules about several settings at once, each of which adds what it finds.
const RULES: [fn(&Study, &mut Vec<Fault>); 7] = [
    check_characteristic_length,
    check_slider,
    check_bounds,
    check_proportions,
    check_grids,
    check_moga2,
    check_references,
];

impl Study {
    /// Returns the invalid values; there are none in a valid study.
    pub fn faults(&self) -> Vec<Fault> {
        let table = match toml::Table::try_from(self) {
            Ok(table) => table,
            // The only values that TOML cannot represent are whole numbers beyond its range.
            Err(error) => return vec![Fault::new("optimizer", error.to_string())],
        };
        let mut faults: Vec<Fault> = settings()
            .filter_map(|setting| Some(Fault::new(setting.path(), setting.check.fault(setting.value(&table)?)?)))
            .collect();
        for rule in RULES {
            rule(self, &mut faults);
        }
        faults
    }
}

fn check_characteristic_length(study: &Study, faults: &mut Vec<Fault>) {
    let model = &study.model;
    match (model.characteristic_length, model.characteristic_length_m) {
        (LengthChoice::Fixed, None) => faults.push(Fault::new(
            "model.characteristic_length",
            "is \"fixed\", which requires `characteristic_length_m` beside it",
        )),
        (LengthChoice::PlatformRadius | LengthChoice::Isotropic, Some(_)) => faults.push(Fault::new(
            "model.characteristic_length_m",
            "has no effect unless `characteristic_length = \"fixed\"`",
        )),
        _ => {}
    }
}

fn check_slider(study: &Study, faults: &mut Vec<Fault>) {
    let bodies = &study.bodies;
    if bodies.slider_length < 2.0 * bodies.slider_half_width {
        faults.push(Fault::new(
            "bodies.slider_length",
            format!(
                "is {}; it must be at least twice slider_half_width = {}, because the ends of a slider are round",
                bodies.slider_length, bodies.slider_half_width
            ),
        ));
    }
}

fn check_bounds(study: &Study, faults: &mut Vec<Fault>) {
    for (variable, key) in Bounds::keys() {
        let [lower, upper] = study.bounds.range(variable);
        let (valid, expected) = if variable.may_be_zero() {
            (lower >= 0.0, "at least 0")
        } else {
            (lower > 0.0, "above 0")
        };
        if !(lower.is_finite() && upper.is_finite() && valid) {
            let message = format!("is [{lower}, {upper}]; both must be finite and {expected}");
            faults.push(Fault::new(format!("bounds.{key}"), message));
        } else if lower > upper {
            let message = format!("has its lower bound {lower} above its upper bound {upper}");
            faults.push(Fault::new(format!("bounds.{key}"), message));
        }
    }
}

fn check_proportions(study: &Study, faults: &mut Vec<Fault>) {
    let [smallest, _] = study.bounds.R_m;
    let limit = Design::MAX_RATIO;
    for (key, [_, largest]) in [("bounds.r_m", study.bounds.r_m), ("bounds.Lb_m", study.bounds.Lb_m)] {
        if largest > limit * smallest {
            let message =
                format!("has an upper bound above {limit} times the smallest R; the workspace grid scales with R");
            faults.push(Fault::new(key, message));
        }
    }
}

fn check_grids(study: &Study, faults: &mut Vec<Fault>) {
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
                format!("has too many poses: {error}; enlarge phi_step_deg, or take fewer directions or ray_steps"),
            ),
            Err(error @ GridError::TurnNotWhole(_)) => Fault::new(key, format!("is invalid: {error}")),
        };
        faults.push(fault);
    }
}

fn check_moga2(study: &Study, faults: &mut Vec<Fault>) {
    let moga2 = &study.optimizer.moga2;
    let sum = moga2.directional_crossover + moga2.selection + moga2.mutation;
    if sum > 1.0 + 1e-12 {
        faults.push(Fault::new(
            "optimizer.moga2.directional_crossover",
            format!("gives a sum of {sum} with selection and mutation; the sum of the probabilities must not exceed 1"),
        ));
    }
}

fn check_references(study: &Study, faults: &mut Vec<Fault>) {
    for reference in &study.references {
        let name = &reference.name;
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
