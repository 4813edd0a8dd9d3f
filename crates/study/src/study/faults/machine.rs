//! What is wrong with the manipulators of a study: their parts, their motion, and what stands beside them.

use super::Fault;
use crate::settings::{LengthChoice, RailSection, RailSupportChoice, SectionChoice};
use crate::study::{Study, surroundings};
use kinefront_model::mechanism::{Arrangement, Geometry, JointKind};
use kinefront_model::spatial::LEGS;

pub(super) fn check_characteristic_length(study: &Study, faults: &mut Vec<Fault>) {
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

pub(super) fn check_slider(study: &Study, faults: &mut Vec<Fault>) {
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

pub(super) fn check_geometry(study: &Study, faults: &mut Vec<Fault>) {
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

pub(super) fn check_sections(study: &Study, faults: &mut Vec<Fault>) {
    let of = |name: &str, choice: &SectionChoice| {
        let (key, message) = choice.cross_section().err()?;
        Some(Fault::new(format!("sections.{name}.{key}"), message))
    };
    faults.extend(of("legs", &study.sections.legs));
    faults.extend(of("platform", &study.sections.platform));
    faults.extend(of("rails", &study.sections.rails));
}

pub(super) fn check_rails(study: &Study, faults: &mut Vec<Fault>) {
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

pub(super) fn check_task(study: &Study, faults: &mut Vec<Fault>) {
    // A number that is invalid by itself has its fault already.
    if faults.iter().any(|fault| fault.key.starts_with("task.")) {
        return;
    }
    let found = study.task.faults().into_iter();
    faults.extend(found.map(|(key, message)| Fault::new(format!("task.{key}"), message)));
}

pub(super) fn check_drives(study: &Study, faults: &mut Vec<Fault>) {
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

pub(super) fn check_surroundings(study: &Study, faults: &mut Vec<Fault>) {
    let found = surroundings::faults(study).into_iter();
    faults.extend(found.map(|(key, message)| Fault::new(key, message)));
}
