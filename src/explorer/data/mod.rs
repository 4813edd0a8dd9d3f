//! The data of the window: the evaluated designs, the front, the filter, and the user's document.

mod document;
mod filter;
mod front;
mod store;

pub use document::{Document, History, Named, Origin, Selected};
pub use filter::{Filter, FilterError, PreparedFilter};
pub use front::{FrontEntry, front_of};
pub use store::Store;
