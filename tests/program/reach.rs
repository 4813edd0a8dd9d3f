//! What a run folder, a study or a name from elsewhere would reach outside: links, pipes, catalogues, terminals.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use predicates::prelude::PredicateBooleanExt;

use super::handed_over::{PATIENCE, merge, run_of};
use super::support::{
    DESIGN, check, copy, folder, kinefront, optimize, repair, resume, said, sample, says, short_study, tables,
};

/// A link in a run folder is replaced; what it leads to is neither read as a table of the run nor written to.
#[cfg(unix)]
#[test]
fn nothing_outside_the_folder_is_written_through_a_link() {
    use std::os::unix::fs::symlink;

    let folder = folder();
    let victim = folder.write("victim", "precious");
    let untouched = || assert_eq!(folder.read("victim"), "precious");
    let study = short_study(folder.path());
    // A name that a temporary file once had, before the run.
    let run = folder.join("run");
    fs::create_dir(&run).expect("a folder");
    for name in ["run.json", "study.toml", "front.csv", "progress.json"] {
        symlink(&victim, run.join(format!(".{name}.partial"))).expect("a link");
    }
    optimize(&study, &run, &["--evaluations", "90"]);
    untouched();
    // Files of the run are links: they are replaced, not written through.
    let whole = tables(&run);
    for name in ["front.csv", "recording.rrd", "progress.json"] {
        let _ = fs::remove_file(run.join(name));
        symlink(&victim, run.join(name)).expect("a link");
    }
    fs::remove_file(run.join("progress.json")).expect("a link");
    repair(&run).success();
    untouched();
    assert!(tables(&run) == whole);
    assert!(!run.join("recording.rrd").is_symlink());
    // The table of the designs is the lock of the folder: a link in its place is refused.
    let linked = folder.join("linked");
    fs::create_dir(&linked).expect("a folder");
    symlink(&victim, linked.join("designs.csv")).expect("a link");
    let told = folder.run("optimize small.toml --out linked").code(2);
    told.stderr(says("regular file"));
    untouched();
    let table = run.join("designs.csv");
    fs::rename(&table, folder.join("designs.csv")).expect("a move");
    symlink(folder.join("designs.csv"), &table).expect("a link");
    let told = resume(&run, &["--evaluations", "120"]).code(2);
    told.stderr(says("regular file"));
}

/// Files that have no end, or that nobody writes, are refused at once.
#[cfg(unix)]
#[test]
fn pipes_and_devices_are_refused() {
    use std::os::unix::fs::symlink;
    use std::process::Command;

    let folder = folder();
    let whole = run_of(&folder, "run", &[]);
    let pipe = |path: &Path| {
        let made = Command::new("mkfifo").arg(path).status();
        assert!(made.expect("mkfifo runs").success());
    };
    let zero = |path: &Path| symlink("/dev/zero", path).expect("a link");
    let sparse = |path: &Path| {
        let file = fs::File::create(path).expect("a file");
        file.set_len(1 << 40).expect("a sparse file");
    };
    type Make<'a> = &'a dyn Fn(&Path);
    let kinds: [(&str, Make<'_>); 3] = [("pipe", &pipe), ("zero", &zero), ("sparse", &sparse)];
    let files = ["study.toml", "designs.csv", "front.csv", "run.json", "progress.json"];
    let cases: Vec<_> = kinds.iter().flat_map(|kind| files.map(|file| (kind, file))).collect();
    for ((name, make), file) in sample(cases.into_iter(), 8) {
        let run = copy(&whole, &folder.join(format!("{name}-{file}")));
        let _ = fs::remove_file(run.join(file));
        make(&run.join(file));
        for arguments in [
            &["check"][..],
            &["optimize", "--resume"],
            &["export", "--out", "/dev/null/front.csv"],
        ] {
            let told = kinefront().args(arguments).arg(&run).timeout(PATIENCE).assert();
            let code = told.get_output().status.code();
            // A run that is complete needs no other file to say so.
            let least = if arguments[0] == "optimize" { 0 } else { 1 };
            assert!(
                code.is_some_and(|code| (least..=3).contains(&code)),
                "{name} {file} {arguments:?}: {code:?}"
            );
        }
    }
    for (name, make) in kinds {
        make(&folder.join(name));
        let text = format!("[sections]\nlegs = {{ kind = \"tube\", catalogue = \"{name}\" }}\n");
        let study = folder.write("tubes.toml", text);
        let mut command = kinefront();
        command.args(["study", "check"]).arg(study).timeout(PATIENCE);
        command.assert().code(2).stderr(says("catalogue"));
    }
}

#[test]
fn a_study_names_no_files_outside_its_folder() {
    let folder = folder();
    fs::create_dir(folder.join("inside")).expect("a folder");
    let secret = folder.write("secret.csv", "root:secret,of,others\nanother:secret\n");
    let tubes = "name,outer_mm,wall_mm\na,30,2\nb,40,3\n";
    let good = folder.write("tubes.csv", tubes);
    let checked = |catalogue: &str, more: &str| {
        let text = format!("[sections]\nlegs = {{ kind = \"tube\", catalogue = '{catalogue}' }}\n");
        folder.write("inside/study.toml", text);
        folder.run(&format!("study check inside/study.toml {more}"))
    };
    let refused = |catalogue: &str| checked(catalogue, "").code(2).stderr(says("--outside-files"));
    refused("../tubes.csv");
    refused(&good.display().to_string());
    refused("../secret.csv");
    checked("../tubes.csv", "--outside-files").success();
    // What is in a file that is not a catalogue is not told.
    checked("../secret.csv", "--outside-files").code(2).stderr(
        says("must name the columns")
            .and(says("secret,of").not())
            .and(says("another").not()),
    );
    folder.write("inside/tubes.csv", tubes);
    checked("tubes.csv", "").success();
    checked("../inside/tubes.csv", "").success();
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&secret, folder.join("inside/link.csv")).expect("a link");
        refused("link.csv");
    }
}

#[test]
fn names_reach_neither_terminals_nor_spreadsheets_as_commands() {
    let folder = folder();
    let named = |name: &str| {
        folder.write("study.toml", format!("name = {name}\n"));
        folder.run("study check study.toml")
    };
    for (name, told) in [
        ("\"a\\u001b]0;title\\u0007\"", "\\u{1b}"),
        ("\"a\\u202eb\"", "\\u{202e}"),
        ("\"a\\nb\"", "\\u{a}"),
        ("\"a\\u0000b\"", "\\u{0}"),
        (&format!("\"{}\"", "n".repeat(101)), "101 characters"),
        (&format!("\"{}\"", "n".repeat(300)), "300 characters"),
    ] {
        named(name).code(2).stderr(says(told).and(says("name")));
    }
    named(&format!("\"{}\"", "n".repeat(100))).success();
    // A message that quotes a file does not pass its characters on.
    folder.write("study.toml", "nam\u{1b}[2Je = 1\n");
    assert!(!said(&folder.run("study check study.toml").code(2)).contains('\u{1b}'));
    let told = said(&folder.run("check 'missing\u{1b}]0;title\u{7}\u{202e}'").code(2));
    assert!(
        told.contains("\\u{1b}") && !told.contains(['\u{1b}', '\u{7}', '\u{202e}']),
        "{told}"
    );
    // A reference design is a mark in the front, and a folder a name in the origins.
    let text = kinefront_testkit::small_study(90);
    let reference = format!("[[references]]\nname = \"=1+1\"\ndesign = \"{DESIGN}\"\n");
    let study = folder.write("study.toml", text + &reference);
    let runs = ["-1+1", "@a"].map(|name| folder.join(name));
    for (seed, run) in runs.iter().enumerate() {
        optimize(&study, run, &["--no-recording", "--seed", &seed.to_string()]);
        let front = fs::read_to_string(run.join("front.csv")).expect("a front");
        assert!(!front.contains(",=") && !front.contains(",@"), "{front}");
    }
    let merged = folder.join("merged");
    merge(&[&runs[0], &runs[1]], &merged).success();
    let origins = folder.read("merged/origins.csv");
    let names = origins.lines().skip(1).filter_map(|line| line.split('"').nth(1));
    assert_eq!(BTreeSet::from_iter(names), BTreeSet::from(["'-1+1", "'@a"]));
    check(&merged).success();
}

/// A write beyond the limit of the size of a file fails like any other.
#[cfg(target_os = "linux")]
#[test]
fn a_limit_of_the_size_of_files_is_told() {
    let folder = folder();
    let run = folder.join("run");
    let script = format!(
        "ulimit -f 16; exec {} optimize {} --evaluations 600 --out {} --no-recording --quiet",
        env!("CARGO_BIN_EXE_kinefront"),
        short_study(folder.path()).display(),
        run.display()
    );
    let ended = std::process::Command::new("sh")
        .args(["-c", &script])
        .output()
        .expect("sh runs");
    let told = String::from_utf8_lossy(&ended.stderr);
    assert_eq!(ended.status.code(), Some(3), "{told}");
    assert!(told.contains("designs.csv") && told.contains("too large"), "{told}");
    resume(&run, &[]).success();
    check(&run).success();
}
