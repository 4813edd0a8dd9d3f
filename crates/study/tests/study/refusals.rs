//! Tests of what is refused: invalid files and values, each with the reason, its place, and what would be right.

use kinefront_study::{Fault, Study, StudyError};
use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme};

use super::{parsed, reread};

fn error(text: &str) -> StudyError {
    Study::parse(text, "mine.toml").expect_err("a fault")
}

/// The faults of values in a text.
fn faults(text: &str) -> Vec<Fault> {
    match error(text) {
        StudyError::Values { faults, .. } => faults,
        other => panic!("the error is not about values: {text}: {other}"),
    }
}

/// The report on a text that is refused, with single spaces wherever a line of it may end.
pub(super) fn printed(text: &str) -> String {
    let mut out = String::new();
    GraphicalReportHandler::new_themed(GraphicalTheme::none())
        .render_report(&mut out, &error(text) as &dyn Diagnostic)
        .expect("a report");
    out.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Asserts that texts are refused, each with a report that shows the given parts.
fn assert_refused(cases: &[(&str, &[&str])]) {
    for (text, parts) in cases {
        let report = printed(text);
        for part in parts.iter().chain(&["mine.toml:"]) {
            assert!(
                report.contains(*part),
                "`{part}` is missing for:\n{text}\nreport:\n{report}"
            );
        }
    }
}

#[test]
fn questions_that_cannot_be_asked_are_refused_with_the_reason_and_what_would_be_right() {
    assert_refused(&[
        (
            "objectives = [{ minimize = 'weight_kg' }]",
            &["objectives", "weight_kg", "mass_kg"],
        ),
        ("objectives = [{ minimize = 'mass_g' }]", &["stated in kg", "`mass_kg`"]),
        (
            "objectives = [{ minimize = 'mass_kg' }, { maximize = 'mass_kg' }]",
            &["`mass_kg` is named twice"],
        ),
        ("objectives = []", &["0 entries", "one to three"]),
        (
            "workspace.region = { kind = 'disc', radius_m = 0.3 }\nobjectives = [{ maximize = 'workspace_radius_m' }]",
            &["the region is prescribed"],
        ),
        (
            "constraints.mas_kg = { at_most = 3 }",
            &["constraints.mas_kg", "did you mean `mass_kg`"],
        ),
        (
            "constraints.footprint_mm = { at_most = 3000 }",
            &["stated in m", "`footprint_m`"],
        ),
        (
            "constraints.mass_kg = { at_least = 3, at_most = 2 }",
            &["contradicts itself", "at least 3 and at most 2 kg"],
        ),
        ("constraints.mass_kg = {}", &["states no limit", "at_least"]),
        ("constraints.dexterity_mean = { at_least = 1.5 }", &["at most 1"]),
        (
            "constraints.k_xy_n_per_m = { at_least = 1 }\nrequirements.k_xy_min_n_per_m = 2",
            &["requirements.k_xy_min_n_per_m", "omit one"],
        ),
        (
            "sections.legs = { kind = 'tube', catalogue = [] }",
            &["sections.legs.catalogue", "no entry"],
        ),
        (
            "sections.legs = { kind = 'tube', catalogue = 'no.csv' }",
            &["cannot be read", "en-10255-medium"],
        ),
        (
            "sections.legs = { kind = 'tube' }",
            &["sections.legs.kind", "wall_ratio"],
        ),
        (
            "sections.legs = { kind = 'tube', wall_ratio = 1.2 }",
            &["1.2", "(0, 1]"],
        ),
        (
            "objectives = [{ minimize = 'mass_kg' }]\nworkspace.region = { kind = 'disc', radius_m = 30 }",
            &["30.000 m from O", "no design within the bounds"],
        ),
        ("variables.rp_m = 'rq'", &["variables.rp_m", "rq", "0.5 rj"]),
    ]);
}

#[test]
fn wrong_files_are_refused_with_file_line_and_key() {
    assert_refused(&[
        (
            "name = 'x'\n[material]\ndensty = 1.0",
            &["mine.toml:3", "densty", "density_kg_per_m3"],
        ),
        (
            "[material]\ndensity_kg_per_m3 = 'steel'",
            &["mine.toml:2", "material.density_kg_per_m3", "expected a number"],
        ),
        (
            "[material]\ndensity_kg_per_m3 = -7850.0",
            &["mine.toml:2", "material.density_kg_per_m3", "-7850", "above 0"],
        ),
        ("[material]\ndensity_kg_per_m3 = nan", &["mine.toml:2", "NaN"]),
        (
            "[bounds]\nR_m = [4.0, 0.5]",
            &["mine.toml:2", "bounds.R_m", "lower bound 4 above its upper bound 0.5"],
        ),
        ("[bounds]\nr_m = [0.0, 0.5]", &["mine.toml:2", "bounds.r_m", "above 0"]),
        (
            "[optimizer]\nthreads = 0",
            &["mine.toml:2", "optimizer.threads", "1 to 1024"],
        ),
        (
            "[optimizer]\nalgorithm = 'moga'",
            &["mine.toml:2", "optimizer.algorithm", "moga2", "nsga2"],
        ),
        (
            "architectures = ['3-PPP']",
            &["mine.toml:1", "3-PPP", "3-PRR, 3-RPR, 3-RRR"],
        ),
        ("working_mode = '++'", &["mine.toml:1", "three signs"]),
        (
            "[grid.fine]\nphi_step_deg = 7\ndirections = 36\nray_steps = 50\nhalvings = 12",
            &["mine.toml:2", "grid.fine.phi_step_deg", "whole steps"],
        ),
        (
            "[rails]\nradius_m = 0.03\nsupports = 'pinned'\nspans = 2",
            &["mine.toml:4", "rails.spans", "one span", "clamped"],
        ),
        (
            "[rails]\nspans = 3",
            &["mine.toml:2", "rails.spans", "no effect", "rails.radius_m"],
        ),
        (
            "[sections.rails]\nkind = 'square_tube'\nwall_ratio = 0.1",
            &["mine.toml:2", "sections.rails.kind", "no effect", "rails.radius_m"],
        ),
        ("name = 'x'\nbroken", &["mine.toml:2", "expected"]),
    ]);
}

#[test]
fn all_faults_are_told_at_once() {
    let faults = faults("[material]\ndensity_kg_per_m3 = 0\n[bounds]\nR_m = [2, 1]\nrj_m = [-1, 1]");
    let keys: Vec<&str> = faults.iter().map(|fault| fault.key.as_str()).collect();
    assert_eq!(keys, ["material.density_kg_per_m3", "bounds.R_m", "bounds.rj_m"]);
}

const CLEARANCE: &str = "[requirements]\nclearance_min_m = 0.005\n";
const POST: &str = "[[obstacles]]\nname = \"post\"\nkind = \"disc\"\nradius_m = 0.1\n";

/// Obstacles and a room are read, written and compared.
#[test]
fn obstacles_and_a_room_are_read() {
    let study = parsed(&format!(
        "{CLEARANCE}{POST}centre_m = [0.9, 0.8]\nheights_m = [-0.1, 0.4]\n[[obstacles]]\nname = \"wall\"\n\
         kind = \"polygon\"\ncentre_m = [1.0, 0.0]\ncorners_m = [[0.5, -1.0], [0.6, -1.0], [0.6, 1.0], [0.5, 1.0]]\n\
         [room]\nkind = \"rectangle\"\nwidth_m = 6.0\nheight_m = 5.0\n"
    ));
    let surroundings = study.model().expect("a model").settings().surroundings.clone();
    assert_eq!(surroundings.obstacles.len(), 2);
    assert_eq!(surroundings.obstacles[0].heights, [-0.1, 0.4]);
    assert_eq!(surroundings.obstacles[1].heights, [f64::NEG_INFINITY, f64::INFINITY]);
    let room = surroundings.room.as_ref().expect("a room");
    assert_eq!(
        room.bounds().map(|corner| corner.to_array()),
        [[-3.0, -2.5], [3.0, 2.5]]
    );
    assert_eq!(reread(&study), study);
    assert_eq!(study.differing_key(&parsed(CLEARANCE)).as_deref(), Some("obstacles"));
}

/// Each fault of obstacles and of a room names the section and the key at fault.
#[test]
fn obstacles_and_a_room_are_checked() {
    let post = format!("{POST}centre_m = [1.0, 1.0]\n");
    let with_clearance = [
        (
            format!("{post}{POST}centre_m = [-1.0, 1.0]"),
            "obstacles[2].name",
            "the name of another obstacle",
        ),
        (
            format!("{post}heights_m = [0.2, 0.1]"),
            "obstacles[1].heights_m",
            "above the first",
        ),
        (
            format!("{POST}centre_m = [1.0, inf]"),
            "obstacles[1].centre_m",
            "within ±1e6 m",
        ),
        (POST.into(), "obstacles[1]", "covers the centre of the workspace"),
        ("[[obstacles]]\nname = 'post'".into(), "obstacles[1].kind", "is missing"),
        (
            "[[obstacles]]\nkind = 'disc'\nradius_m = 0.1".into(),
            "obstacles[1].name",
            "is missing",
        ),
        (
            "[room]\nkind = 'rectangle'\nwidth_m = 0.5\nheight_m = 0.5".into(),
            "room",
            "smaller than the base: A1",
        ),
        ("[room]\nkind = 'disc'".into(), "room.kind", "is \"disc\""),
    ]
    .map(|(text, key, words)| (CLEARANCE.to_owned() + &text, key, words));
    let without = (post.clone(), "obstacles[1]", "without a clearance");
    for (text, key, words) in with_clearance.into_iter().chain([without]) {
        let faults = faults(&text);
        let [fault] = &faults[..] else {
            panic!("{text}: {faults:?}");
        };
        assert_eq!(fault.key, key, "{text}");
        assert!(fault.message.contains(words), "{text}: {}", fault.message);
    }
    // The place in the file is that of the second obstacle.
    let second = printed(&format!("{CLEARANCE}{post}{POST}centre_m = [-1.0, nan]"));
    assert!(second.contains("mine.toml:12:12"), "{second}");
}

/// A fault that several keys have is told once, with the file that has it.
#[test]
fn a_fault_that_two_keys_share_is_told_once() {
    let section = "{ kind = \"tube\", catalogue = \"tubes-that-are-not-there.csv\" }";
    let told = printed(&format!("[sections]\nlegs = {section}\nplatform = {section}\n")).replace("│ ", "");
    assert!(
        told.contains("`sections.platform.catalogue` has the same fault as `sections.legs.catalogue`"),
        "{told}"
    );
}
