//! A design text and a pose text that are read have finite numbers, and the design reads back what it writes.
#![no_main]

use kinefront_model::evaluation::Model;
use kinefront_model::mechanism::{Design, WorkingMode};
use kinefront_model::spatial::Pose;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|texts: (&str, &str)| {
    let Ok(design) = Design::parse(texts.0, WorkingMode::ALL_PLUS) else { return };
    assert!(design.values().iter().all(|value| value.is_finite()));
    assert_eq!(Design::parse(&design.to_string(), WorkingMode::ALL_PLUS).expect("a design"), design);
    let Ok(pose) = texts.1.parse::<Pose>() else { return };
    if let Ok(found) = Model::default().pose(&design, &pose) {
        assert!(found.actuators.iter().all(|value| value.is_finite()));
    }
});
