//! A design text and, on the next line, a pose text that are read have finite numbers, and the design reads back what it writes.

use kinefront_model::evaluation::Model;
use kinefront_model::mechanism::{Design, WorkingMode};
use kinefront_model::spatial::Pose;

pub fn check(text: &str) {
    let (design, pose) = text.split_once('\n').unwrap_or((text, ""));
    let Ok(design) = Design::parse(design, WorkingMode::ALL_PLUS) else {
        return;
    };
    assert!(design.values().iter().all(|value| value.is_finite()));
    assert_eq!(
        Design::parse(&design.to_string(), WorkingMode::ALL_PLUS).expect("a design"),
        design
    );
    let model = Model::default();
    assert!(model.mass(&design).is_finite());
    let Ok(pose) = pose.parse::<Pose>() else { return };
    if let Ok(found) = model.pose(&design, &pose) {
        assert!(found.actuators.iter().all(|value| value.is_finite()));
    }
}
