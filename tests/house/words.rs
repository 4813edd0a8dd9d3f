//! What sources do not mention.

use std::path::PathBuf;

use super::sources::{dependencies, files, read, root};

const CORE: [&str; 3] = ["crates/model/src", "crates/optimize/src", "crates/optimum/src"];

/// The modules of the model that are written once for all architectures and for all instruction sets.
const PHYSICS: [&str; 8] = [
    "crates/model/src/certify",
    "crates/model/src/enclosure",
    "crates/model/src/clearance",
    "crates/model/src/evaluation",
    "crates/model/src/kinematics",
    "crates/model/src/pose",
    "crates/model/src/stiffness",
    "crates/model/src/spatial.rs",
];

/// What stands on the core crates, but for the window and the command line.
const LIBRARY: [&str; 5] = [
    "crates/study/src",
    "crates/scene/src",
    "crates/export/src",
    "crates/report/src",
    "crates/recording/src",
];

/// The sources below a folder or in a file, without comments: documentation may speak of anything.
fn sources(place: &str) -> Vec<(PathBuf, String)> {
    let path = root().join(place);
    let found = if path.is_dir() { files(&path, "rs") } else { vec![path] };
    assert!(!found.is_empty(), "there is no source in {place}");
    let code = |path: PathBuf| {
        let text = read(&path);
        let lines = text.lines().filter(|line| !line.trim_start().starts_with("//"));
        let code: Vec<&str> = lines.collect();
        (path, code.join("\n"))
    };
    found.into_iter().map(code).collect()
}

fn assert_absent(places: &[&str], words: &[&str]) {
    for place in places {
        for (path, code) in sources(place) {
            for word in words {
                // A name within another one, as `eframe` in `Wireframe`, is not that name.
                let begins_a_name = word.starts_with(char::is_alphabetic);
                let is_mentioned = code.match_indices(word).any(|(at, _)| {
                    let before = code[..at].chars().next_back();
                    !begins_a_name || !before.is_some_and(|before| before.is_alphanumeric() || before == '_')
                });
                assert!(!is_mentioned, "{} mentions `{word}`", path.display());
            }
        }
    }
}

#[test]
fn the_core_crates_depend_on_numbers_alone() {
    for (name, allowed) in [
        ("model", &["glam", "libm", "nalgebra", "pulp", "serde", "thiserror"][..]),
        (
            "optimize",
            &["libm", "nalgebra", "rand_chacha", "rand_core", "serde", "sobol_burley"],
        ),
        (
            "optimum",
            &["clarabel", "glam", "kinefront-model", "libm", "nalgebra", "thiserror"],
        ),
    ] {
        for dependency in dependencies(&format!("crates/{name}")) {
            let is_allowed = allowed.contains(&dependency.as_str());
            assert!(is_allowed, "kinefront-{name} uses {dependency}");
        }
    }
}

/// What serves without a window compiles without one, and all but the recordings without Rerun.
#[test]
fn only_the_recordings_and_the_window_need_rerun() {
    for folder in [
        "crates/study",
        "crates/scene",
        "crates/export",
        "crates/report",
        "crates/recording",
        "python",
    ] {
        let dependencies = dependencies(folder);
        assert!(dependencies.len() > 3);
        for dependency in dependencies {
            let starts = |start: &&str| dependency.starts_with(*start);
            let is_of_window = ["egui", "eframe", "re_viewer", "rfd"].iter().any(starts);
            let is_of_rerun = dependency == "rerun" || dependency.starts_with("re_");
            let may_record = folder == "crates/recording";
            assert!(
                !is_of_window && (may_record || !is_of_rerun),
                "{folder} uses {dependency}"
            );
        }
    }
}

#[test]
fn the_core_crates_do_no_input_or_output_and_read_no_clock() {
    let words = [
        "std::fs",
        "std::io",
        "std::env",
        "std::time",
        "std::thread",
        "println!",
        "mul_add",
    ];
    assert_absent(&CORE, &words);
    assert_absent(&["crates/model/src"], &["rand"]);
}

/// One result on every machine: no transcendental function of the platform's own library.
#[test]
fn transcendental_functions_come_from_libm() {
    let platform = [
        ".sin()",
        ".cos()",
        ".tan()",
        ".atan2(",
        ".powf(",
        ".powi(",
        ".exp()",
        ".ln()",
        ".sin_cos()",
    ];
    assert_absent(&CORE, &platform);
}

#[test]
fn hash_order_decides_nothing() {
    for places in [&CORE[..], &LIBRARY, &["crates/explorer/src", "src"]] {
        assert_absent(places, &["HashMap", "HashSet"]);
    }
}

/// One place knows registers, and one the loops over them: everything else is written over `Real`.
#[test]
fn instruction_sets_are_known_to_the_lanes() {
    assert_absent(&PHYSICS, &["pulp"]);
    assert_absent(&["crates/model/src/mechanism", "crates/optimize/src"], &["pulp"]);
    // Fused, approximate, or summed over lanes: what would make a result depend on the processor.
    let words = ["mul_add", "approx", "reduce_sum", "reduce_product", "relaxed"];
    assert_absent(&["crates/model/src/lanes", "crates/model/src/workspace"], &words);
}

#[test]
fn architectures_are_named_in_mechanism_alone() {
    let legs = [
        "PrrChain",
        "RprChain",
        "RrrChain",
        "Architecture::R",
        "Architecture::Prr",
        "Architecture::Prp",
        "Architecture::Ppr",
        "\"RRR\"",
        "\"PRR\"",
    ];
    let loops = [
        "crates/model/src/workspace",
        "crates/model/src/lanes",
        "crates/optimize/src",
    ];
    for places in [&PHYSICS[..], &loops, &LIBRARY, &["crates/explorer/src", "src"]] {
        assert_absent(places, &legs);
    }
}

/// A study is a study: nothing but the page of a report asks whether it is that of the paper.
#[test]
fn only_a_section_of_the_report_knows_the_paper() {
    for (path, code) in LIBRARY.iter().flat_map(|place| sources(place)) {
        if !path.display().to_string().contains("page/") {
            let asks = ["of_paper", "is_paper", "as_the_paper"]
                .iter()
                .any(|word| code.contains(word));
            assert!(!asks, "{} asks for the paper's study", path.display());
        }
    }
}

#[test]
fn a_panel_shows_what_others_computed() {
    let physics = [
        "kinefront_model::kinematics",
        "kinefront_model::stiffness",
        "kinefront_model::workspace",
        ".pose_evaluator",
    ];
    assert_absent(&["crates/explorer/src"], &physics);
    for (path, code) in sources("crates/explorer/src") {
        // The places that know the embedded viewer; none but the recording names entities.
        let knows = ["viewer.rs", "app/mod.rs", "theme.rs"]
            .iter()
            .any(|file| path.ends_with(file));
        assert!(
            knows || !code.contains("re_viewer"),
            "{} knows the viewer",
            path.display()
        );
        let names = code.contains("rerun::Points") || code.contains("\"/design");
        assert!(!names, "{} names entities", path.display());
    }
}
