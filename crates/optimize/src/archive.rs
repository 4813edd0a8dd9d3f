//! The archive of all non-dominated feasible candidates found so far.

use std::ops::Deref;

use super::dominance::{Relation, pareto};
use super::{Objectives, Outcome};

/// A member of the archive.
#[derive(Debug, Clone, PartialEq)]
pub struct ArchiveMember {
    /// Number of its evaluation, counted from 0.
    pub id: usize,
    /// Values of its variables.
    pub x: Vec<f64>,
    /// Values of its objectives.
    pub objectives: Objectives,
}

/// Non-dominated feasible candidates in ascending order of the first objective; with two objectives the second one is therefore
/// strictly descending, and with one objective there is a single member. The archive dereferences to a slice of its
/// [`ArchiveMember`]s.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Archive {
    members: Vec<ArchiveMember>,
}

impl Deref for Archive {
    type Target = [ArchiveMember];

    fn deref(&self) -> &[ArchiveMember] {
        &self.members
    }
}

impl Archive {
    /// Inserts evaluation `id` if it is feasible and no member of the archive dominates or equals it, and removes the
    /// members that it dominates. Returns whether the archive changed.
    pub fn insert(&mut self, id: usize, x: &[f64], outcome: &Outcome) -> bool {
        if !outcome.is_feasible() {
            return false;
        }
        let objectives = &outcome.objectives;
        let first = objectives[0];
        // The first objective of every member before `place` is at most `first`.
        let place = self.members.partition_point(|member| member.objectives[0] <= first);
        let start = match objectives.len() {
            2 => self.make_room(place, objectives),
            _ => self.make_room_among_all(objectives),
        };
        let Some(start) = start else { return false };
        let member = ArchiveMember {
            id,
            x: x.to_vec(),
            objectives: *objectives,
        };
        self.members.insert(start, member);
        true
    }

    /// Removes the members that a candidate of two objectives dominates; `place` is that behind the members whose first objective
    /// is no larger. Returns the place of the candidate; `None` if it is dominated or equalled.
    fn make_room(&mut self, place: usize, objectives: &[f64]) -> Option<usize> {
        let (first, second) = (objectives[0], objectives[1]);
        if place > 0 && self.members[place - 1].objectives[1] <= second {
            return None;
        }
        // The candidate dominates a member with an equal first objective (which is the one just before `place`) and the
        // run of members from `place` on whose second objective is not smaller.
        let start = if place > 0 && self.members[place - 1].objectives[0] == first {
            place - 1
        } else {
            place
        };
        let run = self.members[place..]
            .iter()
            .take_while(|member| member.objectives[1] >= second)
            .count();
        self.members.drain(start..place + run);
        Some(start)
    }

    /// As [`Archive::make_room`] for any number of objectives, by comparing all members.
    fn make_room_among_all(&mut self, objectives: &[f64]) -> Option<usize> {
        let stays = |member: &ArchiveMember| {
            pareto(&member.objectives, objectives) == Relation::Dominates || *member.objectives == *objectives
        };
        if self.members.iter().any(stays) {
            return None;
        }
        self.members
            .retain(|member| pareto(objectives, &member.objectives) != Relation::Dominates);
        Some(
            self.members
                .partition_point(|member| member.objectives[0] <= objectives[0]),
        )
    }
}
