//! The gaps between neighbouring members of a front, and which of them a candidate is to close.

use crate::random::Random;
use crate::{Archive, ArchiveMember};

/// Probability that a gap is drawn whatever its area.
const ANY: f64 = 0.15;

/// Probability that the area counts with the logarithm of the sized objective.
const LOGARITHMIC: f64 = 0.4;

/// Weight of a gap neither end of which is on the common front.
const DOMINATED: f64 = 0.1;

/// The gaps of a front of two objectives.
#[derive(Debug, Clone, Default)]
pub struct Gaps {
    gaps: Vec<Gap>,
}

#[derive(Debug, Clone, Copy)]
struct Gap {
    /// Evaluations of the two members.
    ends: [usize; 2],
    /// First objective of the first member, in whose ascending order the gaps are.
    first: f64,
    /// Area of the rectangle between the ends, and the same with the logarithm of the sized objective.
    areas: [f64; 2],
    /// Number of candidates so far that were to close it.
    tried: u32,
}

impl Gaps {
    /// Finds the gaps of a front of which `common` holds the members that no other category dominates. `logarithm` is applied to the
    /// sized objective.
    pub fn update(&mut self, front: &Archive, common: &Archive, leveled: usize, logarithm: impl Fn(f64) -> f64) {
        let is_common = |member: &ArchiveMember| {
            let first = member.objectives[0];
            let at = common.partition_point(|other| other.objectives[0] < first);
            common
                .get(at)
                .is_some_and(|other| other.objectives == member.objectives)
        };
        // The gaps so far are in the same order as the members, so that one pass finds those that are left.
        let mut before = std::mem::take(&mut self.gaps).into_iter().peekable();
        let mut tried = |ends: [usize; 2], first: f64| {
            while before.next_if(|gap| gap.first < first).is_some() {}
            let known = before.peek().filter(|gap| gap.ends == ends);
            known.map_or(0, |gap| gap.tried)
        };
        let gap = |pair: &[(&ArchiveMember, f64, bool)]| {
            let [(a, log_a, common_a), (b, log_b, common_b)] = [pair[0], pair[1]];
            let weight = if common_a || common_b { 1.0 } else { DOMINATED };
            let height = weight * (b.objectives[leveled] - a.objectives[leveled]);
            let width = b.objectives[1 - leveled] - a.objectives[1 - leveled];
            let (ends, first) = ([a.id, b.id], a.objectives[0]);
            Gap {
                ends,
                first,
                areas: [width * height, (log_b - log_a) * height].map(f64::abs),
                tried: tried(ends, first),
            }
        };
        let ends: Vec<(&ArchiveMember, f64, bool)> = front
            .iter()
            .map(|member| (member, logarithm(member.objectives[1 - leveled]), is_common(member)))
            .collect();
        self.gaps = ends.windows(2).map(gap).collect();
    }

    /// Draws a gap, mostly in proportion to its area, and the less likely the more often it was tried. Returns the place of its first end.
    pub fn draw(&mut self, random: &mut Random) -> usize {
        let place = if random.chance(ANY) {
            random.below(self.gaps.len())
        } else {
            let kind = usize::from(random.chance(LOGARITHMIC));
            let weight = |gap: &Gap| gap.areas[kind] / (1.0 + f64::from(gap.tried));
            let mut draw = random.uniform() * self.gaps.iter().map(weight).sum::<f64>();
            let reached = |gap| {
                draw -= weight(gap);
                draw < 0.0
            };
            self.gaps.iter().position(reached).unwrap_or(self.gaps.len() - 1)
        };
        self.gaps[place].tried += 1;
        place
    }
}
