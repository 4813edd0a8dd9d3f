//! The library of the program: studies, fronts, scenes, reports, and the dependencies between its modules.

mod fronts;
mod invariants;
mod reports;
mod scenes;
mod studies;
