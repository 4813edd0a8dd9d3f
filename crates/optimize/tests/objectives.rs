//! One and three objectives: archive, hypervolume, and the algorithms on problems whose optima are known.

use kinefront_optimize::{
    Algorithm, Archive, CmaEs, CmaEsSettings, FrontDe, FrontDeSettings, Moga2, Moga2Settings, Nsga2, Nsga2Settings,
    Objectives, Outcome, Problem, Relation, Target, Variable, compare, hypervolume, run,
};
use proptest::prelude::*;

fn outcome(count: usize) -> impl Strategy<Value = Outcome> {
    // A coarse lattice, so that ties and duplicates occur.
    (prop::collection::vec(0..6i32, count), 0..3i32).prop_map(|(values, violation)| Outcome {
        objectives: Objectives::new(values.into_iter().map(f64::from)),
        violation: f64::from(violation.max(1) - 1),
    })
}

fn outcomes() -> impl Strategy<Value = Vec<Outcome>> {
    (1..4usize).prop_flat_map(|count| prop::collection::vec(outcome(count), 0..60))
}

proptest! {
    #[test]
    fn the_archive_is_the_non_dominated_feasible_set(outcomes in outcomes()) {
        let mut archive = Archive::default();
        for (id, outcome) in outcomes.iter().enumerate() {
            archive.insert(id, &[], outcome);
        }
        let mut wanted: Vec<Vec<f64>> = outcomes
            .iter()
            .filter(|a| a.is_feasible() && outcomes.iter().all(|b| compare(b, a) != Relation::Dominates))
            .map(|a| a.objectives.to_vec())
            .collect();
        wanted.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
        wanted.dedup();
        let mut found: Vec<Vec<f64>> = archive.iter().map(|member| member.objectives.to_vec()).collect();
        prop_assert!(found.is_sorted_by(|a, b| a[0] <= b[0]));
        found.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
        prop_assert_eq!(found, wanted);
    }

    #[test]
    fn the_hypervolume_of_three_objectives_equals_counting_cells(
        points in prop::collection::vec((0..6u8, 0..6u8, 0..6u8), 0..30),
    ) {
        let mut cells = 0;
        for x in 0..6u8 {
            for y in 0..6u8 {
                for z in 0..6u8 {
                    cells += usize::from(points.iter().any(|&(a, b, c)| a <= x && b <= y && c <= z));
                }
            }
        }
        let points = points.iter().map(|&(x, y, z)| [f64::from(x), f64::from(y), f64::from(z)]);
        prop_assert_eq!(hypervolume(points, [6.0; 3]), cells as f64);
    }
}

#[test]
fn the_hypervolume_of_one_objective_is_a_length() {
    assert_eq!(hypervolume([[3.0], [1.0], [7.0]], [5.0]), 4.0);
    assert_eq!(hypervolume([[6.0]], [5.0]), 0.0);
}

/// DTLZ2 (Deb et al. 2002): the front is the positive octant of the unit sphere.
struct Dtlz2;

impl Problem for Dtlz2 {
    fn variables(&self) -> Vec<Variable> {
        vec![Variable::Real { lower: 0.0, upper: 1.0 }; 12]
    }

    fn evaluate(&self, x: &[f64]) -> Outcome {
        let g: f64 = x[2..].iter().map(|x| (x - 0.5) * (x - 0.5)).sum();
        let [a, b] = [x[0], x[1]].map(|x| x * std::f64::consts::FRAC_PI_2);
        let r = 1.0 + g;
        Outcome {
            objectives: [r * a.cos() * b.cos(), r * a.cos() * b.sin(), r * a.sin()].into(),
            violation: 0.0,
        }
    }
}

/// The volume below the reference point (1.1, 1.1, 1.1) that the octant of the sphere leaves.
const DTLZ2_VOLUME: f64 = 1.331 - std::f64::consts::PI / 6.0;

#[test]
fn three_objectives_approach_the_sphere() {
    let variables = || Dtlz2.variables();
    let algorithms: [(Box<dyn Algorithm>, f64); 3] = [
        (Box::new(FrontDe::new(variables(), FrontDeSettings::default(), 3)), 0.93),
        (Box::new(Nsga2::new(variables(), Nsga2Settings::default(), 3)), 0.93),
        (Box::new(Moga2::new(variables(), Moga2Settings::default(), 3)), 0.3),
    ];
    for (mut algorithm, wanted) in algorithms {
        let archive = run(&Dtlz2, algorithm.as_mut(), 6000);
        let volume = hypervolume(archive.iter().map(|member| member.objectives), [1.1; 3]);
        let share = volume / DTLZ2_VOLUME;
        assert!((wanted..1.0).contains(&share), "{share}");
    }
}

/// A sphere in rotated axes with one active constraint and two categories, of which the second is better; the last variable
/// follows from the first.
struct Rotated;

impl Problem for Rotated {
    fn variables(&self) -> Vec<Variable> {
        let real = Variable::Real {
            lower: -4.0,
            upper: 6.0,
        };
        vec![Variable::Categorical { choices: 2 }, real, real, real, real]
    }

    fn evaluate(&self, x: &[f64]) -> Outcome {
        let [a, b, c] = [x[1] - 1.0 + x[2], x[2] - x[3], x[3] + x[1] - 0.3];
        let value = a * a + 100.0 * b * b + 10.0 * c * c + (x[4] - x[1]).abs() + 2.0 - x[0];
        // At least 1 of the sum of two variables.
        let short = (1.0 - x[1] - x[2]).max(0.0);
        Outcome {
            objectives: [value].into(),
            violation: short,
        }
    }

    fn complete(&self, x: &[f64], _: Target) -> Option<Vec<f64>> {
        let mut x = x.to_vec();
        x[4] = x[1];
        Some(x)
    }
}

#[test]
fn the_evolution_strategy_finds_the_constrained_minimum_of_the_better_category() {
    for seed in 0..5 {
        let mut algorithm = CmaEs::new(Rotated.variables(), CmaEsSettings::default(), seed);
        let archive = run(&Rotated, &mut algorithm, 2500);
        assert_eq!(archive.len(), 1);
        let best = &archive[0];
        assert_eq!(best.x[0], 1.0, "seed {seed}");
        // With x1 + x2 = 1 and d = x2 − x3, 100 d² + 10 (0.7 − d)² is least at d = 7/110.
        let least = 4.9 * 100.0 / 110.0 + 1.0;
        assert!((best.objectives[0] - least).abs() < 1e-6, "seed {seed}: {best:?}");
    }
}

#[test]
fn the_evolution_strategy_is_repeatable() {
    let found = |seed| {
        let mut algorithm = CmaEs::new(Rotated.variables(), CmaEsSettings::default(), seed);
        run(&Rotated, &mut algorithm, 600)
    };
    assert_eq!(found(7), found(7));
    assert_ne!(found(7), found(8));
}

/// Valleys with steep walls, sharp floors and one lowest point each: valley `k` runs along `y = 0.55 x + 0.01 k`, and the lowest
/// points of the valleys lie on a parabola about that of valley 0, whose value is 30.
struct Valleys;

impl Problem for Valleys {
    fn variables(&self) -> Vec<Variable> {
        vec![
            Variable::Real {
                lower: -1.0,
                upper: 1.0
            };
            3
        ]
    }

    fn evaluate(&self, x: &[f64]) -> Outcome {
        let of_valley = |k: i32| {
            let shift = f64::from(k);
            let (across, along) = (x[1] - 0.55 * x[0] - 0.01 * shift, x[0] - 0.2 - 0.004 * shift);
            let wall = (300.0 * across).max(-500.0 * across);
            let floor = (6.0 * along).max(-9.0 * along);
            30.0 + 4e-3 * shift * shift + wall + floor
        };
        let value = (-60..=60).map(of_valley).fold(f64::INFINITY, f64::min);
        Outcome {
            objectives: [value].into(),
            violation: 0.0,
        }
    }

    /// The last variable is left to the problem.
    fn complete(&self, x: &[f64], _: Target) -> Option<Vec<f64>> {
        Some(vec![x[0], x[1], 0.5])
    }

    fn determined_variables(&self) -> Vec<usize> {
        vec![2]
    }
}

#[test]
fn descents_find_the_lowest_of_many_sharp_valleys() {
    let found: Vec<f64> = (0..8)
        .map(|seed| {
            let mut algorithm = CmaEs::for_problem(&Valleys, CmaEsSettings::default(), seed);
            run(&Valleys, &mut algorithm, 3000)[0].objectives[0]
        })
        .collect();
    let lowest = found.iter().filter(|value| (**value - 30.0).abs() < 3e-5).count();
    assert!(lowest >= 7, "{found:?}");
    assert!(found.iter().all(|value| *value < 30.05), "{found:?}");
}
