//! The real variables of a design.

/// One of the real design variables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DesignVariable {
    /// `R`, [`Design::base_radius`](super::Design::base_radius).
    BaseRadius,
    /// `r`, [`Design::platform_radius`](super::Design::platform_radius).
    PlatformRadius,
    /// `L_b`, [`Design::link_length`](super::Design::link_length).
    LinkLength,
    /// `r_j`, [`Design::leg_bar_radius`](super::Design::leg_bar_radius).
    LegBarRadius,
    /// `r_p`, [`Design::platform_bar_radius`](super::Design::platform_bar_radius).
    PlatformBarRadius,
    /// `L_a`, [`Design::proximal_length`](super::Design::proximal_length).
    ProximalLength,
    /// `α`, [`Design::rail_angle_deg`](super::Design::rail_angle_deg).
    RailAngle,
    /// `β`, [`Design::guide_angle_deg`](super::Design::guide_angle_deg).
    GuideAngle,
    /// `γ`, [`Design::platform_guide_angle_deg`](super::Design::platform_guide_angle_deg).
    PlatformGuideAngle,
}

/// The real variables that every architecture has, in the order of the design vector.
pub const DESIGN_VARIABLES: [DesignVariable; 5] = [
    DesignVariable::BaseRadius,
    DesignVariable::PlatformRadius,
    DesignVariable::LinkLength,
    DesignVariable::LegBarRadius,
    DesignVariable::PlatformBarRadius,
];

/// The variables that only some chains have, in the order in which they are written
/// ([`Architecture::further_variables`](super::Architecture::further_variables)).
pub const FURTHER_VARIABLES: [DesignVariable; 4] = [
    DesignVariable::ProximalLength,
    DesignVariable::RailAngle,
    DesignVariable::GuideAngle,
    DesignVariable::PlatformGuideAngle,
];

/// Number of all real variables.
pub(super) const VARIABLES: usize = DESIGN_VARIABLES.len() + FURTHER_VARIABLES.len();

impl DesignVariable {
    /// Returns the key and the symbol.
    fn names(self) -> [&'static str; 2] {
        match self {
            DesignVariable::BaseRadius => ["R", "R"],
            DesignVariable::PlatformRadius => ["r", "r"],
            DesignVariable::LinkLength => ["Lb", "L_b"],
            DesignVariable::LegBarRadius => ["rj", "r_j"],
            DesignVariable::PlatformBarRadius => ["rp", "r_p"],
            DesignVariable::ProximalLength => ["La", "L_a"],
            DesignVariable::RailAngle => ["alpha_deg", "α"],
            DesignVariable::GuideAngle => ["beta_deg", "β"],
            DesignVariable::PlatformGuideAngle => ["gamma_deg", "γ"],
        }
    }

    /// Returns the key in design texts, JSON and CSV: `R`, `r`, `Lb`, `rj`, `rp`, `La`, `alpha_deg`, `beta_deg`, `gamma_deg`.
    pub fn key(self) -> &'static str {
        self.names()[0]
    }

    /// Returns the symbol, as text: `R`, `r`, `L_b`, `r_j`, `r_p` as in the paper, `L_a`, `α`, `β`, `γ`.
    pub fn symbol(self) -> &'static str {
        self.names()[1]
    }

    /// Returns the unit: `m` or `deg`.
    pub fn unit(self) -> &'static str {
        if self.is_angle() { "deg" } else { "m" }
    }

    /// Returns whether the variable is an angle.
    pub fn is_angle(self) -> bool {
        matches!(
            self,
            DesignVariable::RailAngle | DesignVariable::GuideAngle | DesignVariable::PlatformGuideAngle
        )
    }

    /// Returns whether zero is a legal value: a bar radius may be 0 (an infinitely compliant bar), any other dimension
    /// may not.
    pub fn may_be_zero(self) -> bool {
        matches!(self, DesignVariable::LegBarRadius | DesignVariable::PlatformBarRadius)
    }
}
