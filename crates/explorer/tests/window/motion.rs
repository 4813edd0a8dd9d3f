//! The motion of the study, followed by the selected design.

use egui_kittest::kittest::Queryable as _;
use kinefront_explorer::Panel;
use kinefront_model::spatial::Pose;
use kinefront_scene::PathColor;
use kinefront_study::TaskShapeChoice;

use super::support::{Window, change_study, click, click_at, edited, opened_window, set_slider, show, told, until};

/// Opens a window with the panel and a path that is chosen in it.
fn window_with(path: &str) -> Window {
    let mut window = opened_window();
    show(&mut window, Panel::Motion);
    click(&mut window, path);
    until_followed(&mut window);
    window
}

fn until_followed(window: &mut Window) {
    // The panel asks when it is drawn; before that, the last answer stands.
    window.run_steps(2);
    until(window, "the motion is followed", |explorer| {
        explorer.session().is_answered()
    });
}

fn pose(window: &Window) -> Pose {
    window.state().session().pose().expect("a pose")
}

fn waypoints(window: &Window) -> Vec<[f64; 3]> {
    edited(window).task.waypoints.clone().expect("waypoints")
}

#[test]
fn a_time_of_the_cursor_is_a_pose_of_the_path() {
    let mut window = window_with("Pick and place");
    let task = edited(&window).task.clone();
    assert_eq!(
        (task.shape, task.cycle_time_s),
        (Some(TaskShapeChoice::PickAndPlace), Some(2.0))
    );
    let evaluation = window.state().session().known().expect("known").evaluation.clone();
    let home = window.state().session().home().expect("a home pose");
    let radius = evaluation.workspace_radius();
    // The stroke takes half of the cycle, from 0.8 R_w on one side to 0.8 R_w on the other.
    for (time, along) in [(0.5, 0.0), (1.0, 0.8), (1.5, 0.0), (2.0, -0.8)] {
        set_slider(&mut window, "time", time);
        window.run_steps(2);
        let arm = pose(&window).position - home.position;
        assert!(
            (arm.x - along * radius).abs() < 1e-3 * radius && arm.y.abs() < 1e-9,
            "at {time} s {arm} from the centre instead of {along} R_w"
        );
    }
    // In equal steps of time the platform goes from rest to rest.
    let before = pose(&window);
    window.get_by_label("Play").click();
    window.run_steps(12);
    assert!(pose(&window).position.distance(before.position) > 1e-6 * radius);
    click(&mut window, "Pause");
    let rest = pose(&window);
    window.run_steps(6);
    assert_eq!(pose(&window), rest);
}

#[test]
fn waypoints_are_added_by_the_pose_and_by_clicks() {
    let mut window = window_with("Waypoints");
    let first = waypoints(&window);
    assert_eq!(first.len(), 2);
    let home = pose(&window);
    let moved = Pose {
        position: home.position + glam::DVec2::new(0.0, 0.01),
        phi: home.phi + 0.02,
    };
    window.state_mut().session_mut().view_mut().pose = Some(moved);
    window.run_steps(2);
    click(&mut window, "Add the pose");
    let with_pose = waypoints(&window);
    let [x, y, phi_deg] = with_pose[2];
    assert!((x - moved.position.x).abs() < 1e-6 && (y - moved.position.y).abs() < 1e-6);
    assert!((phi_deg - moved.phi.to_degrees()).abs() < 1e-6);

    window.state_mut().show(Panel::Pose);
    click(&mut window, "Draw");
    // The middle of the plan view is the centre of the base.
    let view = window.get_by_label("Top view").rect();
    click_at(&mut window, view.center() + egui::vec2(6.0, 0.0));
    let drawn = waypoints(&window);
    assert_eq!(drawn.len(), 4, "{drawn:?}");
    assert!(drawn[3][0] > 0.0 && drawn[3][1].abs() < 1e-3, "{:?}", drawn[3]);
    // Each is a step of its own that can be undone.
    window.state_mut().session_mut().editor_mut().undo();
    assert_eq!(waypoints(&window), with_pose);
    window.state_mut().session_mut().editor_mut().undo();
    assert_eq!(waypoints(&window), first);
}

#[test]
fn a_path_that_is_too_large_tells_where_it_ends() {
    let mut window = window_with("Circle");
    assert!(told(&window, "cycle 2.000 s").is_some());
    for field in window.state().session().fields() {
        window.state_mut().session_mut().view_mut().layers.path = Some(PathColor::Field(field));
        window.run_steps(2);
        let answer = window.state_mut().session_mut().motion().expect("an answer");
        let followed = answer.as_ref().as_ref().expect("no error").as_ref().expect("a motion");
        let [low, high] = followed.path.as_ref().expect("a path with colours").range;
        assert!(low <= high, "{field:?}: {low} to {high}");
    }
    change_study(&mut window, |study| study.task.share = 40.0);
    until_followed(&mut window);
    assert!(told(&window, "the motion ends in piece 1").is_some());
    click(&mut window, "No motion");
    assert_eq!(edited(&window).task.shape, None);
    assert!(window.query_by_label("Pick and place").is_some());
}

#[test]
fn limits_take_the_place_of_the_time_of_a_cycle() {
    let mut window = window_with("Star");
    click(&mut window, "set v max [m/s]");
    let task = edited(&window).task.clone();
    assert_eq!((task.cycle_time_s, task.v_max_m_per_s), (None, Some(1.0)));
    click(&mut window, "set v max [m/s]");
    let task = edited(&window).task.clone();
    assert_eq!((task.cycle_time_s, task.v_max_m_per_s), (Some(2.0), None));
    assert!(window.state().session().editor().text_fault().is_none());
}
