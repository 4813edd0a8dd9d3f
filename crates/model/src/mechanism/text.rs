//! Text form of a design: `3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056`, with `La`, `alpha_deg`, `beta_deg`, `gamma_deg` and
//! `mode=++-` where they are not the default (docs/interfaces.md).

use std::str::FromStr;

use super::{Architecture, DESIGN_VARIABLES, Design, DesignError, DesignVariable, FURTHER_VARIABLES, WorkingMode};

/// Reason why a text is not a valid design, architecture or working mode.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TextError {
    /// The text is empty.
    #[error("the design is empty; expected one like `3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056`")]
    Empty,
    /// The first word is not the name of an architecture.
    #[error("unknown architecture `{0}`; expected one of {names}, where `_` precedes the actuated joint", names = architecture_names())]
    UnknownArchitecture(String),
    /// The name is that of a chain without its actuated joint.
    #[error(
        "`{name}` does not state which joint is actuated; expected one of {of_chain}, where `_` precedes the actuated joint"
    )]
    NoDrivenJoint {
        /// The name.
        name: String,
        /// The legitimate names of the chain.
        of_chain: String,
    },
    /// With the actuated joint locked, such a leg could transmit no force.
    #[error(
        "`{name}` cannot be actuated at this joint: with it locked, two prismatic joints remain, so the leg transmits no force \
         and every pose is singular; expected one of {names}",
        names = architecture_names()
    )]
    IdleLeg {
        /// The name.
        name: String,
    },
    /// A word has no `=`.
    #[error("`{0}` is not of the form key=value")]
    NoEquals(String),
    /// A key is unknown.
    #[error("unknown key `{0}`; expected R, r, Lb, rj, rp, La, alpha_deg, beta_deg, gamma_deg or mode")]
    UnknownKey(String),
    /// A key is given twice.
    #[error("`{0}` is given twice")]
    Repeated(&'static str),
    /// A key is missing.
    #[error("`{0}` is missing; a design needs R, r, Lb, rj and rp, in metres")]
    Missing(&'static str),
    /// A value is not a number.
    #[error("`{text}` is not a number (key {key}, in {unit})")]
    NotANumber {
        /// Key of the value.
        key: &'static str,
        /// Unit of the value.
        unit: &'static str,
        /// Text of the value.
        text: String,
    },
    /// A working mode does not consist of three signs.
    #[error("`{0}` is not a working mode; expected three signs as in `+++` or `+-+`")]
    WorkingMode(String),
    /// A number is outside its domain.
    #[error(transparent)]
    Domain(#[from] DesignError),
}

fn architecture_names() -> String {
    names(Architecture::ALL.iter().copied())
}

fn names(architectures: impl Iterator<Item = Architecture>) -> String {
    let names: Vec<&str> = architectures.map(Architecture::name).collect();
    names.join(", ")
}

impl FromStr for Architecture {
    type Err = TextError;

    /// Parses a name such as `3-PRR` or `3-P_RR`, where `_` precedes the actuated joint. The names of the paper may be written
    /// either way, and an actuated joint may also be underlined by U+0332.
    fn from_str(text: &str) -> Result<Self, TextError> {
        let name = with_leading_marks(text);
        let mut all = Architecture::ALL.iter().copied();
        if let Some(found) = all.find(|architecture| architecture.name() == name || architecture.marked_name() == name)
        {
            return Ok(found);
        }
        let chain = name.strip_prefix("3-").unwrap_or_default().replace('_', "");
        let of_chain = || {
            Architecture::ALL
                .iter()
                .copied()
                .filter(|found| found.chain_name() == chain)
        };
        let marks = name.matches('_').count();
        Err(match of_chain().next() {
            Some(_) if marks == 0 => TextError::NoDrivenJoint {
                name,
                of_chain: names(of_chain()),
            },
            Some(_) if marks == 1 && !name.ends_with('_') => TextError::IdleLeg { name },
            _ => TextError::UnknownArchitecture(text.to_owned()),
        })
    }
}

/// Returns the text with `_` before each letter that U+0332 underlines.
fn with_leading_marks(text: &str) -> String {
    let mut marked = String::with_capacity(text.len());
    for letter in text.chars() {
        match (letter, marked.pop()) {
            ('\u{332}', Some(last)) => marked.extend(['_', last]),
            (_, last) => marked.extend(last.into_iter().chain([letter])),
        }
    }
    marked
}

impl FromStr for WorkingMode {
    type Err = TextError;

    fn from_str(text: &str) -> Result<Self, TextError> {
        let error = || TextError::WorkingMode(text.to_owned());
        let signs: Vec<bool> = text
            .chars()
            .map(|c| match c {
                '+' => Ok(true),
                '-' | '−' => Ok(false),
                _ => Err(error()),
            })
            .collect::<Result<_, _>>()?;
        signs.try_into().map(WorkingMode::new).map_err(|_| error())
    }
}

/// Implements the conversions from and to text that study files need.
macro_rules! as_text {
    ($type:ty) => {
        impl TryFrom<String> for $type {
            type Error = TextError;

            fn try_from(text: String) -> Result<Self, TextError> {
                text.parse()
            }
        }

        impl From<$type> for String {
            fn from(value: $type) -> String {
                value.to_string()
            }
        }
    };
}

as_text!(Architecture);
as_text!(WorkingMode);

impl Design {
    /// Parses a design; `default_mode` applies if the text has no working mode.
    ///
    /// # Errors
    /// Returns a [`TextError`] that says what is wrong and what is expected.
    pub fn parse(text: &str, default_mode: WorkingMode) -> Result<Self, TextError> {
        let mut words = text.split_whitespace();
        let architecture: Architecture = words.next().ok_or(TextError::Empty)?.parse()?;
        let mut working_mode = None;
        let mut given: Vec<(DesignVariable, f64)> = Vec::new();
        for word in words {
            let (key, value) = word
                .split_once('=')
                .ok_or_else(|| TextError::NoEquals(word.to_owned()))?;
            if key == "mode" {
                if working_mode.replace(value.parse()?).is_some() {
                    return Err(TextError::Repeated("mode"));
                }
                continue;
            }
            let variable = DESIGN_VARIABLES
                .into_iter()
                .chain(FURTHER_VARIABLES)
                .find(|variable| variable.key() == key)
                .ok_or_else(|| TextError::UnknownKey(key.to_owned()))?;
            let number: f64 = value.parse().map_err(|_| TextError::NotANumber {
                key: variable.key(),
                unit: if variable.is_angle() { "degrees" } else { "metres" },
                text: value.to_owned(),
            })?;
            if given.iter().any(|(other, _)| *other == variable) {
                return Err(TextError::Repeated(variable.key()));
            }
            given.push((variable, number));
        }
        let mut numbers = [0.0; DESIGN_VARIABLES.len()];
        for (number, variable) in numbers.iter_mut().zip(DESIGN_VARIABLES) {
            let found = given.iter().find(|(other, _)| *other == variable);
            *number = found.ok_or(TextError::Missing(variable.key()))?.1;
        }
        let mut design = Design::new(architecture, working_mode.unwrap_or(default_mode), numbers)?;
        for (variable, number) in given {
            if FURTHER_VARIABLES.contains(&variable) {
                design = design.with(variable, number)?;
            }
        }
        Ok(design)
    }
}

impl FromStr for Design {
    type Err = TextError;

    fn from_str(text: &str) -> Result<Self, TextError> {
        Design::parse(text, WorkingMode::ALL_PLUS)
    }
}

impl std::fmt::Display for Design {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.architecture())?;
        for (variable, value) in DESIGN_VARIABLES.into_iter().zip(self.values()) {
            write!(f, " {}={value}", variable.key())?;
        }
        for variable in self.given_variables() {
            write!(f, " {}={}", variable.key(), self.value(variable))?;
        }
        if self.working_mode() != WorkingMode::ALL_PLUS {
            write!(f, " mode={}", self.working_mode())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_design_reads_what_it_writes() {
        let text = "3-RRR R=3.3658 r=0.2537 Lb=1.9157 rj=0 rp=0.0891 mode=+-+";
        let design: Design = text.parse().expect("a design");
        assert_eq!(design.to_string(), text);
        assert_eq!(design.working_mode().signs(), [1, -1, 1]);
        for text in [
            "3-R_RR R=1 r=0.25 Lb=1 rj=0.02 rp=0.03 La=0.75 mode=---",
            "3-_PPR R=1 r=0.25 Lb=1 rj=0.02 rp=0.03 alpha_deg=30 beta_deg=75.5",
            "3-RP_P R=1 r=0.25 Lb=1 rj=0.02 rp=0.03 La=2 beta_deg=60 gamma_deg=-12.5",
        ] {
            assert_eq!(text.parse::<Design>().expect("a design").to_string(), text);
        }
    }

    #[test]
    fn every_architecture_reads_its_names() {
        for &architecture in Architecture::ALL {
            for name in [
                architecture.name().to_owned(),
                architecture.marked_name(),
                architecture.underlined_name(),
            ] {
                assert_eq!(name.parse(), Ok(architecture), "{name}");
            }
        }
        assert_eq!(Architecture::ALL.len(), 18);
        assert_eq!(Architecture::Prr.marked_name(), "3-_PRR");
        assert_eq!(Architecture::PprFirst.underlined_name(), "3-P\u{332}PR");
    }

    #[test]
    fn an_illegitimate_architecture_is_explained() {
        let error = |text: &str| text.parse::<Architecture>().expect_err("a fault").to_string();
        assert!(error("3-PPR").contains("expected one of 3-_PPR, 3-P_PR"));
        for name in ["3-_RPP", "3-P_RP", "3-PP_R"] {
            let found = error(name);
            assert!(found.contains("no force") && found.contains("3-R_PP"), "{found}");
        }
        for name in ["3-PPP", "3-_P_PR", "PRR", "3-PRR_", "3-_PRRR", ""] {
            assert!(error(name).contains("unknown architecture"), "{name}: {}", error(name));
        }
    }

    #[test]
    fn errors_say_what_is_wrong_and_what_is_right() {
        let error = |text: &str| text.parse::<Design>().expect_err("a fault").to_string();
        assert!(error("").contains("empty"));
        assert!(error("4-PRR R=1").contains("3-PRR, 3-RPR, 3-RRR"));
        assert!(error("3-PRR R=1 r=1 Lb=1 rj=1").contains("`rp` is missing"));
        assert!(error("3-PRR R=1 R=1").contains("twice"));
        assert!(error("3-PRR R=one").contains("not a number"));
        assert!(error("3-PRR Q=1").contains("unknown key `Q`"));
        assert!(error("3-PRR R=NaN r=1 Lb=1 rj=1 rp=1").contains("R is NaN"));
        assert!(error("3-PRR R=1 r=0 Lb=1 rj=1 rp=1").contains("above 0 m"));
        assert!(error("3-PRR R=1 r=1 Lb=1 rj=-1 rp=1").contains("at least 0 m"));
        assert!(error("3-PRR R=1e-9 r=1 Lb=1 rj=1 rp=1").contains("times R"));
        assert!(error("3-PRR mode=++").contains("three signs"));
        let further = |text: &str| error(&format!("{text} R=1 r=1 Lb=1 rj=1 rp=1"));
        assert!(error("3-PRR R=1 r=1 Lb=1 rj=1 rp=1 La=1").contains("3-PRR has no La; only RRR, RRP and RPP"));
        assert!(error("3-RPR R=1 r=1 Lb=1 rj=1 rp=1 alpha_deg=1").contains("no alpha_deg"));
        assert!(error("3-_PPR R=1 r=1 Lb=1 rj=1 rp=1 beta_deg=180").contains("below 180°"));
        assert!(error("3-_PRP R=1 r=1 Lb=1 rj=1 rp=1 gamma_deg=NaN").contains("within ±360°"));
        assert!(error("3-RRR R=1 r=1 Lb=1 rj=1 rp=1 La=0").contains("above 0 m"));
        assert!(further("3-PPR").contains("which joint is actuated"));
    }
}
