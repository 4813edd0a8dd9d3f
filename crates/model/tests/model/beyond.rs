//! Values beyond the limits of joints.

use glam::DVec2;
use kinefront_model::evaluation::{Model, PoseScalar, ScalarSet};
use kinefront_model::spatial::Rotation;

use super::strategies::parsed;

/// Where every leg reaches a pose, the values are those of the evaluation; across the end of a rail they continue smoothly, and the
/// distance from the limit changes its sign.
#[test]
fn values_continue_across_a_joint_limit() {
    let design = parsed("3-PRR R=1 r=0.3 Lb=0.9 rj=0.01 rp=0.015");
    let evaluator = Model::default().pose_evaluator(&design);
    let arms = evaluator.arms(&Rotation::new(0.3));
    let at = |x: f64| evaluator.evaluate_beyond_limits(&arms, DVec2::new(x, 0.05), ScalarSet::default());
    let reached = |x: f64| evaluator.evaluate_position(&arms, DVec2::new(x, 0.05));
    // The pose from which on a slider passes the end of its rail.
    let (mut inside, mut outside) = (0.0, 1.0);
    assert!(reached(inside).is_ok() && reached(outside).is_err());
    for _ in 0..60 {
        let middle = 0.5 * (inside + outside);
        *(if reached(middle).is_ok() {
            &mut inside
        } else {
            &mut outside
        }) = middle;
    }
    let values = reached(inside).expect("within reach");
    for scalar in [
        PoseScalar::Reach,
        PoseScalar::Dexterity,
        PoseScalar::StiffnessXy,
        PoseScalar::StiffnessZ,
    ] {
        assert_eq!(at(inside)[scalar].to_bits(), values[scalar].to_bits(), "{scalar:?}");
        let step = 1e-5;
        let [below, here, above] = [-step, 0.0, step].map(|step| at(inside + step)[scalar]);
        let bend = (below - 2.0 * here + above).abs();
        assert!(
            bend < 1e-2 * (above - below).abs().max(1e-12),
            "{scalar:?}: {below} {here} {above}"
        );
    }
    assert!(at(inside - 1e-6)[PoseScalar::Reach] > 0.0 && at(inside + 1e-6)[PoseScalar::Reach] < 0.0);
    // Far away, the inverse kinematics has no solution.
    assert!(at(9.0)[PoseScalar::Determinant].is_nan() && at(9.0)[PoseScalar::Reach] < 0.0);
}
