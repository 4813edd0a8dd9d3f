//! Two radii under constraints that both relieve: least weighted sum of squares by sequential linearisation in logarithms.
//!
//! Stiffness is close to a power law of the radii, and mass is one. In logarithms of the radii the constraints are close
//! to straight lines and the mass is convex, so that a few linearisations settle it.

/// What is asked.
#[derive(Debug, Clone, Copy)]
pub(super) struct Problem {
    /// Radii to start from \[m\].
    pub start: [f64; 2],
    /// Their ranges \[m\].
    pub ranges: [[f64; 2]; 2],
    /// Mass per squared radius \[kg/m²\].
    pub mass: [f64; 2],
}

/// What stiffness there is at some poses as shares of what is asked, a column for each kind.
pub(super) trait Shares {
    /// At all poses.
    fn of_all(&mut self, bars: [f64; 2]) -> [Vec<f64>; 3];
    /// Chooses some of them, and may look closer about the weakest: poses that it adds to all are among the chosen.
    fn choose(&mut self, poses: &[usize], weakest: &[usize]);
    /// At the poses chosen.
    fn of_chosen(&mut self, bars: [f64; 2]) -> [Vec<f64>; 3];
}

/// Rounds of choosing poses, and of linearisations on the chosen ones.
const ROUNDS: [usize; 2] = [3, 4];

/// Poses of each kind chosen in a round: the weakest.
const CHOSEN: usize = 10;

/// Of them, so many are looked at closer.
const REFINED: usize = 3;

/// Largest change of a logarithm in a linearisation.
const TRUST: f64 = 0.5;

/// A change of the logarithms below this ends the linearisations: near the optimum the mass changes by its square.
const SETTLED: f64 = 2e-3;

/// Shares beyond this are no constraint.
const FAR: f64 = 1e6;

/// Step of the difference quotients in a logarithm.
const STEP: f64 = 1e-4;

/// Power of the radii that stiffness is taken to grow with where nothing better is known: between 2, a bar pulled, and
/// 4, a bar bent.
const POWER: f64 = 3.5;

/// A lower bound of 0 is taken as this share of the upper one.
const THINNEST: f64 = 1e-5;

/// Bars whose weakest share exceeds 1 by no more than this are left as they are.
const SPARE: f64 = 5e-4;

/// The constraint `share + slopes · change ≥ 0`, all in logarithms.
struct Line {
    share: f64,
    slopes: [f64; 2],
}

/// The radii of least mass at which every share is at least 1; `None` where the ranges have none.
pub(super) fn lightest(problem: &Problem, shares: &mut impl Shares) -> Option<[f64; 2]> {
    let upper = problem.ranges.map(|range| libm::log(range[1]));
    let lower = problem.ranges.map(|[low, high]| libm::log(low.max(THINNEST * high)));
    let inside = |at: [f64; 2]| [at[0].clamp(lower[0], upper[0]), at[1].clamp(lower[1], upper[1])];
    if weakest(&shares.of_all(upper.map(libm::exp))) < 1.0 {
        return None;
    }
    let mut at = inside([0, 1].map(|k| libm::log(problem.start[k].max(THINNEST * problem.ranges[k][1]))));
    let mut chosen: Vec<usize> = Vec::new();
    for round in 0..ROUNDS[0] {
        let mut all = shares.of_all(at.map(libm::exp));
        if round == 0 {
            // Near the constraints first: both radii scaled alike.
            at = scaled(at, weakest(&all), &inside);
            all = shares.of_all(at.map(libm::exp));
        } else if weakest(&all) > 1.0 - SPARE {
            break;
        }
        let mut weak = Vec::new();
        for column in &all {
            let mut order: Vec<usize> = (0..column.len()).collect();
            let count = CHOSEN.min(order.len());
            let by_share = |a: &usize, b: &usize| column[*a].total_cmp(&column[*b]).then(a.cmp(b));
            order.select_nth_unstable_by(count - 1, by_share);
            order[..count].sort_unstable_by(by_share);
            chosen.extend(&order[..count]);
            weak.extend(&order[..REFINED.min(count)]);
        }
        chosen.sort_unstable();
        chosen.dedup();
        shares.choose(&chosen, &weak);
        let mut trust = TRUST;
        for _ in 0..ROUNDS[1] {
            let base = shares.of_chosen(at.map(libm::exp));
            let stepped = [[at[0] + STEP, at[1]], [at[0], at[1] + STEP]].map(|at| shares.of_chosen(at.map(libm::exp)));
            let lines = lines(&base, &stepped);
            let next = inside(change(at, &lines, problem, trust));
            let moved = (next[0] - at[0]).abs().max((next[1] - at[1]).abs());
            at = next;
            if moved < SETTLED {
                break;
            }
            trust *= 0.7;
        }
    }
    // The linearised optimum may miss by a little: both radii are scaled until all hold, by no more than need be.
    let mut held = upper;
    let mut short: Option<[f64; 2]> = None;
    for _ in 0..6 {
        let weakest = weakest(&shares.of_all(at.map(libm::exp)));
        if weakest >= 1.0 {
            held = at;
            if weakest < 1.0 + SPARE {
                break;
            }
        } else {
            short = Some(at);
        }
        let next = scaled(at, weakest / (1.0 + 0.5 * SPARE), &inside);
        at = match short {
            // Between what falls short and what holds, never past either.
            Some(short) if held != upper && !between(next, short, held) => {
                [0.5 * (short[0] + held[0]), 0.5 * (short[1] + held[1])]
            }
            _ => next,
        };
    }
    // The exponential of a bound's logarithm may pass the bound by a bit.
    let [low, high] = [0, 1].map(|end| problem.ranges.map(|range| range[end]));
    Some([0, 1].map(|k| libm::exp(held[k]).clamp(low[k], high[k])))
}

fn weakest(columns: &[Vec<f64>; 3]) -> f64 {
    columns
        .iter()
        .flatten()
        .fold(f64::INFINITY, |least, &share| least.min(share))
}

/// The constraints linearised by difference quotients.
fn lines(base: &[Vec<f64>; 3], stepped: &[[Vec<f64>; 3]; 2]) -> Vec<Line> {
    let mut lines = Vec::with_capacity(3 * base[0].len());
    for kind in 0..3 {
        for (index, &share) in base[kind].iter().enumerate() {
            if share > 0.0 && share < FAR {
                lines.push(Line {
                    share: libm::log(share),
                    slopes: [0, 1].map(|k| (stepped[k][kind][index] / share - 1.0) / STEP),
                });
            }
        }
    }
    lines
}

/// Both logarithms shifted alike, so that the weakest share comes near 1.
fn scaled(at: [f64; 2], weakest: f64, inside: &impl Fn([f64; 2]) -> [f64; 2]) -> [f64; 2] {
    let shift = -libm::log(weakest.clamp(1e-12, 1e12)) / POWER;
    inside([at[0] + shift, at[1] + shift])
}

fn between(at: [f64; 2], low: [f64; 2], high: [f64; 2]) -> bool {
    (0..2).all(|k| at[k] >= low[k].min(high[k]) && at[k] <= low[k].max(high[k]))
}

/// The point of least mass within `trust` of `at` that keeps `lines`; nearest to keeping them where none does.
fn change(at: [f64; 2], lines: &[Line], problem: &Problem, trust: f64) -> [f64; 2] {
    // The second change that a line asks for, `[constant, slope]` in the first; of lines that can fail within reach. One
    // without a second slope asks for a first change instead.
    let mut asked: Vec<[f64; 2]> = Vec::with_capacity(lines.len());
    let mut low = -trust;
    for line in lines {
        let [first, second] = line.slopes;
        if line.share >= (first.max(0.0) + second.max(0.0)) * trust {
            continue;
        }
        if second > 1e-6 {
            asked.push([-line.share / second, -first / second]);
        } else if first > 1e-6 {
            low = low.max(-line.share / first);
        }
    }
    let mut low = low.min(trust);
    let mut high = trust;
    let second = |first: f64| {
        asked.iter().fold(-trust, |most: f64, [constant, slope]| {
            most.max(constant + slope * first)
        })
    };
    let mass = |first: f64| {
        let second = second(first);
        if second > trust {
            return f64::INFINITY;
        }
        problem.mass[0] * libm::exp(2.0 * (at[0] + first)) + problem.mass[1] * libm::exp(2.0 * (at[1] + second))
    };
    // The mass is convex in the first change, infinite below some value of it: golden section.
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let mut left = high - GOLDEN * (high - low);
    let mut right = low + GOLDEN * (high - low);
    let (mut at_left, mut at_right) = (mass(left), mass(right));
    while high - low > 0.5 * SETTLED {
        if at_left <= at_right && at_left.is_finite() {
            high = right;
            (right, at_right) = (left, at_left);
            left = high - GOLDEN * (high - low);
            at_left = mass(left);
        } else {
            low = left;
            (left, at_left) = (right, at_right);
            right = low + GOLDEN * (high - low);
            at_right = mass(right);
        }
    }
    let first = if at_left <= at_right { left } else { right };
    [at[0] + first, at[1] + second(first).min(trust)]
}
