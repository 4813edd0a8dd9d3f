//! Settings that others need or exclude.

use toml::{Table, Value};

use kinefront_study::{Initial, settings};

/// Adds the settings that others need, and removes those that they exclude.
pub(super) fn settle(table: &mut Table) {
    follow_characteristic_length(table);
    follow_sections(table);
    follow_region(table);
}

/// Returns the value that an optional setting starts from; `None` for one that is edited as text.
pub(super) fn initial_value(initial: Initial) -> Option<Value> {
    match initial {
        Initial::Number(number) => Some(Value::Float(number)),
        Initial::Count(count) => Some(Value::Integer(count)),
        Initial::Name(name) => Some(Value::String(name.to_owned())),
        Initial::AsText => None,
    }
}

/// A fixed characteristic length needs its value, and any other must not have one.
fn follow_characteristic_length(table: &mut Table) {
    let Some(model) = table.get_mut("model").and_then(Value::as_table_mut) else {
        return;
    };
    let key = "characteristic_length_m";
    if model.get("characteristic_length").and_then(Value::as_str) != Some("fixed") {
        model.remove(key);
    } else if !model.contains_key(key)
        && let Some(initial) = settings()
            .find(|setting| setting.key == key)
            .and_then(|setting| setting.initial)
    {
        model.extend(initial_value(initial).map(|value| (key.to_owned(), value)));
    }
}

/// A hollow bar needs its wall, and a solid one must not have one.
fn follow_sections(table: &mut Table) {
    const WALLS: [&str; 3] = ["wall_ratio", "wall_m", "catalogue"];
    let Some(sections) = table.get_mut("sections").and_then(Value::as_table_mut) else {
        return;
    };
    for (_, section) in sections.iter_mut() {
        let Some(section) = section.as_table_mut() else {
            continue;
        };
        let is_hollow = section.get("kind").and_then(Value::as_str) != Some("round");
        let has_wall = WALLS.iter().any(|key| section.contains_key(*key));
        if is_hollow && !has_wall {
            section.insert(WALLS[0].to_owned(), Value::Float(0.2));
        } else if !is_hollow {
            section.retain(|key, _| !WALLS.contains(&key));
        }
    }
}

/// A prescribed region needs its sizes, and must not have those of another one.
fn follow_region(table: &mut Table) {
    let region = table
        .get_mut("workspace")
        .and_then(|workspace| workspace.get_mut("region"));
    let Some(region) = region.and_then(Value::as_table_mut) else {
        return;
    };
    let corner = |x: f64, y: f64| Value::Array(vec![Value::Float(x), Value::Float(y)]);
    let triangle = || Value::Array(vec![corner(-0.2, -0.1), corner(0.2, -0.1), corner(0.0, 0.2)]);
    let sizes: Vec<(&str, Value)> = match region.get("kind").and_then(Value::as_str) {
        Some("disc") => vec![("radius_m", Value::Float(0.3))],
        Some("rectangle") => vec![("width_m", Value::Float(0.4)), ("height_m", Value::Float(0.3))],
        Some("polygon") => vec![("corners_m", triangle())],
        _ => Vec::new(),
    };
    region.retain(|key, _| key == "kind" || sizes.iter().any(|(size, _)| *size == key));
    for (key, value) in sizes {
        region.entry(key).or_insert(value);
    }
}
