//! Pareto dominance with constraints, non-dominated sorting and crowding (Deb et al. 2002).

use std::cmp::Ordering;

use super::Outcome;

/// Dominance relation of two outcomes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Relation {
    /// The first outcome is better.
    Dominates,
    /// The second outcome is better.
    Dominated,
    /// Neither is better: they are equal, or each is better in some objective.
    Incomparable,
}

/// Compares two outcomes by constraint domination: a feasible outcome dominates an infeasible one, of two infeasible
/// outcomes the one with the smaller violation dominates, and two feasible ones are compared by Pareto dominance.
pub fn compare(a: &Outcome, b: &Outcome) -> Relation {
    match (a.is_feasible(), b.is_feasible()) {
        (true, false) => Relation::Dominates,
        (false, true) => Relation::Dominated,
        (false, false) => match a.violation.total_cmp(&b.violation) {
            Ordering::Less => Relation::Dominates,
            Ordering::Greater => Relation::Dominated,
            Ordering::Equal => Relation::Incomparable,
        },
        (true, true) => pareto(&a.objectives, &b.objectives),
    }
}

/// Ranks feasible outcomes by the first objective, then infeasible ones by violation.
pub fn order(a: &Outcome, b: &Outcome) -> Ordering {
    let key = |outcome: &Outcome| (outcome.violation.max(0.0), outcome.objectives[0]);
    let ((violation_a, objective_a), (violation_b, objective_b)) = (key(a), key(b));
    violation_a
        .total_cmp(&violation_b)
        .then(objective_a.total_cmp(&objective_b))
}

/// Compares the minimised objectives of two candidates by Pareto dominance.
pub fn pareto(a: &[f64], b: &[f64]) -> Relation {
    let better = a.iter().zip(b).any(|(a, b)| a < b);
    let worse = a.iter().zip(b).any(|(a, b)| a > b);
    match (better, worse) {
        (true, false) => Relation::Dominates,
        (false, true) => Relation::Dominated,
        _ => Relation::Incomparable,
    }
}

/// Returns the rank of each outcome under [`compare`]: 0 for the non-dominated outcomes, 1 for those dominated only by
/// outcomes of rank 0, and so on.
pub fn non_dominated_ranks(outcomes: &[Outcome]) -> Vec<usize> {
    let count = outcomes.len();
    let mut dominated_by = vec![0usize; count];
    let mut dominates: Vec<Vec<usize>> = vec![Vec::new(); count];
    for i in 0..count {
        for j in i + 1..count {
            match compare(&outcomes[i], &outcomes[j]) {
                Relation::Dominates => {
                    dominates[i].push(j);
                    dominated_by[j] += 1;
                }
                Relation::Dominated => {
                    dominates[j].push(i);
                    dominated_by[i] += 1;
                }
                Relation::Incomparable => {}
            }
        }
    }
    let mut ranks = vec![0; count];
    let mut front: Vec<usize> = (0..count).filter(|&i| dominated_by[i] == 0).collect();
    let mut rank = 0;
    while !front.is_empty() {
        let mut next = Vec::new();
        for &i in &front {
            ranks[i] = rank;
            for &j in &dominates[i] {
                dominated_by[j] -= 1;
                if dominated_by[j] == 0 {
                    next.push(j);
                }
            }
        }
        next.sort_unstable();
        front = next;
        rank += 1;
    }
    ranks
}

/// Returns the crowding distance of each member of `front`: infinite at the ends, 0 for a member whose two neighbours
/// coincide with it.
pub fn crowding_distances(front: &[impl AsRef<[f64]>]) -> Vec<f64> {
    let front: Vec<&[f64]> = front.iter().map(AsRef::as_ref).collect();
    let mut distances = vec![0.0; front.len()];
    for objective in 0..front.first().map_or(0, |first| first.len()) {
        let mut order: Vec<usize> = (0..front.len()).collect();
        order.sort_by(|&a, &b| front[a][objective].total_cmp(&front[b][objective]).then(a.cmp(&b)));
        let (Some(&first), Some(&last)) = (order.first(), order.last()) else {
            return distances;
        };
        let range = front[last][objective] - front[first][objective];
        distances[first] = f64::INFINITY;
        distances[last] = f64::INFINITY;
        if range > 0.0 {
            for triple in order.windows(3) {
                distances[triple[1]] += (front[triple[2]][objective] - front[triple[0]][objective]) / range;
            }
        }
    }
    distances
}
