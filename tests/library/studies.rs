//! Tests of study files: the built-in studies, reading and writing, and how invalid files are rejected.

use kinefront::study::{
    BUILTIN, Builtin, Check, DesignProblem, Initial, Setting, Stagnation, Study, StudyError, settings,
};
use kinefront_model::evaluation::Model;
use kinefront_model::kinematics::CharacteristicLength;
use kinefront_model::mechanism::BarLength;
use kinefront_model::stiffness::StiffnessDefinition;
use kinefront_optimize::Variable;
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

/// Dotted keys of all values of a table; the reference designs are data, not settings.
fn keys(table: &toml::Table, path: &str, found: &mut Vec<String>) {
    for (key, value) in table {
        let path = if path.is_empty() {
            key.clone()
        } else {
            format!("{path}.{key}")
        };
        match value {
            toml::Value::Table(table) => keys(table, &path, found),
            _ if path == "references" => {}
            _ => found.push(path),
        }
    }
}

/// A study in which every setting has a value.
fn complete_study() -> Study {
    let mut study = Study::default();
    study.optimizer.stagnation = Some(Stagnation {
        evaluations: 2000,
        gain: 0.001,
    });
    let mut table = toml::Table::try_from(&study).expect("TOML");
    for setting in settings() {
        if let Some(initial) = setting.initial {
            insert(&mut table, setting, value_of(initial));
        }
    }
    insert_text(&mut table, "model", "characteristic_length", "fixed");
    table.try_into().expect("a study")
}

fn value_of(initial: Initial) -> toml::Value {
    match initial {
        Initial::Number(number) => number.into(),
        Initial::Count(count) => count.into(),
    }
}

fn insert(table: &mut toml::Table, setting: &Setting, value: toml::Value) {
    let sections = setting.section.split('.').filter(|part| !part.is_empty());
    let table = sections.fold(table, |table, section| {
        table[section].as_table_mut().expect("a section")
    });
    table.insert(setting.key.to_owned(), value);
}

fn insert_text(table: &mut toml::Table, section: &str, key: &str, text: &str) {
    let section = table[section].as_table_mut().expect("a section");
    section.insert(key.to_owned(), text.into());
}

#[test]
fn every_value_of_a_study_is_declared_once_and_stands_in_the_template() {
    let complete = complete_study();
    assert_eq!(complete.faults(), []);
    let mut found = Vec::new();
    keys(&toml::Table::try_from(&complete).expect("TOML"), "", &mut found);
    let mut declared: Vec<String> = settings().map(Setting::path).collect();
    found.sort();
    declared.sort();
    assert_eq!(found, declared);

    let template = BUILTIN[0].text;
    for setting in settings() {
        let stated = format!("{} = ", setting.key);
        assert!(template.contains(&stated), "{} is not in paper.toml", setting.path());
        let section = format!("[{}]", setting.section);
        assert!(setting.section.is_empty() || template.contains(&section), "{section}");
        assert!(setting.description.trim().ends_with('.'), "{}", setting.path());
    }
}

/// Another valid value.
fn other(setting: &Setting, value: &toml::Value) -> toml::Value {
    use toml::Value;
    match (setting.check, value) {
        (Check::Selection(_), _) => Value::Array(vec!["3-RPR".into()]),
        (Check::Choice(names), Value::String(name)) => {
            let index = names.iter().position(|known| known == name).expect("a known name");
            names[(index + 1) % names.len()].into()
        }
        (_, Value::Float(number)) => (if *number == 0.0 { 0.5 } else { 0.5 * number }).into(),
        (_, Value::Integer(number)) => (number / 2 + number % 2).into(),
        (_, Value::Array(items)) => {
            // A bound of 0 stays, so that the other bound stays above it.
            let zero = Value::Float(0.0);
            let all_zero = items.iter().all(|item| *item == zero);
            let change = |item: &Value| {
                if *item == zero && !all_zero {
                    zero.clone()
                } else {
                    other(setting, item)
                }
            };
            Value::Array(items.iter().map(change).collect())
        }
        (_, Value::String(_)) => "+-+".into(),
        (_, Value::Boolean(flag)) => Value::Boolean(!flag),
        _ => panic!("{}: {value}", setting.path()),
    }
}

/// The values of choices arrive in the model as they are written.
#[test]
fn every_choice_reaches_the_model() {
    let text = r#"
        working_mode = "+-+"
        architectures = ["3-RPR", "3-PRR"]
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
    let model = study.model().expect("a model");
    assert_eq!(model.actuators.prismatic, 2e7);
    assert_eq!(model.thresholds.k_phi_z, 5729.6);
    assert_eq!(model.workspace.centre.to_array(), [0.1, 0.0]);
    assert_eq!(model.workspace.home_phi_deg, Some(45.0));
    assert_eq!(model.stiffness_definition, StiffnessDefinition::Compliance);
    assert_eq!(model.characteristic_length, CharacteristicLength::Fixed(0.7));
    assert_eq!(model.platform_bars, 1);
    assert_eq!(model.legs.telescopic_bar, BarLength::Longest);
    assert_eq!(model.legs.telescopic_shortest, 0.0);
    assert_eq!(model.reference_grid.directions(), 24);

    let problem = DesignProblem::new(&study).expect("a problem");
    assert_eq!(problem.variables()[0], Variable::Categorical { choices: 2 });
    let design = problem.design(&[1.0, 2.0, 1.0, 2.0, 0.03, 0.04]).expect("a design");
    assert_eq!(design.architecture.name(), "3-PRR");
    assert_eq!(design.working_mode.signs(), [1, -1, 1]);
}

/// Each setting changes what it is declared for: the model, the ranges of the variables, or the settings of the search.
#[test]
fn every_setting_has_an_effect() {
    let paper = Study::default();
    let complete = complete_study();
    let (model, problem) = (
        complete.model().expect("a model"),
        DesignProblem::new(&complete).expect("a problem"),
    );
    for setting in settings() {
        let mut table = toml::Table::try_from(&complete).expect("TOML");
        let value = setting.value(&table).expect("a value").clone();
        let value = if setting.key == "seed" {
            7.into()
        } else {
            other(setting, &value)
        };
        insert(&mut table, setting, value);
        match setting.key {
            // A length counts only if it is fixed.
            "characteristic_length" => {
                table["model"]
                    .as_table_mut()
                    .expect("a section")
                    .remove("characteristic_length_m");
            }
            // A threshold that is set directly takes precedence over force and displacement.
            key if key.ends_with("_n")
                || key.ends_with("_nm")
                || key.ends_with("displacement_m")
                || key == "rotation_z_deg" =>
            {
                let requirements = table["requirements"].as_table_mut().expect("a section");
                for key in ["k_xy_min_n_per_m", "k_z_min_n_per_m", "k_phi_z_min_nm_per_rad"] {
                    requirements.remove(key);
                }
            }
            _ => {}
        }
        let path = setting.path();
        let changed: Study = table.try_into().unwrap_or_else(|error| panic!("{path}: {error}"));
        assert_eq!(changed.faults(), [], "{path}");
        let found = changed.model().expect("a model");
        match setting.section.split('.').next().expect("a section") {
            // The run proves the front or does not; the model is the same.
            _ if setting.key == "certify" => assert_ne!(changed, complete, "{path}"),
            "material" | "actuators" | "workspace" | "model" | "bodies" | "grid" => {
                assert_ne!(found, model, "{path} does not reach the model");
            }
            "requirements" => {
                let mut plain = paper.model().expect("a model").thresholds;
                plain.clearance = model.thresholds.clearance;
                assert_ne!(found.thresholds, model.thresholds, "{path} does not reach the model");
                assert_ne!(found.thresholds, plain, "{path} does not reach the model");
            }
            "bounds" => {
                let variables = DesignProblem::new(&changed).expect("a problem").variables();
                assert_ne!(variables, problem.variables(), "{path} does not reach the problem");
            }
            "optimizer" => assert_ne!(changed.optimizer, complete.optimizer, "{path}"),
            _ => assert_ne!(changed, complete, "{path}"),
        }
    }
}

#[test]
fn studies_of_one_problem_may_differ_in_the_search_only() {
    let paper = Study::default();
    let changed = |change: fn(&mut Study)| {
        let mut study = paper.clone();
        change(&mut study);
        paper.differing_key(&study)
    };
    assert_eq!(changed(|study| study.optimizer.seed = 7), None);
    assert_eq!(changed(|study| study.grid.reference.directions = 18), None);
    assert_eq!(
        changed(|study| study.material.density_kg_per_m3 = 2700.0).as_deref(),
        Some("material.density_kg_per_m3")
    );
    assert_eq!(
        changed(|study| study.requirements.clearance_min_m = Some(0.0)).as_deref(),
        Some("requirements.clearance_min_m")
    );
    assert_eq!(
        changed(|study| study.grid.fine.directions = 90).as_deref(),
        Some("grid.fine.directions")
    );
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
