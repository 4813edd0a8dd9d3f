//! Tests of dominance, the archive, the hypervolume and the algorithms on problems with known fronts.

use kinefront_optimize::{
    Algorithm, Archive, Candidate, Evaluated, FrontDe, FrontDeSettings, Moga2, Moga2Settings, Nsga2, Nsga2Settings,
    Objectives, Outcome, Problem, Relation, Target, Variable, compare, crowding_distances, hypervolume,
    non_dominated_ranks, run, sobol,
};
use proptest::prelude::*;

/// A problem with a categorical and a real variable: each choice is best on a part of the front.
struct Mixed;

impl Problem for Mixed {
    fn variables(&self) -> Vec<Variable> {
        vec![
            Variable::Categorical { choices: 3 },
            Variable::Real { lower: 0.0, upper: 3.0 },
        ]
    }

    fn evaluate(&self, x: &[f64]) -> Outcome {
        let off = x[1] - (x[0] + 0.5);
        Outcome {
            objectives: [x[1], 3.0 - x[1] + 4.0 * off * off].into(),
            violation: 0.0,
        }
    }
}

/// All algorithms for the mixed problem, each from a random seed.
const MAKERS: [fn(u64) -> Box<dyn Algorithm>; 3] = [
    |seed| Box::new(FrontDe::new(Mixed.variables(), FrontDeSettings::default(), seed)),
    |seed| Box::new(Nsga2::new(Mixed.variables(), Nsga2Settings::default(), seed)),
    |seed| Box::new(Moga2::new(Mixed.variables(), Moga2Settings::default(), seed)),
];

#[test]
fn every_choice_finds_its_part_of_the_front() {
    for make in MAKERS {
        let archive = run(&Mixed, make(3).as_mut(), 6000);
        for choice in [0.0, 1.0, 2.0] {
            assert!(
                archive.iter().any(|member| member.x[0] == choice),
                "choice {choice} is missing"
            );
        }
    }
}

/// A problem whose second variable is best at a tenth of the first; it can complete candidates accordingly.
struct Structured;

impl Problem for Structured {
    fn variables(&self) -> Vec<Variable> {
        vec![Variable::Real { lower: 0.0, upper: 1.0 }; 2]
    }

    fn evaluate(&self, x: &[f64]) -> Outcome {
        let off = (x[1] - 0.1 * x[0]).abs();
        Outcome {
            objectives: [x[0] + off, 1.0 - x[0] * x[0] + off].into(),
            violation: 0.0,
        }
    }

    fn complete(&self, x: &[f64], target: Target) -> Option<Vec<f64>> {
        let first = match target {
            Target::Level(level) => (1.0 - level).clamp(0.0, 1.0).sqrt(),
            Target::Best => x[0],
        };
        Some(vec![first, 0.1 * first])
    }
}

#[test]
fn structure_is_made_use_of() {
    let mut algorithm = FrontDe::new(Structured.variables(), FrontDeSettings::default(), 1);
    let archive = run(&Structured, &mut algorithm, 300);
    assert!(archive.len() > 100);
    for member in archive.iter() {
        assert_eq!(
            member.x[1],
            0.1 * member.x[0],
            "every candidate is completed before it is evaluated"
        );
    }
    let levels = (0..20)
        .flat_map(|_| algorithm.ask())
        .filter_map(|candidate| match candidate.target {
            Some(Target::Level(level)) => Some(level),
            _ => None,
        });
    let levels: Vec<f64> = levels.collect();
    assert!(levels.len() > 20 && levels.iter().any(|level| *level < 0.3) && levels.iter().any(|level| *level > 0.7));
}

/// Fraction of the area under the best front, a curve over a parameter from 0 to 1, that a search leaves out.
fn missing(archive: &Archive, best: impl Fn(f64) -> [f64; 2], reference: [f64; 2]) -> f64 {
    let whole = hypervolume((0..=20_000).map(|step| best(f64::from(step) / 20_000.0)), reference);
    1.0 - hypervolume(archive.iter().map(|member| member.objectives), reference) / whole
}

/// A frame of two lengths whose bars follow from the reach asked for: the reach `x0 (1 − 2 (x1 − 0.3 x0)²)` is bought by a thickness that
/// grows with its square, and the mass is that of the bars. On the front, `x1 = 0.3 x0`, and a reach `R` weighs `(0.2 + R²)(1 + R)`. The
/// frame comes in two kinds, of which the second one is twice as heavy.
struct Frame;

impl Frame {
    fn reach(x: &[f64]) -> f64 {
        let off = x[1] - 0.3 * x[0];
        x[0] * (1.0 - 2.0 * off * off)
    }

    fn missing(archive: &Archive) -> f64 {
        let best = |reach: f64| [(0.2 + reach * reach) * (1.0 + reach), -reach];
        missing(archive, best, [2.4, 0.0])
    }
}

impl Problem for Frame {
    fn variables(&self) -> Vec<Variable> {
        let real = Variable::Real { lower: 0.0, upper: 1.0 };
        vec![Variable::Categorical { choices: 2 }, real, real, real]
    }

    fn evaluate(&self, x: &[f64]) -> Outcome {
        let reach = Self::reach(&x[1..]).min((x[3] - 0.2).max(0.0).sqrt());
        let violation = (0.2 - x[3]).max(0.0);
        Outcome {
            objectives: [x[3] * (1.0 + x[1]) * (1.0 + x[0]), -reach].into(),
            violation,
        }
    }

    fn complete(&self, x: &[f64], target: Target) -> Option<Vec<f64>> {
        let largest = Self::reach(&x[1..]).max(0.0);
        let reach = match target {
            Target::Level(level) if -level < largest => (-level).max(0.0),
            _ => largest,
        };
        Some(vec![x[0], x[1], x[2], 0.2 + reach * reach])
    }

    fn determined_variables(&self) -> Vec<usize> {
        vec![3]
    }
}

/// The settings by default, and the same without learning.
fn with_and_without_learning() -> [FrontDeSettings; 2] {
    let settings = FrontDeSettings::default();
    let learned = 0.0;
    [settings, FrontDeSettings { learned, ..settings }]
}

/// Asserts that a search repeats itself, and that learning leaves out little of the front: less than a share of it, and than a share of
/// what is missing without learning.
fn assert_learned(problem: &impl Problem, evaluations: usize, missing: fn(&Archive) -> f64, [most, share]: [f64; 2]) {
    let [settings, unlearned] = with_and_without_learning();
    for seed in 1..=5 {
        let search = |settings| run(problem, &mut FrontDe::for_problem(problem, settings, seed), evaluations);
        assert_eq!(search(settings), search(settings));
        let [learned, without] = [settings, unlearned].map(|settings| missing(&search(settings)));
        assert!(
            learned < most && learned < share * without,
            "seed {seed}: {learned} is missing, and {without} without learning"
        );
    }
}

#[test]
fn a_front_is_learned_where_the_problem_determines_variables() {
    assert_learned(&Frame, 600, Frame::missing, [0.005, 0.6]);
}

/// A table of a size `x0`, whose legs have the thickness that its size and its proportion ask for, `0.2 + (1 − x0)² + 2 (x1 − 0.3 x0)²`,
/// whatever level is asked for: a small table is heavy. On the front, `x1 = 0.3 x0`.
struct Table;

impl Table {
    fn thickness(size: f64, proportion: f64) -> f64 {
        let off = proportion - 0.3 * size;
        0.2 + (1.0 - size) * (1.0 - size) + 2.0 * off * off
    }

    fn missing(archive: &Archive) -> f64 {
        let best = |size: f64| [Self::thickness(size, 0.3 * size), size];
        missing(archive, best, [1.2, 1.0])
    }
}

impl Problem for Table {
    fn variables(&self) -> Vec<Variable> {
        vec![Variable::Real { lower: 0.0, upper: 1.0 }; 3]
    }

    fn evaluate(&self, x: &[f64]) -> Outcome {
        Outcome {
            objectives: [x[2], x[0]].into(),
            violation: (Self::thickness(x[0], x[1]) - x[2]).max(0.0),
        }
    }

    fn leveled_objective(&self) -> usize {
        2
    }

    fn learned_objective(&self) -> usize {
        1
    }

    fn complete(&self, x: &[f64], target: Target) -> Option<Vec<f64>> {
        assert_eq!(target, Target::Best, "no objective has levels");
        Some(vec![x[0], x[1], Self::thickness(x[0], x[1])])
    }

    fn determined_variables(&self) -> Vec<usize> {
        vec![2]
    }
}

#[test]
fn a_front_without_levels_is_learned_too() {
    assert_learned(&Table, 400, Table::missing, [0.01, 0.8]);
}

/// Where the algorithm is told nothing of the structure, or the problem has none, learning changes no bit.
#[test]
fn without_determined_variables_nothing_is_learned() {
    let [settings, unlearned] = with_and_without_learning();
    let of_frame = |mut algorithm: FrontDe| run(&Frame, &mut algorithm, 600);
    assert_eq!(
        of_frame(FrontDe::new(Frame.variables(), settings, 5)),
        of_frame(FrontDe::for_problem(&Frame, unlearned, 5))
    );
    let of_structured = |settings| run(&Structured, &mut FrontDe::for_problem(&Structured, settings, 5), 600);
    assert_eq!(of_structured(settings), of_structured(unlearned));
}

/// The candidates depend on nothing but the random seed and the evaluations: the same seed gives the same candidates,
/// another seed gives others, and all are within the bounds.
#[test]
fn algorithms_repeat_themselves_and_stay_in_bounds() {
    for make in MAKERS {
        let record = |seed| {
            let mut algorithm = make(seed);
            let mut asked = Vec::new();
            for _ in 0..40 {
                let candidates = algorithm.ask();
                asked.extend(candidates.clone());
                let tell = |candidate: Candidate| Evaluated {
                    outcome: Mixed.evaluate(&candidate.x),
                    x: candidate.x,
                };
                algorithm.tell(candidates.into_iter().map(tell).collect());
            }
            asked
        };
        let first = record(7);
        assert_eq!(first, record(7));
        assert_ne!(first, record(8));
        assert!(
            first
                .iter()
                .all(|Candidate { x, .. }| [0.0, 1.0, 2.0].contains(&x[0]) && (0.0..=3.0).contains(&x[1]))
        );
    }
}

#[test]
fn a_sobol_sample_gives_each_choice_its_share() {
    let variables = [
        Variable::Categorical { choices: 3 },
        Variable::Real { lower: 2.0, upper: 4.0 },
    ];
    let sample = sobol(&variables, 30, 1);
    for choice in 0..3 {
        let count = sample.iter().filter(|x| x[0] == f64::from(choice)).count();
        assert!((8..=12).contains(&count), "choice {choice}: {count} of 30");
    }
    let lower_half = sample.iter().filter(|x| x[1] < 3.0).count();
    assert!((13..=17).contains(&lower_half));
    assert_eq!(sample, sobol(&variables, 30, 1));
    assert_ne!(sample, sobol(&variables, 30, 2));
}

#[test]
fn hypervolume_of_known_fronts() {
    assert_eq!(hypervolume([[0.0; 2]; 0], [1.0, 1.0]), 0.0);
    assert_eq!(hypervolume([[0.0, 0.0]], [2.0, 3.0]), 6.0);
    assert_eq!(
        hypervolume([[1.0, 2.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]], [3.0, 3.0]),
        3.0
    );
    assert_eq!(hypervolume([[4.0, 0.0]], [3.0, 3.0]), 0.0);
}

fn outcome() -> impl Strategy<Value = Outcome> {
    // A coarse lattice, so that ties and duplicates occur.
    (0..8i32, 0..8i32, 0..3i32).prop_map(|(first, second, violation)| Outcome {
        objectives: [f64::from(first), f64::from(second)].into(),
        violation: f64::from(violation.max(1) - 1),
    })
}

proptest! {
    #[test]
    fn the_archive_is_the_non_dominated_feasible_set(outcomes in prop::collection::vec(outcome(), 0..60)) {
        let mut archive = Archive::default();
        for (id, &outcome) in outcomes.iter().enumerate() {
            archive.insert(id, &[id as f64], &outcome);
        }
        let mut wanted: Vec<Objectives> = outcomes
            .iter()
            .filter(|a| a.is_feasible() && outcomes.iter().all(|b| compare(b, a) != Relation::Dominates))
            .map(|a| a.objectives)
            .collect();
        wanted.sort_by(|a, b| a[0].total_cmp(&b[0]));
        wanted.dedup();
        let found: Vec<Objectives> = archive.iter().map(|member| member.objectives).collect();
        prop_assert_eq!(found, wanted);
    }

    #[test]
    fn ranks_are_layers_of_dominance(outcomes in prop::collection::vec(outcome(), 1..40)) {
        let ranks = non_dominated_ranks(&outcomes);
        for (i, a) in outcomes.iter().enumerate() {
            let above = outcomes
                .iter()
                .zip(&ranks)
                .filter(|(b, _)| compare(b, a) == Relation::Dominates)
                .map(|(_, rank)| rank + 1)
                .max()
                .unwrap_or(0);
            prop_assert_eq!(ranks[i], above);
        }
    }

    #[test]
    fn hypervolume_equals_counting_cells(points in prop::collection::vec((0..8u8, 0..8u8), 0..20)) {
        let cells = (0..8u8)
            .flat_map(|x| (0..8u8).map(move |y| (x, y)))
            .filter(|&(x, y)| points.iter().any(|&(a, b)| a <= x && b <= y))
            .count();
        let points = points.iter().map(|&(x, y)| [f64::from(x), f64::from(y)]);
        prop_assert_eq!(hypervolume(points, [8.0, 8.0]), cells as f64);
    }

    #[test]
    fn the_ends_of_a_front_are_never_crowded(front in prop::collection::vec((0.0..1.0, 0.0..1.0), 1..20)) {
        let front: Vec<[f64; 2]> = front.into_iter().map(|(a, b)| [a, b]).collect();
        let distances = crowding_distances(&front);
        for objective in 0..2 {
            let least = (0..front.len()).min_by(|&a, &b| front[a][objective].total_cmp(&front[b][objective]));
            prop_assert_eq!(distances[least.expect("not empty")], f64::INFINITY);
        }
        prop_assert!(distances.iter().all(|distance| *distance >= 0.0));
    }
}
