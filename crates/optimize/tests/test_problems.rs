//! Published test problems, on which the algorithms must reach the hypervolume that pymoo's NSGA-II reaches.

use std::f64::consts::PI;

use kinefront_optimize::{
    Algorithm, FrontDe, FrontDeSettings, Nsga2, Nsga2Settings, Outcome, Problem, Variable, hypervolume, run,
};
use rayon::prelude::*;

/// Made by crates/optimize/tests/tools/pymoo_fronts.py.
const PYMOO: &str = include_str!("fixtures/pymoo_nsga2.json");

/// A problem given by formulas: bounds, objectives, and constraint functions that must not be positive.
struct Formula {
    name: &'static str,
    bounds: Vec<[f64; 2]>,
    objectives: fn(&[f64]) -> [f64; 2],
    constraints: fn(&[f64]) -> Vec<f64>,
}

impl Problem for Formula {
    fn variables(&self) -> Vec<Variable> {
        self.bounds
            .iter()
            .map(|&[lower, upper]| Variable::Real { lower, upper })
            .collect()
    }

    fn evaluate(&self, x: &[f64]) -> Outcome {
        Outcome {
            objectives: (self.objectives)(x).into(),
            violation: (self.constraints)(x).into_iter().map(|value| value.max(0.0)).sum(),
        }
    }
}

fn square(value: f64) -> f64 {
    value * value
}

/// Osyczka and Kundu 1995; each constraint is divided by its right-hand side.
fn osy() -> Formula {
    Formula {
        name: "osy",
        bounds: vec![
            [0.0, 10.0],
            [0.0, 10.0],
            [1.0, 5.0],
            [0.0, 6.0],
            [1.0, 5.0],
            [0.0, 10.0],
        ],
        objectives: |x| {
            [
                -(25.0 * square(x[0] - 2.0)
                    + square(x[1] - 2.0)
                    + square(x[2] - 1.0)
                    + square(x[3] - 4.0)
                    + square(x[4] - 1.0)),
                x.iter().map(|value| square(*value)).sum(),
            ]
        },
        constraints: |x| {
            vec![
                -(x[0] + x[1] - 2.0) / 2.0,
                -(6.0 - x[0] - x[1]) / 6.0,
                -(2.0 - x[1] + x[0]) / 2.0,
                -(2.0 - x[0] + 3.0 * x[1]) / 2.0,
                -(4.0 - square(x[2] - 3.0) - x[3]) / 4.0,
                -(square(x[4] - 3.0) + x[5] - 4.0) / 4.0,
            ]
        },
    }
}

/// The problems with constraints.
fn constrained() -> Vec<Formula> {
    vec![
        // Binh and Korn 1997.
        Formula {
            name: "bnh",
            bounds: vec![[0.0, 5.0], [0.0, 3.0]],
            objectives: |x| {
                [
                    4.0 * (square(x[0]) + square(x[1])),
                    square(x[0] - 5.0) + square(x[1] - 5.0),
                ]
            },
            constraints: |x| {
                vec![
                    square(x[0] - 5.0) + square(x[1]) - 25.0,
                    7.7 - square(x[0] - 8.0) - square(x[1] + 3.0),
                ]
            },
        },
        osy(),
        // Tanaka et al. 1995.
        Formula {
            name: "tnk",
            bounds: vec![[0.0, PI], [1e-30, PI]],
            objectives: |x| [x[0], x[1]],
            constraints: |x| {
                vec![
                    -(square(x[0]) + square(x[1]) - 1.0 - 0.1 * (16.0 * (x[0] / x[1]).atan()).cos()),
                    2.0 * (square(x[0] - 0.5) + square(x[1] - 0.5)) - 1.0,
                ]
            },
        },
        // Srinivas and Deb 1994.
        Formula {
            name: "srn",
            bounds: vec![[-20.0, 20.0]; 2],
            objectives: |x| {
                [
                    2.0 + square(x[0] - 2.0) + square(x[1] - 1.0),
                    9.0 * x[0] - square(x[1] - 1.0),
                ]
            },
            constraints: |x| {
                vec![
                    (square(x[0]) + square(x[1]) - 225.0) / 225.0,
                    (x[0] - 3.0 * x[1] + 10.0) / 10.0,
                ]
            },
        },
    ]
}

/// ZDT (Zitzler, Deb, Thiele 2000): the objectives are `f1` and `f2 = g·h(f1/g)`.
fn zdt(name: &'static str, bounds: Vec<[f64; 2]>, objectives: fn(&[f64]) -> [f64; 2]) -> Formula {
    Formula {
        name,
        bounds,
        objectives,
        constraints: |_| Vec::new(),
    }
}

fn shaped(first: f64, g: f64, h: impl Fn(f64) -> f64) -> [f64; 2] {
    [first, g * h(first / g)]
}

fn linear_g(x: &[f64]) -> f64 {
    1.0 + 9.0 * x[1..].iter().sum::<f64>() / (x.len() - 1) as f64
}

fn unconstrained() -> Vec<Formula> {
    let unit = |count: usize| vec![[0.0, 1.0]; count];
    let mut zdt4 = vec![[-5.0, 5.0]; 10];
    zdt4[0] = [0.0, 1.0];
    vec![
        zdt("zdt1", unit(30), |x| {
            shaped(x[0], linear_g(x), |part| 1.0 - part.sqrt())
        }),
        zdt("zdt2", unit(30), |x| {
            shaped(x[0], linear_g(x), |part| 1.0 - square(part))
        }),
        zdt("zdt3", unit(30), |x| {
            shaped(x[0], linear_g(x), |part| {
                1.0 - part.sqrt() - part * (10.0 * PI * x[0]).sin()
            })
        }),
        zdt("zdt4", zdt4, |x| {
            let wave = |value: &f64| square(*value) - 10.0 * (4.0 * PI * value).cos();
            let g = 91.0 + x[1..].iter().map(wave).sum::<f64>();
            shaped(x[0], g, |part| 1.0 - part.sqrt())
        }),
        zdt("zdt6", unit(10), |x| {
            let first = 1.0 - (-4.0 * x[0]).exp() * (6.0 * PI * x[0]).sin().powi(6);
            let g = 1.0 + 9.0 * (x[1..].iter().sum::<f64>() / 9.0).powf(0.25);
            shaped(first, g, |part| 1.0 - square(part))
        }),
    ]
}

fn median(problem: &Formula, evaluations: usize, reference: [f64; 2], make: Make) -> f64 {
    let mut volumes: Vec<f64> = (1..=11)
        .into_par_iter()
        .map(|seed| {
            let archive = run(problem, &mut *make(problem.variables(), seed), evaluations);
            assert!(archive.iter().all(|member| problem.evaluate(&member.x).is_feasible()));
            hypervolume(archive.iter().map(|member| member.objectives), reference)
        })
        .collect();
    volumes.sort_by(f64::total_cmp);
    volumes[5]
}

type Make = fn(Vec<Variable>, u64) -> Box<dyn Algorithm>;

/// Compares the median hypervolume over 11 random seeds with that of pymoo's runs, at the same budget; all feasible
/// candidates count on both sides. A median may stay below pymoo's by as much as medians of 11 seeds differ between
/// sets of seeds. On OSY the difference is whether a run found the last segment of the front, which contributes 1.2 %
/// and which half of the seeds find, also in pymoo's runs.
fn reach(make: Make) {
    let pymoo: serde_json::Value = serde_json::from_str(PYMOO).expect("JSON");
    let evaluations = pymoo["evaluations"].as_u64().expect("a number") as usize;
    let mut short = Vec::new();
    for problem in constrained().into_iter().chain(unconstrained()) {
        let theirs = &pymoo["problems"][problem.name];
        let reference = [0, 1].map(|k| theirs["reference"][k].as_f64().expect("a number"));
        let fraction = median(&problem, evaluations, reference, make) / theirs["median"].as_f64().expect("a number");
        println!("{:5} {fraction:.5}", problem.name);
        let allowed = if problem.name == "osy" { 0.013 } else { 0.001 };
        if fraction < 1.0 - allowed {
            short.push(format!("{}: {fraction}", problem.name));
        }
    }
    assert!(
        short.is_empty(),
        "hypervolumes too small as fractions of pymoo's: {short:?}"
    );
}

#[test]
fn nsga2_reaches_what_pymoo_reaches() {
    reach(|variables, seed| Box::new(Nsga2::new(variables, Nsga2Settings::default(), seed)));
}

#[test]
fn front_de_reaches_what_pymoo_reaches() {
    // These problems have no structure, without which a small population gives no quick start.
    reach(|variables, seed| {
        let settings = FrontDeSettings {
            population: 60,
            most: 60,
            ..FrontDeSettings::default()
        };
        Box::new(FrontDe::new(variables, settings, seed))
    });
}
