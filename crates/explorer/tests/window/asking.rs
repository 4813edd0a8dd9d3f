//! Questions about designs, asked in the window: wishes, why not, prices along the front, and what stands in the way.

use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use kinefront_explorer::{DesignOrigin, Panel, Purpose};
use kinefront_model::evaluation::{PoseScalar, Quantity};
use kinefront_study::Study;

use super::support::{
    Window, act, click, click_at, content, opened_window, press_with, set_slider, show, small_study, told, until,
    until_seen, until_verified, window,
};

const K_XY: Quantity = Quantity::Worst(PoseScalar::StiffnessXy);

/// Runs a study of one architecture in a window of its own.
fn run_of(change: impl FnOnce(&mut Study)) -> Window {
    let mut study = Study {
        references: Vec::new(),
        ..small_study()
    };
    study.optimizer.evaluations = 150;
    change(&mut study);
    let evaluations = study.optimizer.evaluations;
    let mut window = window(content(study, true));
    until(&mut window, "the run ends", |explorer| {
        let session = explorer.session();
        let is_verified = session.front().iter().all(|entry| entry.verified);
        !session.is_running() && session.store().len() == evaluations && is_verified
    });
    window
}

#[test]
fn a_wish_becomes_a_design_and_undo_takes_it_back() {
    let mut window = opened_window();
    show(&mut window, Panel::Wish);
    let before = window.state().session().known().expect("known").evaluation.clone();
    let selected = window.state().session().document().selected.clone();
    set_slider(&mut window, "Desired change of k_xy", 10.0);
    click(&mut window, "Find the design");
    until(&mut window, "the wish is answered", |explorer| {
        !explorer.session().is_wishing()
    });
    let answer = window.state().session().wish_answer();
    assert!(answer.as_ref().is_some_and(|answer| answer.is_ok()), "{answer:?}");
    let start = answer
        .as_ref()
        .and_then(|answer| answer.as_ref().as_ref().ok())
        .map(|outcome| outcome.before.design);
    let document = window.state().session().document().clone();
    let [wished] = document.wished.as_slice() else {
        panic!("one design answers the wish: {:?}", document.wished)
    };
    assert_eq!(
        document.selected.as_ref().map(|selected| &selected.origin),
        Some(&DesignOrigin::Wished(0))
    );
    let value = |of: &kinefront_model::evaluation::Evaluation| of.quantities.get(K_XY).expect("a stiffness");
    assert!(value(&wished.evaluation) >= 1.1 * value(&before) * (1.0 - 1e-6));
    assert!(wished.evaluation.is_feasible() && start == Some(before.design));
    assert!(wished.evaluation.workspace_radius() >= before.workspace_radius() * (1.0 - 1e-6));
    until_verified(&mut window);
    assert!(told(&window, "All conditions are met").is_some());

    press_with(&mut window, Modifiers::COMMAND, Key::Z);
    let session = window.state().session();
    assert!(session.document().wished.is_empty());
    assert_eq!(session.document().selected, selected);
    press_with(&mut window, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(window.state().session().document().wished.len(), 1);
}

#[test]
fn a_click_beyond_the_front_asks_why() {
    let mut window = opened_window();
    let session = window.state().session();
    let [first, .., last] = session.front() else {
        panic!("a front")
    };
    let (mass, radius) = (first.row.mass(), last.row.workspace_radius());
    let place = |id: usize| window.state().scatter_position(id).expect("a place");
    // As light as the lightest design, and nearly as large as the largest.
    let at = egui::pos2(place(first.id).x, place(last.id).y + 12.0);
    click_at(&mut window, at);
    let point = window.state().session().why_point().expect("a question");
    assert!((point.wished / mass - 1.0).abs() < 0.1, "{point:?}");
    assert_eq!(point.held.len(), 1);
    let (quantity, held) = point.held[0];
    assert!(
        quantity == Quantity::WorkspaceRadius && held > 0.8 * radius && held < radius,
        "{point:?}"
    );
    until(&mut window, "the question is answered", |explorer| {
        explorer.session().why().is_some()
    });
    let answer = window.state().session().why().expect("an answer");
    let drivers = answer.as_ref().as_ref().expect("a reason");
    assert!(drivers.polished_value > point.wished);
    // The panel came to the front by itself, and shows a design for a requirement that is relaxed.
    assert!(told(&window, "The best design there has a mass of").is_some());
    let before = window.state().session().document().selected.clone();
    let show = window.get_all_by_label_contains("Show the design for").next();
    show.expect("a link").click();
    window.run_steps(3);
    assert_ne!(window.state().session().document().selected, before);
    click(&mut window, "Dismiss");
    assert!(window.state().session().why_point().is_none());
    assert!(told(&window, "Click an empty place in the scatter").is_some());
}

#[test]
fn prices_along_the_front_are_told_in_sentences() {
    let mut window = opened_window();
    show(&mut window, Panel::Prices);
    until_seen(&mut window, "a sentence is told", |window| {
        told(window, "drives the mass").is_some()
    });
    assert!(told(&window, "Prices of the limits").is_some());
}

#[test]
fn a_run_without_designs_tells_what_stands_in_the_way() {
    let mut window = run_of(|study| {
        study.requirements.k_xy_min_n_per_m = Some(1e12);
        study.optimizer.evaluations = 60;
    });
    assert!(window.state().session().is_hindered());
    show(&mut window, Panel::WhyNot);
    assert!(told(&window, "No design of the run is feasible").is_some());
    until_seen(&mut window, "the question is answered", |window| {
        window.query_by_label("Show the design for k_xy").is_some()
    });
    click(&mut window, "Show the design for k_xy");
    assert!(window.state().session().document().selected.is_some());
}

#[test]
fn a_second_run_is_compared_with_the_first() {
    // The same question with a softer material, in a run of its own.
    let mut softer = run_of(|study| {
        study.optimizer.front_designs = 24;
        study.material.youngs_modulus_pa = 70e9;
    });
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("softer");
    act(&mut softer, Purpose::SaveRun, &path);
    assert!(path.join("front.csv").exists());

    // Fronts of few designs have none near most radii.
    let mut window = run_of(|study| study.optimizer.front_designs = 24);
    act(&mut window, Purpose::OpenBeside, &path);
    show(&mut window, Panel::Beside);
    assert!(told(&window, "small and softer").is_some());
    assert!(window.query_by_label("material.youngs_modulus_pa").is_some());
    let levels = window.state().session().levels_beside();
    let both: Vec<[f64; 2]> = levels
        .iter()
        .filter_map(|level| Some([level.costs[0]?, level.costs[1]?]))
        .collect();
    assert!(both.len() > 3, "{levels:?}");
    // A softer material is heavier wherever both have a design.
    assert!(both.iter().all(|[stiff, soft]| soft > stiff), "{levels:?}");
    click(&mut window, "Close softer");
    assert!(window.state().session().beside().is_none());
    // A folder that is no run is refused.
    act(&mut window, Purpose::OpenBeside, folder.path());
    assert!(window.state().session().beside().is_none());
    assert!(window.state().session().notices().iter().any(|notice| notice.is_error));
}
