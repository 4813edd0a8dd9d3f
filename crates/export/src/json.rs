//! All data of a design as JSON. Keys are a contract: new ones may be added, none may be renamed.

use serde::Serialize;

use super::dynamics::DynamicsJson;
use super::format::{AnyError, Contents, Format};
use super::pose::PoseJson;
use super::prepared::{Prepared, kind_name};
use super::wire::{EvaluationJson, PoseReportJson};
use kinefront_model::spatial::Pose;
use kinefront_model::stiffness::Material;
use kinefront_scene::{Body, Linkage};

pub(super) const FORMAT: Format = Format {
    key: "json",
    file: "design.json",
    name: "JSON",
    title: "JSON, all data",
    lost: None,
    contents: Contents::Text,
    write,
};

/// The output of `kinefront export --format json`.
#[derive(Debug, Serialize)]
struct ExportJson<'a> {
    kinefront_version: &'static str,
    study: &'a str,
    design: String,
    evaluation: EvaluationJson,
    pose: PoseJson,
    at_pose: PoseReportJson,
    material: MaterialJson,
    actuator: ActuatorJson,
    bodies: Vec<BodyJson<'a>>,
    closures: Vec<ClosureJson<'a>>,
    tour: Vec<TourJson>,
}

#[derive(Debug, Serialize)]
struct MaterialJson {
    youngs_modulus_pa: f64,
    shear_modulus_pa: f64,
    density_kg_per_m3: f64,
    yield_strength_pa: Option<f64>,
}

impl From<&Material> for MaterialJson {
    fn from(material: &Material) -> Self {
        Self {
            youngs_modulus_pa: material.youngs_modulus,
            shear_modulus_pa: material.shear_modulus,
            density_kg_per_m3: material.density,
            yield_strength_pa: material.yield_strength,
        }
    }
}

#[derive(Debug, Serialize)]
struct ActuatorJson {
    kind: &'static str,
    unit: &'static str,
    /// Stiffness \[N/m or N·m/rad\].
    stiffness: f64,
}

#[derive(Debug, Serialize)]
struct FrameJson {
    x_m: f64,
    y_m: f64,
    angle_rad: f64,
}

#[derive(Debug, Serialize)]
struct JointJson {
    kind: &'static str,
    actuated: bool,
    value: f64,
    limits: Option<[f64; 2]>,
}

#[derive(Debug, Serialize)]
struct BarJson {
    from_m: [f64; 2],
    to_m: [f64; 2],
    radius_m: f64,
    /// Inner radius, or half of the inner width; 0 for a solid bar.
    inner_radius_m: f64,
    /// Shape of the cross-section: `round` or `square`.
    section: &'static str,
    mass_kg: f64,
}

/// Elements of the inertia tensor about the centre of mass, in the body's axes; `xy` is `−∫xy dm`.
#[derive(Debug, Serialize)]
struct InertiaJson {
    xx: f64,
    yy: f64,
    zz: f64,
    xy: f64,
}

#[derive(Debug, Serialize)]
struct BodyJson<'a> {
    name: &'a str,
    /// `base`, the name of a body, or `None` for the platform.
    parent: Option<&'a str>,
    /// Frame of the body in the base frame.
    frame: FrameJson,
    /// Height of the bars above the plane of the frames.
    height_m: f64,
    joint: Option<JointJson>,
    mass_kg: f64,
    centre_of_mass_m: [f64; 2],
    inertia_kg_m2: InertiaJson,
    bars: Vec<BarJson>,
}

impl<'a> BodyJson<'a> {
    fn new(linkage: &'a Linkage, body: &'a Body) -> Self {
        let [xx, yy, zz, xy] = body.inertia();
        Self {
            name: &body.name,
            parent: match body.parent {
                Some(parent) => Some(&linkage.bodies[parent].name),
                None => body.joint.map(|_| "base"),
            },
            frame: FrameJson {
                x_m: body.frame.origin.x,
                y_m: body.frame.origin.y,
                angle_rad: body.frame.angle,
            },
            height_m: body.height,
            joint: body.joint.map(|joint| JointJson {
                kind: kind_name(joint.kind),
                actuated: joint.actuated,
                value: joint.value,
                limits: joint.limits,
            }),
            mass_kg: body.mass(),
            centre_of_mass_m: body.centre_of_mass().to_array(),
            inertia_kg_m2: InertiaJson { xx, yy, zz, xy },
            bars: body
                .bars
                .iter()
                .map(|bar| BarJson {
                    from_m: bar.from.to_array(),
                    to_m: bar.to.to_array(),
                    radius_m: bar.radius,
                    inner_radius_m: bar.inner_radius,
                    section: if bar.is_square { "square" } else { "round" },
                    mass_kg: bar.mass,
                })
                .collect(),
        }
    }
}

#[derive(Debug, Serialize)]
struct ClosureJson<'a> {
    name: String,
    leg_body: &'a str,
    on_leg_m: [f64; 2],
    on_platform_m: [f64; 2],
    /// Whether the body cannot turn in the platform.
    rigid: bool,
}

#[derive(Debug, Serialize)]
struct TourJson {
    #[serde(flatten)]
    pose: PoseJson,
    actuators: Option<[f64; 3]>,
}

fn write(subject: &Prepared) -> Result<Vec<u8>, AnyError> {
    let Prepared {
        study,
        evaluation,
        model,
        pose,
        linkage,
        ..
    } = subject;
    let design = &evaluation.design;
    let posed = model.posed(design);
    let at = |pose: &Pose| posed.at(pose);
    let strength = posed.strength_at(pose, None).ok().flatten();
    let dynamics = posed.dynamics_at(pose).ok().flatten();
    let dynamics = dynamics.and_then(|dynamics| DynamicsJson::new(&dynamics, None));
    let actuator = design.architecture().actuator();
    let tour = subject.tour.iter().flat_map(|tour| &tour.poses);
    let document = ExportJson {
        kinefront_version: env!("CARGO_PKG_VERSION"),
        study: &study.name,
        design: subject.title(),
        evaluation: EvaluationJson::new(evaluation, model).with_dynamics(model, evaluation),
        pose: PoseJson::new(pose, pose.phi.to_degrees()),
        at_pose: PoseReportJson::new(&at(pose), strength.as_ref(), dynamics),
        material: (&model.settings().material).into(),
        actuator: ActuatorJson {
            kind: kind_name(actuator),
            unit: actuator.unit(),
            stiffness: model.settings().actuators.of(actuator),
        },
        bodies: linkage.bodies.iter().map(|body| BodyJson::new(linkage, body)).collect(),
        closures: linkage
            .closures
            .iter()
            .enumerate()
            .map(|(leg, closure)| ClosureJson {
                name: format!("C{}", leg + 1),
                leg_body: &linkage.bodies[closure.leg].name,
                on_leg_m: closure.on_leg.to_array(),
                on_platform_m: closure.on_platform.to_array(),
                rigid: closure.is_rigid,
            })
            .collect(),
        tour: tour
            .map(|pose| TourJson {
                pose: PoseJson::new(pose, pose.phi.to_degrees()),
                actuators: at(pose).ok().map(|report| report.actuators),
            })
            .collect(),
    };
    let mut bytes = serde_json::to_vec_pretty(&document)?;
    bytes.push(b'\n');
    Ok(bytes)
}
