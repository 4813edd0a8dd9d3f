//! The front as the window shows it.

use std::sync::Arc;

use kinefront_model::evaluation::Evaluation;
use kinefront_optimize::{Archive, Objectives, Outcome};
use kinefront_study::Row;
use kinefront_study::{CertifiedWorkspace, FrontMember, TableRow};

/// A non-dominated design.
#[derive(Debug, Clone, PartialEq)]
pub struct FrontEntry {
    /// Id of its evaluation.
    pub id: usize,
    /// Its values; from the fine grid if `verified`.
    pub row: Row,
    /// `R_w` on the reference grid \[m\].
    pub reference_radius: f64,
    /// Whether it was evaluated on the fine grid.
    pub verified: bool,
    /// What is proved about `R_w`.
    pub certified: Option<CertifiedWorkspace>,
    /// Its evaluation on the fine grid, if the run is in the window; a table holds no evaluations.
    pub evaluation: Option<Arc<Evaluation>>,
}

impl FrontEntry {
    /// Makes the entry of a design of the verified front of a run.
    pub fn of_member(member: &FrontMember) -> Self {
        Self {
            id: member.id,
            row: Row::new(member.generation, &member.evaluation),
            reference_radius: member.reference_radius,
            verified: true,
            certified: member.certified,
            evaluation: Some(Arc::new(member.evaluation.clone())),
        }
    }

    /// Makes the entry of a row of a table; the row is `verified` if it states the values of the fine grid.
    pub fn of_row(entry: &TableRow, verified: bool) -> Self {
        Self {
            id: entry.id,
            row: entry.row,
            reference_radius: entry.reference_radius.unwrap_or(entry.row.workspace_radius()),
            verified,
            certified: entry.certified,
            evaluation: None,
        }
    }

    /// Makes the entry of a design of the search.
    pub fn of_search(id: usize, row: Row) -> Self {
        Self {
            id,
            reference_radius: row.workspace_radius(),
            row,
            verified: false,
            certified: None,
            evaluation: None,
        }
    }

    /// Returns the entry as a row of a table.
    pub fn to_table_row(&self) -> TableRow {
        TableRow {
            reference_radius: Some(self.reference_radius),
            certified: self.certified,
            ..TableRow::new(self.id, self.row)
        }
    }

    /// Returns the objectives, as they are minimised.
    pub fn objectives(&self) -> Objectives {
        self.row.objectives
    }
}

/// Returns the non-dominated designs of a store, sorted by the first objective, with the values in the store.
pub fn front_of(store: &super::Store) -> Vec<FrontEntry> {
    let mut archive = Archive::default();
    for id in (0..store.len()).filter(|&id| store.is_feasible(id)) {
        let outcome = Outcome {
            objectives: store.objectives(id),
            violation: 0.0,
        };
        archive.insert(id, &[], &outcome);
    }
    let members = archive
        .iter()
        .filter_map(|member| Some(FrontEntry::of_search(member.id, store.row(member.id)?)));
    members.collect()
}
