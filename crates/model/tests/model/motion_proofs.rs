//! Proofs of motions, compared with motions that are sampled densely.

use glam::DVec2;
use kinefront_model::certify::{MotionClaim, MotionVerdict};
use kinefront_model::dynamics::{DynamicsSettings, MotionLaw, Task, TaskFrame, TaskShape, TaskTiming};
use kinefront_model::evaluation::{Model, ModelSettings, PoseScalar, Quantity, TaskOutcome, largest_of_legs};
use kinefront_model::mechanism::{Architecture, Design, JointKind};
use kinefront_model::spatial::Pose;
use kinefront_testkit::{numbers as random_numbers, repetitions};

use super::legs::{cases, model as model_of};
use super::motion::{DRIVES, PAYLOAD};
use super::reference::{design, pose as pose_of};
use super::strategies::at_most;

const TRAPEZOID: MotionLaw = MotionLaw::Trapezoid { blend: 0.3, ramp: 0.2 };

/// A motion to one side of a pose and back, that turns the platform on the way.
fn sideways(pose: &Pose, reach: f64, law: MotionLaw, samples: usize) -> Task {
    let at = |x: f64, y: f64, turn: f64| {
        let position = pose.position + reach * DVec2::new(x, y);
        [position.x, position.y, pose.phi + reach * turn]
    };
    Task {
        shape: TaskShape::Waypoints(vec![at(-1.0, 0.2, -0.4), at(0.9, 0.5, 0.5), at(0.1, -1.0, 0.0)]),
        share: 0.5,
        angle: 0.4,
        closed: true,
        law,
        dwell: 0.05,
        samples,
        timing: TaskTiming::Cycle(2.0),
    }
}

fn sampled(task: &Task, samples: usize) -> Task {
    Task {
        samples,
        ..task.clone()
    }
}

/// The frame of a circle about a pose.
fn about(pose: &Pose, reach: f64, design: &Design) -> TaskFrame {
    TaskFrame {
        centre: pose.position,
        radius: 2.0 * reach,
        polygon: None,
        home_phi: pose.phi,
        half_range: 0.1,
        lever: design.platform_radius(),
    }
}

fn follow(model: &Model, design: &Design, task: &Task, frame: &TaskFrame) -> TaskOutcome {
    model.posed(design).follow(task, frame).0
}

fn moving(model: &mut ModelSettings) {
    model.dynamics = DynamicsSettings {
        payload: PAYLOAD,
        drives: DRIVES,
        gravity: [0.0, -9.81, 0.0],
        tool: [20.0, -10.0, 3.0],
        ..DynamicsSettings::default()
    };
}

/// Calls a function for one design of each architecture, with a pose of the fixture that is far from singularities and joint limits, and
/// the reach of a motion about it \[m\].
fn for_all(mut check: impl FnMut(&Model, &Design, &Pose, f64)) {
    let cases = cases("poses");
    for &architecture in Architecture::ALL {
        let poses = cases.iter().filter_map(|case| {
            let (design, pose) = (design(case), pose_of(case));
            let model = model_of(case, moving);
            let values = model.pose(&design, &pose).ok()?.values;
            let room = values[PoseScalar::Reach];
            let clear = (room / design.base_radius()).min(0.05);
            let key = clear.min(values[PoseScalar::Dexterity]);
            (design.architecture() == architecture).then_some((key, room, model, design, pose))
        });
        let best = poses.max_by(|a, b| a.0.total_cmp(&b.0));
        let (_, room, model, design, pose) = best.unwrap_or_else(|| panic!("no pose of {}", architecture.name()));
        check(&model, &design, &pose, (0.1 * room).min(0.02 * design.base_radius()));
    }
}

#[test]
fn a_proved_motion_keeps_its_bounds_at_every_moment() {
    let mut proved = 0;
    for_all(|model, design, pose, reach| {
        let frame = about(pose, reach, design);
        for law in [MotionLaw::Quintic, TRAPEZOID] {
            let sideways = sideways(pose, reach, law, 50);
            let circle = Task {
                shape: TaskShape::Circle,
                ..sideways.clone()
            };
            for task in [sideways, circle] {
                let outcome = follow(model, design, &task, &frame);
                let name = format!("{design} along {:?} by {law:?}", task.shape);
                assert!(outcome.figures().is_some(), "{name}: {outcome:?}");
                let found = model.certify_motion(design, &outcome).expect("a motion");
                let dense = follow(model, design, &sampled(&task, 3000), &frame);
                let figures = dense.figures().expect("figures");
                let path_reach = figures.path_reach;
                let bounds = *found.verdict.bounds().unwrap_or_else(|| panic!("{name}: {found:?}"));
                proved += 1;
                for (bound, peak) in [
                    (bounds.speed, largest_of_legs(figures.peak_speed)),
                    (bounds.force, largest_of_legs(figures.peak_force)),
                ] {
                    assert!(bound >= peak * (1.0 - 1e-12), "{name}: {bound} is passed by {peak}");
                    assert!(bound <= peak * 1.004, "{name}: {bound} is far above {peak}");
                }
                assert!(bounds.reach <= path_reach + 1e-12, "{name}: {bounds:?} {path_reach}");
                assert!(bounds.reach >= path_reach * 0.998, "{name}: {bounds:?} {path_reach}");
            }
        }
    });
    assert_eq!(proved, 4 * Architecture::ALL.len());
}

#[test]
fn what_happens_between_the_samples_is_found() {
    for_all(|model, design, pose, reach| {
        let frame = about(pose, reach, design);
        // So few samples miss the middle of each piece, where the motion is fastest.
        let points = match sideways(pose, reach, MotionLaw::Quintic, 3).shape {
            TaskShape::Waypoints(points) => points[..2].to_vec(),
            other => panic!("{other:?}"),
        };
        let rough = Task {
            shape: TaskShape::Waypoints(points),
            closed: false,
            ..sideways(pose, reach, MotionLaw::Quintic, 3)
        };
        let quantity = match design.architecture().actuator() {
            JointKind::Prismatic => Quantity::PathSpeed,
            JointKind::Revolute => Quantity::PathRate,
        };
        let fine = follow(model, design, &sampled(&rough, 3000), &frame);
        let peak = largest_of_legs(fine.figures().expect("figures").peak_speed);
        for (limit, is_kept) in [(0.999 * peak, false), (1.001 * peak, true)] {
            let mut settings = model.settings().clone();
            settings.limits = vec![at_most(quantity, limit)];
            let limited = Model::new(settings).expect("a model");
            let outcome = follow(&limited, design, &rough, &frame);
            let found = limited.certify_motion(design, &outcome).expect("a motion");
            match found.verdict {
                MotionVerdict::Proved(_) => assert!(is_kept, "{design}: {limit} of {peak}"),
                MotionVerdict::Refuted(moment) => {
                    assert!(!is_kept, "{design}: {limit} of {peak}");
                    assert_eq!(moment.claim, MotionClaim::Limit(quantity));
                }
                MotionVerdict::Open(moment) => panic!("{design}: {moment:?}"),
            }
        }
    });
}

#[test]
fn no_motion_is_proved_that_a_dense_sampling_refutes() {
    let mut random = random_numbers(3);
    let [mut refuted, mut proved, mut open] = [0; 3];
    for_all(|model, design, pose, _| {
        let frame = about(pose, 0.1 * design.base_radius(), design);
        for _ in 0..repetitions(75, 1000) {
            let mut somewhere = || {
                let mut spread = |by: f64| by * (2.0 * random() - 1.0);
                let by = 0.9 * design.base_radius();
                [
                    pose.position.x + spread(by),
                    pose.position.y + spread(by),
                    pose.phi + spread(0.8),
                ]
            };
            let straight = Task {
                shape: TaskShape::Waypoints(vec![somewhere(), somewhere()]),
                closed: false,
                ..sideways(pose, 0.0, MotionLaw::Quintic, 3)
            };
            let outcome = follow(model, design, &straight, &frame);
            if outcome.figures().is_none() {
                continue;
            }
            let dense = sampled(&straight, 1000);
            let is_followed = follow(model, design, &dense, &frame).figures().is_some();
            let found = model.certify_motion(design, &outcome).expect("a motion");
            match found.verdict {
                MotionVerdict::Proved(_) => {
                    assert!(is_followed, "{design} does not follow {dense:?}");
                    proved += 1;
                }
                MotionVerdict::Refuted(moment) | MotionVerdict::Open(moment) if !is_followed => {
                    assert!(!matches!(moment.claim, MotionClaim::Limit(_)), "{design}: {moment:?}");
                    refuted += 1;
                }
                _ => open += 1,
            }
        }
    });
    assert!(
        refuted >= 2 && proved >= 50 && open <= proved / 20,
        "{refuted} {proved} {open}"
    );
}
