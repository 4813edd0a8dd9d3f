//! Result tables for the terminal.

mod drivers;
mod evaluation;
mod motion;
mod pose;

pub use drivers::{drivers, drivers_along, hindrances, wish};
pub use evaluation::evaluation;
pub use motion::{dynamics, task};
pub use pose::{assembly_modes, pose};

use comfy_table::presets::UTF8_FULL_CONDENSED;
use comfy_table::{CellAlignment, Table};
use kinefront_export::CertificateJson;
use kinefront_model::certify::Verdict;
use kinefront_model::evaluation::Quantity;
use kinefront_model::spatial::Pose;
use kinefront_scene::text;
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

/// Formats a margin in per cent, with as many digits as it takes to tell a violation from 0.
fn percent(margin: f64) -> String {
    let percent = 100.0 * margin;
    let least = [0.05, 0.005, 5e-4, 5e-5, 5e-6];
    let digits = least.iter().position(|least| percent >= 0.0 || -percent >= *least);
    format!("{percent:+.*} %", digits.map_or(1, |place| place + 1))
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
