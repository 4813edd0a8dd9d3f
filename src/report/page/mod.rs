//! The page of a report: one self-contained HTML file that loads nothing.

mod clearance;
mod made;
mod paper;
mod question;
mod references;
mod results;
mod sensitivity;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::question::Question;
use super::{DesignPicture, Figure, Report};
use crate::text::number;

const STYLE: &str = include_str!("style.css");

/// Returns the page as text.
pub(super) fn html(report: &Report) -> String {
    let title = if report.of_paper && report.moga2.is_some() {
        "Comparison of planar parallel manipulators: reproduction of the 2010 paper".to_owned()
    } else {
        format!("Kinefront report: {}", report.study.name)
    };
    let sections = match &report.question {
        Some(question) => of_question(report, question),
        None => of_workspaces(report),
    };
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="generator" content={ "Kinefront " (env!("CARGO_PKG_VERSION")) };
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    h1 { (title) }
                    @if !report.study.description.is_empty() { p.lead { (report.study.description) } }
                    nav { @for (id, name, _) in &sections { a href={ "#" (id) } { (name) } } }
                }
                main {
                    @if report.of_paper { (paper::guide(report)) }
                    @for (id, name, section) in &sections {
                        section id=(id) { h2 { (name) } (section) }
                    }
                }
            }
        }
    };
    page.into_string()
}

/// Returns the sections of a report on another question than the paper's: identifiers, titles and contents.
fn of_question(report: &Report, question: &Question) -> Vec<(&'static str, &'static str, Markup)> {
    let mut sections = vec![
        ("question", "The question", question::asked(report, question)),
        ("fronts", "Designs found", question::found(report, question)),
    ];
    if !report.references.is_empty() {
        sections.push(("designs", "Reference designs", references::references(report)));
    }
    if question.objectives.len() > 1 {
        let along = question::variables(report, question);
        sections.push(("variables", "Design variables along the fronts", along));
    }
    sections.extend([
        ("constraints", "Active constraints", question::constraints(report)),
        ("clearance", "Clearance between members", clearance::clearance(report)),
        ("pictures", "Pictures of designs", results::pictures(report)),
        ("made", "How this report was made", made::made(report)),
    ]);
    sections
}

/// Returns the sections of a report on the lightest designs for the largest workspaces.
fn of_workspaces(report: &Report) -> Vec<(&'static str, &'static str, Markup)> {
    let mut sections = vec![
        (
            "comparison",
            "Comparison of the architectures",
            results::comparison(report),
        ),
        ("fronts", "Pareto fronts", results::fronts(report)),
    ];
    if !report.references.is_empty() {
        sections.push(("designs", "Reference designs", references::references(report)));
    }
    if report.of_paper {
        sections.push((
            "differences",
            "Differences from the paper and their causes",
            paper::differences(report),
        ));
    }
    sections.push((
        "variables",
        "Trends of the design variables with R_w",
        results::variables(report),
    ));
    sections.push((
        "constraints",
        "Constraints that limit the workspace",
        results::constraints(report),
    ));
    sections.push(("clearance", "Clearance between members", clearance::clearance(report)));
    sections.push(("pictures", "Pictures of designs", results::pictures(report)));
    if !report.variations.is_empty() {
        sections.push((
            "sensitivity",
            "Sensitivity to assumptions",
            sensitivity::sensitivity(report),
        ));
    }
    sections.push(("made", "How this report was made", made::made(report)));
    sections
}

/// Lays out the figures whose names begin with `prefix` side by side.
fn figures(report: &Report, prefix: &str) -> Markup {
    let found: Vec<&Figure> = report
        .figures
        .iter()
        .filter(|figure| figure.name.starts_with(prefix))
        .collect();
    html! {
        div.figures {
            @for figure in found {
                figure id={ "figure-" (figure.name) } {
                    (drawing(figure))
                    figcaption { (figure.caption) }
                }
            }
        }
    }
}

/// Returns the SVG of a figure, labelled with its caption for screen readers.
fn drawing(figure: &Figure) -> PreEscaped<String> {
    let label = html! { (figure.caption) }.into_string().replace('"', "&quot;");
    PreEscaped(
        figure
            .svg
            .replacen("<svg ", &format!("<svg role=\"img\" aria-label=\"{label}\" "), 1),
    )
}

fn image(picture: &DesignPicture) -> Markup {
    let data = STANDARD.encode(&picture.png);
    html! { img src={ "data:image/png;base64," (data) } alt=(picture.caption); }
}

/// Returns a table cell with a number.
fn cell(value: f64) -> Markup {
    html! { td.number { (number(value)) } }
}

/// Returns a table cell with a number, or with a dash if there is none.
fn optional(value: Option<f64>) -> Markup {
    match value {
        Some(value) => cell(value),
        None => html! { td.number { "–" } },
    }
}

/// Formats a fraction as a percentage.
fn percent(fraction: f64) -> String {
    let percent = 100.0 * fraction;
    if percent == 0.0 {
        "0 %".to_owned()
    } else if percent.abs() < 10.0 {
        format!("{percent:.1} %")
    } else {
        format!("{percent:.0} %")
    }
}

/// Formats the change that a ratio means as a percentage with its sign.
fn change(ratio: f64) -> String {
    let percent = 100.0 * (ratio - 1.0);
    if percent.abs() < 0.05 {
        "0 %".to_owned()
    } else if percent.abs() < 10.0 {
        format!("{percent:+.1} %").replace('-', "−")
    } else {
        format!("{percent:+.0} %").replace('-', "−")
    }
}
