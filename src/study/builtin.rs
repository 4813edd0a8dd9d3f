//! Studies that come with the program, embedded in the binary.

use super::{Study, StudyError};

/// A study that comes with the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Builtin {
    /// Name on the command line.
    pub name: &'static str,
    /// The file, comments and all.
    pub text: &'static str,
}

/// All of them; the first is the default.
pub const BUILTIN: [Builtin; 4] = [
    Builtin {
        name: "paper",
        text: include_str!("../../assets/studies/paper.toml"),
    },
    Builtin {
        name: "paper-bounds-as-printed",
        text: include_str!("../../assets/studies/paper-bounds-as-printed.toml"),
    },
    Builtin {
        name: "paper-without-collisions",
        text: include_str!("../../assets/studies/paper-without-collisions.toml"),
    },
    Builtin {
        name: "aluminium-pick-and-place",
        text: include_str!("../../assets/studies/aluminium-pick-and-place.toml"),
    },
];

impl Builtin {
    /// The one of a name.
    pub fn find(name: &str) -> Option<Builtin> {
        BUILTIN.into_iter().find(|builtin| builtin.name == name)
    }

    /// The study.
    ///
    /// # Errors
    /// None for a file that passed the tests.
    pub fn study(&self) -> Result<Study, StudyError> {
        Study::parse(self.text, self.name)
    }
}
