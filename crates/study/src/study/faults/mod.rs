//! Invalid values of a study.

mod machine;
mod question;
mod ranges;
mod search;

use super::Study;
use crate::settings::settings;

/// A key with an invalid value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Dotted key.
    pub key: String,
    /// What is wrong and what would be right.
    pub message: String,
}

impl Fault {
    pub(crate) fn new(key: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            key: key.into(),
            message: message.into(),
        }
    }
}

/// Rules about several settings at once, each of which adds what it finds.
const RULES: [fn(&Study, &mut Vec<Fault>); 18] = [
    machine::check_characteristic_length,
    machine::check_slider,
    ranges::check_bounds,
    machine::check_geometry,
    ranges::check_proportions,
    search::check_grids,
    search::check_moga2,
    search::check_references,
    machine::check_sections,
    machine::check_rails,
    ranges::check_variables,
    ranges::check_region,
    question::check_objectives,
    question::check_constraints,
    question::check_inputs,
    machine::check_task,
    machine::check_drives,
    machine::check_surroundings,
];

impl Study {
    /// Returns the invalid values; there are none in a valid study.
    pub fn faults(&self) -> Vec<Fault> {
        let table = match toml::Table::try_from(self) {
            Ok(table) => table,
            // The only values that TOML cannot represent are whole numbers beyond its range.
            Err(error) => return vec![Fault::new("optimizer", error.to_string())],
        };
        let mut faults: Vec<Fault> = settings()
            .filter_map(|setting| Some(Fault::new(setting.path(), setting.check.fault(setting.value(&table)?)?)))
            .collect();
        for rule in RULES {
            rule(self, &mut faults);
        }
        faults
    }
}
