//! The lightest pair of bars when one or both are selected from a catalogue.

use super::lightest::{BarMass, SizingProblem, StiffnessRatios, lightest, smallest, weakest};

/// Number of poses on which a pair is tested first.
const TESTED_FIRST: usize = 30;

/// Returns the radii of smallest mass at which every ratio is at least 1; those of a list are among `listed`, which holds the
/// outer radii of a catalogue within the ranges. Returns `None` if no such radii exist.
///
/// Pairs of two lists are tested in the order of their mass, so that the first that carries is the lightest. The stiffness need
/// not grow in the order of a catalogue.
pub(super) fn lightest_listed(
    problem: &SizingProblem,
    listed: [Option<&[f64]>; 2],
    ratios: &mut impl StiffnessRatios,
) -> Option<[f64; 2]> {
    match listed {
        [None, None] => lightest(problem, ratios),
        [Some(legs), Some(platform)] => of_two_lists(problem, [legs, platform], ratios),
        [Some(radii), None] => of_one_list(problem, 0, radii, ratios),
        [None, Some(radii)] => of_one_list(problem, 1, radii, ratios),
    }
}

fn mass(problem: &SizingProblem, bars: [f64; 2]) -> f64 {
    let of = |mass: &BarMass, radius: f64| mass.at(libm::log(radius));
    of(&problem.mass[0], bars[0]) + of(&problem.mass[1], bars[1])
}

/// Solves the problem for each radius of one list.
fn of_one_list(
    problem: &SizingProblem,
    which: usize,
    radii: &[f64],
    ratios: &mut impl StiffnessRatios,
) -> Option<[f64; 2]> {
    let mut best: Option<([f64; 2], f64)> = None;
    for &radius in radii {
        // The bars of this list alone may be heavier than the best so far.
        let alone = problem.mass[which].at(libm::log(radius));
        if best.is_some_and(|(_, least)| alone >= least) {
            continue;
        }
        let mut with = problem.clone();
        with.start[which] = radius;
        with.ranges[which] = [radius; 2];
        if let Some(bars) = lightest(&with, ratios) {
            let mass = mass(problem, bars);
            if best.is_none_or(|(_, least)| mass < least) {
                best = Some((bars, mass));
            }
        }
    }
    best.map(|(bars, _)| bars)
}

fn of_two_lists(
    problem: &SizingProblem,
    [legs, platform]: [&[f64]; 2],
    ratios: &mut impl StiffnessRatios,
) -> Option<[f64; 2]> {
    let mut pairs: Vec<([f64; 2], f64)> = legs
        .iter()
        .flat_map(|&leg| platform.iter().map(move |&bar| [leg, bar]))
        .map(|bars| (bars, mass(problem, bars)))
        .collect();
    pairs.sort_by(|a, b| a.1.total_cmp(&b.1));
    // Few poses tell most pairs that do not carry.
    let middle = pairs.get(pairs.len() / 2)?.0;
    let columns = ratios.ratios_at_all(middle);
    let of_columns = columns.iter().flat_map(|column| smallest(column, TESTED_FIRST));
    let mut chosen: Vec<usize> = of_columns.collect();
    chosen.sort_unstable();
    chosen.dedup();
    ratios.choose(&chosen, &[]);
    pairs
        .into_iter()
        .map(|(bars, _)| bars)
        .find(|&bars| weakest(&ratios.ratios_at_selected(bars)) >= 1.0 && weakest(&ratios.ratios_at_all(bars)) >= 1.0)
}
