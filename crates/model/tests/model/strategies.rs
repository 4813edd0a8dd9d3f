//! Strategies for random designs and poses over the whole design space of the paper.

use kinefront_model::clearance::{BodySettings, Layers};
use kinefront_model::evaluation::{Model, ModelSettings};
use kinefront_model::mechanism::{Architecture, Design, WorkingMode};
use kinefront_model::spatial::Pose;
use proptest::prelude::*;

/// A property over the part of the design space where it applies: `cases` designs and poses that it applies to, or the test
/// fails.
pub fn applicable_cases(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        max_global_rejects: 200 * cases,
        ..ProptestConfig::default()
    }
}

/// The paper's model with some settings changed.
pub fn model(change: impl FnOnce(&mut ModelSettings)) -> Model {
    let mut settings = ModelSettings::default();
    change(&mut settings);
    Model::new(settings).expect("the grids fit the rotation range")
}

pub fn architecture() -> impl Strategy<Value = Architecture> {
    prop::sample::select(Architecture::ALL)
}

pub fn working_mode() -> impl Strategy<Value = WorkingMode> {
    any::<[bool; 3]>().prop_map(WorkingMode::new)
}

/// Generates designs within the paper's bounds, with bar radii of at least `thinnest` \[m\].
pub fn design(thinnest: f64) -> impl Strategy<Value = Design> {
    let lengths = (0.5..4.0, 0.1..4.0, 0.5..4.0, thinnest..0.1, thinnest..0.1);
    (architecture(), working_mode(), lengths).prop_map(|(architecture, mode, (base, platform, link, leg, bar))| {
        Design::new(architecture, mode, [base, platform, link, leg, bar]).expect("a valid design")
    })
}

pub fn pose() -> impl Strategy<Value = Pose> {
    (-2.0..2.0, -2.0..2.0, -3.2..3.2).prop_map(|(x, y, phi)| Pose::new(x, y, phi))
}

/// Generates sliders and layers: the default layers, all layers in one plane, or random layers.
pub fn bodies() -> impl Strategy<Value = BodySettings> {
    let layer = || -2.0..2.0;
    let any = (layer(), layer(), layer(), layer(), layer());
    let any = any.prop_map(|(platform, link, telescopic_leg, crank, slider)| Layers {
        platform,
        link,
        telescopic_leg,
        crank,
        slider,
    });
    let layers = prop_oneof![Just(Layers::default()), Just(Layers::ONE_PLANE), any];
    (layers, 0.5..3.0, prop_oneof![Just(2.0), 2.0..6.0]).prop_map(|(layers, half_width, length)| BodySettings {
        slider_length: length * half_width,
        slider_half_width: half_width,
        layers,
    })
}

/// Generates a clearance that a study may require \[m\], or none.
pub fn clearance() -> impl Strategy<Value = Option<f64>> {
    prop::option::weighted(0.8, 0.0..0.05)
}
