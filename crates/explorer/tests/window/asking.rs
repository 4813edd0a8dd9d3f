//! Questions about designs, asked in the window: wishes, why not, prices along the front, and what stands in the way.

use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use kinefront_explorer::{DesignOrigin, InitialContent, Panel};
use kinefront_model::evaluation::{PoseScalar, Quantity};
use kinefront_study::Study;

use super::support::{Window, click_at, opened_window, set_slider, small_study, until, window};

const K_XY: Quantity = Quantity::Worst(PoseScalar::StiffnessXy);

/// Returns what a label that contains some text says.
fn told(window: &Window, text: &str) -> Option<String> {
    let found = window.query_all_by_label_contains(text).next()?;
    found.value().or_else(|| found.accesskit_node().label())
}

/// Runs a study of one architecture in a window of its own.
fn run_of(change: impl FnOnce(&mut Study)) -> Window {
    let mut study = Study {
        references: Vec::new(),
        ..small_study()
    };
    study.optimizer.evaluations = 150;
    change(&mut study);
    let evaluations = study.optimizer.evaluations;
    let mut window = window(InitialContent::Study {
        study: Box::new(study),
        path: None,
        start: true,
    });
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
    window.state_mut().show(Panel::Wish);
    window.run_steps(3);
    let before = window.state().session().known().expect("known").evaluation.clone();
    let selected = window.state().session().document().selected.clone();
    set_slider(&mut window, "Desired change of k_xy", 10.0);
    window.get_by_label("Find the design").click();
    window.run_steps(2);
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
    until(&mut window, "the design is shown", |explorer| {
        explorer.session().known().is_some_and(|known| known.verified)
    });
    assert!(told(&window, "All conditions are met").is_some());

    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.run_steps(3);
    let session = window.state().session();
    assert!(session.document().wished.is_empty());
    assert_eq!(session.document().selected, selected);
    window.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    window.run_steps(3);
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
    window.get_by_label("Dismiss").click();
    window.run_steps(3);
    assert!(window.state().session().why_point().is_none());
    assert!(told(&window, "Click an empty place in the scatter").is_some());
}

#[test]
fn prices_along_the_front_are_told_in_sentences() {
    let mut window = opened_window();
    window.state_mut().show(Panel::Prices);
    window.run_steps(3);
    let since = std::time::Instant::now();
    while told(&window, "drives the mass").is_none() {
        assert!(since.elapsed().as_secs() < 120, "no sentence");
        std::thread::sleep(std::time::Duration::from_millis(10));
        window.step();
    }
    assert!(told(&window, "Prices of the limits").is_some());
}

#[test]
fn a_run_without_designs_tells_what_stands_in_the_way() {
    let mut window = run_of(|study| {
        study.requirements.k_xy_min_n_per_m = Some(1e12);
        study.optimizer.evaluations = 60;
    });
    assert!(window.state().session().is_hindered());
    window.state_mut().show(Panel::WhyNot);
    window.run_steps(3);
    assert!(told(&window, "No design of the run is feasible").is_some());
    let since = std::time::Instant::now();
    while window.query_by_label("Show the design for k_xy").is_none() {
        assert!(since.elapsed().as_secs() < 120, "no answer");
        std::thread::sleep(std::time::Duration::from_millis(10));
        window.step();
    }
    window.get_by_label("Show the design for k_xy").click();
    window.run_steps(3);
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
    let ctx = softer.ctx.clone();
    let path = folder.path().join("softer");
    softer
        .state_mut()
        .act(&ctx, kinefront_explorer::Purpose::SaveRun, path.clone());
    until(&mut softer, "the run is saved", |explorer| !explorer.is_busy());
    assert!(path.join("front.csv").exists());

    // Fronts of few designs have none near most radii.
    let mut window = run_of(|study| study.optimizer.front_designs = 24);
    let ctx = window.ctx.clone();
    window
        .state_mut()
        .act(&ctx, kinefront_explorer::Purpose::OpenBeside, path);
    window.state_mut().show(Panel::Beside);
    window.run_steps(4);
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
    window.get_by_label("Close softer").click();
    window.run_steps(3);
    assert!(window.state().session().beside().is_none());
    // A folder that is no run is refused.
    window
        .state_mut()
        .act(&ctx, kinefront_explorer::Purpose::OpenBeside, folder.path().to_owned());
    assert!(window.state().session().beside().is_none());
    assert!(window.state().session().notices().iter().any(|notice| notice.is_error));
}
