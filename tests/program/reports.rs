//! Reports: self-contained pages that load nothing and show the numbers of the run.

use std::path::Path;

use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;

use super::support::{folder, kinefront, optimize, small_study};

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
    kinefront()
        .arg("report")
        .args(runs)
        .arg("--out")
        .arg(out)
        .args(["--quiet", "--picture-width", "200", "--scale", "0.5"])
        .args(more)
        .assert()
}

#[test]
fn a_page_holds_everything_and_loads_nothing() {
    let folder = folder();
    let (run, out) = (folder.path().join("run"), folder.path().join("page"));
    optimize(&small_study(folder.path()), &run, &[]);
    report(&[&run], &out, &["--sensitivity", "60"]).success().stdout("");
    let again = folder.path().join("again");
    kinefront()
        .arg("report")
        .arg(&run)
        .arg("--out")
        .arg(&again)
        .args(["--picture-width", "160", "--scale", "0.5", "--sensitivity", "0"])
        .assert()
        .success()
        .stdout(contains(again.join("index.html").display().to_string()));
    let page = std::fs::read_to_string(out.join("index.html")).expect("a page");

    // Nothing is fetched: pictures are embedded, links stay within the page, and there is no script.
    for source in attributes(&page, "src") {
        assert!(
            source.starts_with("data:image/png;base64,iVBOR"),
            "{}",
            &source[..40.min(source.len())]
        );
    }
    let anchors = attributes(&page, "id");
    for link in attributes(&page, "href") {
        let target = link.strip_prefix('#').unwrap_or_else(|| panic!("{link} leads outside"));
        assert!(anchors.contains(&target), "{link} leads nowhere");
    }
    for word in ["<script", "<link", "<iframe", "@import", "url(", "<base"] {
        assert!(!page.contains(word), "{word}");
    }

    // Three charts of all architectures; for each of the three architectures a front, two charts of variables, and
    // charts of active constraints, clearance and sensitivity, and two of prices.
    let names = |name: &str, extension: &str| -> Vec<String> {
        let mut found: Vec<String> = std::fs::read_dir(out.join(name))
            .expect("a folder")
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .filter_map(|file| file.strip_suffix(extension).map(str::to_owned))
            .collect();
        found.sort();
        found
    };
    let figures = names("figures", ".svg");
    assert_eq!(figures, names("figures", ".png"));
    assert_eq!(figures.len(), 3 + 3 + 3 * 2 + 3 + 3 + 3 + 3 * 2);
    for figure in &figures {
        assert!(
            page.contains(&format!("id=\"figure-{figure}\"")),
            "{figure} is not in the page"
        );
    }
    let pictures = names("pictures", ".png");
    assert_eq!(attributes(&page, "src").len(), pictures.len());
    assert!(pictures.contains(&"3-prr-knee".to_owned()), "{pictures:?}");

    // The numbers are those of the run: every design of `fronts.csv` was evaluated by the run, or reported by it, or is one
    // with thicker bars.
    let rows = |path: &Path| -> Vec<csv::StringRecord> {
        let mut reader = csv::Reader::from_path(path).expect("a table");
        reader.records().map(|record| record.expect("a row")).collect()
    };
    let shown = rows(&out.join("fronts.csv"));
    let designs = [rows(&run.join("designs.csv")), rows(&run.join("front.csv"))].concat();
    assert!(shown.len() > 20);
    for row in &shown {
        // Architecture, mode and lengths; the bars may be thicker by the same small factor.
        let bar = |row: &csv::StringRecord, column: usize| row[column].parse::<f64>().expect("a radius");
        let same = |other: &&csv::StringRecord| {
            let growth = [7, 8].map(|column| bar(row, column) / bar(other, column) - 1.0);
            (2..7).all(|column| row[column] == other[column])
                && (0.0..1.001e-3).contains(&growth[0])
                && (growth[0] - growth[1]).abs() < 1e-12
        };
        assert!(designs.iter().any(|other| same(&other)), "{row:?}");
    }
    // The page shows the masses of the lightest and the heaviest design of each architecture.
    for architecture in ["3-PRR", "3-RPR", "3-RRR"] {
        let masses: Vec<f64> = shown
            .iter()
            .filter(|row| &row[2] == architecture)
            .map(|row| row[9].parse().expect("a mass"))
            .collect();
        let ends = [f64::min as fn(f64, f64) -> f64, f64::max].map(|pick| masses.iter().copied().reduce(pick));
        for mass in ends.into_iter().flatten() {
            let text = kinefront_scene::text::number(mass);
            assert!(
                page.contains(&format!("mass <b>{text}</b> kg")),
                "{architecture}: no {text} kg"
            );
        }
    }
    assert!(page.contains("kinefront report run --sensitivity 60"));
    assert!(page.contains("3 other random seeds") && page.contains("K_act × 10"));
    // The page does not reveal the path of the folder.
    assert!(!page.contains(&folder.path().display().to_string()));
}

/// Runs whose studies state the same problem make one report; other runs are rejected.
#[test]
fn runs_are_put_together_where_they_ask_for_the_same() {
    let folder = folder();
    let study = small_study(folder.path());
    let run = |name: &str, more: &[&str]| {
        let path = folder.path().join(name);
        optimize(&study, &path, more);
        path
    };
    // Fronts of few designs have none near most radii.
    let first = run("first", &["--architectures", "3-PRR", "--front", "40"]);
    let second = run(
        "second",
        &[
            "--architectures",
            "3-RPR",
            "--algorithm",
            "nsga2",
            "--seed",
            "9",
            "--front",
            "40",
        ],
    );
    let out = folder.path().join("both");
    report(&[&first, &second], &out, &["--sensitivity", "0"]).success();
    let page = std::fs::read_to_string(out.join("index.html")).expect("a page");
    assert!(page.contains("Pareto front of the 3-PRR.") && page.contains("Pareto front of the 3-RPR."));
    assert!(!page.contains("Pareto front of the 3-RRR.") && !page.contains("Repeated searches"));

    let text = std::fs::read_to_string(&study).expect("a study");
    let softer = folder.path().join("softer.toml");
    std::fs::write(&softer, format!("{text}[material]\nyoungs_modulus_pa = 70e9\n")).expect("a study");
    let third = folder.path().join("third");
    optimize(
        &softer,
        &third,
        &["--evaluations", "60", "--architectures", "3-PRR", "--front", "40"],
    );
    let beside = folder.path().join("beside");
    report(&[&first, &third], &beside, &["--sensitivity", "0"]).success();
    let page = std::fs::read_to_string(beside.join("index.html")).expect("a page");
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

    // Architectures of other variables: each run has the bounds of its own alone, and the page those of all.
    let wide = folder.path().join("wide.toml");
    let bounds = "[bounds]\nLa_m = [0.5, 4.0]\nalpha_deg = [-30.0, 30.0]\n";
    std::fs::write(&wide, format!("{text}{bounds}")).expect("a study");
    let alone = ["3-PRR", "3-RRR", "3-RPR"].map(|architecture| {
        let path = folder.path().join(architecture);
        optimize(&wide, &path, &["--evaluations", "90", "--architectures", architecture]);
        path
    });
    let written = std::fs::read_to_string(alone[1].join("study.toml")).expect("a study");
    assert!(written.contains("La_m") && !written.contains("alpha_deg"), "{written}");
    let all = folder.path().join("all");
    report(&[&alone[0], &alone[1], &alone[2]], &all, &[]).success();
    let page = std::fs::read_to_string(all.join("index.html")).expect("a page");
    for architecture in ["3-PRR", "3-RPR", "3-RRR"] {
        assert!(
            page.contains(&format!("Pareto front of the {architecture}.")),
            "{architecture}"
        );
    }

    // Of other objectives there is nothing to compare.
    let other = folder.path().join("other.toml");
    let objectives = "objectives = [{ minimize = \"mass_kg\" }, { maximize = \"k_xy_n_per_m\" }]";
    let region = "[workspace.region]\nkind = \"disc\"\nradius_m = 0.3\n";
    std::fs::write(&other, format!("{objectives}\n{text}{region}")).expect("a study");
    let fourth = folder.path().join("fourth");
    optimize(&other, &fourth, &["--evaluations", "60"]);
    report(&[&first, &fourth], &folder.path().join("not"), &[])
        .code(2)
        .stderr(contains("first and fourth cannot be combined in one report").and(contains("objectives")));
    assert!(!folder.path().join("not").exists());
}

/// The paper's study on small grids: its claims are judged if they can be, and not if an architecture is missing.
#[test]
fn the_papers_study_is_compared_with_the_paper() {
    let folder = folder();
    let study = small_study(folder.path());
    let paper = kinefront_study::BUILTIN[0].text;
    let references = &paper[paper.find("[[references]]").expect("references")..];
    let text = std::fs::read_to_string(&study).expect("a study");
    std::fs::write(&study, format!("{text}{references}")).expect("a study");
    let page = |name: &str, architectures: &str| {
        let (run, out) = (folder.path().join(name), folder.path().join(format!("{name}-page")));
        optimize(
            &study,
            &run,
            &["--architectures", architectures, "--evaluations", "240"],
        );
        report(&[&run], &out, &["--sensitivity", "0"]).success();
        assert!(out.join("pictures/reference-1-id-i.png").exists());
        std::fs::read_to_string(out.join("index.html")).expect("a page")
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
    let text = std::fs::read_to_string(&study).expect("a study");
    std::fs::write(&study, format!("{text}[material]\nyoungs_modulus_pa = 70e9\n")).expect("a study");
    let other = page("other", "3-PRR");
    assert!(other.contains("Reference designs") && !other.contains("Differences from the paper"));
    assert!(!other.contains("mass range for the rounded bar radii"));
}

#[test]
fn reports_say_what_is_wrong_and_replace_nothing_unasked() {
    let folder = folder();
    let out = folder.path().join("page");
    report(&[folder.path()], &out, &[])
        .code(2)
        .stderr(contains("holds no run"));
    report(&[], &out, &[]).code(2).stderr(contains("<RUN>"));

    let run = folder.path().join("run");
    optimize(&small_study(folder.path()), &run, &["--evaluations", "60"]);
    std::fs::create_dir(&out).expect("a folder");
    std::fs::write(out.join("index.html"), "mine").expect("a page");
    report(&[&run], &out, &["--sensitivity", "0"])
        .code(2)
        .stderr(contains("already holds a report").and(contains("--replace")));
    assert_eq!(std::fs::read_to_string(out.join("index.html")).expect("a page"), "mine");
    report(&[&run], &out, &["--sensitivity", "0", "--replace"]).success();
    assert!(std::fs::metadata(out.join("index.html")).expect("a page").len() > 10_000);

    // The message on an invalid table names the file and the line.
    let designs = run.join("designs.csv");
    let text = std::fs::read_to_string(&designs).expect("a table");
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    lines[3] = lines[3].replacen("3-", "4-", 1);
    std::fs::write(&designs, lines.join("\n")).expect("a table");
    report(&[&run], &folder.path().join("other"), &[])
        .code(2)
        .stderr(contains("designs.csv").and(contains("line 4")));
}

/// A report follows the question of the study: one objective for a rectangle, and two other objectives.
#[test]
fn a_report_answers_the_question_of_its_study() {
    let folder = folder();
    let of_question = |name: &str, question: &str| {
        let study = small_study(folder.path());
        let mut text = std::fs::read_to_string(&study).expect("a study");
        text.insert_str(0, question);
        std::fs::write(&study, text).expect("a study");
        let run = folder.path().join(name);
        let told = optimize(&study, &run, &["--evaluations", "300"]);
        assert!(told["front_size"].as_u64() > Some(0), "{told}");
        let out = folder.path().join(format!("{name}-page"));
        report(&[&run], &out, &[]).success();
        let page = std::fs::read_to_string(out.join("index.html")).expect("a page");
        let table = std::fs::read_to_string(out.join("fronts.csv")).expect("a table");
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
    let pictures = std::fs::read_dir(out.join("pictures")).expect("a folder").count();
    assert_eq!(pictures, designs);
    report(&[&run], &folder.path().join("refused"), &["--sensitivity", "100"])
        .code(2)
        .stderr(contains("Leave out --sensitivity"));

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
