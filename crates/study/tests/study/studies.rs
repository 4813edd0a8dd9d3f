//! Tests of study files: the built-in studies, reading and writing, and how invalid files are rejected.

use kinefront_model::evaluation::{GridChoice, Model, PoseScalar};
use kinefront_model::kinematics::CharacteristicLength;
use kinefront_model::mechanism::{BarLength, Design};
use kinefront_model::stiffness::{Material, StiffnessDefinition};
use kinefront_model::workspace::Grid;
use kinefront_optimize::Variable;
use kinefront_study::{
    BUILTIN, Builtin, Check, DesignProblem, Initial, MATERIALS, Overrides, Setting, Stagnation, Study, StudyError,
    settings,
};
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

/// The design with which a study is shown is an answer to its question.
#[test]
fn the_studies_that_come_with_the_program_are_shown_with_feasible_designs() {
    for builtin in BUILTIN {
        let study = builtin.study().expect("a valid study");
        let design = Design::parse(builtin.design, study.working_mode).expect("a design");
        assert!(study.architectures.contains(&design.architecture()), "{}", builtin.name);
        let model = study.model().expect("the grids fit");
        let evaluation = model.evaluate(&design, GridChoice::Reference);
        assert!(evaluation.is_feasible(), "{}: {:?}", builtin.name, evaluation.limits);
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
        if let Some(value) = setting.initial.and_then(value_of).filter(|_| !is_alternative(setting)) {
            insert(&mut table, setting, value);
        }
    }
    insert_text(&mut table, "model", "characteristic_length", "fixed");
    insert_text(&mut table, "task", "shape", "pick-and-place");
    insert_text(&mut table, "task", "law", "trapezoid");
    for key in ["force_range_n", "moment_range_nm"] {
        let setting = settings().find(|setting| setting.key == key).expect("a setting");
        insert(
            &mut table,
            setting,
            toml::Value::Array(vec![1.0.into(), 2.0.into(), 3.0.into()]),
        );
    }
    table.try_into().expect("a study")
}

fn value_of(initial: Initial) -> Option<toml::Value> {
    match initial {
        Initial::Number(number) => Some(number.into()),
        Initial::Count(count) => Some(count.into()),
        Initial::Name(name) => Some(name.into()),
        Initial::AsText => None,
    }
}

/// Settings that stand in the place of others, or that only some studies have.
fn is_alternative(setting: &Setting) -> bool {
    let of_sections = setting.section.starts_with("sections.") && setting.key != "kind";
    let of_region = setting.section == "workspace.region" && setting.key != "kind";
    let paths = [
        "quantities",
        "constraints",
        "hypervolume.reference",
        "material.name",
        "task.waypoints",
        "task.cycle_time_s",
        "drives.catalogue",
    ];
    let of_some_chains = setting.section == "bounds" && setting.initial.is_some();
    of_sections
        || of_region
        || of_some_chains
        || setting.section == "variables"
        || paths.contains(&setting.path().as_str())
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
    let always = settings().filter(|setting| !is_alternative(setting));
    let mut declared: Vec<String> = always.map(Setting::path).collect();
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
        (_, Value::Integer(1)) => 2.into(),
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
    assert_eq!(model.settings().actuators.prismatic, 2e7);
    assert_eq!(model.settings().thresholds.get(PoseScalar::StiffnessPhiZ), Some(5729.6));
    assert_eq!(model.settings().workspace.centre.to_array(), [0.1, 0.0]);
    assert_eq!(model.settings().workspace.home_phi_deg, Some(45.0));
    assert_eq!(model.settings().stiffness_definition, StiffnessDefinition::Compliance);
    assert_eq!(model.settings().characteristic_length, CharacteristicLength::Fixed(0.7));
    assert_eq!(model.settings().platform_bars, 1);
    assert_eq!(model.settings().legs.telescopic_bar, BarLength::Longest);
    assert_eq!(model.settings().legs.telescopic_shortest, 0.0);
    assert_eq!(model.settings().reference_grid.directions(), 24);

    let problem = DesignProblem::new(&study).expect("a problem");
    assert_eq!(problem.variables()[0], Variable::Categorical { choices: 2 });
    let design = problem.design(&[1.0, 2.0, 1.0, 2.0, 0.03, 0.04]).expect("a design");
    assert_eq!(design.architecture().name(), "3-PRR");
    assert_eq!(design.working_mode().signs(), [1, -1, 1]);
}

/// A grid of which a study states some keys keeps its own defaults for the others.
#[test]
fn a_grid_may_state_some_of_its_keys() {
    let study = Study::parse(
        "[grid.fine]\nray_steps = 100\n[grid.reference]\nphi_step_deg = 5",
        "coarse",
    );
    let settings = study
        .expect("a valid study")
        .model()
        .expect("a model")
        .settings()
        .clone();
    let of = |grid: Grid| {
        (
            grid.phi_step_deg(),
            grid.directions(),
            grid.ray_steps(),
            grid.halvings(),
        )
    };
    assert_eq!(of(settings.fine_grid), (0.5, 180, 100, 12));
    assert_eq!(of(settings.reference_grid), (5.0, 36, 50, 12));
    let unknown = printed("[grid.fine]\nray_step = 100");
    assert!(
        unknown.contains("mine.toml:2") && unknown.contains("ray_steps"),
        "{unknown}"
    );
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
    // Kinds and objectives need other settings beside them; the test of alternatives has them.
    let is_kind = |setting: &Setting| setting.key == "kind" || setting.key == "objectives";
    for setting in settings().filter(|setting| !is_alternative(setting) && !is_kind(setting)) {
        let mut table = toml::Table::try_from(&complete).expect("TOML");
        let value = setting.value(&table).expect("a value").clone();
        insert(&mut table, setting, other(setting, &value));
        match setting.key {
            // A length counts only if it is fixed.
            "characteristic_length" => {
                table["model"]
                    .as_table_mut()
                    .expect("a section")
                    .remove("characteristic_length_m");
            }
            // A threshold that is set directly takes precedence over force and displacement.
            key if setting.section == "requirements"
                && (key.ends_with("_n")
                    || key.ends_with("_nm")
                    || key.ends_with("displacement_m")
                    || key == "rotation_z_deg") =>
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
            "material" | "rails" | "actuators" | "joints" | "strength" | "payload" | "drives" | "loads" | "task"
            | "anywhere" | "tolerances" | "workspace" | "model" | "bodies" | "grid" => {
                assert_ne!(found, model, "{path} does not reach the model");
            }
            "requirements" => {
                let mut plain = paper.model().expect("a model").settings().thresholds;
                plain.set(
                    PoseScalar::Clearance,
                    model.settings().thresholds.get(PoseScalar::Clearance),
                );
                assert_ne!(
                    found.settings().thresholds,
                    model.settings().thresholds,
                    "{path} does not reach the model"
                );
                assert_ne!(found.settings().thresholds, plain, "{path} does not reach the model");
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

/// Each alternative changes what it is declared for.
#[test]
fn every_alternative_has_an_effect() {
    let paper = Study::default();
    let variables = DesignProblem::new(&paper).expect("a problem").variables();
    let cases = [
        (
            "task.waypoints",
            "[task]\nshape = \"waypoints\"\nwaypoints = [[0, 0, 0], [0.1, 0, 0]]\ncycle_time_s = 1",
        ),
        ("task.cycle_time_s", "[task]\nshape = \"star\"\ncycle_time_s = 2"),
        (
            "sections.legs.wall_ratio",
            "[sections]\nlegs = { kind = \"tube\", wall_ratio = 0.2 }",
        ),
        (
            "sections.legs.wall_m",
            "[sections]\nlegs = { kind = \"square_tube\", wall_m = 0.002 }",
        ),
        (
            "sections.legs.catalogue",
            "[sections]\nlegs = { kind = \"tube\", catalogue = \"en-10255-medium\" }",
        ),
        (
            "sections.platform.wall_ratio",
            "[sections.platform]\nkind = \"tube\"\nwall_ratio = 0.2",
        ),
        (
            "sections.platform.wall_m",
            "[sections.platform]\nkind = \"tube\"\nwall_m = 0.002",
        ),
        (
            "sections.platform.catalogue",
            "[sections.platform]\nkind = \"tube\"\n\
             catalogue = [{ name = \"40 x 2\", outer_mm = 40.0, wall_mm = 2.0 }]",
        ),
        (
            "sections.rails.wall_ratio",
            "[rails]\nradius_m = 0.03\n[sections.rails]\nkind = \"tube\"\nwall_ratio = 0.2",
        ),
        (
            "sections.rails.wall_m",
            "[rails]\nradius_m = 0.03\n[sections.rails]\nkind = \"square_tube\"\nwall_m = 0.004",
        ),
        (
            "sections.rails.catalogue",
            "[rails]\nradius_m = 0.03\n[sections.rails]\nkind = \"tube\"\ncatalogue = \"en-10255-medium\"",
        ),
        (
            "workspace.region.radius_m",
            "objectives = [{ minimize = \"mass_kg\" }]\nworkspace.region = { kind = \"disc\", radius_m = 0.3 }",
        ),
        (
            "workspace.region.width_m",
            "objectives = [{ minimize = \"mass_kg\" }]\n\
             workspace.region = { kind = \"rectangle\", width_m = 0.3, height_m = 0.2 }",
        ),
        (
            "workspace.region.corners_m",
            "objectives = [{ minimize = \"mass_kg\" }]\n\
             workspace.region = { kind = \"polygon\", corners_m = [[0, 0], [0.2, 0], [0, 0.2]] }",
        ),
        ("quantities", "quantities = [\"dexterity_mean\"]"),
        ("material.name", "[material]\nname = \"S235\""),
        ("constraints", "[constraints]\nmass_kg = { at_most = 10 }"),
        ("constraints", "[constraints]\nk_xy_n_per_m = { at_least = 2e6 }"),
        ("constraints", "[constraints]\ntransmission_min = { at_least = 0.3 }"),
        ("variables.R_m", "[variables]\nR_m = 1.5"),
        ("variables.r_m", "[variables]\nr_m = [0.2, 0.3]"),
        ("variables.rp_m", "[variables]\nrp_m = \"0.5 rj\""),
    ];
    for (path, text) in cases {
        let study = Study::parse(text, path).unwrap_or_else(|error| panic!("{path}: {error}"));
        let table = toml::Table::try_from(&study).expect("TOML");
        let setting = settings().find(|setting| setting.path() == path).expect("a setting");
        assert!(setting.value(&table).is_some(), "{path}");
        let reread = Study::parse(&toml::to_string(&study).expect("TOML"), path).expect("a valid study");
        assert_eq!(reread, study, "{path}");
        assert!(paper.differing_key(&study).is_some(), "{path}");
        if path.starts_with("variables") {
            let found = DesignProblem::new(&study).expect("a problem").variables();
            assert_ne!(found, variables, "{path} does not reach the problem");
        } else {
            assert_ne!(study.model(), paper.model(), "{path} does not reach the model");
        }
    }
}

/// Rails with a section weigh what their travel says, and yield the more the thinner and the less supported they are.
#[test]
fn rails_weigh_and_bend_as_a_study_says() {
    let evaluated = |rails: &str, design: &str| {
        let study = Study::parse(rails, "rails").expect("a study");
        let design: Design = design.parse().expect("a design");
        study.model().expect("a model").evaluate(&design, GridChoice::Reference)
    };
    let on_rails = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056";
    let rigid = evaluated("", on_rails);
    let radius_of = |rails: &str| evaluated(rails, on_rails).workspace_radius();
    let clamped = evaluated("[rails]\nradius_m = 0.08", on_rails);
    let rails = 3.0 * 3f64.sqrt() * 3.066 * std::f64::consts::PI * 0.08 * 0.08 * 7850.0;
    assert!((clamped.mass() / (rigid.mass() + rails) - 1.0).abs() < 1e-12);

    // Which is stiffer shows in the size of the workspace.
    let spans = radius_of("[rails]\nradius_m = 0.08\nspans = 3");
    let thick = radius_of("[rails]\nradius_m = 5");
    let pinned = radius_of("[rails]\nradius_m = 0.08\nsupports = \"pinned\"");
    let tube = radius_of("[rails]\nradius_m = 0.08\n[sections.rails]\nkind = \"tube\"\nwall_ratio = 0.1");
    let order = [pinned, clamped.workspace_radius(), spans, rigid.workspace_radius()];
    assert!(
        order.is_sorted() && order[0] < order[1] && order[1] < order[2],
        "{order:?}"
    );
    assert!(tube < clamped.workspace_radius(), "{tube}");
    assert!((thick / rigid.workspace_radius() - 1.0).abs() < 1e-3, "{thick}");

    // A chain without rails has nothing to do with them.
    let without = "3-RPR R=2.0 r=0.6 Lb=2.5 rj=0.04 rp=0.04";
    assert_eq!(evaluated("[rails]\nradius_m = 0.02", without), evaluated("", without));
}

/// Variables that are fixed, listed, tied or of a catalogue take their values before a candidate is evaluated.
#[test]
fn candidates_take_the_values_that_variables_may_have() {
    use kinefront_optimize::{Candidate, Problem, Target};
    let text = r#"
        architectures = ["3-PRR"]
        [sections]
        legs = { kind = "tube", catalogue = "en-10255-medium" }
        [variables]
        R_m = 1.5
        r_m = [0.3, 0.5, 0.4]
        rp_m = "2 rj"
    "#;
    let problem = DesignProblem::new(&Study::parse(text, "variables").expect("a study")).expect("a problem");
    for target in [None, Some(Target::Best), Some(Target::Level(-0.2))] {
        let candidate = Candidate {
            x: vec![0.0, 2.0, 0.44, 1.1, 0.02, 0.09],
            target,
        };
        let x = problem.completed(candidate.clone());
        assert_eq!(x[1..4], [1.5, 0.4, 1.1], "{target:?}");
        let tubes = [
            10.2, 13.5, 17.2, 21.3, 26.9, 33.7, 42.4, 48.3, 60.3, 76.1, 88.9, 114.3, 139.7, 165.1,
        ];
        assert!(tubes.iter().any(|tube| 0.0005 * tube == x[4]), "{target:?}: {x:?}");
        assert_eq!(x[5], 2.0 * x[4], "{target:?}");
        let design = problem.design(&x).expect("a design");
        assert_eq!(design.values()[..], x[1..]);
        assert!(problem.follows(&candidate, &design), "{target:?}");
    }
}

/// Where the mass alone is sought for a prescribed region, the bars and the scale are left to sizing, unless a length is fixed or a
/// limit depends on the scale.
#[test]
fn sizing_determines_the_scale_where_nothing_else_depends_on_it() {
    use kinefront_optimize::Problem;
    let determined = |question: &str| {
        let text = format!(
            "objectives = [{{ minimize = \"mass_kg\" }}]\nworkspace.region = {{ kind = \"disc\", radius_m = 0.3 }}\n{question}"
        );
        let study = Study::parse(&text, "test.toml").expect("a study");
        DesignProblem::new(&study)
            .expect("a valid study")
            .determined_variables()
    };
    let (bars, with_scale) = (vec![4, 5], vec![4, 5, 1]);
    assert_eq!(determined(""), with_scale);
    assert_eq!(determined("constraints.footprint_m = { at_most = 2.0 }"), with_scale);
    assert_eq!(determined("variables.r_m = \"0.3 R\""), with_scale);
    for question in [
        "variables.r_m = 0.3",
        "variables.Lb_m = [0.6, 0.8]",
        "constraints.dexterity_mean = { at_least = 0.3 }",
        "constraints.clearance_m = { at_least = 0.005 }",
    ] {
        assert_eq!(determined(question), bars, "{question}");
    }
}

#[test]
fn questions_that_cannot_be_asked_are_refused_with_the_reason_and_what_would_be_right() {
    let disc = "workspace.region = { kind = \"disc\", radius_m = 0.3 }";
    let cases: [(String, &[&str]); 17] = [
        (
            "objectives = [{ minimize = \"weight_kg\" }]".into(),
            &["objectives", "weight_kg", "mass_kg"],
        ),
        (
            "objectives = [{ minimize = \"mass_g\" }]".into(),
            &["stated in kg", "`mass_kg`"],
        ),
        (
            "objectives = [{ minimize = \"mass_kg\" }, { maximize = \"mass_kg\" }]".into(),
            &["`mass_kg` is named twice"],
        ),
        ("objectives = []".into(), &["0 entries", "one to three"]),
        (
            format!("{disc}\nobjectives = [{{ maximize = \"workspace_radius_m\" }}]"),
            &["the region is prescribed"],
        ),
        (
            "constraints.mas_kg = { at_most = 3 }".into(),
            &["constraints.mas_kg", "did you mean `mass_kg`"],
        ),
        (
            "constraints.footprint_mm = { at_most = 3000 }".into(),
            &["stated in m", "`footprint_m`"],
        ),
        (
            "constraints.mass_kg = { at_least = 3, at_most = 2 }".into(),
            &["contradicts itself", "at least 3 and at most 2 kg"],
        ),
        ("constraints.mass_kg = {}".into(), &["states no limit", "at_least"]),
        ("constraints.dexterity_mean = { at_least = 1.5 }".into(), &["at most 1"]),
        (
            "constraints.k_xy_n_per_m = { at_least = 1 }\nrequirements.k_xy_min_n_per_m = 2".into(),
            &["requirements.k_xy_min_n_per_m", "omit one"],
        ),
        (
            "sections.legs = { kind = \"tube\", catalogue = [] }".into(),
            &["sections.legs.catalogue", "no entry"],
        ),
        (
            "sections.legs = { kind = \"tube\", catalogue = \"no.csv\" }".into(),
            &["cannot be read", "en-10255-medium"],
        ),
        (
            "sections.legs = { kind = \"tube\" }".into(),
            &["sections.legs.kind", "wall_ratio"],
        ),
        (
            "sections.legs = { kind = \"tube\", wall_ratio = 1.2 }".into(),
            &["1.2", "(0, 1]"],
        ),
        (
            "objectives = [{ minimize = \"mass_kg\" }]\nworkspace.region = { kind = \"disc\", radius_m = 30 }".into(),
            &["30.000 m from O", "no design within the bounds"],
        ),
        ("variables.rp_m = \"rq\"".into(), &["variables.rp_m", "rq", "0.5 rj"]),
    ];
    for (text, parts) in cases {
        let report = printed(&text).split_whitespace().collect::<Vec<_>>().join(" ");
        for part in parts {
            assert!(report.contains(part), "{part}: {report}");
        }
        assert!(report.contains("mine.toml:"), "{report}");
    }
}

/// Bounds of a variable that the architectures of one of the studies do not have make no other problem; those of one that both have do.
#[test]
fn bounds_of_what_one_study_lacks_do_not_count() {
    let of = |architectures: &str, bounds: &str| {
        Study::parse(
            &format!("architectures = [{architectures}]\n[bounds]\n{bounds}\n"),
            "mine",
        )
        .expect("a study")
    };
    let (rails, cranks) = (
        of("\"3-PRR\"", "alpha_deg = [-30.0, 30.0]"),
        of("\"3-RRR\"", "La_m = [0.5, 4.0]"),
    );
    assert_eq!(rails.differing_key(&cranks), None);
    let mut both = rails.clone();
    both.join(&cranks);
    assert_eq!(both, {
        let both = of("\"3-PRR\", \"3-RRR\"", "alpha_deg = [-30.0, 30.0]\nLa_m = [0.5, 4.0]");
        Study {
            name: rails.name.clone(),
            ..both
        }
    });
    assert_eq!(both.differing_key(&cranks), None);
    let narrow = of("\"3-RRR\"", "La_m = [0.5, 2.0]");
    assert_eq!(narrow.differing_key(&cranks).as_deref(), Some("bounds.La_m"));
    assert_eq!(narrow.differing_key(&both).as_deref(), Some("bounds.La_m"));
    // A command that selects architectures omits the bounds that have no effect then.
    let overrides = Overrides {
        architectures: Some(cranks.architectures.clone()),
        ..Overrides::default()
    };
    let alone = overrides.apply(both).expect("a study");
    assert_eq!(alone.bounds, cranks.bounds);
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
    let cases: [(&str, &[&str]); 15] = [
        (
            "name = \"x\"\n[material]\ndensty = 1.0",
            &["mine.toml:3", "densty", "density_kg_per_m3"],
        ),
        (
            "[material]\ndensity_kg_per_m3 = \"steel\"",
            &["mine.toml:2", "material.density_kg_per_m3", "expected a number"],
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
        (
            "[rails]\nradius_m = 0.03\nsupports = \"pinned\"\nspans = 2",
            &["mine.toml:4", "rails.spans", "one span", "clamped"],
        ),
        (
            "[rails]\nspans = 3",
            &["mine.toml:2", "rails.spans", "no effect", "rails.radius_m"],
        ),
        (
            "[sections.rails]\nkind = \"square_tube\"\nwall_ratio = 0.1",
            &["mine.toml:2", "sections.rails.kind", "no effect", "rails.radius_m"],
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

/// Obstacles and a room are read, written and compared, and each fault names the section and the key at fault.
#[test]
fn obstacles_and_a_room_are_checked() {
    let clearance = "[requirements]\nclearance_min_m = 0.005\n";
    let post = "[[obstacles]]\nname = \"post\"\nkind = \"disc\"\nradius_m = 0.1\n";
    let sound = format!(
        "{clearance}{post}centre_m = [0.9, 0.8]\nheights_m = [-0.1, 0.4]\n[[obstacles]]\nname = \"wall\"\n\
         kind = \"polygon\"\ncentre_m = [1.0, 0.0]\ncorners_m = [[0.5, -1.0], [0.6, -1.0], [0.6, 1.0], [0.5, 1.0]]\n\
         [room]\nkind = \"rectangle\"\nwidth_m = 6.0\nheight_m = 5.0\n"
    );
    let study = Study::parse(&sound, "mine.toml").expect("a study");
    let model = study.model().expect("a model");
    let surroundings = &model.settings().surroundings;
    assert_eq!(surroundings.obstacles.len(), 2);
    assert_eq!(surroundings.obstacles[0].heights, [-0.1, 0.4]);
    assert_eq!(surroundings.obstacles[1].heights, [f64::NEG_INFINITY, f64::INFINITY]);
    let room = surroundings.room.as_ref().expect("a room");
    assert_eq!(
        room.bounds().map(|corner| corner.to_array()),
        [[-3.0, -2.5], [3.0, 2.5]]
    );
    let text = toml::to_string(&study).expect("TOML");
    assert_eq!(Study::parse(&text, "again").expect("a study"), study);
    let paper = Study::parse(clearance, "paper").expect("a study");
    assert_eq!(study.differing_key(&paper).as_deref(), Some("obstacles"));
    for (text, key, words) in [
        (
            post.to_owned() + "centre_m = [1.0, 1.0]",
            "obstacles[1]",
            "without a clearance",
        ),
        (
            format!("{clearance}{post}"),
            "obstacles[1]",
            "covers the centre of the workspace",
        ),
        (
            format!("{clearance}{post}centre_m = [1.0, 1.0]\n{post}centre_m = [-1.0, 1.0]"),
            "obstacles[2].name",
            "the name of another obstacle",
        ),
        (
            format!("{clearance}{post}centre_m = [1.0, 1.0]\nheights_m = [0.2, 0.1]"),
            "obstacles[1].heights_m",
            "above the first",
        ),
        (
            format!("{clearance}{post}centre_m = [1.0, inf]"),
            "obstacles[1].centre_m",
            "within ±1e6 m",
        ),
        (
            format!("{clearance}[[obstacles]]\nname = \"post\""),
            "obstacles[1].kind",
            "is missing",
        ),
        (
            format!("{clearance}[[obstacles]]\nkind = \"disc\"\nradius_m = 0.1"),
            "obstacles[1].name",
            "is missing",
        ),
        (
            format!("{clearance}[room]\nkind = \"rectangle\"\nwidth_m = 0.5\nheight_m = 0.5"),
            "room",
            "smaller than the base: A1",
        ),
        (
            format!("{clearance}[room]\nkind = \"disc\""),
            "room.kind",
            "is \"disc\"",
        ),
    ] {
        let StudyError::Values { faults, .. } = error(&text) else {
            panic!("the error is not about values: {text}");
        };
        let [fault] = &faults[..] else {
            panic!("{faults:?}");
        };
        assert_eq!(fault.key, key, "{text}");
        assert!(fault.message.contains(words), "{}", fault.message);
    }
    // The place in the file is that of the second obstacle.
    let second = format!("{clearance}{post}centre_m = [1.0, 1.0]\n{post}centre_m = [-1.0, nan]");
    assert!(printed(&second).contains("mine.toml:12:12"), "{}", printed(&second));
}

/// A named material gives what the study does not state, and what it states stays.
#[test]
fn a_named_material_gives_what_is_not_stated() {
    let of = |text: &str| Study::parse(text, "mine.toml").expect("a study").material;
    for builtin in MATERIALS {
        let name = builtin.name;
        let plain = of(&format!("[material]\nname = \"{name}\""));
        assert_eq!(Material::from(&plain), builtin.material, "{name}");
        assert!(!builtin.source.is_empty() && builtin.material.yield_strength.is_some());
        let stated = of(&format!("[material]\nname = \"{name}\"\ndensity_kg_per_m3 = 1234.0"));
        assert_eq!(
            (stated.density_kg_per_m3, stated.youngs_modulus_pa),
            (1234.0, plain.youngs_modulus_pa)
        );
    }
    assert_eq!(Material::from(&of("")), Material::STEEL);
}

/// A fault that several keys have is told once, with the file that has it.
#[test]
fn a_fault_that_two_keys_share_is_told_once() {
    let section = "{ kind = \"tube\", catalogue = \"tubes-that-are-not-there.csv\" }";
    let told = printed(&format!("[sections]\nlegs = {section}\nplatform = {section}\n"));
    let told = told.split_whitespace().collect::<Vec<_>>().join(" ").replace("│ ", "");
    assert!(
        told.contains("`sections.platform.catalogue` has the same fault as `sections.legs.catalogue`"),
        "{told}"
    );
}
