//! Two bar radii of smallest mass under constraints that an increase of either radius relaxes. The mass of the bars of each
//! radius grows with it; the method is sequential linearisation in logarithms.
//!
//! Stiffness is close to a power law of the radii, and the mass of the bars of each radius follows one, exactly for solid
//! bars and constant wall ratios. In logarithms of the radii the constraints are nearly linear and the mass is convex, so
//! that a few linearisations suffice.

use super::golden_section::golden_section;
use crate::mechanism::CrossSection;

/// Sizing problem to be solved.
#[derive(Debug, Clone)]
pub(super) struct SizingProblem {
    /// Radii at which the solution starts \[m\].
    pub start: [f64; 2],
    /// Ranges of the radii \[m\].
    pub ranges: [[f64; 2]; 2],
    /// Masses of the bars of each radius.
    pub mass: [BarMass; 2],
    /// How exact the result is to be.
    pub accuracy: SizingAccuracy,
}

/// How exact the bars are to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SizingAccuracy {
    /// The linearisations end when the logarithms change by less than this: near the optimum the mass changes with the
    /// square of that change.
    pub settled: f64,
    /// Bars whose smallest ratio exceeds 1 by no more than this are left unchanged.
    pub spare: f64,
    /// Largest numbers of rounds that select poses, of linearisations on the selected poses in each round, and of final scalings.
    pub steps: [usize; 3],
}

impl SizingAccuracy {
    /// For candidates of a search for a front, of which the next is a little better.
    pub const COARSE: SizingAccuracy = SizingAccuracy {
        settled: 2e-3,
        spare: 5e-4,
        steps: [3, 4, 6],
    };
    /// For the lightest bars of a prescribed region.
    pub const EXACT: SizingAccuracy = SizingAccuracy {
        settled: 1e-6,
        spare: 1e-9,
        steps: [6, 12, 30],
    };
}

/// Mass of the bars of one radius.
#[derive(Debug, Clone)]
pub(super) enum BarMass {
    /// In proportion to the squared radius \[kg/m²\].
    Squared(f64),
    /// Of a section, density \[kg/m³\] and total length \[m\].
    Of(CrossSection, f64, f64),
}

impl BarMass {
    /// Returns the mass \[kg\] at the logarithm of a radius.
    pub fn at(&self, logarithm: f64) -> f64 {
        match self {
            BarMass::Squared(mass) => mass * libm::exp(2.0 * logarithm),
            BarMass::Of(section, density, length) => section.mass_per_length(*density, libm::exp(logarithm)) * length,
        }
    }
}

/// Ratios of what thicker bars improve to what is required, or the reverse where smaller values are better; one column for each, one
/// number for each pose.
pub(super) type Ratios = Vec<Vec<f64>>;

/// Ratios of the stiffness to the required stiffness at a set of poses.
pub(super) trait StiffnessRatios {
    /// Returns the ratios at all poses for bars of the given radii.
    fn ratios_at_all(&mut self, bars: [f64; 2]) -> Ratios;
    /// Selects some of the poses. It may refine the sampling about the `weakest`; poses that it adds to the set are
    /// selected too.
    fn choose(&mut self, poses: &[usize], weakest: &[usize]);
    /// Returns the ratios at the selected poses for bars of the given radii.
    fn ratios_at_selected(&mut self, bars: [f64; 2]) -> Ratios;
}

/// Number of poses that a round selects for each kind of stiffness: those with the smallest ratios.
const CHOSEN: usize = 10;

/// Number of the selected poses of each kind about which the sampling is refined.
const REFINED: usize = 3;

/// Largest change of a logarithm in a linearisation.
const TRUST: f64 = 0.5;

/// Ratios above this value do not act as constraints.
const FAR: f64 = 1e6;

/// Step in a logarithm for the difference quotients.
const STEP: f64 = 1e-4;

/// Assumed exponent of the growth of stiffness with the radii, where nothing better is known: between 2 for a bar in
/// tension and 4 for a bar in bending.
const POWER: f64 = 3.5;

/// Fraction of the upper bound that replaces a lower bound of 0.
const THINNEST: f64 = 1e-5;

/// Linearised constraint `ratio + slopes · change ≥ 0`, with all quantities in logarithms.
struct LinearConstraint {
    ratio: f64,
    slopes: [f64; 2],
}

/// Returns the radii of smallest mass at which every ratio is at least 1; `None` if the ranges contain no such radii.
pub(super) fn lightest(problem: &SizingProblem, ratios: &mut impl StiffnessRatios) -> Option<[f64; 2]> {
    let upper = problem.ranges.map(|range| libm::log(range[1]));
    let lower = problem.ranges.map(|[low, high]| libm::log(low.max(THINNEST * high)));
    let inside = |at: [f64; 2]| [at[0].clamp(lower[0], upper[0]), at[1].clamp(lower[1], upper[1])];
    if weakest(&ratios.ratios_at_all(upper.map(libm::exp))) < 1.0 {
        return None;
    }
    let start = inside([0, 1].map(|k| libm::log(problem.start[k].max(THINNEST * problem.ranges[k][1]))));
    let near = linearised(problem, ratios, start, &inside);
    let held = held(problem, ratios, (near, upper), &inside);
    // The exponential of the logarithm of a bound may exceed the bound by a rounding error.
    let [low, high] = [0, 1].map(|end| problem.ranges.map(|range| range[end]));
    Some([0, 1].map(|k| libm::exp(held[k]).clamp(low[k], high[k])))
}

/// Returns the logarithms of the radii of smallest mass by a sequence of linearisations, on the poses with the smallest ratios. They may
/// violate a constraint slightly.
fn linearised(
    problem: &SizingProblem,
    ratios: &mut impl StiffnessRatios,
    mut at: [f64; 2],
    inside: &impl Fn([f64; 2]) -> [f64; 2],
) -> [f64; 2] {
    let mut chosen: Vec<usize> = Vec::new();
    let SizingAccuracy { settled, spare, steps } = problem.accuracy;
    for round in 0..steps[0] {
        let mut all = ratios.ratios_at_all(at.map(libm::exp));
        if round == 0 {
            // Both radii are first scaled alike to come close to the constraints.
            at = scaled(at, weakest(&all), inside);
            all = ratios.ratios_at_all(at.map(libm::exp));
        } else if weakest(&all) > 1.0 - spare {
            break;
        }
        let mut weak = Vec::new();
        for column in &all {
            let order = smallest(column, CHOSEN);
            chosen.extend(&order);
            weak.extend(order.iter().take(REFINED));
        }
        chosen.sort_unstable();
        chosen.dedup();
        ratios.choose(&chosen, &weak);
        let mut trust = TRUST;
        for _ in 0..steps[1] {
            let base = ratios.ratios_at_selected(at.map(libm::exp));
            let stepped =
                [[at[0] + STEP, at[1]], [at[0], at[1] + STEP]].map(|at| ratios.ratios_at_selected(at.map(libm::exp)));
            let lines = lines(&base, &stepped);
            let next = inside(change(at, &lines, problem, trust));
            let moved = (next[0] - at[0]).abs().max((next[1] - at[1]).abs());
            at = next;
            if moved < settled {
                break;
            }
            trust *= 0.7;
        }
    }
    at
}

/// Returns logarithms of radii with which all constraints hold: both radii are scaled, by no more than necessary.
fn held(
    problem: &SizingProblem,
    ratios: &mut impl StiffnessRatios,
    (mut at, upper): ([f64; 2], [f64; 2]),
    inside: &impl Fn([f64; 2]) -> [f64; 2],
) -> [f64; 2] {
    let SizingAccuracy { spare, steps, .. } = problem.accuracy;
    let mut held = upper;
    let mut short: Option<[f64; 2]> = None;
    for _ in 0..steps[2] {
        let weakest = weakest(&ratios.ratios_at_all(at.map(libm::exp)));
        if weakest >= 1.0 {
            held = at;
            if weakest < 1.0 + spare {
                break;
            }
        } else {
            short = Some(at);
        }
        let next = scaled(at, weakest / (1.0 + 0.5 * spare), inside);
        at = match short {
            // The next radii stay between those that violate a constraint and those that satisfy all, and pass neither.
            Some(short) if held != upper && !between(next, short, held) => {
                [0.5 * (short[0] + held[0]), 0.5 * (short[1] + held[1])]
            }
            _ => next,
        };
    }
    held
}

/// Returns the places of the smallest numbers, the smallest one first and equal ones in their order.
pub(super) fn smallest(numbers: &[f64], count: usize) -> Vec<usize> {
    let mut places: Vec<usize> = (0..numbers.len()).collect();
    let by_number = |a: &usize, b: &usize| numbers[*a].total_cmp(&numbers[*b]).then(a.cmp(b));
    if count < places.len() {
        places.select_nth_unstable_by(count, by_number);
        places.truncate(count);
    }
    places.sort_unstable_by(by_number);
    places
}

/// Returns the smallest ratio.
pub(super) fn weakest(columns: &Ratios) -> f64 {
    columns
        .iter()
        .flatten()
        .fold(f64::INFINITY, |least, &ratio| least.min(ratio))
}

/// Returns the constraints, linearised by difference quotients.
fn lines(base: &Ratios, stepped: &[Ratios; 2]) -> Vec<LinearConstraint> {
    let mut lines = Vec::with_capacity(base.iter().map(Vec::len).sum());
    for kind in 0..base.len() {
        for (index, &ratio) in base[kind].iter().enumerate() {
            if ratio > 0.0 && ratio < FAR {
                lines.push(LinearConstraint {
                    ratio: libm::log(ratio),
                    slopes: [0, 1].map(|k| (stepped[k][kind][index] / ratio - 1.0) / STEP),
                });
            }
        }
    }
    lines
}

/// Returns both logarithms, shifted alike so that the smallest ratio comes close to 1.
fn scaled(at: [f64; 2], weakest: f64, inside: &impl Fn([f64; 2]) -> [f64; 2]) -> [f64; 2] {
    let shift = -libm::log(weakest.clamp(1e-12, 1e12)) / POWER;
    inside([at[0] + shift, at[1] + shift])
}

fn between(at: [f64; 2], low: [f64; 2], high: [f64; 2]) -> bool {
    (0..2).all(|k| at[k] >= low[k].min(high[k]) && at[k] <= low[k].max(high[k]))
}

/// Returns the point of smallest mass within `trust` of `at` that satisfies `lines`; if none does, the point that is
/// nearest to satisfying them.
fn change(at: [f64; 2], lines: &[LinearConstraint], problem: &SizingProblem, trust: f64) -> [f64; 2] {
    // Smallest change of the second logarithm that a line requires, as `[constant, slope]` in the change of the first,
    // for lines that can be violated within `trust`. A line without a second slope requires a change of the first
    // instead.
    let mut required: Vec<[f64; 2]> = Vec::with_capacity(lines.len());
    let mut low = -trust;
    for line in lines {
        let [first, second] = line.slopes;
        if line.ratio >= (first.max(0.0) + second.max(0.0)) * trust {
            continue;
        }
        if second > 1e-6 {
            required.push([-line.ratio / second, -first / second]);
        } else if first > 1e-6 {
            low = low.max(-line.ratio / first);
        }
    }
    let (low, high) = (low.min(trust), trust);
    let second = |first: f64| {
        required.iter().fold(-trust, |most: f64, [constant, slope]| {
            most.max(constant + slope * first)
        })
    };
    let mass = |first: f64| {
        let second = second(first);
        if second > trust {
            return f64::INFINITY;
        }
        problem.mass[0].at(at[0] + first) + problem.mass[1].at(at[1] + second)
    };
    // The mass is convex in the first change, and infinite below some value of it.
    let first = golden_section([low, high], 0.5 * problem.accuracy.settled, mass);
    [at[0] + first, at[1] + second(first).min(trust)]
}
