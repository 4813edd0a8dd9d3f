//! Design variables that are not free within their bounds: fixed ones, lists, and ones that are tied to others
//! (docs/interfaces.md).

use serde::{Deserialize, Serialize};

use super::Bounds;
use super::declare::{Check, Initial, section};
use crate::Study;
use kinefront_model::mechanism::{DESIGN_VARIABLES, DesignVariable};

/// Values that a variable may have.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum VariableChoice {
    /// One value \[m\].
    Fixed(f64),
    /// One of these values \[m\].
    Listed(Vec<f64>),
    /// The value of another variable, times a factor: `rj`, or `0.5 rj`.
    Tied(String),
}

section! {
    /// Design variables that do not range freely between their bounds.
    #[allow(non_snake_case, reason = "keys are the paper's symbols")]
    pub struct Variables in "variables" {
        optional {
            /// Base radius `R`: one value, a list of values, or another variable, as in `"2 r"`.
            R_m: VariableChoice, Check::Any, Initial::Number(2.0);
            /// Platform radius `r`.
            r_m: VariableChoice, Check::Any, Initial::Number(0.5);
            /// Link length `L_b`.
            Lb_m: VariableChoice, Check::Any, Initial::Number(1.5);
            /// Radius `r_j` of the leg bars.
            rj_m: VariableChoice, Check::Any, Initial::Number(0.02);
            /// Radius `r_p` of the platform bars.
            rp_m: VariableChoice, Check::Any, Initial::Number(0.02);
        }
    }
}

/// A variable that follows from another one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tie {
    /// Factor.
    pub factor: f64,
    /// The other variable.
    pub source: DesignVariable,
}

impl Tie {
    /// Reads `rj`, `0.5 rj` or `0.5 * rj`.
    pub fn parse(text: &str) -> Option<Self> {
        let words: Vec<&str> = text
            .split(|letter: char| letter == '*' || letter.is_whitespace())
            .filter(|word| !word.is_empty())
            .collect();
        let (factor, name) = match words.as_slice() {
            [name] => (1.0, *name),
            [factor, name] => (factor.parse().ok()?, *name),
            _ => return None,
        };
        let source = DESIGN_VARIABLES.into_iter().find(|variable| variable.key() == name)?;
        (factor > 0.0 && f64::is_finite(factor)).then_some(Self { factor, source })
    }
}

impl Variables {
    /// Returns the choice of a variable, if the study states one.
    pub fn of(&self, variable: DesignVariable) -> Option<&VariableChoice> {
        match variable {
            DesignVariable::BaseRadius => self.R_m.as_ref(),
            DesignVariable::PlatformRadius => self.r_m.as_ref(),
            DesignVariable::LinkLength => self.Lb_m.as_ref(),
            DesignVariable::LegBarRadius => self.rj_m.as_ref(),
            DesignVariable::PlatformBarRadius => self.rp_m.as_ref(),
            // The bounds free or fix these.
            _ => None,
        }
    }
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
        match study.variables.of(variable) {
            Some(VariableChoice::Fixed(value)) if !fits(*value) => {
                faults.push((key, format!("is {value}; it must be a length above 0 m")));
            }
            Some(VariableChoice::Listed(values)) if values.is_empty() => {
                faults.push((key, "is an empty list; it must have at least one value".to_owned()));
            }
            Some(VariableChoice::Listed(values)) => {
                if let Some(value) = values.iter().find(|value| !fits(**value)) {
                    faults.push((key, format!("contains {value}; every value must be a length above 0 m")));
                }
            }
            Some(VariableChoice::Tied(text)) => match Tie::parse(text) {
                None => {
                    let message = format!(
                        "is \"{text}\"; it must be a number, a list of numbers, or another variable with a factor, as in \"0.5 rj\" \
                         (R, r, Lb, rj, rp)"
                    );
                    faults.push((key, message));
                }
                Some(tie) if tie.source == variable => {
                    faults.push((key, "is tied to itself; name another variable".to_owned()));
                }
                Some(tie) if study.tie(tie.source).is_some() => {
                    let message = format!(
                        "is tied to {}, which is tied itself; name the variable that is free",
                        tie.source.key()
                    );
                    faults.push((key, message));
                }
                Some(_) if has_catalogue(study, variable) => {
                    faults.push((
                        key,
                        "is tied, but its bars are selected from a catalogue; omit one of both".to_owned(),
                    ));
                }
                Some(_) => {}
            },
            _ => {}
        }
        if faults.is_empty() && study.listed(variable).is_some_and(|values| values.is_empty()) {
            let [low, high] = study.bounds.range(variable);
            let message = format!("are [{low}, {high}]; no bar of the catalogue has an outer radius within them");
            faults.push((format!("bounds.{}_m", variable.key()), message));
        }
    }
    faults
}

fn has_catalogue(study: &Study, variable: DesignVariable) -> bool {
    match variable {
        DesignVariable::LegBarRadius => study.sections.legs.catalogue.is_some(),
        DesignVariable::PlatformBarRadius => study.sections.platform.catalogue.is_some(),
        _ => false,
    }
}
