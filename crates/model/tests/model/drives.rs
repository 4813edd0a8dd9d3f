//! The drive that a design selects is the lightest one that carries its motion, as each drive by itself tells it.

use kinefront_model::dynamics::{Drive, DriveCatalogue, MotionLaw, Task, TaskShape, TaskTiming};
use kinefront_model::evaluation::{
    Evaluation, GridChoice, Model, ModelSettings, Quantity, TaskFigures, largest_of_legs,
};
use kinefront_model::mechanism::{Design, JointKind, JointMasses};
use kinefront_testkit::numbers as random_numbers;

use super::strategies::{at_most, parsed};

/// Designs with motors on the base, at the elbow and at the platform, that slide and that turn.
const DESIGNS: [&str; 6] = [
    "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056",
    "3-RRR R=2.0 r=0.6 Lb=1.6 rj=0.05 rp=0.04",
    "3-R_RR R=2.25 r=0.74 Lb=1.52 rj=0.040 rp=0.060",
    "3-RR_R R=1.64 r=0.77 Lb=1.42 rj=0.051 rp=0.058",
    "3-RPR R=2.0 r=0.5 Lb=3.0 rj=0.03 rp=0.03",
    "3-RP_R R=1.00 r=0.84 Lb=1.63 rj=0.053 rp=0.052",
];

fn settings() -> ModelSettings {
    let mut settings = ModelSettings {
        joints: JointMasses {
            revolute: 0.5,
            carriage: 1.0,
            motor: 3.0,
        },
        task: Some(Task {
            shape: TaskShape::Star,
            share: 0.5,
            angle: 0.2,
            closed: true,
            law: MotionLaw::Quintic,
            dwell: 0.05,
            samples: 60,
            timing: TaskTiming::Cycle(3.0),
        }),
        limits: vec![at_most(Quantity::DriveUtilization, 1.0)],
        quantities: [Quantity::DriveMass, Quantity::DriveUtilization].into_iter().collect(),
        ..ModelSettings::default()
    };
    settings.dynamics.payload.mass = 15.0;
    settings.dynamics.gravity = [0.0, -9.81, 0.0];
    settings
}

/// Returns what a drive by itself gives: the figures of the motion with its mass and inertia, and the mass in motion.
fn alone(design: &Design, drive: &Drive) -> (TaskFigures, f64) {
    let mut settings = settings();
    settings.limits.clear();
    settings.joints.motor = drive.mass;
    settings.dynamics.drives.prismatic = drive.inertia;
    settings.dynamics.drives.revolute = drive.inertia;
    let model = Model::new(settings).expect("a model");
    let evaluation = model.evaluate(design, GridChoice::Reference);
    assert!(evaluation.drive.is_none());
    let (outcome, _) = model.follow_task(&evaluation).expect("a motion");
    (
        outcome.result.expect("a motion").expect("it is followed"),
        evaluation.mass(),
    )
}

fn utilization(drive: &Drive, figures: &TaskFigures) -> f64 {
    let shares = [
        largest_of_legs(figures.peak_force) / drive.peak,
        largest_of_legs(figures.rms_force) / drive.rated,
        largest_of_legs(figures.peak_speed) / drive.speed,
    ];
    shares.into_iter().fold(0.0, f64::max)
}

/// Drives of any size, of which a quarter are of the other kind.
fn random_drives(random: &mut impl FnMut() -> f64, kind: JointKind, force: f64, speed: f64) -> DriveCatalogue {
    let drive = |place: usize| {
        let size = 0.05 + 3.0 * random() * random();
        Drive {
            name: format!("drive {place}"),
            kind: if place % 4 == 3 { other(kind) } else { kind },
            rated: force * size,
            peak: force * size * (1.5 + random()),
            speed: speed * (0.8 + random()),
            inertia: 3.0 * size * random(),
            mass: 0.2 + 10.0 * size * random(),
        }
    };
    DriveCatalogue::new((0..12).map(drive).collect()).expect("a catalogue")
}

/// Asserts that the parts that are ordered name the drive that was selected, and that their masses sum to that of the design.
fn assert_ordered(model: &Model, evaluation: &Evaluation, drive: &Drive, mass: f64) {
    let parts = model.parts(&evaluation.design, evaluation.drive);
    let ordered = parts.iter().find_map(|part| part.drive.as_ref());
    assert_eq!(ordered, evaluation.drive.map(|_| &drive.name));
    if evaluation.drive.is_some() {
        let counted = parts.iter().filter(|part| part.counts);
        let total: f64 = counted.map(|part| part.total_mass()).sum();
        assert!(
            (total - mass).abs() <= 1e-12 * mass,
            "{}: {total} kg",
            evaluation.design
        );
    }
}

#[test]
fn the_lightest_drive_that_carries_the_motion_is_selected() {
    let mut random = random_numbers(7);
    let (mut counts, mut reserved) = ([0; 2], 0);
    for text in DESIGNS {
        let design = parsed(text);
        let kind = design.architecture().actuator();
        let needed = alone(&design, &light(kind)).0;
        let force = largest_of_legs(needed.rms_force);
        let speed = largest_of_legs(needed.peak_speed);
        for round in 0..4 {
            // Weak ones, strong ones, and those of the other kind, which must not be selected. None of the last round is strong enough.
            let weakness = if round == 3 { 0.05 } else { 1.0 };
            // The study may leave a reserve.
            let allowed = if round == 1 || round == 2 { 0.8 } else { 1.0 };
            let catalogue = random_drives(&mut random, kind, weakness * force, speed);
            let model = Model::new(ModelSettings {
                drive_catalogue: catalogue.clone(),
                limits: vec![at_most(Quantity::DriveUtilization, allowed)],
                ..settings()
            })
            .expect("a model");
            let evaluation = model.evaluate(&design, GridChoice::Reference);
            let try_alone = |(place, drive)| {
                let (figures, mass) = alone(&design, drive);
                (place, utilization(drive, &figures), mass)
            };
            let tried: Vec<(usize, f64, f64)> = catalogue.of_kind(kind).map(try_alone).collect();
            let wanted = tried.iter().find(|(_, used, _)| *used <= allowed);
            let without_reserve = tried.iter().find(|(_, used, _)| *used <= 1.0);
            reserved += usize::from(wanted.is_some() && wanted != without_reserve);
            let least = tried.iter().min_by(|a, b| a.1.total_cmp(&b.1)).expect("drives");
            // One that carries the motion without the reserve is selected, but does not make the design feasible.
            let selected = wanted.or(Some(least).filter(|(_, used, _)| *used <= 1.0));
            let selected = selected.map(|(place, ..)| *place);
            assert_eq!(evaluation.drive, selected, "{design}: {tried:?}");
            assert_eq!(evaluation.is_feasible(), wanted.is_some(), "{design}");
            let found = evaluation.quantities.get(Quantity::DriveUtilization).expect("a number");
            let (place, used, mass) = wanted.unwrap_or(least);
            assert!(
                (found - used).abs() <= 1e-9 * used,
                "{design}: {found} instead of {used}"
            );
            let drive = catalogue.get(*place).expect("a drive");
            assert_eq!(evaluation.quantities.get(Quantity::DriveMass), Some(drive.mass));
            assert!((evaluation.mass() - mass).abs() <= 1e-12 * mass, "{design}: {mass}");
            counts[usize::from(wanted.is_some())] += 1;
            assert_ordered(&model, &evaluation, drive, *mass);
            // What follows the motion afterwards does so with the same drive.
            let (outcome, samples) = model.follow_task(&evaluation).expect("a motion");
            assert_eq!(outcome.drive.expect("a drive").place, *place);
            let driven = model.driven_by(Some(*place));
            let (_, again) = driven.follow_task(&evaluation).expect("a motion");
            assert_eq!(samples, again);
        }
    }
    assert!(counts.iter().all(|count| *count >= 4), "{counts:?}");
    assert!(reserved > 0, "no reserve has changed a selection");
}

/// A drive that weighs next to nothing.
fn light(kind: JointKind) -> Drive {
    Drive {
        name: "light".to_owned(),
        kind,
        rated: 1.0,
        peak: 1.0,
        speed: 1.0,
        inertia: 0.0,
        mass: 1e-6,
    }
}

fn other(kind: JointKind) -> JointKind {
    match kind {
        JointKind::Prismatic => JointKind::Revolute,
        JointKind::Revolute => JointKind::Prismatic,
    }
}

/// In the shortest cycle all limits are kept, and a cycle that is a little shorter misses the one that sets it.
#[test]
fn the_shortest_cycle_just_keeps_the_limits() {
    let mut set_by = Vec::new();
    for text in DESIGNS {
        let design = parsed(text);
        let (speed, force) = match design.architecture().actuator() {
            JointKind::Prismatic => (Quantity::PathSpeed, Quantity::PathForce),
            JointKind::Revolute => (Quantity::PathRate, Quantity::PathTorque),
        };
        // Limits that the cycle of 3 s keeps, and such that it does not.
        let (now, _) = alone(&design, &light(design.architecture().actuator()));
        let at = [now.peak_speed, now.peak_force].map(largest_of_legs);
        for limits in [
            vec![at_most(speed, 0.6 * at[0])],
            vec![
                at_most(speed, 4.0 * at[0]),
                at_most(force, 3.0 * at[1]),
                at_most(Quantity::CornerPower, 2.0 * at[0] * at[1]),
            ],
            vec![
                at_most(Quantity::CycleEnergy, 1.5 * now.energy_shared),
                at_most(speed, 20.0 * at[0]),
            ],
        ] {
            let with = |time: f64| {
                let mut settings = settings();
                settings.quantities = limits.iter().map(|limit| limit.quantity).collect();
                settings.limits.clone_from(&limits);
                settings.task.as_mut().expect("a motion").timing = TaskTiming::Cycle(time);
                Model::new(settings).expect("a model")
            };
            let model = with(3.0);
            let evaluation = model.evaluate(&design, GridChoice::Reference);
            let shortest = model.shortest_cycle(&evaluation).expect("a cycle");
            set_by.push(shortest.limit.quantity);
            let margin = |time: f64| {
                let found = with(time).evaluate(&design, GridChoice::Reference);
                let margins = found.limits.iter().map(|result| result.margin);
                let of_it = found.limits.iter().find(|result| result.limit == shortest.limit);
                (margins.fold(f64::INFINITY, f64::min), of_it.expect("a limit").margin)
            };
            let (least, _) = margin(shortest.time);
            assert!(least >= 0.0, "{design}: {shortest:?} misses a limit by {least}");
            let (_, missed) = margin(0.9999 * shortest.time);
            assert!(missed < 0.0, "{design}: {shortest:?} could be shorter: {missed}");
        }
        // Without a limit there is no shortest cycle, and none keeps a force below the one that gravity asks for.
        for limits in [Vec::new(), vec![at_most(force, 1e-3)]] {
            let mut settings = settings();
            settings.limits = limits;
            let model = Model::new(settings).expect("a model");
            let evaluation = model.evaluate(&design, GridChoice::Reference);
            assert_eq!(model.shortest_cycle(&evaluation), None);
        }
    }
    for quantity in [Quantity::PathSpeed, Quantity::PathRate, Quantity::CycleEnergy] {
        assert!(set_by.contains(&quantity), "{quantity:?} is among {set_by:?}");
    }
}
