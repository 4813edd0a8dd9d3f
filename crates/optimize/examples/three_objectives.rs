//! Three objectives: the optimizers on problems whose fronts are surfaces (Deb et al. 2002), and on a welded beam.
//!
//! `cargo run --release -p kinefront-optimize --example three_objectives -- dtlz2 front-de 6000 1` prints the hypervolume of the
//! non-dominated candidates. `benches/comparison/three.py` compares it with that of other programs.

use std::f64::consts::{FRAC_PI_2, PI};

use kinefront_optimize::{
    Algorithm, FrontDe, FrontDeSettings, Nsga2, Nsga2Settings, Outcome, Problem, Variable, hypervolume, run,
};

/// A problem by its formulas.
struct Named {
    bounds: Vec<[f64; 2]>,
    reference: [f64; 3],
    formulas: fn(&[f64]) -> ([f64; 3], f64),
}

impl Problem for Named {
    fn variables(&self) -> Vec<Variable> {
        let real = |&[lower, upper]: &[f64; 2]| Variable::Real { lower, upper };
        self.bounds.iter().map(real).collect()
    }

    fn evaluate(&self, x: &[f64]) -> Outcome {
        let (objectives, violation) = (self.formulas)(x);
        Outcome {
            objectives: objectives.into(),
            violation,
        }
    }
}

/// Point of a surface given by two angles, at the distance 1 + g.
fn sphere(g: f64, [first, second]: [f64; 2]) -> [f64; 3] {
    let r = 1.0 + g;
    [
        r * first.cos() * second.cos(),
        r * first.cos() * second.sin(),
        r * first.sin(),
    ]
}

fn off_middle(x: &[f64]) -> f64 {
    x.iter().map(|x| (x - 0.5) * (x - 0.5)).sum()
}

fn dtlz2(x: &[f64]) -> ([f64; 3], f64) {
    (sphere(off_middle(&x[2..]), [x[0] * FRAC_PI_2, x[1] * FRAC_PI_2]), 0.0)
}

fn dtlz5(x: &[f64]) -> ([f64; 3], f64) {
    let g = off_middle(&x[2..]);
    let second = PI / (4.0 * (1.0 + g)) * (1.0 + 2.0 * g * x[1]);
    (sphere(g, [x[0] * FRAC_PI_2, second]), 0.0)
}

fn dtlz7(x: &[f64]) -> ([f64; 3], f64) {
    let g = 1.0 + 9.0 / 20.0 * x[2..].iter().sum::<f64>();
    let wave = |x: f64| x / (1.0 + g) * (1.0 + (3.0 * PI * x).sin());
    ([x[0], x[1], (1.0 + g) * (3.0 - wave(x[0]) - wave(x[1]))], 0.0)
}

/// Cost, deflection and shear stress of a welded beam (Deb, Pratap, Moitra 2000) in units of 10 \[–\], 0.01 in and 13 600 psi.
fn welded_beam(x: &[f64]) -> ([f64; 3], f64) {
    let [h, l, t, b] = [x[0], x[1], x[2], x[3]];
    let cost = 1.10471 * h * h * l + 0.04811 * t * b * (14.0 + l);
    let deflection = 2.1952 / (t * t * t * b);
    let primary = 6000.0 / (std::f64::consts::SQRT_2 * h * l);
    let radius = (0.25 * (l * l + (h + t) * (h + t))).sqrt();
    let area = 2.0 * 0.707 * h * l * (l * l / 12.0 + 0.25 * (h + t) * (h + t));
    let secondary = 6000.0 * (14.0 + 0.5 * l) * radius / area;
    let shear = (primary * primary + secondary * secondary + l * primary * secondary / radius).sqrt();
    let bending = 504_000.0 / (t * t * b);
    let buckling = 64_746.022 * (1.0 - 0.028_234_6 * t) * t * b * b * b;
    let violation = (shear / 13_600.0 - 1.0).max(0.0)
        + (bending / 30_000.0 - 1.0).max(0.0)
        + ((h - b) / 5.0).max(0.0)
        + (1.0 - buckling / 6000.0).max(0.0);
    ([cost / 10.0, 100.0 * deflection, shear / 13_600.0], violation)
}

fn problem(name: &str) -> Option<Named> {
    let unit = |count: usize| vec![[0.0, 1.0]; count];
    Some(match name {
        "dtlz2" => Named {
            bounds: unit(12),
            reference: [1.1; 3],
            formulas: dtlz2,
        },
        "dtlz5" => Named {
            bounds: unit(12),
            reference: [1.1; 3],
            formulas: dtlz5,
        },
        "dtlz7" => Named {
            bounds: unit(22),
            reference: [1.1, 1.1, 6.6],
            formulas: dtlz7,
        },
        "welded-beam" => Named {
            bounds: vec![[0.125, 5.0], [0.1, 10.0], [0.1, 10.0], [0.125, 5.0]],
            reference: [4.0, 2.0, 1.0],
            formulas: welded_beam,
        },
        _ => return None,
    })
}

fn main() -> Result<(), String> {
    let usage = "usage: three_objectives dtlz2|dtlz5|dtlz7|welded-beam front-de|nsga2 EVALUATIONS SEED";
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.is_empty() {
        arguments = ["dtlz2", "front-de", "6000", "1"].map(str::to_owned).to_vec();
    }
    let [name, algorithm, evaluations, seed] = arguments.as_slice() else {
        return Err(usage.to_owned());
    };
    let problem = problem(name).ok_or(usage)?;
    let evaluations: usize = evaluations.parse().map_err(|_| usage)?;
    let seed: u64 = seed.parse().map_err(|_| usage)?;
    let variables = problem.variables();
    let mut algorithm: Box<dyn Algorithm> = match algorithm.as_str() {
        "front-de" => Box::new(FrontDe::new(variables, FrontDeSettings::default(), seed)),
        "nsga2" => Box::new(Nsga2::new(variables, Nsga2Settings::default(), seed)),
        _ => return Err(usage.to_owned()),
    };
    let archive = run(&problem, algorithm.as_mut(), evaluations);
    let volume = hypervolume(archive.iter().map(|member| member.objectives), problem.reference);
    println!("{volume}");
    Ok(())
}
