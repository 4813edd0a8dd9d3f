//! The archive of all non-dominated feasible candidates found so far.

use std::ops::Deref;

use super::Evaluated;

/// A member of the archive.
#[derive(Debug, Clone, PartialEq)]
pub struct ArchiveMember {
    /// Number of its evaluation, counted from 0.
    pub id: usize,
    /// Values of its variables.
    pub x: Vec<f64>,
    /// Values of its objectives.
    pub objectives: [f64; 2],
}

/// Non-dominated feasible candidates in ascending order of the first objective, which makes the second objective
/// strictly descending. The archive dereferences to a slice of its [`ArchiveMember`]s.
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
    pub fn insert(&mut self, id: usize, candidate: &Evaluated) -> bool {
        if !candidate.outcome.is_feasible() {
            return false;
        }
        let [first, second] = candidate.outcome.objectives;
        // The first objective of every member before `place` is at most `first`.
        let place = self.members.partition_point(|member| member.objectives[0] <= first);
        if place > 0 && self.members[place - 1].objectives[1] <= second {
            return false;
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
        let member = ArchiveMember {
            id,
            x: candidate.x.clone(),
            objectives: [first, second],
        };
        self.members.splice(start..place + run, [member]);
        true
    }
}
