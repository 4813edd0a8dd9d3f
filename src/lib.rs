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
//! | [`scene`] | named shapes and fields of a design at a pose, independent of any renderer |
//! | [`study`] | study files, runs, run folders |
//! | [`export`] | export of a design to the file formats of other programs |
//! | [`report`] | report pages of a run: figures, pictures, comparison with the paper |
//! | [`palette`] | colours and their meaning |
//! | [`recording`] | conversion of events to Rerun recordings |
//! | [`text`] | formatting of numbers for display |
//! | `explorer` | the application window (feature `explorer`) |

#[cfg(feature = "explorer")]
pub mod explorer;
pub mod export;
pub mod palette;
pub mod recording;
pub mod report;
pub mod scene;
pub mod study;
pub mod text;
