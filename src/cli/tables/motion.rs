//! Tables of the motion of a design.

use comfy_table::Table;
use kinefront_model::certify::MotionCertificate;
use kinefront_model::dynamics::{Accuracy, DriveCatalogue, Motion, Response};
use kinefront_model::evaluation::{PosedDynamics, ShortestCycle, TaskFigures, TaskOutcome};
use kinefront_model::mechanism::{Design, JointKind};
use kinefront_scene::text::{self, number};

use super::table;

/// Formats the motion at a pose: frequencies and errors, and what the actuators do during a motion.
pub fn dynamics(design: &Design, dynamics: &PosedDynamics<'_>, motion: Option<&Motion>) -> String {
    let Some(report) = dynamics.report() else {
        return String::new();
    };
    let mut facts = table(["motion", ""], &[]);
    let list = |values: &[f64]| values.iter().map(|value| number(*value)).collect::<Vec<_>>().join(", ");
    if let Some([in_plane, out_of_plane]) = &report.frequencies {
        facts.add_row([
            "natural frequencies in the plane".to_owned(),
            format!("{} Hz", list(in_plane)),
        ]);
        facts.add_row([
            "natural frequencies out of the plane".to_owned(),
            format!("{} Hz", list(out_of_plane)),
        ]);
    }
    if let Some(of_frame) = dynamics.frame_frequencies() {
        facts.add_row([
            "lowest of the frame of finite elements, in and out of the plane".to_owned(),
            format!("{} Hz", list(&of_frame)),
        ]);
    }
    facts.add_row([
        "bending of the leg bars themselves".to_owned(),
        format!("{} Hz", number(report.bar_frequency)),
    ]);
    facts.add_rows(accuracy(&report.accuracy));
    let actuator = design.architecture().actuator();
    for (name, value, unit) in [
        (
            "largest actuator speed in any direction",
            report.anywhere_speed,
            format!("{}/s", actuator.unit()),
        ),
        (
            "largest actuator effort in any direction",
            report.anywhere_force,
            actuator.effort_unit().to_owned(),
        ),
    ] {
        if value > 0.0 {
            facts.add_row([name.to_owned(), format!("{} {unit}", number(value))]);
        }
    }
    let Some(motion) = motion else {
        return format!("\n{facts}");
    };
    format!("\n{facts}\n{}", drives(actuator, &dynamics.response(motion)))
}

/// Returns the rows of the errors of the pose; none without tolerances.
fn accuracy(found: &Accuracy) -> Vec<[String; 2]> {
    if found.worst_position <= 0.0 {
        return Vec::new();
    }
    let share = |part: f64| number(100.0 * part / found.worst_position);
    let parts = found
        .budget_position
        .parts()
        .into_iter()
        .filter(|(_, part)| *part > 0.0);
    let parts: Vec<String> = parts.map(|(name, part)| format!("{name} {} %", share(part))).collect();
    vec![
        [
            "largest position error".to_owned(),
            format!("{} mm", number(1e3 * found.worst_position)),
        ],
        [
            "largest orientation error".to_owned(),
            format!("{}°", number(found.worst_orientation.to_degrees())),
        ],
        ["sources of the position error".to_owned(), parts.join(", ")],
    ]
}

/// Formats what each actuator does during a motion.
fn drives(actuator: JointKind, response: &Response) -> Table {
    let (unit, effort) = (actuator.unit(), actuator.effort_unit());
    let columns = [
        format!("speed [{unit}/s]"),
        format!("acceleration [{unit}/s²]"),
        format!("effort [{effort}]"),
    ];
    let mut drives = table(["leg", &columns[0], &columns[1], &columns[2]], &[1, 2, 3]);
    for leg in 0..3 {
        let values = [response.speeds[leg], response.accelerations[leg], response.forces[leg]].map(number);
        drives.add_row([vec![(leg + 1).to_string()], values.to_vec()].concat());
    }
    drives
}

/// Formats what a motion asks of the drives.
pub fn task(
    design: &Design,
    outcome: &TaskOutcome,
    catalogue: &DriveCatalogue,
    why_not: Option<String>,
    (shortest, proof): (Option<ShortestCycle>, Option<MotionCertificate>),
) -> String {
    let mut facts = table(["design", &design.to_string()], &[]);
    if let Some(motion) = &outcome.motion {
        facts.add_row(["cycle time".to_owned(), format!("{} s", number(motion.cycle_time()))]);
    }
    let figures = match (why_not, &outcome.result) {
        (None, Some(Ok(figures))) => figures,
        (reason, _) => {
            facts.add_row(["not possible".to_owned(), reason.unwrap_or_default()]);
            return facts.to_string();
        }
    };
    if let Some(shortest) = shortest {
        let set_by = shortest.limit.quantity.entry().label;
        facts.add_row([
            "shortest cycle".to_owned(),
            format!("{} s, set by the limit of the {set_by}", number(shortest.time)),
        ]);
    }
    if let Some(drive) = text::selected_drive(catalogue, outcome) {
        facts.add_row(["drives".to_owned(), drive]);
    }
    if let Some(proof) = proof {
        let words = text::motion_proof(&proof, design.architecture().actuator());
        facts.add_row(["proof".to_owned(), words]);
    }
    add_figures(&mut facts, figures);
    format!("{facts}\n{}", drives_of_legs(design, figures))
}

/// Adds where the path lies, and the energy and the power of all drives.
fn add_figures(facts: &mut Table, figures: &TaskFigures) {
    let inside = if figures.inside_workspace { "yes" } else { "no" };
    facts.add_row(["inside the workspace".to_owned(), inside.to_owned()]);
    facts.add_row([
        "smallest distance to the limits".to_owned(),
        format!("{} mm", number(1e3 * figures.path_reach)),
    ]);
    // Without a tool it is 0, up to rounding.
    let is_nothing = figures.energy_net.abs() < 1e-9 * figures.energy_each;
    let net = if is_nothing { 0.0 } else { figures.energy_net };
    for (name, value, unit) in [
        ("energy per cycle, no recuperation", figures.energy_each, "J"),
        (
            "energy per cycle, drives on a common DC link",
            figures.energy_shared,
            "J",
        ),
        ("energy per cycle, all recovered", net, "J"),
        ("peak power of all drives together", figures.peak_power_total, "W"),
        ("corner power of one motor type for all legs", figures.corner_power, "W"),
    ] {
        facts.add_row([name.to_owned(), format!("{} {unit}", number(value))]);
    }
}

/// Tabulates what the motion asks of the drive of each leg.
fn drives_of_legs(design: &Design, figures: &TaskFigures) -> Table {
    let actuator = design.architecture().actuator();
    let (unit, effort) = (actuator.unit(), actuator.effort_unit());
    let columns = [
        format!("stroke [{unit}]"),
        format!("speed [{unit}/s]"),
        format!("acceleration [{unit}/s²]"),
        format!("peak effort [{effort}]"),
        format!("RMS effort [{effort}]"),
        "peak power [W]".to_owned(),
    ];
    let mut header = vec!["leg"];
    header.extend(columns.iter().map(String::as_str));
    let header: [&str; 7] = std::array::from_fn(|column| header[column]);
    let mut drives = table(header, &[1, 2, 3, 4, 5, 6]);
    for leg in 0..3 {
        let values = [
            figures.stroke[leg],
            figures.peak_speed[leg],
            figures.peak_acceleration[leg],
            figures.peak_force[leg],
            figures.rms_force[leg],
            figures.peak_power[leg],
        ];
        drives.add_row([vec![(leg + 1).to_string()], values.map(number).to_vec()].concat());
    }
    drives
}
