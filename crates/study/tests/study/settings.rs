//! Tests of the settings of a study: each is declared once, stands in the template, and has an effect.

use kinefront_model::evaluation::PoseScalar;
use kinefront_model::kinematics::CharacteristicLength;
use kinefront_model::mechanism::BarLength;
use kinefront_model::stiffness::StiffnessDefinition;
use kinefront_model::workspace::Grid;
use kinefront_optimize::Variable;
use kinefront_study::{BUILTIN, Check, Initial, Setting, Stagnation, Study, settings};

use super::refusals::printed;
use super::{parsed, problem, reread};

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
    for (path, value) in [
        ("model.characteristic_length", "fixed".into()),
        ("task.shape", "pick-and-place".into()),
        ("task.law", "trapezoid".into()),
        ("strength.force_range_n", vec![1.0, 2.0, 3.0].into()),
        ("strength.moment_range_nm", vec![1.0, 2.0, 3.0].into()),
    ] {
        insert(&mut table, setting_at(path), value);
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

fn setting_at(path: &str) -> &'static Setting {
    settings().find(|setting| setting.path() == path).expect("a setting")
}

fn insert(table: &mut toml::Table, setting: &Setting, value: toml::Value) {
    let sections = setting.section.split('.').filter(|part| !part.is_empty());
    let table = sections.fold(table, section);
    table.insert(setting.key.to_owned(), value);
}

fn section<'a>(table: &'a mut toml::Table, name: &str) -> &'a mut toml::Table {
    table[name].as_table_mut().expect("a section")
}

/// Removes what takes precedence over a setting.
fn remove_stronger(table: &mut toml::Table, setting: &Setting) {
    match setting.key {
        // A length counts only if it is fixed.
        "characteristic_length" => {
            section(table, "model").remove("characteristic_length_m");
        }
        // A threshold that is set directly takes precedence over force and displacement.
        key if setting.section == "requirements"
            && (key.ends_with("_n")
                || key.ends_with("_nm")
                || key.ends_with("displacement_m")
                || key == "rotation_z_deg") =>
        {
            for key in ["k_xy_min_n_per_m", "k_z_min_n_per_m", "k_phi_z_min_nm_per_rad"] {
                section(table, "requirements").remove(key);
            }
        }
        _ => {}
    }
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
    let study = parsed(text);
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

    let problem = problem(&study);
    assert_eq!(problem.variables()[0], Variable::Categorical { choices: 2 });
    let design = problem.design(&[1.0, 2.0, 1.0, 2.0, 0.03, 0.04]).expect("a design");
    assert_eq!(design.architecture().name(), "3-PRR");
    assert_eq!(design.working_mode().signs(), [1, -1, 1]);
}

/// A grid of which a study states some keys keeps its own defaults for the others.
#[test]
fn a_grid_may_state_some_of_its_keys() {
    let study = parsed("[grid.fine]\nray_steps = 100\n[grid.reference]\nphi_step_deg = 5");
    let settings = study.model().expect("a model").settings().clone();
    assert_eq!(Ok(settings.fine_grid), Grid::new(0.5, 180, 100, 12));
    assert_eq!(Ok(settings.reference_grid), Grid::new(5.0, 36, 50, 12));
    let unknown = printed("[grid.fine]\nray_step = 100");
    assert!(
        unknown.contains("mine.toml:2") && unknown.contains("ray_steps"),
        "{unknown}"
    );
}

/// Each setting changes what it is declared for: the model, the ranges of the variables, or the settings of the search.
#[test]
fn every_setting_has_an_effect() {
    let complete = complete_study();
    let model = complete.model().expect("a model");
    let thresholds = model.settings().thresholds;
    // Those of the paper, but for the clearance, which it does not require.
    let mut plain = Study::default().model().expect("a model").settings().thresholds;
    plain.set(PoseScalar::Clearance, thresholds.get(PoseScalar::Clearance));
    // Kinds and objectives need other settings beside them; the test of alternatives has them.
    let is_kind = |setting: &Setting| setting.key == "kind" || setting.key == "objectives";
    for setting in settings().filter(|setting| !is_alternative(setting) && !is_kind(setting)) {
        let mut table = toml::Table::try_from(&complete).expect("TOML");
        let value = setting.value(&table).expect("a value").clone();
        insert(&mut table, setting, other(setting, &value));
        remove_stronger(&mut table, setting);
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
                for other in [thresholds, plain] {
                    assert_ne!(found.settings().thresholds, other, "{path} does not reach the model");
                }
            }
            "bounds" => {
                let [found, before] = [&changed, &complete].map(|study| problem(study).variables());
                assert_ne!(found, before, "{path} does not reach the problem");
            }
            "optimizer" => assert_ne!(changed.optimizer, complete.optimizer, "{path}"),
            _ => assert_ne!(changed, complete, "{path}"),
        }
    }
}

/// The paths of settings that stand in the place of others, each with a study that states it.
const ALTERNATIVES: [(&str, &str); 22] = [
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

/// Each alternative changes what it is declared for.
#[test]
fn every_alternative_has_an_effect() {
    let paper = Study::default();
    let variables = problem(&paper).variables();
    for (path, text) in ALTERNATIVES {
        let study = parsed(text);
        let table = toml::Table::try_from(&study).expect("TOML");
        assert!(setting_at(path).value(&table).is_some(), "{path}");
        assert_eq!(reread(&study), study, "{path}");
        assert!(paper.differing_key(&study).is_some(), "{path}");
        if path.starts_with("variables") {
            assert_ne!(
                problem(&study).variables(),
                variables,
                "{path} does not reach the problem"
            );
        } else {
            assert_ne!(study.model(), paper.model(), "{path} does not reach the model");
        }
    }
}
