//! All non-dominated feasible candidates seen so far.

use std::ops::Deref;

use super::Evaluated;

/// A member of the archive.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    /// Number of its evaluation, from 0.
    pub id: usize,
    /// Its variables.
    pub x: Vec<f64>,
    /// Its objectives.
    pub objectives: [f64; 2],
}

/// Non-dominated feasible candidates, sorted by the first objective: ascending in it, strictly descending in the
/// second. It derefs to a slice of its [`Member`]s.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Archive {
    members: Vec<Member>,
}

impl Deref for Archive {
    type Target = [Member];

    fn deref(&self) -> &[Member] {
        &self.members
    }
}

impl Archive {
    /// Takes in evaluation `id` if it is feasible and nothing in the archive dominates or equals it, and drops what it
    /// dominates. Tells whether the archive changed.
    pub fn insert(&mut self, id: usize, candidate: &Evaluated) -> bool {
        if !candidate.outcome.is_feasible() {
            return false;
        }
        let [first, second] = candidate.outcome.objectives;
        // Members before `place` are at most as large in the first objective.
        let place = self.members.partition_point(|member| member.objectives[0] <= first);
        if place > 0 && self.members[place - 1].objectives[1] <= second {
            return false;
        }
        // Dominated: an equal first objective (then just before `place`), and the run behind that is no better.
        let start = if place > 0 && self.members[place - 1].objectives[0] == first {
            place - 1
        } else {
            place
        };
        let run = self.members[place..]
            .iter()
            .take_while(|member| member.objectives[1] >= second)
            .count();
        let member = Member {
            id,
            x: candidate.x.clone(),
            objectives: [first, second],
        };
        self.members.splice(start..place + run, [member]);
        true
    }
}
