//! The texts of a recording: the study, and its result.

use crate::writer::RecordingError;
use kinefront_model::evaluation::{Constraint, Quantity};
use kinefront_scene::text::number;
use kinefront_study::{Column, RunSummary, Study};

/// Returns the study with its description.
pub(super) fn study(study: &Study) -> Result<String, RecordingError> {
    let text = toml::to_string(study).map_err(RecordingError::encode)?;
    Ok(format!(
        "# {}\n\n{}\n\n```toml\n{text}```\n",
        study.name, study.description
    ))
}

/// Returns the verified front as a table, thinned to a readable number of rows.
pub(super) fn summary(study: &Study, summary: &RunSummary) -> String {
    const MOST_ROWS: usize = 40;
    let last = summary.history.last();
    let mut text = format!(
        "# Result\n\n{} evaluations, {} feasible. {} designs are on the front after verification on the fine grid \
         ({} dropped); hypervolume {:.1} {}.\n\n",
        last.map_or(0, |last| last.evaluations),
        last.map_or(0, |last| last.feasible),
        summary.front.len(),
        summary.dropped,
        summary.verified_hypervolume,
        study.hypervolume_unit(),
    );
    if let Some(proofs) = &summary.proofs {
        text.push_str(&format!("{proofs}\n\n"));
    }
    // The objectives, and what is of interest in any case.
    let mut quantities: Vec<Quantity> = study.objectives().iter().map(|objective| objective.quantity).collect();
    for quantity in [
        Quantity::Mass,
        Quantity::WorkspaceRadius,
        Quantity::of_constraint(Constraint::Clearance),
    ] {
        if !quantities.contains(&quantity) {
            quantities.push(quantity);
        }
    }
    let title = |&quantity: &Quantity| format!(" {} |", Column::Quantity(quantity).title());
    text.push_str(&format!(
        "| # | architecture |{} φ_c [°] | R | r | L_b | r_j | r_p | active |\n\
         |---|---|{}---|---|---|---|---|---|---|\n",
        quantities.iter().map(title).collect::<String>(),
        "---|".repeat(quantities.len()),
    ));
    for (_, member) in summary.spread(MOST_ROWS) {
        let e = &member.evaluation;
        let [base, platform, link, leg_bar, platform_bar] = e.design.values();
        let active: Vec<&str> = e.active().map(|constraint| constraint.id()).collect();
        let value = |&quantity: &Quantity| {
            let value = e.quantities.get(quantity).map(number).unwrap_or_default();
            format!(" {value} |")
        };
        text.push_str(&format!(
            "| {} | {} |{} {} | {base:.3} | {platform:.3} | {link:.3} | {leg_bar:.4} | {platform_bar:.4} | {} |\n",
            member.id,
            e.design.architecture(),
            quantities.iter().map(value).collect::<String>(),
            e.home_phi_deg.map(|phi| phi.to_string()).unwrap_or_default(),
            active.join(" "),
        ));
    }
    text
}
