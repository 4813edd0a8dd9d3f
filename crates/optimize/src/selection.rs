//! Selection among the members of a front: the knee, an evenly spread subset, a weighted ranking, groups of similar
//! members.
//!
//! A front is a slice of objectives, all minimised, in the order of the [archive](super::Archive): ascending in the first
//! objective, and with two objectives descending in the second. Each objective is scaled by its range over the front.

/// Returns the knee: the member farthest below the line between the two ends of the front, or below the plane through the three
/// best values, and among equals the first.
pub fn knee(front: &[impl AsRef<[f64]>]) -> Option<usize> {
    smallest(scaled(front).iter().map(|point| point.iter().sum()))
}

/// Selects at most `most` evenly spread members: the best in each objective and the knee, then repeatedly the member farthest
/// from those already selected (Gonzalez 1985). The result is in the order of the front.
pub fn spread(front: &[impl AsRef<[f64]>], most: usize) -> Vec<usize> {
    if front.len() <= most {
        return (0..front.len()).collect();
    }
    let points = scaled(front);
    let mut chosen = Vec::with_capacity(most);
    let mut distances = vec![f64::INFINITY; points.len()];
    let mut first = bests(&points);
    first.extend(knee(front));
    let mut first = first.into_iter();
    while chosen.len() < most {
        let farthest = || smallest(distances.iter().map(|distance| -distance));
        let Some(place) = first.next().or_else(farthest) else {
            break;
        };
        chosen.push(place);
        for (distance, point) in distances.iter_mut().zip(&points) {
            *distance = distance.min(length(point, &points[place]));
        }
    }
    chosen.sort_unstable();
    // A member may be the best in two objectives, or the knee besides.
    chosen.dedup();
    chosen
}

/// Sorts the members by their weighted distance to the ideal point, which combines the best values of all objectives;
/// the best member comes first.
///
/// `weights` are those of the objectives, at least 0; an objective without a weight has the weight 0.
pub fn ranking(front: &[impl AsRef<[f64]>], weights: &[f64]) -> Vec<usize> {
    let distances: Vec<f64> = scaled(front)
        .iter()
        .map(|point| {
            let weighted = point.iter().zip(weights).map(|(fraction, weight)| fraction * weight);
            weighted.fold(0.0, libm::hypot)
        })
        .collect();
    let mut order: Vec<usize> = (0..front.len()).collect();
    // The sort is stable: members at equal distance keep the order of the front.
    order.sort_by(|&a, &b| distances[a].total_cmp(&distances[b]));
    order
}

/// Splits the front into at most `count` groups of neighbours such that the sum of squared distances to the group means
/// is the smallest possible. With up to two objectives every optimal group is an interval of the front, so that dynamic
/// programming finds the optimum; with three, Lloyd's iteration starts from evenly spread members and finds a local one.
/// Each group is returned as its members in the order of the front.
pub fn groups(front: &[impl AsRef<[f64]>], count: usize) -> Vec<Vec<usize>> {
    let points = scaled(front);
    match points.first().map_or(0, Vec::len) {
        0 => Vec::new(),
        1 | 2 => intervals(&points, count).into_iter().map(Iterator::collect).collect(),
        _ => clusters(&points, &spread(front, count.max(1))),
    }
}

/// Splits a front of up to two objectives into intervals.
fn intervals(points: &[Vec<f64>], count: usize) -> Vec<std::ops::Range<usize>> {
    let n = points.len();
    let count = count.min(n);
    if count == 0 {
        return Vec::new();
    }
    // Prefix sums over the first k members make the cost of an interval a difference of two sums.
    let mut sums = vec![[0.0; 3]];
    for point in points {
        let (x, y) = (point[0], point.get(1).copied().unwrap_or(0.0));
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

/// Assigns the members to the nearest of some centres, which move to the means of their members until nothing changes.
fn clusters(points: &[Vec<f64>], starts: &[usize]) -> Vec<Vec<usize>> {
    const ITERATIONS: usize = 100;
    let mut centres: Vec<Vec<f64>> = starts.iter().map(|&place| points[place].clone()).collect();
    let mut members: Vec<Vec<usize>> = Vec::new();
    for _ in 0..ITERATIONS {
        let mut next = vec![Vec::new(); centres.len()];
        for (place, point) in points.iter().enumerate() {
            let nearest = smallest(centres.iter().map(|centre| length(point, centre)));
            next[nearest.unwrap_or(0)].push(place);
        }
        if next == members {
            break;
        }
        members = next;
        for (centre, members) in centres
            .iter_mut()
            .zip(&members)
            .filter(|(_, members)| !members.is_empty())
        {
            for (k, coordinate) in centre.iter_mut().enumerate() {
                *coordinate = members.iter().map(|&place| points[place][k]).sum::<f64>() / members.len() as f64;
            }
        }
    }
    members.retain(|members| !members.is_empty());
    members.sort_by_key(|members| members[0]);
    members
}

/// Returns the best member in each objective, the first among equals; of the second of two objectives it is the last member.
pub(super) fn bests(points: &[impl AsRef<[f64]>]) -> Vec<usize> {
    let count = points.first().map_or(0, |first| first.as_ref().len());
    (0..count)
        .filter_map(|k| smallest(points.iter().map(|point| point.as_ref()[k])))
        .collect()
}

fn length(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |length, (a, b)| libm::hypot(length, a - b))
}

/// Returns the square of the distance of two points.
#[inline]
pub(super) fn squared_distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

/// Scales each objective to \[0, 1\], where 0 is the best value of the front and 1 the worst.
pub fn scaled(front: &[impl AsRef<[f64]>]) -> Vec<Vec<f64>> {
    let count = front.first().map_or(0, |first| first.as_ref().len());
    let range = |k: usize| {
        front
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| {
                let value = point.as_ref()[k];
                [low.min(value), high.max(value)]
            })
    };
    let ranges: Vec<[f64; 2]> = (0..count).map(range).collect();
    let fraction = |value: f64, [low, high]: [f64; 2]| if high > low { (value - low) / (high - low) } else { 0.0 };
    front
        .iter()
        .map(|point| {
            point
                .as_ref()
                .iter()
                .zip(&ranges)
                .map(|(value, range)| fraction(*value, *range))
                .collect()
        })
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
        assert_eq!(knee(&[[0.0; 2]; 0]), None);
        assert_eq!(knee(&[[3.0, 4.0]]), Some(0));
    }

    #[test]
    fn the_weight_moves_the_ranking_from_end_to_end() {
        let front = front();
        assert_eq!(ranking(&front, &[1.0, 0.0])[0], 0);
        assert_eq!(ranking(&front, &[0.5, 0.5])[0], 5);
        assert_eq!(ranking(&front, &[0.0, 1.0])[0], 10);
        let mut all = ranking(&front, &[0.3, 0.7]);
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
        assert_eq!(found, vec![vec![0, 1, 2], vec![3, 4], vec![5, 6, 7]]);
        assert_eq!(groups(&points, 100).len(), points.len());
        assert!(groups(&[[0.0; 2]; 0], 3).is_empty());
    }

    /// Three clusters of a front of three objectives are found, each about one corner; the knee lies in the middle.
    #[test]
    fn fronts_of_three_objectives_have_a_knee_corners_and_groups() {
        let mut front: Vec<[f64; 3]> = Vec::new();
        for k in 0..5 {
            let by = 0.01 * f64::from(k);
            front.extend([[by, 1.0 - by, 1.0], [1.0, by, 1.0 - by], [1.0 - by, 1.0, by]]);
        }
        let middle = front.len();
        front.push([0.4, 0.4, 0.4]);
        assert_eq!(knee(&front), Some(middle));
        let chosen = spread(&front, 4);
        assert_eq!(chosen, vec![0, 1, 2, middle]);
        let found = groups(&front, 4);
        assert_eq!(found.len(), 4);
        assert!(
            found.contains(&vec![0, 3, 6, 9, 12]) && found.contains(&vec![middle]),
            "{found:?}"
        );
        assert_eq!(ranking(&front, &[0.0, 1.0, 0.0])[0], 1);
    }
}
