//! Architectures and designs: chains, actuated joints, joint limits and inverse kinematics, one file per chain.
//!
//! A leg is a chain of three joints of which one is driven ([`DrivenLeg`]). To add an architecture of a known chain, add a line to the
//! list `architectures!` below; for a new chain, also add a file to `chains` with a type that implements [`Chain`]. No other module
//! of the library names an individual chain: code that needs a leg uses [`AnyLeg`], but for the loops over poses, which are generic over
//! `L: Leg` and entered through `with_leg!` (docs/model.md, section 2).

mod body;
mod chain;
mod chain_enclosure;
mod chains;
mod design;
mod design_variable;
mod driven_leg;
mod geometry;
mod joint;
mod leg;
mod leg_enclosure;
mod member;
mod section;
mod settings;
mod shortfall;
mod text;

pub use body::{LegBody, LegJoint, LegPart, Travel, TravelKind};
pub use chain::{
    Assembly, BarPosture, Chain, ChainDescription, ChainLanes, ChainPosture, DistalLanes, LegSizes, LockedKind,
    LockedLeg, ProximalLanes, Solved,
};
pub use chain_enclosure::{ChainEnclosure, LegFrameEnclosure, LegToEnclose, ProximalEnclosure, REACH_FORMS};
pub use design::{Design, DesignError, WorkingMode};
pub use design_variable::{DESIGN_VARIABLES, DesignVariable, FURTHER_VARIABLES};
pub use driven_leg::DrivenLeg;
pub use geometry::{Arrangement, Geometry, LegFrame};
pub use joint::{CylinderSize, JointKind, JointMasses, JointPart, JointPoint, JointSizes};
pub use leg::{BarLoads, Leg, LegLanes, LegPosture, LineLoads, Manipulator, Posture};
pub use leg_enclosure::{EnclosedLoads, LegEnclosure};
pub use member::{MemberAxis, MemberKind, Members};
pub use section::{Catalogue, CatalogueEntry, CatalogueError, CrossSection, CrossSections, Wall};
pub use settings::{BarLength, LegSettings};
pub use shortfall::{ReachReason, Shortfall, Within};
pub use text::TextError;

use crate::enclosure::{MembersEnclosure, PlanarModel, PoseEnclosure};
use chains::{PprChain, PrpChain, PrrChain, RppChain, RprChain, RrpChain, RrrChain};

macro_rules! architectures {
    // `$d` is a literal dollar sign: this macro defines macros that have metavariables of their own.
    (
        $d:tt;
        fast { $($(#[$fast_doc:meta])* $fast:ident $fast_name:literal $fast_chain:ident $fast_driven:literal,)+ }
        others { $($(#[$doc:meta])* $variant:ident $name:literal $chain:ident $driven:literal,)+ }
    ) => {
        /// Planar parallel architecture with three legs of one type; the paper underlines the actuated joint.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
        #[serde(try_from = "String", into = "String")]
        pub enum Architecture {
            $($(#[$fast_doc])* $fast,)+
            $($(#[$doc])* $variant,)+
        }

        impl Architecture {
            /// All architectures: those of the paper in its order, then the others.
            pub const ALL: &[Architecture] = &[$(Architecture::$fast,)+ $(Architecture::$variant),+];

            /// The architectures of the paper.
            pub const PAPER: &[Architecture] = &[$(Architecture::$fast),+];

            /// Returns the name, for example `3-PRR` or `3-P_RR`: `_` precedes the actuated joint, except in the names of the paper.
            pub fn name(self) -> &'static str {
                match self {
                    $(Architecture::$fast => $fast_name,)+
                    $(Architecture::$variant => $name,)+
                }
            }

            /// Returns what is known of the chain without any lengths.
            pub fn chain(self) -> &'static ChainDescription {
                match self {
                    $(Architecture::$fast => &<$fast_chain as Chain>::DESCRIPTION,)+
                    $(Architecture::$variant => &<$chain as Chain>::DESCRIPTION,)+
                }
            }

            /// Returns the place of the actuated joint: 0, 1 or 2 from the base.
            pub fn driven(self) -> usize {
                match self {
                    $(Architecture::$fast => $fast_driven,)+
                    $(Architecture::$variant => $driven,)+
                }
            }
        }

        /// A leg of any architecture. It is slower than the leg itself, which matters only where many poses are evaluated.
        #[derive(Debug, Clone, Copy, PartialEq)]
        #[allow(missing_docs, reason = "the variants are those of `Architecture`")]
        pub enum AnyLeg {
            $($fast(DrivenLeg<$fast_chain, $fast_driven>),)+
            $($variant(DrivenLeg<$chain, $driven>),)+
        }

        /// Runs an expression with a name bound to the leg in a value of [`AnyLeg`].
        macro_rules! visit {
            ($d any:expr, $d leg:ident => $d body:expr) => {
                match $d any {
                    $(AnyLeg::$fast($d leg) => $d body,)+
                    $(AnyLeg::$variant($d leg) => $d body,)+
                }
            };
        }

        impl AnyLeg {
            /// Creates leg `index` of `design`.
            fn of(design: &Design, settings: &LegSettings, index: usize) -> Self {
                match design.architecture() {
                    $(Architecture::$fast => AnyLeg::$fast(Leg::new(design, settings, index)),)+
                    $(Architecture::$variant => AnyLeg::$variant(Leg::new(design, settings, index)),)+
                }
            }

            /// Encloses a leg of `design` over a box of poses.
            pub fn enclose(
                frame: &LegFrameEnclosure,
                design: &Design,
                settings: &LegSettings,
                pose: &PoseEnclosure,
            ) -> LegEnclosure {
                let leg = LegToEnclose { frame, design, settings };
                match design.architecture() {
                    $(Architecture::$fast => DrivenLeg::<$fast_chain, $fast_driven>::enclose(&leg, pose),)+
                    $(Architecture::$variant => DrivenLeg::<$chain, $driven>::enclose(&leg, pose),)+
                }
            }

            /// Encloses the axes of the members of a leg of `design` over a box of poses, relative to `P` and in multiples of
            /// `L_b`: `anchor` is `A_i`, and `tip` is `C_i`.
            pub fn enclose_members(
                frame: &LegFrameEnclosure,
                design: &Design,
                settings: &LegSettings,
                leg: &LegEnclosure,
                anchor: PlanarModel,
                tip: PlanarModel,
            ) -> MembersEnclosure {
                let (chain, leg) = (&leg.chain, LegToEnclose { frame, design, settings });
                match design.architecture() {
                    $(Architecture::$fast => $fast_chain::enclose_members(&leg, chain, anchor, tip),)+
                    $(Architecture::$variant => $chain::enclose_members(&leg, chain, anchor, tip),)+
                }
            }
        }

        /// The legs that are compiled into the loops over poses, because studies of the paper use them most.
        pub(crate) mod fast {
            $(
                #[doc = concat!("Leg of a ", $fast_name, ".")]
                pub type $fast = super::DrivenLeg<super::chains::$fast_chain, $fast_driven>;
            )+
        }

        /// Runs an expression with a type alias bound to the leg type with which an architecture is evaluated fastest.
        macro_rules! with_leg {
            ($d architecture:expr, $d alias:ident => $d body:expr) => {
                match $d architecture {
                    $($crate::mechanism::Architecture::$fast => {
                        type $d alias = $crate::mechanism::fast::$fast;
                        $d body
                    })+
                    _ => {
                        type $d alias = $crate::mechanism::AnyLeg;
                        $d body
                    }
                }
            };
        }
    };
}

architectures! { $;
    fast {
        /// Driven slider on a rail of the base, followed by a link.
        Prr "3-PRR" PrrChain 0,
        /// Driven telescopic leg between two passive revolute joints.
        Rpr "3-RPR" RprChain 1,
        /// Driven crank, followed by a link.
        Rrr "3-RRR" RrrChain 0,
    }
    others {
        /// Crank and link, driven between them.
        RrrSecond "3-R_RR" RrrChain 1,
        /// Crank and link, driven at the platform.
        RrrThird "3-RR_R" RrrChain 2,
        /// Driven crank with a carriage on a guide of the platform.
        RrpFirst "3-_RRP" RrpChain 0,
        /// Crank with a carriage on a guide of the platform, driven between them.
        RrpSecond "3-R_RP" RrpChain 1,
        /// Crank with a driven carriage on a guide of the platform.
        RrpThird "3-RR_P" RrpChain 2,
        /// Telescopic leg, turned at the base.
        RprFirst "3-_RPR" RprChain 0,
        /// Telescopic leg, turned at the platform.
        RprThird "3-RP_R" RprChain 2,
        /// Slider and link, driven between them.
        PrrSecond "3-P_RR" PrrChain 1,
        /// Slider and link, driven at the platform.
        PrrThird "3-PR_R" PrrChain 2,
        /// Guide that turns about the base joint, with a driven carriage that also runs on a guide of the platform.
        RppSecond "3-R_PP" RppChain 1,
        /// Guide that turns about the base joint, with a carriage that is driven along a guide of the platform.
        RppThird "3-RP_P" RppChain 2,
        /// Driven slider with a carriage on a guide of the platform.
        PrpFirst "3-_PRP" PrpChain 0,
        /// Slider with a carriage that is driven along a guide of the platform.
        PrpThird "3-PR_P" PrpChain 2,
        /// Driven slider that carries a guide.
        PprFirst "3-_PPR" PprChain 0,
        /// Slider that carries a guide with a driven carriage.
        PprSecond "3-P_PR" PprChain 1,
    }
}

// Below the macro `visit!`, which it uses.
mod any_leg;

impl Architecture {
    /// Returns the letters of the joints, for example `PRR`.
    pub fn chain_name(self) -> &'static str {
        self.chain().name
    }

    /// Returns the name with `_` before the actuated joint, for example `3-_PRR`.
    pub fn marked_name(self) -> String {
        let (before, after) = self.chain_name().split_at(self.driven());
        format!("3-{before}_{after}")
    }

    /// Returns the name with the actuated joint underlined by U+0332.
    pub fn underlined_name(self) -> String {
        let (before, after) = self.chain_name().split_at(self.driven() + 1);
        format!("3-{before}\u{332}{after}")
    }

    /// Returns whether the inverse kinematics has two solutions per leg, so that a working mode has to be set.
    pub fn has_working_modes(self) -> bool {
        self.chain().has_working_modes
    }

    /// Returns the number of moving bars per leg: one (`n` = 3 in the formula of the mass) or two (`n` = 6).
    pub fn bars_per_leg(self) -> usize {
        1 + usize::from(self.chain().has_proximal_bar)
    }

    /// Returns the variables that the chain has beyond those of every architecture.
    pub fn further_variables(self) -> &'static [DesignVariable] {
        self.chain().variables
    }

    /// Returns whether the designs of this architecture have a variable: the five dimensions, or one of its chain.
    pub fn has(self, variable: DesignVariable) -> bool {
        !FURTHER_VARIABLES.contains(&variable) || self.further_variables().contains(&variable)
    }

    /// Returns the kind of the actuated joint.
    pub fn actuator(self) -> JointKind {
        self.chain().joints[self.driven()]
    }

    /// Returns the longest lever that a driven revolute joint may have \[m\]: the length of the bar next to it.
    pub fn longest_lever(self, design: &Design) -> f64 {
        let chain = self.chain();
        let reaches = |point: JointPoint| chain.points[self.driven()] == point;
        let is_proximal = reaches(JointPoint::A) || (chain.distal == MemberKind::Guide && reaches(JointPoint::B));
        if chain.has_proximal_bar && is_proximal {
            design.proximal_length()
        } else {
            design.link_length()
        }
    }

    /// Returns a distance from `O` beyond which no point `P` can be reached by all legs of any design of the paper's geometry with a
    /// base radius of at least `base`, and with platform radii and lengths of at most those given \[m\]. `lengths` holds `L_a` and
    /// `L_b`.
    pub fn farthest_reach(self, base: f64, platform: f64, lengths: [f64; 2]) -> f64 {
        let chain = self.chain();
        let of_proximal = if chain.has_proximal_bar { lengths[0] } else { 0.0 };
        let reach = of_proximal + lengths[1] + platform;
        if chain.is_on_rails() {
            // The rails are the sides of the base triangle; that farthest from `P` is at least (base + |OP|)/2 away.
            return (2.0 * reach - base).max(0.0);
        }
        // The farthest of the three base joints is at least √(|OP|² + R² + |OP|·R) away.
        (libm::sqrt((4.0 * reach * reach - 3.0 * base * base).max(0.0)) - base).max(0.0) * 0.5
    }
}

impl std::fmt::Display for Architecture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}
