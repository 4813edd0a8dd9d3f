//! Your own problem: cost against deflection of a welded beam (Deb, Pratap, Moitra 2000), by two algorithms.
//!
//! `cargo run --release -p kinefront-optimize --example welded_beam`

use kinefront_optimize::{Algorithm, FrontDe, FrontDeSettings, Nsga2, Nsga2Settings, Outcome, Problem, Variable, run};

struct WeldedBeam;

impl Problem for WeldedBeam {
    /// Thickness `h` and length `l` of the weld, height `t` and thickness `b` of the beam \[in\].
    fn variables(&self) -> Vec<Variable> {
        [[0.125, 5.0], [0.1, 10.0], [0.1, 10.0], [0.125, 5.0]]
            .map(|[lower, upper]| Variable::Real { lower, upper })
            .to_vec()
    }

    fn evaluate(&self, x: &[f64]) -> Outcome {
        let [h, l, t, b] = [x[0], x[1], x[2], x[3]];
        let cost = 1.10471 * h * h * l + 0.04811 * t * b * (14.0 + l);
        let deflection = 2.1952 / (t * t * t * b);
        let primary = 6000.0 / (std::f64::consts::SQRT_2 * h * l);
        let radius = (0.25 * (l * l + (h + t) * (h + t))).sqrt();
        let secondary =
            6000.0 * (14.0 + 0.5 * l) * radius / (2.0 * 0.707 * h * l * (l * l / 12.0 + 0.25 * (h + t) * (h + t)));
        let shear = (primary * primary + secondary * secondary + l * primary * secondary / radius).sqrt();
        let bending = 504_000.0 / (t * t * b);
        let buckling = 64_746.022 * (1.0 - 0.028_234_6 * t) * t * b * b * b;
        let violation = (shear / 13_600.0 - 1.0).max(0.0)
            + (bending / 30_000.0 - 1.0).max(0.0)
            + ((h - b) / 5.0).max(0.0)
            + (1.0 - buckling / 6000.0).max(0.0);
        Outcome {
            objectives: [cost, deflection].into(),
            violation,
        }
    }
}

fn main() {
    let front_de = FrontDeSettings {
        population: 60,
        ..FrontDeSettings::default()
    };
    let algorithms: [(&str, Box<dyn Algorithm>); 2] = [
        ("front-de", Box::new(FrontDe::new(WeldedBeam.variables(), front_de, 1))),
        (
            "NSGA-II",
            Box::new(Nsga2::new(WeldedBeam.variables(), Nsga2Settings::default(), 1)),
        ),
    ];
    for (name, mut algorithm) in algorithms {
        let archive = run(&WeldedBeam, algorithm.as_mut(), 10_000);
        let cheapest = archive.iter().next().expect("a feasible design");
        println!(
            "{name}: {} designs on the front; the cheapest costs {:.3} and deflects by {:.4} in",
            archive.len(),
            cheapest.objectives[0],
            cheapest.objectives[1]
        );
        // The best cost known is 2.381.
        assert!((2.38..2.6).contains(&cheapest.objectives[0]), "{cheapest:?}");
    }
}
