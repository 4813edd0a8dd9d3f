//! Dragging the platform in the 3-D view: what the viewer sees of it, and where the platform goes.

use egui::{Event, Modifiers, PointerButton, Pos2, RawInput, Rect, pos2};
use glam::{DMat3, DQuat, DVec2, DVec3};
use kinefront_explorer::{Eye, Panel, PlatformDrag, SceneView, Session};
use kinefront_model::mechanism::MemberKind;
use kinefront_model::spatial::Pose;
use kinefront_study::{ObstacleSection, RegionKind};

use super::support::{TopView, change_study, drag, opened_window};

/// An eye above the front of the machine.
fn view() -> SceneView {
    let position = DVec3::new(1.0, -5.0, 6.0);
    let back = position.normalize();
    let right = DVec3::Z.cross(back).normalize();
    SceneView {
        eye: Eye {
            position,
            rotation: DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back)),
            fov_y: 0.96,
        },
        rect: Rect::from_min_max(pos2(400.0, 50.0), pos2(1200.0, 650.0)),
    }
}

fn press(pos: Pos2, pressed: bool, modifiers: Modifiers) -> Event {
    Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers,
    }
}

/// Passes events to the drag, and returns what is left for the viewer.
fn send(drag: &mut PlatformDrag, session: &mut Session, events: Vec<Event>) -> Vec<Event> {
    let mut input = RawInput {
        events,
        ..RawInput::default()
    };
    drag.take_events(&mut input, session, Some(view()));
    input.events
}

/// Returns a point of the first bar of the platform, at a share of its length from `P`.
fn on_bar(session: &Session, pose: &Pose, share: f64) -> DVec3 {
    let design = session.known().expect("a design").evaluation.design;
    let members = session.model().members(&design, pose).expect("the pose is reached");
    let bar = members
        .iter()
        .find(|member| member.member.kind == MemberKind::PlatformBar);
    let bar = bar.expect("a bar");
    let is_outward = (bar.to.truncate() - pose.position).length() > (bar.from.truncate() - pose.position).length();
    let [inner, outer] = if is_outward {
        [bar.from, bar.to]
    } else {
        [bar.to, bar.from]
    };
    inner.lerp(outer, share)
}

fn screen(at: DVec3) -> Pos2 {
    view().screen(at).expect("it is before the eye").0
}

/// Drags from one point of the scene to another, and returns the poses before and after.
fn dragged(session: &mut Session, from_share: f64, by: DVec2, modifiers: Modifiers) -> [Pose; 2] {
    session.view_mut().pose = None;
    let mut drag = PlatformDrag::default();
    let before = session.pose().expect("a pose");
    let held = on_bar(session, &before, from_share);
    let (from, to) = (screen(held), screen(held + by.extend(0.0)));
    let left = send(&mut drag, session, vec![press(from, true, modifiers)]);
    assert_eq!(left, [], "the viewer must not turn its camera");
    let moves = [0.3, 0.7, 1.0].map(|share| Event::PointerMoved(from.lerp(to, share)));
    let left = send(&mut drag, session, moves.to_vec());
    assert_eq!(left.len(), 3, "the viewer may follow the pointer");
    assert!(drag.is_dragging());
    let left = send(&mut drag, session, vec![press(to, false, modifiers)]);
    assert_eq!(left, []);
    assert!(!drag.is_dragging());
    [before, session.pose().expect("a pose")]
}

#[test]
fn the_platform_follows_the_pointer_and_its_rim_turns_it() {
    let mut window = opened_window();
    let session = window.state_mut().session_mut();
    let by = DVec2::new(0.2, -0.12);
    let [before, after] = dragged(session, 0.4, by, Modifiers::NONE);
    assert!(
        (after.position - before.position - by).length() < 1e-4,
        "{before:?} {after:?}"
    );
    assert_eq!(after.phi, before.phi);

    let design = session.known().expect("a design").evaluation.design;
    let end = on_bar(session, &before, 0.95).truncate() - before.position;
    let along = 0.12 * design.platform_radius() * end.perp().normalize();
    let [before, after] = dragged(session, 0.95, along, Modifiers::NONE);
    assert_eq!(after.position, before.position);
    let turned = end.angle_to(end + along);
    assert!((after.phi - before.phi - turned).abs() < 1e-3, "{before:?} {after:?}");

    let [before, after] = dragged(session, 0.95, along, Modifiers::SHIFT);
    assert_eq!(after.phi, before.phi);
    assert!((after.position - before.position - along).length() < 1e-4);
}

#[test]
fn a_click_on_the_platform_and_a_press_beside_it_reach_the_viewer() {
    let mut window = opened_window();
    let session = window.state_mut().session_mut();
    let mut drag = PlatformDrag::default();
    let pose = session.pose().expect("a pose");
    let at = screen(on_bar(session, &pose, 0.5));
    assert_eq!(send(&mut drag, session, vec![press(at, true, Modifiers::NONE)]), []);
    let nudge = Event::PointerMoved(at + egui::vec2(1.0, 1.0));
    assert_eq!(send(&mut drag, session, vec![nudge.clone()]), [nudge]);
    let click = [true, false].map(|pressed| press(at, pressed, Modifiers::NONE));
    assert_eq!(send(&mut drag, session, vec![press(at, false, Modifiers::NONE)]), click);
    assert_eq!(session.pose(), Some(pose));

    let beside = view().rect.left_top() + egui::vec2(5.0, 5.0);
    let away = [
        press(beside, true, Modifiers::NONE),
        Event::PointerMoved(beside + egui::vec2(50.0, 50.0)),
        press(beside, false, Modifiers::NONE),
    ];
    assert_eq!(send(&mut drag, session, away.to_vec()), away);
    assert_eq!(session.pose(), Some(pose));
}

#[test]
fn what_stops_the_platform_is_told_until_it_is_released() {
    let mut window = opened_window();
    let session = window.state_mut().session_mut();
    let mut drag = PlatformDrag::default();
    let pose = session.pose().expect("a pose");
    let held = on_bar(session, &pose, 0.4);
    let far = screen(held + DVec3::new(-60.0, 60.0, 0.0));
    send(&mut drag, session, vec![press(screen(held), true, Modifiers::NONE)]);
    send(&mut drag, session, vec![Event::PointerMoved(far)]);
    assert!(session.stopped().is_some());
    assert_ne!(session.pose(), Some(pose), "it moves as far as it reaches");
    send(&mut drag, session, vec![press(far, false, Modifiers::NONE)]);
    assert_eq!(session.stopped(), None);
}

#[test]
fn an_obstacle_is_moved_in_the_plan_and_the_study_follows() {
    let mut window = opened_window();
    window.state_mut().show(Panel::Pose);
    let design = window.state().session().known().expect("a design").evaluation.design;
    let place = DVec2::new(-0.7, 0.6) * design.base_radius();
    change_study(&mut window, |study| {
        study.requirements.clearance_min_m = Some(0.0);
        study.obstacles.push(ObstacleSection {
            name: "column".to_owned(),
            kind: RegionKind::Disc,
            centre_m: place.to_array(),
            radius_m: Some(0.1 * design.base_radius()),
            ..ObstacleSection::default()
        });
    });
    let faults: Vec<_> = window.state().session().editor().faults().cloned().collect();
    assert!(faults.is_empty(), "{faults:?}");
    window.run_steps(4);
    let pose = window.state().session().pose();
    let by = DVec2::new(0.3, -0.1) * design.base_radius();
    let plan = TopView::of(&window);
    drag(
        &mut window,
        &[0.0, 0.5, 1.0].map(|share| plan.screen(place + by * share)),
    );
    let session = window.state().session();
    let moved = DVec2::from_array(session.editor().study().obstacles[0].centre_m);
    assert!(
        (moved - place - by).length() < 2.0 / plan.scale,
        "{moved} instead of {}",
        place + by
    );
    assert_eq!(session.pose(), pose, "the platform stays where it is");
    let text = session.editor().text();
    assert!(
        text.contains("[[obstacles]]") && text.contains(&format!("{:?}", moved.x)),
        "{text}"
    );
    // One drag is one step of the history.
    window.state_mut().session_mut().editor_mut().undo();
    let obstacles = &window.state().session().editor().study().obstacles;
    assert_eq!(obstacles[0].centre_m, place.to_array());
}
