//! Faults from below: a folder that goes away, a full disk, no network.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Instant;

use super::support::{folder, program, sample, short_run, short_study, tables, wait_for, words};

/// A run whose folder is removed, moved or truncated ends and says so, and leaves no gap in its table.
#[cfg(unix)]
#[test]
fn a_run_notices_that_its_folder_is_gone() {
    let folder = folder();
    let study = short_study(folder.path());
    type Happening = fn(&Path);
    let faults: [(&str, Happening); 3] = [
        ("removed", |run| fs::remove_dir_all(run).expect("a folder")),
        ("moved", |run| {
            fs::rename(run, run.with_extension("elsewhere")).expect("a folder")
        }),
        ("truncated", |run| {
            let table = File::options()
                .write(true)
                .open(run.join("designs.csv"))
                .expect("a table");
            table.set_len(3000).expect("a shorter table");
        }),
    ];
    for (name, fault) in faults {
        let run = folder.join(name);
        let child = program()
            .arg("optimize")
            .arg(&study)
            .args(["--evaluations", "100000000", "--quiet", "--no-recording", "--out"])
            .arg(&run)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        wait_for(&run, 200);
        fault(&run);
        let ended = child.wait_with_output().expect("an end");
        let said = String::from_utf8_lossy(&ended.stderr);
        assert_eq!(ended.status.code(), Some(3), "{name}: {said}");
        assert!(
            said.contains("designs.csv") || said.contains("progress.json"),
            "{name}: {said}"
        );
        if name == "truncated" {
            let text = fs::read(run.join("designs.csv")).expect("a table");
            assert!(!text.contains(&0), "a gap in the table");
        }
    }
}

/// Runs a script that may mount file systems, which nobody else sees.
fn in_mounts(script: &str) -> Output {
    let mut command = Command::new("unshare");
    command.args(["-rm", "sh", "-ec", script]);
    command.env("KINEFRONT", env!("CARGO_BIN_EXE_kinefront"));
    command.env_remove("RERUN").env("NO_COLOR", "1");
    command.output().expect("unshare runs")
}

/// A full disk costs the recording first, then ends the run, which prints its front, loses no row, and resumes when there
/// is space.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_costs_no_design() {
    if !in_mounts("mount -t tmpfs none /mnt").status.success() {
        eprintln!("skipped: a small file system cannot be mounted here");
        return;
    }
    let folder = folder();
    let study = short_study(folder.path());
    let whole = short_run(&["--evaluations", "900"]);
    for kib in sample([8, 16, 40, 120, 200, 300, 400, 440, 480, 600, 2000, 6000].iter(), 4) {
        let kept = folder.join(format!("kept{kib}"));
        // Whether it fails or not, the run ends in good order; then there is space, and it is resumed.
        let script = format!(
            "mount -t tmpfs -o size={kib}k none /mnt; mkdir /mnt/other; code=0; \
             \"$KINEFRONT\" optimize {study} --evaluations 900 --out /mnt/run --json >{out} 2>{err} || code=$?; \
             echo \"code $code\"; ls -la /mnt/run; \
             mount -o remount,size=100m /mnt; \
             if test -e /mnt/run/study.toml; then cp -r /mnt/run {kept}.before; \
             \"$KINEFRONT\" optimize --resume /mnt/run --quiet; \
             else \"$KINEFRONT\" optimize {study} --evaluations 900 --out /mnt/run --quiet; fi; \
             \"$KINEFRONT\" check /mnt/run; cp -r /mnt/run {kept}",
            study = study.display(),
            out = folder.join("out").display(),
            err = folder.join("err").display(),
            kept = kept.display(),
        );
        let output = in_mounts(&script);
        let said = format!(
            "{}{}",
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr)
        );
        assert!(output.status.success(), "{kib} KiB: {said}");
        let code = said.lines().find_map(|line| line.strip_prefix("code "));
        let code: i32 = code.expect("a code").parse().expect("a number");
        let (told, answer) = (folder.read("err"), folder.read("out"));
        let before = kept.with_extension("before");
        if before.exists() {
            // What was on the full disk is a beginning of the whole table.
            let rows = fs::read(before.join("designs.csv")).expect("a table");
            assert!(tables(&whole)[1].starts_with(&rows), "{kib} KiB: {told}");
            assert!(matches!(code, 0 | 3), "{kib} KiB: code {code}: {told}");
        }
        if code == 3 {
            assert!(
                told.contains("No space left") || told.contains("disk is full"),
                "{kib} KiB: {told}"
            );
            let names = ["designs.csv", "front.csv", "study.toml", ".json", "recording"];
            assert!(names.iter().any(|name| told.contains(name)), "{kib} KiB: {told}");
            // A run that could not begin has no front.
            if !told.contains("\u{d7} cannot write") {
                let front: serde_json::Value = serde_json::from_str(&answer).expect("the answer arrives");
                assert!(front["front_size"].as_u64().expect("a number") > 0, "{kib} KiB");
            }
        }
        assert!(tables(&kept) == tables(&whole), "{kib} KiB: {said}");
    }
}

/// A run needs no network: without a route it is the same, and it opens no socket but those of this machine.
#[cfg(target_os = "linux")]
#[test]
fn a_run_makes_no_attempt_to_reach_a_network() {
    let folder = folder();
    let study = short_study(folder.path());
    let (run, log) = (folder.join("run"), folder.join("calls"));
    let mut command = Command::new("unshare");
    command.args(words("-rn strace -f -qq -e trace=socket,connect,bind,listen -o"));
    command.arg(&log).arg(env!("CARGO_BIN_EXE_kinefront"));
    command.args(["optimize", "--evaluations", "90", "--quiet", "--out"]);
    let traced = command.arg(&run).arg(&study).output();
    let Ok(traced) = traced else {
        eprintln!("skipped: there is no unshare");
        return;
    };
    if !log.exists() {
        eprintln!("skipped: {}", String::from_utf8_lossy(&traced.stderr));
        return;
    }
    assert!(traced.status.success(), "{}", String::from_utf8_lossy(&traced.stderr));
    let calls = fs::read_to_string(&log).expect("a log");
    assert!(!calls.contains("AF_INET"), "{calls}");
    assert!(tables(&run) == tables(&short_run(&["--evaluations", "90"])));
}

/// A report that is replaced is there at every instant, the old page or the new one.
#[test]
fn a_report_is_replaced_at_once() {
    let folder = folder();
    let (run, page) = (short_run(&["--evaluations", "120"]), folder.join("page"));
    let replace = || {
        let mut command = program();
        command.arg("report").arg(&run).arg("--out").arg(&page);
        command.args(words(
            "--replace --quiet --sensitivity 0 --picture-width 160 --scale 0.25",
        ));
        command.stdout(Stdio::null()).stderr(Stdio::null());
        command
    };
    let since = Instant::now();
    assert!(replace().status().expect("the program runs").success());
    let duration = since.elapsed();
    let whole = |text: &str| text.starts_with("<!DOCTYPE html>") && text.trim_end().ends_with("</html>");
    let stale = page.join("figures/of-another-report.svg");
    for kill in sample(0..20_u32, 4) {
        fs::write(&stale, "<svg/>").expect("a figure");
        let mut child = replace().spawn().expect("the program starts");
        std::thread::sleep(duration.mul_f64(f64::from(kill) / 20.0));
        child.kill().expect("a signal");
        child.wait().expect("an end");
        let text = fs::read_to_string(page.join("index.html")).expect("a page");
        assert!(whole(&text), "kill {kill}: {} bytes", text.len());
    }
    assert!(replace().status().expect("the program runs").success());
    assert!(!stale.exists() && page.join("figures").read_dir().expect("figures").count() > 5);
}

/// What a file states is on the disk before the file is: each file is synchronised before it is renamed, and its folder
/// after; the table is synchronised before a checkpoint, the front or the report states its rows.
#[cfg(target_os = "linux")]
#[test]
fn files_are_synchronised_before_they_appear() {
    let folder = folder();
    let study = short_study(folder.path());
    let (run, log) = (folder.join("run"), folder.join("calls"));
    let mut command = Command::new("strace");
    let traced = "-f -qq -e trace=openat,fsync,fdatasync,rename,renameat,renameat2,write -o";
    command
        .args(words(traced))
        .arg(&log)
        .arg(env!("CARGO_BIN_EXE_kinefront"));
    command.args(words("optimize --evaluations 90 --quiet --no-recording --out"));
    let traced = command.arg(&run).arg(&study).output();
    if traced.is_err() || !log.exists() {
        eprintln!("skipped: there is no strace");
        return;
    }
    let calls = fs::read_to_string(&log).expect("a log");
    // `<... fsync resumed>` belongs to a call that has begun earlier; its begin counts.
    let calls: Vec<&str> = calls.lines().filter(|call| !call.contains("resumed>")).collect();
    let mut names = Vec::new();
    for (place, call) in calls.iter().enumerate().filter(|(_, call)| call.contains(" rename")) {
        let before = calls[..place].iter().rev();
        let steps: Vec<&&str> = before.take_while(|call| !call.contains("O_EXCL")).collect();
        assert!(
            steps.iter().any(|call| call.contains(" fsync(")),
            "{call}: not synchronised"
        );
        let after = calls[place + 1..].iter().take_while(|call| !call.contains("O_EXCL"));
        assert!(
            after.into_iter().any(|call| call.contains(" fsync(")),
            "{call}: the folder is not synchronised"
        );
        let name = call
            .rsplit('/')
            .next()
            .and_then(|rest| rest.split('"').next())
            .expect("a name");
        names.push(name.to_owned());
        if name == "run.json" {
            let rows = calls[..place]
                .iter()
                .rposition(|call| call.contains(" write(") && call.contains(",3-"));
            let table = calls[..place].iter().rposition(|call| call.contains(" fdatasync("));
            assert!(
                rows.is_some() && rows < table,
                "the table is not synchronised before run.json"
            );
        }
    }
    assert_eq!(names.first().map(String::as_str), Some("progress.json"));
    assert_eq!(names[names.len() - 2..], ["front.csv", "run.json"]);
    assert!(names.iter().any(|name| name == "study.toml"));
}
