//! Fronts and fits of reports.

mod fronts;
mod reports;
