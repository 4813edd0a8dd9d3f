//! Selection among the members of a front: the knee, an evenly spread subset, a weighted ranking, groups of similar
//! members.
//!
//! A front is a slice of pairs of objectives, both minimised, in the order of the [archive](super::Archive): ascending
//! in the first objective, descending in the second. Each objective is scaled by its range over the front.

/// Returns the knee: the member farthest below the line between the two ends of the front, and among equals the first.
pub fn knee(front: &[[f64; 2]]) -> Option<usize> {
    smallest(scaled(front).iter().map(|[first, second]| first + second))
}

/// Selects at most `most` evenly spread members: both ends and the knee, then repeatedly the member farthest from those
/// already selected (Gonzalez 1985). The result is in the order of the front.
pub fn spread(front: &[[f64; 2]], most: usize) -> Vec<usize> {
    if front.len() <= most {
        return (0..front.len()).collect();
    }
    let points = scaled(front);
    let mut chosen = Vec::with_capacity(most);
    let mut distances = vec![f64::INFINITY; points.len()];
    let mut next = Some(0);
    while let Some(place) = next.filter(|_| chosen.len() < most) {
        chosen.push(place);
        for (distance, point) in distances.iter_mut().zip(&points) {
            *distance = distance.min(libm::hypot(point[0] - points[place][0], point[1] - points[place][1]));
        }
        next = match chosen.len() {
            1 => Some(points.len() - 1),
            2 => knee(front),
            _ => smallest(distances.iter().map(|distance| -distance)),
        };
    }
    chosen.sort_unstable();
    // The knee may be one of the ends.
    chosen.dedup();
    chosen
}

/// Sorts the members by their weighted distance to the ideal point, which combines the best values of both objectives;
/// the best member comes first.
///
/// `weight` in \[0, 1\] is the weight of the first objective: with 1 the first member ranks best, with 0 the last.
pub fn ranking(front: &[[f64; 2]], weight: f64) -> Vec<usize> {
    let weight = weight.clamp(0.0, 1.0);
    let distances: Vec<f64> = scaled(front)
        .iter()
        .map(|[first, second]| libm::hypot(weight * first, (1.0 - weight) * second))
        .collect();
    let mut order: Vec<usize> = (0..front.len()).collect();
    // The sort is stable: members at equal distance keep the order of the front.
    order.sort_by(|&a, &b| distances[a].total_cmp(&distances[b]));
    order
}

/// Splits the front into at most `count` groups of neighbours such that the sum of squared distances to the group means
/// is the smallest possible. On a front every optimal group is an interval, so dynamic programming finds the optimum.
/// Each group is returned as a range of members.
pub fn groups(front: &[[f64; 2]], count: usize) -> Vec<std::ops::Range<usize>> {
    let points = scaled(front);
    let n = points.len();
    let count = count.min(n);
    if count == 0 {
        return Vec::new();
    }
    // Prefix sums over the first k members make the cost of an interval a difference of two sums.
    let mut sums = vec![[0.0; 3]];
    for &[x, y] in &points {
        let [sx, sy, squares] = sums[sums.len() - 1];
        sums.push([sx + x, sy + y, squares + x * x + y * y]);
    }
    let cost = |from: usize, to: usize| {
        let [x, y, squares] = [0, 1, 2].map(|k| sums[to][k] - sums[from][k]);
        (squares - (x * x + y * y) / (to - from) as f64).max(0.0)
    };
    // best[k][to]: smallest cost of splitting the first `to` members into k + 1 groups, and the start of the last
    // group.
    let mut best: Vec<Vec<(f64, usize)>> = vec![
        (0..=n)
            .map(|to| if to == 0 { (0.0, 0) } else { (cost(0, to), 0) })
            .collect(),
    ];
    for k in 1..count {
        let before = &best[k - 1];
        let row = (0..=n)
            .map(|to| {
                (k..to)
                    .map(|from| (before[from].0 + cost(from, to), from))
                    .min_by(|a, b| a.0.total_cmp(&b.0))
                    .unwrap_or((f64::INFINITY, 0))
            })
            .collect();
        best.push(row);
    }
    let mut ranges = Vec::new();
    let mut to = n;
    for k in (0..count).rev() {
        let from = best[k][to].1;
        ranges.push(from..to);
        to = from;
    }
    ranges.reverse();
    ranges
}

/// Scales each objective to \[0, 1\], where 0 is the best value of the front and 1 the worst.
fn scaled(front: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let range = |k: usize| {
        front
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| {
                [low.min(point[k]), high.max(point[k])]
            })
    };
    let ranges = [range(0), range(1)];
    let fraction = |value: f64, [low, high]: [f64; 2]| if high > low { (value - low) / (high - low) } else { 0.0 };
    front
        .iter()
        .map(|point| [fraction(point[0], ranges[0]), fraction(point[1], ranges[1])])
        .collect()
}

/// Returns the index of the smallest number, the first among equals.
fn smallest(numbers: impl Iterator<Item = f64>) -> Option<usize> {
    numbers
        .enumerate()
        .fold(None, |best: Option<(usize, f64)>, (index, number)| match best {
            Some((_, least)) if least <= number => best,
            _ => Some((index, number)),
        })
        .map(|(index, _)| index)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a front of 11 members on a quarter circle that is convex towards the ideal point.
    fn front() -> Vec<[f64; 2]> {
        (0..=10)
            .map(|k| {
                let angle = std::f64::consts::FRAC_PI_2 * f64::from(k) / 10.0;
                [100.0 * (1.0 - libm::cos(angle)), 2.0 * (1.0 - libm::sin(angle))]
            })
            .collect()
    }

    #[test]
    fn the_knee_of_a_symmetric_front_is_its_middle() {
        assert_eq!(knee(&front()), Some(5));
        assert_eq!(knee(&[]), None);
        assert_eq!(knee(&[[3.0, 4.0]]), Some(0));
    }

    #[test]
    fn the_weight_moves_the_ranking_from_end_to_end() {
        let front = front();
        assert_eq!(ranking(&front, 1.0)[0], 0);
        assert_eq!(ranking(&front, 0.5)[0], 5);
        assert_eq!(ranking(&front, 0.0)[0], 10);
        let mut all = ranking(&front, 0.3);
        all.sort_unstable();
        assert_eq!(all, (0..11).collect::<Vec<_>>());
    }

    #[test]
    fn a_spread_has_the_ends_the_knee_and_no_crowd() {
        // The members crowd at one end of the front.
        let front: Vec<[f64; 2]> = (0..=200)
            .map(|k| {
                let fraction = libm::pow(f64::from(k) / 200.0, 3.0);
                [fraction, (1.0 - fraction) * (1.0 - fraction)]
            })
            .collect();
        let chosen = spread(&front, 12);
        assert_eq!(chosen.len(), 12);
        for member in [Some(0), Some(200), knee(&front)] {
            assert!(member.is_some_and(|member| chosen.contains(&member)));
        }
        let gaps: Vec<f64> = chosen
            .windows(2)
            .map(|pair| {
                libm::hypot(
                    front[pair[1]][0] - front[pair[0]][0],
                    front[pair[1]][1] - front[pair[0]][1],
                )
            })
            .collect();
        let (least, most) = (
            gaps.iter().copied().fold(f64::INFINITY, f64::min),
            gaps.iter().copied().fold(0.0, f64::max),
        );
        assert!(most < 2.5 * least, "{gaps:?}");
        assert_eq!(spread(&front, 500).len(), 201);
    }

    /// The points form three clusters, which must be the three groups.
    #[test]
    fn groups_are_the_best_split() {
        let points: Vec<[f64; 2]> = [0.0, 0.1, 0.15, 2.0, 2.2, 5.0, 5.1, 5.3].map(|x| [x, 6.0 - x]).to_vec();
        let found = groups(&points, 3);
        assert_eq!(found, vec![0..3, 3..5, 5..8]);
        assert_eq!(groups(&points, 100).len(), points.len());
        assert!(groups(&[], 3).is_empty());
    }
}
