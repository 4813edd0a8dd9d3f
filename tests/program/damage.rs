//! Damaged files and bad input: what is wrong is named, and nothing is taken for something else.

use std::fs::{self, File};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::support::{DESIGN, check, folder, kinefront, optimize, repetitions, report, resume, short_study, tables};

/// The line that ends a table decides: only a last row without its end of line is forgiven, and that is said.
#[test]
fn damage_is_never_read_as_less_data() {
    let folder = folder();
    let study = short_study(folder.path());
    let run = folder.path().join("run");
    optimize(&study, &run, &["--evaluations", "120"]);
    let table = run.join("designs.csv");
    let text = fs::read_to_string(&table).expect("a table");
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
        let page = folder.path().join("page");
        kinefront()
            .arg("report")
            .arg(&run)
            .arg("--out")
            .arg(&page)
            .args(["--quiet", "--sensitivity", "0"])
            .assert()
            .code(2)
            .stderr(contains(place));
        check(&run).code(2).stdout(contains("designs.csv"));
    }
    fs::write(&table, &text).expect("a table");
    check(&run).success();

    // Cut at any line, the study of the run is not taken for another study.
    let (study, front) = (run.join("study.toml"), run.join("front.csv"));
    let text = fs::read_to_string(&study).expect("a study");
    let id = fs::read_to_string(&front)
        .expect("a front")
        .lines()
        .nth(1)
        .expect("a design")
        .split(',')
        .next()
        .expect("an id")
        .to_owned();
    for cut in 0..text.lines().count() {
        let part: Vec<&str> = text.lines().take(cut).collect();
        fs::write(&study, part.join("\n")).expect("a study");
        kinefront()
            .arg("export")
            .arg(format!("{}#{id}", front.display()))
            .args(["--format", "json", "--out", "-"])
            .assert()
            .code(2)
            .stderr(contains("study.toml").and(contains("not the file of the run")));
    }
    fs::write(&study, &text).expect("a study");
}

/// The table of a small run, cut at every byte (by day, at every third one): the run resumes or is refused, and is never another one.
#[test]
fn a_table_cut_at_every_byte_resumes() {
    use kinefront_study::{ResumeOptions, Resumption};
    let folder = folder();
    let study = folder.path().join("tiny.toml");
    let text = "name = \"tiny\"\narchitectures = [\"3-PRR\"]\n\
                [grid.reference]\nphi_step_deg = 10\ndirections = 3\nray_steps = 4\nhalvings = 1\n\
                [grid.fine]\nphi_step_deg = 10\ndirections = 6\nray_steps = 4\nhalvings = 1\n\
                [optimizer]\nevaluations = 12\nthreads = 1\nfront_designs = 4\nalgorithm = \"nsga2\"\n[optimizer.nsga2]\npopulation = 4\n";
    fs::write(&study, text).expect("a study");
    let (whole, run) = (folder.path().join("whole"), folder.path().join("run"));
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
    let study = short_study(folder.path());
    let run = folder.path().join("run");
    optimize(&study, &run, &["--evaluations", "300"]);
    // Without the report, checksums are unknown, and only the rows themselves can tell.
    let report = fs::read_to_string(run.join("run.json")).expect("a report");
    let unknown = || fs::remove_file(run.join("run.json")).expect("a report");
    let change = |file: &str, from: &str, to: &str| {
        let path = run.join(file);
        let text = fs::read_to_string(&path).expect("a file");
        assert!(text.contains(from), "{from}");
        fs::write(&path, text.replacen(from, to, 1)).expect("a file");
    };
    let more = ["--evaluations", "400", "--accept-unverified"];
    change("study.toml", "seed = 5", "seed = 6");
    resume(&run, &more)
        .code(2)
        .stderr(contains("study.toml").and(contains("checksum")));
    unknown();
    resume(&run, &more)
        .code(2)
        .stderr(contains("design #0 does not follow"));
    change("study.toml", "seed = 6", "seed = 5");
    change("study.toml", "density_kg_per_m3 = 7850.0", "density_kg_per_m3 = 2700.0");
    resume(&run, &more).code(2).stderr(contains("mass_kg"));
    change("study.toml", "density_kg_per_m3 = 2700.0", "density_kg_per_m3 = 7850.0");
    fs::write(
        run.join("run.json"),
        report.replace("\"kinefront_version\": \"", "\"kinefront_version\": \"9"),
    )
    .expect("a report");
    resume(&run, &more).code(2).stderr(contains("written by Kinefront 9"));
    fs::write(run.join("run.json"), &report[..report.len() / 2]).expect("a report");
    resume(&run, &more)
        .code(2)
        .stderr(contains("run.json").and(contains("damaged")));
    // JSON that lacks a key is as damaged as what is not JSON: the checksums would be lost with it.
    fs::write(run.join("run.json"), report.replace("\"outcome\"", "\"outcomf\"")).expect("a report");
    resume(&run, &more)
        .code(2)
        .stderr(contains("run.json").and(contains("outcome")));
    check(&run).code(2);
    // More rows than the study allows.
    unknown();
    change("study.toml", "evaluations = 300", "evaluations = 200");
    resume(&run, &["--accept-unverified"])
        .code(2)
        .stderr(contains("300 designs").and(contains("200 evaluations")));
    check(&run).code(2);
    change("study.toml", "evaluations = 200", "evaluations = 300");
    fs::write(run.join("run.json"), &report).expect("a report");
    resume(&run, &more).success();
}

/// What follows from the designs is repaired; what was guessed would be is not.
#[test]
fn a_folder_is_repaired_where_nothing_is_guessed() {
    let folder = folder();
    let study = short_study(folder.path());
    let [whole, run] = ["whole", "run"].map(|name| folder.path().join(name));
    optimize(&study, &whole, &["--evaluations", "180"]);
    let copy = |to: &Path| {
        let _ = fs::remove_dir_all(to);
        fs::create_dir(to).expect("a folder");
        for entry in fs::read_dir(&whole).expect("a folder") {
            let path = entry.expect("an entry").path();
            fs::copy(&path, to.join(path.file_name().expect("a name"))).expect("a file");
        }
    };
    let flip = |path: PathBuf, place: f64| {
        let mut file = File::options().read(true).write(true).open(&path).expect("a file");
        let at = (place * file.metadata().expect("a size").len() as f64) as u64;
        let mut byte = [0];
        file.seek(SeekFrom::Start(at)).expect("a place");
        file.read_exact(&mut byte).expect("a byte");
        file.seek(SeekFrom::Start(at)).expect("a place");
        file.write_all(&[byte[0] ^ 1]).expect("a byte");
    };
    let damages: [(&str, &dyn Fn()); 6] = [
        ("front.csv", &|| flip(run.join("front.csv"), 0.5)),
        ("front.csv", &|| {
            fs::remove_file(run.join("front.csv")).expect("a front")
        }),
        ("recording.rrd", &|| {
            fs::remove_file(run.join("recording.rrd")).expect("a recording")
        }),
        ("recording.rrd", &|| {
            let file = File::options()
                .write(true)
                .open(run.join("recording.rrd"))
                .expect("a recording");
            file.set_len(2000).expect("a shorter recording");
        }),
        ("run.json", &|| {
            let text = fs::read_to_string(run.join("run.json")).expect("a report");
            fs::write(run.join("run.json"), text.replace("\"feasible\": ", "\"feasible\": 1")).expect("a report");
        }),
        ("run.json", &|| {
            let text = fs::read_to_string(run.join("run.json")).expect("a report");
            fs::write(
                run.join("run.json"),
                text.replace("\"front_verified\": ", "\"front_verified\": 9"),
            )
            .expect("a report");
        }),
    ];
    for (file, damage) in damages {
        copy(&run);
        damage();
        check(&run)
            .code(2)
            .stdout(contains(file).and(contains("can be repaired")));
        kinefront()
            .arg("check")
            .arg(&run)
            .arg("--repair")
            .assert()
            .success()
            .stdout(contains("repaired"));
        assert!(tables(&run) == tables(&whole), "{file}");
        assert_eq!(report(&run), report(&whole), "{file}");
    }
    copy(&run);
    flip(run.join("designs.csv"), 0.5);
    kinefront().arg("check").arg(&run).arg("--repair").assert().code(2);
    check(folder.path()).code(2).stderr(contains("holds no run"));
}

/// Input of any size is refused in a moment and with little memory.
#[test]
fn input_beyond_measure_is_refused() {
    let folder = folder();
    let refuse = |name: &str, text: &str, words: &str| {
        let study = folder.path().join(name);
        fs::write(&study, text).expect("a study");
        let told = kinefront().args(["study", "check"]).arg(&study).assert().code(2);
        let said = String::from_utf8_lossy(&told.get_output().stderr).into_owned();
        assert!(said.len() < 4000, "{name}: {} bytes were said", said.len());
        // Long lines are broken, with a margin.
        let joined: String = said
            .split_whitespace()
            .filter(|word| *word != "│")
            .collect::<Vec<_>>()
            .join(" ");
        assert!(joined.contains(words), "{name}: {said}");
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
    let study = short_study(folder.path());
    let run = folder.path().join("run");
    optimize(&study, &run, &["--evaluations", "60"]);
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
    let odd = folder.path().join(std::ffi::OsStr::from_bytes(b"run \xff"));
    optimize(&study, &odd, &["--evaluations", "60"]);
    let front = fs::read_to_string(odd.join("front.csv")).expect("a front");
    let id = front
        .lines()
        .nth(1)
        .and_then(|line| line.split(',').next())
        .expect("an id");
    let row = || {
        let mut row = odd.join("front.csv").into_os_string();
        row.push(format!("#{id}"));
        row
    };
    kinefront()
        .arg("evaluate")
        .args(["--design", DESIGN, "--study"])
        .arg(odd.join("study.toml"))
        .assert()
        .success();
    kinefront()
        .arg("show")
        .arg(row())
        .arg("--record")
        .arg(odd.join("one.rrd"))
        .assert()
        .success();
    kinefront()
        .arg("export")
        .arg(row())
        .args(["--format", "json", "--out", "-"])
        .assert()
        .success();
    check(&odd).success();
    let text = fs::read(&study).expect("a study");
    kinefront()
        .args(["optimize", "/dev/stdin", "--evaluations", "60", "--quiet", "--out"])
        .arg(folder.path().join("piped"))
        .write_stdin(text)
        .assert()
        .success();
    assert!(tables(&folder.path().join("piped")) == tables(&odd));
}

/// What a process that was killed leaves behind blocks nothing.
#[test]
fn remains_block_nothing() {
    let folder = folder();
    let study = short_study(folder.path());
    // A start that was killed after the first lines of its table.
    let run = folder.path().join("run");
    fs::create_dir(&run).expect("a folder");
    for header in ["", "id,generation,arch"] {
        fs::write(run.join("designs.csv"), header).expect("a table");
        kinefront()
            .arg("report")
            .arg(&run)
            .assert()
            .code(2)
            .stderr(contains("holds no run"));
        resume(&run, &[]).code(2).stderr(contains("holds no run"));
    }
    optimize(&study, &run, &["--evaluations", "60"]);
    check(&run).success();
    // A table of someone else is no remains.
    let other = folder.path().join("other");
    fs::create_dir(&other).expect("a folder");
    fs::write(other.join("designs.csv"), "id,generation\n0,1\n").expect("a table");
    kinefront()
        .arg("optimize")
        .arg(&study)
        .arg("--out")
        .arg(&other)
        .assert()
        .code(2)
        .stderr(contains("designs.csv"));
    assert_eq!(
        fs::read_to_string(other.join("designs.csv")).expect("a table"),
        "id,generation\n0,1\n"
    );
}
