//! Models with other definitions and other limits than the paper's.

use glam::DVec2;
use kinefront_model::clearance::{Layers, Obstacle, ObstacleShape, Stacking, Surroundings};
use kinefront_model::evaluation::{Model, ModelSettings, PoseScalar};
use kinefront_model::kinematics::CharacteristicLength;
use kinefront_model::mechanism::{CrossSection, CylinderSize, JointSizes, Wall};
use kinefront_model::polygon::Polygon;
use kinefront_model::stiffness::{RailSupports, StiffnessDefinition};
use kinefront_model::strength::{LoadShape, Loads};

use crate::strategies::{limit_motion, model, round_rails};

/// The model whose characteristic length depends on which orientations are reached.
pub const ISOTROPIC: &str = "the isotropic characteristic length";

/// What changes the paper's model into another one.
type Change = fn(&mut ModelSettings);

/// Models with other definitions than the paper's, and with a required clearance.
const OTHER_MODELS: [(&str, Change); 14] = [
    ("the paper's definitions", |_| {}),
    ("stiffness as the reciprocal of a compliance", |settings| {
        settings.stiffness_definition = StiffnessDefinition::Compliance;
    }),
    (ISOTROPIC, |settings| {
        settings.characteristic_length = CharacteristicLength::Isotropic;
    }),
    ("a clearance in the layers by default", require_clearance),
    ("a clearance in one plane", |settings| {
        require_clearance(settings);
        settings.bodies.layers = Layers::ONE_PLANE;
    }),
    ("a limit of the transmission", |settings| {
        settings.thresholds.set(PoseScalar::Transmission, Some(0.3));
    }),
    (
        "a limit of the displacement, on rails that are pinned at their ends",
        |settings| {
            settings.thresholds.set(PoseScalar::Displacement, Some(2e-4));
            settings.rails = round_rails(0.06, RailSupports::Pinned);
        },
    ),
    ("rails in three clamped spans", |settings| {
        settings.rails = round_rails(0.06, RailSupports::Clamped { spans: 3 });
    }),
    (
        "stiffness as the reciprocal of a compliance, on rails that are pinned at their ends",
        |settings| {
            settings.stiffness_definition = StiffnessDefinition::Compliance;
            settings.rails = round_rails(0.06, RailSupports::Pinned);
        },
    ),
    ("limits of the strength under a cylinder of wrenches", limit_strength),
    (
        "limits of the strength of square tubes in an upright plane, under an ellipsoid of wrenches",
        |settings| {
            limit_strength(settings);
            settings.sections.legs = CrossSection::SquareTube(Wall::Ratio(0.2));
            settings.loads = Loads {
                wrench: [20.0, -30.0, 10.0, 2.0, -3.0, 4.0],
                range: [80.0, 60.0, 100.0, 5.0, 4.0, 10.0],
                shape: LoadShape::Ellipsoid,
                gravity: [1.0, -9.0, 3.0],
            };
        },
    ),
    ("a clearance beside obstacles in a room", |settings| {
        require_clearance(settings);
        settings.surroundings = post_and_beam_in_a_room();
    }),
    (
        "limits of a motion with a payload beside P, in an inclined plane",
        limit_motion,
    ),
    (
        "a clearance of joints with a size in layers that are chosen",
        |settings| {
            require_clearance(settings);
            settings.bodies.stacking = Stacking::Chosen;
            settings.joint_sizes = JointSizes {
                revolute: CylinderSize {
                    radius: 0.06,
                    height: 0.1,
                },
                motor: CylinderSize {
                    radius: 0.09,
                    height: 0.2,
                },
            };
        },
    ),
];

/// One of the models, with its name.
pub fn other_model(place: usize) -> (&'static str, Model) {
    let (name, change) = OTHER_MODELS[place];
    (name, model(change))
}

/// All of them.
pub fn other_models() -> impl Iterator<Item = (&'static str, Model)> {
    (0..OTHER_MODELS.len()).map(other_model)
}

fn require_clearance(settings: &mut ModelSettings) {
    settings.thresholds.set(PoseScalar::Clearance, Some(0.005));
}

/// Limits everything that depends on loads that both kinds of drives have.
fn limit_strength(settings: &mut ModelSettings) {
    settings.material.yield_strength = Some(2.35e8);
    for (scalar, limit) in [
        (PoseScalar::Stress, 1e8),
        (PoseScalar::SafetyFactor, 2.0),
        (PoseScalar::BucklingFactor, 3.0),
        (PoseScalar::JointForce, 1500.0),
        (PoseScalar::JointMoment, 800.0),
    ] {
        settings.thresholds.set(scalar, Some(limit));
    }
}

fn post_and_beam_in_a_room() -> Surroundings {
    let corners = |half: [f64; 2], at: [f64; 2]| {
        let [x, y] = half;
        let rectangle = Polygon::rectangle(2.0 * x, 2.0 * y).expect("a rectangle");
        rectangle.mapped(|corner| corner + DVec2::from_array(at))
    };
    Surroundings {
        obstacles: vec![
            Obstacle {
                name: "post".into(),
                shape: ObstacleShape::Disc {
                    centre: DVec2::new(1.0, 0.7),
                    radius: 0.08,
                },
                heights: [f64::NEG_INFINITY, f64::INFINITY],
            },
            Obstacle {
                name: "beam".into(),
                shape: ObstacleShape::Polygon(corners([0.05, 0.4], [-1.1, 0.6])),
                heights: [0.03, 1.0],
            },
        ],
        room: Some(corners([3.6, 3.8], [0.0, 0.0])),
    }
}
