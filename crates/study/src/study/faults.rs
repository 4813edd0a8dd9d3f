//! Invalid values of a study.

use super::{Study, surroundings, variables};
use crate::settings::{
    AlgorithmName, AnywhereSection, Bounds, LengthChoice, LimitChoice, ObjectiveChoice, RailSection, RailSupportChoice,
    SectionChoice, ToleranceSection, settings, unknown_quantity, wrong_name,
};
use kinefront_model::evaluation::{PoseScalar, Quantity, Scope};
use kinefront_model::mechanism::{Architecture, Arrangement, Design, DesignVariable, Geometry, JointKind};
use kinefront_model::spatial::LEGS;
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
    pub(crate) fn new(key: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            key: key.into(),
            message: message.into(),
        }
    }
}

/// Rules about several settings at once, each of which adds what it finds.
const RULES: [fn(&Study, &mut Vec<Fault>); 19] = [
    check_characteristic_length,
    check_slider,
    check_bounds,
    check_further_bounds,
    check_geometry,
    check_proportions,
    check_grids,
    check_moga2,
    check_references,
    check_sections,
    check_rails,
    check_variables,
    check_region,
    check_objectives,
    check_constraints,
    check_inputs,
    check_task,
    check_drives,
    check_surroundings,
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
            "is \"fixed\", which also requires `characteristic_length_m`",
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

fn check_further_bounds(study: &Study, faults: &mut Vec<Fault>) {
    for variable in study.bounds.further_variables() {
        let key = format!("bounds.{}", Bounds::key(variable));
        let [lower, upper] = study.bounds.range(variable);
        let (valid, expected) = match variable {
            DesignVariable::ProximalLength => (lower > 0.0, "above 0"),
            DesignVariable::GuideAngle => (lower > 0.0 && upper < 180.0, "above 0° and below 180°"),
            _ => (true, "within ±360°"),
        };
        if !(lower.is_finite() && upper.is_finite() && valid) {
            let message = format!("is [{lower}, {upper}]; both must be finite and {expected}");
            faults.push(Fault::new(&*key, message));
        } else if lower > upper {
            let message = format!("has its lower bound {lower} above its upper bound {upper}");
            faults.push(Fault::new(&*key, message));
        }
        let has_it = |architecture: &Architecture| architecture.has(variable);
        if !study.architectures.iter().any(has_it) {
            let names: Vec<&str> = Architecture::ALL
                .iter()
                .filter(|found| has_it(found))
                .map(|found| found.name())
                .collect();
            let message = format!(
                "has no effect: none of the study's architectures has {}; those that have it are {}",
                variable.symbol(),
                names.join(", ")
            );
            faults.push(Fault::new(key, message));
        }
    }
}

fn check_geometry(study: &Study, faults: &mut Vec<Fault>) {
    let geometry = Geometry::from(Arrangement::from(&study.geometry));
    for (key, [lower, upper]) in [
        ("geometry.rail", geometry.arrangement().rail),
        ("geometry.guide", geometry.arrangement().guide),
    ] {
        if lower >= upper {
            let message = format!("is [{lower}, {upper}]; the second share must be above the first");
            faults.push(Fault::new(key, message));
        }
    }
    let mut architectures = study.architectures.iter();
    let Some(architecture) = architectures.find(|architecture| architecture.chain().is_on_rails()) else {
        return;
    };
    for leg in 0..LEGS {
        let next = (leg + 1) % LEGS;
        if geometry.base_joint(leg, 1.0).distance(geometry.base_joint(next, 1.0)) < 1e-9 {
            let message = format!(
                "puts A{} and A{} at the same point, but the rail of a {architecture} runs from one to the other",
                leg + 1,
                next + 1
            );
            faults.push(Fault::new("geometry.base_angles_deg", message));
        }
    }
}

fn check_proportions(study: &Study, faults: &mut Vec<Fault>) {
    let [smallest, _] = study.bounds.R_m;
    let limit = Design::MAX_RATIO;
    let of_proximal = study.bounds.La_m.map(|range| ("bounds.La_m", range));
    let given = [("bounds.r_m", study.bounds.r_m), ("bounds.Lb_m", study.bounds.Lb_m)];
    for (key, [_, largest]) in given.into_iter().chain(of_proximal) {
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
                format!("has too many poses: {error}; increase phi_step_deg, or use fewer directions or ray_steps"),
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

fn check_sections(study: &Study, faults: &mut Vec<Fault>) {
    let of = |name: &str, choice: &SectionChoice| {
        let (key, message) = choice.cross_section().err()?;
        Some(Fault::new(format!("sections.{name}.{key}"), message))
    };
    faults.extend(of("legs", &study.sections.legs));
    faults.extend(of("platform", &study.sections.platform));
    faults.extend(of("rails", &study.sections.rails));
}

fn check_rails(study: &Study, faults: &mut Vec<Fault>) {
    let rails = &study.rails;
    if rails.supports == RailSupportChoice::Pinned && rails.spans > 1 {
        let message = format!(
            "is {}, but a rail on pinned supports has one span; set supports = \"clamped\", or omit it",
            rails.spans
        );
        faults.push(Fault::new("rails.spans", message));
    }
    let without_radius = "has no effect, because rails are rigid; set rails.radius_m, or omit it";
    if rails.radius_m.is_some() {
        return;
    }
    let defaults = RailSection::default();
    for (key, is_stated) in [
        ("rails.supports", rails.supports != defaults.supports),
        ("rails.spans", rails.spans != defaults.spans),
        ("sections.rails.kind", study.sections.rails != SectionChoice::default()),
    ] {
        if is_stated {
            faults.push(Fault::new(key, without_radius));
        }
    }
}

/// A quantity that a study names needs what it is computed from.
fn check_inputs(study: &Study, faults: &mut Vec<Fault>) {
    let mut fault = |key: String, quantity: &str| {
        let missing = Quantity::find(quantity).and_then(|quantity| missing_input(study, quantity));
        faults.extend(missing.map(|message| Fault::new(key, message)));
    };
    for key in study.constraints.keys() {
        fault(format!("constraints.{key}"), key);
    }
    for choice in &study.objectives {
        fault("objectives".to_owned(), choice.key());
    }
}

/// Returns why no design of a study has a quantity, and what would change that.
fn missing_input(study: &Study, quantity: Quantity) -> Option<String> {
    let key = quantity.entry().key;
    if let (Some(kind), Some(other)) = (quantity.of_actuators(), quantity.of_other_actuators()) {
        let none_has_it = study
            .architectures
            .iter()
            .all(|architecture| architecture.actuator() != kind);
        if none_has_it {
            let move_so = match kind {
                JointKind::Prismatic => "turn",
                JointKind::Revolute => "slide",
            };
            let other = other.entry().key;
            return Some(format!(
                "`{key}` has no value, because all actuators {move_so}; use {other} instead"
            ));
        }
    }
    let all_on_rails = study
        .architectures
        .iter()
        .all(|architecture| architecture.chain().is_on_rails());
    let rails_bend = study.rails.radius_m.is_some() && all_on_rails;
    let message = match quantity {
        Quantity::Worst(PoseScalar::SafetyFactor) if study.material.yield_strength_pa.is_none() => {
            "has no value without a yield strength; set material.yield_strength_pa, or material.name to a known material"
        }
        Quantity::Worst(PoseScalar::BucklingFactor | PoseScalar::NaturalFrequency) | Quantity::FrameFrequency
            if rails_bend =>
        {
            "has no value on rails that bend; omit rails.radius_m, or this quantity"
        }
        Quantity::Worst(PoseScalar::PositionError | PoseScalar::OrientationError)
            if study.tolerances == ToleranceSection::default() =>
        {
            "is 0 without tolerances; state them in [tolerances]"
        }
        Quantity::Worst(
            PoseScalar::ActuatorSpeed | PoseScalar::ActuatorRate | PoseScalar::MotionForce | PoseScalar::MotionTorque,
        ) if study.anywhere == AnywhereSection::default() => "is 0 without a motion; state it in [anywhere]",
        Quantity::DriveMass | Quantity::DriveUtilization if study.drives.catalogue.is_none() => {
            "has no value without a catalogue of drives; state it in drives.catalogue"
        }
        other if Quantity::OF_TASK.contains(&other) && study.task.shape.is_none() => {
            "has no value without a motion; state it in [task]"
        }
        _ => return None,
    };
    Some(format!("`{key}` {message}"))
}

fn check_task(study: &Study, faults: &mut Vec<Fault>) {
    // A number that is invalid by itself has its fault already.
    if faults.iter().any(|fault| fault.key.starts_with("task.")) {
        return;
    }
    let found = study.task.faults().into_iter();
    faults.extend(found.map(|(key, message)| Fault::new(format!("task.{key}"), message)));
}

fn check_drives(study: &Study, faults: &mut Vec<Fault>) {
    if study.drives.catalogue.is_none() {
        return;
    }
    let mut fault = |message: String| faults.push(Fault::new("drives.catalogue", message));
    let drives = match study.drives.drives() {
        Ok(drives) => drives,
        Err(error) => return fault(error.to_string()),
    };
    if study.task.shape.is_none() {
        fault(
            "has no effect without a motion, for which drives are selected; state it in [task], or omit it".to_owned(),
        );
    }
    for (kind, name, moves) in [
        (JointKind::Prismatic, "prismatic", "slide"),
        (JointKind::Revolute, "revolute", "turn"),
    ] {
        let mut architectures = study.architectures.iter();
        if let Some(architecture) = architectures.find(|architecture| architecture.actuator() == kind)
            && drives.of_kind(kind).next().is_none()
        {
            fault(format!(
                "has no drive of the kind {name}, but the actuators of {architecture} {moves}; add one, or omit the architecture"
            ));
        }
    }
}

fn check_variables(study: &Study, faults: &mut Vec<Fault>) {
    if faults
        .iter()
        .any(|fault| fault.key.starts_with("sections.") || fault.key.starts_with("bounds."))
    {
        return;
    }
    let found = variables::faults(study).into_iter();
    faults.extend(found.map(|(key, message)| Fault::new(key, message)));
}

fn check_surroundings(study: &Study, faults: &mut Vec<Fault>) {
    let found = surroundings::faults(study).into_iter();
    faults.extend(found.map(|(key, message)| Fault::new(key, message)));
}

fn check_region(study: &Study, faults: &mut Vec<Fault>) {
    let key = |key: &str| format!("workspace.region.{key}");
    match study.workspace.region.region() {
        Err((at, message)) => faults.push(Fault::new(key(at), message)),
        Ok(_) if faults.is_empty() => {
            let unreachable = study.unreachable_region();
            faults.extend(unreachable.map(|message| Fault::new(key("kind"), message)));
        }
        Ok(_) => {}
    }
}

fn check_objectives(study: &Study, faults: &mut Vec<Fault>) {
    let mut fault = |message: String| faults.push(Fault::new("objectives", message));
    let choices = &study.objectives;
    if choices.is_empty() || choices.len() > 3 {
        fault(format!(
            "has {} entries; a study has one to three objectives",
            choices.len()
        ));
    }
    for (place, choice) in choices.iter().enumerate() {
        let key = choice.key();
        let Some(quantity) = Quantity::find(key) else {
            fault(format!("`{key}` {}", unknown_quantity(key)));
            continue;
        };
        if choices[..place].iter().any(|other| other.key() == key) {
            fault(format!(
                "`{key}` is named twice; each objective must be a different quantity"
            ));
        }
        if quantity == Quantity::WorkspaceRadius && study.workspace.region.is_prescribed() {
            fault(format!(
                "`{key}` is the same for every design, because the region is prescribed; name another quantity, or omit \
                 [workspace.region]"
            ));
        }
    }
    if choices.len() > 1 && study.optimizer.algorithm == AlgorithmName::CmaEs {
        let names: Vec<&str> = choices.iter().map(ObjectiveChoice::key).collect();
        faults.push(Fault::new(
            "optimizer.algorithm",
            format!(
                "is \"cma-es\", which has one objective, but the study has {}: {}; use \"front-de\"",
                choices.len(),
                names.join(", ")
            ),
        ));
    }
    for key in &study.quantities {
        if Quantity::find(key).is_none() {
            faults.push(Fault::new("quantities", format!("`{key}` {}", unknown_quantity(key))));
        }
    }
}

fn check_constraints(study: &Study, faults: &mut Vec<Fault>) {
    for (key, limits) in &study.constraints {
        if let Some(message) = limit_fault(study, key, limits) {
            faults.push(Fault::new(format!("constraints.{key}"), message));
        }
    }
}

fn limit_fault(study: &Study, key: &str, limits: &LimitChoice) -> Option<String> {
    let Some(quantity) = Quantity::find(key) else {
        return Some(unknown_quantity(key));
    };
    let stated = [limits.at_least, limits.at_most];
    let entry = quantity.entry();
    match stated {
        [None, None] => return Some("states no limit; write { at_least = … }, { at_most = … } or both".to_owned()),
        [Some(least), Some(most)] if least > most => {
            return Some(format!(
                "contradicts itself: no value is at least {least} and at most {most} {}",
                entry.unit
            ));
        }
        _ => {}
    }
    if let Some(limit) = stated
        .into_iter()
        .flatten()
        .find(|limit| !limit.is_finite() || limit.abs() > 1e15)
    {
        return Some(format!("has the limit {limit}; it must be a number of at most 1e15"));
    }
    if entry.scope == Scope::Poses && stated.into_iter().flatten().any(|limit| limit < 0.0) {
        return Some("has a limit below 0; this quantity is at least 0 at every feasible pose".to_owned());
    }
    if !entry.may_be_zero && stated.contains(&Some(0.0)) {
        return Some("has a limit of 0; it must be above 0".to_owned());
    }
    if let (Some(least), Some(most)) = (limits.at_least, entry.most)
        && least >= most
    {
        return Some(format!(
            "requires at least {least}, but this quantity is at most {most}"
        ));
    }
    if quantity == Quantity::WorkspaceRadius && study.workspace.region.is_prescribed() {
        return Some("has no effect, because the region is prescribed; omit it, or omit [workspace.region]".to_owned());
    }
    let requirements = &study.requirements;
    let stated = |key: &'static str, value: Option<f64>| value.map(|_| key);
    let requirement = match quantity {
        Quantity::Worst(PoseScalar::StiffnessXy) => stated("k_xy_min_n_per_m", requirements.k_xy_min_n_per_m),
        Quantity::Worst(PoseScalar::StiffnessZ) => stated("k_z_min_n_per_m", requirements.k_z_min_n_per_m),
        Quantity::Worst(PoseScalar::StiffnessPhiZ) => {
            stated("k_phi_z_min_nm_per_rad", requirements.k_phi_z_min_nm_per_rad)
        }
        Quantity::Worst(PoseScalar::Clearance) => stated("clearance_min_m", requirements.clearance_min_m),
        _ => None,
    };
    requirement.filter(|_| limits.at_least.is_some()).map(|requirement| {
        format!("is stated together with requirements.{requirement}, which sets the same limit; omit one of the two")
    })
}
