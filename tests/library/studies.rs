//! Tests of study files: the built-in studies, reading and writing, and how invalid files are rejected.

use kinefront::study::{BUILTIN, Builtin, Study, StudyError};
use kinefront_model::evaluation::Model;
use kinefront_model::stiffness::StiffnessDefinition;
use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme};

fn error(text: &str) -> StudyError {
    Study::parse(text, "mine.toml").expect_err("a fault")
}

fn printed(text: &str) -> String {
    let mut out = String::new();
    GraphicalReportHandler::new_themed(GraphicalTheme::none())
        .render_report(&mut out, &error(text) as &dyn Diagnostic)
        .expect("a report");
    out
}

#[test]
fn the_studies_that_come_with_the_program_are_sound() {
    for builtin in BUILTIN {
        let study = builtin
            .study()
            .unwrap_or_else(|error| panic!("{}: {error}", builtin.name));
        assert_eq!(study.name, builtin.name);
        assert!(!study.description.is_empty());
    }
}

/// The file of the paper's study states the defaults of the program, so that omitting a key changes nothing.
#[test]
fn the_paper_is_the_default() {
    let paper = Builtin::find("paper")
        .expect("the paper")
        .study()
        .expect("a valid study");
    assert_eq!(paper.model(), Ok(Model::default()));
    let bare = Study::parse("name = \"paper\"", "bare").expect("a valid study");
    assert_eq!(
        Study {
            description: paper.description.clone(),
            references: paper.references.clone(),
            ..bare
        },
        paper
    );
    let printed = Builtin::find("paper-bounds-as-printed")
        .expect("a study")
        .study()
        .expect("a valid study");
    assert_eq!(printed.bounds.r_m, [0.5, 4.0]);
}

#[test]
fn a_study_reads_what_it_writes() {
    for builtin in BUILTIN {
        let study = builtin.study().expect("a valid study");
        let text = toml::to_string(&study).expect("TOML");
        assert_eq!(Study::parse(&text, "again").expect("a valid study"), study);
    }
}

/// Every assumption that the paper leaves open is a setting (docs/model.md, section 11).
#[test]
fn every_choice_reaches_the_model() {
    let text = r#"
        working_mode = "+-+"
        [actuators]
        prismatic_stiffness_n_per_m = 2e7
        [requirements]
        k_phi_z_min_nm_per_rad = 5729.6
        [workspace]
        centre_m = [0.1, 0]
        home_phi_deg = 45
        [model]
        stiffness_definition = "compliance"
        characteristic_length = "fixed"
        characteristic_length_m = 0.7
        platform_bars = 1
        telescopic_bar = "longest"
        telescopic_shortest = 0.0
        [grid.reference]
        phi_step_deg = 5
        directions = 24
        ray_steps = 25
        halvings = 8
    "#;
    let study = Study::parse(text, "choices").expect("a valid study");
    let model = study.model().expect("a valid study");
    let paper = Model::default();
    assert_eq!(study.working_mode.signs(), [1, -1, 1]);
    assert_eq!(model.actuators.prismatic, 2e7);
    assert_eq!(model.thresholds.k_phi_z, 5729.6);
    assert_eq!(model.workspace.home_phi_deg, Some(45.0));
    assert_eq!(model.stiffness_definition, StiffnessDefinition::Compliance);
    assert_eq!(model.platform_bars, 1);
    assert_eq!(model.reference_grid.directions(), 24);
    for changed in [
        model.legs != paper.legs,
        model.characteristic_length != paper.characteristic_length,
    ] {
        assert!(changed);
    }
}

#[test]
fn wrong_files_are_refused_with_file_line_and_key() {
    // Text of the study, and what the report must show.
    let cases: [(&str, &[&str]); 12] = [
        (
            "name = \"x\"\n[material]\ndensty = 1.0",
            &["mine.toml:3", "densty", "density_kg_per_m3"],
        ),
        (
            "[material]\ndensity_kg_per_m3 = \"steel\"",
            &["mine.toml:2", "material.density_kg_per_m3", "f64"],
        ),
        (
            "[material]\ndensity_kg_per_m3 = -7850.0",
            &["mine.toml:2", "material.density_kg_per_m3", "-7850", "above 0"],
        ),
        ("[material]\ndensity_kg_per_m3 = nan", &["mine.toml:2", "NaN"]),
        (
            "[bounds]\nR_m = [4.0, 0.5]",
            &["mine.toml:2", "bounds.R_m", "lower bound 4 above its upper bound 0.5"],
        ),
        ("[bounds]\nr_m = [0.0, 0.5]", &["mine.toml:2", "bounds.r_m", "above 0"]),
        (
            "[optimizer]\nthreads = 0",
            &["mine.toml:2", "optimizer.threads", "1 to 1024"],
        ),
        (
            "[optimizer]\nalgorithm = \"moga\"",
            &["mine.toml:2", "optimizer.algorithm", "moga2", "nsga2"],
        ),
        (
            "architectures = [\"3-PPP\"]",
            &["mine.toml:1", "3-PPP", "3-PRR, 3-RPR, 3-RRR"],
        ),
        ("working_mode = \"++\"", &["mine.toml:1", "three signs"]),
        (
            "[grid.fine]\nphi_step_deg = 7\ndirections = 36\nray_steps = 50\nhalvings = 12",
            &["mine.toml:2", "grid.fine.phi_step_deg", "whole steps"],
        ),
        ("name = \"x\"\nbroken", &["mine.toml:2", "expected"]),
    ];
    for (text, wanted) in cases {
        let report = printed(text);
        for part in wanted {
            assert!(
                report.contains(part),
                "`{part}` is missing for:\n{text}\nreport:\n{report}"
            );
        }
    }
}

#[test]
fn all_faults_are_told_at_once() {
    let StudyError::Values { faults, .. } =
        error("[material]\ndensity_kg_per_m3 = 0\n[bounds]\nR_m = [2, 1]\nrj_m = [-1, 1]")
    else {
        panic!("the error is not about values");
    };
    let keys: Vec<&str> = faults.iter().map(|fault| fault.key.as_str()).collect();
    assert_eq!(keys, ["material.density_kg_per_m3", "bounds.R_m", "bounds.rj_m"]);
}
