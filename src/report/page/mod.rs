//! The page: one HTML file that holds everything and loads nothing.

mod clearance;
mod differences;
mod made;
mod results;
mod sensitivity;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::{Figure, Picture, Report};
use crate::text::number;

const STYLE: &str = include_str!("style.css");

/// The page as text.
pub(super) fn html(report: &Report) -> String {
    let title = if report.of_paper && report.rivals.is_some() {
        "Planar parallel manipulators compared: the 2010 paper, reproduced".to_owned()
    } else {
        format!("Kinefront report: {}", report.study.name)
    };
    let mut sections: Vec<(&str, &str, Markup)> = vec![
        ("comparison", "What the comparison says", results::comparison(report)),
        ("fronts", "Pareto fronts", results::fronts(report)),
    ];
    if !report.references.is_empty() {
        sections.push(("designs", "Reference designs", differences::references(report)));
    }
    if report.of_paper {
        sections.push((
            "differences",
            "Where and why this differs from the paper",
            differences::explained(report),
        ));
    }
    sections.push(("variables", "Design variables along R_w", results::variables(report)));
    sections.push(("constraints", "What stops the workspace", results::constraints(report)));
    sections.push(("clearance", "Bodies that collide", clearance::clearance(report)));
    sections.push(("pictures", "Designs", results::pictures(report)));
    if !report.variations.is_empty() {
        sections.push((
            "sensitivity",
            "If it were read otherwise",
            sensitivity::sensitivity(report),
        ));
    }
    sections.push(("made", "How this was made", made::made(report)));
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
                    @if report.of_paper { (made::guide(report)) }
                    @for (id, name, section) in &sections {
                        section id=(id) { h2 { (name) } (section) }
                    }
                }
            }
        }
    };
    page.into_string()
}

/// The figures whose names begin so, side by side.
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

/// The figure's SVG, which says what it is to those who cannot see it.
fn drawing(figure: &Figure) -> PreEscaped<String> {
    let label = html! { (figure.caption) }.into_string().replace('"', "&quot;");
    PreEscaped(
        figure
            .svg
            .replacen("<svg ", &format!("<svg role=\"img\" aria-label=\"{label}\" "), 1),
    )
}

fn image(picture: &Picture) -> Markup {
    let data = STANDARD.encode(&picture.png);
    html! { img src={ "data:image/png;base64," (data) } alt=(picture.caption); }
}

/// A number of a table.
fn cell(value: f64) -> Markup {
    html! { td.number { (number(value)) } }
}

/// A number of a table that may be missing.
fn optional(value: Option<f64>) -> Markup {
    match value {
        Some(value) => cell(value),
        None => html! { td.number { "–" } },
    }
}

/// A share as text.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent == 0.0 {
        "0 %".to_owned()
    } else if percent.abs() < 10.0 {
        format!("{percent:.1} %")
    } else {
        format!("{percent:.0} %")
    }
}

/// A change as text, with its sign.
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
