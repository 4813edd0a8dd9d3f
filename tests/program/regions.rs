//! Runs for prescribed regions: every design that is reported is proved, and no random pose of its region misses a limit.

use kinefront_model::evaluation::{Model, PoseScalar};
use kinefront_study::{RunFolder, TableRow};
use kinefront_testkit::poses_of_region;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;

use super::support::{check, folder, front, list, number, optimize, parsed, question, repetitions, says};

/// Studies of builders, each with the least number of designs that its front has.
const STUDIES: [(&str, &str, usize); 3] = [
    (
        "cell",
        r#"
objectives = [{ minimize = "mass_kg" }, { maximize = "k_xy_n_per_m" }]
[constraints]
footprint_m = { at_most = 1.2 }
[sections]
legs = { kind = "tube", catalogue = "en-10255-medium" }
platform = { kind = "square_tube", wall_ratio = 0.15 }
[workspace.region]
kind = "rectangle"
width_m = 0.6
height_m = 0.4
[variables]
r_m = 0.25
"#,
        5,
    ),
    (
        "polygon",
        r#"
objectives = [{ minimize = "mass_kg" }, { minimize = "footprint_m" }]
[constraints]
displacement_max_m = { at_most = 8e-5 }
transmission_min = { at_least = 0.25 }
[requirements]
clearance_min_m = 0.005
[workspace.region]
kind = "polygon"
corners_m = [[-0.3, -0.2], [0.3, -0.2], [0.3, 0.1], [0.0, 0.0], [-0.3, 0.25]]
"#,
        2,
    ),
    (
        "disc",
        r#"
objectives = [{ minimize = "mass_kg" }]
[workspace.region]
kind = "disc"
radius_m = 0.5
"#,
        1,
    ),
];

#[test]
fn reported_designs_hold_their_region() {
    let folder = folder();
    for (name, text, least) in STUDIES {
        let study = folder.write(&format!("{name}.toml"), text);
        let out = folder.join(name);
        optimize(
            &study,
            &out,
            &["--evaluations", "400", "--front", "12", "--no-recording"],
        );
        let run = RunFolder::open(&out).expect("a run");
        let report = run.report().expect("a report");
        let proofs = report.proofs.as_ref().expect("proofs");
        let front = front(&out);
        let count = front.len();
        assert!((least..=12).contains(&count), "{name}: {count} designs");
        assert_eq!((proofs.proved, proofs.open), (count, 0), "{name}: {proofs}");
        let model = run.study().model().expect("a model");
        for entry in &front {
            misses_no_limit(&model, entry, name);
        }
        check(&out).success();
        // The command proves the same, and refutes a region that is larger.
        let certify = |study: &str| {
            let design = &front[0].row.design;
            let told = folder.run(&format!("certify --json --design '{design}' --study {study}"));
            parsed(&told.success())
        };
        let proof = certify(&format!("{name}.toml"));
        assert_eq!(
            (&proof["verdict"], &proof["claim"]),
            (&"proved".into(), &"region".into())
        );
        let grown = text
            .replace("width_m = 0.6", "width_m = 1.9")
            .replace("[0.3, -0.2]", "[1.9, -0.2]")
            .replace("radius_m = 0.5", "radius_m = 1.5");
        assert_ne!(grown, text);
        folder.write("larger.toml", grown);
        assert_eq!(certify("larger.toml")["verdict"], "refuted", "{name}");
    }
}

/// Checks that a reported design is proved and keeps every limit at random poses of its region.
fn misses_no_limit(model: &Model, entry: &TableRow, study: &str) {
    let certified = entry.certified.expect("a certificate");
    assert!(certified.is_proved && certified.is_of_region && certified.upper.is_none());
    let (design, phi_deg) = (&entry.row.design, entry.row.phi.expect("a home"));
    let (settings, count) = (model.settings(), repetitions(2000, 200_000));
    for pose in poses_of_region(&settings.workspace, phi_deg, count, 17 + entry.id as u64) {
        let place = format!("{study} #{} at {pose:?}", entry.id);
        assert!(model.pose(design, &pose).is_ok(), "{place}");
        for (scalar, _) in settings.thresholds.iter() {
            let margin = model.margin_at(design, &pose, scalar);
            let is_kept = margin >= -1e-9 || scalar == PoseScalar::Determinant;
            assert!(is_kept, "{scalar:?} {margin}: {place}");
        }
    }
}

/// Neighbours that are improved can end at the same optimum; it is reported once.
#[test]
fn no_design_of_a_front_repeats_another_one() {
    let folder = folder();
    let out = folder.join("run");
    optimize(
        &question("disc-footprint"),
        &out,
        &["--evaluations", "400", "--no-recording"],
    );
    let front = front(&out);
    assert!(front.len() >= 3, "{} designs", front.len());
    for (place, entry) in front.iter().enumerate() {
        for other in &front[place + 1..] {
            let mut pairs = entry.row.objectives.iter().zip(other.row.objectives.iter());
            let is_same = pairs.all(|(a, b)| (a - b).abs() <= 1e-5 * a.abs().max(b.abs()));
            assert!(!is_same, "#{} and #{}", entry.id, other.id);
        }
    }
}

/// A search that has settled on one architecture leaves the others far from their optima: the best design of each is optimised before one
/// is reported.
#[test]
fn the_lightest_of_all_architectures_is_not_that_of_the_search() {
    let folder = folder();
    let out = folder.join("run");
    optimize(
        &question("polygon-all"),
        &out,
        &["--evaluations", "200", "--seed", "5", "--no-recording"],
    );
    let run = RunFolder::open(&out).expect("a run");
    let rows = run.designs().expect("a table").rows;
    let found = rows.iter().filter(|entry| entry.row.is_feasible());
    let best = found
        .min_by(|a, b| a.row.objectives[0].total_cmp(&b.row.objectives[0]))
        .expect("a feasible design");
    let reported = &front(&out)[0].row;
    assert_ne!(reported.design.architecture(), best.row.design.architecture());
    assert!(
        reported.objectives[0] < 0.5 * best.row.objectives[0],
        "{reported:?} instead of {:?}",
        best.row
    );
    check(&out).success();
}

/// Legs that cross in the plane are put into layers of their own where the study allows it, and the program tells in which.
#[test]
fn legs_in_layers_of_their_own_are_told() {
    let folder = folder();
    let write = |stacking: &str| {
        let text = format!(
            "architectures = [\"3-RPR\"]\nrequirements.clearance_min_m = 0.004\nbodies.stacking = \"{stacking}\"\n"
        );
        folder.write("study.toml", text);
    };
    let ask = |command: &str| {
        let design = "3-RPR R=0.99 r=0.67 Lb=2.21 rj=0.019 rp=0.018";
        folder.run(&format!("{command} --design '{design}' --study study.toml"))
    };
    write("common");
    let common = parsed(&ask("evaluate --json").success());
    assert_eq!((&common["feasible"], common.get("layers")), (&false.into(), None));
    write("chosen");
    let chosen = parsed(&ask("evaluate --json").success());
    assert_eq!(chosen["feasible"], true);
    assert_eq!(chosen["layers"]["stack"], "legs");
    let order = list(&chosen["layers"]["order"]).iter();
    let mut order: Vec<u64> = order.filter_map(serde_json::Value::as_u64).collect();
    order.sort_unstable();
    assert_eq!(order, [1, 2, 3]);
    ask("evaluate").success().stdout(contains(", stacked"));
    // Its workspace is proved with the pins of the joints between the layers.
    let proof = parsed(&ask("certify --json").success());
    let radius = number(&chosen["workspace_radius_m"]);
    assert!(number(&proof["lower_m"]) > 0.99 * radius, "{proof}");
    write("free");
    let told = ask("evaluate").code(2);
    told.stderr(says("bodies.stacking").and(says("chosen")));
}

/// A limit that a design misses is told with its value, and a refutation names what is missed and where.
#[test]
fn what_an_infeasible_design_misses_is_told() {
    let folder = folder();
    let text = "architectures = [\"3-PRR\"]\nobjectives = [{ minimize = \"mass_kg\" }]\n[constraints]\nnatural_frequency_hz = { at_least = 500 }\n\
                [workspace.region]\nkind = \"rectangle\"\nwidth_m = 0.4\nheight_m = 0.3\n";
    folder.write("stiff.toml", text);
    let ask = |command: &str| {
        let design = "3-PRR R=1 r=0.2 Lb=0.7 rj=0.02 rp=0.03";
        folder
            .run(&format!("{command} --design '{design}' --study stiff.toml"))
            .success()
    };
    let told = parsed(&ask("evaluate --json"));
    assert_eq!(told["feasible"], false);
    let [limit] = list(&told["limits"]) else {
        panic!("{told}");
    };
    let (value, margin) = (number(&limit["value"]), number(&limit["margin"]));
    assert!(value > 1.0 && (margin - (value / 500.0 - 1.0)).abs() < 1e-9, "{limit}");
    ask("evaluate").stdout(contains("Hz: missed"));
    ask("certify").stdout(contains("it misses natural_frequency_hz").and(contains("home orientation")));
    assert_eq!(parsed(&ask("certify --json"))["verdict"], "refuted");
}

/// A study may leave no dimension free: each is a list.
#[test]
fn a_study_whose_dimensions_are_all_listed_is_searched() {
    let folder = folder();
    let text = "architectures = [\"3-PRR\"]\nobjectives = [{ minimize = \"mass_kg\" }, { maximize = \"k_xy_n_per_m\" }]\n\
                [variables]\nR_m = [0.8, 1.0]\nr_m = [0.15, 0.2, 0.25]\nLb_m = [0.6, 0.7]\nrj_m = [0.015, 0.02, 0.025]\nrp_m = [0.02, 0.03]\n\
                [workspace.region]\nkind = \"disc\"\nradius_m = 0.2\n[optimizer]\nevaluations = 60\n";
    folder.write("listed.toml", text);
    let search = "optimize listed.toml --no-recording --quiet --out run";
    folder.run(search).success();
    let front = folder.read("run/front.csv");
    assert!(front.lines().count() > 2, "{front}");
    // A run folder stands for its front.
    folder.run("evaluate run#best").success();
}
