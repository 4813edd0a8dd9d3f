//! # Kinefront: the model
//!
//! Kinematics, stiffness, clearance and regular workspace of the planar parallel manipulators 3-PRR, 3-RPR and 3-RRR.
//! `docs/model.md` in the repository derives every formula.
//!
//! ## A design and its evaluation
//!
//! ```
//! use kinefront_model::evaluation::{Constraint, GridChoice, Model};
//! use kinefront_model::mechanism::Design;
//!
//! let design: Design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056".parse()?;
//! let evaluation = Model::default().evaluate(&design, GridChoice::Fine);
//! assert!((evaluation.mass - 479.47).abs() < 0.01);
//! assert!((evaluation.workspace_radius - 1.2211).abs() < 1e-4);
//! assert!(evaluation.active().any(|constraint| constraint == Constraint::StiffnessXy));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## A design at a pose
//!
//! ```
//! use kinefront_model::evaluation::Model;
//! use kinefront_model::spatial::Pose;
//! # let design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056".parse()?;
//!
//! let model = Model::default();
//! let found = model.pose(&design, &Pose::new(0.1, 0.2, 0.5))?;
//! assert!(found.inverse_condition > 0.1 && found.stiffness_values.k_xy > 1e6);
//! let unreachable = model.pose(&design, &Pose::new(9.0, 0.0, 0.0)).expect_err("too far");
//! assert!(unreachable.to_string().starts_with("leg "));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Other assumptions
//!
//! ```
//! use kinefront_model::evaluation::{GridChoice, Model, ModelSettings};
//! # let design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056".parse()?;
//!
//! let mut settings = ModelSettings::default();
//! settings.actuators.prismatic = 0.5e7;
//! let softer = Model::new(settings)?.evaluate(&design, GridChoice::Reference);
//! let paper = Model::default().evaluate(&design, GridChoice::Reference);
//! assert!(softer.workspace_radius < paper.workspace_radius);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Code for every architecture
//!
//! Code that needs the leg type is written over [`L: Leg`](mechanism::Leg) and entered with [`with_leg!`]:
//!
//! ```
//! use kinefront_model::mechanism::{Design, Leg, LegSettings, Manipulator};
//! use kinefront_model::spatial::Pose;
//! use kinefront_model::with_leg;
//!
//! fn reaches<L: Leg>(design: &Design, pose: &Pose) -> bool {
//!     Manipulator::<L>::new(design, &LegSettings::default()).posture(pose).is_ok()
//! }
//!
//! let design: Design = "3-RRR R=1.5 r=0.5 Lb=1.2 rj=0.02 rp=0.02".parse()?;
//! assert!(with_leg!(design.architecture, L => reaches::<L>(&design, &Pose::new(0.0, 0.0, 0.0))));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Code that only needs values at poses asks [`Model::pose_evaluator`](evaluation::Model::pose_evaluator), which hides the leg type.
//!
//! | module | purpose |
//! |---|---|
//! | [`lanes`] | arithmetic on one number or on several at once |
//! | [`spatial`] | poses, planar vectors, notation and frames |
//! | [`mechanism`] | architectures, designs, inverse kinematics |
//! | [`kinematics`] | Jacobian, dexterity, forward kinematics |
//! | [`stiffness`] | stiffness of bars, legs and platform: closed form, and the 6×6 form as its reference |
//! | [`clearance`] | clearance between the members |
//! | [`workspace`] | regular workspace of a design |
//! | [`evaluation`] | evaluation of a design: objectives, constraints, margins |
//! | [`enclosure`] | enclosures of real functions over boxes |
//! | [`certify`] | proofs that every pose of a disc is feasible |

#[macro_use]
pub mod mechanism;

pub mod certify;
pub mod clearance;
pub mod enclosure;
pub mod evaluation;
pub mod kinematics;
pub mod lanes;
pub mod spatial;
pub mod stiffness;
pub mod workspace;
