//! Damaged files and bad input: what is wrong is named, and nothing is taken for something else.

use std::fs::{self, File};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;

use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::support::{
    DESIGN, check, copy, folder, kinefront, optimize, read_rows, repair, repetitions, report, resume, said, says,
    short_run, short_study, tables,
};

/// The line that ends a table decides: only a last row without its end of line is forgiven, and that is said.
#[test]
fn damage_is_never_read_as_less_data() {
    let folder = folder();
    let run = copy(&short_run(&["--evaluations", "120"]), &folder.join("run"));
    let table = run.join("designs.csv");
    let text = folder.read("run/designs.csv");
    let lines: Vec<&str> = text.lines().collect();
    let joined = |lines: &[&str]| lines.join("\n") + "\n";
    let with = |line: usize, new: &str| {
        let mut lines = lines.clone();
        lines[line] = new;
        joined(&lines)
    };
    let mass = lines[31].split(',').nth(9).expect("a mass");
    let other_digit = lines[31].replace(mass, &format!("{mass}1"));
    let swapped = [&lines[..30], &[lines[31], lines[30]], &lines[32..]].concat();
    let cases = [
        ("a comma", with(31, &lines[31].replacen(',', "", 1)), "line 32"),
        ("a number", with(31, &lines[31].replacen(mass, "NaN", 1)), "line 32"),
        ("an empty field", with(31, &lines[31].replacen(mass, "", 1)), "line 32"),
        ("no row", joined(&[&lines[..31], &lines[32..]].concat()), "line 32"),
        ("a row twice", joined(&[&lines[..32], &lines[31..]].concat()), "line 33"),
        ("two rows in another order", joined(&swapped), "line 31"),
        ("a digit more", with(31, &other_digit), "designs.csv"),
        ("fewer rows", joined(&lines[..61]), "(120 rows)"),
        (
            "no end of the last row",
            text[..text.len() - 1].to_owned(),
            "(120 rows)",
        ),
        (
            "an open quotation mark",
            with(31, &format!("\"{}", lines[31])),
            "line 32",
        ),
        (
            "an open quotation mark, and no end",
            with(31, &format!("\"{}", lines[31])).trim_end().to_owned(),
            "line 32",
        ),
    ];
    for (damage, damaged, place) in cases {
        println!("{damage}");
        fs::write(&table, damaged).expect("a table");
        let told = folder.run("report run --out page --quiet --sensitivity 0").code(2);
        told.stderr(says(place));
        check(&run).code(2).stdout(contains("designs.csv"));
    }
    fs::write(&table, &text).expect("a table");
    check(&run).success();
}

/// Cut at any line, the study of the run is not taken for another study.
#[test]
fn a_study_that_was_cut_is_not_that_of_the_run() {
    let folder = folder();
    let run = copy(&short_run(&["--evaluations", "120"]), &folder.join("run"));
    let text = folder.read("run/study.toml");
    let id = &read_rows(&run.join("front.csv"))[0]["id"];
    for cut in 0..text.lines().count() {
        let part: Vec<&str> = text.lines().take(cut).collect();
        folder.write("run/study.toml", part.join("\n"));
        let line = format!("export run/front.csv#{id} --format json --out -");
        let told = folder.run(&line).code(2);
        told.stderr(says("study.toml").and(says("not the file of the run")));
    }
}

/// The table of a small run, cut at every byte (by day, at every third one): the run resumes or is refused, and is never another one.
#[test]
fn a_table_cut_at_every_byte_resumes() {
    use kinefront_study::{ResumeOptions, Resumption};
    let folder = folder();
    let text = "name = \"tiny\"\narchitectures = [\"3-PRR\"]\n\
                [grid.reference]\nphi_step_deg = 10\ndirections = 3\nray_steps = 4\nhalvings = 1\n\
                [grid.fine]\nphi_step_deg = 10\ndirections = 6\nray_steps = 4\nhalvings = 1\n\
                [optimizer]\nevaluations = 12\nthreads = 1\nfront_designs = 4\nalgorithm = \"nsga2\"\n[optimizer.nsga2]\npopulation = 4\n";
    let study = folder.write("tiny.toml", text);
    let (whole, run) = (folder.join("whole"), folder.join("run"));
    optimize(&study, &whole, &["--no-recording"]);
    let table = fs::read(whole.join("designs.csv")).expect("a table");
    fs::create_dir(&run).expect("a folder");
    fs::copy(whole.join("study.toml"), run.join("study.toml")).expect("a study");
    let options = ResumeOptions {
        accept_unverified: true,
        ..ResumeOptions::default()
    };
    for length in (0..table.len()).step_by(repetitions(3, 1)) {
        // Neither a checkpoint nor a report states what should be there, and the user takes what is.
        fs::write(run.join("designs.csv"), &table[..length]).expect("a table");
        let resumption = Resumption::open(&run, &options).unwrap_or_else(|error| panic!("{length} bytes: {error}"));
        let complete = table[..length]
            .iter()
            .filter(|&&byte| byte == b'\n')
            .count()
            .saturating_sub(1);
        assert_eq!(resumption.search().replayed(), complete / 4 * 4, "{length} bytes");
        drop(resumption);
        if length.is_multiple_of(repetitions(291, 97)) {
            resume(&run, &["--no-recording", "--accept-unverified"]).success();
            assert!(tables(&run) == tables(&whole), "{length} bytes");
            fs::remove_file(run.join("run.json")).expect("a report");
        }
    }
}

/// Rows that were changed, and a study that was, are named.
#[test]
fn a_resumed_run_names_what_was_changed() {
    let folder = folder();
    let run = copy(&short_run(&["--evaluations", "300"]), &folder.join("run"));
    // Without the report, checksums are unknown, and only the rows themselves can tell.
    let report = folder.read("run/run.json");
    let unknown = || fs::remove_file(run.join("run.json")).expect("a report");
    let change = |file: &str, from: &str, to: &str| {
        let path = format!("run/{file}");
        let text = folder.read(&path);
        assert!(text.contains(from), "{from}");
        folder.write(&path, text.replacen(from, to, 1));
    };
    let more = ["--evaluations", "400", "--accept-unverified"];
    change("study.toml", "seed = 5", "seed = 6");
    let told = resume(&run, &more).code(2);
    told.stderr(says("study.toml").and(says("checksum")));
    unknown();
    let told = resume(&run, &more).code(2);
    told.stderr(says("design #0 does not follow"));
    change("study.toml", "seed = 6", "seed = 5");
    change("study.toml", "density_kg_per_m3 = 7850.0", "density_kg_per_m3 = 2700.0");
    resume(&run, &more).code(2).stderr(says("mass_kg"));
    change("study.toml", "density_kg_per_m3 = 2700.0", "density_kg_per_m3 = 7850.0");
    let version = "\"kinefront_version\": \"";
    // JSON that lacks a key is as damaged as what is not JSON: the checksums would be lost with it.
    let newer = report.replace(version, &format!("{version}9"));
    for (damaged, file, words) in [
        (newer, "", "written by Kinefront 9"),
        (report[..report.len() / 2].to_owned(), "run.json", "damaged"),
        (report.replace("\"outcome\"", "\"outcomf\""), "run.json", "outcome"),
    ] {
        folder.write("run/run.json", damaged);
        let told = resume(&run, &more).code(2);
        told.stderr(says(file).and(says(words)));
    }
    check(&run).code(2);
    // More rows than the study allows.
    unknown();
    change("study.toml", "evaluations = 300", "evaluations = 200");
    resume(&run, &["--accept-unverified"])
        .code(2)
        .stderr(says("300 designs").and(says("200 evaluations")));
    check(&run).code(2);
    change("study.toml", "evaluations = 200", "evaluations = 300");
    folder.write("run/run.json", &report);
    resume(&run, &more).success();
}

/// Changes a bit of the byte at a place of a file, which is stated as a share of its size.
fn flip(path: &Path, place: f64) {
    let mut file = File::options().read(true).write(true).open(path).expect("a file");
    let at = (place * file.metadata().expect("a size").len() as f64) as u64;
    let mut byte = [0];
    file.seek(SeekFrom::Start(at)).expect("a place");
    file.read_exact(&mut byte).expect("a byte");
    file.seek(SeekFrom::Start(at)).expect("a place");
    file.write_all(&[byte[0] ^ 1]).expect("a byte");
}

/// What follows from the designs is repaired; what was guessed would be is not.
#[test]
fn a_folder_is_repaired_where_nothing_is_guessed() {
    let folder = folder();
    let whole = short_run(&["--evaluations", "180"]);
    let run = copy(&whole, &folder.join("run"));
    let again = || {
        fs::remove_dir_all(&run).expect("a folder");
        copy(&whole, &run)
    };
    let remove = |path: &Path| fs::remove_file(path).expect("a file");
    let shorten = |path: &Path| {
        let file = File::options().write(true).open(path).expect("a file");
        file.set_len(2000).expect("a shorter file");
    };
    let write = |from: &str, to: &str| {
        let text = folder.read("run/run.json");
        folder.write("run/run.json", text.replace(from, to));
    };
    type Damage<'a> = &'a dyn Fn(&Path);
    let damages: [(&str, Damage<'_>); 6] = [
        ("front.csv", &|path| flip(path, 0.5)),
        ("front.csv", &remove),
        ("recording.rrd", &remove),
        ("recording.rrd", &shorten),
        ("run.json", &|_| write("\"feasible\": ", "\"feasible\": 1")),
        ("run.json", &|_| write("\"front_verified\": ", "\"front_verified\": 9")),
    ];
    for (file, damage) in damages {
        damage(&again().join(file));
        let told = check(&run).code(2);
        told.stdout(contains(file).and(contains("can be repaired")));
        repair(&run).success().stdout(contains("repaired"));
        assert!(tables(&run) == tables(&whole), "{file}");
        assert_eq!(report(&run), report(&whole), "{file}");
    }
    flip(&again().join("designs.csv"), 0.5);
    repair(&run).code(2);
    check(folder.path()).code(2).stderr(says("holds no run"));
}

/// Input of any size is refused in a moment and with little memory.
#[test]
fn input_beyond_measure_is_refused() {
    let folder = folder();
    let refuse = |name: &str, text: &str, words: &str| {
        folder.write(name, text);
        let told = folder.run(&format!("study check {name}")).code(2);
        let said = said(&told);
        assert!(said.len() < 4000, "{name}: {} bytes were said", said.len());
        told.stderr(says(words));
    };
    let long = "x".repeat(10_000_000);
    refuse("key.toml", &format!("{long} = 1"), "a study has about 5000");
    refuse("brackets.toml", &"[".repeat(10_000_000), "a study has about 5000");
    refuse("some.toml", &"[".repeat(200_000), "have at most 4096");
    refuse(
        "brackets-in-lines.toml",
        &"[[[[[[[[\n".repeat(20_000),
        "brackets-in-lines.toml:1",
    );
    refuse("short.toml", &format!("{} = 1", &long[..100_000]), "has 100004 bytes");
    refuse(
        "grid.toml",
        "[grid.fine]\nphi_step_deg = 0.01\ndirections = 3600\nray_steps = 10000\nhalvings = 12",
        "36000 orientations × 3600 directions × 10000 ray steps exceed 1000000000 poses",
    );
    refuse(
        "threshold.toml",
        "[requirements]\nk_z_min_n_per_m = 1e-308",
        "0, or from 1e-12 to 1e15",
    );
    refuse(
        "window.toml",
        "[workspace]\nrotation_range_deg = 21",
        "half of it, 10.5°, must be a whole multiple of grid.reference.phi_step_deg, 2.5°",
    );

    let lines = format!("{long}\n3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056\n{long}");
    let told = kinefront()
        .args(["evaluate", "--stdin"])
        .write_stdin(lines)
        .assert()
        .success();
    let answers = String::from_utf8_lossy(&told.get_output().stdout).into_owned();
    let answers: Vec<&str> = answers.lines().collect();
    assert_eq!(answers.len(), 3);
    assert!(answers[0].contains("longer than 65536 bytes") && answers[2].contains("longer than 65536 bytes"));
    assert!(answers[1].contains("\"mass_kg\":479.4"), "{}", answers[1]);
}

/// A recording with flipped bits, or cut anywhere, is read or refused; its decoder can do no harm.
#[test]
fn a_damaged_recording_does_no_harm() {
    let folder = folder();
    let run = copy(&short_run(&["--evaluations", "60"]), &folder.join("run"));
    let path = run.join("recording.rrd");
    let sound = fs::read(&path).expect("a recording");
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut refused = 0;
    let cases = repetitions(20, 60);
    for case in 0..cases {
        let mut damaged = sound.clone();
        let place = random.next_u64() as usize % if case % 2 == 0 { 20_000 } else { sound.len() };
        if case % 3 == 0 {
            damaged.truncate(place);
        } else {
            damaged[place] ^= 1 << (random.next_u32() % 8);
        }
        fs::write(&path, damaged).expect("a recording");
        let code = check(&run).get_output().status.code();
        assert!(matches!(code, Some(0 | 2)), "case {case}: {code:?}");
        refused += usize::from(code == Some(2));
    }
    assert!(refused > cases / 3, "{refused}");
    // Found by fuzzing: two kilobytes that ask their decoder for gigabytes.
    let hostile = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus/recording/asks-for-gigabytes");
    fs::copy(hostile, &path).expect("a recording");
    check(&run)
        .code(2)
        .stdout(contains("recording.rrd").and(contains("is not a recording of a run")));
}

/// Paths need not be UTF-8, and a study may come from a pipe.
#[cfg(target_os = "linux")]
#[test]
fn any_path_and_a_pipe_will_do() {
    use std::os::unix::ffi::OsStrExt;
    let folder = folder();
    let study = short_study(folder.path());
    let odd = folder.join(std::ffi::OsStr::from_bytes(b"run \xff"));
    optimize(&study, &odd, &["--evaluations", "60"]);
    let id = &read_rows(&odd.join("front.csv"))[0]["id"];
    let row = || {
        let mut row = odd.join("front.csv").into_os_string();
        row.push(format!("#{id}"));
        row
    };
    let mut command = kinefront();
    command.args(["evaluate", "--design", DESIGN, "--study"]);
    command.arg(odd.join("study.toml")).assert().success();
    let mut command = kinefront();
    command.arg("show").arg(row()).arg("--record");
    command.arg(odd.join("one.rrd")).assert().success();
    let mut command = kinefront();
    command.arg("export").arg(row());
    command.args(["--format", "json", "--out", "-"]).assert().success();
    check(&odd).success();
    let mut command = kinefront();
    command.args(["optimize", "/dev/stdin", "--evaluations", "60", "--quiet", "--out"]);
    let piped = command.arg(folder.join("piped")).write_stdin(folder.read("small.toml"));
    piped.assert().success();
    assert!(tables(&folder.join("piped")) == tables(&odd));
}

/// What a process that was killed leaves behind blocks nothing.
#[test]
fn remains_block_nothing() {
    let folder = folder();
    let study = short_study(folder.path());
    // A start that was killed after the first lines of its table.
    let run = folder.join("run");
    fs::create_dir(&run).expect("a folder");
    for header in ["", "id,generation,arch"] {
        folder.write("run/designs.csv", header);
        let told = folder.run("report run").code(2);
        told.stderr(says("holds no run"));
        resume(&run, &[]).code(2).stderr(says("holds no run"));
    }
    optimize(&study, &run, &["--evaluations", "60"]);
    check(&run).success();
    // A table of someone else is no remains.
    fs::create_dir(folder.join("other")).expect("a folder");
    let table = "id,generation\n0,1\n";
    folder.write("other/designs.csv", table);
    let told = folder.run("optimize small.toml --out other").code(2);
    told.stderr(says("designs.csv"));
    assert_eq!(folder.read("other/designs.csv"), table);
}
