//! The identities of prices (docs/model.md, section 16.2): neither forces nor lengths have a scale of their own.

use kinefront_study::Builtin;
use serde_json::Value;

use super::support::{folder, json, list, number, question, repetitions, sample};

/// Designs of the fronts of five questions, 20 of each, evenly spread among those with prices in tables that searches with seed 3 have left:
/// with 1500 evaluations of `paper` and `three-objectives`, 300 of `paper-without-collisions`, 600 of the others. The last two of
/// `three-objectives` are added because their bases and their members reach equally far.
const FRONT_DESIGNS: &str = include_str!("fixtures/front_designs.csv");

/// Scaling all forces, or all lengths, changes nothing but the unit: the prices of what has them add up.
pub fn keeps_its_identities(drivers: &Value, architecture: &str) {
    let prices = list(&drivers["prices"]);
    let price = |name: &str| {
        let found = prices.iter().find(|price| price["parameter"] == name);
        found.map_or(0.0, |price| number(&price["price"]))
    };
    let is_bound = |price: &&Value| {
        price["parameter"]
            .as_str()
            .is_some_and(|name| name.starts_with("bounds."))
    };
    let bounds: f64 = prices
        .iter()
        .filter(is_bound)
        .map(|price| number(&price["price"]))
        .sum();
    let stiffness = price("k_xy_min") + price("k_z_min");
    let forces = price("E") + price("G") + price("K_act") + stiffness + price("k_phi_z_min");
    assert!(forces.abs() < 1e-7, "{architecture}: {forces}");
    // The stiffness of an actuator that slides is a force over a length, that of one that turns a force times a length.
    let of_actuators = match architecture {
        "3-PRR" | "3-RPR" => 1.0,
        "3-RRR" => 3.0,
        other => panic!("{other}"),
    };
    let sizes = price("workspace_radius") + price("footprint_m") + price("clearance_min") + bounds;
    let lengths = of_actuators * price("K_act") + stiffness + 3.0 * price("k_phi_z_min") + sizes;
    assert!((lengths - 3.0).abs() < 1e-6, "{architecture}: {lengths}");
    assert!((price("density") - 1.0).abs() < 1e-9);
}

/// The critical poses of these designs lie in valleys that are parallel to no coordinate, or the legs are nearly stretched: prices need
/// exact places there, and exact derivatives.
#[test]
fn prices_of_designs_with_flat_valleys_keep_the_identities() {
    for dimensions in [
        "R=1.050713370059659 r=0.1 Lb=0.5 rj=0.017079438655045076 rp=0.010682370272295945",
        "R=1.6652717987588521 r=0.1 Lb=1.4286022016209872 rj=0.06445319678248854 rp=0.026919048037598467",
        "R=1.8578058254040524 r=0.1 Lb=1.6041013829777744 rj=0.07329675865503613 rp=0.029401005682441285",
    ] {
        let drivers = json(&format!("prices --design '3-RRR {dimensions}' --json"));
        let residual = number(&drivers["residual"]);
        assert!(residual < 1e-6, "{dimensions}: {residual}");
        keeps_its_identities(&drivers, "3-RRR");
    }
}

/// By day, of a few designs of each question, the last of which is one.
#[test]
fn prices_of_front_designs_of_five_questions_keep_the_identities() {
    let folder = folder();
    let mut lines = FRONT_DESIGNS.lines();
    let header = lines.next().expect("a header").replacen("study", "id", 1);
    let lines: Vec<(&str, &str)> = lines.filter_map(|line| line.split_once(',')).collect();
    let mut checked = 0;
    for of_study in lines.chunk_by(|a, b| a.0 == b.0) {
        let study = of_study[0].0;
        let designs = sample(of_study.iter().rev(), 10).enumerate();
        let rows: String = designs.map(|(id, (_, design))| format!("{id},{design}\n")).collect();
        folder.write("table.csv", format!("{header}\n{rows}"));
        let study = match Builtin::find(study) {
            Some(_) => study.to_owned(),
            None => question(study).display().to_string(),
        };
        for front in list(&folder.json(&format!("prices table.csv --study '{study}' --json"))) {
            for design in list(&front["designs"]) {
                let drivers = &design["drivers"];
                assert!(number(&drivers["residual"]) < 1e-8, "{drivers}");
                keeps_its_identities(drivers, front["architecture"].as_str().expect("a name"));
                checked += 1;
            }
        }
    }
    assert_eq!(checked, repetitions(48, 102));
}
