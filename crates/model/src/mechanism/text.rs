//! Text form of a design: `3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056`, optionally with `mode=++-`
//! (docs/interfaces.md).

use std::str::FromStr;

use super::{Architecture, DESIGN_VARIABLES, Design, DesignError, WorkingMode};

/// Reason why a text is not a valid design, architecture or working mode.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TextError {
    /// The text is empty.
    #[error("the design is empty; expected one like `3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056`")]
    Empty,
    /// The first word is not the name of an architecture.
    #[error("unknown architecture `{0}`; expected one of {names}", names = architecture_names())]
    UnknownArchitecture(String),
    /// A word has no `=`.
    #[error("`{0}` is not of the form key=value")]
    NoEquals(String),
    /// A key is unknown.
    #[error("unknown key `{0}`; expected R, r, Lb, rj, rp or mode")]
    UnknownKey(String),
    /// A key is given twice.
    #[error("`{0}` is given twice")]
    Repeated(&'static str),
    /// A key is missing.
    #[error("`{0}` is missing; a design needs R, r, Lb, rj and rp, in metres")]
    Missing(&'static str),
    /// A value is not a number.
    #[error("`{text}` is not a number (key {key}, in metres)")]
    NotANumber {
        /// Key of the value.
        key: &'static str,
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
    let names: Vec<&str> = Architecture::ALL.iter().map(|a| a.name()).collect();
    names.join(", ")
}

impl FromStr for Architecture {
    type Err = TextError;

    fn from_str(text: &str) -> Result<Self, TextError> {
        Architecture::ALL
            .iter()
            .copied()
            .find(|architecture| architecture.name() == text)
            .ok_or_else(|| TextError::UnknownArchitecture(text.to_owned()))
    }
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
        let mut values = [None; DESIGN_VARIABLES.len()];
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
            let index = DESIGN_VARIABLES
                .iter()
                .position(|variable| variable.key() == key)
                .ok_or_else(|| TextError::UnknownKey(key.to_owned()))?;
            let key = DESIGN_VARIABLES[index].key();
            let number: f64 = value.parse().map_err(|_| TextError::NotANumber {
                key,
                text: value.to_owned(),
            })?;
            if values[index].replace(number).is_some() {
                return Err(TextError::Repeated(key));
            }
        }
        let mut numbers = [0.0; DESIGN_VARIABLES.len()];
        for ((number, value), variable) in numbers.iter_mut().zip(values).zip(DESIGN_VARIABLES) {
            *number = value.ok_or(TextError::Missing(variable.key()))?;
        }
        Ok(Design::new(
            architecture,
            working_mode.unwrap_or(default_mode),
            numbers,
        )?)
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
        write!(f, "{}", self.architecture)?;
        for (variable, value) in DESIGN_VARIABLES.into_iter().zip(self.values()) {
            write!(f, " {}={value}", variable.key())?;
        }
        if self.working_mode != WorkingMode::ALL_PLUS {
            write!(f, " mode={}", self.working_mode)?;
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
        assert_eq!(design.working_mode.signs(), [1, -1, 1]);
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
    }
}
