//! Wishes and reasons, as a user of the program meets them.

use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use serde_json::Value;

use super::support::{Folder, design_of, entry, folder, list, number, read_rows, says, value};

#[test]
fn a_front_answers_wishes_and_reasons() {
    let folder = folder();
    let search = "optimize paper --evaluations 300 --front 40 --out run --no-recording --quiet";
    folder.run(search).success();
    let rows = read_rows(&folder.join("run/front.csv"));
    let near = rows.iter().find(|row| {
        let has_radius = row["workspace_radius_m"]
            .parse::<f64>()
            .is_ok_and(|radius| radius > 1.0);
        row["architecture"] == "3-PRR" && has_radius
    });
    let row = near.expect("a design of a metre");
    let subject = format!("run/front.csv#{}", row["id"]);
    let (radius, mass) = (value(row, "workspace_radius_m"), value(row, "mass_kg"));

    let wish = |condition: &str| folder.json(&format!("wish {subject} --set '{condition}' --json"));
    let granted = wish("k_xy_n_per_m >= 1.2e6");
    assert_eq!(granted["outcome"], "granted", "{granted}");
    assert_eq!(granted["proof"], "proved");
    let after = |quantity: &str| number(&granted["after"][quantity]);
    assert!(after("k_xy_n_per_m") >= 1.2e6);
    assert!(after("workspace_radius_m") >= radius * (1.0 - 2e-4));
    assert_eq!(granted, wish("k_xy_n_per_m >= 1.2e6"), "the same answer again");

    let had = wish("mass_kg <= 1e5");
    assert_eq!(had["outcome"], "had");
    assert_eq!(had["design"], design_of(row));

    let refused = wish("workspace_radius_m >= 9");
    assert_eq!(refused["outcome"], "not granted");
    let left = number(&refused["unmet"][0]["value"]);
    assert!(left > 2.0 && left < 2.6, "{left}");

    let why = |mass: f64| folder.json(&format!("why run/front.csv --mass {mass} --radius {radius} --json"));
    let can = why(mass * 1.2);
    assert!(number(&can["why_not"]["log_deficit"]) >= 0.0, "{can}");
    let cannot = why(mass * 0.8);
    let relaxations = list(&cannot["why_not"]["relaxations"]);
    let is_enough = |relaxation: &Value| relaxation["needed"].is_number();
    assert!(relaxations.iter().any(is_enough), "{cannot}");
    wrong_questions_are_refused(&folder, &subject);
}

fn wrong_questions_are_refused(folder: &Folder, subject: &str) {
    let wish = |more: &str| format!("wish {subject} --set {more}");
    for (line, message) in [
        (wish("'k_xy_n_per_m > 3'"), "is not a condition"),
        (wish("'stiffness >= 3'"), "`stiffness` is not a quantity"),
        (
            wish("'mass_kg <= 9' --keep footprint_mm"),
            "the footprint is stated in m: `footprint_m`",
        ),
        (wish("'mass_kg <= -3'"), "is not a number above 0"),
        ("why run/front.csv --mass 10".to_owned(), "add --radius"),
        (
            "why run/front.csv --mass 10 --radius 9".to_owned(),
            "satisfies every requirement",
        ),
        (format!("prices {subject} --radius 0"), "it must be a number above 0"),
    ] {
        folder.run(&line).code(2).stderr(says(message));
    }
}

/// Returns the evaluation of a design on the fine grid under `study.toml`.
fn evaluated(folder: &Folder, design: &str) -> Value {
    folder.json(&format!(
        "evaluate --design '{design}' --study study.toml --grid fine --json"
    ))
}

/// A run that finds nothing tells what stands in the way, and the value that it tells can be had.
#[test]
fn a_study_without_designs_is_told_what_stands_in_the_way() {
    let folder = folder();
    let ask = |k_xy: f64| {
        let text = format!(
            "architectures = [\"3-PRR\", \"3-RRR\"]\nobjectives = [{{ minimize = \"mass_kg\" }}]\n[requirements]\nk_xy_min_n_per_m = {k_xy:e}\n\
             [workspace]\ncertify = false\n[workspace.region]\nkind = \"disc\"\nradius_m = 0.5\n[optimizer]\nevaluations = 90\n"
        );
        folder.write("study.toml", text)
    };
    ask(1e12);
    let told = folder.run("optimize study.toml --no-recording --out run").success();
    told.stdout(contains("No design is feasible.").and(contains("k_xy")));
    let found = folder.json("why run/designs.csv --json");
    let hindrance = entry(&found, "parameter", "k_xy_min");
    let possible = number(&hindrance["possible"]);
    assert_eq!(hindrance["stated"], 1e12);
    assert!(possible > 1e7 && possible < 1e11, "{possible}");
    // The design has the value, and it has no more.
    for (share, is_feasible) in [(0.98, true), (1.02, false)] {
        ask(share * possible);
        let evaluated = evaluated(&folder, hindrance["design"].as_str().expect("a design"));
        assert_eq!(evaluated["feasible"], is_feasible, "{share}: {evaluated}");
    }
    let told = folder.run("why run/designs.csv --radius 1").code(2);
    told.stderr(says("add --mass"));
    let search = "optimize --evaluations 60 --front 8 --no-recording --quiet --out feasible";
    folder.run(search).success();
    let told = folder.run("why feasible/designs.csv").code(2);
    told.stderr(says("is feasible, so no requirement"));
}

/// A point of a question without a workspace radius is stated by its own quantities.
#[test]
fn why_is_asked_of_the_objectives_of_the_study() {
    let folder = folder();
    let text = "architectures = [\"3-PRR\"]\nobjectives = [{ minimize = \"mass_kg\" }, { maximize = \"k_xy_n_per_m\" }]\n\
                [workspace]\ncertify = false\n[workspace.region]\nkind = \"rectangle\"\nwidth_m = 0.6\nheight_m = 0.4\n\
                [optimizer]\nevaluations = 200\nfront_designs = 8\n";
    folder.write("cell.toml", text);
    let search = "optimize cell.toml --out run --no-recording --quiet";
    folder.run(search).success();
    let deficit = |mass: &str, stiffness: &str| {
        let at = format!("--mass {mass} --at k_xy_n_per_m={stiffness}");
        let answer = folder.json(&format!("why run/front.csv {at} --json"));
        number(&answer["why_not"]["log_deficit"])
    };
    let (light, heavy) = (deficit("1", "2e6"), deficit("1000", "2e6"));
    assert!(light < 0.0 && heavy > 0.0);
    // More stiffness at the same mass is further away.
    assert!(deficit("1", "2e7") < light - 0.1);
    for (more, message) in [
        (
            "--at k_z_n_per_m=3",
            "the objectives after the first one are k_xy_n_per_m",
        ),
        ("--at k_xy_n_per_m=-3", "a number above 0"),
        ("--at k_xy_n_per_m=3 --at k_xy_n_per_m=4", "is stated twice"),
        ("--radius 1", "is not an objective of the study; omit --radius"),
    ] {
        let told = folder.run(&format!("why run/front.csv --mass 10 {more}")).code(2);
        told.stderr(says(message));
    }
}

/// A limit over a motion that no design keeps stands in the way alone: no relaxation of another requirement helps.
#[test]
fn a_limit_over_a_motion_stands_in_the_way() {
    let folder = folder();
    let ask = |limit: f64| {
        let text = format!(
            "architectures = [\"3-PRR\"]\nobjectives = [{{ minimize = \"mass_kg\" }}]\n\
             constraints = {{ path_speed_max_m_per_s = {{ at_most = {limit} }} }}\n\
             [task]\nshape = \"waypoints\"\nwaypoints = [[-0.15, 0.0, 0.0], [0.15, 0.0, 0.0]]\ncycle_time_s = 1.0\n\
             [workspace]\ncertify = false\nhome_phi_deg = 0.0\n[workspace.region]\nkind = \"disc\"\nradius_m = 0.2\n\
             [bounds]\nR_m = [0.3, 1.0]\nr_m = [0.1, 0.5]\nLb_m = [0.3, 1.0]\n[optimizer]\nevaluations = 60\n"
        );
        folder.write("study.toml", text)
    };
    ask(0.01);
    let search = "optimize study.toml --out run --no-recording --quiet";
    folder.run(search).success();
    let found = folder.json("why run/designs.csv --json");
    let [hindrance] = list(&found) else {
        panic!("one requirement is in the way: {found}");
    };
    assert_eq!(hindrance["parameter"], "path_speed_max_m_per_s");
    assert_eq!(hindrance["is_enough"], false);
    // Its design keeps everything else, and the limit where it is as large as the value that is told.
    let possible = number(&hindrance["possible"]);
    for (limit, is_feasible) in [(1.001 * possible, true), (0.999 * possible, false)] {
        ask(limit);
        let evaluated = evaluated(&folder, hindrance["design"].as_str().expect("a design"));
        assert_eq!(evaluated["feasible"], is_feasible, "{limit}: {evaluated}");
    }
}
