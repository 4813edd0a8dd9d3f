//! Built-in studies, embedded in the binary.

/// A built-in study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Builtin {
    /// Name of the study on the command line.
    pub name: &'static str,
    /// Text of the study file, including its comments.
    pub text: &'static str,
}

/// All built-in studies; the first is the default.
pub const BUILTIN: [Builtin; 12] = [
    Builtin {
        name: "paper",
        text: include_str!("../assets/studies/paper.toml"),
    },
    Builtin {
        name: "paper-bounds-as-printed",
        text: include_str!("../assets/studies/paper-bounds-as-printed.toml"),
    },
    Builtin {
        name: "paper-without-collisions",
        text: include_str!("../assets/studies/paper-without-collisions.toml"),
    },
    Builtin {
        name: "aluminium-pick-and-place",
        text: include_str!("../assets/studies/aluminium-pick-and-place.toml"),
    },
    Builtin {
        name: "lightest-for-a-rectangle",
        text: include_str!("../assets/studies/lightest-for-a-rectangle.toml"),
    },
    Builtin {
        name: "tubes-from-a-catalogue",
        text: include_str!("../assets/studies/tubes-from-a-catalogue.toml"),
    },
    Builtin {
        name: "three-objectives",
        text: include_str!("../assets/studies/three-objectives.toml"),
    },
    Builtin {
        name: "alignment-stage",
        text: include_str!("../assets/studies/alignment-stage.toml"),
    },
    Builtin {
        name: "all-planar-architectures",
        text: include_str!("../assets/studies/all-planar-architectures.toml"),
    },
    Builtin {
        name: "builders-cell",
        text: include_str!("../assets/studies/builders-cell.toml"),
    },
    Builtin {
        name: "machine-builder",
        text: include_str!("../assets/studies/machine-builder.toml"),
    },
    Builtin {
        name: "pick-and-place-cycle",
        text: include_str!("../assets/studies/pick-and-place-cycle.toml"),
    },
];

impl Builtin {
    /// Returns the names of the built-in studies, separated by commas.
    pub fn names() -> String {
        BUILTIN.map(|builtin| builtin.name).join(", ")
    }

    /// Returns the built-in study with the given name, if there is one.
    pub fn find(name: &str) -> Option<Builtin> {
        BUILTIN.into_iter().find(|builtin| builtin.name == name)
    }
}
