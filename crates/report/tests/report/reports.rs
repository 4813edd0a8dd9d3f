//! The computations of reports: fits, fronts, and the ranges in which each architecture is the lightest.

use kinefront_model::evaluation::{GridChoice, Model, Quantity};
use kinefront_model::mechanism::{Architecture, DESIGN_VARIABLES, Design};
use kinefront_report::{Fit, Front, Fronts, Source, best_intervals, trends};
use kinefront_study::{BUILTIN, DesignProblem, Row, Study};
use proptest::prelude::*;

proptest! {
    /// A fit to points on a parabola reproduces it, and a straight line explains no more of the variance than the
    /// parabola.
    #[test]
    fn a_fit_gives_back_the_polynomial(
        [a, b, c] in prop::array::uniform3(-5.0f64..5.0),
        xs in prop::collection::btree_set(1u32..400, 6..40),
    ) {
        let points: Vec<[f64; 2]> = xs
            .iter()
            .map(|&x| f64::from(x) / 100.0)
            .map(|x| [x, a + b * x + c * x * x])
            .collect();
        let parabola = Fit::new(&points, 2).expect("enough points");
        for (found, wanted) in parabola.coefficients.iter().zip([a, b, c]) {
            prop_assert!((found - wanted).abs() < 1e-6 * (a.abs() + b.abs() + c.abs() + 1.0), "{parabola:?}");
        }
        prop_assert!(parabola.r_squared > 1.0 - 1e-9);
        let line = Fit::new(&points, 1).expect("enough points");
        prop_assert!(line.r_squared <= parabola.r_squared + 1e-9 && line.r_squared > -1e-9);
        // Least squares: no neighbouring line has a smaller error.
        let error = |shift: f64, turn: f64| -> f64 {
            points.iter().map(|[x, y]| (line.at(*x) + shift + turn * x - y).powi(2)).sum()
        };
        for (shift, turn) in [(1e-3, 0.0), (-1e-3, 0.0), (0.0, 1e-3), (0.0, -1e-3)] {
            prop_assert!(error(shift, turn) >= error(0.0, 0.0));
        }
    }
}

#[test]
fn too_few_points_have_no_fit() {
    assert_eq!(Fit::new(&[[1.0, 2.0], [2.0, 3.0]], 1), None);
    assert_eq!(Fit::new(&[[0.0, 2.0], [0.0, 3.0], [0.0, 4.0]], 1), None);
    let constant = Fit::new(&[[1.0, 4.0], [2.0, 4.0], [3.0, 4.0]], 1).expect("a line");
    assert_eq!(constant.r_squared, 1.0);
}

fn small(architectures: &[Architecture]) -> Study {
    let mut study = BUILTIN[0].study().expect("the paper's study");
    study.architectures = architectures.to_vec();
    study.optimizer.evaluations = 300;
    study.grid.fine = study.grid.reference.clone();
    study
}

/// The front of each architecture is non-dominated and holds only its designs, and the front of all architectures is
/// at least as light as each of them.
#[test]
fn fronts_are_what_they_are_called() {
    let study = small(Architecture::PAPER);
    let problem = DesignProblem::new(&study).expect("a valid study");
    let source = Source::run("all", study).expect("a run");
    let fronts = Fronts::new(std::slice::from_ref(&source), &problem, 20).expect("fronts");
    assert_eq!(fronts.alone.len(), Architecture::PAPER.len());
    for (architecture, front) in &fronts.alone {
        assert!(front.shown.len() <= 20);
        for pair in front.members.windows(2) {
            assert!(pair[0].mass() < pair[1].mass() && pair[0].workspace_radius() < pair[1].workspace_radius());
        }
        for member in &front.members {
            assert_eq!(member.design.architecture(), *architecture);
            let best = fronts.together.best_with(&member.objectives[1..]).expect("one is");
            assert!(best.mass() <= member.mass());
            // No design of the run dominates it.
            assert!(!source.rows.iter().any(|row| {
                row.design.architecture() == *architecture
                    && row.mass() < member.mass()
                    && row.workspace_radius() > member.workspace_radius()
            }));
        }
        let marks: Vec<String> = front
            .marked(&problem.model().settings().objectives)
            .into_iter()
            .map(|(mark, _)| mark)
            .collect();
        let has = |name: &str| marks.iter().any(|mark| mark == name);
        assert!(has("lightest") && has("largest") || front.members.len() == 1);
    }
    let largest = fronts.together.best(1).expect("a design").workspace_radius();
    let stretches = best_intervals(&fronts, [0.0, -largest]);
    for pair in stretches.windows(2) {
        assert!(pair[0].0 != pair[1].0 && (pair[0].1[1] - pair[1].1[0]).abs() < 1e-12);
    }
    for (architecture, [from, to]) in stretches {
        let middle = 0.5 * (from + to);
        // The ranges are determined on equally spaced radii, and their ends are among these.
        assert_eq!(
            fronts.together.best_with(&[to]).map(|best| best.design.architecture()),
            Some(architecture)
        );
        assert!(fronts.together.best_with(&[middle]).is_some());
    }
}

/// Designs at which a variable is at its bound are excluded from the fits of the variable.
#[test]
fn trends_leave_out_what_stands_at_its_bounds() {
    let study = small(&[Architecture::ALL[0]]);
    let model = study.model().expect("a valid study");
    let designs = [1.0, 2.0, 3.0, 4.0].map(|radius| {
        let text = format!(
            "3-PRR R={radius} r={} Lb={} rj=0.05 rp=0.06",
            0.4 * radius,
            0.6 * radius
        );
        text.parse::<Design>().expect("a design")
    });
    let evaluations = designs.map(|design| model.evaluate(&design, GridChoice::Fine));
    assert!(evaluations.iter().all(|evaluation| evaluation.is_feasible()));
    let front = Front::new(evaluations.to_vec(), 10);
    assert_eq!(front.members.len(), 4);
    let trends = trends(&front, &study.bounds, Quantity::WorkspaceRadius);
    // R = 4 is the upper bound.
    let free: Vec<usize> = trends.iter().map(|trend| trend.free.len()).collect();
    assert_eq!(free, [3, 4, 4, 4, 4]);
    assert!((trends[1].rank_correlation.expect("four designs") - 1.0).abs() < 1e-12);
    assert_eq!(trends[3].rank_correlation, Some(0.0));
    assert_eq!((trends[0].rank_correlation, &trends[0].linear), (None, &None));
    assert_eq!(trends.len(), DESIGN_VARIABLES.len());
}

/// A row has the active constraints and the objectives of its evaluation.
#[test]
fn rows_keep_what_is_active() {
    let design: Design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056"
        .parse()
        .expect("a design");
    let evaluation = Model::default().evaluate(&design, GridChoice::Reference);
    let row = Row::new(3, &evaluation);
    assert_eq!(
        row.active.iter().collect::<Vec<_>>(),
        evaluation.active().collect::<Vec<_>>()
    );
    assert_eq!(*row.objectives, [evaluation.mass(), -evaluation.workspace_radius()]);
}
