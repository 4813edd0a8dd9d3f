//! Architectures and designs: joints, joint limits and inverse kinematics, one file per leg type.
//!
//! A further architecture is a new file with a type that implements [`Leg`], and one line in the
//! `architectures!` list below. Nothing outside this module names the single architectures: code that needs
//! a leg type is written over `L: Leg` and entered through `with_leg!`.

mod design;
mod leg;
mod member;
mod prr;
mod rpr;
mod rrr;
mod text;

pub use design::{Design, DesignError, VARIABLES, Variable, WorkingMode};
pub use leg::{
    Actuator, BarLength, Guide, Leg, LegBody, LegJoint, LegLanes, LegPart, LegPosture, LegSettings, Manipulator,
    Posture, ReachReason, Segment, Shortfall,
};
pub use member::{Axis, MemberKind, Members};
pub use prr::PrrLeg;
pub use rpr::RprLeg;
pub use rrr::RrrLeg;
pub use text::TextError;

macro_rules! architectures {
    // `$d` is a literal dollar sign: the list writes a macro that has variables of its own.
    ($d:tt; $($(#[$doc:meta])* $variant:ident => $leg:ident,)+) => {
        /// Planar parallel architecture: three identical legs, the actuated joint underlined in the paper.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
        #[serde(try_from = "String", into = "String")]
        pub enum Architecture {
            $($(#[$doc])* $variant,)+
        }

        impl Architecture {
            /// Every architecture, in the order of the paper.
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
    /// Actuated slider along the base triangle's side, then a link.
    Prr => PrrLeg,
    /// Actuated telescopic leg between two passive revolutes.
    Rpr => RprLeg,
    /// Actuated crank, then a link.
    Rrr => RrrLeg,
}

impl Architecture {
    /// The name the paper uses, as in `3-PRR`.
    pub fn name(self) -> &'static str {
        with_leg!(self, L => L::NAME)
    }

    /// Whether the inverse kinematics has two solutions per leg to choose from.
    pub fn has_working_modes(self) -> bool {
        with_leg!(self, L => L::HAS_WORKING_MODES)
    }

    /// Bars that move in each leg: one (`n` = 3 in the mass) or two (`n` = 6).
    pub fn bars_per_leg(self) -> usize {
        with_leg!(self, L => L::BARS)
    }

    /// Kind of the actuated joint.
    pub fn actuator(self) -> Actuator {
        with_leg!(self, L => L::ACTUATOR)
    }
}

impl std::fmt::Display for Architecture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}
