//! The threads beside the window: the run with its listeners, the threads that evaluate and draw the selected design, and those that
//! answer questions about designs.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

mod answering;
mod intake;
mod mailbox;
mod questions;
mod run;
mod scene;

pub use answering::AnsweringThread;
pub use intake::{Intake, RunMessages};
pub use questions::{
    AlongQuestion, DriversQuestion, FollowedMotion, HindrancesQuestion, MotionAnswer, MotionQuestion, StudyOfRun,
    WhyQuestion, WishQuestion,
};
pub use run::{Running, Writing};
pub use scene::{Answer, Known, MotionShown, Request, SceneThread};

/// Wakes the window when there is something new to show.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// Locks what threads share. It is as good as before where one of them has ended in a panic.
fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
