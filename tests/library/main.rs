//! The library of the program: studies, fronts, scenes, reports, and the dependencies between its modules.

mod control;
mod fronts;
mod invariants;
// The tests of the model introduce faults into the oracle on purpose; here it is used without.
#[allow(dead_code)]
#[path = "../../crates/model/tests/model/oracle.rs"]
mod oracle;
mod reports;
mod robustness;
mod scenes;
mod studies;
