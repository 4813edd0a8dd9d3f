//! What is wrong with the ranges of the design variables, and with the region that designs are to reach.

use super::Fault;
use crate::settings::Bounds;
use crate::study::{Study, variables};
use kinefront_model::mechanism::{Architecture, DESIGN_VARIABLES, Design, DesignVariable, FURTHER_VARIABLES};

pub(super) fn check_bounds(study: &Study, faults: &mut Vec<Fault>) {
    let further = study.bounds.further_variables();
    for variable in DESIGN_VARIABLES.into_iter().chain(further) {
        let key = format!("bounds.{}", Bounds::key(variable));
        let [lower, upper] = study.bounds.range(variable);
        let (valid, expected) = match variable {
            DesignVariable::GuideAngle => (lower > 0.0 && upper < 180.0, "above 0° and below 180°"),
            // The setting itself keeps these within a turn.
            _ if variable.is_angle() => (true, "within ±360°"),
            _ if variable.may_be_zero() => (lower >= 0.0, "at least 0"),
            _ => (lower > 0.0, "above 0"),
        };
        if !(lower.is_finite() && upper.is_finite() && valid) {
            let message = format!("is [{lower}, {upper}]; both must be finite and {expected}");
            faults.push(Fault::new(&*key, message));
        } else if lower > upper {
            let message = format!("has its lower bound {lower} above its upper bound {upper}");
            faults.push(Fault::new(&*key, message));
        }
        let has_it = |architecture: &Architecture| architecture.has(variable);
        if FURTHER_VARIABLES.contains(&variable) && !study.architectures.iter().any(has_it) {
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

pub(super) fn check_proportions(study: &Study, faults: &mut Vec<Fault>) {
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

pub(super) fn check_variables(study: &Study, faults: &mut Vec<Fault>) {
    if faults
        .iter()
        .any(|fault| fault.key.starts_with("sections.") || fault.key.starts_with("bounds."))
    {
        return;
    }
    let found = variables::faults(study).into_iter();
    faults.extend(found.map(|(key, message)| Fault::new(key, message)));
}

pub(super) fn check_region(study: &Study, faults: &mut Vec<Fault>) {
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
