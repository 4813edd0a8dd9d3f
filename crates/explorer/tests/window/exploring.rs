//! Tests that go from a run to a design, to a modified design, and back.

use egui::accesskit::{Role, Toggled};
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use kinefront_explorer::{DesignOrigin, Phase};
use kinefront_model::evaluation::{MemberReport, Quantity, QuantitySet};
use kinefront_model::mechanism::{DesignVariable, MemberKind};
use kinefront_study::{Column, EndReason};

use super::support::{
    TopView, change_study, click, click_at, idle_window, opened_window, press, press_with, selected, selected_id,
    set_slider, told, until, until_settled,
};

#[test]
fn a_run_is_started_and_a_click_shows_a_design_that_a_slider_changes_and_undo_restores() {
    let mut window = idle_window();
    assert_eq!(*window.state().session().phase(), Phase::Ready);
    click(&mut window, "▶ Start");
    until(&mut window, "the run ends", |explorer| {
        *explorer.session().phase() == Phase::Finished(EndReason::Completed)
    });
    let session = window.state().session();
    assert_eq!(session.store().len(), 300);
    assert_eq!(session.generations().last().map(|last| last.evaluations), Some(300));
    assert!(session.front().len() > 3 && session.front().iter().all(|entry| entry.verified));
    // The knee was selected automatically, which is not a step to undo.
    assert!(!session.can_undo());

    let id = session.front()[session.front().len() / 3].id;
    let at = window.state().scatter_position(id).expect("a position in the scatter");
    click_at(&mut window, at);
    let selected = window.state().session().document().selected.clone().expect("a design");
    assert_eq!(selected.origin, DesignOrigin::Evaluated(id));
    until(&mut window, "the design is verified", |explorer| {
        explorer.session().known().is_some_and(|known| known.verified) && explorer.session().is_drawn()
    });
    let heading = format!("{} #{id}", selected.design.architecture());
    assert!(
        window.query_by_label(&heading).is_some(),
        "the inspector shows {heading}"
    );
    let known = window.state().session().known().expect("known").clone();
    let place = window.state().session().place_on_front(id).expect("on the front");
    assert_eq!(
        known.evaluation.workspace_radius(),
        window.state().session().front()[place].row.workspace_radius()
    );

    set_slider(&mut window, "R", 2.0);
    let session = window.state().session();
    let changed = session.document().selected.clone().expect("a design");
    assert_eq!(changed.origin, DesignOrigin::Modified { from: Some(id) });
    assert_eq!(changed.design.base_radius(), 2.0);
    assert!(window.query_by_label("modified design").is_some());
    until(&mut window, "the modified design is evaluated", |explorer| {
        explorer.session().known().is_some()
    });
    let modify = window.state().session().known().expect("known").evaluation.clone();
    assert_ne!(modify.mass(), 0.0);
    assert_eq!(modify.design, changed.design);

    press_with(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(window.state().session().document().selected, Some(selected));
    press_with(&mut window, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(window.state().session().document().selected, Some(changed));
}

#[test]
fn a_run_is_paused_stepped_resumed_stopped_and_started_again() {
    let mut window = idle_window();
    change_study(&mut window, |study| study.optimizer.evaluations = 30_000);
    click(&mut window, "▶ Start");
    until(&mut window, "designs arrive", |explorer| {
        explorer.session().store().len() >= 60
    });
    click(&mut window, "⏸ Pause");
    assert_eq!(*window.state().session().phase(), Phase::Paused);
    // The current generation is still completed, and its messages arrive.
    until(&mut window, "the run waits", |explorer| explorer.session().is_waiting());
    until_settled(&mut window);
    let held = window.state().session().generations().len();
    window.get_by_label("⏭ Step").click();
    until(&mut window, "one more generation is done", |explorer| {
        explorer.session().generations().len() == held + 1
    });
    until(&mut window, "the run waits again", |explorer| {
        explorer.session().is_waiting()
    });
    until_settled(&mut window);
    assert_eq!(window.state().session().generations().len(), held + 1);
    window.get_by_label("▶ Resume").click();
    until(&mut window, "the run continues", |explorer| {
        explorer.session().generations().len() > held + 2
    });
    window.get_by_label("⏹ Stop").click();
    until(&mut window, "the run stops", |explorer| {
        *explorer.session().phase() == Phase::Finished(EndReason::Stopped)
    });
    let designs = window.state().session().store().len();
    assert!(designs < 30_000 && window.state().session().front().iter().all(|entry| entry.verified));
    click(&mut window, "▶ Start");
    assert!(window.state().session().store().len() < designs);
    window.state_mut().session_mut().close();
}

#[test]
fn arrow_keys_walk_along_the_lit_front_and_p_pins() {
    let mut window = opened_window();
    let front: Vec<usize> = window.state().session().front().iter().map(|entry| entry.id).collect();
    let knee = selected_id(&window);
    let place = front.iter().position(|&id| id == knee).expect("on the front");
    press(&mut window, Key::ArrowRight);
    assert_eq!(selected_id(&window), front[(place + 1).min(front.len() - 1)]);
    press(&mut window, Key::ArrowLeft);
    assert_eq!(selected_id(&window), knee);
    for _ in 0..front.len() {
        window.key_press(Key::ArrowLeft);
    }
    window.run_steps(2);
    assert_eq!(selected_id(&window), front[0]);

    press(&mut window, Key::P);
    press(&mut window, Key::K);
    press(&mut window, Key::P);
    let pins = &window.state().session().document().pins;
    assert_eq!(pins.len(), 2);
    assert_eq!(pins[0].name, format!("#{}", front[0]));
}

#[test]
fn one_filter_holds_everywhere() {
    let mut window = opened_window();
    let all = window.state().session().front().len();
    let architecture = window.state().session().front()[0].row.design.architecture();
    click(&mut window, &format!("include {architecture}"));
    let document = window.state().session().document().clone();
    assert_eq!(document.filter.hidden, [architecture]);
    let toggled = window
        .get_by_label(&format!("include {architecture}"))
        .accesskit_node()
        .toggled();
    assert_eq!(toggled, Some(Toggled::False));
    // Designs that do not pass the filter are dimmed, not removed.
    assert_eq!(window.state().session().front().len(), all);
    press_with(&mut window, Modifiers::COMMAND, Key::Z);
    assert!(window.state().session().document().filter.is_empty());

    let (low, high) = (0.3, 0.9);
    window.state_mut().session_mut().edit(|document| {
        document
            .filter
            .set_range(Column::Quantity(Quantity::WorkspaceRadius), Some([low, high]));
    });
    press(&mut window, Key::ArrowRight);
    let session = window.state().session();
    let prepared = session.document().filter.prepare(session.store());
    let id = selected_id(&window);
    assert!(prepared.passes(id), "the arrow key selected #{id}, which does not pass");
    let passes_filter = (0..session.store().len()).filter(|&id| prepared.passes(id)).count();
    let inside = session
        .store()
        .column(Column::Quantity(Quantity::WorkspaceRadius))
        .iter()
        .filter(|r| (low..=high).contains(*r))
        .count();
    assert_eq!(passes_filter, inside);
    assert!(inside > 0 && inside < session.store().len());
}

#[test]
fn the_platform_stops_at_its_limits_and_says_which() {
    let mut window = opened_window();
    set_slider(&mut window, "pose x", 3.9);
    let words = told(&window, "stopped: leg").expect("a reason");
    assert!(words.contains("reach") || words.contains("limit"), "{words}");
    let session = window.state().session();
    let (pose, design) = (session.pose().expect("a pose"), selected(&window).design);
    assert!(pose.position.x > 0.0);
    assert!(session.model().pose(&design, &pose).is_ok());
    click(&mut window, "Home");
    assert_eq!(window.state().session().pose(), window.state().session().home());
    // The message ends with the design and the pose that it speaks of.
    set_slider(&mut window, "pose x", 3.9);
    assert!(window.query_by_label_contains("stopped: leg").is_some());
    window.key_press(Key::ArrowRight);
    until(&mut window, "another design is shown", |explorer| {
        explorer
            .session()
            .known()
            .is_some_and(|known| known.evaluation.design != design)
    });
    window.run_steps(2);
    assert!(window.query_by_label_contains("stopped: leg").is_none());
}

/// Pointing at a bar in the top view shows what it is, with the values of the model.
#[test]
fn pointing_at_a_bar_tells_what_it_is() {
    let mut window = opened_window();
    window.run_steps(3);
    let session = window.state().session();
    let known = session.known().expect("a selected design");
    let design = known.evaluation.design;
    let pose = session.pose().expect("a pose");
    let members = session.model().members(&design, &pose).expect("reachable");
    // Whether a member can be pointed at: no other member covers its middle.
    let bare = |report: &MemberReport| {
        let at = 0.5 * (report.from + report.to).truncate();
        members.iter().all(|other| {
            let (from, way) = (other.from.truncate(), (other.to - other.from).truncate());
            let fraction = ((at - from).dot(way) / way.length_squared()).clamp(0.0, 1.0);
            other.member == report.member || at.distance(from + way * fraction) > 0.05 * design.base_radius()
        })
    };
    let report = members
        .iter()
        .find(|report| report.member.kind != MemberKind::PlatformBar && bare(report))
        .expect("a member that no other member covers");
    let view = TopView::of(&window);
    window.hover_at(view.screen(0.5 * (report.from + report.to).truncate()));
    window.run_steps(60);
    let name = format!(
        "{} of leg {}",
        report.member.kind.name().replace('_', " "),
        report.member.leg + 1
    );
    window.get_by_label(&name);
    let mass = format!("mass {} kg", kinefront_scene::text::number(report.mass));
    window.get_by_label(&mass);
    let fraction = report.contribution.expect("a stiff design");
    let words = format!(
        "contribution to the compliance at this pose: {:.1} % in the plane",
        100.0 * fraction.in_plane
    );
    assert!(window.query_all_by_label_contains(&words).count() > 0, "{words}");
    window.hover_at(view.rect.left_top() + egui::vec2(3.0, 3.0));
    window.run_steps(60);
    assert!(window.query_by_label(&name).is_none(), "the card is still shown");
}

#[test]
fn any_two_quantities_stand_against_each_other() {
    let mut window = opened_window();
    for (k, quantity) in Column::quantities(QuantitySet::default()).enumerate() {
        let scatter = kinefront_explorer::axes(quantity, Column::Dimension(DesignVariable::BaseRadius), k % 2 == 0);
        window.state_mut().set_axes(scatter);
        window.run_steps(3);
        assert_eq!(window.state().scatter_axes(), scatter);
        let shown = window.query_by_role_and_label(Role::Image, "Scatter of designs");
        assert!(shown.is_some(), "the scatter of {quantity:?} is missing");
    }
}

/// The platform, the view and the guide are reached without a mouse.
#[test]
fn keys_move_the_platform_and_turn_the_view() {
    let mut window = opened_window();
    let before = window.state().session().pose().expect("a pose");
    let design = selected(&window).design;
    let step = 0.01 * design.base_radius();
    window.key_press_modifiers(Modifiers::ALT, Key::ArrowRight);
    window.key_press_modifiers(Modifiers::ALT, Key::ArrowUp);
    window.key_press_modifiers(Modifiers::ALT, Key::PageUp);
    window.run_steps(4);
    let session = window.state().session();
    let moved = session.pose().expect("a pose");
    assert!((moved.position - before.position - glam::DVec2::splat(step)).length() < 1e-9);
    assert!((moved.phi - before.phi - 1f64.to_radians()).abs() < 1e-9);
    // The arrow keys alone walk along the front: the design is still the same.
    assert_eq!(selected(&window).design, design);
    let (viewpoint, changes) = session.view().viewpoint;
    press(&mut window, Key::Num2);
    let (top, more) = window.state().session().view().viewpoint;
    assert!(top != viewpoint && more == changes + 1);
    press(&mut window, Key::F1);
    assert!(window.query_by_label_contains("What you see").is_some());
}
