//! Formatting of numbers and names for display.

use kinefront_model::certify::{MotionCertificate, MotionClaim, MotionMoment, MotionVerdict};
use kinefront_model::clearance::{Clearance, MemberId, StackOrder, Stacking};
use kinefront_model::dynamics::DriveCatalogue;
use kinefront_model::evaluation::{Evaluation, Model, Quantity, QuantityValues, TaskFailure, TaskFault, TaskOutcome};
use kinefront_model::mechanism::{Architecture, CrossSections, Design, DesignVariable, JointKind};
use kinefront_model::spatial::LEGS;
use kinefront_model::workspace::Region;

/// Formats a number with four significant digits: in decimal notation from 0.001 up to 100 000, otherwise in scientific
/// notation. A number that is not finite becomes a dash.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if !value.is_finite() {
        "–".to_owned()
    } else if value == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e5).contains(&size) {
        let digits = (3 - size.log10().floor() as i32).max(0) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.3e}")
    }
}

/// Returns the name of a member, as in `link of leg 1`.
pub fn member(member: &MemberId) -> String {
    format!("{} of leg {}", member.kind.name().replace('_', " "), member.leg + 1)
}

/// Formats a number with at most four decimals and without trailing zeros, as for the labels of a scale: in decimal
/// notation from 0.001 up to 10 000, otherwise in scientific notation.
pub fn short(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e4).contains(&size) {
        let rounded = format!("{value:.4}");
        rounded.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        let text = format!("{value:.2e}");
        text.replace(".00e", "e").replace("0e", "e")
    }
}

/// Writes a region, for example `rectangle of 0.6 × 0.4 m`.
pub fn region(region: &Region) -> String {
    match region {
        Region::Largest => "largest disc".to_owned(),
        Region::Disc(radius) => format!("disc of radius {} m", short(*radius)),
        Region::Polygon(polygon) => match polygon.as_rectangle() {
            Some([low, high]) => {
                let [width, height] = (high - low).to_array().map(short);
                format!("rectangle of {width} × {height} m")
            }
            None => format!("polygon with {} corners", polygon.corners().len()),
        },
    }
}

/// Writes the bars and drives that a design selects from catalogues, each with what it is for, for example `bars of the legs` and
/// `DN 25 M, 33.7 × 3.2 mm`.
pub fn selected_parts(model: &Model, evaluation: &Evaluation) -> impl Iterator<Item = [String; 2]> {
    let drive = evaluation
        .drive
        .and_then(|place| model.settings().drive_catalogue.get(place));
    let drive = drive.map(|drive| {
        [
            "drives".to_owned(),
            format!("3 × {}, {} kg each", drive.name, number(drive.mass)),
        ]
    });
    let is_chosen = model.settings().bodies.stacking == Stacking::Chosen;
    let layers = is_chosen.then(|| ["layers".to_owned(), layers(model.stack_of(&evaluation.design).order)]);
    catalogue_bars(&model.settings().sections, &evaluation.design)
        .chain(drive)
        .chain(layers)
}

/// Writes how the legs of a design are stacked, beginning at the platform, for example `legs 2, 1, 3, stacked`.
pub fn layers(order: StackOrder) -> String {
    let names = |order: [usize; LEGS]| order.map(|leg| (leg + 1).to_string()).join(", ");
    match order {
        StackOrder::Common => "common to all legs".to_owned(),
        StackOrder::Distal(order) => format!("legs {}, distal members stacked", names(order)),
        StackOrder::Legs(order) => format!("legs {}, stacked", names(order)),
    }
}

fn catalogue_bars(sections: &CrossSections, design: &Design) -> impl Iterator<Item = [String; 2]> {
    let bars = [
        ("legs", &sections.legs, design.leg_bar_radius()),
        ("platform", &sections.platform, design.platform_bar_radius()),
    ];
    bars.into_iter().filter_map(|(part, section, radius)| {
        let catalogue = section.catalogue()?;
        let sizes = |radius: f64| {
            let [outer, wall] = [2.0 * radius, section.wall_ratio(radius) * radius].map(|size| short(1e3 * size));
            format!("{outer} × {wall} mm")
        };
        let words = match section.catalogue_name(radius) {
            Some(name) => format!("{name}, {}", sizes(radius)),
            None => {
                let nearest = catalogue.nearest(radius);
                format!(
                    "{}, which the catalogue does not have; the nearest is {}, {}",
                    sizes(radius),
                    nearest.name,
                    sizes(nearest.radius)
                )
            }
        };
        Some([format!("bars of the {part}"), words])
    })
}

/// Writes a quantity with its name and unit, for example `mass 12.34 kg`.
pub fn quantity(quantity: Quantity, value: f64) -> String {
    let entry = quantity.entry();
    format!("{} {} {}", entry.short, number(value), entry.unit)
        .trim_end()
        .to_owned()
}

/// Writes those of some quantities that a design has, for example `mass 12.34 kg, R_w 0.31 m`.
pub fn quantities(shown: impl IntoIterator<Item = Quantity>, values: &QuantityValues) -> String {
    let text = |shown| Some(quantity(shown, values.get(shown)?));
    shown.into_iter().filter_map(text).collect::<Vec<_>>().join(", ")
}

/// Writes a clearance, for example `12.3 mm from leg1_link to leg2_link` or
/// `overlap of 12.3 mm between leg1_link and leg2_link`.
pub fn clearance(clearance: &Clearance) -> String {
    let [member, neighbour] = clearance.pair();
    let size = number(1e3 * clearance.distance.abs());
    if clearance.distance < 0.0 {
        format!("overlap of {size} mm between {member} and {neighbour}")
    } else {
        format!("{size} mm from {member} to {neighbour}")
    }
}

/// Writes the value of a variable: an angle in degrees, the radius of a bar in millimetres, any other length in metres.
pub fn variable_value(variable: DesignVariable, value: f64) -> String {
    if variable.is_angle() {
        format!("{value:.2}°")
    } else if variable.may_be_zero() {
        format!("{:.2} mm", 1e3 * value)
    } else {
        format!("{value:.4} m")
    }
}

/// Returns the name of an architecture for people: as in the paper, or with the actuated joint underlined.
pub fn architecture(architecture: Architecture) -> String {
    if Architecture::PAPER.contains(&architecture) {
        architecture.name().to_owned()
    } else {
        architecture.underlined_name()
    }
}

/// Says that a path gives no motion.
pub const NO_MOTION: &str =
    "there is no motion: the path has no length, or it is scaled to a workspace that the design does not have";

/// Returns why a design does not follow its motion, in words.
pub fn motion_fault(outcome: &TaskOutcome) -> Option<String> {
    let Some(result) = &outcome.result else {
        return Some(NO_MOTION.to_owned());
    };
    result.as_ref().err().map(motion_failure)
}

/// Writes which drive of a catalogue carries a motion and how much of its limits the motion uses, or that none does; `None` without a
/// catalogue.
pub fn selected_drive(catalogue: &DriveCatalogue, outcome: &TaskOutcome) -> Option<String> {
    let selected = outcome.drive?;
    let name = &catalogue.get(selected.place)?.name;
    let used = number(100.0 * selected.utilization);
    Some(if selected.carries() {
        format!("3 × {name}, utilization {used} %")
    } else {
        format!(
            "no drive of the catalogue can perform the motion; {name} comes closest, with a utilization of {used} %"
        )
    })
}

/// Writes by how much a threshold may be tightened at no cost, given as a share of itself.
pub fn slack(share: f64) -> String {
    if share > 10.0 {
        "more than 1000 %".to_owned()
    } else {
        format!("{} %", number(100.0 * share))
    }
}

/// Writes what is proved about a motion at every moment, for actuators of a kind.
pub fn motion_proof(certificate: &MotionCertificate, actuator: JointKind) -> String {
    let at = |moment: &MotionMoment| format!("in piece {} at {:.4} s", moment.piece + 1, moment.time);
    let claim = |moment: &MotionMoment| match moment.claim {
        MotionClaim::Reach => "a leg does not reach, or a joint passes its limit".to_owned(),
        MotionClaim::Singularity => "a parallel singularity is met".to_owned(),
        MotionClaim::Speed => "the speed of an actuator grows without bound".to_owned(),
        MotionClaim::Force => "the force of an actuator grows without bound".to_owned(),
        MotionClaim::Limit(quantity) => format!("the limit of the {} is missed", quantity.entry().label),
    };
    match &certificate.verdict {
        MotionVerdict::Refuted(moment) => format!("refuted between the samples: {}, {}", claim(moment), at(moment)),
        MotionVerdict::Open(moment) => format!("open: it is not decided whether {}, {}", claim(moment), at(moment)),
        MotionVerdict::Proved(bounds) => format!(
            "proved at every moment: at most {} {}/s and {} {}, at least {} mm to the limits",
            number(bounds.speed),
            actuator.unit(),
            number(bounds.force),
            actuator.effort_unit(),
            number(1e3 * bounds.reach),
        ),
    }
}

/// Returns where a motion ends early, and why.
pub fn motion_failure(failure: &TaskFailure) -> String {
    let place = format!("piece {} at {:.4} s", failure.piece + 1, failure.time);
    match failure.leg {
        Some(leg) => format!(
            "the motion ends in {place}: leg {} is {:.6} m beyond its {}",
            leg + 1,
            -failure.path_reach,
            match failure.fault {
                TaskFault::Limit => "joint limit",
                _ => "reach",
            }
        ),
        None => format!("the motion ends in {place}: it reaches a parallel singularity"),
    }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn four_digits_count() {
        for (value, text) in [
            (0.0, "0"),
            (12.345_67, "12.35"),
            (-0.001_234_1, "-0.001234"),
            (99_999.0, "99999"),
            (1e6, "1.000e6"),
            (2.5e-7, "2.500e-7"),
            (f64::NAN, "–"),
        ] {
            assert_eq!(number(value), text);
        }
    }
}
