//! The design vector `x = (d, R, r, L_b, r_j, r_p)` and the working mode.

use super::Architecture;

/// One manipulator: architecture, working mode and the five dimensions, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Design {
    /// `d`: the architecture.
    pub architecture: Architecture,
    /// Branch of the inverse kinematics, leg by leg.
    pub working_mode: WorkingMode,
    /// `R`: circumradius of the base joints `A_i` \[m\].
    pub base_radius: f64,
    /// `r`: circumradius of the platform joints `C_i` \[m\].
    pub platform_radius: f64,
    /// `L_b`: length of the links, or the longest reach of a telescopic leg \[m\].
    pub link_length: f64,
    /// `r_j`: radius of the leg bars \[m\].
    pub leg_bar_radius: f64,
    /// `r_p`: radius of the three platform bars \[m\].
    pub platform_bar_radius: f64,
}

/// One of the five real design variables, by its symbol in the paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Variable {
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
}

/// The real variables in the order of the design vector.
pub const VARIABLES: [Variable; 5] = [
    Variable::BaseRadius,
    Variable::PlatformRadius,
    Variable::LinkLength,
    Variable::LegBarRadius,
    Variable::PlatformBarRadius,
];

impl Variable {
    /// Key in design texts, JSON and CSV: `R`, `r`, `Lb`, `rj`, `rp`.
    pub fn key(self) -> &'static str {
        match self {
            Variable::BaseRadius => "R",
            Variable::PlatformRadius => "r",
            Variable::LinkLength => "Lb",
            Variable::LegBarRadius => "rj",
            Variable::PlatformBarRadius => "rp",
        }
    }

    /// Symbol in the paper, as text: `R`, `r`, `L_b`, `r_j`, `r_p`.
    pub fn symbol(self) -> &'static str {
        match self {
            Variable::BaseRadius => "R",
            Variable::PlatformRadius => "r",
            Variable::LinkLength => "L_b",
            Variable::LegBarRadius => "r_j",
            Variable::PlatformBarRadius => "r_p",
        }
    }

    /// Whether zero is a legal value: a bar radius may be 0 (infinitely compliant), a length may not.
    pub fn may_be_zero(self) -> bool {
        matches!(self, Variable::LegBarRadius | Variable::PlatformBarRadius)
    }
}

/// Sign of each leg's solution of the inverse kinematics (SPEC section 1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct WorkingMode([bool; 3]);

impl WorkingMode {
    /// `+++`, the default.
    pub const ALL_PLUS: WorkingMode = WorkingMode([true; 3]);

    /// The mode with the given signs; `true` is plus.
    pub fn new(plus: [bool; 3]) -> Self {
        Self(plus)
    }

    /// +1 or −1 for leg `i` = 0, 1, 2.
    pub fn sign(self, leg: usize) -> f64 {
        if self.0[leg] { 1.0 } else { -1.0 }
    }

    /// The three signs as ±1.
    pub fn signs(self) -> [i8; 3] {
        self.0.map(|plus| if plus { 1 } else { -1 })
    }

    /// One sign for all legs: the manipulator then has three-fold symmetry about O.
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

/// Why five numbers are not a design.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DesignError {
    /// Not a number, infinite, negative, or a zero length.
    #[error("{key} is {value}; it must be {wanted}")]
    OutOfDomain {
        /// Variable, as in [`Variable::key`].
        key: &'static str,
        /// The value given.
        value: f64,
        /// What would be right.
        wanted: &'static str,
    },
    /// The workspace grid is laid in steps of a share of `R`: beyond this ratio it has no end.
    #[error("{key} is {ratio:.0} times R; the workspace grid follows R and takes at most 1000 times")]
    OutOfProportion {
        /// Variable, as in [`Variable::key`].
        key: &'static str,
        /// Its ratio to `R`.
        ratio: f64,
    },
}

impl Design {
    /// Largest ratio of `r` or `L_b` to `R` that is accepted.
    pub const MAX_RATIO: f64 = 1000.0;

    /// The design with the real variables given in the order of [`VARIABLES`].
    ///
    /// # Errors
    /// [`DesignError`] when a value is no positive finite length (bar radii may be 0).
    pub fn new(architecture: Architecture, working_mode: WorkingMode, values: [f64; 5]) -> Result<Self, DesignError> {
        for (variable, value) in VARIABLES.into_iter().zip(values) {
            let legal = value.is_finite() && (value > 0.0 || (variable.may_be_zero() && value == 0.0));
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
        for (variable, value) in [(Variable::PlatformRadius, values[1]), (Variable::LinkLength, values[2])] {
            let ratio = value / values[0];
            if ratio > Self::MAX_RATIO {
                return Err(DesignError::OutOfProportion {
                    key: variable.key(),
                    ratio,
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
            // A mode without meaning is not told apart from another one.
            working_mode: if architecture.has_working_modes() {
                working_mode
            } else {
                WorkingMode::ALL_PLUS
            },
            base_radius,
            platform_radius,
            link_length,
            leg_bar_radius,
            platform_bar_radius,
        })
    }

    /// The real variables in the order of [`VARIABLES`] \[m\].
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
