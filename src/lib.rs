//! # Kinefront
//!
//! A design explorer for planar parallel manipulators. It searches for 3-PRR, 3-RPR and 3-RRR designs that are light
//! **and** have a large regular dexterous workspace.
//!
//! Data flows one way: **[`study`] → [`kinefront_optimize`] → evaluated designs → [`recording`], run folder**. The model
//! itself is the crate [`kinefront_model`]; a study builds it and runs an algorithm on it:
//!
//! ```
//! use std::sync::Arc;
//! use std::sync::mpsc::sync_channel;
//!
//! use kinefront::study::{Event, RunControl, Study, spawn};
//!
//! let study = Study::parse("architectures = [\"3-PRR\"]\n[optimizer]\nevaluations = 60", "mine")?;
//! let (sender, events) = sync_channel(64);
//! let worker = spawn(study, Arc::new(RunControl::default()), vec![sender])?;
//! let mut evaluated = 0;
//! for event in events {
//!     match &*event {
//!         Event::Evaluated(batch) => evaluated += batch.rows.len(),
//!         Event::Finished(summary) => assert!(summary.front.len() > 1),
//!         _ => {}
//!     }
//! }
//! worker.join().expect("the worker ends");
//! assert_eq!(evaluated, 60);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | module | purpose |
//! |---|---|
//! | [`study`] | study files, runs, tables and run folders |
//! | [`scene`] | named shapes and fields of a design at a pose, independent of any renderer |
//! | [`export`] | export of a design to the file formats of other programs |
//! | [`report`] | report pages of a run: figures, pictures, comparison with the paper |
//! | [`palette`] | colours and their meaning |
//! | [`recording`] | conversion of events to Rerun recordings |
//! | [`signals`] | signals that ask the program to end |
//! | [`text`] | formatting of numbers for display |
//! | `explorer` | the application window (feature `explorer`) |

#[cfg(feature = "explorer")]
pub mod explorer;
pub mod recording;
pub mod report;
pub mod signals;

pub use kinefront_export as export;
pub use kinefront_scene as scene;
pub use kinefront_scene::{palette, text};
pub use kinefront_study as study;

pub(crate) use kinefront_export::AnyError;
