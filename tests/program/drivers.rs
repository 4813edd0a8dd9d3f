//! Prices, wishes and reasons, as a user of the program meets them.

use std::fs;
use std::path::Path;

use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use serde_json::Value;

use kinefront_testkit::python;

use super::identities::keeps_its_identities;
use super::support::{design_of, folder, json, kinefront, optimize, says, script};

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
    let text_of_row = |row: &csv::StringRecord| design_of(|name| row[place(name)].to_owned());
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
        (
            vec!["wish", &subject, "--set", "k_xy_n_per_m > 3"],
            "is not a condition",
        ),
        (
            vec!["wish", &subject, "--set", "stiffness >= 3"],
            "`stiffness` is not a quantity",
        ),
        (
            vec!["wish", &subject, "--set", "mass_kg <= 9", "--keep", "footprint_mm"],
            "the footprint is stated in m: `footprint_m`",
        ),
        (
            vec!["wish", &subject, "--set", "mass_kg <= -3"],
            "is not a number above 0",
        ),
        (vec!["why", &table, "--mass", "10"], "add --radius"),
        (
            vec!["why", &table, "--mass", "10", "--radius", "9"],
            "satisfies every requirement",
        ),
        (vec!["prices", &subject, "--radius", "0"], "it must be a number above 0"),
    ] {
        kinefront().args(&arguments).assert().code(2).stderr(says(message));
    }
}

/// The prices of a table are those of its designs, and nothing of the front is left out.
#[test]
fn prices_along_a_front_are_those_of_its_designs() {
    let folder = folder();
    let run = folder.path().join("run");
    let arguments = [
        "--evaluations",
        "300",
        "--front",
        "12",
        "--architectures",
        "3-PRR,3-RPR",
    ];
    let out = ["--no-recording", "--quiet", "--out"];
    kinefront()
        .arg("optimize")
        .args(arguments)
        .args(out)
        .arg(&run)
        .assert()
        .success();
    let table = run.join("front.csv").to_str().expect("a path").to_owned();
    let along = json(["prices", &table, "--json"]);
    let printed = kinefront()
        .args(["prices", &table, "--csv"])
        .output()
        .expect("a table")
        .stdout;
    let mut printed = csv::Reader::from_reader(printed.as_slice());
    let headers = printed.headers().expect("a header").clone();
    let place = |name: &str| headers.iter().position(|header| header == name).expect("a column");
    let rows: Vec<csv::StringRecord> = printed.records().map(|row| row.expect("a row")).collect();
    let front = fs::read_to_string(run.join("front.csv")).expect("a front");
    assert_eq!(rows.len(), front.lines().count() - 1);
    let mut priced = 0;
    for front in along.as_array().expect("architectures") {
        assert_eq!(front["along"], "workspace_radius_m");
        assert!(!front["sentences"].as_array().expect("sentences").is_empty(), "{front}");
        let designs = front["designs"].as_array().expect("designs");
        priced += designs.len() + front["without_prices"].as_u64().expect("a number") as usize;
        let at: Vec<f64> = designs
            .iter()
            .map(|design| design["at"].as_f64().expect("a radius"))
            .collect();
        assert!(at.is_sorted(), "{at:?}");
        for design in designs {
            let id = design["id"].to_string();
            keeps_its_identities(&design["drivers"], front["architecture"].as_str().expect("a name"));
            let row = rows.iter().find(|row| row[place("id")] == id).expect("the row");
            assert_eq!(row[place("architecture")], front["architecture"]);
            for price in design["drivers"]["prices"].as_array().expect("prices") {
                let name = format!("price_{}", price["parameter"].as_str().expect("a name"));
                let cell: f64 = row[place(&name)].parse().expect("a price");
                assert_eq!(Some(cell), price["price"].as_f64(), "{name}");
            }
        }
        // Both fronts end where the other architecture becomes the lighter one (an independent solver: 0.1389536 m and 2.370432 kg,
        // where 1 % of the radius costs 2.0177 % below and 0.0157 % above).
        let crossing = &front["crossings"][0];
        for (key, expected, accuracy) in [
            ("at", 0.138_953_6, 1e-6),
            ("objective", 2.370_432, 1e-6),
            ("price_below", 2.0177, 1e-4),
            ("price_above", 0.0157, 1e-4),
        ] {
            let found = crossing[key].as_f64().expect("a number");
            assert!((found - expected).abs() < accuracy, "{key}: {found}");
        }
        assert_eq!(
            (&crossing["below"], &crossing["above"]),
            (&"3-RPR".into(), &"3-PRR".into())
        );
        if let Some(design) = designs.first() {
            let alone = json(["prices", &format!("{table}#{}", design["id"]), "--json"]);
            assert_eq!(alone, design["drivers"], "a design alone has the same prices");
        }
    }
    assert_eq!(priced, rows.len());
    is_recorded(&table, folder.path(), &along);
    for (arguments, message) in [
        (vec!["prices", &table, "--steps"], "require a single design"),
        (
            vec!["prices", &format!("{table}#1"), "--csv"],
            "name the table without #ID",
        ),
        (vec!["prices", &table, "--csv", "--json"], "cannot be used with"),
        (
            vec!["prices", &format!("{table}#1"), "--record", "prices.rrd"],
            "--record writes a recording of a front; name the table without #ID",
        ),
    ] {
        kinefront().args(&arguments).assert().code(2).stderr(contains(message));
    }
}

/// The recording of a front holds the prices that the command prints.
fn is_recorded(table: &str, folder: &Path, along: &Value) {
    let (recording, printed) = (folder.join("prices.rrd"), folder.join("along.json"));
    let record = || {
        let mut command = kinefront();
        command.args(["prices", table, "--json", "--record"]).arg(&recording);
        command
    };
    let output = record()
        .assert()
        .success()
        .stderr(contains("wrote"))
        .get_output()
        .clone();
    let repeated: Value = serde_json::from_slice(&output.stdout).expect("nothing but JSON");
    assert_eq!(&repeated, along);
    fs::write(&printed, output.stdout).expect("a file");
    if let Some(python) = python(&["rerun", "pyarrow"]) {
        let found = script(python, "check_prices.py", &[&recording, &printed]);
        let found: Value = serde_json::from_str(&found).expect("JSON");
        let fronts = along.as_array().expect("architectures").len();
        let priced = along.as_array().expect("architectures").iter();
        let priced: usize = priced
            .map(|front| front["designs"].as_array().expect("designs").len())
            .sum();
        assert_eq!(found["steps"], priced, "{found}");
        assert_eq!(found["plots"], 2 * fronts, "{found}");
        assert!(found["curves"].as_u64() >= Some(4), "{found}");
    }
    // A file that exists is never replaced.
    record().assert().code(2).stderr(contains("exists"));
}

/// Returns the evaluation of a design on the fine grid.
fn evaluated(design: &str, study: &Path) -> Value {
    let study = study.to_str().expect("a path");
    json([
        "evaluate", "--design", design, "--study", study, "--grid", "fine", "--json",
    ])
}

/// A run that finds nothing tells what stands in the way, and the value that it tells can be had.
#[test]
fn a_study_without_designs_is_told_what_stands_in_the_way() {
    let folder = folder();
    let study = folder.path().join("stiff.toml");
    let text = |k_xy: f64| {
        format!(
            "architectures = [\"3-PRR\", \"3-RRR\"]\nobjectives = [{{ minimize = \"mass_kg\" }}]\n[requirements]\nk_xy_min_n_per_m = {k_xy:e}\n\
             [workspace]\ncertify = false\n[workspace.region]\nkind = \"disc\"\nradius_m = 0.5\n[optimizer]\nevaluations = 90\n"
        )
    };
    fs::write(&study, text(1e12)).expect("a study");
    let run = folder.path().join("run");
    kinefront()
        .args(["optimize", "--no-recording", "--out"])
        .arg(&run)
        .arg(&study)
        .assert()
        .success()
        .stdout(contains("No design is feasible.").and(contains("k_xy")));
    let table = run.join("designs.csv").to_str().expect("a path").to_owned();
    let found = json(["why", &table, "--json"]);
    let found = found.as_array().expect("hindrances").clone();
    let hindrance = found
        .iter()
        .find(|found| found["parameter"] == "k_xy_min")
        .expect("the requirement");
    let possible = hindrance["possible"].as_f64().expect("a value");
    assert_eq!(hindrance["stated"], 1e12);
    assert!(possible > 1e7 && possible < 1e11, "{possible}");
    // The design has the value, and it has no more.
    for (share, is_feasible) in [(0.98, true), (1.02, false)] {
        fs::write(&study, text(share * possible)).expect("a study");
        let design = hindrance["design"].as_str().expect("a design");
        let evaluated = evaluated(design, &study);
        assert_eq!(evaluated["feasible"], is_feasible, "{share}: {evaluated}");
    }
    kinefront()
        .args(["why", &table, "--radius", "1"])
        .assert()
        .code(2)
        .stderr(contains("add --mass"));
    let feasible = folder.path().join("feasible");
    kinefront()
        .args(["optimize", "--evaluations", "60", "--no-recording", "--quiet", "--out"])
        .arg(&feasible)
        .assert()
        .success();
    kinefront()
        .arg("why")
        .arg(feasible.join("designs.csv"))
        .assert()
        .code(2)
        .stderr(says("is feasible, so no requirement"));
}

/// A point of a question without a workspace radius is stated by its own quantities.
#[test]
fn why_is_asked_of_the_objectives_of_the_study() {
    let folder = folder();
    let study = folder.path().join("cell.toml");
    let text = "architectures = [\"3-PRR\"]\nobjectives = [{ minimize = \"mass_kg\" }, { maximize = \"k_xy_n_per_m\" }]\n\
                [workspace]\ncertify = false\n[workspace.region]\nkind = \"rectangle\"\nwidth_m = 0.6\nheight_m = 0.4\n\
                [optimizer]\nevaluations = 200\nfront_designs = 8\n";
    fs::write(&study, text).expect("a study");
    let run = folder.path().join("run");
    optimize(&study, &run, &["--no-recording"]);
    let table = run.join("front.csv").to_str().expect("a path").to_owned();
    let why = |mass: &str, stiffness: &str| {
        let at = format!("k_xy_n_per_m={stiffness}");
        json(["why", &table, "--mass", mass, "--at", &at, "--json"])
    };
    let deficit = |answer: &serde_json::Value| answer["why_not"]["log_deficit"].as_f64().expect("a number");
    let (light, heavy) = (why("1", "2e6"), why("1000", "2e6"));
    assert!(deficit(&light) < 0.0 && deficit(&heavy) > 0.0);
    // More stiffness at the same mass is further away.
    assert!(deficit(&why("1", "2e7")) < deficit(&light) - 0.1);
    for (arguments, message) in [
        (
            vec!["--at", "k_z_n_per_m=3"],
            "the objectives after the first one are k_xy_n_per_m",
        ),
        (vec!["--at", "k_xy_n_per_m=-3"], "a number above 0"),
        (
            vec!["--at", "k_xy_n_per_m=3", "--at", "k_xy_n_per_m=4"],
            "is stated twice",
        ),
        (vec!["--radius", "1"], "is not an objective of the study; omit --radius"),
    ] {
        kinefront()
            .args(["why", &table, "--mass", "10"])
            .args(&arguments)
            .assert()
            .code(2)
            .stderr(contains(message));
    }
}

/// A limit over a motion that no design keeps stands in the way alone: no relaxation of another requirement helps.
#[test]
fn a_limit_over_a_motion_stands_in_the_way() {
    let folder = folder();
    let study = folder.path().join("slow.toml");
    let text = |limit: f64| {
        format!(
            "architectures = [\"3-PRR\"]\nobjectives = [{{ minimize = \"mass_kg\" }}]\n\
             constraints = {{ path_speed_max_m_per_s = {{ at_most = {limit} }} }}\n\
             [task]\nshape = \"waypoints\"\nwaypoints = [[-0.15, 0.0, 0.0], [0.15, 0.0, 0.0]]\ncycle_time_s = 1.0\n\
             [workspace]\ncertify = false\nhome_phi_deg = 0.0\n[workspace.region]\nkind = \"disc\"\nradius_m = 0.2\n\
             [bounds]\nR_m = [0.3, 1.0]\nr_m = [0.1, 0.5]\nLb_m = [0.3, 1.0]\n[optimizer]\nevaluations = 60\n"
        )
    };
    fs::write(&study, text(0.01)).expect("a study");
    let run = folder.path().join("run");
    optimize(&study, &run, &["--no-recording"]);
    let found = json(["why", run.join("designs.csv").to_str().expect("a path"), "--json"]);
    let found = found.as_array().expect("hindrances");
    let [hindrance] = &found[..] else {
        panic!("one requirement is in the way: {found:?}");
    };
    assert_eq!(
        (&hindrance["parameter"], &hindrance["is_enough"]),
        (&"path_speed_max_m_per_s".into(), &false.into())
    );
    // Its design keeps everything else, and the limit where it is as large as the value that is told.
    let possible = hindrance["possible"].as_f64().expect("a value");
    let design = hindrance["design"].as_str().expect("a design");
    for (limit, is_feasible) in [(1.001 * possible, true), (0.999 * possible, false)] {
        fs::write(&study, text(limit)).expect("a study");
        let evaluated = evaluated(design, &study);
        assert_eq!(evaluated["feasible"], is_feasible, "{limit}: {evaluated}");
    }
}

/// Tubes of a catalogue have no derivative: the prices tell what the next ones cost, a reported design has none that would be better, and
/// a wish exchanges them.
#[test]
fn tubes_of_a_catalogue_are_exchanged() {
    let folder = folder();
    let study = folder.path().join("tubes.toml");
    let text = r#"
        name = "tubes"
        architectures = ["3-PRR"]
        objectives = [{ minimize = "mass_kg" }, { maximize = "k_xy_n_per_m" }]
        [constraints]
        footprint_m = { at_most = 1.2 }
        [workspace.region]
        kind = "rectangle"
        width_m = 0.5
        height_m = 0.3
        [sections]
        legs = { kind = "tube", catalogue = "en-10255-medium" }
        platform = { kind = "square_tube", wall_ratio = 0.15 }
        [optimizer]
        front_designs = 6
    "#;
    fs::write(&study, text).expect("a study");
    let run = folder.path().join("run");
    optimize(&study, &run, &["--evaluations", "400", "--no-recording"]);
    let number = |value: &Value| value.as_f64().expect("a number");
    let front = fs::read_to_string(run.join("front.csv")).expect("a front");
    let mut optima = 0;
    for row in front.lines().skip(1) {
        let id = row.split(',').next().expect("an id");
        let subject = format!("{}#{id}", run.join("front.csv").display());
        let prices = json(["prices", &subject, "--json"]);
        let others = prices["alternatives"].as_array().expect("other tubes");
        assert!(
            (1..=2).contains(&others.len()),
            "one or two tubes are beside one: {prices}"
        );
        // A design whose optimum does not hold on the fine grid stays as it was found.
        if number(&prices["excess"]) < 1e-3 {
            optima += 1;
            for other in others.iter().filter(|other| other["change"].is_number()) {
                assert!(number(&other["change"]) > -1e-3, "{id}: {other}");
            }
        }
    }
    assert!(optima >= 3, "{optima} of the reported designs are optima:\n{front}");

    let thick =
        "3-PRR R=0.8959856810761102 r=0.4178926328195201 Lb=0.6136237256603441 rj=0.03805 rp=0.030739628007979688";
    let study = study.to_str().expect("a path");
    let wish = |more: &[&str]| {
        let arguments = [
            "wish",
            "--design",
            thick,
            "--study",
            study,
            "--set",
            "k_xy_n_per_m >= 4e6",
        ];
        arguments
            .into_iter()
            .chain(more.iter().copied())
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let granted = json(wish(&["--json"]));
    assert_eq!(granted["outcome"], "granted", "{granted}");
    assert!(number(&granted["after"]["mass_kg"]) < 0.9 * number(&granted["before"]["mass_kg"]));
    assert!(number(&granted["after"]["k_xy_n_per_m"]) >= 4e6 * (1.0 - 1e-6));
    let changed = granted["changed_entries"][0].as_str().expect("another tube");
    assert!(changed.starts_with("legs: DN 65 M becomes DN "), "{changed}");
    kinefront().args(wish(&[])).assert().success().stdout(contains(changed));
}
