//! # Kinefront
//!
//! A design explorer for planar parallel manipulators: which 3-PRR, 3-RPR and 3-RRR are light **and** have a large
//! regular dexterous workspace.
//!
//! Data flows one way: **[`study`] → [`kinefront_optimize`] → evaluated designs → [`recording`], run folder**. What a design is
//! worth is one call:
//!
//! ```
//! use kinefront_model::evaluation::{GridChoice, Model};
//!
//! let design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056".parse()?;
//! let evaluation = Model::default().evaluate(&design, GridChoice::Reference)?;
//! println!("{:.1} kg, R_w {:.3} m", evaluation.mass, evaluation.workspace_radius);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | module | purpose |
//! |---|---|
//! | [`scene`] | a design at a pose → named shapes and fields, free of any renderer |
//! | [`study`] | study file, run, run folder |
//! | [`export`] | a design as files of other programs |
//! | [`report`] | a run as pages: figures, pictures, comparison with the paper |
//! | [`palette`] | what colours mean |
//! | [`recording`] | events → Rerun |
//! | [`text`] | numbers for people |
//! | `explorer` | the window (feature `explorer`) |

#[cfg(feature = "explorer")]
pub mod explorer;
pub mod export;
pub mod palette;
pub mod recording;
pub mod report;
pub mod scene;
pub mod study;
pub mod text;
