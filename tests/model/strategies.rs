//! Random designs and poses over the whole design space of the paper.

use kinefront::mechanism::{Architecture, Design, WorkingMode};
use kinefront::spatial::Pose;
use proptest::prelude::*;

pub fn architecture() -> impl Strategy<Value = Architecture> {
    prop::sample::select(Architecture::ALL)
}

pub fn working_mode() -> impl Strategy<Value = WorkingMode> {
    any::<[bool; 3]>().prop_map(WorkingMode::new)
}

/// Designs within the paper's bounds with bar radii of at least `thinnest` \[m\].
pub fn design(thinnest: f64) -> impl Strategy<Value = Design> {
    let lengths = (0.5..4.0, 0.1..4.0, 0.5..4.0, thinnest..0.1, thinnest..0.1);
    (architecture(), working_mode(), lengths).prop_map(|(architecture, mode, (base, platform, link, leg, bar))| {
        Design::new(architecture, mode, [base, platform, link, leg, bar]).expect("a sound design")
    })
}

pub fn pose() -> impl Strategy<Value = Pose> {
    (-2.0..2.0, -2.0..2.0, -3.2..3.2).prop_map(|(x, y, phi)| Pose::new(x, y, phi))
}
