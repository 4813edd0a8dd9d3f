//! The design vector `x = (d, R, r, L_b, r_j, r_p)`, the further variables of some chains, and the working mode.

use super::design_variable::VARIABLES;
use super::{Architecture, DESIGN_VARIABLES, DesignVariable, FURTHER_VARIABLES};

/// Design of one manipulator: architecture, working mode, the five dimensions in metres, and what its chain has beyond them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Design {
    architecture: Architecture,
    working_mode: WorkingMode,
    /// Values of [`DESIGN_VARIABLES`] and then of [`FURTHER_VARIABLES`], in the order of [`DesignVariable`].
    values: [f64; VARIABLES],
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

impl DesignVariable {
    fn out_of_domain(self, value: f64, wanted: &'static str) -> DesignError {
        let key = self.key();
        DesignError::OutOfDomain { key, value, wanted }
    }

    /// Refuses what is no length: a number that is not finite, below 0, or 0 where it must be positive.
    fn check_length(self, value: f64) -> Result<(), DesignError> {
        let above = value > 0.0 || (self.may_be_zero() && value == 0.0);
        if above && value.is_finite() {
            return Ok(());
        }
        let wanted = if self.may_be_zero() {
            "a finite length of at least 0 m"
        } else {
            "a finite length above 0 m"
        };
        Err(self.out_of_domain(value, wanted))
    }

    /// Refuses a length that is too many times `R`.
    fn check_ratio(self, value: f64, base_radius: f64) -> Result<(), DesignError> {
        let ratio = value / base_radius;
        if ratio > Design::MAX_RATIO {
            let key = self.key();
            return Err(DesignError::OutOfProportion { key, ratio });
        }
        Ok(())
    }

    /// Refuses a value with which the product of the length of a bar and its squared radius is too large \[m³\].
    fn check_volume(self, value: f64, volume: f64) -> Result<(), DesignError> {
        if volume.is_nan() || volume > Design::MAX_VOLUME {
            return Err(self.out_of_domain(value, "so small that the mass of the bar is a finite number"));
        }
        Ok(())
    }
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
        self.value(DesignVariable::BaseRadius)
    }

    /// `r`: circumradius of the platform joints `C_i` \[m\].
    pub fn platform_radius(&self) -> f64 {
        self.value(DesignVariable::PlatformRadius)
    }

    /// `L_b`: length of the links or guides, or the largest length of a telescopic leg \[m\].
    pub fn link_length(&self) -> f64 {
        self.value(DesignVariable::LinkLength)
    }

    /// `r_j`: radius of the leg bars \[m\].
    pub fn leg_bar_radius(&self) -> f64 {
        self.value(DesignVariable::LegBarRadius)
    }

    /// `r_p`: radius of the three platform bars \[m\].
    pub fn platform_bar_radius(&self) -> f64 {
        self.value(DesignVariable::PlatformBarRadius)
    }

    /// `L_a`: length of the bar `A_iB_i`, or its largest length \[m\]. It equals `L_b` unless it is given.
    pub fn proximal_length(&self) -> f64 {
        self.value(DesignVariable::ProximalLength)
    }

    /// `α`: angle from the side `A_iA_{i+1}` of the base to the rail \[deg\].
    pub fn rail_angle_deg(&self) -> f64 {
        self.value(DesignVariable::RailAngle)
    }

    /// `β`: angle between the two guides of a leg \[deg\].
    pub fn guide_angle_deg(&self) -> f64 {
        self.value(DesignVariable::GuideAngle)
    }

    /// `γ`: angle from `PC_i` to the guide on the platform \[deg\].
    pub fn platform_guide_angle_deg(&self) -> f64 {
        self.value(DesignVariable::PlatformGuideAngle)
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
    pub(crate) fn with_bars(mut self, [leg, platform]: [f64; 2]) -> Self {
        self.values[DesignVariable::LegBarRadius as usize] = leg;
        self.values[DesignVariable::PlatformBarRadius as usize] = platform;
        self
    }

    /// Returns the design with `R`, `r`, `L_b` and `L_a` multiplied by `factor`, and with its own bars.
    pub(crate) fn with_lengths_times(mut self, factor: f64) -> Self {
        for variable in [
            DesignVariable::BaseRadius,
            DesignVariable::PlatformRadius,
            DesignVariable::LinkLength,
            DesignVariable::ProximalLength,
        ] {
            self.values[variable as usize] *= factor;
        }
        self
    }

    /// Creates the design with the real variables given in the order of [`DESIGN_VARIABLES`]; what its chain has beyond them takes
    /// its default, which [`Design::with`] changes.
    ///
    /// # Errors
    /// Returns a [`DesignError`] if a value is not a positive finite length (bar radii may be 0), if `r` or `L_b` exceeds
    /// [`Design::MAX_RATIO`] times `R`, or if a bar is so large that its mass is not finite.
    pub fn new(architecture: Architecture, working_mode: WorkingMode, values: [f64; 5]) -> Result<Self, DesignError> {
        for (variable, value) in DESIGN_VARIABLES.into_iter().zip(values) {
            variable.check_length(value)?;
        }
        let [base, platform, link, leg_bar, platform_bar] = values;
        DesignVariable::PlatformRadius.check_ratio(platform, base)?;
        DesignVariable::LinkLength.check_ratio(link, base)?;
        DesignVariable::LegBarRadius.check_volume(leg_bar, leg_bar * leg_bar * link)?;
        DesignVariable::PlatformBarRadius.check_volume(platform_bar, platform_bar * platform_bar * platform)?;
        let mut design = Self {
            architecture,
            working_mode: Self::mode_of(architecture, working_mode),
            values: [0.0; VARIABLES],
        };
        design.values[..values.len()].copy_from_slice(&values);
        for variable in FURTHER_VARIABLES {
            design.values[variable as usize] = design.default_value(variable);
        }
        Ok(design)
    }

    /// Returns the design with another value of one variable; `L_a` follows `L_b` unless it is given.
    ///
    /// # Errors
    /// Returns a [`DesignError`] if the chain has no such variable, or if the value is out of its domain.
    pub fn with(mut self, variable: DesignVariable, value: f64) -> Result<Self, DesignError> {
        if DESIGN_VARIABLES.contains(&variable) {
            let mut values = self.values();
            values[variable as usize] = value;
            return self.with_dimensions(values);
        }
        self.values[variable as usize] = value;
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
        match variable {
            DesignVariable::ProximalLength => {
                variable.check_length(value)?;
                variable.check_ratio(value, self.base_radius())?;
                variable.check_volume(value, self.leg_bar_radius() * self.leg_bar_radius() * value)?;
            }
            DesignVariable::GuideAngle if !(value > 0.0 && value < 180.0) => {
                let wanted = "above 0° and below 180°, so that the guides are not parallel";
                return Err(variable.out_of_domain(value, wanted));
            }
            _ if value.is_nan() || value.abs() > 360.0 => return Err(variable.out_of_domain(value, "within ±360°")),
            _ => {}
        }
        Ok(self)
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
            self.proximal_length() + self.link_length()
        } else {
            self.link_length()
        }
    }

    /// Returns the value of a variable \[m, or deg for an angle\].
    pub fn value(&self, variable: DesignVariable) -> f64 {
        self.values[variable as usize]
    }

    /// Returns the value that a further variable has unless it is given: `L_b` for `L_a`, 90° between two guides, otherwise 0°.
    pub fn default_value(&self, variable: DesignVariable) -> f64 {
        match variable {
            DesignVariable::ProximalLength => self.link_length(),
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
        DESIGN_VARIABLES.map(|variable| self.value(variable))
    }
}
