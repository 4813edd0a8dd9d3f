//! Result tables for the terminal.

mod drivers;
mod motion;

pub use drivers::{drivers, drivers_along, hindrances, wish};
pub use motion::{dynamics, task};

use comfy_table::presets::UTF8_FULL_CONDENSED;
use comfy_table::{CellAlignment, Table};
use kinefront_export::CertificateJson;
use kinefront_model::certify::Verdict;
use kinefront_model::evaluation::{Bound, Evaluation, Model, PoseEvaluation, PoseScalar, Quantity, Unreachable};
use kinefront_model::kinematics::AssemblyMode;
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Pose;
use kinefront_model::strength::{LARGEST_FACTOR, StrengthReport};
use kinefront_scene::text::{self, number};
use kinefront_study::{FrontMember, RunSummary, Study};

fn table(header: impl IntoIterator<Item = impl Into<comfy_table::Cell>>, right: &[usize]) -> Table {
    let mut table = Table::new();
    table
        .load_style(UTF8_FULL_CONDENSED)
        .set_header(header.into_iter().map(Into::into).collect::<Vec<comfy_table::Cell>>());
    for &column in right {
        if let Some(column) = table.column_mut(column) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

fn pose_text(pose: &Pose) -> String {
    format!(
        "({:.4}, {:.4}) m, {:.2}°",
        pose.position.x,
        pose.position.y,
        pose.phi.to_degrees()
    )
}

/// Formats the evaluation of a design.
pub fn evaluation(evaluation: &Evaluation, model: &Model) -> String {
    let design = &evaluation.design;
    let mut facts = table(["design", &design.to_string()], &[]);
    facts.add_row([
        "mass in motion".to_owned(),
        format!(
            "{:.3} kg (legs {:.3}, platform {:.3})",
            evaluation.mass(),
            // Motors that move have the mass of the selected drive.
            evaluation.mass() - model.platform_mass(design),
            model.platform_mass(design)
        ),
    ]);
    add_workspace(&mut facts, evaluation, model);
    for bar in text::selected_parts(model, evaluation) {
        facts.add_row(bar);
    }
    add_quantities(&mut facts, evaluation, model);
    add_limits(&mut facts, evaluation);
    if let Some(nearest) = &evaluation.nearest {
        let where_least = match (evaluation.home, model.settings().workspace.region.is_prescribed()) {
            (_, true) => "the smallest over the region",
            (Some(_), false) => "the smallest over the workspace",
            (None, false) => "at the centre in the best orientation",
        };
        facts.add_row([
            "clearance".to_owned(),
            format!("{}, {where_least}", text::clearance(nearest)),
        ]);
    }
    format!("{facts}\n{}", constraints(evaluation))
}

fn add_workspace(facts: &mut Table, evaluation: &Evaluation, model: &Model) {
    match (&evaluation.home, evaluation.home_phi_deg) {
        (Some(home), Some(phi_deg)) => {
            let region = &model.settings().workspace.region;
            facts.add_row(if region.is_prescribed() {
                ["region".to_owned(), format!("{}, all of it", text::region(region))]
            } else {
                let radius = evaluation.workspace_radius();
                ["regular workspace".to_owned(), format!("R_w = {radius:.5} m")]
            });
            let centre = home.position;
            facts.add_row([
                "home pose".to_owned(),
                format!("({}, {}) m, φ_c = {phi_deg}°", centre.x, centre.y),
            ]);
        }
        _ => {
            facts.add_row(["regular workspace", "none: the design is infeasible"]);
        }
    }
}

/// Adds the quantities that no other row or table tells.
fn add_quantities(facts: &mut Table, evaluation: &Evaluation, model: &Model) {
    let told_elsewhere = [
        Quantity::Mass,
        Quantity::LegsMass,
        Quantity::PlatformMass,
        Quantity::WorkspaceRadius,
    ];
    let is_fact = |quantity: &Quantity| quantity.constraint().is_none() && !told_elsewhere.contains(quantity);
    let tells = |quantity: &Quantity| match quantity {
        Quantity::Worst(scalar) => model.tells(&evaluation.design, *scalar),
        _ => true,
    };
    for quantity in Quantity::all().filter(is_fact).filter(tells) {
        let entry = quantity.entry();
        if let Some(value) = evaluation.quantities.get(quantity) {
            facts.add_row([
                entry.label.to_owned(),
                format!("{} {}", text::number(value), entry.unit),
            ]);
        }
    }
}

fn add_limits(facts: &mut Table, evaluation: &Evaluation) {
    for result in &evaluation.limits {
        let entry = result.limit.quantity.entry();
        let sign = match result.limit.bound {
            Bound::AtLeast(_) => "≥",
            Bound::AtMost(_) => "≤",
        };
        let limit = format!("{sign} {} {}", text::number(result.limit.threshold()), entry.unit);
        let limit = limit.trim_end();
        facts.add_row([
            format!("limit of {}", entry.label),
            match result.value {
                Some(value) if result.margin >= 0.0 => format!("{} {limit}: kept", text::number(value)),
                Some(value) => format!("{} {limit}: missed ({})", text::number(value), percent(result.margin)),
                // The design has no value where it is examined.
                None => format!("{limit}: not evaluated"),
            },
        ]);
    }
}

fn constraints(evaluation: &Evaluation) -> Table {
    let mut constraints = table(
        [
            "",
            "constraint",
            "worst value",
            "threshold",
            "unit",
            "margin",
            "active",
            "where",
        ],
        &[2, 3, 5],
    );
    for report in evaluation.constraints.iter().filter(|report| report.required) {
        constraints.add_row([
            report.constraint.id().to_owned(),
            report.constraint.name().to_owned(),
            report.value.map(number).unwrap_or_else(|| "–".to_owned()),
            number(report.threshold),
            report.constraint.unit().to_owned(),
            percent(report.margin),
            if report.active { "yes" } else { "" }.to_owned(),
            report.pose.as_ref().map(pose_text).unwrap_or_default(),
        ]);
    }
    constraints
}

/// Formats a margin in per cent, with as many digits as it takes to tell a violation from 0.
fn percent(margin: f64) -> String {
    let percent = 100.0 * margin;
    let least = [0.05, 0.005, 5e-4, 5e-5, 5e-6];
    let digits = least.iter().position(|least| percent >= 0.0 || -percent >= *least);
    format!("{percent:+.*} %", digits.map_or(1, |place| place + 1))
}

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

/// Formats the verified front of a run, thinned to the number of rows that fit a screen.
pub fn front(study: &Study, summary: &RunSummary) -> String {
    const MOST_ROWS: usize = 20;
    // Mass and workspace radius have columns in any case.
    let has_column = |quantity: &Quantity| [Quantity::Mass, Quantity::WorkspaceRadius].contains(quantity);
    let objectives = study.objectives().into_iter().map(|objective| objective.quantity);
    let others: Vec<Quantity> = objectives.filter(|quantity| !has_column(quantity)).collect();
    let titles = others.iter().map(|quantity| quantity.entry());
    let titles = titles.map(|entry| format!("{} {}", entry.label, entry.unit).trim().to_owned());
    let headings = ["#", "architecture", "mass kg", "R_w m"].map(str::to_owned).into_iter();
    let headings = headings.chain(titles);
    let rest = ["φ_c °", "R", "r", "Lb", "rj", "rp", "clear. mm", "active", ""].map(str::to_owned);
    let numbers: Vec<usize> = std::iter::once(0).chain(2..11 + others.len()).collect();
    let mut table = table(headings.chain(rest), &numbers);
    let count = summary.front.len();
    let rows = count.min(MOST_ROWS);
    let marks = summary.marks(study);
    for (place, FrontMember { id, evaluation, .. }) in summary.spread(MOST_ROWS) {
        let mut row = vec![
            id.to_string(),
            evaluation.design.architecture().to_string(),
            format!("{:.2}", evaluation.mass()),
            format!("{:.4}", evaluation.workspace_radius()),
        ];
        row.extend(others.iter().map(|&quantity| {
            let value = evaluation.quantities.get(quantity);
            value.map(text::number).unwrap_or_default()
        }));
        row.push(evaluation.home_phi_deg.map(|phi| phi.to_string()).unwrap_or_default());
        row.extend(evaluation.design.values().iter().enumerate().map(|(index, value)| {
            let digits = if index < 3 { 3 } else { 4 };
            format!("{value:.digits$}")
        }));
        let clearance = evaluation.clearance();
        row.push(
            clearance
                .map(|clearance| format!("{:.1}", 1e3 * clearance))
                .unwrap_or_default(),
        );
        let active: Vec<&str> = evaluation.active().map(|constraint| constraint.id()).collect();
        row.push(active.join(" "));
        row.push(marks[place].clone());
        table.add_row(row);
    }
    let left_out = if rows < count {
        format!("\n({rows} of {count} shown; all are in front.csv)")
    } else {
        String::new()
    };
    format!("{table}{left_out}")
}

/// The bounds of a workspace radius and the verdict on it, as sentences.
pub fn certificate(found: &CertificateJson) -> String {
    let verdict = match found.found {
        Verdict::Proved => "proved",
        Verdict::Refuted => "refuted",
        Verdict::OpenBudget => "open: the maximum number of boxes was reached",
        Verdict::OpenPrecision => "open: a constraint equals its threshold to the precision of a double",
    };
    let homes = match found.upper_all_homes_m {
        Some(Some(bound)) => format!("\nR_w is at most {bound:.6} m at any home orientation"),
        Some(None) => "\nno bound over all home orientations was found".to_owned(),
        None => String::new(),
    };
    let of_region = found.claim == "region";
    let infeasible = found.upper_m.map(|upper| {
        let place = match of_region {
            true => format!("a pose of the region at {upper:.6} m from its centre"),
            false => format!("a pose at {upper:.6} m"),
        };
        let missed = found.violation.as_ref().map(|violation| {
            let (pose, margin) = (&violation.pose, percent(violation.margin));
            format!(
                ": it misses {} (margin {margin}) at ({:.4}, {:.4}) m, {:.2}°",
                violation.id, pose.x_m, pose.y_m, pose.phi_deg
            )
        });
        format!("{place} is proved infeasible{}", missed.unwrap_or_default())
    });
    let effort = format!("home orientation {}°, {} boxes{homes}", found.home.phi_deg, found.boxes);
    if of_region {
        let infeasible = infeasible.map_or(String::new(), |infeasible| format!("\n{infeasible}"));
        return format!("claim that every pose of the region is feasible: {verdict}{infeasible}\n{effort}");
    }
    let infeasible = infeasible.unwrap_or_else(|| "no infeasible pose was found".to_owned());
    format!(
        "claimed R_w {:.6} m: {verdict}\nevery pose within {:.6} m is proved feasible; {infeasible}\n{effort}",
        found.claimed_radius_m, found.lower_m
    )
}
