//! Members of a population with their rank and crowding distance, and the tournament selection that uses both (Deb et
//! al. 2002).

use std::cmp::Ordering;

use super::dominance::{crowding_distances, non_dominated_ranks};
use super::random::Random;
use super::{Evaluated, Outcome};

/// A member of a population.
#[derive(Debug, Clone)]
pub struct PopulationMember {
    pub candidate: Evaluated,
    /// Non-domination rank, 0 for a non-dominated member.
    pub rank: usize,
    /// Crowding distance among the members of the same rank.
    pub crowding: f64,
}

/// Determines the rank and the crowding distance of each candidate.
pub fn ranked(candidates: Vec<Evaluated>) -> Vec<PopulationMember> {
    let outcomes: Vec<Outcome> = candidates.iter().map(|candidate| candidate.outcome).collect();
    let ranks = non_dominated_ranks(&outcomes);
    let mut crowding = vec![0.0; outcomes.len()];
    for rank in 0..=ranks.iter().copied().max().unwrap_or(0) {
        let front: Vec<usize> = (0..outcomes.len()).filter(|&i| ranks[i] == rank).collect();
        let objectives: Vec<[f64; 2]> = front.iter().map(|&i| outcomes[i].objectives).collect();
        for (&i, distance) in front.iter().zip(crowding_distances(&objectives)) {
            crowding[i] = distance;
        }
    }
    candidates
        .into_iter()
        .zip(ranks)
        .zip(crowding)
        .map(|((candidate, rank), crowding)| PopulationMember {
            candidate,
            rank,
            crowding,
        })
        .collect()
}

/// Draws two members and returns the place of the better one: by rank, then by crowding distance, then at random.
pub fn tournament(random: &mut Random, population: &[PopulationMember]) -> usize {
    let a = random.below(population.len());
    let b = random.below(population.len());
    let coin = random.chance(0.5);
    let (first, second) = (&population[a], &population[b]);
    let better = first
        .rank
        .cmp(&second.rank)
        .then(second.crowding.total_cmp(&first.crowding));
    match better {
        Ordering::Less => a,
        Ordering::Greater => b,
        Ordering::Equal if coin => a,
        Ordering::Equal => b,
    }
}

/// Keeps the best `size` candidates by rank. The first rank that does not fit completely is thinned: the member with
/// the smallest crowding distance is removed and the distances are recomputed until the rank fits, so that the
/// remaining members are evenly spread.
pub fn best(candidates: Vec<Evaluated>, size: usize) -> Vec<Evaluated> {
    let outcomes: Vec<Outcome> = candidates.iter().map(|candidate| candidate.outcome).collect();
    let ranks = non_dominated_ranks(&outcomes);
    let mut kept = vec![false; outcomes.len()];
    let mut count = 0;
    for rank in 0.. {
        let mut front: Vec<usize> = (0..outcomes.len()).filter(|&i| ranks[i] == rank).collect();
        if front.is_empty() || count == size {
            break;
        }
        while count + front.len() > size {
            let objectives: Vec<[f64; 2]> = front.iter().map(|&i| outcomes[i].objectives).collect();
            let distances = crowding_distances(&objectives);
            let crowded = (0..front.len()).min_by(|&a, &b| distances[a].total_cmp(&distances[b]));
            front.remove(crowded.unwrap_or(0));
        }
        count += front.len();
        for i in front {
            kept[i] = true;
        }
    }
    candidates
        .into_iter()
        .zip(kept)
        .filter_map(|(candidate, kept)| kept.then_some(candidate))
        .collect()
}
