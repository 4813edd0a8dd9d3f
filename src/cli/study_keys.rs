//! The command `kinefront study keys`: the reference of every key of a study file, made from the declarations of the settings.

use std::fmt::Write as _;

use kinefront_model::evaluation::{Better, Quantity, Scope};
use kinefront_study::{Check, Setting, Study, settings, settings_of_surroundings};
use miette::{IntoDiagnostic, Result, miette};
use toml::{Table, Value};

/// What each section is for.
const SECTIONS: [(&str, &str); 35] = [
    (
        "",
        "Objectives, limits and architectures. These keys come before the first section.",
    ),
    (
        "material",
        "Material of every bar. A named material supplies the values that the section does not state.",
    ),
    (
        "sections.legs",
        "Cross-section of the bars of the legs: solid (`round`), or hollow with one of `wall_ratio`, `wall_m` and `catalogue`.",
    ),
    ("sections.platform", "Cross-section of the bars of the platform."),
    (
        "sections.rails",
        "Cross-section of the rails of the base; it is used only if `rails.radius_m` is set.",
    ),
    (
        "rails",
        "Rails of the base, on which the sliders of PRR, PRP and PPR legs move.",
    ),
    ("actuators", "Stiffness of the actuators, including their transmission."),
    (
        "joints",
        "Masses of joints and motors. A mass counts only where it moves.",
    ),
    (
        "requirements",
        "Accuracy under load, dexterity, and clearance, at every pose of the workspace.",
    ),
    (
        "strength",
        "Loads for which stress, buckling, and the forces of joints and actuators are computed.",
    ),
    ("payload", "Body that the platform carries during a motion."),
    (
        "drives",
        "Masses and inertias that the drives move, and the catalogue of drives.",
    ),
    ("loads", "Loads during a motion."),
    (
        "task",
        "Motion that the platform repeats; without `shape`, the study has no motion.",
    ),
    (
        "anywhere",
        "Motion and load that every pose must allow in any direction.",
    ),
    (
        "tolerances",
        "Errors of manufacture, assembly and control, each in both directions.",
    ),
    (
        "workspace",
        "The regular workspace: positions, and orientations at each of them.",
    ),
    ("workspace.region", "Region of positions."),
    ("model", "Choices of the model."),
    (
        "bodies",
        "Dimensions of the bodies that are not design variables, for drawings and for the clearance.",
    ),
    (
        "bodies.layers",
        "Heights of the members along z, in diameters of the thicker of the two bars.",
    ),
    (
        "geometry",
        "Arrangement of base and platform, and travel of the prismatic joints.",
    ),
    ("bounds", "Bounds of the design variables, each as `[lower, upper]`."),
    (
        "variables",
        "Design variables that do not vary freely between their bounds.",
    ),
    ("grid.reference", "Grid of poses of the search."),
    ("grid.fine", "Grid of poses on which reported designs are verified."),
    ("optimizer", "The search."),
    (
        "optimizer.stagnation",
        "Ends the search when the hypervolume hardly grows; without this section, stagnation does not end the search.",
    ),
    ("optimizer.front_de", "Differential evolution along the front."),
    (
        "optimizer.moga2",
        "MOGA-II, a reimplementation of the paper's optimizer.",
    ),
    ("optimizer.nsga2", "NSGA-II with constraint domination."),
    ("optimizer.cma_es", "Evolution strategy for one objective."),
    ("hypervolume", "Reference point of the hypervolume."),
    (
        "obstacles",
        "Upright bodies that no member may touch: one section `[[obstacles]]` for each. They need `requirements.clearance_min_m`.",
    ),
    (
        "room",
        "Outline that no member may leave. It needs `requirements.clearance_min_m`.",
    ),
];

/// Returns the reference in Markdown: all of it, or the sections and keys whose dotted names contain `part`.
pub fn reference(part: Option<&str>) -> Result<String> {
    let defaults = Table::try_from(Study::default()).into_diagnostic()?;
    let all: Vec<&Setting> = settings().chain(settings_of_surroundings()).collect();
    let mut text = String::new();
    for (section, about) in SECTIONS {
        let is_shown = |setting: &Setting| part.is_none_or(|part| setting.path().contains(part));
        let shown: Vec<&Setting> = all
            .iter()
            .copied()
            .filter(|setting| setting.section == section && is_shown(setting))
            .collect();
        if shown.is_empty() {
            continue;
        }
        let heading = match section {
            "" => "At the top of the file".to_owned(),
            "obstacles" => "`[[obstacles]]`".to_owned(),
            section => format!("`[{section}]`"),
        };
        let _ = writeln!(
            text,
            "## {heading}\n\n{about}\n\n| key | default | valid | meaning |\n|---|---|---|---|"
        );
        for setting in shown {
            let default = setting
                .value(&defaults)
                .map_or("–".to_owned(), |value| format!("`{}`", written(value)));
            let valid = valid(setting, &defaults);
            let meaning = cell(setting.description);
            let _ = writeln!(text, "| `{}` | {default} | {valid} | {meaning} |", setting.key);
        }
        text.push('\n');
    }
    let quantities = quantities(part);
    if !quantities.is_empty() {
        let _ = writeln!(
            text,
            "## Quantities\n\nThe keys of `objectives`, `quantities` and `constraints`.\n\n| key | unit | taken over | better | meaning |\n|---|---|---|---|---|\n{quantities}"
        );
    }
    match text.is_empty() {
        true => Err(miette!("no key of a study contains `{}`", part.unwrap_or_default())),
        false => Ok(text.trim_end().to_owned() + "\n"),
    }
}

/// Returns a text as it stands in a cell of a table.
fn cell(text: &str) -> String {
    text.trim().replace('|', "\\|")
}

/// Returns a value as a study file states it, with exponents where they are shorter.
fn written(value: &Value) -> String {
    match value {
        Value::Float(number) if *number != 0.0 && !(1e-3..1e6).contains(&number.abs()) => format!("{number:e}"),
        Value::Array(values) => {
            let values: Vec<String> = values.iter().map(written).collect();
            format!("[{}]", values.join(", "))
        }
        other => other.to_string(),
    }
}

/// Returns the valid values of a setting in words.
fn valid(setting: &Setting, defaults: &Table) -> String {
    let quoted = |names: &[&str]| {
        let names: Vec<String> = names.iter().map(|name| format!("`\"{name}\"`")).collect();
        names.join(", ")
    };
    let form = form(setting, defaults);
    match setting.check {
        Check::Choice(names) => quoted(names),
        Check::Selection(_) => "one or several architectures".to_owned(),
        Check::Name => "text of at most 100 characters".to_owned(),
        check => match (form, check.range()) {
            // What an error adds about omitting the key stands in the meaning.
            (form, Some(range)) => {
                let range = range.split(", or ").next().unwrap_or_default().to_owned();
                form.map_or(range.clone(), |form| format!("{form}, each {range}"))
            }
            (form, None) => form.unwrap_or("number").to_owned(),
        },
    }
}

/// Returns the form of the values of a setting; `None` for a number.
fn form(setting: &Setting, defaults: &Table) -> Option<&'static str> {
    Some(match (setting.section, setting.key) {
        ("", "objectives" | "constraints" | "working_mode") => "as described",
        ("", "quantities") => "array of quantities",
        ("bounds", _) => "`[lower, upper]`",
        ("variables", _) => "number, array of numbers, or another variable times a factor, as in `\"0.5 rj\"`",
        ("hypervolume", "reference") => "array of numbers, one for each objective",
        ("task", "waypoints") => "array of `[x_m, y_m, phi_deg]`",
        (_, "catalogue") => "text, or array of rows",
        (_, "corners_m") => "array of `[x, y]`",
        (_, "heights_m") => "`[lowest, highest]`",
        (_, "centre_m") => "`[x, y]`",
        ("strength", "force_range_n" | "moment_range_nm") => "array of three numbers",
        _ => match setting.value(defaults) {
            Some(Value::Boolean(_)) => "`true`, `false`",
            Some(Value::String(_)) => "text",
            Some(Value::Array(values)) if values.len() == 2 => "array of two numbers",
            Some(Value::Array(_)) => "array of three numbers",
            _ => return None,
        },
    })
}

/// Returns a row for each quantity whose key contains `part`.
fn quantities(part: Option<&str>) -> String {
    let mut text = String::new();
    for entry in Quantity::all().map(Quantity::entry) {
        if part.is_some_and(|part| !entry.key.contains(part)) {
            continue;
        }
        let unit = if entry.unit.is_empty() { "–" } else { entry.unit };
        let scope = match entry.scope {
            Scope::Design => "design",
            Scope::Poses => "poses",
            Scope::Region => "region",
        };
        let better = match entry.better {
            Better::Lower => "lower",
            Better::Higher => "higher",
        };
        let meaning = cell(entry.meaning);
        let _ = writeln!(text, "| `{}` | {unit} | {scope} | {better} | {meaning} |", entry.key);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A section that is not listed would be missing in the reference.
    #[test]
    fn every_section_is_listed() {
        for setting in settings().chain(settings_of_surroundings()) {
            let is_listed = SECTIONS.iter().any(|(section, _)| *section == setting.section);
            assert!(is_listed, "{}", setting.path());
        }
    }
}
