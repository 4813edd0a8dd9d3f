//! Tables of a design at one pose, and of the poses that its actuated joints allow.

use comfy_table::Table;
use kinefront_model::evaluation::{PoseEvaluation, PoseScalar, Unreachable};
use kinefront_model::kinematics::AssemblyMode;
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Pose;
use kinefront_model::strength::{LARGEST_FACTOR, StrengthReport};
use kinefront_scene::text::{self, number};

use super::{pose_text, table};

/// Formats the report on a design at one pose, with its strength there.
pub fn pose(
    design: &Design,
    pose: &Pose,
    outcome: &Result<PoseEvaluation, Unreachable>,
    strength: Option<&StrengthReport>,
) -> String {
    let mut facts = table(["design", &design.to_string()], &[]);
    facts.add_row(["pose".to_owned(), pose_text(pose)]);
    let report = match outcome {
        Err(unreachable) => {
            facts.add_row(["not reachable".to_owned(), unreachable.to_string()]);
            return facts.to_string();
        }
        Ok(report) => report,
    };
    let unit = design.architecture().actuator().unit();
    let mut joints = table(["leg", "actuator", "B [m]", "C [m]"], &[]);
    let point = |p: [f64; 2]| format!("({:.6}, {:.6})", p[0], p[1]);
    for leg in 0..3 {
        joints.add_row([
            (leg + 1).to_string(),
            format!("{:.6} {unit}", report.actuators[leg]),
            point(report.b[leg]),
            point(report.c[leg]),
        ]);
    }
    // The clearance has a row of its own, with the members between which it is, and strength and motion have tables.
    let scalars = PoseScalar::ALL.iter().filter(|scalar| {
        **scalar != PoseScalar::Clearance && !scalar.is_of_loads() && !PoseScalar::OF_MOTION.contains(scalar)
    });
    for scalar in scalars {
        if let Some(value) = report.values.get(*scalar) {
            let entry = scalar.entry();
            let words = format!("{} {}", number(value), entry.quantity.unit);
            facts.add_row([entry.label.to_owned(), words.trim_end().to_owned()]);
        }
    }
    facts.add_row(["clearance".to_owned(), text::clearance(&report.nearest)]);
    let mut stiffness = table(["K", "x", "y", "z", "φx", "φy", "φz"], &[1, 2, 3, 4, 5, 6]);
    for (i, name) in ["fx", "fy", "fz", "mx", "my", "mz"].into_iter().enumerate() {
        let mut row = vec![name.to_owned()];
        row.extend((0..6).map(|j| number(report.stiffness[(i, j)])));
        stiffness.add_row(row);
    }
    let strength = strength
        .map(|report| strength_tables(design, report))
        .unwrap_or_default();
    format!("{facts}\n{joints}\n{stiffness}{strength}")
}

/// Formats the strength at a pose: the worst values, the members and the joints.
fn strength_tables(design: &Design, report: &StrengthReport) -> String {
    let mut worst = table(["strength", "worst"], &[]);
    worst.add_row([
        "largest stress".to_owned(),
        format!("{} MPa", number(1e-6 * report.stress)),
    ]);
    for (name, factor) in [
        ("safety factor against yielding", report.safety_factor),
        ("factor against buckling, at least", report.buckling_factor),
    ] {
        let words = match factor {
            Some(factor) if factor >= LARGEST_FACTOR => "no load".to_owned(),
            Some(factor) => number(factor),
            None => "–".to_owned(),
        };
        worst.add_row([name.to_owned(), words]);
    }
    let unit = design.architecture().actuator().effort_unit();
    let efforts = report.actuators.map(number).join(", ");
    worst.add_row(["actuators of legs 1, 2, 3".to_owned(), format!("{efforts} {unit}")]);
    format!("\n{worst}\n{}\n{}", member_table(report), joint_table(report))
}

/// Formats what each member carries.
fn member_table(report: &StrengthReport) -> Table {
    let headings = [
        "member",
        "stress MPa",
        "at",
        "axial N",
        "M in plane N·m",
        "M out N·m",
        "torsion N·m",
        "buckling factor",
    ];
    let mut members = table(headings, &[1, 2, 3, 4, 5, 6, 7]);
    let moments = report
        .members
        .iter()
        .flat_map(|member| [member.moment_in_plane, member.moment_out_of_plane, member.torsion]);
    let largest = moments.fold(0.0, f64::max);
    // What rounding leaves of nothing is nothing.
    let moment = |value: f64| number(if value < 1e-12 * largest { 0.0 } else { value });
    for member in &report.members {
        let [least, most] = member.axial.map(number);
        members.add_row([
            member.member.to_string(),
            number(1e-6 * member.stress),
            format!("{:.0} %", 100.0 * member.share),
            if least == most {
                least
            } else {
                format!("{least} … {most}")
            },
            moment(member.moment_in_plane),
            moment(member.moment_out_of_plane),
            moment(member.torsion),
            match member.buckling_factor {
                Some(factor) if factor < LARGEST_FACTOR => number(factor),
                Some(_) => "no compression".to_owned(),
                None => "–".to_owned(),
            },
        ]);
    }
    members
}

/// Formats what each joint carries.
fn joint_table(report: &StrengthReport) -> Table {
    let mut joints = table(
        ["joint", "kind", "radial N", "axial N", "force N", "moment N·m"],
        &[2, 3, 4, 5],
    );
    for joint in &report.joints {
        let driven = if joint.is_driven { ", actuated" } else { "" };
        joints.add_row([
            joint.name(),
            format!("{}{driven}", joint.kind.letter()),
            number(joint.radial),
            number(joint.axial),
            number(joint.force),
            number(joint.moment),
        ]);
    }
    joints
}

/// Formats all poses at which the actuated joints of a design have the given values.
pub fn assembly_modes(design: &Design, values: [f64; 3], modes: &[AssemblyMode]) -> String {
    let unit = design.architecture().actuator().unit();
    let mut facts = table(["design", &design.to_string()], &[]);
    let values: Vec<String> = values.iter().map(|value| format!("{value} {unit}")).collect();
    facts.add_row(["actuated joints".to_owned(), values.join(", ")]);
    facts.add_row(["assembly modes".to_owned(), modes.len().to_string()]);
    if modes.is_empty() {
        return facts.to_string();
    }
    let headings = ["pose", "working mode", "within limits", "of this design"];
    let mut rows = table(headings, &[]);
    let yes = |holds: bool| if holds { "yes" } else { "no" }.to_owned();
    for mode in modes {
        rows.add_row([
            pose_text(&mode.pose),
            mode.working_mode
                .map_or_else(|| "none".to_owned(), |mode| mode.to_string()),
            yes(mode.is_within_limits),
            yes(mode.is_of_design),
        ]);
    }
    format!("{facts}\n{rows}")
}
