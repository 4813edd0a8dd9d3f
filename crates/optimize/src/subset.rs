//! The members of a front that together cover the most: a subset of given size with the largest hypervolume.

use std::collections::BinaryHeap;

use super::hypervolume::hypervolume;
use super::selection::{bests, knee};

/// Selects at most `most` members whose hypervolume is the largest: the best in each objective and the knee always, and the others so
/// that they contribute most. The result is in the order of the front, which is that of the [archive](super::Archive).
///
/// The hypervolume counts twice, each time as a share of that of the whole front: once of the objectives as they are, and once of the
/// logarithms of those that are positive and extend over more than a factor of `e`, so that small values count as much as large ones.
/// The subset of a front of two objectives is the best one (Auger et al. 2009); with three, members are added one after the other
/// (Nemhauser et al. 1978: at least 63 % of the best).
///
/// ```
/// use kinefront_optimize::subset;
///
/// let front = [[0.0, 4.0], [1.0, 3.9], [2.0, 1.0], [3.0, 0.9], [4.0, 0.0]];
/// assert_eq!(subset(&front, &[5.0, 5.0], 3), [0, 2, 4]);
/// ```
pub fn subset(front: &[impl AsRef<[f64]>], reference: &[f64], most: usize) -> Vec<usize> {
    if front.len() <= most {
        return (0..front.len()).collect();
    }
    let scales = scales(front, reference);
    match reference.len() {
        1 => vec![0],
        2 => {
            let chosen = best_staircase(&scales, most);
            match knee(front) {
                Some(knee) if !chosen.contains(&knee) => with_knee(&scales, &chosen, knee),
                _ => chosen,
            }
        }
        _ => {
            let mut first: Vec<usize> = bests(front);
            first.extend(knee(front));
            first.sort_unstable();
            first.dedup();
            first.truncate(most);
            one_after_the_other(&scales, first, most)
        }
    }
}

/// Puts the knee in the place of one of its neighbours, but for the ends: that without which the others cover more.
fn with_knee(scales: &[Scale], chosen: &[usize], knee: usize) -> Vec<usize> {
    let at = chosen.partition_point(|&place| place < knee);
    let others = (at.saturating_sub(1)..=at).filter(|&place| place > 0 && place + 1 < chosen.len());
    let exchanged = others.map(|place| {
        let mut exchanged = chosen.to_vec();
        exchanged[place] = knee;
        (covered(scales, &exchanged), exchanged)
    });
    let best = exchanged.reduce(|best, next| if next.0 > best.0 { next } else { best });
    best.map_or(chosen.to_vec(), |(_, exchanged)| exchanged)
}

/// What some members cover, as a share of the whole front, summed over the scales.
fn covered(scales: &[Scale], chosen: &[usize]) -> f64 {
    let of_scale = |scale: &Scale| {
        let points = chosen.iter().map(|&place| &scale.points[place]);
        scale.weight * hypervolume(points, &scale.reference)
    };
    scales.iter().map(of_scale).sum()
}

/// The front on one scale of its objectives.
pub(super) struct Scale {
    pub points: Vec<Vec<f64>>,
    pub reference: Vec<f64>,
    /// Reciprocal of the hypervolume of the whole front; 0 if it has none.
    pub weight: f64,
}

/// Returns the front as it is, and with logarithms of the objectives that are positive and extend over more than a factor of `e`, if
/// there are any.
pub(super) fn scales(front: &[impl AsRef<[f64]>], reference: &[f64]) -> Vec<Scale> {
    let is_logarithmic: Vec<bool> = (0..reference.len())
        .map(|k| {
            let values = || front.iter().map(|point| point.as_ref()[k]);
            let least = values().fold(f64::INFINITY, f64::min);
            let largest = values().fold(f64::NEG_INFINITY, f64::max);
            least > 0.0 && reference[k] > 0.0 && largest > std::f64::consts::E * least
        })
        .collect();
    let on_scale = |logarithmic: bool| {
        let convert = |point: &[f64]| -> Vec<f64> {
            let value = |k: usize| {
                // What lies beyond the reference contributes nothing.
                let value = point[k].min(reference[k]);
                if logarithmic && is_logarithmic[k] {
                    libm::log(value)
                } else {
                    value
                }
            };
            (0..reference.len()).map(value).collect()
        };
        let points: Vec<Vec<f64>> = front.iter().map(|point| convert(point.as_ref())).collect();
        let reference = convert(reference);
        let whole = hypervolume(&points, &reference);
        Scale {
            points,
            reference,
            weight: if whole > 0.0 { 1.0 / whole } else { 0.0 },
        }
    };
    let with_logarithms = is_logarithmic.contains(&true).then(|| on_scale(true));
    std::iter::once(on_scale(false)).chain(with_logarithms).collect()
}

/// Returns the staircase of `most` of the points, both ends included, that covers the largest area.
///
/// A step covers an area that depends on it and the step before it alone, so that dynamic programming finds the best one. The best
/// step before a point moves in the same direction as the point, which leaves `n log n` pairs a step instead of `n²`.
fn best_staircase(scales: &[Scale], most: usize) -> Vec<usize> {
    let count = scales[0].points.len();
    let gain = |before: Option<usize>, at: usize| {
        let of_scale = |scale: &Scale| {
            let from = before.map_or(scale.reference[1], |before| scale.points[before][1]);
            let [first, second] = [scale.points[at][0], scale.points[at][1]];
            scale.weight * (scale.reference[0] - first) * (from - second)
        };
        scales.iter().map(of_scale).sum::<f64>()
    };
    let most = most.max(2).min(count);
    let mut covered = vec![f64::NEG_INFINITY; count];
    covered[0] = gain(None, 0);
    let mut before: Vec<Vec<usize>> = Vec::new();
    for step in 1..most {
        let mut row = vec![0; count];
        let mut next = vec![f64::NEG_INFINITY; count];
        // Ranges of points whose best step before them lies in a range.
        let mut ranges = vec![(step, count, step - 1, count - 1)];
        while let Some((from, to, first, last)) = ranges.pop() {
            if from >= to {
                continue;
            }
            let middle = usize::midpoint(from, to);
            for place in first..=last.min(middle - 1) {
                let found = covered[place] + gain(Some(place), middle);
                if found > next[middle] {
                    (next[middle], row[middle]) = (found, place);
                }
            }
            let best = row[middle].max(first);
            ranges.push((from, middle, first, best));
            ranges.push((middle + 1, to, best, last));
        }
        covered = next;
        before.push(row);
    }
    let mut chosen = vec![count - 1];
    for row in before.iter().rev() {
        chosen.push(row[chosen[chosen.len() - 1]]);
    }
    chosen.reverse();
    chosen
}

/// A member that is not chosen, with the largest gain that it may have: gains only shrink as others are chosen.
#[derive(PartialEq)]
struct Waiting {
    gain: f64,
    place: usize,
    /// Number of members that were chosen when the gain was determined.
    known_at: usize,
}

impl Eq for Waiting {}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        // Among equals the first comes first.
        self.gain.total_cmp(&other.gain).then(other.place.cmp(&self.place))
    }
}

fn one_after_the_other(scales: &[Scale], mut chosen: Vec<usize>, most: usize) -> Vec<usize> {
    let mut waiting: BinaryHeap<Waiting> = (0..scales[0].points.len())
        .filter(|place| !chosen.contains(place))
        .map(|place| Waiting {
            gain: f64::INFINITY,
            place,
            known_at: usize::MAX,
        })
        .collect();
    let mut so_far = covered(scales, &chosen);
    while chosen.len() < most {
        let Some(next) = waiting.pop() else { break };
        if next.known_at == chosen.len() {
            so_far += next.gain;
            chosen.push(next.place);
        } else {
            chosen.push(next.place);
            let gain = covered(scales, &chosen) - so_far;
            chosen.pop();
            waiting.push(Waiting {
                gain,
                known_at: chosen.len(),
                ..next
            });
        }
    }
    chosen.sort_unstable();
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A front of random steps.
    fn front(count: usize) -> Vec<[f64; 2]> {
        let mut state = 5_u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut point = [1.0, 0.0];
        (0..count)
            .map(|_| {
                point = [point[0] * (1.0 + next()), point[1] - next()];
                point
            })
            .collect()
    }

    /// Of all subsets with both ends, that which is returned covers the most.
    #[test]
    fn no_other_subset_covers_more() {
        let front = front(11);
        let reference = [2.0 * front[10][0], 1.0];
        let scales = scales(&front, &reference);
        assert_eq!(scales.len(), 2);
        let covers = |places: &[usize]| covered(&scales, places);
        for most in [3, 5, 8] {
            let chosen = best_staircase(&scales, most);
            assert_eq!(chosen.len(), most);
            let best = (0_u32..1 << 11)
                .filter(|set| set.count_ones() as usize == most && set & 1 == 1 && set >> 10 == 1)
                .map(|set| covers(&(0..11).filter(|place| set >> place & 1 == 1).collect::<Vec<_>>()))
                .fold(0.0, f64::max);
            let found = covers(&chosen);
            assert!((found - best).abs() < 1e-12 * best, "{found} of {best}");
        }
    }

    /// A subset has both ends and the knee, and covers almost as much as the whole front.
    #[test]
    fn a_subset_has_the_ends_and_the_knee() {
        let front = front(300);
        let reference = [1.1 * front[299][0], 1.0];
        for most in 3..40 {
            assert_eq!(subset(&front, &reference, most).len(), most);
        }
        let chosen = subset(&front, &reference, 20);
        assert!(chosen.is_sorted());
        for member in [Some(0), Some(299), knee(&front)] {
            assert!(member.is_some_and(|member| chosen.contains(&member)));
        }
        assert_eq!(subset(&front, &reference, 300).len(), 300);
        let kept = hypervolume(chosen.iter().map(|&place| front[place]), reference);
        assert!(kept > 0.9 * hypervolume(&front, reference));
    }

    /// With three objectives, each member added is the one that adds most, and the corners are in.
    #[test]
    fn members_of_three_objectives_are_added_by_their_gain() {
        let mut front: Vec<[f64; 3]> = Vec::new();
        for i in 0..12 {
            for j in 0..12 - i {
                let [x, y] = [i, j].map(|k| f64::from(k) / 11.0);
                front.push([x, y, (1.0 - x - y).max(0.0)]);
            }
        }
        front.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let reference = [1.2; 3];
        let chosen = subset(&front, &reference, 12);
        assert_eq!(chosen.len(), 12);
        for k in 0..3 {
            assert!(chosen.iter().any(|&place| front[place][k] == 0.0));
        }
        let covered = |chosen: &[usize]| hypervolume(chosen.iter().map(|&place| front[place]), reference);
        // No exchange of one member for another one gains more than a few per cent.
        let found = covered(&chosen);
        for out in 0..chosen.len() {
            for place in 0..front.len() {
                let mut other = chosen.clone();
                other[out] = place;
                assert!(covered(&other) < 1.03 * found);
            }
        }
    }
}
