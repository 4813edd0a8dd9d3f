//! The search for the regular workspace against a plain one that marches every ray of every orientation.

use glam::DVec2;
use kinefront::evaluation::{Constraint, GridChoice, Model};
use kinefront::mechanism::{Architecture, Design, Leg, PrrLeg, RprLeg, RrrLeg};
use kinefront::spatial::Rotation;
use kinefront::workspace::{Grid, PoseChecker};
use proptest::prelude::*;

use super::strategies::design;

/// SPEC section 4 taken literally; `None` where no window has a workspace.
fn plain<L: Leg>(model: &Model, design: &Design, grid: &Grid) -> Option<(f64, f64)> {
    let checker: PoseChecker<L> = model.checker(design).expect("a whole grid");
    let count = grid.orientations().expect("a whole turn");
    let half = grid
        .half_window(model.workspace.rotation_range_deg)
        .expect("a whole window");
    let centre = model.workspace.centre;
    let step = design.base_radius / grid.ray_steps as f64;
    let rays: Vec<(f64, f64)> = (0..count)
        .map(|k| {
            let arms = checker
                .manipulator
                .arms(&Rotation::new((k as f64 * grid.phi_step_deg).to_radians()));
            let Some(sign) = checker.good_sign(centre, &arms) else {
                return (0.0, 0.0);
            };
            let radius = (0..grid.directions)
                .map(|d| {
                    let angle = (d as f64 * 360.0 / grid.directions as f64).to_radians();
                    let direction = DVec2::new(libm::cos(angle), libm::sin(angle));
                    let good = |radius: f64| checker.is_good(centre + direction * radius, &arms, sign);
                    let first = (1..).find(|&k| !good(f64::from(k) * step)).expect("an end");
                    let (mut low, mut high) = (f64::from(first - 1) * step, f64::from(first) * step);
                    for _ in 0..grid.halvings {
                        let middle = 0.5 * (low + high);
                        if good(middle) {
                            low = middle;
                        } else {
                            high = middle;
                        }
                    }
                    low
                })
                .fold(f64::INFINITY, f64::min);
            (radius, sign)
        })
        .collect();
    let window = |home: usize| (0..=2 * half).map(move |offset| (home + count - half + offset) % count);
    let mut best: Option<(f64, f64)> = None;
    for home in 0..count {
        let sign = rays[home].1;
        if sign == 0.0 || window(home).any(|k| rays[k].1 != sign) {
            continue;
        }
        let radius = window(home).map(|k| rays[k].0).fold(f64::INFINITY, f64::min);
        if radius > best.map_or(0.0, |(other, _)| other) {
            best = Some((radius, home as f64 * grid.phi_step_deg));
        }
    }
    best
}

fn plain_search(model: &Model, design: &Design, grid: &Grid) -> Option<(f64, f64)> {
    match design.architecture {
        Architecture::Prr => plain::<PrrLeg>(model, design, grid),
        Architecture::Rpr => plain::<RprLeg>(model, design, grid),
        Architecture::Rrr => plain::<RrrLeg>(model, design, grid),
    }
}

/// Same radius; the same home, or one as good.
fn same(model: &Model, design: &Design) -> Result<(), proptest::test_runner::TestCaseError> {
    let found = model.evaluate(design, GridChoice::Reference).expect("a whole grid");
    let wanted = plain_search(model, design, &model.reference_grid);
    let radius = wanted.map_or(0.0, |(radius, _)| radius);
    prop_assert!(
        (found.workspace_radius - radius).abs() <= 1e-9 * radius,
        "{design}: {} instead of {radius}",
        found.workspace_radius
    );
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn best_first_finds_what_a_plain_search_finds(design in design(0.01)) {
        same(&Model::default(), &design)?;
    }

    #[test]
    fn also_about_another_centre(design in design(0.01), x in -0.3..0.3, y in -0.3..0.3) {
        let mut model = Model::default();
        model.workspace.centre = DVec2::new(x, y);
        same(&model, &design)?;
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
