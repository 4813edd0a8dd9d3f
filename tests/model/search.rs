//! The search for the regular workspace against its definition, which marches every ray of every orientation.

use glam::DVec2;
use kinefront::evaluation::{Constraint, GridChoice, Model};
use kinefront::mechanism::{Architecture, Design, Leg, PrrLeg, RprLeg, RrrLeg};
use kinefront::optimize::sobol;
use kinefront::spatial::LEGS;
use kinefront::study::{DesignProblem, Study};
use kinefront::workspace::plain::{PlainWorkspace, plain};
use kinefront::workspace::{Grid, PoseChecker};
use proptest::prelude::*;
use rayon::prelude::*;

use super::strategies::design;

fn plain_of<L: Leg>(model: &Model, design: &Design, grid: &Grid) -> PlainWorkspace {
    let checker: PoseChecker<L> = model.checker(design).expect("a whole grid");
    let good = |position: DVec2, arms: &[DVec2; LEGS]| checker.good_sign(position, arms);
    plain(&checker.manipulator, &model.workspace, grid, design.base_radius, good).expect("a whole grid")
}

pub fn plain_search(model: &Model, design: &Design, grid: &Grid) -> PlainWorkspace {
    match design.architecture {
        Architecture::Prr => plain_of::<PrrLeg>(model, design, grid),
        Architecture::Rpr => plain_of::<RprLeg>(model, design, grid),
        Architecture::Rrr => plain_of::<RrrLeg>(model, design, grid),
    }
}

/// Same radius; the same home, or one as good.
fn same(model: &Model, design: &Design) -> Result<(), String> {
    let found = model.evaluate(design, GridChoice::Reference).expect("a whole grid");
    let wanted = plain_search(model, design, &model.reference_grid);
    let close = |radius: f64| (found.workspace_radius - radius).abs() <= 1e-9 * wanted.radius;
    if !close(wanted.radius) {
        return Err(format!(
            "{design}: {} instead of {}",
            found.workspace_radius, wanted.radius
        ));
    }
    if let Some(phi_deg) = found.home_phi_deg {
        let home = (phi_deg / model.reference_grid.phi_step_deg).round() as usize;
        if !close(wanted.windows[home]) {
            return Err(format!(
                "{design}: at {phi_deg}° the radius is {}",
                wanted.windows[home]
            ));
        }
    }
    Ok(())
}

/// Designs of each architecture over the paper's bounds, compared one by one.
fn all_the_same(count: usize) {
    for &architecture in Architecture::ALL {
        let study = Study {
            architectures: vec![architecture],
            ..Study::default()
        };
        let problem = DesignProblem::new(&study);
        let sample = sobol(&problem.variables(), count, 5);
        let failures: Vec<String> = sample
            .par_iter()
            .filter_map(|x| same(&Model::default(), &problem.design(x).expect("a design")).err())
            .collect();
        println!("{architecture}: {count} designs compared");
        assert!(
            failures.is_empty(),
            "{} of {count} differ: {failures:#?}",
            failures.len()
        );
    }
}

#[test]
fn a_thousand_designs_of_each_architecture_have_the_plain_radius() {
    all_the_same(1000);
}

/// The same for 10⁴, which takes minutes: `cargo test --release -- --ignored ten_thousand`.
#[test]
#[ignore = "takes minutes"]
fn ten_thousand_designs_of_each_architecture_have_the_plain_radius() {
    all_the_same(10_000);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn best_first_finds_what_a_plain_search_finds(design in design(0.01)) {
        same(&Model::default(), &design).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn also_about_another_centre(design in design(0.01), x in -0.3..0.3, y in -0.3..0.3) {
        let mut model = Model::default();
        model.workspace.centre = DVec2::new(x, y);
        same(&model, &design).map_err(TestCaseError::fail)?;
    }

    /// A report speaks of the workspace it reports.
    #[test]
    fn reports_are_consistent(design in design(0.0)) {
        let found = Model::default().evaluate(&design, GridChoice::Reference).expect("a whole grid");
        prop_assert_eq!(found.is_feasible(), found.violation == 0.0);
        prop_assert_eq!(found.is_feasible(), found.home.is_some());
        prop_assert!(found.violation.is_finite() && found.mass.is_finite());
        for report in &found.constraints {
            prop_assert!(report.margin.is_finite() && report.value.is_none_or(f64::is_finite));
            if found.is_feasible() {
                prop_assert!(report.margin >= 0.0, "{report:?}");
                prop_assert_eq!(report.pose.is_none(), report.constraint == Constraint::Assembly);
            }
        }
        prop_assert!(found.active().next().is_some(), "nothing is active");
    }
}

/// A fixed home gives the window about it, and never more than the best one.
#[test]
fn a_given_home_is_kept() {
    let design: Design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056"
        .parse()
        .expect("a design");
    let best = Model::default()
        .evaluate(&design, GridChoice::Reference)
        .expect("a whole grid");
    for (home, equal) in [(30.0, true), (-330.0, true), (20.0, false)] {
        let mut model = Model::default();
        model.workspace.home_phi_deg = Some(home);
        let found = model.evaluate(&design, GridChoice::Reference).expect("a whole grid");
        assert_eq!(found.workspace_radius == best.workspace_radius, equal, "home {home}");
        assert!(found.workspace_radius <= best.workspace_radius && found.is_feasible());
        assert_eq!(found.home_phi_deg, Some(if equal { 30.0 } else { home }));
    }
}

/// Each constraint shows: lifting the one that is active makes the workspace larger.
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
        let design: Design = text.parse().expect("a design");
        let model = Model::default();
        let before = model.evaluate(&design, GridChoice::Fine).expect("a whole grid");
        assert!(before.active().any(|active| active == constraint), "{text}");
        let mut eased = model;
        eased.thresholds.inverse_condition *= 0.5;
        eased.thresholds.k_xy *= 0.5;
        let after = eased.evaluate(&design, GridChoice::Fine).expect("a whole grid");
        assert!(after.workspace_radius > before.workspace_radius + 1e-5, "{text}");
    }
}

#[test]
fn a_zero_radius_is_infeasible_and_finite() {
    for text in [
        "3-PRR R=3 r=1.2 Lb=1.9 rj=0 rp=0.05",
        "3-RRR R=3 r=1.2 Lb=1.9 rj=0.05 rp=0",
    ] {
        let found = Model::default()
            .evaluate(&text.parse().expect("a design"), GridChoice::Reference)
            .expect("a whole grid");
        assert!(!found.is_feasible());
        assert!(found.mass > 0.0 && found.violation > 0.0);
        assert_eq!(found.constraint(Constraint::StiffnessXy).value, Some(0.0));
        assert_eq!(found.constraint(Constraint::StiffnessXy).margin, -1.0);
    }
}
