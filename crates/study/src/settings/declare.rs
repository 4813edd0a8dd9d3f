//! How a setting of a study is declared: once, with its key, check and description. `section!` also declares defaults;
//! settings listed with `settings!` have the defaults of the crate that defines their structure.

use toml::Value;

/// One setting of a study. The keys of the study file, the faults, the fields of the window and the comparison of studies
/// follow from it.
#[derive(Debug, Clone, Copy)]
pub struct Setting {
    /// Dotted name of the section, empty for the top of the file.
    pub section: &'static str,
    /// Key within the section; it ends with the unit.
    pub key: &'static str,
    /// What the setting means, in one or two sentences.
    pub description: &'static str,
    /// Which values are valid.
    pub check: Check,
    /// For a setting that may be omitted and then has no value: the value that an editor starts from.
    pub initial: Option<Initial>,
}

/// Value that an editor starts from when an optional setting is added.
#[derive(Debug, Clone, Copy)]
pub enum Initial {
    /// A floating-point number.
    Number(f64),
    /// A whole number.
    Count(i64),
    /// A name.
    Name(&'static str),
    /// None: the setting is edited as text.
    AsText,
}

/// Which values of a setting are valid. Each value of an array is checked.
#[derive(Debug, Clone, Copy)]
pub enum Check {
    /// A number above 0, large and small enough that squares and quotients of such numbers stay finite.
    Positive,
    /// A number of at least 0, small enough that squares of such numbers stay finite.
    NonNegative,
    /// A number in `[low, high]`; the text names the unit or another way to omit the requirement.
    Within(f64, f64, &'static str),
    /// A number in `[low, high)`.
    HalfOpen(f64, f64),
    /// A finite number.
    Finite,
    /// A whole number in `[low, high]`.
    Count(i64, i64),
    /// One of these names.
    Choice(&'static [&'static str]),
    /// A selection of names, at least one and none twice.
    Selection(fn() -> Vec<&'static str>),
    /// A text that is not blank.
    Name,
    /// Any value of its type, or one that a rule about several settings checks.
    Any,
}

impl Setting {
    /// Dotted key in the study file.
    pub fn path(&self) -> String {
        if self.section.is_empty() {
            self.key.to_owned()
        } else {
            format!("{}.{}", self.section, self.key)
        }
    }

    /// Name for people, with the unit in brackets: `youngs_modulus_pa` is `youngs modulus [Pa]`.
    pub fn title(&self) -> String {
        const UNITS: [(&str, &str); 18] = [
            ("_kg_per_m3", "kg/m³"),
            ("_nm_per_rad", "N·m/rad"),
            ("_rad_per_s2", "rad/s²"),
            ("_rad_per_s", "rad/s"),
            ("_m_per_s2", "m/s²"),
            ("_m_per_s", "m/s"),
            ("_kg_m2", "kg·m²"),
            ("_rad", "rad"),
            ("_hz", "Hz"),
            ("_w", "W"),
            ("_n_per_m", "N/m"),
            ("_deg", "°"),
            ("_nm", "N·m"),
            ("_kg", "kg"),
            ("_pa", "Pa"),
            ("_m", "m"),
            ("_n", "N"),
            ("_s", "s"),
        ];
        let unit = UNITS
            .iter()
            .find_map(|(suffix, unit)| Some((self.key.strip_suffix(suffix)?, *unit)));
        match unit {
            Some((name, unit)) => format!("{} [{unit}]", name.replace('_', " ")),
            None => self.key.replace('_', " "),
        }
    }

    /// The value of this setting in a study as a TOML table.
    pub fn value<'a>(&self, study: &'a toml::Table) -> Option<&'a Value> {
        let sections = self.section.split('.').filter(|part| !part.is_empty());
        let mut table = study;
        for section in sections {
            table = table.get(section)?.as_table()?;
        }
        table.get(self.key)
    }
}

impl Check {
    /// What is wrong with a value and what would be right; `None` for a valid value.
    pub fn fault(self, value: &Value) -> Option<String> {
        match (self, value) {
            (Check::Selection(_), Value::Array(names)) => selection_fault(names),
            (_, Value::Array(values)) => values.iter().find_map(|value| self.fault(value)),
            (_, Value::Float(number)) => self.number_fault(*number),
            (Check::Count(low, high), Value::Integer(count)) => {
                let valid = (low..=high).contains(count);
                (!valid).then(|| format!("is {count}; it must be {low} to {high}"))
            }
            (_, Value::Integer(count)) => self.number_fault(*count as f64),
            (Check::Choice(names), Value::String(name)) => {
                let valid = names.contains(&name.as_str());
                (!valid).then(|| format!("is \"{name}\"; it must be one of {}", names.join(", ")))
            }
            (Check::Name, Value::String(name)) => {
                if name.trim().is_empty() {
                    return Some("is empty; give a short name".to_owned());
                }
                wrong_name(name)
            }
            _ => None,
        }
    }

    /// The valid values in words, if they are a range.
    pub fn range(self) -> Option<String> {
        match self {
            Check::Positive => Some("above 0".to_owned()),
            Check::NonNegative => Some("0 or above".to_owned()),
            Check::Within(low, high, more) => Some(format!("{low} to {high}{more}")),
            Check::HalfOpen(low, high) => Some(format!("{low} to below {high}")),
            Check::Count(low, high) => Some(format!("{low} to {high}")),
            _ => None,
        }
    }

    fn number_fault(self, number: f64) -> Option<String> {
        let (valid, expected) = match self {
            Check::Positive => ((1e-12..=1e15).contains(&number), "above 0 (1e-12 to 1e15)".to_owned()),
            Check::NonNegative => (
                number == 0.0 || (1e-12..=1e15).contains(&number),
                "0, or from 1e-12 to 1e15".to_owned(),
            ),
            Check::Within(low, high, more) => ((low..=high).contains(&number), format!("in [{low}, {high}]{more}")),
            Check::HalfOpen(low, high) => ((low..high).contains(&number), format!("in [{low}, {high})")),
            Check::Finite => (number.is_finite(), "a finite number".to_owned()),
            _ => (true, String::new()),
        };
        (!valid).then(|| format!("is {number}; it must be {expected}"))
    }
}

fn selection_fault(names: &[Value]) -> Option<String> {
    let twice = names
        .iter()
        .enumerate()
        .find(|(index, name)| names[..*index].contains(name));
    match (names.is_empty(), twice) {
        (true, _) => Some("is empty; select at least one".to_owned()),
        (_, Some((_, name))) => Some(format!("contains {name} twice")),
        _ => None,
    }
}

/// Declares a section of the study file: a structure with its defaults, and the [`Setting`] of each key.
///
/// A field is declared as `key: type = default, check;`, an optional one as `key: Option<type>, check, initial value;`, and a section
/// within the section, whose settings are declared with it, as `key: type;`.
macro_rules! section {
    (
        $(#[$attribute:meta])*
        pub struct $name:ident in $section:literal {
            $(
                $(#[doc = $doc:literal])+
                $key:ident: $type:ty = $default:expr, $check:expr;
            )*
            $(optional {
                $(
                    $(#[doc = $optional_doc:literal])+
                    $optional_key:ident: $optional_type:ty, $optional_check:expr, $initial:expr;
                )*
            })?
            $(nested {
                $(
                    $(#[doc = $nested_doc:literal])+
                    $nested_key:ident: $nested_type:ty;
                )*
            })?
        }
    ) => {
        $(#[$attribute])*
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
        #[serde(default, deny_unknown_fields)]
        pub struct $name {
            $($(#[doc = $doc])+ pub $key: $type,)*
            $($(
                $(#[doc = $optional_doc])+
                #[serde(skip_serializing_if = "Option::is_none")]
                pub $optional_key: Option<$optional_type>,
            )*)?
            $($(
                $(#[doc = $nested_doc])+
                pub $nested_key: $nested_type,
            )*)?
        }

        impl Default for $name {
            fn default() -> Self {
                Self {
                    $($key: $default,)*
                    $($($optional_key: None,)*)?
                    $($($nested_key: <$nested_type>::default(),)*)?
                }
            }
        }

        impl $name {
            /// The settings of this section.
            pub(super) const SETTINGS: &'static [$crate::Setting] = &[
                $($crate::Setting {
                    section: $section,
                    key: stringify!($key),
                    description: concat!($($doc),+),
                    check: $check,
                    initial: None,
                },)*
                $($($crate::Setting {
                    section: $section,
                    key: stringify!($optional_key),
                    description: concat!($($optional_doc),+),
                    check: $optional_check,
                    initial: Some($initial),
                },)*)?
            ];
        }
    };
}

/// Declares the settings of a section whose structure stands elsewhere.
///
/// A key is declared as `key: check, description;`, and one that may be omitted as `key: check, description, initial value;`.
macro_rules! settings {
    ($section:literal { $($key:ident: $check:expr, $description:literal $(, $initial:expr)?;)* }) => {
        &[$($crate::Setting {
            section: $section,
            key: stringify!($key),
            description: $description,
            check: $check,
            initial: settings!(@initial $($initial)?),
        },)*]
    };
    (@initial) => { None };
    (@initial $initial:expr) => { Some($initial) };
}

pub(super) use {section, settings};

/// Largest number of characters of a name.
const LONGEST_NAME: usize = 100;

/// Returns what is wrong with a name that terminals, file systems and other programs show.
pub(crate) fn wrong_name(name: &str) -> Option<String> {
    if let Some(found) = name.chars().find(|&c| c == '\n' || c == '\t' || !is_shown(c)) {
        return Some(format!(
            "has the character {}, which changes what a terminal shows; omit it",
            found.escape_unicode()
        ));
    }
    let length = name.chars().count();
    (length > LONGEST_NAME).then(|| format!("has {length} characters; a name has at most {LONGEST_NAME}"))
}

/// Whether a terminal shows a character and nothing else happens: control characters, and marks that change the direction of the text
/// around them, are others. The end of a line and the tabulator are shown.
pub fn is_shown(character: char) -> bool {
    let turns = matches!(
        character,
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
    );
    matches!(character, '\n' | '\t') || !character.is_control() && !turns
}
