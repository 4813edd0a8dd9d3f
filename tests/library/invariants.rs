//! Checks the rules of ARCHITECTURE.md on what a module may use: its source does not mention anything else.

use std::fs;
use std::path::{Path, PathBuf};

fn sources(module: &str) -> Vec<(PathBuf, String)> {
    fn collect(path: &Path, found: &mut Vec<PathBuf>) {
        if path.is_dir() {
            for entry in fs::read_dir(path).expect("a folder") {
                collect(&entry.expect("an entry").path(), found);
            }
        } else {
            found.push(path.to_owned());
        }
    }
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    for path in [src.join(module), src.join(format!("{module}.rs"))] {
        if path.exists() {
            collect(&path, &mut found);
        }
    }
    assert!(!found.is_empty(), "no module {module}");
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).expect("a source");
        // Comments may mention anything.
        let code: Vec<&str> = text
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"))
            .collect();
        (path, code.join("\n"))
    };
    found.into_iter().map(read).collect()
}

fn absent(modules: &[&str], words: &[&str]) {
    for module in modules {
        for (path, code) in sources(module) {
            for word in words {
                assert!(!code.contains(word), "{} mentions `{word}`", path.display());
            }
        }
    }
}

const MODEL: [&str; 8] = [
    "lanes",
    "spatial",
    "mechanism",
    "kinematics",
    "stiffness",
    "clearance",
    "workspace",
    "evaluation",
];

#[test]
fn only_the_recording_knows_rerun() {
    let outside = [
        &MODEL[..],
        &["optimize", "study", "scene", "export", "report", "palette"],
    ]
    .concat();
    absent(&outside, &["rerun", "egui", "crate::recording"]);
    absent(&["recording"], &["egui", "eframe", "re_viewer", "crate::explorer"]);
}

#[test]
fn a_panel_shows_what_others_computed() {
    let physics = ["crate::kinematics", "crate::stiffness", "crate::workspace", ".checker"];
    absent(&["explorer"], &physics);
    // Only these files use the embedded viewer, and only the recording names entities.
    for (path, code) in sources("explorer") {
        let knows = ["viewer.rs", "app/mod.rs", "theme.rs"]
            .iter()
            .any(|file| path.ends_with(file));
        assert!(
            knows || !code.contains("re_viewer"),
            "{} uses the embedded viewer",
            path.display()
        );
        assert!(
            !code.contains("rerun::Points") && !code.contains("\"/design"),
            "{} names entities of a recording",
            path.display()
        );
    }
}

/// Only `lanes` uses vector registers and only `workspace` loops over them: everything else is written in terms of
/// `Real`.
#[test]
fn instruction_sets_are_known_to_the_lanes() {
    let outside = [
        "spatial",
        "mechanism",
        "kinematics",
        "stiffness",
        "evaluation",
        "optimize",
        "study",
        "scene",
    ];
    absent(&outside, &["pulp"]);
    for module in ["lanes", "workspace"] {
        // Fused or approximate operations and sums over lanes would make a result depend on the processor.
        absent(
            &[module],
            &["mul_add", "approx", "reduce_sum", "reduce_product", "relaxed"],
        );
    }
}

#[test]
fn the_optimizer_knows_nothing_of_robots() {
    let ours = [
        "mechanism",
        "kinematics",
        "stiffness",
        "workspace",
        "evaluation",
        "study",
        "recording",
        "spatial",
        "lanes",
    ];
    for module in ours {
        absent(&["optimize"], &[&format!("crate::{module}")]);
    }
}

#[test]
fn the_model_does_no_input_or_output_and_reads_no_clock() {
    absent(
        &MODEL,
        &[
            "std::fs",
            "std::io",
            "std::env",
            "std::time",
            "std::thread",
            "println!",
            "rand",
            "mul_add",
        ],
    );
    // For the same result on every machine, the platform's own transcendental functions are not used.
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
    absent(&MODEL, &platform);
    absent(&["optimize"], &platform);
}

#[test]
fn architectures_are_named_in_mechanism_alone() {
    let outside = [
        "lanes",
        "spatial",
        "kinematics",
        "stiffness",
        "workspace",
        "evaluation",
        "optimize",
        "study",
        "recording",
        "explorer",
        "export",
        "report",
    ];
    absent(
        &outside,
        &[
            "PrrLeg",
            "RprLeg",
            "RrrLeg",
            "Architecture::Prr",
            "Architecture::Rpr",
            "Architecture::Rrr",
        ],
    );
}

#[test]
fn hash_order_decides_nothing() {
    let others = [
        "optimize",
        "study",
        "recording",
        "scene",
        "explorer",
        "export",
        "report",
    ];
    let all = [&MODEL[..], &others].concat();
    absent(&all, &["HashMap", "HashSet"]);
}
