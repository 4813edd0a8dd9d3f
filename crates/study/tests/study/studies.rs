//! Tests of studies: the built-in ones, reading and writing, comparing, and what follows from one.

use kinefront_model::evaluation::{GridChoice, Model};
use kinefront_model::mechanism::Design;
use kinefront_model::stiffness::Material;
use kinefront_study::{BUILTIN, MATERIALS, Overrides, Study};

use super::{builtin, parsed, problem, reread};

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
    let paper = builtin("paper").study().expect("a valid study");
    assert_eq!(paper.model(), Ok(Model::default()));
    let bare = Study {
        description: paper.description.clone(),
        references: paper.references.clone(),
        ..parsed("name = \"paper\"")
    };
    assert_eq!(bare, paper);
    let printed = builtin("paper-bounds-as-printed").study().expect("a valid study");
    assert_eq!(printed.bounds.r_m, [0.5, 4.0]);
}

#[test]
fn a_study_reads_what_it_writes() {
    for builtin in BUILTIN {
        let study = builtin.study().expect("a valid study");
        assert_eq!(reread(&study), study);
    }
}

/// A named material gives what the study does not state, and what it states stays.
#[test]
fn a_named_material_gives_what_is_not_stated() {
    let of = |text: &str| parsed(text).material;
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

/// Rails with a section weigh what their travel says, and yield the more the thinner and the less supported they are.
#[test]
fn rails_weigh_and_bend_as_a_study_says() {
    let evaluated = |rails: &str, design: &str| {
        let design: Design = design.parse().expect("a design");
        let model = parsed(rails).model().expect("a model");
        model.evaluate(&design, GridChoice::Reference)
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
    let problem = problem(&parsed(text));
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
        problem(&parsed(&text)).determined_variables()
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

/// Bounds of a variable that the architectures of one of the studies do not have make no other problem; those of one that both have do.
#[test]
fn bounds_of_what_one_study_lacks_do_not_count() {
    let of =
        |architectures: &str, bounds: &str| parsed(&format!("architectures = [{architectures}]\n[bounds]\n{bounds}\n"));
    let (rails, cranks) = (
        of("\"3-PRR\"", "alpha_deg = [-30.0, 30.0]"),
        of("\"3-RRR\"", "La_m = [0.5, 4.0]"),
    );
    assert_eq!(rails.differing_key(&cranks), None);
    let mut both = rails.clone();
    both.join(&cranks);
    assert_eq!(
        both,
        of("\"3-PRR\", \"3-RRR\"", "alpha_deg = [-30.0, 30.0]\nLa_m = [0.5, 4.0]")
    );
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
    let differs = |change: fn(&mut Study), key: &str| assert_eq!(changed(change).as_deref(), Some(key));
    differs(
        |study| study.material.density_kg_per_m3 = 2700.0,
        "material.density_kg_per_m3",
    );
    differs(
        |study| study.requirements.clearance_min_m = Some(0.0),
        "requirements.clearance_min_m",
    );
    differs(|study| study.grid.fine.directions = 90, "grid.fine.directions");
}
