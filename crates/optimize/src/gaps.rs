//! Gaps of a front: pairs of neighbours with nothing between them.

use super::Objectives;
use super::hypervolume::hypervolume;
use super::selection::{scaled, squared_distance};
use super::subset::{Scale, scales};

/// Two neighbours of a front, with nothing between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// Places of the two members: first the one that is better in the first objective.
    pub between: [usize; 2],
    /// The objectives [`halfway`] between them.
    pub middle: Objectives,
    /// What a member there would add to what the front covers, as a share of it.
    pub share: f64,
}

/// Returns the gaps of a front of two or three objectives, which is in the order of its first objective; none for one objective.
///
/// Two members of a front of two objectives are neighbours if they follow one another. Two members of a front of three objectives are
/// neighbours if no other member lies in the ball about the middle between them (Gabriel and Sokal 1969), each objective scaled to the
/// front. Shares are means over the scales that [`subset`](super::subset()) uses.
///
/// ```
/// use kinefront_optimize::gaps;
///
/// let front = [[0.0, 4.0], [1.0, 3.0], [3.0, 0.0]].map(Into::into);
/// let found = gaps(&front, &[5.0, 5.0]);
/// assert_eq!(found[1].between, [1, 2]);
/// assert!((found[1].share - 6.0 * found[0].share).abs() < 1e-12);
/// ```
pub fn gaps(front: &[Objectives], reference: &[f64]) -> Vec<Gap> {
    let pairs = match reference.len() {
        2 => (1..front.len()).map(|place| [place - 1, place]).collect(),
        3 => neighbours(front),
        _ => Vec::new(),
    };
    let scales = scales(front, reference);
    let gap = |between: [usize; 2]| {
        let [a, b] = between.map(|place| &front[place]);
        let shares = scales.iter().map(|scale| share_between(scale, between));
        Gap {
            between,
            middle: halfway(a, b),
            share: shares.sum::<f64>() / scales.len() as f64,
        }
    };
    pairs.into_iter().map(gap).collect()
}

/// Returns what a member in the middle of two would add to what the front covers on a scale.
fn share_between(scale: &Scale, between: [usize; 2]) -> f64 {
    let [a, b] = between.map(|place| &scale.points[place]);
    let mut hoped = vec![a[0].min(b[0])];
    hoped.extend((1..a.len()).map(|k| 0.5 * (a[k] + b[k])));
    // Of every other member, only what is no better than the one that is hoped for covers what that one covers.
    let covered = scale.points.iter().map(|point| -> Vec<f64> {
        let parts = point.iter().zip(&hoped);
        parts.map(|(value, hoped)| value.max(*hoped)).collect()
    });
    let of_hoped = hypervolume([&hoped], &scale.reference);
    scale.weight * (of_hoped - hypervolume(covered, &scale.reference))
}

/// Returns what one more member would add to what a front covers, as a share of it; the mean over the scales that
/// [`subset`](super::subset()) uses.
///
/// ```
/// use kinefront_optimize::added_share;
///
/// let front = [[0.0, 4.0], [2.0, 2.0]].map(Into::into);
/// let added = added_share(&front, &[5.0, 5.0], &[1.0, 3.0].into());
/// assert!((added - 1.0 / 11.0).abs() < 1e-12);
/// ```
pub fn added_share(front: &[Objectives], reference: &[f64], member: &Objectives) -> f64 {
    let all: Vec<Objectives> = front.iter().chain([member]).copied().collect();
    let scales = scales(&all, reference);
    let added = |scale: &Scale| {
        let whole = hypervolume(&scale.points, &scale.reference);
        let had = hypervolume(&scale.points[..front.len()], &scale.reference);
        if had > 0.0 { whole / had - 1.0 } else { 1.0 }
    };
    scales.iter().map(added).sum::<f64>() / scales.len() as f64
}

/// Returns the pairs of members with no other one in the ball about the middle between them.
fn neighbours(front: &[Objectives]) -> Vec<[usize; 2]> {
    let points = scaled(front);
    let squared = |a: usize, b: usize| squared_distance(&points[a], &points[b]);
    let mut found = Vec::new();
    for b in 1..points.len() {
        for a in 0..b {
            let between = squared(a, b);
            let is_inside = |other: usize| other != a && other != b && squared(a, other) + squared(other, b) < between;
            if !(0..points.len()).any(is_inside) {
                found.push([a, b]);
            }
        }
    }
    found
}

/// Returns the best objectives that a member between two others can be hoped to have: the smaller one of the first objectives, and of each
/// other objective the geometric mean, or the arithmetic mean of values of different signs.
pub fn halfway(a: &Objectives, b: &Objectives) -> Objectives {
    let mean = |a: f64, b: f64| {
        if a * b > 0.0 {
            a.signum() * libm::sqrt(a * b)
        } else {
            0.5 * (a + b)
        }
    };
    let others = a.iter().zip(b.iter()).skip(1).map(|(a, b)| mean(*a, *b));
    Objectives::new(std::iter::once(a[0].min(b[0])).chain(others))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A front on an eighth of a sphere that bulges towards the ideal point, but for a hole.
    fn sphere_with_a_hole() -> Vec<Objectives> {
        let mut front: Vec<Objectives> = Vec::new();
        for ring in 0..=8 {
            for step in 0..=8 {
                let (polar, around) = (f64::from(ring) / 8.0, f64::from(step) / 8.0);
                let [polar, around] = [polar, around].map(|part| part * std::f64::consts::FRAC_PI_2);
                let across = libm::sin(polar);
                let unit = [across * libm::cos(around), across * libm::sin(around), libm::cos(polar)];
                let hole: f64 = unit.map(|part| (part - 0.577) * (part - 0.577)).iter().sum();
                if hole > 0.1 && !front.iter().any(|other| other[..] == unit.map(|part| 1.0 - part)[..]) {
                    front.push(unit.map(|part| 1.0 - part).into());
                }
            }
        }
        front.sort_by(|a, b| a[0].total_cmp(&b[0]));
        front
    }

    #[test]
    fn the_largest_gap_of_three_objectives_lies_across_the_hole() {
        let front = sphere_with_a_hole();
        let found = gaps(&front, &[1.5; 3]);
        assert!(found.iter().all(|gap| gap.share >= -1e-12));
        let largest = found.iter().max_by(|a, b| a.share.total_cmp(&b.share)).expect("a gap");
        let distances = (1..3).map(|k| (largest.middle[k] - (1.0 - 0.577)).abs());
        assert!(distances.fold(0.0, f64::max) < 0.3, "{largest:?}");
    }

    #[test]
    fn a_gap_is_worth_what_the_hoped_member_adds() {
        let front: Vec<Objectives> = [[1.0, 9.0, 2.0], [2.0, 4.0, 3.0], [5.0, 3.0, 1.0]]
            .map(Into::into)
            .to_vec();
        let reference = [6.0, 10.0, 4.0];
        let whole = hypervolume(&front, reference);
        for gap in gaps(&front, &reference) {
            // No objective extends over more than a factor of e but the first two, which count by their logarithms as well.
            let [a, b] = gap.between.map(|place| &front[place]);
            let hoped: Objectives = [a[0].min(b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])].into();
            let more: Vec<Objectives> = front.iter().copied().chain([hoped]).collect();
            let added = hypervolume(&more, reference) / whole - 1.0;
            let scale = &scales(&front, &reference)[0];
            assert!((share_between(scale, gap.between) - added).abs() < 1e-12);
        }
    }
}
