//! Which designs the table lists, and in which order.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::entry;
use crate::{Filter, FrontEntry, Session, theme};
use kinefront_model::evaluation::{Constraint, Quantity};
use kinefront_study::Column;

/// Column by which the table is sorted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum SortKey {
    Star,
    Id,
    Architecture,
    Number(Column),
}

/// What the table lists, and in which order.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Listing {
    /// Whether it lists the marked designs instead of the front.
    pub marked: bool,
    pub key: SortKey,
    pub descending: bool,
    pub search: String,
    pub starred_only: bool,
}

impl Default for Listing {
    fn default() -> Self {
        Self {
            marked: false,
            key: SortKey::Number(Column::Quantity(Quantity::Mass)),
            descending: false,
            search: String::new(),
            starred_only: false,
        }
    }
}

/// The listed designs in their order. It is kept from frame to frame, because a million designs may be marked.
#[derive(Default)]
pub(super) struct Order {
    of: Option<Basis>,
    ids: Vec<usize>,
}

/// What the order follows from.
#[derive(PartialEq)]
struct Basis {
    listing: Listing,
    era: u64,
    front: u64,
    filter: Filter,
    marked: Arc<Vec<usize>>,
    stars: BTreeSet<usize>,
    notes: BTreeMap<usize, String>,
}

impl Order {
    /// Returns the ids of the listed designs.
    pub fn ids(&self) -> &[usize] {
        &self.ids
    }

    /// Lists and sorts the designs anew if anything has changed that the order follows from.
    pub fn update(&mut self, session: &Session, listing: &Listing) {
        let document = session.document();
        let basis = Basis {
            listing: listing.clone(),
            era: session.era(),
            front: session.front_number(),
            filter: document.filter.clone(),
            marked: Arc::clone(&document.marked),
            stars: document.stars.clone(),
            notes: document.notes.clone(),
        };
        if self.of.as_ref() == Some(&basis) {
            return;
        }
        let all: Vec<usize> = if listing.marked {
            let prepared = document.filter.prepare(session.store());
            document
                .marked
                .iter()
                .copied()
                .filter(|&id| prepared.passes(id))
                .collect()
        } else {
            let passing = session.passing().into_iter();
            passing.map(|place| session.front()[place].id).collect()
        };
        let mut found: Vec<(f64, usize)> = all
            .into_iter()
            .filter(|id| !listing.starred_only || document.stars.contains(id))
            .filter(|&id| listing.finds(session, id))
            .map(|id| (listing.key.number(session, id), id))
            .collect();
        found.sort_by(|a, b| {
            let by_number = a.0.total_cmp(&b.0);
            let in_direction = if listing.descending {
                by_number.reverse()
            } else {
                by_number
            };
            a.0.is_nan().cmp(&b.0.is_nan()).then(in_direction)
        });
        self.ids = found.into_iter().map(|(_, id)| id).collect();
        self.of = Some(basis);
    }
}

impl Listing {
    /// Returns whether the search finds a design: in its text, its id, its active constraints, or its note.
    fn finds(&self, session: &Session, id: usize) -> bool {
        let search = self.search.trim().to_lowercase();
        if search.is_empty() {
            return true;
        }
        let Some(entry) = entry(session, id) else {
            return false;
        };
        let note = session.document().notes.get(&id);
        entry.row.design.to_string().to_lowercase().contains(&search)
            || format!("#{id}").contains(&search)
            || active(&entry).contains(&search)
            || note.is_some_and(|note| note.to_lowercase().contains(&search))
    }
}

impl SortKey {
    /// Returns the number by which a design is sorted; designs without one come last.
    fn number(self, session: &Session, id: usize) -> f64 {
        match self {
            Self::Star => f64::from(u8::from(!session.document().stars.contains(&id))),
            Self::Id => id as f64,
            Self::Architecture => session
                .row(id)
                .map_or(f64::NAN, |row| theme::index(row.design.architecture()) as f64),
            Self::Number(quantity) => session.number(id, quantity).unwrap_or(f64::NAN),
        }
    }
}

/// Returns the ids of the active constraints of a design.
pub(super) fn active(entry: &FrontEntry) -> String {
    let ids: Vec<&str> = entry.row.active.iter().map(Constraint::id).collect();
    ids.join(" ")
}
