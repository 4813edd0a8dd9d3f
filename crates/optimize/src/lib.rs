//! # Kinefront: the optimizers
//!
//! Constrained optimization of one to three objectives over real and categorical variables, independent of the manipulators.
//!
//! A [`Problem`] consists of its variables and an evaluation. An [`Algorithm`] has an ask-and-tell interface: it is asked for
//! candidates and told their outcomes. Its caller thus decides where candidates are evaluated, and can pause, stop or step
//! between generations. All objectives are minimised; the constraints are combined into a single violation, which is 0
//! for a feasible candidate. [`run`] drives an algorithm in the calling thread.
//!
//! ## Your own problem
//!
//! ```
//! use kinefront_optimize::{Nsga2, Nsga2Settings, Outcome, Problem, Variable, run};
//!
//! struct Schaffer;
//! impl Problem for Schaffer {
//!     fn variables(&self) -> Vec<Variable> {
//!         vec![Variable::Real { lower: -10.0, upper: 10.0 }]
//!     }
//!     fn evaluate(&self, x: &[f64]) -> Outcome {
//!         Outcome { objectives: [x[0] * x[0], (x[0] - 2.0) * (x[0] - 2.0)].into(), violation: 0.0 }
//!     }
//! }
//!
//! let mut algorithm = Nsga2::new(Schaffer.variables(), Nsga2Settings::default(), 1);
//! let archive = run(&Schaffer, &mut algorithm, 2000);
//! assert!(archive.iter().all(|member| (-0.1..2.1).contains(&member.x[0])));
//! ```
//!
//! ## Your own algorithm
//!
//! ```
//! use kinefront_optimize::{Algorithm, Candidate, Evaluated, Outcome, Problem, Variable, hypervolume, run, sobol};
//!
//! /// Samples the space evenly and learns nothing.
//! struct Sampling {
//!     points: Vec<Vec<f64>>,
//!     told: usize,
//! }
//!
//! impl Algorithm for Sampling {
//!     fn ask(&mut self) -> Vec<Candidate> {
//!         self.points.drain(..10).map(Candidate::from).collect()
//!     }
//!     fn tell(&mut self, evaluated: Vec<Evaluated>) {
//!         self.told += evaluated.len();
//!     }
//! }
//! # struct Schaffer;
//! # impl Problem for Schaffer {
//! #     fn variables(&self) -> Vec<Variable> {
//! #         vec![Variable::Real { lower: -10.0, upper: 10.0 }]
//! #     }
//! #     fn evaluate(&self, x: &[f64]) -> Outcome {
//! #         Outcome { objectives: [x[0] * x[0], (x[0] - 2.0) * (x[0] - 2.0)].into(), violation: 0.0 }
//! #     }
//! # }
//!
//! let mut algorithm = Sampling { points: sobol(&Schaffer.variables(), 200, 1), told: 0 };
//! let archive = run(&Schaffer, &mut algorithm, 200);
//! assert_eq!(algorithm.told, 200);
//! let front = archive.iter().map(|member| member.objectives);
//! assert!(hypervolume(front, [4.0, 4.0]) > 10.0);
//! ```
//!
//! | item | purpose |
//! |---|---|
//! | [`Problem`], [`Variable`], [`Objectives`], [`Outcome`], [`Target`] | what is optimized |
//! | [`Algorithm`], [`FrontDe`], [`CmaEs`], [`Nsga2`], [`Moga2`] | how it is optimized |
//! | [`Archive`], [`hypervolume()`], [`compare`] | what was found, and how good it is |
//! | [`knee`], [`spread`], [`ranking`], [`groups`], [`subset()`], [`gaps()`] | choosing from a front |

mod archive;
mod categories;
mod cma_es;
mod doe;
mod dominance;
mod front_de;
mod gaps;
mod hypervolume;
mod moga2;
mod nsga2;
mod population;
mod problem;
mod random;
mod run;
mod selection;
mod subset;
mod variation;

pub use archive::{Archive, ArchiveMember};
pub use cma_es::{CmaEs, CmaEsSettings};
pub use doe::sobol;
pub use dominance::{Relation, compare, crowding_distances, non_dominated_ranks};
pub use front_de::{FrontDe, FrontDeSettings};
pub use gaps::{Gap, added_share, gaps, halfway};
pub use hypervolume::hypervolume;
pub use moga2::{Moga2, Moga2Settings};
pub use nsga2::{Nsga2, Nsga2Settings};
pub use problem::{Algorithm, Candidate, Evaluated, Objectives, Outcome, Problem, Target, Variable};
pub use run::run;
pub use selection::{groups, knee, ranking, scaled, spread};
pub use subset::subset;
