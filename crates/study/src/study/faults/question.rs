//! What is wrong with the question of a study: its objectives and its limits.

use super::Fault;
use crate::settings::{
    AlgorithmName, AnywhereSection, LimitChoice, ObjectiveChoice, ToleranceSection, unknown_quantity,
};
use crate::study::Study;
use kinefront_model::evaluation::{PoseScalar, Quantity, Scope};
use kinefront_model::mechanism::JointKind;

pub(super) fn check_objectives(study: &Study, faults: &mut Vec<Fault>) {
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

pub(super) fn check_constraints(study: &Study, faults: &mut Vec<Fault>) {
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

/// A quantity that a study names needs what it is computed from.
pub(super) fn check_inputs(study: &Study, faults: &mut Vec<Fault>) {
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
