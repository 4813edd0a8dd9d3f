//! Members of a population with their rank and crowding, and the tournament that these decide (Deb et al. 2002).

use std::cmp::Ordering;

use super::dominance::{crowding_distances, non_dominated_ranks};
use super::random::Random;
use super::{Evaluated, Outcome};

/// A member of a population.
#[derive(Debug, Clone)]
pub struct Member {
    pub candidate: Evaluated,
    /// 0 for the non-dominated ones.
    pub rank: usize,
    /// Crowding distance within its rank.
    pub crowding: f64,
}

/// Ranks a population.
pub fn ranked(candidates: Vec<Evaluated>) -> Vec<Member> {
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
        .map(|((candidate, rank), crowding)| Member {
            candidate,
            rank,
            crowding,
        })
        .collect()
}

/// The better of two drawn members by rank, then crowding, then a coin.
pub fn tournament(random: &mut Random, population: &[Member]) -> usize {
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

/// Keeps the best `size` by rank. The last rank that fits is thinned by crowding, which is counted anew after each that
/// leaves, so that what stays is evenly spread.
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
