//! The documents as a new user follows them: their commands run, and what is made from the program is current.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::support::{
    Folder, folder, is_thorough, kinefront, number, python, read_rows, run, said, small_study, value, words,
};

fn document(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Returns what a command line of the program prints in a folder.
fn printed_in(folder: &Folder, line: &str) -> String {
    let told = folder.run(line).success();
    String::from_utf8(told.get_output().stdout.clone()).expect("UTF-8")
}

fn printed(line: &str) -> String {
    printed_in(&folder(), line)
}

/// The commands of `kinefront` in the shell blocks of a document, without comments.
fn commands(text: &str) -> Vec<String> {
    let blocks = text
        .split("```sh\n")
        .skip(1)
        .filter_map(|rest| rest.split("```").next());
    blocks
        .flat_map(|block| {
            block
                .replace("\\\n", " ")
                .lines()
                .map(str::to_owned)
                .collect::<Vec<_>>()
        })
        .map(|line| line.split("  #").next().unwrap_or_default().trim().to_owned())
        .filter(|line| line.starts_with("kinefront "))
        .collect()
}

/// The reference of keys is what the program prints.
#[test]
fn the_reference_of_keys_is_current() {
    let text = document("docs/study.md");
    let (_, reference) = text
        .split_once("<!-- kinefront study keys -->\n\n")
        .expect("the mark of what the program prints");
    assert_eq!(
        reference,
        printed("study keys"),
        "write the output of `kinefront study keys` behind the mark in docs/study.md"
    );
}

/// The tables of the documents that follow from commands are what the commands print, and so are the listings of the tutorial, whose
/// commands all run in an empty folder. By day, without those of searches.
#[test]
fn the_tables_of_the_documents_are_current() {
    let Some(mut python) = python(&["json"]) else { return };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/make.py");
    let tutorial = commands(&document("docs/tutorial.md"));
    assert!(tutorial.len() >= 9, "{tutorial:?}");
    let names: &[&str] = if is_thorough() { &[] } else { &["published", "studies"] };
    let program = ["--check", "--program", env!("CARGO_BIN_EXE_kinefront")];
    let output = python
        .arg(script)
        .args(program)
        .args(names)
        .output()
        .expect("Python runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
}

/// A part of a key leads to its section, and an unknown one is an error.
#[test]
fn keys_are_found_by_a_part() {
    let found = printed("study keys clearance");
    assert!(
        found.contains("`clearance_min_m`") && found.contains("`clearance_m`"),
        "{found}"
    );
    assert!(!found.contains("density_kg_per_m3"), "{found}");
    assert!(said(&run("study keys torsion").code(2)).contains("torsion"));
}

/// The commands of the documents have the options that the program has: each is tried with an option that it cannot have, which is then
/// the first that it complains about.
#[test]
fn commands_of_the_documents_are_known() {
    let mut count = 0;
    for name in [
        "README.md",
        "docs/tutorial.md",
        "docs/howto.md",
        "docs/exports.md",
        "docs/troubleshooting.md",
        "docs/window.md",
    ] {
        for command in commands(&document(name)) {
            // Only the program itself: what is piped into it or out of it is the shell's.
            // The window's command accepts anything where there is none.
            let is_of_window = cfg!(not(feature = "explorer")) && command.starts_with("kinefront explore");
            if is_of_window || command.contains(['|', '>', '<', '$', ';', '&', '*', '…']) {
                continue;
            }
            let mut arguments = words(&command);
            arguments.remove(0);
            arguments.push("--no-such-option".to_owned());
            let said = said(&kinefront().args(&arguments).assert().code(2));
            assert!(said.contains("'--no-such-option'"), "{name}: {command}\n{said}");
            count += 1;
        }
    }
    assert!(count > 10, "only {count} commands");
}

/// Every table of a run has designs with names, which are those of its column `mark`.
#[test]
fn designs_are_found_by_their_names() {
    let folder = folder();
    small_study(folder.path());
    let search = "optimize small.toml --out run --evaluations 200 --no-recording --quiet";
    folder.run(search).success();
    let rows = read_rows(&folder.join("run/front.csv"));
    let evaluated = |name: &str| printed_in(&folder, &format!("evaluate run/front.csv#{name} --grid fine --json"));
    for name in ["lightest", "knee", "largest"] {
        let row = rows.iter().find(|row| row["mark"] == name).expect("a mark");
        assert_eq!(evaluated(name), evaluated(&row["id"]), "{name}");
    }
    assert_eq!(evaluated("best"), evaluated("lightest"));
    let best: Value = serde_json::from_str(&evaluated("best")).expect("JSON");
    let masses = rows.iter().map(|row| value(row, "mass_kg"));
    let least = masses.min_by(f64::total_cmp).expect("a row");
    assert!((number(&best["mass_kg"]) / least - 1.0).abs() < 1e-12);
    // The table of all designs has the same names.
    for name in ["best", "knee", "largest"] {
        for (command, more) in [
            ("evaluate", ""),
            ("certify", ""),
            ("pose", "--pose 'x=0 y=0 phi_deg=30' --json"),
        ] {
            folder
                .run(&format!("{command} run/designs.csv#{name} {more}"))
                .success();
        }
    }
    let said = said(&folder.run("evaluate run/front.csv#heaviest").code(2));
    for name in ["#heaviest", "#knee", "#lightest"] {
        assert!(said.contains(name), "{said}");
    }
}

/// Each command has a manual page, which names its options, and no page replaces a file.
#[test]
fn manual_pages_name_every_command() {
    let folder = folder();
    folder.run("manual man").success();
    let found: BTreeSet<String> = fs::read_dir(folder.join("man"))
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    let help = printed("--help");
    let commands: Vec<&str> = help
        .split("Commands:")
        .nth(1)
        .expect("the commands")
        .lines()
        .skip(1)
        .map_while(|line| line.strip_prefix("  ")?.split_whitespace().next())
        .filter(|&name| name != "help")
        .collect();
    assert!(commands.contains(&"optimize") && commands.len() > 15, "{commands:?}");
    for command in commands {
        assert!(
            found.contains(&format!("kinefront-{command}.1")),
            "{command}: {found:?}"
        );
    }
    assert!(found.contains("kinefront-study-new.1"), "{found:?}");
    let page = folder.read("man/kinefront-optimize.1");
    assert!(page.contains(".TH ") && page.contains("\\-\\-resume"), "{page}");
    folder.run("manual man").code(2);
    let told = folder.run("manual man/kinefront.1").code(2);
    assert!(said(&told).contains("is not a folder"));
}

/// Scripts for shells complete the commands; bash accepts its own.
#[test]
fn completions_are_scripts() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        assert!(printed(&format!("completions {shell}")).contains("optimize"), "{shell}");
    }
    let folder = folder();
    let script = folder.write("kinefront.bash", printed("completions bash"));
    if let Ok(status) = Command::new("bash").arg("-n").arg(&script).status() {
        assert!(status.success());
    }
}

/// The version says which build it is.
#[test]
fn the_version_names_the_build() {
    let version = printed("--version");
    let window = match cfg!(feature = "explorer") {
        true => "with the window",
        false => "without a window",
    };
    assert!(
        version.starts_with(&format!("kinefront {}", env!("CARGO_PKG_VERSION"))),
        "{version}"
    );
    assert!(version.contains(window), "{version}");
}
