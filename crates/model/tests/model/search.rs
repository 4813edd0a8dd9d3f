//! Compares the search for the regular workspace with its definition, which marches along every ray of every
//! orientation.

use glam::DVec2;
use kinefront_model::evaluation::{Constraint, GridChoice, Model, PoseScalar};
use kinefront_model::lanes::InstructionSet;
use kinefront_model::mechanism::{Architecture, Design, WorkingMode};
use kinefront_model::spatial::LEGS;
use kinefront_model::workspace::Grid;
use kinefront_model::workspace::plain::{PlainWorkspace, plain};
use kinefront_optimize::{Variable, sobol};
use kinefront_testkit::repetitions;
use proptest::prelude::*;
use rayon::prelude::*;

use super::strategies::{bodies, clearance, design, limit_motion, model, parsed};

/// Form of the stiffness that decides which poses are feasible.
#[derive(Clone, Copy)]
enum Form {
    /// The closed form, evaluated as it is defined.
    Plain,
    /// The reduced form that evaluations use, one pose at a time.
    Reduced,
}

fn plain_in(model: &Model, design: &Design, form: Form) -> PlainWorkspace {
    let evaluator = model.pose_evaluator(design);
    let good = |position: DVec2, arms: &[DVec2; LEGS]| match form {
        Form::Plain => evaluator.feasible_sign(arms, position),
        Form::Reduced => {
            let values = evaluator.evaluate_position(arms, position).ok()?;
            let determinant = values[PoseScalar::Determinant];
            (determinant != 0.0 && evaluator.thresholds().are_met_by(&values)).then(|| determinant.signum())
        }
    };
    plain(
        |rotation| evaluator.arms(rotation),
        model.sampling(GridChoice::Reference),
        design.base_radius(),
        good,
    )
}

pub fn plain_search(model: &Model, design: &Design) -> PlainWorkspace {
    plain_in(model, design, Form::Plain)
}

/// Compares with the definition evaluated with the same form: the radius and the home orientation, which is the first
/// of several with equal radius, must agree to the bit.
fn exactly(model: &Model, design: &Design) -> Result<(), TestCaseError> {
    let grid = &model.settings().reference_grid;
    let wanted = plain_in(model, design, Form::Reduced);
    let first = wanted
        .windows
        .iter()
        .position(|&radius| radius == wanted.radius && radius > 0.0);
    let assembly = model.assembly(design);
    let assembled = assembly.value >= assembly.threshold;
    for instructions in InstructionSet::available() {
        let found = model.evaluate_with(design, GridChoice::Reference, instructions);
        let name = format!("{design}: {}", instructions.name());
        if !assembled {
            prop_assert_eq!(found.workspace_radius(), 0.0);
            continue;
        }
        prop_assert_eq!(found.workspace_radius(), wanted.radius, "{}", name);
        let home = first.map(|home| home as f64 * grid.phi_step_deg());
        prop_assert_eq!(found.home_phi_deg, home, "{}", name);
        // Of the limits of a study, none has an id among the constraints.
        let is_limited = found.active().next().is_some() || !found.limits.is_empty();
        prop_assert!(is_limited, "{}: no constraint is active", design);
    }
    Ok(())
}

/// Checks that the radius is the same and that the home orientation is the same or one with an equal radius.
fn same(model: &Model, design: &Design) -> Result<(), String> {
    let found = model.evaluate(design, GridChoice::Reference);
    let wanted = plain_search(model, design);
    let radius = found.workspace_radius();
    let close = |wanted_radius: f64| (radius - wanted_radius).abs() <= 1e-9 * wanted.radius;
    if !close(wanted.radius) {
        return Err(format!("{design}: {radius} instead of {}", wanted.radius));
    }
    if let Some(phi_deg) = found.home_phi_deg {
        let home = (phi_deg / model.settings().reference_grid.phi_step_deg()).round() as usize;
        let radius = wanted.windows[home];
        if !close(radius) {
            return Err(format!("{design}: at {phi_deg}° the radius is {radius}"));
        }
    }
    Ok(())
}

/// The bounds of the paper: `R`, `r`, `L_b`, `r_j` and `r_p` \[m\].
const BOUNDS: [[f64; 2]; 5] = [[0.5, 4.0], [0.1, 4.0], [0.5, 4.0], [0.0, 0.1], [0.0, 0.1]];

/// Designs of each architecture, spread over the paper's bounds.
#[test]
fn designs_of_each_architecture_have_the_plain_radius() {
    let count = repetitions(150, 10_000);
    let bounds = BOUNDS.map(|[lower, upper]| Variable::Real { lower, upper });
    for &architecture in Architecture::ALL {
        let design = |x: &[f64]| {
            let values = x.try_into().expect("a value per bound");
            Design::new(architecture, WorkingMode::ALL_PLUS, values).expect("a design")
        };
        let sample = sobol(&bounds, count, 5);
        let failures: Vec<String> = sample
            .par_iter()
            .filter_map(|x| same(&Model::default(), &design(x)).err())
            .collect();
        println!("{architecture}: {count} designs compared");
        assert!(
            failures.is_empty(),
            "{} of {count} differ: {failures:#?}",
            failures.len()
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn best_first_finds_what_a_plain_search_finds(design in design(0.01)) {
        same(&Model::default(), &design).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn also_about_another_centre(design in design(0.01), x in -0.3..0.3, y in -0.3..0.3) {
        let model = model(|settings| settings.workspace.centre = DVec2::new(x, y));
        same(&model, &design).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn also_where_bodies_must_not_collide(design in design(0.01), bodies in bodies(), clearance in 0.0..0.05) {
        let model = model(|settings| {
            settings.bodies = bodies;
            settings.thresholds.set(PoseScalar::Clearance, Some(clearance));
        });
        same(&model, &design).map_err(TestCaseError::fail)?;
    }

    /// Whether a pose keeps the limits of a motion is determined by fewer operations than their values take. Each limit alone decides at
    /// some strictness.
    #[test]
    fn also_where_a_motion_is_limited(
        design in design(0.01),
        place in 0..PoseScalar::OF_MOTION.len(),
        strictness in 0.1..10.0f64,
    ) {
        let model = model(|settings| {
            limit_motion(settings);
            settings.reference_grid = Grid::new(10.0, 12, 20, 20).expect("a grid");
            for (other, &scalar) in PoseScalar::OF_MOTION.iter().enumerate() {
                let limit = settings.thresholds.get(scalar).expect("a limit");
                let is_raised = scalar == PoseScalar::NaturalFrequency;
                let by = if is_raised { strictness } else { 1.0 / strictness };
                settings.thresholds.set(scalar, (other == place).then_some(by * limit));
            }
        });
        exactly(&model, &design)?;
    }

    /// This also covers ties and grids of any shape: one direction marched, rings of a few poses, a single step, no
    /// halving.
    #[test]
    fn the_search_is_the_definition_to_the_bit(
        design in design(0.01),
        directions in 3..40usize,
        ray_steps in 1..60usize,
        halvings in 0..=40u32,
        phi_step_deg in prop::sample::select(&[2.5, 5.0, 10.0][..]),
        half_window in 0..5u32,
        off_centre: bool,
        bodies in bodies(),
        clearance in clearance(),
    ) {
        let model = model(|settings| {
            settings.reference_grid = Grid::new(phi_step_deg, directions, ray_steps, halvings).expect("a grid");
            settings.bodies = bodies;
            settings.thresholds.set(PoseScalar::Clearance, clearance);
            settings.workspace.rotation_range_deg = 2.0 * f64::from(half_window) * phi_step_deg;
            if off_centre {
                settings.workspace.centre = DVec2::new(0.1, -0.05);
            }
        });
        exactly(&model, &design)?;
    }

    /// With a given home orientation, the radius is that of its window in the definition.
    #[test]
    fn a_given_home_is_the_window_of_the_definition(design in design(0.01), home in 0..144usize) {
        let paper = Model::default();
        let wanted = plain_in(&paper, &design, Form::Reduced).windows[home];
        let model = model(|settings| settings.workspace.home_phi_deg = Some(home as f64 * 2.5));
        let found = model.evaluate(&design, GridChoice::Reference);
        prop_assume!(design.link_length() + design.platform_radius() >= 0.5 * design.base_radius());
        prop_assert_eq!(found.workspace_radius(), wanted);
    }

    /// The values of an evaluation are consistent with the workspace that it reports.
    #[test]
    fn reports_are_consistent(design in design(0.0), bodies in bodies(), clearance in clearance()) {
        let model = model(|settings| {
            settings.bodies = bodies;
            settings.thresholds.set(PoseScalar::Clearance, clearance);
        });
        let found = model.evaluate(&design, GridChoice::Reference);
        prop_assert_eq!(found.is_feasible(), found.violation == 0.0);
        prop_assert_eq!(found.is_feasible(), found.home.is_some());
        prop_assert!(found.violation.is_finite() && found.mass().is_finite());
        for report in &found.constraints {
            prop_assert!(report.margin.is_finite() && report.value.is_none_or(f64::is_finite));
            if found.is_feasible() {
                // Between the rings that the search samples, a value may fall a little below its threshold: only a proof excludes it.
                prop_assert!(report.margin >= -0.01 || !report.required, "{report:?}");
                prop_assert_eq!(report.pose.is_none(), report.constraint == Constraint::Assembly);
            }
        }
        prop_assert!(found.active().next().is_some(), "no constraint is active");
        // The reported clearance is that of the nearest pair over the workspace.
        let told = found.constraint(Constraint::Clearance);
        prop_assert_eq!(told.required, clearance.is_some());
        let nearest = found.nearest.as_ref().map(|nearest| nearest.distance);
        let close = |nearest: f64| told.value.is_some_and(|value| (nearest - value).abs() < 1e-7);
        prop_assert!(nearest.map_or(told.value.is_none(), close), "{:?} for {:?}", nearest, told);
    }
}

/// A given home orientation yields the radius of the window about it, which never exceeds that of the best window.
#[test]
fn a_given_home_is_kept() {
    let design = parsed("3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056");
    let best = Model::default().evaluate(&design, GridChoice::Reference);
    for (home, equal) in [(30.0, true), (-330.0, true), (20.0, false)] {
        let model = model(|settings| settings.workspace.home_phi_deg = Some(home));
        let found = model.evaluate(&design, GridChoice::Reference);
        assert_eq!(
            found.workspace_radius() == best.workspace_radius(),
            equal,
            "home {home}"
        );
        assert!(found.workspace_radius() <= best.workspace_radius() && found.is_feasible());
        assert_eq!(found.home_phi_deg, Some(if equal { 30.0 } else { home }));
    }
}

/// Each constraint has an effect: relaxing the active one makes the workspace larger.
#[test]
fn lifting_the_active_constraint_enlarges_the_workspace() {
    let cases = [
        (
            "3-PRR R=1.412 r=0.319 Lb=0.620 rj=0.026 rp=0.023",
            Constraint::Dexterity,
        ),
        (
            "3-PRR R=3.872 r=1.947 Lb=1.977 rj=0.039 rp=0.096",
            Constraint::StiffnessXy,
        ),
    ];
    for (text, constraint) in cases {
        let design = parsed(text);
        let before = Model::default().evaluate(&design, GridChoice::Fine);
        assert!(before.active().any(|active| active == constraint), "{text}");
        let eased = model(|settings| {
            for scalar in [PoseScalar::Dexterity, PoseScalar::StiffnessXy] {
                let limit = settings.thresholds.get(scalar).map(|limit| 0.5 * limit);
                settings.thresholds.set(scalar, limit);
            }
        });
        let after = eased.evaluate(&design, GridChoice::Fine);
        assert!(after.workspace_radius() > before.workspace_radius() + 1e-5, "{text}");
    }
}

#[test]
fn a_zero_radius_is_infeasible_and_finite() {
    for text in [
        "3-PRR R=3 r=1.2 Lb=1.9 rj=0 rp=0.05",
        "3-RRR R=3 r=1.2 Lb=1.9 rj=0.05 rp=0",
    ] {
        let found = Model::default().evaluate(&parsed(text), GridChoice::Reference);
        assert!(!found.is_feasible());
        assert!(found.mass() > 0.0 && found.violation > 0.0);
        assert_eq!(found.constraint(Constraint::StiffnessXy).value, Some(0.0));
        assert_eq!(found.constraint(Constraint::StiffnessXy).margin, -1.0);
    }
}

/// All results are finite, however far the input lies beyond anything that can be built.
#[test]
fn sizes_beyond_measure_stay_finite() {
    let far = model(|settings| settings.workspace.centre = DVec2::new(1e200, 0.0));
    for architecture in Architecture::ALL {
        for (model, lengths) in [
            (Model::default(), "R=1e160 r=1e159 Lb=1e160 rj=0.1 rp=0.1"),
            (Model::default(), "R=1e-160 r=1e-160 Lb=1e-160 rj=0.1 rp=0.1"),
            (Model::default(), "R=2 r=1 Lb=2 rj=2e74 rp=2e74"),
            (Model::default(), "R=2 r=1 Lb=2 rj=1e120 rp=1e-200"),
            (Model::default(), "R=1 r=1 Lb=1 rj=0.05 rp=0.05"),
            (far.clone(), "R=2 r=1 Lb=2 rj=0.05 rp=0.05"),
        ] {
            let design = parsed(&format!("{architecture} {lengths}"));
            let found = model.evaluate(&design, GridChoice::Reference);
            assert!(
                found.workspace_radius().is_finite() && found.violation.is_finite() && found.mass().is_finite(),
                "{design}"
            );
            for report in &found.constraints {
                assert!(
                    report.value.is_none_or(f64::is_finite) && report.margin.is_finite(),
                    "{design}: {report:?}"
                );
            }
            assert!(found.active().next().is_some(), "{design}: no constraint is active");
        }
    }
    // The mass of a bar that is larger still would be infinite.
    for (lengths, key) in [
        ("R=1 r=1 Lb=1 rj=0 rp=1e200", "rp"),
        ("R=2 r=1 Lb=2 rj=1e200 rp=0", "rj"),
    ] {
        let refused = format!("3-PRR {lengths}").parse::<Design>().expect_err("too large");
        assert!(refused.to_string().contains(key), "{refused}");
    }
}

/// A workspace that is large compared with the base costs time, not memory.
#[test]
fn a_disc_of_many_base_radii_is_searched() {
    let design = parsed("3-RRR R=0.001 r=1 Lb=1 rj=0.1 rp=0.1");
    let found = Model::default().evaluate(&design, GridChoice::Reference);
    assert!(
        found.workspace_radius() > 100.0 * design.base_radius(),
        "{}",
        found.workspace_radius()
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    /// An infeasible design names what it lacks: a constraint that it misses.
    #[test]
    fn an_infeasible_design_has_a_negative_margin(design in design(0.0)) {
        let found = Model::default().evaluate(&design, GridChoice::Reference);
        let misses = found.constraints.iter().any(|report| report.required && report.margin < 0.0);
        prop_assert!(found.is_feasible() || misses, "{}: {:?}", design, found.constraints);
    }
}
