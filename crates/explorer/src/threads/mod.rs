//! The threads beside the window: the run with its listeners, and the threads that evaluate and draw the selected design.

use std::sync::Arc;

mod drivers;
mod intake;
mod mailbox;
mod run;
mod scene;

pub use drivers::{DriversAnswer, DriversThread};
pub use intake::{Intake, RunMessages};
pub use run::{Running, Writing};
pub use scene::{Answer, Known, Request, SceneThread};

/// Wakes the window when there is something new to show.
pub type Wake = Arc<dyn Fn() + Send + Sync>;
