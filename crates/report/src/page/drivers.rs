//! What drives the first objective along the fronts.

use maud::{Markup, html};

use super::figures;
use crate::{Report, Topic};
use kinefront_scene::text::short;
use kinefront_study::{DriversAlong, ParameterKind};

/// Prices below this \[% for 1 %\] are left out of the tables.
const FREE: f64 = 0.01;

/// Largest number of designs of a table.
const COLUMNS: usize = 6;

/// All kinds of parameters, in the order of the tables.
const KINDS: [ParameterKind; 6] = [
    ParameterKind::Limit,
    ParameterKind::Region,
    ParameterKind::Travel,
    ParameterKind::Bound,
    ParameterKind::Section,
    ParameterKind::Material,
];

/// Tells what each requirement, bound and property of the material costs along the front of each architecture.
pub(super) fn drivers(report: &Report) -> Markup {
    let question = &report.question;
    let objective = question.name(0);
    html! {
        p {
            "The price of a parameter is the change of the " (objective) " in per cent if the parameter increases by 1 %, with the design optimized again and "
            @if question.objectives.len() > 1 { "the other objectives held at their values. " } @else { "the region held. " }
            "Each design was first replaced by the local optimum near it, with every pose of the region as a constraint. A bound or a limit that is not "
            "active has no price."
        }
        @for along in &report.drivers { @if !along.designs.is_empty() {
            h3 { (along.architecture) }
            ul { @for sentence in along.sentences() { li { (sentence) } } }
            (table(along))
        } }
        (figures(report, Topic::Drivers))
    }
}

/// Tabulates the prices at some designs of a front.
fn table(along: &DriversAlong) -> Markup {
    let count = along.designs.len();
    let columns = count.min(COLUMNS);
    let places: Vec<usize> = (0..columns)
        .map(|column| column * (count - 1) / (columns - 1).max(1))
        .collect();
    let entry = along.along.entry();
    let curves = KINDS.map(|kind| along.curves(&[kind]));
    html! {
        div.scroll { table {
            caption { "Prices [% for 1 %] at designs of the front of the " (along.architecture) "." }
            thead { tr {
                th { "parameter" }
                @for &place in &places { th.number { (entry.short) " " (short(along.designs[place].1)) " " (entry.unit) } }
            } }
            tbody { @for curve in curves.iter().flatten().filter(|curve| curve.largest() >= FREE) { tr {
                td { (curve.label) }
                @for &place in &places { td.number { (price(curve.points[place][1])) } }
            } } }
        } }
    }
}

fn price(price: f64) -> String {
    match price.abs() < 0.5 * FREE {
        true => "–".to_owned(),
        false => format!("{price:+.2}").replace('-', "−"),
    }
}
