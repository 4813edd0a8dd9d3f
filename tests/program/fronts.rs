//! Reported fronts: without gaps, with the best designs at their ends, and with every family of designs.

use std::fs;
use std::path::{Path, PathBuf};

use super::support::{Folder, check, folder, front, optimize, question};

/// Searches a study without a recording and returns its run.
fn search(folder: &Folder, study: &Path, settings: &str) -> PathBuf {
    let run = folder.join("run");
    let settings: Vec<&str> = settings.split(' ').chain(["--no-recording"]).collect();
    optimize(study, &run, &settings);
    run
}

/// NSGA-II finds few designs with so few evaluations; those between them are optimised for the gaps.
#[test]
fn a_short_search_reports_a_front_without_gaps() {
    let folder = folder();
    let settings = "--algorithm nsga2 --evaluations 300 --seed 3";
    let out = search(&folder, Path::new("paper"), settings);
    let found = front(&out);
    let of_the_search = found.iter().filter(|entry| entry.id < 300).count();
    assert!(
        found.len() > 60 && of_the_search < 20,
        "{} and {of_the_search}",
        found.len()
    );
    let sizes: Vec<[f64; 2]> = found
        .iter()
        .map(|entry| [entry.row.mass(), entry.row.workspace_radius()])
        .collect();
    for pair in sizes.windows(2) {
        let [[lighter, smaller], [heavier, larger]] = [pair[0], pair[1]];
        if smaller > 0.3 && heavier < 1500.0 {
            assert!(heavier < 1.25 * lighter && larger < 1.15 * smaller, "{pair:?}");
        }
    }
    let proved = found
        .iter()
        .filter(|entry| entry.certified.is_some_and(|certified| certified.is_proved));
    assert_eq!(proved.count(), found.len());
    check(&out).success();
}

/// The lightest design of a front of two objectives is that of the question for the mass alone.
#[test]
fn the_ends_of_a_front_are_the_best_designs() {
    let both = fs::read_to_string(question("rectangle-stiffness")).expect("a study");
    let lightest = |text: &str| {
        let folder = folder();
        let study = folder.write("study.toml", format!("{text}\n[workspace]\ncertify = false\n"));
        let out = search(&folder, &study, "--evaluations 300 --front 8 --seed 5");
        front(&out)[0].row.mass()
    };
    let alone = both
        .replace(r#", { maximize = "k_xy_n_per_m" }"#, "")
        .replace("[hypervolume]\nreference = [120.0, 0.0]\n", "");
    assert_ne!(alone, both);
    let (of_both, of_mass) = (lightest(&both), lightest(&alone));
    assert!(of_both < 1.001 * of_mass, "{of_both} kg, and {of_mass} kg");
}

/// The 3-PRR with rails at any angle has two families of designs. This search settles on the one that is two to five times as heavy at small radii
/// and finds no design of the other.
#[test]
fn a_front_has_the_family_that_the_search_has_given_up() {
    let folder = folder();
    let settings = "--architectures 3-PRR --evaluations 800 --seed 3";
    let out = search(&folder, Path::new("all-planar-architectures"), settings);
    let found = front(&out);
    for (radius, mass) in [(0.5, 4.5), (0.9, 14.0), (1.3, 31.0)] {
        let large = found.iter().filter(|entry| entry.row.workspace_radius() >= radius);
        let lightest = large.map(|entry| entry.row.mass()).fold(f64::INFINITY, f64::min);
        assert!(lightest < mass, "{lightest} kg at {radius} m");
    }
}
