//! Design variables that are not free within their bounds: fixed ones, lists, and ones that are tied to others
//! (docs/interfaces.md).

use serde::{Deserialize, Serialize};

use super::declare::{Check, Initial, section};
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
