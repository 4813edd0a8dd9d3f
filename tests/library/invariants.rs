//! What ARCHITECTURE.md states about the modules, checked by what their source does not mention. What the packages may use at
//! all is held by the compiler; here stands what it cannot see.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(files(&path, extension));
        } else if path.extension().is_some_and(|found| found == extension) {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The sources below a folder or in a file, without comments: documentation may speak of anything.
fn sources(place: &str) -> Vec<(PathBuf, String)> {
    let path = root().join(place);
    let found = if path.is_dir() { files(&path, "rs") } else { vec![path] };
    assert!(!found.is_empty(), "there is no source in {place}");
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let code: Vec<&str> = text
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"))
            .collect();
        (path, code.join("\n"))
    };
    found.into_iter().map(read).collect()
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

const CRATES: [&str; 2] = ["crates/model/src", "crates/optimize/src"];

/// The modules of the model that are written once for all architectures and for all instruction sets.
const PHYSICS: [&str; 7] = [
    "crates/model/src/certify",
    "crates/model/src/enclosure",
    "crates/model/src/clearance",
    "crates/model/src/evaluation",
    "crates/model/src/kinematics",
    "crates/model/src/stiffness",
    "crates/model/src/spatial.rs",
];

/// Every module of the program, window and command line left out.
const LIBRARY: [&str; 5] = [
    "crates/study/src",
    "crates/scene/src",
    "crates/export/src",
    "src/report",
    "src/recording",
];

/// Names of the crates that the package in a folder depends on.
fn dependencies(folder: &str) -> Vec<String> {
    let text = fs::read_to_string(root().join(folder).join("Cargo.toml")).expect("a manifest");
    let manifest: toml::Table = text.parse().expect("TOML");
    manifest["dependencies"]
        .as_table()
        .expect("dependencies")
        .keys()
        .cloned()
        .collect()
}

#[test]
fn the_core_crates_depend_on_numbers_alone() {
    for (name, allowed) in [
        ("model", &["glam", "libm", "nalgebra", "pulp", "serde", "thiserror"][..]),
        (
            "optimize",
            &["libm", "nalgebra", "rand_chacha", "rand_core", "serde", "sobol_burley"],
        ),
    ] {
        for dependency in dependencies(&format!("crates/{name}")) {
            assert!(
                allowed.contains(&dependency.as_str()),
                "kinefront-{name} uses {dependency}"
            );
        }
    }
}

/// The package for Python is built from these crates: it must need neither Rerun nor a window.
#[test]
fn only_the_program_needs_rerun_and_a_window() {
    for folder in ["crates/study", "crates/scene", "crates/export", "python"] {
        let dependencies = dependencies(folder);
        assert!(dependencies.len() > 3);
        for dependency in dependencies {
            let is_of_window = ["egui", "eframe", "re_", "rfd"]
                .iter()
                .any(|start| dependency.starts_with(start));
            assert!(!is_of_window && dependency != "rerun", "{folder} uses {dependency}");
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
    assert_absent(&CRATES, &words);
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
    assert_absent(&CRATES, &platform);
}

#[test]
fn hash_order_decides_nothing() {
    assert_absent(&CRATES, &["HashMap", "HashSet"]);
    assert_absent(&LIBRARY, &["HashMap", "HashSet"]);
    assert_absent(&["src/explorer"], &["HashMap", "HashSet"]);
}

/// One place knows registers, and one the loops over them: everything else is written over `Real`.
#[test]
fn instruction_sets_are_known_to_the_lanes() {
    assert_absent(&PHYSICS, &["pulp"]);
    assert_absent(&["crates/model/src/mechanism", "crates/optimize/src"], &["pulp"]);
    // Fused, approximate, or summed over lanes: what would make a result depend on the processor.
    let words = ["mul_add", "approx", "reduce_sum", "reduce_product", "relaxed"];
    assert_absent(&["crates/model/src/lanes.rs", "crates/model/src/workspace"], &words);
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
    assert_absent(&PHYSICS, &legs);
    assert_absent(
        &[
            "crates/model/src/workspace",
            "crates/model/src/lanes.rs",
            "crates/optimize/src",
        ],
        &legs,
    );
    assert_absent(&LIBRARY, &legs);
    assert_absent(&["src/explorer", "src/cli"], &legs);
}

#[test]
fn only_the_recording_and_the_window_know_rerun() {
    let others = [
        "crates/study/src",
        "crates/scene/src",
        "crates/export/src",
        "python/src",
        "src/report",
    ];
    assert_absent(&others, &["rerun", "egui", "crate::recording"]);
    assert_absent(&["src/recording"], &["egui", "eframe", "re_viewer", "crate::explorer"]);
}

#[test]
fn a_panel_shows_what_others_computed() {
    let physics = [
        "kinefront_model::kinematics",
        "kinefront_model::stiffness",
        "kinefront_model::workspace",
        ".checker",
    ];
    assert_absent(&["src/explorer"], &physics);
    for (path, code) in sources("src/explorer") {
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

/// A type name means one thing in the whole project.
#[test]
fn every_type_name_stands_once() {
    let mut places: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for place in [
        "crates/export/src",
        "crates/model/src",
        "crates/optimize/src",
        "crates/scene/src",
        "crates/study/src",
        "python/src",
        "src",
    ] {
        for (path, code) in sources(place) {
            for line in code.lines() {
                let line = line.trim_start_matches("pub(super) ").trim_start_matches("pub(crate) ");
                let line = line.strip_prefix("pub ").unwrap_or(line);
                let name = ["struct ", "enum ", "trait ", "type "]
                    .iter()
                    .find_map(|keyword| line.strip_prefix(keyword))
                    .and_then(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next());
                if let Some(name) = name.filter(|name| !name.is_empty()) {
                    places
                        .entry(name.to_owned())
                        .or_default()
                        .push(path.display().to_string());
                }
            }
        }
    }
    assert!(places.len() > 150, "only {} types found", places.len());
    let twice: Vec<_> = places.iter().filter(|(_, places)| places.len() > 1).collect();
    assert!(twice.is_empty(), "{twice:#?}");
}

/// Headings of a document, `2.1 Geometry common to all` as `2.1`.
fn sections(document: &str) -> Vec<String> {
    let text = fs::read_to_string(root().join(document)).expect("a document");
    let headings = text.lines().filter(|line| line.starts_with('#'));
    let number = |line: &str| {
        line.trim_start_matches('#')
            .split_whitespace()
            .next()
            .map(str::to_owned)
    };
    headings.filter_map(number).collect()
}

/// Sources and tests refer to sections of the documentation that exist, and to nothing outside the repository.
#[test]
fn references_to_the_model_lead_to_its_sections() {
    let model = sections("docs/model.md");
    assert!(
        model.contains(&"4.3".to_owned()) && model.contains(&"12".to_owned()),
        "{model:?}"
    );
    let mut count = 0;
    for place in ["crates", "python", "src", "tests", "benches", "examples"] {
        for path in files(&root().join(place), "rs") {
            let text = fs::read_to_string(&path).expect("a source");
            if path.ends_with("library/invariants.rs") {
                continue;
            }
            assert!(
                !text.contains("SPEC"),
                "{} refers to a document of others",
                path.display()
            );
            // A reference may be broken over two lines of a comment.
            let joined = text
                .replace("\n//! ", " ")
                .replace("\n/// ", " ")
                .replace("\n    /// ", " ");
            for rest in joined.split("docs/model.md, section ").skip(1) {
                let number: String = rest.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
                let number = number.trim_end_matches('.').to_owned();
                assert!(
                    model.contains(&number),
                    "{}: there is no section {number}",
                    path.display()
                );
                count += 1;
            }
        }
    }
    assert!(count > 20, "only {count} references");
}

/// Files that the documents name exist, equations are numbered without gaps, and links between documents lead somewhere.
#[test]
fn documents_refer_to_what_is_there() {
    let documents = [
        "README.md",
        "ARCHITECTURE.md",
        "CONTRIBUTING.md",
        "docs/model.md",
        "docs/interfaces.md",
        "docs/benchmarks.md",
        "python/README.md",
    ];
    for document in documents {
        let path = root().join(document);
        let text = fs::read_to_string(&path).expect("a document");
        for rest in text.split("](").skip(1) {
            let link = rest.split([')', ' ']).next().unwrap_or_default();
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            if file.starts_with("http") {
                continue;
            }
            let target = if file.is_empty() {
                path.clone()
            } else {
                path.with_file_name("").join(file)
            };
            assert!(target.exists(), "{document} links to {link}");
            if !anchor.is_empty() {
                let slug = |line: &str| {
                    let kept = line.trim_start_matches('#').trim().to_lowercase();
                    let kept: String = kept
                        .chars()
                        .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-'))
                        .collect();
                    kept.replace(' ', "-")
                };
                let target = fs::read_to_string(&target).expect("a document");
                let found = target
                    .lines()
                    .filter(|line| line.starts_with('#'))
                    .any(|line| slug(line) == anchor);
                assert!(found, "{document} links to {link}, which has no such heading");
            }
        }
        for word in text.split('`').skip(1).step_by(2) {
            let is_file = word.contains('/')
                && [".rs", ".md", ".json", ".py", ".toml"]
                    .iter()
                    .any(|end| word.ends_with(end));
            let is_ours = ["crates/", "src/", "tests/", "docs/", "benches/", "assets/"]
                .iter()
                .any(|start| word.starts_with(start));
            if is_file && is_ours && !word.contains('*') {
                assert!(root().join(word).exists(), "{document} names {word}");
            }
        }
    }
    let model = fs::read_to_string(root().join("docs/model.md")).expect("the model");
    let tags: Vec<usize> = model
        .split("\\tag{")
        .skip(1)
        .filter_map(|rest| rest.split('}').next()?.parse().ok())
        .collect();
    assert_eq!(tags, (1..=tags.len()).collect::<Vec<_>>());
    assert!(tags.len() > 30);
}

/// The contract lists the columns of the tables in their order.
#[test]
fn the_interfaces_list_every_column_in_order() {
    let text = fs::read_to_string(root().join("docs/interfaces.md")).expect("the interfaces");
    let mut rest = text.as_str();
    for column in kinefront::study::Column::of_front(&kinefront::study::Study::default()) {
        let name = format!("`{}`", column.name());
        let found = rest
            .find(&name)
            .unwrap_or_else(|| panic!("{name} is missing, or not in its place"));
        rest = &rest[found..];
    }
}
