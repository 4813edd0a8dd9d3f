//! The data of the window: the evaluated designs, the front, the filter, and the user's document.

mod document;
mod filter;
mod front;
mod history;
mod store;

pub use document::{DesignOrigin, Document, Named, Selected, Wished};
pub use filter::{Filter, FilterError, PreparedFilter};
pub use front::{FrontEntry, front_of};
pub use history::History;
pub use store::Store;
