//! Prices of single designs against an independent solver.

use glam::DVec2;
use kinefront_model::evaluation::{Better, ModelSettings, Objective, Quantity};
use kinefront_model::mechanism::{DESIGN_VARIABLES, Design, DesignVariable, WorkingMode};
use kinefront_model::polygon::Polygon;
use kinefront_model::workspace::{Region, WorkspaceSpec};
use kinefront_optimum::{FreeVariable, LocalProblem, LocalQuestion, Parameter};
use serde_json::Value;

fn cases() -> Vec<Value> {
    let text = include_str!("fixtures/prices_cases.json");
    let all: Value = serde_json::from_str(text).expect("the fixture is JSON");
    all["cases"].as_array().expect("cases").clone()
}

fn design_of(case: &Value) -> Design {
    let text = case["architecture"].as_str().expect("architecture");
    let architecture = kinefront_model::mechanism::Architecture::ALL
        .iter()
        .find(|a| a.name() == text)
        .expect("known");
    let values =
        DESIGN_VARIABLES.map(|variable: DesignVariable| case["design"][variable.key()].as_f64().expect("number"));
    Design::new(*architecture, WorkingMode::ALL_PLUS, values).expect("valid")
}

fn question(region: Region) -> LocalQuestion {
    let settings = ModelSettings::default();
    let bounds = [[0.5, 4.0], [0.1, 4.0], [0.5, 4.0], [0.0025, 0.5], [0.0025, 0.5]];
    LocalQuestion {
        workspace: WorkspaceSpec {
            region,
            rotation_range_deg: 20.0,
            centre: DVec2::ZERO,
            home_phi_deg: None,
        },
        objective: Objective {
            quantity: Quantity::Mass,
            goal: Better::Lower,
        },
        variables: DESIGN_VARIABLES
            .into_iter()
            .zip(bounds)
            .map(|(variable, range)| FreeVariable {
                variable,
                range,
                tied: Vec::new(),
            })
            .collect(),
        is_of_bars: false,
        slack: 0.0,
        settings,
    }
}

#[test]
fn look() {
    for case in cases() {
        if case["id"] != "b" && case["id"] != "d" && case["id"] != "f" {
            continue;
        }
        let design = design_of(&case);
        let region = match case["workspace_radius_m"].as_f64() {
            Some(radius) => Region::Disc(radius),
            None => Region::Polygon(Polygon::rectangle(0.6, 0.4).unwrap()),
        };
        let problem = LocalProblem::new(question(region), &design).expect("a question");
        for home in [Some(case["home_phi_deg"].as_f64().unwrap().to_radians()), None] {
            let start = std::time::Instant::now();
            let found = problem.best(&design, home);
            let Some(found) = found else {
                println!("{} none", case["id"]);
                continue;
            };
            println!(
                "{} {:?} mass {} ({}) home {} missed {:.1e} residual {:.1e} {:.1} ms",
                case["id"],
                home,
                found.objective,
                case["mass_kg"],
                found.home.to_degrees(),
                found.missed,
                found.multipliers.residual,
                start.elapsed().as_secs_f64() * 1e3
            );
            println!("   {}", found.design);
            let start = std::time::Instant::now();
            let prices = problem.prices(&found, true);
            println!("   prices {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
            for price in &prices.prices {
                let name = price.parameter.name(problem.question());
                println!(
                    "   {name:24} {:+.9} ref {} bars {:?} ref {} {:?} {:?}",
                    price.price,
                    case["prices"][&name]["price"],
                    price.bars_only,
                    case["bars_only"]["prices"][&name],
                    price.one_sided,
                    price.bars_cannot_repair
                );
            }
            for (variable, price) in prices.of_dimensions {
                println!(
                    "   design.{} {price}  {}",
                    variable.key(),
                    case["bars_only"]["prices"][format!("design.{}", variable.key())]
                );
            }
        }
        let _ = Parameter::Moduli;
    }
}
