//! The path of a motion, and vibrations.

use kinefront_model::dynamics::{MotionLaw, Task, TaskShape, TaskTiming};
use kinefront_model::evaluation::{GridChoice, Model, PoseScalar};
use kinefront_model::spatial::Pose;
use kinefront_scene::{Field, MotionPath, PathColor, Vibrations, pose_at};

use super::{DESIGNS, design};

/// The path of a motion has the colours of what its actuators do, and its poses in time.
#[test]
fn the_path_of_a_motion_has_its_poses_and_values() {
    let task = Task {
        shape: TaskShape::Star,
        share: 0.8,
        angle: 0.0,
        closed: true,
        law: MotionLaw::Quintic,
        dwell: 0.1,
        samples: 200,
        timing: TaskTiming::Cycle(4.0),
    };
    let model = Model::default();
    let design = design(DESIGNS[1]);
    let evaluation = model.evaluate(&design, GridChoice::Reference);
    let (outcome, samples) = model.follow(&evaluation, &task);
    let figures = outcome.result.expect("a motion").expect("followed to its end");
    let path = |color| MotionPath::new(&model, &design, &samples, color).expect("a path");
    let forces = path(PathColor::FORCE);
    let largest = figures.peak_force.iter().fold(0.0f64, |most, force| most.max(*force));
    assert!((forces.range[1] - largest).abs() < 1e-12 * largest);
    assert_eq!(forces.poses.len(), forces.colors.len());
    let kappa = path(PathColor::Field(Field::DEXTERITY));
    let own = |pose: &Pose| model.pose(&design, pose).expect("reached").values[PoseScalar::Dexterity];
    let least = kappa.poses.iter().map(own).fold(f64::INFINITY, f64::min);
    assert!(
        (kappa.range[0] - least).abs() < 1e-9,
        "{} instead of {least}",
        kappa.range[0]
    );

    // Between two samples the platform is on a straight line, and before and after the motion at its ends.
    let [first, second] = [samples[40], samples[41]].map(|sample| sample.instant);
    let between = pose_at(&samples, 0.5 * (first.time + second.time)).expect("a pose");
    assert!(
        between
            .position
            .distance(first.pose.position.midpoint(second.pose.position))
            < 1e-12
    );
    assert_eq!(pose_at(&samples, -1.0), Some(samples[0].instant.pose));
    assert_eq!(pose_at(&samples, 1e3), samples.last().map(|sample| sample.instant.pose));
    assert_eq!(pose_at(&[], 0.0), None);
}

/// Bars that vibrate bend about where they are, and the point that moves most moves by the amplitude.
#[test]
fn vibrations_bend_the_bars_by_their_amplitude() {
    let model = Model::default();
    for text in [
        "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056",
        "3-RPR R=2.0 r=0.5 Lb=3.0 rj=0.03 rp=0.03",
        "3-RRR R=2.0 r=0.6 Lb=1.6 rj=0.05 rp=0.04",
    ] {
        let design = design(text);
        let evaluation = model.evaluate(&design, GridChoice::Reference);
        let posed = model.posed(&design);
        let dynamics = posed
            .dynamics_at(&model.home(&evaluation))
            .expect("reached")
            .expect("regular");
        let report = dynamics.report().expect("regular");
        let vibrations = Vibrations::new(&model, &design, &dynamics, &report).expect("vibrations");
        let lowest = report.lowest_frequency().expect("known");
        assert!((vibrations.modes[0].frequency - lowest).abs() <= 1e-12 * lowest);
        assert_eq!(vibrations.modes.iter().filter(|mode| mode.is_in_plane).count(), 3);
        let rest = vibrations.bent(0, 0.0);
        for mode in 0..6 {
            let (bent, back) = (vibrations.bent(mode, 0.1), vibrations.bent(mode, -0.1));
            let mut most = 0.0f64;
            for ((bent, back), rest) in bent.iter().zip(&back).zip(&rest) {
                for ((bent, back), rest) in bent.points.iter().zip(&back.points).zip(&rest.points) {
                    most = most.max(bent.distance(*rest));
                    assert!((*bent + *back - 2.0 * *rest).length() < 1e-12, "{text}");
                    let moves_up = (bent.z - rest.z).abs() > 1e-12;
                    assert!(!moves_up || !vibrations.modes[mode].is_in_plane, "{text}");
                }
            }
            assert!((most - 0.1).abs() < 1e-12, "{text}: mode {mode} moves by {most}");
        }
    }
}
