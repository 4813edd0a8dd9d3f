//! What threads share: the types of the standard library, which the test of all interleavings replaces.

pub use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
