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
    let found = window.query_by_label_contains(text)?;
    found.value().or_else(|| found.accesskit_node().label())
}

#[test]
fn a_wish_becomes_a_design_and_undo_takes_it_back() {
    let mut window = opened_window();
    window.state_mut().show(Panel::Wish);
    window.run_steps(3);
    let before = window.state().session().known().expect("known").evaluation.clone();
    let selected = window.state().session().document().selected.clone();
    set_slider(&mut window, "Wished change of k_xy", 10.0);
    window.get_by_label("Find the design").click();
    until(&mut window, "the wish is answered", |explorer| {
        !explorer.session().is_wishing()
    });
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
    assert!(wished.evaluation.is_feasible() && wished.from == before.design);
    assert!(wished.evaluation.workspace_radius() >= before.workspace_radius() * (1.0 - 1e-6));
    until(&mut window, "the design is shown", |explorer| {
        explorer.session().known().is_some_and(|known| known.verified)
    });
    assert!(told(&window, "The wish is granted").is_some());

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
    let entry = &session.front()[session.front().len() / 2];
    let (mass, radius) = (entry.row.mass(), entry.row.workspace_radius());
    let at = window.state().scatter_position(entry.id).expect("a place");
    // Lighter and larger: up and to the left.
    click_at(&mut window, at + egui::vec2(-40.0, -25.0));
    let point = window.state().session().why_point().expect("a question");
    assert!(point.wished < mass, "{point:?}");
    assert_eq!(point.held.len(), 1);
    assert!(point.held[0].0 == Quantity::WorkspaceRadius && point.held[0].1 > radius);
    until(&mut window, "the question is answered", |explorer| {
        explorer.session().why().is_some()
    });
    let answer = window.state().session().why().expect("an answer");
    let drivers = answer.as_ref().as_ref().expect("a reason");
    assert!(drivers.polished_value > point.wished);
    // The panel came to the front by itself, and shows a design for a requirement that is relaxed.
    assert!(told(&window, "The best design there has a mass of").is_some());
    let before = window.state().session().document().selected.clone();
    window
        .get_all_by_label_contains("Show the design for")
        .next()
        .expect("a button")
        .click();
    window.run_steps(3);
    assert_ne!(window.state().session().document().selected, before);
    window.get_by_label("Withdraw").click();
    window.run_steps(3);
    assert!(window.state().session().why_point().is_none());
    assert!(told(&window, "Click an empty place of the scatter").is_some());
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
    assert!(window.query_by_label("Prices of the limits").is_some());
}

#[test]
fn a_run_without_designs_tells_what_stands_in_the_way() {
    let mut study = Study {
        references: Vec::new(),
        ..small_study()
    };
    study.requirements.k_xy_min_n_per_m = Some(1e12);
    study.optimizer.evaluations = 60;
    let mut window = window(InitialContent::Study {
        study: Box::new(study),
        path: None,
        start: true,
    });
    until(&mut window, "the run ends", |explorer| {
        let session = explorer.session();
        !session.is_running() && session.store().len() == 60
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
    let mut study = Study {
        references: Vec::new(),
        ..small_study()
    };
    study.material.youngs_modulus_pa = 70e9;
    study.optimizer.evaluations = 150;
    let mut softer = window(InitialContent::Study {
        study: Box::new(study),
        path: None,
        start: true,
    });
    until(&mut softer, "the run ends", |explorer| {
        let session = explorer.session();
        !session.is_running() && session.front().iter().all(|entry| entry.verified) && session.store().len() == 150
    });
    let folder = tempfile::tempdir().expect("a folder");
    let ctx = softer.ctx.clone();
    let path = folder.path().join("softer");
    softer
        .state_mut()
        .act(&ctx, kinefront_explorer::Purpose::SaveRun, path.clone());
    until(&mut softer, "the run is saved", |explorer| !explorer.is_busy());
    assert!(path.join("front.csv").exists());

    let mut window = opened_window();
    let ctx = window.ctx.clone();
    window
        .state_mut()
        .act(&ctx, kinefront_explorer::Purpose::OpenBeside, path);
    window.state_mut().show(Panel::Beside);
    window.run_steps(4);
    assert!(told(&window, "small beside softer").is_some());
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
