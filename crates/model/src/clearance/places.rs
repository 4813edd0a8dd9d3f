//! The places of members in lists, and which of them are not joined.

use crate::mechanism::{Architecture, MemberKind};
use crate::spatial::LEGS;

/// Number of rows of members: the proximal members of the legs, the distal members of the legs, and the platform bars.
pub(crate) const ROWS: usize = 3;
/// Number of members, which come before the joints.
pub(crate) const MEMBERS: usize = ROWS * LEGS;
pub(crate) const PROXIMAL: usize = 0;
pub(crate) const DISTAL: usize = 1;
pub(crate) const PLATFORM: usize = 2;

/// Returns the kinds of the members of each row; `None` for a row that legs of this architecture do not have.
pub(crate) fn kinds(architecture: Architecture) -> [Option<MemberKind>; ROWS] {
    let chain = architecture.chain();
    [chain.proximal, Some(chain.distal), Some(MemberKind::PlatformBar)]
}

/// Returns the pairs of members that are not joined, as indices `LEGS · row + leg`.
pub(crate) fn pairs_not_joined(kinds: [Option<MemberKind>; ROWS]) -> impl Iterator<Item = [usize; 2]> {
    let all = (0..ROWS * LEGS).flat_map(|first| (first + 1..ROWS * LEGS).map(move |second| [first, second]));
    all.filter(move |places| {
        let rows = places.map(|place| place / LEGS);
        let of_one_leg = places[0] % LEGS == places[1] % LEGS;
        let joined = match rows {
            [PLATFORM, PLATFORM] => true,
            [PROXIMAL, DISTAL] | [DISTAL, PLATFORM] => of_one_leg,
            _ => false,
        };
        rows.iter().all(|&row| kinds[row].is_some()) && !joined
    })
}
