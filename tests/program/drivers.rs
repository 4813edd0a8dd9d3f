//! Prices, wishes and reasons, as a user of the program meets them.

use std::fs;

use predicates::str::contains;

use super::support::{folder, json, kinefront};

/// The lightest 3-PRR for a disc of 1.2 m, and its home orientation, as an independent solver found them.
const OPTIMUM: &str = "3-PRR R=3.8908964188791515 r=0.7103100290509872 Lb=2.5672756542491637 rj=0.024643653700447767 rp=0.03482665497108131";
const MASS: f64 = 179.0915914947854;

/// A study of the mass alone for a disc of 1.2 m.
const STUDY: &str = r#"
    name = "disc"
    architectures = ["3-PRR"]
    objectives = [{ minimize = "mass_kg" }]
    [workspace.region]
    kind = "disc"
    radius_m = 1.2
"#;

#[test]
fn prices_of_a_design_are_those_of_its_study() {
    let folder = folder();
    let study = folder.path().join("disc.toml");
    fs::write(&study, STUDY).expect("a study");
    let study = study.to_str().expect("a path");
    let prices = json(["prices", "--design", OPTIMUM, "--study", study, "--json"]);
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    assert!((number(&prices["polished_mass_kg"]) / MASS - 1.0).abs() < 1e-8);
    assert!((number(&prices["home_phi_deg"]) - 35.2215).abs() < 1e-3);
    assert!(number(&prices["excess"]).abs() < 1e-7 && number(&prices["residual"]) < 1e-5);
    let all = prices["prices"].as_array().expect("prices");
    let of = |name: &str| all.iter().find(|price| price["parameter"] == name).expect("the price");
    for (name, expected) in [
        ("k_z_min", 0.40645),
        ("workspace_radius", 2.49919),
        ("rail_end", -4.31499),
    ] {
        let found = of(name);
        assert!((number(&found["price"]) - expected).abs() < 1e-4, "{found}");
        assert_eq!(found["below"], found["above"]);
    }
    assert_eq!(of("rail_end")["bars_cannot_repair"], serde_json::json!(["down"]));
    assert!((number(&of("k_z_min")["radius_price"]) + 0.16263).abs() < 1e-4);
    let names = |key: &str| {
        let all = prices[key].as_array().expect("a list").clone();
        all.iter()
            .map(|entry| entry["constraint"].as_str().unwrap_or_default().to_owned())
            .collect::<Vec<_>>()
    };
    assert!(names("active").contains(&"k_xy_min".to_owned()) && names("inactive").contains(&"k_phi_z_min".to_owned()));
    assert!(prices.get("why_not").is_none());

    // A wish, and what each requirement would have to give for it.
    let wish = json([
        "prices",
        "--design",
        OPTIMUM,
        "--study",
        study,
        "--wish-mass",
        "160",
        "--json",
    ]);
    let relaxations = wish["why_not"]["relaxations"].as_array().expect("relaxations").clone();
    let needed = |name: &str| {
        let found = relaxations.iter().find(|relaxation| relaxation["parameter"] == name);
        found.expect("the relaxation")["needed"].as_f64()
    };
    assert!((needed("k_xy_min").expect("it suffices") - 0.41329).abs() < 1e-4);
    assert_eq!(needed("inverse_condition_min"), None);

    // The same study states the radius where the paper's study leaves it open.
    let stated = json(["prices", "--design", OPTIMUM, "--radius", "1.2", "--json"]);
    assert!((number(&stated["polished_mass_kg"]) / MASS - 1.0).abs() < 1e-8);
    let steps = json([
        "prices",
        "--design",
        OPTIMUM,
        "--radius",
        "1.2",
        "--bars-only",
        "--json",
    ]);
    let of_bars = steps["prices"]
        .as_array()
        .expect("prices")
        .iter()
        .find(|price| price["parameter"] == "workspace_radius");
    assert!(
        (number(&of_bars.expect("the price")["price"]) - 0.39692).abs() < 2e-3,
        "{of_bars:?}"
    );
}

#[test]
fn a_front_answers_wishes_and_reasons() {
    let folder = folder();
    let out = folder.path().join("run");
    let run = out.to_str().expect("a path");
    kinefront()
        .args([
            "optimize",
            "paper",
            "--evaluations",
            "300",
            "--out",
            run,
            "--no-recording",
            "--quiet",
        ])
        .assert()
        .success();
    let table = format!("{run}/front.csv");
    let text = fs::read_to_string(&table).expect("the front");
    let mut rows = csv::Reader::from_reader(text.as_bytes());
    let header = rows.headers().expect("a header").clone();
    let place = |name: &str| header.iter().position(|column| column == name).expect("the column");
    let rows: Vec<csv::StringRecord> = rows.records().map(|row| row.expect("a row")).collect();
    let near = |row: &&csv::StringRecord| {
        &row[place("architecture")] == "3-PRR"
            && row[place("workspace_radius_m")]
                .parse::<f64>()
                .is_ok_and(|radius| radius > 1.0)
    };
    let row = rows.iter().find(near).expect("a design of a metre");
    let subject = format!("{table}#{}", &row[place("id")]);
    let radius: f64 = row[place("workspace_radius_m")].parse().expect("a number");
    let mass: f64 = row[place("mass_kg")].parse().expect("a number");

    let granted = json(["wish", &subject, "--set", "k_xy_n_per_m >= 1.2e6", "--json"]);
    assert_eq!(granted["outcome"], "granted", "{granted}");
    assert_eq!(granted["proof"], "proved");
    let after = &granted["after"];
    assert!(
        after["k_xy_n_per_m"]
            .as_f64()
            .is_some_and(|stiffness| stiffness >= 1.2e6)
    );
    assert!(
        after["workspace_radius_m"]
            .as_f64()
            .is_some_and(|after| after >= radius * (1.0 - 2e-4))
    );
    assert_eq!(
        granted,
        json(["wish", &subject, "--set", "k_xy_n_per_m >= 1.2e6", "--json"]),
        "the same answer again"
    );

    let had = json(["wish", &subject, "--set", "mass_kg <= 1e5", "--json"]);
    assert_eq!(had["outcome"], "had");
    let text_of_row = |row: &csv::StringRecord| {
        let value = |name: &str| row[place(name)].to_owned();
        format!(
            "3-PRR R={} r={} Lb={} rj={} rp={}",
            value("R"),
            value("r"),
            value("Lb"),
            value("rj"),
            value("rp")
        )
    };
    assert_eq!(had["design"], text_of_row(row));

    let refused = json(["wish", &subject, "--set", "workspace_radius_m >= 9", "--json"]);
    assert_eq!(refused["outcome"], "not granted");
    let left = refused["unmet"][0]["value"].as_f64().expect("what remains");
    assert!(left > 2.0 && left < 2.6, "{left}");

    let can = json([
        "why",
        &table,
        "--mass",
        &format!("{}", mass * 1.2),
        "--radius",
        &radius.to_string(),
        "--json",
    ]);
    assert!(
        can["why_not"]["log_deficit"]
            .as_f64()
            .is_some_and(|deficit| deficit >= 0.0),
        "{can}"
    );
    let cannot = json([
        "why",
        &table,
        "--mass",
        &format!("{}", mass * 0.8),
        "--radius",
        &radius.to_string(),
        "--json",
    ]);
    let relaxations = cannot["why_not"]["relaxations"].as_array().expect("relaxations");
    assert!(
        relaxations.iter().any(|relaxation| relaxation["needed"].is_number()),
        "{cannot}"
    );

    for (arguments, message) in [
        (vec!["wish", &subject, "--set", "k_xy_n_per_m > 3"], "is no condition"),
        (
            vec!["wish", &subject, "--set", "stiffness >= 3"],
            "`stiffness` is no quantity",
        ),
        (
            vec!["wish", &subject, "--set", "mass_kg <= -3"],
            "is not a number above 0",
        ),
        (vec!["why", &table, "--mass", "10"], "add --radius"),
        (
            vec!["why", &table, "--mass", "10", "--radius", "9"],
            "keeps every requirement",
        ),
        (vec!["prices", &subject, "--radius", "0"], "it must be a number above 0"),
    ] {
        kinefront().args(&arguments).assert().code(2).stderr(contains(message));
    }
}
