//! The values that the design variables of a study may have.

use super::Study;
use crate::settings::{Bounds, Tie, VariableChoice};
use kinefront_model::mechanism::{DESIGN_VARIABLES, Design, DesignVariable};

/// Relative difference up to which a value counts as one of a list, as for the bars of a catalogue.
const SAME_VALUE: f64 = 1e-6;

/// A variable of a design whose value is not one of those that the study lists.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnlistedValue {
    /// The variable.
    pub variable: DesignVariable,
    /// Its value \[m\].
    pub value: f64,
    /// The nearest of the listed values \[m\].
    pub nearest: f64,
}

impl Study {
    /// Returns the tie of a variable.
    pub fn tie(&self, variable: DesignVariable) -> Option<Tie> {
        match self.variables.of(variable) {
            Some(VariableChoice::Tied(text)) => Tie::parse(text),
            _ => None,
        }
    }

    /// Returns the values that a variable may have, in ascending order; `None` for one that ranges freely. Bars of a catalogue
    /// have its outer radii within the bounds.
    pub fn listed(&self, variable: DesignVariable) -> Option<Vec<f64>> {
        let sections = self.sections.cross_sections();
        let section = match variable {
            DesignVariable::LegBarRadius => Some(&sections.legs),
            DesignVariable::PlatformBarRadius => Some(&sections.platform),
            _ => None,
        };
        let [low, high] = self.bounds.range(variable);
        let of_catalogue = section.and_then(|section| section.catalogue()).map(|catalogue| {
            let radii = catalogue.entries().iter().map(|entry| entry.radius);
            radii
                .filter(|radius| (low..=high).contains(radius))
                .collect::<Vec<f64>>()
        });
        match (self.variables.of(variable), of_catalogue) {
            (Some(VariableChoice::Fixed(value)), _) => Some(vec![*value]),
            (Some(VariableChoice::Listed(values)), _) => {
                let mut values = values.clone();
                values.sort_by(f64::total_cmp);
                values.dedup();
                Some(values)
            }
            (_, of_catalogue) => of_catalogue,
        }
    }

    /// Returns the variables of a design whose values are not among those that the study lists, or that its catalogues have. A search
    /// proposes no such design.
    pub fn unlisted(&self, design: &Design) -> Vec<UnlistedValue> {
        let unlisted = |variable: DesignVariable| {
            let (listed, value) = (self.listed(variable)?, design.value(variable));
            let away = |other: &f64| (other - value).abs();
            let nearest = listed.into_iter().min_by(|a, b| away(a).total_cmp(&away(b)))?;
            (away(&nearest) > SAME_VALUE * value.abs()).then_some(UnlistedValue {
                variable,
                value,
                nearest,
            })
        };
        DESIGN_VARIABLES.into_iter().filter_map(unlisted).collect()
    }

    /// Returns the range of a variable in the search: its bounds, or the ends of its list.
    pub fn range(&self, variable: DesignVariable) -> [f64; 2] {
        if let Some(tie) = self.tie(variable) {
            return self.range(tie.source).map(|end| tie.factor * end);
        }
        let ends = |values: Vec<f64>| Some([*values.first()?, *values.last()?]);
        self.listed(variable)
            .and_then(ends)
            .unwrap_or_else(|| self.bounds.range(variable))
    }

    /// Returns the largest radii of the leg bars and of the platform bars \[m\].
    pub fn thickest_bars(&self) -> [f64; 2] {
        [DesignVariable::LegBarRadius, DesignVariable::PlatformBarRadius].map(|variable| self.range(variable)[1])
    }
}

/// What is wrong with the variables: keys and messages.
pub(super) fn faults(study: &Study) -> Vec<(String, String)> {
    let mut faults = Vec::new();
    for (variable, key) in Bounds::keys() {
        let key = format!("variables.{key}");
        let fits = |value: f64| value.is_finite() && (value > 0.0 || variable.may_be_zero() && value == 0.0);
        let message = match study.variables.of(variable) {
            Some(VariableChoice::Fixed(value)) if !fits(*value) => {
                Some(format!("is {value}; it must be a length above 0 m"))
            }
            Some(VariableChoice::Listed(values)) if values.is_empty() => {
                Some("is an empty list; it must have at least one value".to_owned())
            }
            Some(VariableChoice::Listed(values)) => {
                let wrong = values.iter().find(|value| !fits(**value));
                wrong.map(|value| format!("contains {value}; every value must be a length above 0 m"))
            }
            Some(VariableChoice::Tied(text)) => fault_of_tie(study, variable, text),
            _ => None,
        };
        faults.extend(message.map(|message| (key, message)));
        if faults.is_empty() && study.listed(variable).is_some_and(|values| values.is_empty()) {
            let [low, high] = study.bounds.range(variable);
            let message = format!("are [{low}, {high}]; no bar of the catalogue has an outer radius within them");
            faults.push((format!("bounds.{}_m", variable.key()), message));
        }
    }
    faults
}

fn fault_of_tie(study: &Study, variable: DesignVariable, text: &str) -> Option<String> {
    match Tie::parse(text) {
        None => Some(format!(
            "is \"{text}\"; it must be a number, a list of numbers, or another variable with a factor, as in \"0.5 rj\" \
             (R, r, Lb, rj, rp)"
        )),
        Some(tie) if tie.source == variable => Some("is tied to itself; name another variable".to_owned()),
        Some(tie) if study.tie(tie.source).is_some() => Some(format!(
            "is tied to {}, which is tied itself; name the variable that is free",
            tie.source.key()
        )),
        Some(_) => has_catalogue(study, variable)
            .then(|| "is tied, but its bars are selected from a catalogue; omit one of the two".to_owned()),
    }
}

fn has_catalogue(study: &Study, variable: DesignVariable) -> bool {
    match variable {
        DesignVariable::LegBarRadius => study.sections.legs.catalogue.is_some(),
        DesignVariable::PlatformBarRadius => study.sections.platform.catalogue.is_some(),
        _ => false,
    }
}
