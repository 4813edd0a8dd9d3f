//! Members of a population with their rank and crowding distance, and the tournament selection that uses both (Deb et
//! al. 2002).

use std::cmp::Ordering;

use super::dominance::{crowding_distances, non_dominated_ranks};
use super::random::Random;
use super::selection::{scaled, squared_distance};
use super::{Evaluated, Objectives, Outcome};

/// A member of a population.
#[derive(Debug, Clone)]
pub struct PopulationMember {
    pub candidate: Evaluated,
    /// Non-domination rank, 0 for a non-dominated member.
    pub rank: usize,
    /// Crowding distance among the members of the same rank.
    pub crowding: f64,
}

/// Returns whether a population has a member with the given variables.
pub fn has_member(population: &[PopulationMember], x: &[f64]) -> bool {
    population.iter().any(|member| member.candidate.x == x)
}

/// Determines the rank and the crowding distance of each candidate.
pub fn ranked(candidates: Vec<Evaluated>) -> Vec<PopulationMember> {
    let outcomes: Vec<Outcome> = candidates.iter().map(|candidate| candidate.outcome).collect();
    let ranks = non_dominated_ranks(&outcomes);
    let mut crowding = vec![0.0; outcomes.len()];
    for rank in 0..=ranks.iter().copied().max().unwrap_or(0) {
        let front: Vec<usize> = (0..outcomes.len()).filter(|&i| ranks[i] == rank).collect();
        let objectives: Vec<Objectives> = front.iter().map(|&i| outcomes[i].objectives).collect();
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
/// remaining members are evenly spread. With three objectives, in which the crowding distance says little, the member nearest
/// to another one is removed instead.
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
        if count + front.len() > size && outcomes[front[0]].objectives.len() > 2 {
            let objectives: Vec<Objectives> = front.iter().map(|&i| outcomes[i].objectives).collect();
            let spread = thinned(&objectives, size - count);
            front = spread.into_iter().map(|place| front[place]).collect();
        }
        while count + front.len() > size {
            let objectives: Vec<Objectives> = front.iter().map(|&i| outcomes[i].objectives).collect();
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

/// Returns the places of `size` members of a front that remain when the member nearest to another one is removed repeatedly, the
/// one whose second nearest neighbour is nearer among the two (the truncation of SPEA2, Zitzler et al. 2001). The best member in
/// each objective stays.
fn thinned(front: &[Objectives], size: usize) -> Vec<usize> {
    let points = scaled(front);
    let mut left: Vec<usize> = (0..points.len()).collect();
    let is_best: Vec<bool> = (0..points.len()).map(|place| points[place].contains(&0.0)).collect();
    while left.len() > size {
        // The two smallest distances of each member.
        let nearest = |place: usize| {
            left.iter()
                .filter(|&&other| other != place)
                .fold([f64::INFINITY; 2], |[first, second], &other| {
                    let distance = squared_distance(&points[place], &points[other]);
                    if distance < first {
                        [distance, first]
                    } else {
                        [first, second.min(distance)]
                    }
                })
        };
        let candidates = left.iter().copied().filter(|&place| !is_best[place]);
        let crowded = candidates
            .map(|place| (place, nearest(place)))
            .min_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let Some((crowded, _)) = crowded else {
            left.truncate(size);
            break;
        };
        left.retain(|&place| place != crowded);
    }
    left
}
