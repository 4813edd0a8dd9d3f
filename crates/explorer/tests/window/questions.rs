//! The window with other questions than the paper's: objectives, limits, and designs in three quantities.

use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use kinefront_explorer::Panel;
use kinefront_model::evaluation::{PoseScalar, Quantity};
use kinefront_study::{Column, ObjectiveChoice, Study};

use super::support::{
    Window, click, click_at, content, edited, idle_window, press, selected, show, small_study, told, type_into,
    type_keys, until, window,
};

/// Opens a window and runs the small study with other objectives.
fn run(objectives: &[(&str, &str)]) -> Window {
    let choice = |(goal, key): &(&str, &str)| match *goal {
        "minimize" => ObjectiveChoice::Minimize((*key).to_owned()),
        _ => ObjectiveChoice::Maximize((*key).to_owned()),
    };
    let mut study = Study {
        objectives: objectives.iter().map(choice).collect(),
        references: Vec::new(),
        ..small_study()
    };
    study.optimizer.evaluations = 120;
    study.workspace.certify = false;
    let mut window = window(content(study, true));
    until(&mut window, "the front is verified", |explorer| {
        let session = explorer.session();
        !session.is_running() && !session.front().is_empty() && session.front().iter().all(|entry| entry.verified)
    });
    window
}

#[test]
fn three_objectives_have_axes_colour_buttons_and_a_space_that_is_clicked() {
    let mut window = run(&[
        ("minimize", "mass_kg"),
        ("maximize", "k_xy_n_per_m"),
        ("minimize", "footprint_m"),
    ]);
    let k_xy = Column::Quantity(Quantity::Worst(PoseScalar::StiffnessXy));
    let axes = window.state().scatter_axes().map(<(String, bool)>::from);
    assert_eq!(axes, [("mass_kg".to_owned(), true), ("value_g4".to_owned(), true)]);
    let coloring = window.get_by_role_and_label(Role::ComboBox, "colour");
    let told = coloring.accesskit_node().value().unwrap_or_default();
    assert!(told.contains("footprint"), "{told}");

    show(&mut window, Panel::Choose);
    for (button, quantity, largest) in [
        ("Lightest", Column::Quantity(Quantity::Mass), false),
        ("Largest k_xy", k_xy, true),
        (
            "Smallest footprint",
            Column::Quantity(Quantity::Worst(PoseScalar::Footprint)),
            false,
        ),
    ] {
        click(&mut window, button);
        let (session, selected) = (window.state().session(), selected(&window).design);
        let value = |entry: &kinefront_explorer::FrontEntry| entry.row.number(quantity).expect("a value");
        let best = session.front().iter().map(value).fold(
            if largest { f64::NEG_INFINITY } else { f64::INFINITY },
            |best, value| if largest { best.max(value) } else { best.min(value) },
        );
        let found = session.front().iter().find(|entry| entry.row.design == selected);
        assert_eq!(found.map(value), Some(best), "{button}");
    }
    for name in ["mass", "k_xy", "footprint"] {
        let label = format!("Weight of the {name}");
        assert!(
            window.query_by_role_and_label(Role::Slider, &label).is_some(),
            "{label}"
        );
    }

    show(&mut window, Panel::Space);
    let space = window
        .get_by_role_and_label(Role::Image, "Designs in three quantities")
        .rect();
    let before = selected(&window);
    // Somewhere in the panel a click meets another design of the front.
    'places: for row in 5..25 {
        for column in 2..28 {
            let at = space.min + space.size() * egui::vec2(column as f32 / 30.0, row as f32 / 30.0);
            click_at(&mut window, at);
            if selected(&window) != before {
                break 'places;
            }
        }
    }
    assert_ne!(selected(&window), before, "no click selected a design");
}

#[test]
fn one_objective_has_a_single_best_design() {
    let mut window = run(&[("minimize", "platform_mass_kg")]);
    assert_eq!(window.state().session().front().len(), 1);
    show(&mut window, Panel::Choose);
    click(&mut window, "Smallest mass of the platform");
    assert!(window.state().session().document().selected.is_some());
}

#[test]
fn the_question_is_edited_where_the_study_is() {
    let mut window = idle_window();
    show(&mut window, Panel::Study);
    click(&mut window, "Add an objective");
    let keys = |window: &Window| -> Vec<String> {
        let choices = edited(window).objectives.iter();
        choices.map(|choice| choice.key().to_owned()).collect()
    };
    assert_eq!(keys(&window), ["mass_kg", "workspace_radius_m", "footprint_m"]);
    let text = window.state().session().editor().text().to_owned();
    assert!(text.contains("footprint_m"), "{text}");
    click(&mut window, "maximize");
    assert_eq!(
        edited(&window).objectives[1],
        ObjectiveChoice::Minimize("workspace_radius_m".to_owned())
    );
}

/// A number is taken as a whole: neither half of it nor what follows an invalid half is.
#[test]
fn numbers_are_typed_into_the_fields_of_the_study() {
    let mut window = idle_window();
    show(&mut window, Panel::Study);
    let dexterity = |window: &Window| edited(window).requirements.inverse_condition_min;
    let retype = |window: &mut Window, text: &str| type_into(window, "inverse condition min", text);
    // As it is typed, nothing is taken; "0." and "1" would both be refused.
    retype(&mut window, "0.25");
    assert_eq!(dexterity(&window), 0.1);
    press(&mut window, egui::Key::Enter);
    assert_eq!(dexterity(&window), 0.25);
    assert!(window.state().session().editor().faults().next().is_none());
    // Escape restores.
    retype(&mut window, "0.7");
    press(&mut window, egui::Key::Escape);
    assert_eq!(dexterity(&window), 0.25);
    // A number out of range is refused when it is complete, and the field shows what the study holds.
    retype(&mut window, "7");
    press(&mut window, egui::Key::Enter);
    assert_eq!(dexterity(&window), 0.25);
    assert!(told(&window, "inverse_condition_min").is_some());
}

/// The text view keeps its cursor while what is typed is invalid for a time.
#[test]
fn text_is_typed_into_the_study_as_fast_as_keys_come() {
    let mut window = idle_window();
    show(&mut window, Panel::Study);
    click(&mut window, "Text");
    let at = window.get_by_label("Study text").rect().left_top() + egui::vec2(30.0, 8.0);
    click_at(&mut window, at);
    window.run_steps(2);
    window.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Home);
    window.step();
    let line = "constraints = { footprint_m = { at_most = 1.25 }, dexterity = { at_least = 0.35 } } # ";
    let typed = line.repeat(2);
    let once = typed.replace("# constraints", "# Constraints");
    type_keys(&mut window, &once);
    window.run_steps(3);
    let text = window.state().session().editor().text().to_owned();
    assert!(text.starts_with(&once), "{}", &text[..once.len().min(text.len())]);
}
