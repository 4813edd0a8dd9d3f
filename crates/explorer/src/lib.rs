//! The window, which shows a run in progress, its designs, and the selected design in 3-D.
//!
//! ```text
//!  run thread ──events──► collector ──News──┐
//!      │                                    ▼            Request
//!      ├─► tables   (designs.csv, …)     Session ─────────────────► scene thread ──► viewer (in-process)
//!      └─► recorder (recording.rrd)         ▲ ▲                         │
//!                                           │ └─────── Answer ──────────┤
//!                                        panels                         └──► verify thread (fine grid)
//! ```
//!
//! No frame waits for a thread and no thread for a frame: messages are collected until a frame takes them, and only
//! the latest request is processed. [`Session`] is the complete state of the window, independent of any window; a
//! panel reads it and calls its methods to change it. No panel evaluates designs.

/// An error whose message is shown to the user.
type AnyError = Box<dyn std::error::Error + Send + Sync>;

mod app;
mod data;
mod eye;
mod files;
mod grip;
mod overlay;
mod panels;
mod platform_drag;
mod pointing;
mod session;
mod study_editor;
mod theme;
mod threads;
mod viewer;

pub use app::{AtEndSignals, Explorer, InitialContent, Script, ScriptError, run};
pub use data::{DesignOrigin, Document, Filter, FilterError, FrontEntry, History, Named, Selected, Store, Wished};
pub use eye::{Eye, SceneView};
pub use files::{OpenError, Opened, Purpose, open};
pub use kinefront_study::Row;
pub use panels::scatter::{ScatterAxis, axes};
pub use panels::{Panel, Panels};
pub use platform_drag::PlatformDrag;
pub use pointing::{Description, Pointed, describe};
pub use session::{
    Beside, MOST_PINS, MarkedCounts, Notice, Phase, PoseDynamics, ReferenceMark, Session, ShownVibration, Subject,
    ViewState, WhyPoint,
};
pub use study_editor::StudyEditor;
pub use theme::dress;
pub use threads::{Intake, Known, RunMessages, Wake};
