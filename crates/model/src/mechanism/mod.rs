//! Architectures and designs: joints, joint limits and inverse kinematics, one file per leg type.
//!
//! To add an architecture, add a file with a type that implements [`Leg`] and one line in the `architectures!` list
//! below. No other module of the library names an individual architecture: code that needs a leg type is generic over
//! `L: Leg` and is called through `with_leg!` (docs/model.md, section 2).

mod design;
mod leg;
mod member;
mod prr;
mod rpr;
mod rrr;
mod text;

pub use design::{DESIGN_VARIABLES, Design, DesignError, DesignVariable, WorkingMode};
pub use leg::{
    Actuator, BarLength, Guide, Leg, LegBody, LegJoint, LegLanes, LegPart, LegPosture, LegSettings, Manipulator,
    Posture, ReachReason, Segment, Shortfall,
};
pub use member::{MemberAxis, MemberKind, Members};
pub use prr::PrrLeg;
pub use rpr::RprLeg;
pub use rrr::RrrLeg;
pub use text::TextError;

macro_rules! architectures {
    // `$d` is a literal dollar sign: this macro defines a macro that has metavariables of its own.
    ($d:tt; $($(#[$doc:meta])* $variant:ident => $leg:ident,)+) => {
        /// Planar parallel architecture with three legs of one type; the paper underlines the actuated joint.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
        #[serde(try_from = "String", into = "String")]
        pub enum Architecture {
            $($(#[$doc])* $variant,)+
        }

        impl Architecture {
            /// All architectures in the order of the paper.
            pub const ALL: &[Architecture] = &[$(Architecture::$variant),+];
        }

        /// Runs an expression with a type alias bound to the leg type of an architecture.
        #[macro_export]
        macro_rules! with_leg {
            ($d architecture:expr, $d alias:ident => $d body:expr) => {
                match $d architecture {
                    $($crate::mechanism::Architecture::$variant => {
                        type $d alias = $crate::mechanism::$leg;
                        $d body
                    })+
                }
            };
        }
    };
}

architectures! { $;
    /// Actuated slider along a side of the base triangle, followed by a link.
    Prr => PrrLeg,
    /// Actuated telescopic leg between two passive revolute joints.
    Rpr => RprLeg,
    /// Actuated crank, followed by a link.
    Rrr => RrrLeg,
}

impl Architecture {
    /// Returns the name in the paper, for example `3-PRR`.
    pub fn name(self) -> &'static str {
        with_leg!(self, L => L::NAME)
    }

    /// Returns whether the inverse kinematics has two solutions per leg, so that a working mode has to be set.
    pub fn has_working_modes(self) -> bool {
        with_leg!(self, L => L::HAS_WORKING_MODES)
    }

    /// Returns the number of moving bars per leg: one (`n` = 3 in the formula of the mass) or two (`n` = 6).
    pub fn bars_per_leg(self) -> usize {
        with_leg!(self, L => L::BARS)
    }

    /// Returns a distance from `O` beyond which no point can be reached ([`Leg::farthest_reach`]).
    pub fn farthest_reach(self, base: f64, platform: f64, link: f64) -> f64 {
        with_leg!(self, L => L::farthest_reach(base, platform, link))
    }

    /// Returns the kind of the actuated joint.
    pub fn actuator(self) -> Actuator {
        with_leg!(self, L => L::ACTUATOR)
    }
}

impl std::fmt::Display for Architecture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}
