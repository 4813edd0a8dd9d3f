//! Tests of the data that the window sends to the embedded viewer.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use egui_kittest::kittest::Queryable as _;
use glam::DVec2;
use kinefront_explorer::{Pointed, describe};
use kinefront_model::evaluation::{GridChoice, Model, PoseScalar};
use kinefront_model::mechanism::{Design, WorkingMode};
use kinefront_recording::{LiveScene, Picked, Pinned, Shown, VisibleLayers};
use kinefront_scene::{EllipsoidKind, Field, Heatmap, workspace_proof};
use kinefront_study::BUILTIN;
use rerun::external::arrow::array::Array as _;
use rerun::log::{Chunk, LogMsg};
use rerun::sink::CallbackSink;

use super::support::{Window, opened_window};

/// Number of instances in the largest component of each entity, as sent last.
type Standing = BTreeMap<String, usize>;

fn scene() -> (LiveScene, Arc<Mutex<Standing>>) {
    let standing: Arc<Mutex<Standing>> = Arc::default();
    let seen = Arc::clone(&standing);
    let sink = CallbackSink::new(move |messages| {
        for message in messages {
            let LogMsg::ArrowMsg(store, message) = message else {
                continue;
            };
            if store.kind() != rerun::StoreKind::Recording {
                continue;
            }
            let chunk = Chunk::from_arrow_msg(message).expect("a chunk");
            assert!(
                chunk.is_static() || chunk.entity_path().to_string().starts_with("/__"),
                "{}",
                chunk.entity_path()
            );
            let components = chunk.components();
            // The fill mode of solids is sent even if there are no solids.
            let largest = components
                .component_descriptors()
                .zip(components.list_arrays())
                .filter(|(descriptor, _)| !descriptor.component.ends_with("fill_mode"))
                .map(|(_, list)| list.value(0).len())
                .max()
                .unwrap_or(0);
            seen.lock()
                .expect("a lock")
                .insert(chunk.entity_path().to_string(), largest);
        }
    });
    let study = BUILTIN[0].study().expect("a valid study");
    (LiveScene::new(Box::new(sink), &study).expect("a scene"), standing)
}

fn design(text: &str) -> Design {
    Design::parse(text, WorkingMode::ALL_PLUS).expect("a design")
}

/// Returns the entities below a path that show something.
fn shown(standing: &Mutex<Standing>, below: &str) -> Vec<String> {
    // The sink runs on its own thread.
    std::thread::sleep(std::time::Duration::from_millis(300));
    let standing = standing.lock().expect("a lock");
    let entities = standing
        .iter()
        .filter(|(entity, count)| entity.starts_with(below) && **count > 0);
    entities.map(|(entity, _)| entity.clone()).collect()
}

#[test]
fn what_is_no_longer_drawn_disappears() {
    let (mut scene, standing) = scene();
    let model = Model::default();
    let evaluation = model.evaluate(
        &design("3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056"),
        GridChoice::Reference,
    );
    let proof = workspace_proof(&model, &evaluation, &|| true).expect("a workspace");
    let mut layers = VisibleLayers {
        ellipsoids: Some(EllipsoidKind::Stiffness),
        proof: true,
        ..VisibleLayers::default()
    };
    let show = |scene: &mut LiveScene, layers: &VisibleLayers| {
        let shown = Shown {
            model: &model,
            evaluation: &evaluation,
            proof: Some(&proof),
            path: None,
            pose: None,
            heatmap_phi: None,
            layers,
            light: false,
        };
        scene.design(Some(&shown)).expect("drawn")
    };
    // The window draws the legend; a locked range holds for its own field alone.
    let legend = show(&mut scene, &layers).field.expect("a legend");
    assert_eq!((legend.field, legend.threshold), (Field::DEXTERITY, 0.1));
    assert!(shown(&standing, "/design/legend").is_empty());
    layers.locked = Some((Field::Scalar(PoseScalar::StiffnessXy), [1e5, 1e7]));
    assert_eq!(show(&mut scene, &layers).field, Some(legend));
    layers.locked = Some((Field::DEXTERITY, [0.0, 0.5]));
    let locked = show(&mut scene, &layers).field.expect("a legend");
    assert_eq!(locked.map.range(), [0.0, 0.5]);
    assert_eq!(locked.map.color(0.5), locked.map.color(0.9));
    layers.stresses = true;
    let stress = show(&mut scene, &layers).stress.expect("a legend of the stresses");
    let report = model
        .posed(&evaluation.design)
        .strength_at(&model.home(&evaluation), None);
    let report = report.expect("a pose").expect("a report");
    assert_eq!(stress.largest, report.stress);
    layers.stresses = false;
    assert_eq!(show(&mut scene, &layers).stress, None);
    for below in [
        "/design/heatmap/inverse_condition/field",
        "/design/ellipsoids/stiffness",
        "/design/manipulator/legs",
        "/design/proof/boxes",
        "/design/proof/violation",
        "/configuration/proof/boxes",
        "/configuration",
    ] {
        assert!(!shown(&standing, below).is_empty(), "{below} is not drawn");
    }
    layers.heatmap = None;
    layers.ellipsoids = None;
    layers.legs = false;
    layers.configuration = false;
    show(&mut scene, &layers);
    for below in [
        "/design/heatmap/inverse_condition",
        "/design/legend",
        "/design/ellipsoids",
        "/design/manipulator/legs",
        "/configuration",
    ] {
        assert_eq!(shown(&standing, below), Vec::<String>::new());
    }
    assert!(!shown(&standing, "/design/manipulator/platform").is_empty());
    assert!(
        !shown(&standing, "/design/heatmap/outlines").is_empty(),
        "the outlines are not drawn, although they do not depend on the heatmap"
    );
    scene.design(None).expect("drawn");
    assert_eq!(shown(&standing, "/design"), Vec::<String>::new());
}

#[test]
fn pins_stand_side_by_side_and_what_is_picked_is_known() {
    let (mut scene, standing) = scene();
    let model = Model::default();
    let evaluations: Vec<_> = [
        "3-PRR R=3 r=1.2 Lb=1.9 rj=0.03 rp=0.05",
        "3-RRR R=2 r=0.5 Lb=1.5 rj=0.04 rp=0.05",
    ]
    .into_iter()
    .map(|text| model.evaluate(&design(text), GridChoice::Reference))
    .collect();
    let pins: Vec<Pinned<'_>> = evaluations
        .iter()
        .map(|evaluation| Pinned { evaluation, name: "a" })
        .collect();
    scene.pins(&model, &pins).expect("drawn");
    assert!(!shown(&standing, "/pins/1/manipulator").is_empty());
    scene.pins(&model, &pins[..1]).expect("drawn");
    assert!(!shown(&standing, "/pins/0/manipulator").is_empty());
    assert_eq!(shown(&standing, "/pins/1"), Vec::<String>::new());

    let at = DVec2::new(0.1, -0.2);
    assert_eq!(
        LiveScene::picked("/scatter/plot/front/designs", Some(7), at),
        Some(Picked::Front(7))
    );
    assert_eq!(
        LiveScene::picked("/pins/1/manipulator/legs", None, at),
        Some(Picked::Pin(1))
    );
    assert_eq!(LiveScene::picked("/design/manipulator/legs", Some(2), at), None);
    assert_eq!(
        LiveScene::picked("/design/heatmap/k_xy/field", Some(0), at),
        Some(Picked::Position(at))
    );
}

/// Pointing at the scene tells what is there, with its numbers; a click on the heatmap moves the platform.
#[test]
fn what_the_pointer_is_over_is_told_in_words_and_numbers() {
    let mut window = opened_window();
    let told = |window: &Window, entity: &str, instance: u64, at: DVec2| {
        let pointed = Pointed {
            entity: entity.to_owned(),
            instance: Some(instance),
            at,
        };
        describe(window.state().session(), &pointed)
    };
    let session = window.state().session();
    let (model, known) = (session.model().clone(), session.known().expect("a design").clone());
    let (design, home) = (known.evaluation.design, session.home().expect("a home"));

    let at = DVec2::new(0.02, -0.01);
    let field = told(&window, "/design/heatmap/inverse_condition/field", 0, at).expect("a field");
    let pose = kinefront_model::spatial::Pose {
        position: at,
        phi: home.phi,
    };
    let value = Heatmap::value_at(&model, &design, Field::DEXTERITY, &pose).expect("reached");
    let found = model.pose(&design, &pose).expect("reached").values[PoseScalar::Dexterity];
    assert!((value - found).abs() < 1e-12);
    assert_eq!(
        field.passes,
        model
            .settings()
            .thresholds
            .get(PoseScalar::Dexterity)
            .map(|limit| value >= limit)
    );
    assert!(
        field.title.ends_with(&kinefront_scene::text::number(value)),
        "{}",
        field.title
    );
    assert!(field.lines[0].contains("threshold 0.1"), "{:?}", field.lines);
    assert_eq!(told(&window, "/design/heatmap/k_xy/field", 0, DVec2::splat(1e3)), None);

    // Each bar that is drawn is a member, with its own leg.
    let mut legs = Vec::new();
    for instance in 0..3 {
        let bar = told(&window, "/design/manipulator/platform", instance, at).expect("a bar");
        assert!(bar.lines.iter().any(|line| line.contains("radius")), "{bar:?}");
        legs.push(bar.title);
    }
    assert_eq!(legs, [1, 2, 3].map(|leg| format!("platform bar of leg {leg}")));
    assert_eq!(told(&window, "/design/manipulator/platform", 3, at), None);
    let workspace = told(&window, "/design/workspace/outline", 0, at).expect("the workspace");
    let radius = kinefront_scene::text::number(known.evaluation.workspace_radius());
    assert!(workspace.lines[0].contains(&radius), "{workspace:?}");
    let ellipsoid = told(&window, "/design/ellipsoids/stiffness/bodies", 0, at).expect("an ellipsoid");
    assert!(ellipsoid.lines[0].contains("N/m"), "{ellipsoid:?}");
    assert!(told(&window, "/design/heatmap/k_xy/singular", 0, at).is_some());
    assert_eq!(told(&window, "/design/manipulator/labels", 0, at), None);

    window.state_mut().session_mut().select_picked(Picked::Position(at));
    let moved = window.state().session().pose().expect("a pose");
    assert!((moved.position - at).length() < 1e-12 && moved.phi == home.phi);
}

/// The status bar tells the study, the designs and the selected one; the window's actions are buttons with names.
#[test]
fn the_status_bar_tells_what_is_shown() {
    let window = opened_window();
    let session = window.state().session();
    let designs = format!(
        "{} designs, {} on the front",
        session.store().len(),
        session.front().len()
    );
    window.get_by_label(&designs);
    let study = format!("{}: opened", session.study().name);
    window.get_by_label(&study);
    window.get_by_label_contains("selected: #");
}
