//! Natural frequencies, errors and stresses of the selected design at its pose.

use egui_kittest::kittest::Queryable as _;
use kinefront_explorer::{Panel, ShownVibration};

use kinefront_scene::text::member as member_words;

use super::support::{Window, change_study, click, opened_window, press, set_slider, show, type_into};

fn shown(window: &Window) -> Option<ShownVibration> {
    window.state().session().view().vibration
}

/// Selecting a frequency bends the bars as a slow motion, which pauses, and the payload of the study being edited lowers the frequencies at
/// once.
#[test]
fn a_vibration_is_played_and_follows_the_payload() {
    let mut window = opened_window();
    show(&mut window, Panel::Vibration);
    assert_eq!(shown(&window), None);
    let frequencies = |window: &mut Window| {
        let known = window.state_mut().session_mut().pose_dynamics().cloned();
        let modes = known
            .and_then(|known| known.vibrations)
            .expect("vibrations")
            .modes
            .clone();
        modes.iter().map(|mode| mode.frequency).collect::<Vec<_>>()
    };
    let before = frequencies(&mut window);
    assert_eq!(before.len(), 6);
    assert!(before.is_sorted());
    // A symmetric design has pairs of equal frequencies.
    let names: Vec<String> = before
        .iter()
        .map(|frequency| format!("{} Hz", kinefront_scene::text::number(*frequency)))
        .collect();
    let is_single = |place: &usize| names.iter().filter(|name| **name == names[*place]).count() == 1;
    let place = (0..6).find(is_single).expect("a single frequency");
    click(&mut window, &names[place]);
    let first = shown(&window).expect("a vibration");
    assert_eq!(first.mode, place);
    let mut shares = Vec::new();
    for _ in 0..90 {
        window.step();
        shares.push(shown(&window).expect("a vibration").share);
    }
    // A second and a half is a whole vibration: the bars bend both ways.
    let most = shares.iter().fold(0.0, |most: f64, share| most.max(*share));
    let least = shares.iter().fold(0.0, |least: f64, share| least.min(*share));
    assert!(most > 0.07 && least < -0.07, "{least} to {most}");
    click(&mut window, "Pause");
    let still = shown(&window);
    window.run_steps(5);
    assert_eq!(shown(&window), still);
    change_study(&mut window, |study| study.payload.mass_kg = 500.0);
    window.run_steps(2);
    let after = frequencies(&mut window);
    // A mass at P moves with neither the tilts nor the turn.
    let lower = after
        .iter()
        .zip(&before)
        .filter(|(after, before)| **after < 0.999 * **before);
    assert_eq!(lower.count(), 3, "{before:?} and {after:?}");
    click(&mut window, "Hide");
    assert_eq!(shown(&window), None);
}

/// Tolerances that are stated in the panel have their errors at once, each source with its part.
#[test]
fn errors_follow_the_tolerances() {
    let mut window = opened_window();
    show(&mut window, Panel::Accuracy);
    window.get_by_label("Set tolerances to compute the pose errors:");
    change_study(&mut window, |study| {
        study.tolerances.encoder_m = 1e-5;
        study.tolerances.encoder_rad = 1e-5;
        study.tolerances.link_m = 5e-5;
    });
    window.run_steps(2);
    let report = window
        .state_mut()
        .session_mut()
        .pose_dynamics()
        .and_then(|known| known.report);
    let accuracy = report.expect("a report").accuracy;
    let budget = accuracy.budget_position;
    assert_eq!((budget.base, budget.platform, budget.play), (0.0, 0.0, 0.0));
    assert!(budget.encoders > 0.0 && budget.links > budget.encoders);
    let percent = 100.0 * budget.links / accuracy.worst_position;
    let words = format!(
        "links: {} mm, {percent:.0} %",
        kinefront_scene::text::number(1e3 * budget.links)
    );
    window.get_by_label(&words);
    assert!(window.query_by_label_contains("platform: ").is_none());
    window.get_by_label_contains("Error ellipse");
}

/// A wrench that is set and turned in the panel gives the stresses of the bars, names the bar that buckles first, and is drawn.
#[test]
fn stresses_follow_a_wrench_that_is_turned() {
    let mut window = opened_window();
    show(&mut window, Panel::Strength);
    let wrench = |window: &Window| window.state().session().view().layers.wrench;
    let report = |window: &Window| {
        let session = window.state().session();
        let (known, pose) = (session.known().expect("a design"), session.pose().expect("a pose"));
        let posed = session.model().posed(&known.evaluation.design);
        let report = posed.strength_at(&pose, session.view().layers.wrench);
        report.expect("reached").expect("a report")
    };
    let check = |window: &Window| {
        let report = report(window);
        for member in &report.members {
            let stress = kinefront_scene::text::number(1e-6 * member.stress);
            window.get_by_label_contains(&format!("{}: {stress} MPa", member_words(&member.member)));
        }
        let factor = |member: &&kinefront_model::strength::MemberStrength| member.buckling_factor.expect("a factor");
        let first = report.members.iter().min_by(|a, b| factor(a).total_cmp(&factor(b)));
        let name = member_words(&first.expect("a bar").member);
        window.get_by_label_contains(&format!("The {name} is nearest to buckling"));
        report.stress
    };
    assert_eq!(wrench(&window), None);
    let of_study = check(&window);
    click(&mut window, "under one wrench, drawn as arrows at P");
    assert_eq!(wrench(&window), Some([100.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
    assert!(check(&window) <= of_study);
    type_into(&mut window, "force along z", "-250");
    press(&mut window, egui::Key::Enter);
    set_slider(&mut window, "direction", 90.0);
    window.run_steps(3);
    let [x, y, z, ..] = wrench(&window).expect("a wrench");
    assert!(x.abs() < 1e-9 && (y - 100.0).abs() < 1e-9 && z == -250.0, "{x} {y} {z}");
    check(&window);
    click(&mut window, "under the loads of the study, in their worst directions");
    assert_eq!(wrench(&window), None);
    assert_eq!(check(&window), of_study);
}
