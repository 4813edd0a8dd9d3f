//! The user's selection, pins, kept designs, stars, notes, marked designs and filter: everything that undo restores.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::Filter;
use kinefront_model::evaluation::Evaluation;
use kinefront_model::mechanism::Design;
use kinefront_study::CertifiedWorkspace;

/// Where a design comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum DesignOrigin {
    /// Evaluated by the run under this id.
    Evaluated(usize),
    /// Modified by hand from another design, or pasted as text.
    Modified {
        /// Id of the design of the run that it was modified from, if there is one.
        from: Option<usize>,
    },
    /// Kept earlier; the value is its index in [`Document::kept`].
    Kept(usize),
    /// The answer to a wish; the value is its index in [`Document::wished`].
    Wished(usize),
    /// A reference design of the study; the value is its index among the references.
    Reference(usize),
}

/// The selected design and its origin.
#[derive(Debug, Clone, PartialEq)]
pub struct Selected {
    /// The design.
    pub design: Design,
    /// Its origin.
    pub origin: DesignOrigin,
}

/// A design with a name.
#[derive(Debug, Clone, PartialEq)]
pub struct Named {
    /// Name of the design.
    pub name: String,
    /// The design.
    pub design: Design,
}

/// A design that answers a wish.
#[derive(Debug, Clone, PartialEq)]
pub struct Wished {
    /// Name of the design.
    pub name: String,
    /// Its evaluation on the fine grid.
    pub evaluation: Arc<Evaluation>,
    /// What is proved about its workspace.
    pub certified: Option<CertifiedWorkspace>,
}

/// The user's selection, pins, kept designs, answers to wishes, stars, notes, marked designs and filter.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Document {
    /// The selected design.
    pub selected: Option<Selected>,
    /// Pinned designs, which are compared.
    pub pins: Vec<Named>,
    /// Modified designs that the user has kept.
    pub kept: Vec<Named>,
    /// Designs that answer wishes.
    pub wished: Vec<Wished>,
    /// Starred designs of the run, by id.
    pub stars: BTreeSet<usize>,
    /// Notes on designs of the run, by id.
    pub notes: BTreeMap<usize, String>,
    /// Ids of the designs of the run that were enclosed in the scatter, in order.
    pub marked: Arc<Vec<usize>>,
    /// The filter.
    pub filter: Filter,
}

impl Document {
    /// Returns the id of the selected design, if it is one of the run.
    pub fn selected_id(&self) -> Option<usize> {
        match self.selected.as_ref()?.origin {
            DesignOrigin::Evaluated(id) => Some(id),
            _ => None,
        }
    }

    /// Returns the selected design.
    pub fn selected_design(&self) -> Option<Design> {
        self.selected.as_ref().map(|selected| selected.design)
    }
}
