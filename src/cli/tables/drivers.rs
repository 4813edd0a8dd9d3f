//! Tables of what drives the mass of a design, and of wishes.

use comfy_table::Table;
use kinefront_model::evaluation::Quantity;
use kinefront_scene::text::{self, number};
use kinefront_study::{Drivers, DriversAlong, Hindrance, PriceJson, WhyNotJson, WishOutcome};

use super::table;

/// Prices below this are told as free.
const FREE: f64 = 1e-4;

/// Formats what drives the objective of a design.
pub fn drivers(heading: &str, drivers: &Drivers) -> String {
    let (name, unit) = drivers.objective_name();
    let mut facts = table([heading, ""], &[]);
    facts.add_row(["best design near it".to_owned(), drivers.design.clone()]);
    facts.add_row(["home orientation".to_owned(), format!("{:.3}°", drivers.home_phi_deg)]);
    facts.add_row([
        name.to_owned(),
        format!(
            "{} {unit}; the given design has {} {unit} ({:+.3} %)",
            number(drivers.polished_value),
            number(drivers.value),
            100.0 * drivers.excess
        ),
    ]);
    let mut text = facts.to_string();
    if !drivers.prices.is_empty() {
        text = format!("{text}\n{}", prices(drivers));
        let free = drivers.free(FREE);
        if !free.is_empty() {
            text = format!("{text}\npractically free: {}", free.join(", "));
        }
    }
    if !drivers.inactive.is_empty() {
        let mut slack = table(["not active", "may rise by"], &[1]);
        for inactive in &drivers.inactive {
            slack.add_row([inactive.label.clone(), text::slack(inactive.slack)]);
        }
        text = format!("{text}\n{slack}");
    }
    if !drivers.alternatives.is_empty() {
        text = format!("{text}\n{}", alternatives(drivers));
    }
    if let Some(why) = &drivers.why_not {
        text = format!("{text}\n{}", why_not(why, name, unit));
    }
    for warning in &drivers.warnings {
        text = format!("{text}\nnote: {warning}");
    }
    text
}

/// Tabulates the prices of a design that are not nearly 0.
fn prices(drivers: &Drivers) -> Table {
    let (name, unit) = drivers.objective_name();
    let costs = format!("+1 % costs {name}");
    let mut prices = table(
        ["driver", "value", &costs, &format!("in {unit}"), "bars alone", "remark"],
        &[1, 2, 3, 4],
    );
    for price in drivers.dear(FREE) {
        prices.add_row([
            price.label.clone(),
            price
                .value
                .map_or(String::new(), |value| format!("{} {}", number(value), price.unit)),
            if price.kink {
                format!("{:+.3} … {:+.3} %", price.below, price.above)
            } else {
                format!("{:+.3} %", price.price)
            },
            format!("{:+.4}", 0.01 * price.price * drivers.polished_value),
            price.bars_only.map_or(String::new(), |price| format!("{price:+.3} %")),
            remark(price),
        ]);
    }
    prices
}

/// Tabulates the best designs with the next entries of lists and catalogues.
fn alternatives(drivers: &Drivers) -> Table {
    let (name, unit) = drivers.objective_name();
    let mut others = table(["instead", name, "change", "with the design"], &[1, 2]);
    for other in &drivers.alternatives {
        let text = |value: Option<String>| value.unwrap_or_else(|| "–".to_owned());
        others.add_row([
            other.label.clone(),
            text(other.value.map(|value| format!("{} {unit}", number(value)))),
            other.change.map_or("no design is feasible".to_owned(), |change| {
                format!("{:+.2} %", 100.0 * change)
            }),
            text(other.design.clone()),
        ]);
    }
    others
}

/// Formats what drives the objective along the front of an architecture.
pub fn drivers_along(along: &DriversAlong) -> String {
    let mut text = along.architecture.to_string();
    for sentence in along.sentences() {
        text = format!("{text}\n  {sentence}");
    }
    text
}

/// Formats what stands in the way of a study of which no design is feasible.
pub fn hindrances(found: &[Hindrance]) -> String {
    if found.is_empty() {
        return "no single requirement prevents a feasible design: none was found with any one of them relaxed to one twentieth, or to twenty times, \
                its limit. Two or more requirements, or the bounds of the design variables, have to be relaxed."
            .to_owned();
    }
    let mut facts = table(
        ["requirement relaxed alone", "stated", "achievable", "with the design"],
        &[1, 2],
    );
    for hindrance in found {
        let text = |value: f64| format!("{} {}", number(value), hindrance.unit).trim_end().to_owned();
        facts.add_row([
            hindrance.label.clone(),
            text(hindrance.stated),
            match hindrance.is_enough {
                true => "as stated: search longer".to_owned(),
                false => text(hindrance.possible),
            },
            hindrance.design.clone(),
        ]);
    }
    facts.to_string()
}

fn remark(price: &PriceJson) -> String {
    match price.bars_cannot_repair.as_slice() {
        [] => String::new(),
        [way] => format!("{way}: bars cannot offset it"),
        _ => "bars cannot offset it".to_owned(),
    }
}

fn why_not(why: &WhyNotJson, name: &str, unit: &str) -> String {
    if why.log_deficit >= 0.0 {
        return format!(
            "{} {unit} is achievable: the best design near the front does not exceed it.",
            number(why.wished)
        );
    }
    let header = format!("for {} {unit}", number(why.wished));
    let mut relaxations = table(
        [
            &header,
            "times (by its price)",
            "times (solved)",
            &format!("resulting {name}"),
        ],
        &[1, 2, 3],
    );
    for relaxation in &why.relaxations {
        relaxations.add_row([
            relaxation.parameter.clone(),
            relaxation
                .linear
                .filter(|factor| (1e-3..1e3).contains(factor))
                .map_or("–".to_owned(), |factor| format!("{factor:.4}")),
            relaxation
                .needed
                .map_or("cannot".to_owned(), |factor| format!("{factor:.4}")),
            format!("{} {unit}", number(relaxation.objective)),
        ]);
    }
    relaxations.to_string()
}

/// Formats what became of a wish.
pub fn wish(heading: &str, outcome: &WishOutcome, shown: &[Quantity]) -> String {
    let found = &outcome.found.evaluation;
    let mut facts = table([heading, "before", "after", "change"], &[1, 2, 3]);
    for quantity in shown {
        let entry = quantity.entry();
        let [before, after] = [&outcome.before, found].map(|evaluation| evaluation.quantities.get(*quantity));
        let text =
            |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{} {}", number(value), entry.unit));
        let change = match (before, after) {
            (Some(before), Some(after)) if before != 0.0 => format!("{:+.2} %", 100.0 * (after / before - 1.0)),
            _ => String::new(),
        };
        facts.add_row([entry.label.to_owned(), text(before), text(after), change]);
    }
    let proved = outcome
        .found
        .certified
        .as_ref()
        .map_or("nothing is proved about its workspace".to_owned(), |certified| {
            format!("its workspace is {}", certified.state())
        });
    let mut text = format!("{facts}\n{}: {}; {proved}", outcome.word(), found.design);
    for changed in &outcome.changed_entries {
        text = format!("{text}\n{changed}");
    }
    for (condition, value) in &outcome.unmet {
        let entry = condition.0.quantity.entry();
        text = format!(
            "{text}\n{condition} is not achievable: the nearest value is {} {}",
            number(*value),
            entry.unit
        );
    }
    for quantity in &outcome.left_out {
        text = format!(
            "{text}\nnote: the limit of {} was checked only at the end",
            quantity.entry().key
        );
    }
    text
}
