//! Tests of the controls: every one has a name, designs are marked and listed, and a change of the study is undone.

use egui::accesskit::Role;
use egui::{Key, Modifiers, Pos2, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use kinefront_explorer::{Panel, StudyEditor};
use kinefront_model::evaluation::Quantity;
use kinefront_study::{BUILTIN, Column};

use super::support::{
    Window, change_study, click, copied_text, drag, edited, idle_window, opened_window, press, press_with, show, told,
    until,
};

/// Returns the controls without a name, or with a symbol alone as their name, which a screen reader cannot read.
fn nameless(window: &Window) -> Vec<String> {
    let controls = [
        Role::Button,
        Role::CheckBox,
        Role::ComboBox,
        Role::RadioButton,
        Role::Slider,
        Role::SpinButton,
        Role::TextInput,
        Role::MultilineTextInput,
        Role::Image,
    ];
    let nodes = window.root().children_recursive();
    nodes
        .filter(|node| controls.contains(&node.accesskit_node().role()))
        .filter(|node| {
            let node = node.accesskit_node();
            let name = node.label().or_else(|| node.value()).unwrap_or_default();
            let name = name.replace(['⏶', '⏷'], "");
            !name.chars().any(|letter| letter.is_alphanumeric()) && !["#", "★", "?"].contains(&name.trim())
        })
        .map(|node| format!("{node:?}"))
        .collect()
}

#[test]
fn every_control_has_a_name() {
    let mut window = opened_window();
    window.state_mut().session_mut().toggle_pin();
    for &panel in Panel::ALL.iter().filter(|panel| **panel != Panel::Scene) {
        show(&mut window, panel);
        let found = nameless(&window);
        assert!(found.is_empty(), "{}: {found:#?}", panel.title());
    }
    assert!(window.query_all_by_role(Role::Button).count() > 20);
}

/// The Tab key reaches the controls of every area, and a ring shows where it is until the mouse is used.
#[test]
fn the_tab_key_reaches_every_area_and_a_ring_shows_where() {
    let mut window = opened_window();
    assert_eq!(window.state().focus_ring(), None);
    let mut reached = std::collections::BTreeSet::new();
    for _ in 0..800 {
        press(&mut window, Key::Tab);
        let focused = window
            .root()
            .children_recursive()
            .find(|node| node.accesskit_node().is_focused());
        let Some(focused) = focused else { continue };
        let ring = window.state().focus_ring();
        // What is scrolled out of view has no ring, and the cells of a table report no rectangle.
        let is_cell = focused.accesskit_node().role() == Role::GenericContainer;
        let is_around = |ring: egui::Rect| focused.rect().expand(1.0).contains_rect(ring);
        assert!(is_cell || ring.is_none_or(is_around), "{focused:?}: {ring:?}");
        if ring.is_some() {
            reached.extend(focused.accesskit_node().label());
        }
    }
    for name in [
        "File",
        "Fit",
        "▶ Start",
        "Copy",
        "Home",
        "Copy table",
        "starred only",
        "pose x",
    ] {
        assert!(reached.contains(name), "{name} is not among {reached:?}");
    }
    let start = window.get_by_label_contains("Home").rect().center();
    window.hover_at(start);
    window.drag_at(start);
    window.run_steps(2);
    assert_eq!(window.state().focus_ring(), None);
}

#[test]
fn designs_in_a_box_are_marked_counted_listed_and_filtered() {
    let mut window = opened_window();
    let ids: Vec<usize> = window.state().session().front().iter().map(|entry| entry.id).collect();
    let wanted = &ids[1..4];
    let places: Vec<Pos2> = wanted
        .iter()
        .map(|&id| window.state().scatter_position(id).expect("a position"))
        .collect();
    let around = places
        .iter()
        .fold(egui::Rect::NOTHING, |rect, &at| {
            rect.union(egui::Rect::from_min_size(at, vec2(0.0, 0.0)))
        })
        .expand(1.5);
    click(&mut window, "Box");
    drag(
        &mut window,
        &[around.left_top(), around.center(), around.right_bottom()],
    );
    let marked = window.state().session().document().marked.clone();
    assert!(wanted.iter().all(|id| marked.contains(id)), "{wanted:?} in {marked:?}");
    assert!(marked.len() < window.state().session().store().len(), "not all designs");
    assert!(marked.is_sorted());
    let counts = window.state().session().count_marked();
    assert_eq!(counts.all, marked.len());
    assert_eq!(counts.of.iter().map(|(_, count)| count).sum::<usize>(), marked.len());
    assert!(counts.on_front >= wanted.len() && counts.feasible >= counts.on_front);
    assert!(window.query_by_label(&format!("{} marked", marked.len())).is_some());

    // The table lists them, and copies them for a spreadsheet.
    window.get_by_label(&format!("Marked ({})", marked.len())).click();
    window.run_steps(3);
    window.get_by_label("Copy table").click();
    window.step();
    let copied = copied_text(&window).expect("a copied table");
    let lines: Vec<Vec<&str>> = copied.lines().map(|line| line.split('\t').collect()).collect();
    assert_eq!(lines[0][..4], ["id", "architecture", "working_mode", "mass_kg"]);
    assert_eq!(lines.len(), 1 + marked.len());
    assert!(lines.iter().all(|line| line.len() == lines[0].len()));
    let masses: Vec<f64> = lines[1..].iter().map(|line| line[3].parse().expect("a mass")).collect();
    assert!(masses.is_sorted(), "sorted by mass: {masses:?}");

    // The filter takes their ranges, and undo takes both back.
    click(&mut window, "Filter");
    let filter = &window.state().session().document().filter;
    let range = filter.range(Column::Quantity(Quantity::Mass));
    assert_eq!(range, Some([masses[0], masses[masses.len() - 1]]));
    for _ in 0..2 {
        press_with(&mut window, Modifiers::COMMAND, Key::Z);
    }
    let document = window.state().session().document();
    assert!(document.marked.is_empty() && document.filter.is_empty());
}

#[test]
fn a_lasso_marks_what_it_surrounds() {
    let mut window = opened_window();
    let front = window.state().session().front();
    let id = front[front.len() / 2].id;
    let at = window.state().scatter_position(id).expect("a position");
    let count = window.state().session().store().len();
    let near: Vec<usize> = (0..count)
        .filter(|&other| {
            let place = window.state().scatter_position(other);
            place.is_some_and(|place| place.distance(at) < 9.5)
        })
        .collect();
    click(&mut window, "Lasso");
    let corner = |k: usize| {
        let angle = std::f32::consts::TAU * k as f32 / 12.0;
        at + 9.0 * vec2(angle.cos(), angle.sin())
    };
    let path: Vec<Pos2> = (0..12).map(corner).collect();
    drag(&mut window, &path);
    let marked = window.state().session().document().marked.clone();
    assert!(marked.contains(&id), "{marked:?}");
    assert!(
        marked.iter().all(|other| near.contains(other)),
        "{marked:?} in {near:?}"
    );
}

#[test]
fn the_table_shows_the_columns_that_are_chosen() {
    let mut window = opened_window();
    show(&mut window, Panel::Front);
    assert!(window.query_by_role_and_label(Role::Button, "margin g3").is_none());
    click(&mut window, "Columns");
    window.get_by_role_and_label(Role::CheckBox, "margin g3").click();
    window.run_steps(3);
    press(&mut window, Key::Escape);
    window
        .get_by_role_and_label(Role::Button, "margin g3")
        .click_accesskit();
    window.run_steps(3);
    assert!(window.query_by_label_contains("margin g3 ⏶").is_some(), "sorted by it");
}

#[test]
fn a_change_of_the_study_is_undone_and_a_new_study_begins_from_an_example() {
    let mut window = idle_window();
    *window.state_mut().session_mut().editor_mut() = StudyEditor::paper();
    show(&mut window, Panel::Study);
    assert!(told(&window, "Lengths R, r, L_b of the 3-PRR").is_some());
    change_study(&mut window, |study| study.optimizer.seed = 77);
    window.run_steps(2);
    press_with(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(edited(&window).optimizer.seed, 1);
    click(&mut window, "Redo");
    assert_eq!(edited(&window).optimizer.seed, 77);

    click(&mut window, "File");
    window.get_by_label("New study from an example").click();
    // A picture is made in a frame.
    window.run_steps(BUILTIN.len() + 2);
    let other = BUILTIN
        .iter()
        .find(|builtin| builtin.name == "alignment-stage")
        .expect("a study");
    let study = other.study().expect("a valid study");
    let words = format!("Edit the study {}: {}", other.name, study.description);
    // It is below the visible part of the list.
    window.get_by_role_and_label(Role::Button, &words).click_accesskit();
    window.run_steps(3);
    // The study that was edited is in view.
    assert!(window.query_by_label_contains("Save study").is_some());
    assert_eq!(edited(&window).name, other.name);
}

#[test]
fn the_progress_of_a_run_states_the_time_that_designs_take() {
    let mut window = idle_window();
    click(&mut window, "▶ Start");
    until(&mut window, "the run ends", |explorer| !explorer.session().is_running());
    let session = window.state().session();
    let times = session.generation_times();
    assert_eq!(times.len(), session.generations().len());
    assert!(times.is_sorted() && times[times.len() - 1] > std::time::Duration::ZERO);
    assert!(times[times.len() - 1] <= session.elapsed());
    // A run that was opened states none.
    let opened = opened_window();
    assert!(opened.state().session().generation_times().is_empty());
}
