//! Built-in studies, embedded in the binary.

/// A built-in study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Builtin {
    /// Name of the study on the command line.
    pub name: &'static str,
    /// Text of the study file, including its comments.
    pub text: &'static str,
    /// A design that answers the study's question, with rounded dimensions, with which the study is shown.
    pub design: &'static str,
}

/// All built-in studies; the first is the default.
pub const BUILTIN: [Builtin; 12] = [
    Builtin {
        name: "paper",
        text: include_str!("../assets/studies/paper.toml"),
        design: "3-PRR R=4.0 r=2.12 Lb=3.3 rj=0.029 rp=0.073",
    },
    Builtin {
        name: "paper-bounds-as-printed",
        text: include_str!("../assets/studies/paper-bounds-as-printed.toml"),
        design: "3-PRR R=4.0 r=1.46 Lb=3.01 rj=0.027 rp=0.056",
    },
    Builtin {
        name: "paper-without-collisions",
        text: include_str!("../assets/studies/paper-without-collisions.toml"),
        design: "3-PRR R=4.0 r=1.25 Lb=2.65 rj=0.025 rp=0.053",
    },
    Builtin {
        name: "aluminium-pick-and-place",
        text: include_str!("../assets/studies/aluminium-pick-and-place.toml"),
        design: "3-PRR R=0.8 r=0.23 Lb=0.49 rj=0.011 rp=0.016",
    },
    Builtin {
        name: "lightest-for-a-rectangle",
        text: include_str!("../assets/studies/lightest-for-a-rectangle.toml"),
        design: "3-PRR R=1.14 r=0.22 Lb=0.77 rj=0.0105 rp=0.0155",
    },
    Builtin {
        name: "tubes-from-a-catalogue",
        text: include_str!("../assets/studies/tubes-from-a-catalogue.toml"),
        design: "3-PRR R=3.0 r=1.12 Lb=2.33 rj=0.03015 rp=0.047",
    },
    Builtin {
        name: "three-objectives",
        text: include_str!("../assets/studies/three-objectives.toml"),
        design: "3-RPR R=0.99 r=0.67 Lb=2.21 rj=0.019 rp=0.018",
    },
    Builtin {
        name: "alignment-stage",
        text: include_str!("../assets/studies/alignment-stage.toml"),
        design: "3-PRR R=0.08 r=0.06 Lb=0.04 rj=0.011 rp=0.015 alpha_deg=34.64",
    },
    Builtin {
        name: "all-planar-architectures",
        text: include_str!("../assets/studies/all-planar-architectures.toml"),
        design: "3-PRR R=4.0 r=1.12 Lb=2.31 rj=0.022 rp=0.055 alpha_deg=40.22",
    },
    Builtin {
        name: "builders-cell",
        text: include_str!("../assets/studies/builders-cell.toml"),
        design: "3-PRR R=0.92 r=0.495 Lb=0.776 rj=0.0212 rp=0.0575",
    },
    Builtin {
        name: "machine-builder",
        text: include_str!("../assets/studies/machine-builder.toml"),
        design: "3-PRR R=2.33 r=0.52 Lb=1.49 rj=0.023 rp=0.027",
    },
    Builtin {
        name: "pick-and-place-cycle",
        text: include_str!("../assets/studies/pick-and-place-cycle.toml"),
        design: "3-PRR R=0.77 r=0.29 Lb=0.61 rj=0.032 rp=0.031",
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
