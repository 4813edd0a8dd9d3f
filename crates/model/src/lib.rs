//! # Kinefront: the model
//!
//! Kinematics, stiffness, clearance and regular workspace of the planar parallel manipulators with three legs of one type: 18
//! architectures of seven chains.
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
//! assert!((evaluation.mass() - 479.47).abs() < 0.01);
//! assert!((evaluation.workspace_radius() - 1.2211).abs() < 1e-4);
//! assert!(evaluation.active().any(|constraint| constraint == Constraint::StiffnessXy));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## A design at a pose
//!
//! ```
//! use kinefront_model::evaluation::{Model, PoseScalar};
//! use kinefront_model::spatial::Pose;
//! # let design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056".parse()?;
//!
//! let model = Model::default();
//! let found = model.pose(&design, &Pose::new(0.1, 0.2, 0.5))?;
//! assert!(found.values[PoseScalar::Dexterity] > 0.1 && found.values[PoseScalar::StiffnessXy] > 1e6);
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
//! assert!(softer.workspace_radius() < paper.workspace_radius());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Many poses
//!
//! The loops over poses are compiled for each kind of legs and for each instruction set, once, in this crate. Other code reaches them
//! through [`Model::pose_evaluator`](evaluation::Model::pose_evaluator), whatever the legs are:
//!
//! ```
//! use glam::DVec2;
//! use kinefront_model::evaluation::{Model, PoseScalar};
//! use kinefront_model::spatial::Rotation;
//! # let design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056".parse()?;
//!
//! let evaluator = Model::default().pose_evaluator(&design);
//! let arms = evaluator.arms(&Rotation::new(0.5));
//! let values = evaluator.evaluate_position(&arms, DVec2::new(0.1, 0.2)).expect("within reach");
//! assert!(values[PoseScalar::StiffnessXy] > 1e6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | module | purpose |
//! |---|---|
//! | [`lanes`] | arithmetic on one number or on several at once |
//! | [`spatial`] | poses, planar vectors, notation and frames |
//! | [`polygon`] | simple polygons |
//! | [`mechanism`] | architectures, designs, inverse kinematics |
//! | [`kinematics`] | Jacobian, dexterity, forward kinematics |
//! | [`stiffness`] | stiffness of bars, legs and platform: closed form, and the 6×6 form as its reference |
//! | [`strength`] | stress, buckling, and the forces of joints and drives |
//! | [`dynamics`] | payload and motion: forces of the actuators, natural frequencies, error of the pose |
//! | [`clearance`] | clearance between the members |
//! | [`workspace`] | regular workspace of a design |
//! | [`evaluation`] | evaluation of a design: objectives, constraints, margins |
//! | [`enclosure`] | enclosures of real functions over boxes |
//! | [`workers`] | threads of a caller for one evaluation |
//! | [`certify`] | proofs that every pose of a disc is feasible |

#[macro_use]
pub mod mechanism;

pub mod certify;
pub mod clearance;
pub mod dynamics;
pub mod enclosure;
pub mod evaluation;
pub mod kinematics;
pub mod lanes;
pub mod polygon;
mod pose;
pub mod spatial;
pub mod stiffness;
pub mod strength;
pub mod workers;
pub mod workspace;
