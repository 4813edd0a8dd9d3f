//! The design vector `x = (d, R, r, L_b, r_j, r_p)`, the further variables of some chains, and the working mode.

use super::Architecture;

/// Design of one manipulator: architecture, working mode, the five dimensions in metres, and what its chain has beyond them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Design {
    architecture: Architecture,
    working_mode: WorkingMode,
    base_radius: f64,
    platform_radius: f64,
    link_length: f64,
    leg_bar_radius: f64,
    platform_bar_radius: f64,
    proximal_length: f64,
    rail_angle_deg: f64,
    guide_angle_deg: f64,
    platform_guide_angle_deg: f64,
}

/// One of the real design variables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DesignVariable {
    /// `R`, [`Design::base_radius`].
    BaseRadius,
    /// `r`, [`Design::platform_radius`].
    PlatformRadius,
    /// `L_b`, [`Design::link_length`].
    LinkLength,
    /// `r_j`, [`Design::leg_bar_radius`].
    LegBarRadius,
    /// `r_p`, [`Design::platform_bar_radius`].
    PlatformBarRadius,
    /// `L_a`, [`Design::proximal_length`].
    ProximalLength,
    /// `α`, [`Design::rail_angle_deg`].
    RailAngle,
    /// `β`, [`Design::guide_angle_deg`].
    GuideAngle,
    /// `γ`, [`Design::platform_guide_angle_deg`].
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

/// The variables that only some chains have ([`Architecture::further_variables`]), in the order in which they are written.
pub const FURTHER_VARIABLES: [DesignVariable; 4] = [
    DesignVariable::ProximalLength,
    DesignVariable::RailAngle,
    DesignVariable::GuideAngle,
    DesignVariable::PlatformGuideAngle,
];

impl DesignVariable {
    /// Returns the key in design texts, JSON and CSV: `R`, `r`, `Lb`, `rj`, `rp`, `La`, `alpha_deg`, `beta_deg`, `gamma_deg`.
    pub fn key(self) -> &'static str {
        match self {
            DesignVariable::BaseRadius => "R",
            DesignVariable::PlatformRadius => "r",
            DesignVariable::LinkLength => "Lb",
            DesignVariable::LegBarRadius => "rj",
            DesignVariable::PlatformBarRadius => "rp",
            DesignVariable::ProximalLength => "La",
            DesignVariable::RailAngle => "alpha_deg",
            DesignVariable::GuideAngle => "beta_deg",
            DesignVariable::PlatformGuideAngle => "gamma_deg",
        }
    }

    /// Returns the symbol, as text: `R`, `r`, `L_b`, `r_j`, `r_p` as in the paper, `L_a`, `α`, `β`, `γ`.
    pub fn symbol(self) -> &'static str {
        match self {
            DesignVariable::BaseRadius => "R",
            DesignVariable::PlatformRadius => "r",
            DesignVariable::LinkLength => "L_b",
            DesignVariable::LegBarRadius => "r_j",
            DesignVariable::PlatformBarRadius => "r_p",
            DesignVariable::ProximalLength => "L_a",
            DesignVariable::RailAngle => "α",
            DesignVariable::GuideAngle => "β",
            DesignVariable::PlatformGuideAngle => "γ",
        }
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

/// Sign of the solution of the inverse kinematics for each leg (docs/model.md, section 2.5).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct WorkingMode([bool; 3]);

impl WorkingMode {
    /// Default working mode, `+++`.
    pub const ALL_PLUS: WorkingMode = WorkingMode([true; 3]);

    /// Creates the working mode with the given signs; `true` means plus.
    pub fn new(plus: [bool; 3]) -> Self {
        Self(plus)
    }

    /// Returns the sign of leg `leg` = 0, 1, 2 as +1 or −1.
    pub fn sign(self, leg: usize) -> f64 {
        if self.0[leg] { 1.0 } else { -1.0 }
    }

    /// Returns the three signs as ±1.
    pub fn signs(self) -> [i8; 3] {
        self.0.map(|plus| if plus { 1 } else { -1 })
    }

    /// Returns whether all legs have the same sign, which gives the manipulator three-fold symmetry about O.
    pub fn is_uniform(self) -> bool {
        self.0[0] == self.0[1] && self.0[1] == self.0[2]
    }
}

impl std::fmt::Display for WorkingMode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let text: String = self.0.iter().map(|&plus| if plus { '+' } else { '-' }).collect();
        f.pad(&text)
    }
}

/// Reason why five numbers do not form a valid design.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DesignError {
    /// The value is NaN, infinite, negative, or a zero for a dimension that must be positive.
    #[error("{key} is {value}; it must be {wanted}")]
    OutOfDomain {
        /// Key of the variable ([`DesignVariable::key`]).
        key: &'static str,
        /// Value given.
        value: f64,
        /// Description of the legal values.
        wanted: &'static str,
    },
    /// The ratio of a length to `R` is too large. The steps of the workspace grid are a fraction of `R`, so that beyond
    /// this ratio the number of steps is too large.
    #[error("{key} is {ratio:.0} times R; it must be at most 1000 times R, which sets the step of the grid")]
    OutOfProportion {
        /// Key of the variable ([`DesignVariable::key`]).
        key: &'static str,
        /// Ratio of the variable to `R`.
        ratio: f64,
    },
    /// The chain does not have the variable.
    #[error("{architecture} has no {key}; {wanted}")]
    NotOfChain {
        /// The architecture.
        architecture: Architecture,
        /// Key of the variable ([`DesignVariable::key`]).
        key: &'static str,
        /// The chains that have it.
        wanted: &'static str,
    },
}

impl Design {
    /// Largest product of the length of a bar and its squared radius \[m³\] that is accepted, so that its mass is finite.
    const MAX_VOLUME: f64 = 1e250;

    /// Largest ratio of `r` or `L_b` to `R` that is accepted.
    pub const MAX_RATIO: f64 = 1000.0;

    /// `d`: the architecture.
    pub fn architecture(&self) -> Architecture {
        self.architecture
    }

    /// Branch of the inverse kinematics of each leg.
    pub fn working_mode(&self) -> WorkingMode {
        self.working_mode
    }

    /// `R`: circumradius of the base joints `A_i` \[m\].
    pub fn base_radius(&self) -> f64 {
        self.base_radius
    }

    /// `r`: circumradius of the platform joints `C_i` \[m\].
    pub fn platform_radius(&self) -> f64 {
        self.platform_radius
    }

    /// `L_b`: length of the links or guides, or the largest length of a telescopic leg \[m\].
    pub fn link_length(&self) -> f64 {
        self.link_length
    }

    /// `r_j`: radius of the leg bars \[m\].
    pub fn leg_bar_radius(&self) -> f64 {
        self.leg_bar_radius
    }

    /// `r_p`: radius of the three platform bars \[m\].
    pub fn platform_bar_radius(&self) -> f64 {
        self.platform_bar_radius
    }

    /// `L_a`: length of the bar `A_iB_i`, or its largest length \[m\]. It equals `L_b` unless it is given.
    pub fn proximal_length(&self) -> f64 {
        self.proximal_length
    }

    /// `α`: angle from the side `A_iA_{i+1}` of the base to the rail \[deg\].
    pub fn rail_angle_deg(&self) -> f64 {
        self.rail_angle_deg
    }

    /// `β`: angle between the two guides of a leg \[deg\].
    pub fn guide_angle_deg(&self) -> f64 {
        self.guide_angle_deg
    }

    /// `γ`: angle from `PC_i` to the guide on the platform \[deg\].
    pub fn platform_guide_angle_deg(&self) -> f64 {
        self.platform_guide_angle_deg
    }

    /// Returns the design with other branches of the inverse kinematics, if its legs have several.
    #[must_use]
    pub fn with_working_mode(self, working_mode: WorkingMode) -> Self {
        Self {
            working_mode: Self::mode_of(self.architecture, working_mode),
            ..self
        }
    }

    /// An architecture without working modes always has the default, so that equal designs compare as equal.
    fn mode_of(architecture: Architecture, working_mode: WorkingMode) -> WorkingMode {
        if architecture.has_working_modes() {
            working_mode
        } else {
            WorkingMode::ALL_PLUS
        }
    }

    /// Returns the design with bars of other radii \[m\], which must be within their domain.
    pub(crate) fn with_bars(&self, [leg_bar_radius, platform_bar_radius]: [f64; 2]) -> Self {
        Self {
            leg_bar_radius,
            platform_bar_radius,
            ..*self
        }
    }

    /// Returns the design with `R`, `r`, `L_b` and `L_a` multiplied by `factor`, and with its own bars.
    pub(crate) fn with_lengths_times(&self, factor: f64) -> Self {
        Self {
            base_radius: self.base_radius * factor,
            platform_radius: self.platform_radius * factor,
            link_length: self.link_length * factor,
            proximal_length: self.proximal_length * factor,
            ..*self
        }
    }

    /// Creates the design with the real variables given in the order of [`DESIGN_VARIABLES`]; what its chain has beyond them takes
    /// its default, which [`Design::with`] changes.
    ///
    /// # Errors
    /// Returns a [`DesignError`] if a value is not a positive finite length (bar radii may be 0), if `r` or `L_b` exceeds
    /// [`Design::MAX_RATIO`] times `R`, or if a bar is so large that its mass is not finite.
    pub fn new(architecture: Architecture, working_mode: WorkingMode, values: [f64; 5]) -> Result<Self, DesignError> {
        for (variable, value) in DESIGN_VARIABLES.into_iter().zip(values) {
            let above = value > 0.0 || (variable.may_be_zero() && value == 0.0);
            let legal = above && value.is_finite();
            if !legal {
                return Err(DesignError::OutOfDomain {
                    key: variable.key(),
                    value,
                    wanted: if variable.may_be_zero() {
                        "a finite length of at least 0 m"
                    } else {
                        "a finite length above 0 m"
                    },
                });
            }
        }
        for (variable, value) in [
            (DesignVariable::PlatformRadius, values[1]),
            (DesignVariable::LinkLength, values[2]),
        ] {
            let ratio = value / values[0];
            if ratio > Self::MAX_RATIO {
                return Err(DesignError::OutOfProportion {
                    key: variable.key(),
                    ratio,
                });
            }
        }
        for (variable, radius, length) in [
            (DesignVariable::LegBarRadius, values[3], values[2]),
            (DesignVariable::PlatformBarRadius, values[4], values[1]),
        ] {
            let volume = radius * radius * length;
            if volume.is_nan() || volume > Self::MAX_VOLUME {
                return Err(DesignError::OutOfDomain {
                    key: variable.key(),
                    value: radius,
                    wanted: "so small that the mass of the bar is a finite number",
                });
            }
        }
        let [
            base_radius,
            platform_radius,
            link_length,
            leg_bar_radius,
            platform_bar_radius,
        ] = values;
        Ok(Self {
            architecture,
            working_mode: Self::mode_of(architecture, working_mode),
            base_radius,
            platform_radius,
            link_length,
            leg_bar_radius,
            platform_bar_radius,
            proximal_length: link_length,
            rail_angle_deg: 0.0,
            guide_angle_deg: 90.0,
            platform_guide_angle_deg: 0.0,
        })
    }

    /// Returns the design with another value of one variable; `L_a` follows `L_b` unless it is given.
    ///
    /// # Errors
    /// Returns a [`DesignError`] if the chain has no such variable, or if the value is out of its domain.
    pub fn with(mut self, variable: DesignVariable, value: f64) -> Result<Self, DesignError> {
        let out_of_domain = |wanted| {
            Err(DesignError::OutOfDomain {
                key: variable.key(),
                value,
                wanted,
            })
        };
        let place = match variable {
            DesignVariable::ProximalLength => &mut self.proximal_length,
            DesignVariable::RailAngle => &mut self.rail_angle_deg,
            DesignVariable::GuideAngle => &mut self.guide_angle_deg,
            DesignVariable::PlatformGuideAngle => &mut self.platform_guide_angle_deg,
            _ => {
                let mut values = self.values();
                values[variable as usize] = value;
                return self.with_dimensions(values);
            }
        };
        *place = value;
        if !self.architecture.has(variable) {
            return Err(DesignError::NotOfChain {
                architecture: self.architecture,
                key: variable.key(),
                wanted: match variable {
                    DesignVariable::ProximalLength => "only RRR, RRP and RPP legs have a bar from A to B",
                    DesignVariable::RailAngle => "only legs whose first joint is prismatic have a rail",
                    DesignVariable::GuideAngle => "only RPP and PPR legs have two guides",
                    _ => "only legs whose last joint is prismatic have a guide on the platform",
                },
            });
        }
        let ratio = value / self.base_radius;
        let volume = self.leg_bar_radius * self.leg_bar_radius * value;
        match variable {
            DesignVariable::ProximalLength if !(value.is_finite() && value > 0.0) => {
                out_of_domain("a finite length above 0 m")
            }
            DesignVariable::ProximalLength if ratio > Self::MAX_RATIO => Err(DesignError::OutOfProportion {
                key: variable.key(),
                ratio,
            }),
            DesignVariable::ProximalLength if volume.is_nan() || volume > Self::MAX_VOLUME => {
                out_of_domain("so small that the mass of the bar is a finite number")
            }
            DesignVariable::GuideAngle if !(value > 0.0 && value < 180.0) => {
                out_of_domain("above 0° and below 180°, so that the guides are not parallel")
            }
            variable if variable.is_angle() && (value.is_nan() || value.abs() > 360.0) => out_of_domain("within ±360°"),
            _ => Ok(self),
        }
    }

    /// Returns the design with other dimensions; further variables keep the values that were given.
    ///
    /// # Errors
    /// As [`Design::new`].
    pub fn with_dimensions(&self, values: [f64; 5]) -> Result<Self, DesignError> {
        let design = Self::new(self.architecture, self.working_mode, values)?;
        self.given_variables()
            .try_fold(design, |design, variable| design.with(variable, self.value(variable)))
    }

    /// Returns the length of the bars of one leg together: `L_b`, and `L_a` where the chain has it \[m\].
    pub fn leg_bars_length(&self) -> f64 {
        if self.architecture.chain().has_proximal_bar {
            self.proximal_length + self.link_length
        } else {
            self.link_length
        }
    }

    /// Returns the value of a variable \[m, or deg for an angle\].
    pub fn value(&self, variable: DesignVariable) -> f64 {
        match variable {
            DesignVariable::BaseRadius => self.base_radius,
            DesignVariable::PlatformRadius => self.platform_radius,
            DesignVariable::LinkLength => self.link_length,
            DesignVariable::LegBarRadius => self.leg_bar_radius,
            DesignVariable::PlatformBarRadius => self.platform_bar_radius,
            DesignVariable::ProximalLength => self.proximal_length,
            DesignVariable::RailAngle => self.rail_angle_deg,
            DesignVariable::GuideAngle => self.guide_angle_deg,
            DesignVariable::PlatformGuideAngle => self.platform_guide_angle_deg,
        }
    }

    /// Returns the value that a further variable has unless it is given: `L_b` for `L_a`, 90° between two guides, otherwise 0°.
    pub fn default_value(&self, variable: DesignVariable) -> f64 {
        match variable {
            DesignVariable::ProximalLength => self.link_length,
            DesignVariable::GuideAngle => 90.0,
            _ => 0.0,
        }
    }

    /// Returns the further variables of the chain whose values are not the defaults.
    pub fn given_variables(&self) -> impl Iterator<Item = DesignVariable> + '_ {
        let further = self.architecture.further_variables().iter().copied();
        further.filter(|&variable| self.value(variable) != self.default_value(variable))
    }

    /// Returns the real variables in the order of [`DESIGN_VARIABLES`] \[m\].
    pub fn values(&self) -> [f64; 5] {
        [
            self.base_radius,
            self.platform_radius,
            self.link_length,
            self.leg_bar_radius,
            self.platform_bar_radius,
        ]
    }
}
