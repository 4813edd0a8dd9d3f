//! The page of a report: one self-contained HTML file that loads nothing.

mod clearance;
mod comparison;
mod constraints;
mod drivers;
mod fronts;
mod made;
mod motion;
mod paper;
mod pictures;
mod question;
mod references;
mod sensitivity;
mod side_by_side;
mod variables;

use std::borrow::Cow;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::{DesignPicture, Figure, Report, SideBySide, Topic};
use kinefront_scene::text::number;

const STYLE: &str = include_str!("style.css");

/// Returns the page of a report as text.
pub(super) fn html(report: &Report) -> String {
    let title = format!("Kinefront report: {}", report.study.name);
    page(&title, &report.study.description, &sections(report))
}

/// Returns the page of runs of different studies as text.
pub(super) fn side_by_side(found: &SideBySide) -> String {
    let names: Vec<&str> = found.runs.iter().map(|run| run.name.as_str()).collect();
    let title = format!("Kinefront comparison: {}", names.join(", "));
    page(&title, "", &side_by_side::sections(found))
}

fn page(title: &str, lead: &str, sections: &[Section]) -> String {
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
                    @if !lead.is_empty() { p.lead { (lead) } }
                    nav { @for section in sections { a href={ "#" (section.id) } { (section.title) } } }
                }
                main {
                    @for part in sections {
                        section id=(part.id) { h2 { (part.title) } (part.contents) }
                    }
                }
            }
        }
    };
    page.into_string()
}

/// A section of the page.
struct Section {
    id: &'static str,
    title: Cow<'static, str>,
    contents: Markup,
}

fn section(id: &'static str, title: impl Into<Cow<'static, str>>, contents: Markup) -> Section {
    let title = title.into();
    Section { id, title, contents }
}

/// Returns the sections that there is something to say in.
fn sections(report: &Report) -> Vec<Section> {
    let question = &report.question;
    let mut sections = vec![section("question", "The question", question::asked(report))];
    if question.is_of_two() && report.fronts.alone.len() > 1 {
        let contents = comparison::comparison(report);
        sections.push(section("comparison", "Comparison of the architectures", contents));
    }
    sections.push(section("fronts", "Designs found", fronts::fronts(report)));
    if !report.references.is_empty() {
        sections.push(section("designs", "Reference designs", references::references(report)));
    }
    sections.extend(paper::section(report));
    if !report.trends.is_empty() {
        let contents = variables::variables(report);
        sections.push(section("variables", "Design variables along the fronts", contents));
    }
    sections.push(section(
        "constraints",
        "Active constraints",
        constraints::constraints(report),
    ));
    if report.drivers.iter().any(|along| !along.designs.is_empty()) {
        let title = format!("What drives the {}", question.name(0));
        sections.push(section("drivers", title, drivers::drivers(report)));
    }
    if !report.motions.is_empty() {
        sections.push(section("motion", "Motion and drives", motion::motion(report)));
    }
    sections.push(section(
        "clearance",
        "Clearance between members",
        clearance::clearance(report),
    ));
    sections.push(section("pictures", "Pictures of designs", pictures::pictures(report)));
    if !report.variations.is_empty() || !report.nearby.is_empty() {
        let contents = sensitivity::sensitivity(report);
        sections.push(section("sensitivity", "Sensitivity to assumptions", contents));
    }
    sections.push(section("made", "How this report was made", made::made(report)));
    sections
}

/// Lays out the figures on a topic side by side.
fn figures(report: &Report, topic: Topic) -> Markup {
    let found: Vec<&Figure> = report.figures.iter().filter(|figure| figure.topic == topic).collect();
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
