//! Dominance, archive, hypervolume and the algorithms, on problems whose fronts are known.

use kinefront::optimize::{
    Algorithm, Archive, Evaluated, Moga2, Moga2Settings, Nsga2, Nsga2Settings, Outcome, Problem, Relation, Variable,
    compare, crowding_distances, drive, hypervolume, non_dominated_ranks, sobol,
};
use proptest::prelude::*;

/// ZDT1 (Zitzler, Deb, Thiele 2000) in 10 variables: the front is f2 = 1 − √f1.
struct Zdt1;

impl Problem for Zdt1 {
    fn variables(&self) -> Vec<Variable> {
        vec![Variable::Real { lower: 0.0, upper: 1.0 }; 10]
    }

    fn evaluate(&self, x: &[f64]) -> Outcome {
        let g = 1.0 + x[1..].iter().sum::<f64>();
        Outcome {
            objectives: [x[0], g * (1.0 - (x[0] / g).sqrt())],
            violation: 0.0,
        }
    }
}

/// BNH (Binh, Korn 1997), constrained.
struct Bnh;

impl Problem for Bnh {
    fn variables(&self) -> Vec<Variable> {
        vec![
            Variable::Real { lower: 0.0, upper: 5.0 },
            Variable::Real { lower: 0.0, upper: 3.0 },
        ]
    }

    fn evaluate(&self, x: &[f64]) -> Outcome {
        let square = |value: f64| value * value;
        let first = square(x[0] - 5.0) + square(x[1]) - 25.0;
        let second = 7.7 - square(x[0] - 8.0) - square(x[1] + 3.0);
        Outcome {
            objectives: [
                4.0 * (square(x[0]) + square(x[1])),
                square(x[0] - 5.0) + square(x[1] - 5.0),
            ],
            violation: first.max(0.0) + second.max(0.0),
        }
    }
}

/// A choice and a number: each choice is best over a part of the front.
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
            objectives: [x[1], 3.0 - x[1] + 4.0 * off * off],
            violation: 0.0,
        }
    }
}

fn volume(archive: &Archive, reference: [f64; 2]) -> f64 {
    hypervolume(archive.iter().map(|member| member.objectives), reference)
}

#[test]
fn nsga2_reaches_the_front_of_zdt1() {
    let settings = Nsga2Settings {
        population: 100,
        ..Nsga2Settings::default()
    };
    for seed in 1..=3 {
        let archive = drive(&Zdt1, &mut Nsga2::new(Zdt1.variables(), settings, seed), 20_000);
        // The whole front dominates 2/3 of the unit square beside what lies outside it: 1.1·1.1 − 1/3.
        let share = volume(&archive, [1.1, 1.1]) / (1.21 - 1.0 / 3.0);
        assert!(share > 0.985 && share < 1.0, "seed {seed}: {share}");
    }
}

#[test]
fn both_algorithms_solve_a_constrained_problem() {
    // Area of the front (0, 50) – (136, 4) against the reference (150, 55), by a fine sample of the known optima:
    // x1 = x2 in [0, 3], then x2 = 3 and x1 in [3, 5].
    let optima = (0..=3000)
        .map(|k| [f64::from(k) * 1e-3; 2])
        .chain((0..=2000).map(|k| [3.0 + f64::from(k) * 1e-3, 3.0]))
        .map(|x| Bnh.evaluate(&x).objectives);
    let reference = [150.0, 55.0];
    let whole = hypervolume(optima, reference);
    let nsga2 = drive(
        &Bnh,
        &mut Nsga2::new(Bnh.variables(), Nsga2Settings::default(), 1),
        6000,
    );
    let moga2 = drive(
        &Bnh,
        &mut Moga2::new(Bnh.variables(), Moga2Settings::default(), 1),
        6000,
    );
    for (name, archive) in [("nsga2", nsga2), ("moga2", moga2)] {
        let share = volume(&archive, reference) / whole;
        assert!(share > 0.99 && share < 1.0001, "{name}: {share}");
        assert!(archive.iter().all(|member| Bnh.evaluate(&member.x).is_feasible()));
    }
}

#[test]
fn every_choice_finds_its_part_of_the_front() {
    let nsga2 = drive(
        &Mixed,
        &mut Nsga2::new(Mixed.variables(), Nsga2Settings::default(), 3),
        6000,
    );
    let moga2 = drive(
        &Mixed,
        &mut Moga2::new(Mixed.variables(), Moga2Settings::default(), 3),
        6000,
    );
    for archive in [nsga2, moga2] {
        for choice in [0.0, 1.0, 2.0] {
            assert!(
                archive.iter().any(|member| member.x[0] == choice),
                "choice {choice} is missing"
            );
        }
    }
}

/// Asking is pure state: the same seed asks the same, another seed asks otherwise, bounds hold.
#[test]
fn algorithms_repeat_themselves_and_stay_in_bounds() {
    let algorithms: [fn(u64) -> Box<dyn Algorithm>; 2] = [
        |seed| Box::new(Nsga2::new(Mixed.variables(), Nsga2Settings::default(), seed)),
        |seed| Box::new(Moga2::new(Mixed.variables(), Moga2Settings::default(), seed)),
    ];
    for make in algorithms {
        let record = |seed| {
            let mut algorithm = make(seed);
            let mut asked = Vec::new();
            for _ in 0..40 {
                let candidates = algorithm.ask();
                asked.extend(candidates.clone());
                let tell = |x: Vec<f64>| Evaluated {
                    outcome: Mixed.evaluate(&x),
                    x,
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
                .all(|x| [0.0, 1.0, 2.0].contains(&x[0]) && (0.0..=3.0).contains(&x[1]))
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
    assert_eq!(hypervolume([], [1.0, 1.0]), 0.0);
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
        objectives: [f64::from(first), f64::from(second)],
        violation: f64::from(violation.max(1) - 1),
    })
}

proptest! {
    #[test]
    fn the_archive_is_the_non_dominated_feasible_set(outcomes in prop::collection::vec(outcome(), 0..60)) {
        let mut archive = Archive::default();
        for (id, &outcome) in outcomes.iter().enumerate() {
            archive.insert(id, &Evaluated { x: vec![id as f64], outcome });
        }
        let mut wanted: Vec<[f64; 2]> = outcomes
            .iter()
            .filter(|a| a.is_feasible() && outcomes.iter().all(|b| compare(b, a) != Relation::Dominates))
            .map(|a| a.objectives)
            .collect();
        wanted.sort_by(|a, b| a[0].total_cmp(&b[0]));
        wanted.dedup();
        let found: Vec<[f64; 2]> = archive.iter().map(|member| member.objectives).collect();
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
