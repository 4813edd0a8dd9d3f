//! Reports: self-contained pages that load nothing and show the numbers of the run.

use std::fs;
use std::path::{Path, PathBuf};

use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;

use super::support::{
    Folder, copy, folder, kinefront, optimize, read_rows, says, short_run, small_run, small_study, value,
};

/// Returns the values of all attributes `name="…"` of a page.
fn attributes<'a>(page: &'a str, name: &str) -> Vec<&'a str> {
    let key = format!(" {name}=\"");
    page.match_indices(&key)
        .map(|(at, _)| {
            let value = &page[at + key.len()..];
            &value[..value.find('"').expect("a closing quote")]
        })
        .collect()
}

fn report(runs: &[&Path], out: &Path, more: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = kinefront();
    command.arg("report").args(runs).arg("--out").arg(out);
    command.args(["--quiet", "--picture-width", "200", "--scale", "0.5"]);
    command.args(more).assert()
}

/// Returns the page of a report, or another of its texts.
fn read(report: &Path, name: &str) -> String {
    fs::read_to_string(report.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn a_page_holds_everything_and_loads_nothing() {
    let folder = folder();
    let (run, out) = (small_run(), folder.join("page"));
    report(&[&run], &out, &["--sensitivity", "60"]).success().stdout("");
    let page = read(&out, "index.html");
    loads_nothing(&page);

    // Three charts of all architectures; for each of the three architectures a front, two charts of variables, and
    // charts of active constraints, clearance and sensitivity, and two of prices.
    let names = |name: &str, extension: &str| -> Vec<String> {
        let entries = fs::read_dir(out.join(name)).expect("a folder");
        let files = entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
        let mut found: Vec<String> = files
            .filter_map(|file| file.strip_suffix(extension).map(str::to_owned))
            .collect();
        found.sort();
        found
    };
    let figures = names("figures", ".svg");
    assert_eq!(figures, names("figures", ".png"));
    assert_eq!(figures.len(), 3 + 3 + 3 * 2 + 3 + 3 + 3 + 3 * 2);
    for figure in &figures {
        let is_shown = page.contains(&format!("id=\"figure-{figure}\""));
        assert!(is_shown, "{figure} is not in the page");
    }
    let pictures = names("pictures", ".png");
    assert_eq!(attributes(&page, "src").len(), pictures.len());
    assert!(pictures.contains(&"3-prr-knee".to_owned()), "{pictures:?}");
    has_the_numbers_of_the_run(&run, &out, &page);
    assert!(page.contains("kinefront report run --sensitivity 60"));
    assert!(page.contains("3 other random seeds") && page.contains("K_act × 10"));
    // The page does not reveal the path of the folder.
    let paths: [&Path; 2] = [folder.path(), &run];
    for path in paths {
        assert!(!page.contains(&path.display().to_string()));
    }
}

/// Checks that nothing is fetched: pictures are embedded, links stay within the page, and there is no script.
fn loads_nothing(page: &str) {
    for source in attributes(page, "src") {
        let begin = &source[..40.min(source.len())];
        assert!(source.starts_with("data:image/png;base64,iVBOR"), "{begin}");
    }
    let anchors = attributes(page, "id");
    for link in attributes(page, "href") {
        let target = link.strip_prefix('#').unwrap_or_else(|| panic!("{link} leads outside"));
        assert!(anchors.contains(&target), "{link} leads nowhere");
    }
    for word in ["<script", "<link", "<iframe", "@import", "url(", "<base"] {
        assert!(!page.contains(word), "{word}");
    }
}

/// Checks that every design of `fronts.csv` was evaluated by the run, or reported by it, or is one with thicker bars; and that the page
/// shows the masses of the lightest and the heaviest design of each architecture.
fn has_the_numbers_of_the_run(run: &Path, out: &Path, page: &str) {
    let shown = read_rows(&out.join("fronts.csv"));
    let designs = [read_rows(&run.join("designs.csv")), read_rows(&run.join("front.csv"))].concat();
    assert!(shown.len() > 20);
    for row in &shown {
        let is_same = designs.iter().any(|other| {
            let growth = ["rj", "rp"].map(|bar| value(row, bar) / value(other, bar) - 1.0);
            let others = ["architecture", "working_mode", "R", "r", "Lb"];
            others.into_iter().all(|column| row[column] == other[column])
                && (0.0..1.001e-3).contains(&growth[0])
                && (growth[0] - growth[1]).abs() < 1e-12
        });
        assert!(is_same, "{row:?}");
    }
    for architecture in ["3-PRR", "3-RPR", "3-RRR"] {
        let of_architecture = shown.iter().filter(|row| row["architecture"] == architecture);
        let masses: Vec<f64> = of_architecture.map(|row| value(row, "mass_kg")).collect();
        let ends = [f64::min as fn(f64, f64) -> f64, f64::max].map(|pick| masses.iter().copied().reduce(pick));
        for mass in ends.into_iter().flatten() {
            let text = kinefront_scene::text::number(mass);
            let is_shown = page.contains(&format!("mass <b>{text}</b> kg"));
            assert!(is_shown, "{architecture}: no {text} kg");
        }
    }
}

/// The command says where the page is, unless it is told to be quiet.
#[test]
fn the_place_of_a_page_is_told() {
    let folder = folder();
    copy(&short_run(&["--evaluations", "60"]), &folder.join("run"));
    let line = "report run --out page --picture-width 160 --scale 0.5 --sensitivity 0";
    let told = folder.run(line).success();
    told.stdout(contains(Path::new("page").join("index.html").display().to_string()));
}

/// Searches a study in a folder and returns the run.
fn search(folder: &Folder, study: &str, name: &str, more: &str) -> PathBuf {
    let line = format!("optimize {study} --out {name} {more} --no-recording --quiet");
    folder.run(&line).success();
    folder.join(name)
}

/// Runs whose studies state the same problem make one report.
#[test]
fn runs_are_put_together_where_they_ask_for_the_same() {
    let folder = folder();
    small_study(folder.path());
    // Fronts of few designs have none near most radii.
    let first = search(&folder, "small.toml", "first", "--architectures 3-PRR --front 40");
    let other = "--architectures 3-RPR --algorithm nsga2 --seed 9 --front 40";
    let second = search(&folder, "small.toml", "second", other);
    let out = folder.join("both");
    report(&[&first, &second], &out, &["--sensitivity", "0"]).success();
    let page = read(&out, "index.html");
    assert!(page.contains("Pareto front of the 3-PRR.") && page.contains("Pareto front of the 3-RPR."));
    assert!(!page.contains("Pareto front of the 3-RRR.") && !page.contains("Repeated searches"));

    let text = folder.read("small.toml");
    folder.write("softer.toml", format!("{text}[material]\nyoungs_modulus_pa = 70e9\n"));
    let more = "--evaluations 60 --architectures 3-PRR --front 40";
    let third = search(&folder, "softer.toml", "third", more);
    stand_side_by_side(&folder, [&first, &third]);

    // Of other objectives there is nothing to compare.
    let objectives = "objectives = [{ minimize = \"mass_kg\" }, { maximize = \"k_xy_n_per_m\" }]";
    let region = "[workspace.region]\nkind = \"disc\"\nradius_m = 0.3\n";
    folder.write("other.toml", format!("{objectives}\n{text}{region}"));
    let fourth = search(&folder, "other.toml", "fourth", "--evaluations 60");
    let told = report(&[&first, &fourth], &folder.join("not"), &[]).code(2);
    let combined = says("first and fourth cannot be combined in one report");
    told.stderr(combined.and(says("objectives")));
    assert!(!folder.join("not").exists());
}

/// Checks the page on two runs of which the second one has softer bars.
fn stand_side_by_side(folder: &Folder, runs: [&Path; 2]) {
    let beside = folder.join("beside");
    report(&runs, &beside, &["--sensitivity", "0"]).success();
    let page = read(&beside, "index.html");
    assert!(page.contains("Kinefront comparison: first, third"));
    assert!(page.contains("The mass in motion of third differs from that of first by "));
    assert!(page.contains("material.youngs_modulus_pa") && page.contains("70000000000"));
    assert!(!page.contains("optimizer.evaluations"));
    // Softer bars are heavier at every radius that both reach: no change is below zero.
    let levels = page.split("id=\"levels\"").nth(1).expect("the table");
    let levels = levels.split("</table>").next().expect("the table");
    assert!(
        levels.matches(" %</td>").count() > 3 && !levels.contains('−'),
        "{levels}"
    );
    assert!(beside.join("figures/fronts.svg").exists() && beside.join("figures/fronts-log.png").exists());
}

/// Architectures of other variables: each run has the bounds of its own alone, and the page those of all.
#[test]
fn runs_of_architectures_with_other_variables_are_put_together() {
    let folder = folder();
    let bounds = "[bounds]\nLa_m = [0.5, 4.0]\nalpha_deg = [-30.0, 30.0]\n";
    folder.write("wide.toml", kinefront_testkit::small_study(90) + bounds);
    let architectures = ["3-PRR", "3-RRR", "3-RPR"];
    let runs = architectures.map(|name| search(&folder, "wide.toml", name, &format!("--architectures {name}")));
    let written = folder.read("3-RRR/study.toml");
    assert!(written.contains("La_m") && !written.contains("alpha_deg"), "{written}");
    let all = folder.join("all");
    report(&[&runs[0], &runs[1], &runs[2]], &all, &[]).success();
    let page = read(&all, "index.html");
    for architecture in architectures {
        let is_shown = page.contains(&format!("Pareto front of the {architecture}."));
        assert!(is_shown, "{architecture}");
    }
}

/// The paper's study on small grids: its claims are judged if they can be, and not if an architecture is missing.
#[test]
fn the_papers_study_is_compared_with_the_paper() {
    let folder = folder();
    let paper = kinefront_study::BUILTIN[0].text;
    let references = &paper[paper.find("[[references]]").expect("references")..];
    let text = kinefront_testkit::small_study(240) + references;
    folder.write("small.toml", &text);
    let page = |name: &str, architectures: &str| {
        let more = format!("--architectures {architectures}");
        let run = search(&folder, "small.toml", name, &more);
        let out = folder.join(format!("{name}-page"));
        report(&[&run], &out, &["--sensitivity", "0"]).success();
        assert!(out.join("pictures/reference-1-id-i.png").exists());
        read(&out, "index.html")
    };
    let all = page("all", "3-PRR,3-RPR,3-RRR");
    for words in [
        "Differences from the paper and their causes",
        "The model, requirements and bounds of this run are those of the paper.",
        "The 3-PRR is better than the 3-RRR.",
        "of those of the single search over all architectures",
        "The cause of the difference is not known, and no constant of the model was adjusted to remove it.",
        "484.8",
        "41.78 … 45.25",
    ] {
        assert!(all.contains(words), "{words}");
    }
    assert!(!all.contains("Tab. 2") && !all.contains("inf to") && !all.contains("not compared"));
    let one = page("one", "3-RPR");
    assert!(one.contains("not compared: not all architectures were searched"));
    assert!(one.contains("not compared: at no radius do this architecture and the 3-PRR both have a design"));
    assert!(!one.contains("inf to"));

    // With another material the study is not the paper's, so the page does not compare with the paper.
    folder.write("small.toml", text + "[material]\nyoungs_modulus_pa = 70e9\n");
    let other = page("other", "3-PRR");
    assert!(other.contains("Reference designs") && !other.contains("Differences from the paper"));
    assert!(!other.contains("mass range for the rounded bar radii"));
}

#[test]
fn reports_say_what_is_wrong_and_replace_nothing_unasked() {
    let folder = folder();
    let out = folder.join("page");
    let told = report(&[folder.path()], &out, &[]).code(2);
    told.stderr(says("holds no run"));
    report(&[], &out, &[]).code(2).stderr(says("<RUN>"));

    let run = copy(&short_run(&["--evaluations", "60"]), &folder.join("run"));
    fs::create_dir(&out).expect("a folder");
    folder.write("page/index.html", "mine");
    let told = report(&[&run], &out, &["--sensitivity", "0"]).code(2);
    told.stderr(says("already holds a report").and(says("--replace")));
    assert_eq!(folder.read("page/index.html"), "mine");
    report(&[&run], &out, &["--sensitivity", "0", "--replace"]).success();
    assert!(folder.read("page/index.html").len() > 10_000);

    // The message on an invalid table names the file and the line.
    let text = folder.read("run/designs.csv");
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    lines[3] = lines[3].replacen("3-", "4-", 1);
    folder.write("run/designs.csv", lines.join("\n"));
    let told = report(&[&run], &folder.join("other"), &[]).code(2);
    told.stderr(says("designs.csv").and(says("line 4")));
}

/// A report follows the question of the study: one objective for a rectangle, and two other objectives.
#[test]
fn a_report_answers_the_question_of_its_study() {
    let folder = folder();
    let of_question = |name: &str, question: &str| {
        let text = question.to_owned() + &kinefront_testkit::small_study(300);
        let study = folder.write("small.toml", text);
        let run = folder.join(name);
        let told = optimize(&study, &run, &["--no-recording"]);
        assert!(told["front_size"].as_u64() > Some(0), "{told}");
        let out = folder.join(format!("{name}-page"));
        report(&[&run], &out, &[]).success();
        let (page, table) = (read(&out, "index.html"), read(&out, "fronts.csv"));
        (run, out, page, table)
    };
    let (run, out, page, table) = of_question(
        "lightest",
        "objectives = [{ minimize = \"mass_kg\" }]\nquantities = [\"transmission_min\"]\n\
         workspace.region = { kind = \"rectangle\", width_m = 0.6, height_m = 0.4 }\n",
    );
    assert!(out.join("figures/front-progress.svg").exists());
    assert!(
        page.contains("as small as possible")
            && page.contains("(-0.3, -0.2)")
            && page.contains("smallest transmission")
    );
    assert!(
        !page.contains("largest workspace"),
        "the page speaks of another question"
    );
    // One design of each architecture that has a feasible one, each with its picture.
    let designs = table.lines().count() - 1;
    assert!((1..=3).contains(&designs), "{table}");
    let pictures = fs::read_dir(out.join("pictures")).expect("a folder").count();
    assert_eq!(pictures, designs);
    report(&[&run], &folder.join("refused"), &["--sensitivity", "100"])
        .code(2)
        .stderr(says("Leave out --sensitivity"));

    let (_, out, page, _) = of_question(
        "stiff",
        "architectures = [\"3-PRR\"]\nobjectives = [{ minimize = \"mass_kg\" }, { maximize = \"k_xy_n_per_m\" }]\n\
         workspace.region = { kind = \"disc\", radius_m = 0.3 }\nconstraints.footprint_m = { at_most = 4.0 }\n",
    );
    for figure in ["fronts", "front-3-prr", "lengths-3-prr", "bars-3-prr"] {
        assert!(out.join(format!("figures/{figure}.png")).exists(), "{figure}");
    }
    assert!(page.contains("as large as possible") && page.contains("at most 4 m") && page.contains("hypervolume"));
}
