//! Strategies for random designs and poses over the whole design space: the bounds of the paper for every architecture.

use kinefront_model::clearance::{BodySettings, Layers};
use kinefront_model::dynamics::{Anywhere, DriveInertia, DynamicsSettings, Payload, Tolerances};
use kinefront_model::evaluation::{Bound, Model, ModelSettings, PoseScalar, Quantity, QuantityLimit, SizingRanges};
use kinefront_model::mechanism::{
    Architecture, Arrangement, BarLength, CrossSection, Design, FURTHER_VARIABLES, LegSettings, Wall, WorkingMode,
};
use kinefront_model::spatial::Pose;
use kinefront_model::stiffness::{RailSettings, RailSupports};
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

/// The design that a text states.
pub fn parsed(text: &str) -> Design {
    text.parse().expect("a design")
}

/// The scalars that the paper limits.
pub const PAPER_LIMITS: [PoseScalar; 4] = [
    PoseScalar::Dexterity,
    PoseScalar::StiffnessXy,
    PoseScalar::StiffnessZ,
    PoseScalar::StiffnessPhiZ,
];

/// Ranges of bars up to a radius of 0.1 m.
pub const fn bar_ranges(is_exact: bool) -> SizingRanges {
    SizingRanges {
        leg: [0.0, 0.1],
        platform: [0.0, 0.1],
        listed: [None, None],
        is_exact,
        scale: [1.0; 2],
    }
}

/// Requires that a quantity of the design is at most a number.
pub fn at_most(quantity: Quantity, most: f64) -> QuantityLimit {
    let bound = Bound::AtMost(most);
    QuantityLimit { quantity, bound }
}

/// Rails of solid bars of a radius \[m\], which bend.
pub fn round_rails(radius: f64, supports: RailSupports) -> Option<RailSettings> {
    Some(RailSettings {
        section: CrossSection::Round,
        radius,
        supports,
    })
}

pub fn working_mode() -> impl Strategy<Value = WorkingMode> {
    any::<[bool; 3]>().prop_map(WorkingMode::new)
}

/// Generates designs of every architecture, half of them with further variables that are not the defaults.
pub fn design(thinnest: f64) -> impl Strategy<Value = Design> {
    let further = (0.5..4.0, -90.0..90.0, 30.0..150.0, -180.0..180.0);
    (design_of(Architecture::ALL, thinnest), prop::option::of(further)).prop_map(|(design, further)| {
        let Some((proximal, rail, between, platform)) = further else {
            return design;
        };
        with_variables(design, [proximal, rail, between, platform])
    })
}

/// Returns the design with those further variables that its chain has.
pub fn with_variables(design: Design, values: [f64; 4]) -> Design {
    let given = FURTHER_VARIABLES
        .into_iter()
        .zip(values)
        .filter(|(variable, _)| design.architecture().has(*variable));
    given.fold(design, |design, (variable, value)| {
        design.with(variable, value).expect("a valid value")
    })
}

fn design_of(architectures: &'static [Architecture], thinnest: f64) -> impl Strategy<Value = Design> {
    let lengths = (0.5..4.0, 0.1..4.0, 0.5..4.0, thinnest..0.1, thinnest..0.1);
    let architecture = prop::sample::select(architectures);
    (architecture, working_mode(), lengths).prop_map(|(architecture, mode, (base, platform, link, leg, bar))| {
        Design::new(architecture, mode, [base, platform, link, leg, bar]).expect("a valid design")
    })
}

/// Generates settings of the legs: the defaults, or any geometry of base and platform and any travel.
pub fn leg_settings() -> impl Strategy<Value = LegSettings> {
    let around = |middle: [f64; 3], by: f64| {
        let [a, b, c] = middle;
        [a - by..a + by, b - by..b + by, c - by..c + by]
    };
    let geometry = (
        around([210.0, 330.0, 90.0], 25.0),
        around([1.0; 3], 0.25),
        around([210.0, 330.0, 90.0], 25.0),
        around([1.0; 3], 0.25),
        around([0.0; 3], 15.0),
        (-0.4..0.0, 1.0..1.3),
        (-0.6..0.0, 0.5..1.2),
    );
    let geometry = geometry.prop_map(
        |(base_angles_deg, base_radii, platform_angles_deg, platform_radii, turn, rail, guide)| Arrangement {
            base_angles_deg,
            base_radii,
            platform_angles_deg,
            platform_radii,
            rail_turn_deg: turn,
            rail: [rail.0, rail.1],
            guide: [guide.0, guide.1],
        },
    );
    (prop::option::of(geometry), any::<bool>()).prop_map(|(geometry, longest)| LegSettings {
        telescopic_bar: if longest {
            BarLength::Longest
        } else {
            BarLength::Current
        },
        geometry: geometry.unwrap_or_default().into(),
        ..LegSettings::default()
    })
}

/// Generates rails: rigid ones, or round and square ones with any supports.
pub fn rails() -> impl Strategy<Value = Option<RailSettings>> {
    let supports = prop_oneof![
        Just(RailSupports::Pinned),
        (1..6u32).prop_map(|spans| RailSupports::Clamped { spans }),
    ];
    let section = prop_oneof![
        Just(CrossSection::Round),
        Just(CrossSection::SquareTube(Wall::Ratio(0.3))),
    ];
    let rails = (section, 0.01..0.1, supports).prop_map(|(section, radius, supports)| RailSettings {
        section,
        radius,
        supports,
    });
    prop::option::of(rails)
}

pub fn pose() -> impl Strategy<Value = Pose> {
    (-2.0..2.0, -2.0..2.0, -3.2..3.2).prop_map(|(x, y, phi)| Pose::new(x, y, phi))
}

/// Generates sliders and layers: the default layers, all layers in one plane, or random layers.
pub fn bodies() -> impl Strategy<Value = BodySettings> {
    let layer = || -2.0..2.0;
    let any = (layer(), layer(), layer(), layer(), layer(), layer(), layer());
    let any = any.prop_map(
        |(platform, link, telescopic_leg, crank, slider, turning_guide, guide)| Layers {
            platform,
            link,
            telescopic_leg,
            crank,
            slider,
            turning_guide,
            guide,
        },
    );
    let layers = prop_oneof![Just(Layers::default()), Just(Layers::ONE_PLANE), any];
    (layers, 0.5..3.0, prop_oneof![Just(2.0), 2.0..6.0]).prop_map(|(layers, half_width, length)| BodySettings {
        slider_length: length * half_width,
        slider_half_width: half_width,
        layers,
        ..BodySettings::default()
    })
}

/// Generates a clearance that a study may require \[m\], or none.
pub fn clearance() -> impl Strategy<Value = Option<f64>> {
    prop::option::weighted(0.8, 0.0..0.05)
}

/// Limits everything of a motion.
pub fn limit_motion(settings: &mut ModelSettings) {
    settings.dynamics = DynamicsSettings {
        payload: Payload {
            mass: 15.0,
            inertia: 0.4,
            centre: [0.1, -0.05],
        },
        drives: DriveInertia {
            slider_mass: 3.0,
            prismatic: 5.0,
            revolute: 2.0,
        },
        gravity: [1.0, -3.0, -9.0],
        tool: [0.0; 3],
        anywhere: Anywhere {
            velocity: 1.0,
            omega: 1.0,
            acceleration: 5.0,
            alpha: 5.0,
            force: 100.0,
            moment: 10.0,
        },
        tolerances: Tolerances {
            encoder_prismatic: 1e-5,
            encoder_revolute: 3e-5,
            link: 5e-5,
            base: 5e-5,
            platform: 5e-5,
            play: 1e-5,
        },
    };
    for (scalar, limit) in [
        (PoseScalar::NaturalFrequency, 20.0),
        (PoseScalar::PositionError, 4e-4),
        (PoseScalar::OrientationError, 0.03),
        (PoseScalar::ActuatorSpeed, 3.0),
        (PoseScalar::ActuatorRate, 3.0),
        (PoseScalar::MotionForce, 4000.0),
        (PoseScalar::MotionTorque, 4000.0),
    ] {
        settings.thresholds.set(scalar, Some(limit));
    }
}
