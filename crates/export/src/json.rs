//! The JSON output that other programs rely on. Keys are a contract: new ones may be added, none may be renamed.

use std::collections::BTreeMap;

use crate::AnyError;
use serde::Serialize;

use super::Prepared;
use kinefront_model::certify::{Certificate, CertifyOptions, Verdict};
use kinefront_model::evaluation::{Bound, Evaluation, LimitResult, Model, PoseEvaluation, Quantity, Unreachable};
use kinefront_model::kinematics::AssemblyMode;
use kinefront_model::mechanism::{Design, DesignVariable, JointKind, WorkingMode};
use kinefront_model::spatial::Pose;
use kinefront_model::stiffness::Material;
use kinefront_scene::{Body, Frame, Linkage};

/// The variables of a design \[m, and deg where the key says so\].
#[derive(Debug, Serialize)]
pub struct DesignJson {
    #[serde(rename = "R")]
    base_radius: f64,
    #[serde(rename = "r")]
    platform_radius: f64,
    #[serde(rename = "Lb")]
    link_length: f64,
    #[serde(rename = "rj")]
    leg_bar_radius: f64,
    #[serde(rename = "rp")]
    platform_bar_radius: f64,
    #[serde(rename = "La", skip_serializing_if = "Option::is_none")]
    proximal_length: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    alpha_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    beta_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    gamma_deg: Option<f64>,
}

impl From<&Design> for DesignJson {
    fn from(design: &Design) -> Self {
        // As in the text of a design, what is not given has its default.
        let given = |variable: DesignVariable| {
            let mut given = design.given_variables();
            given.find(|other| *other == variable).map(|found| design.value(found))
        };
        Self {
            base_radius: design.base_radius,
            platform_radius: design.platform_radius,
            link_length: design.link_length,
            leg_bar_radius: design.leg_bar_radius,
            platform_bar_radius: design.platform_bar_radius,
            proximal_length: given(DesignVariable::ProximalLength),
            alpha_deg: given(DesignVariable::RailAngle),
            beta_deg: given(DesignVariable::GuideAngle),
            gamma_deg: given(DesignVariable::PlatformGuideAngle),
        }
    }
}

#[derive(Debug, Serialize)]
struct PoseJson {
    x_m: f64,
    y_m: f64,
    phi_deg: f64,
}

impl PoseJson {
    fn new(pose: &Pose, phi_deg: f64) -> Self {
        Self {
            x_m: pose.position.x,
            y_m: pose.position.y,
            phi_deg,
        }
    }
}

#[derive(Debug, Serialize)]
struct ConstraintJson {
    id: &'static str,
    name: &'static str,
    value: Option<f64>,
    threshold: f64,
    margin: f64,
    active: bool,
    pose: Option<PoseJson>,
}

/// The output of `kinefront evaluate --json`.
#[derive(Debug, Serialize)]
pub struct EvaluationJson {
    architecture: &'static str,
    design: DesignJson,
    working_mode: [i8; 3],
    mass_kg: f64,
    workspace_radius_m: f64,
    home: Option<PoseJson>,
    feasible: bool,
    violation: f64,
    /// Smallest clearance between members that are not joined, over the regular workspace; negative if they overlap.
    clearance_m: Option<f64>,
    /// The pair of members with this clearance.
    clearance_pair: Option<[String; 2]>,
    /// The constraints that the study requires.
    constraints: Vec<ConstraintJson>,
    /// The quantities that were determined, by their keys.
    quantities: BTreeMap<&'static str, f64>,
    /// The limits of quantities over the whole region.
    limits: Vec<LimitJson>,
}

/// A limit of a quantity.
#[derive(Debug, Serialize)]
struct LimitJson {
    quantity: &'static str,
    /// `at_least` or `at_most`.
    bound: &'static str,
    threshold: f64,
    value: Option<f64>,
    margin: f64,
}

impl From<&LimitResult> for LimitJson {
    fn from(result: &LimitResult) -> Self {
        Self {
            quantity: result.limit.quantity.entry().key,
            bound: match result.limit.bound {
                Bound::AtLeast(_) => "at_least",
                Bound::AtMost(_) => "at_most",
            },
            threshold: result.limit.threshold(),
            value: result.value,
            margin: result.margin,
        }
    }
}

impl EvaluationJson {
    /// Creates the output for an evaluation.
    pub fn new(evaluation: &Evaluation) -> Self {
        let design = &evaluation.design;
        Self {
            architecture: design.architecture.name(),
            design: design.into(),
            working_mode: design.working_mode.signs(),
            mass_kg: evaluation.mass,
            workspace_radius_m: evaluation.workspace_radius,
            home: evaluation
                .home
                .zip(evaluation.home_phi_deg)
                .map(|(pose, phi_deg)| PoseJson::new(&pose, phi_deg)),
            feasible: evaluation.is_feasible(),
            violation: evaluation.violation,
            clearance_m: evaluation.clearance(),
            clearance_pair: evaluation.nearest.map(|nearest| nearest.pair()),
            constraints: evaluation
                .constraints
                .iter()
                .filter(|report| report.required)
                .map(|report| ConstraintJson {
                    id: report.constraint.id(),
                    name: report.constraint.name(),
                    value: report.value,
                    threshold: report.threshold,
                    margin: report.margin,
                    active: report.active,
                    pose: report.pose.map(|pose| PoseJson::new(&pose, pose.phi.to_degrees())),
                })
                .collect(),
            quantities: Quantity::all()
                .filter_map(|quantity| Some((quantity.entry().key, evaluation.quantities.get(quantity)?)))
                .collect(),
            limits: evaluation.limits.iter().map(LimitJson::from).collect(),
        }
    }
}

/// The output of `kinefront certify --json`.
#[derive(Debug, Serialize)]
pub struct CertificateJson {
    architecture: &'static str,
    design: DesignJson,
    working_mode: [i8; 3],
    home: PoseJson,
    /// The radius that was claimed.
    pub claimed_radius_m: f64,
    /// Radius of a disc that is proved, rounded down.
    pub lower_m: f64,
    /// Distance of a pose that is proved infeasible, rounded up; `None` if none was found.
    pub upper_m: Option<f64>,
    relative_gap: Option<f64>,
    tolerance: f64,
    closed: bool,
    /// `proved`, `refuted` or `open`.
    pub verdict: &'static str,
    /// Why the verdict is open: `budget` or `precision`.
    pub why: Option<&'static str>,
    violation: Option<ViolationJson>,
    /// Number of boxes that were examined.
    pub boxes: usize,
    seconds: f64,
    /// Bound of the workspace radius over all home orientations, rounded up, if it was asked for and found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub upper_all_homes_m: Option<Option<f64>>,
}

/// A pose that is proved infeasible; `phi_rad` is the orientation of the proof.
#[derive(Debug, Serialize)]
struct ViolationJson {
    #[serde(flatten)]
    pose: PoseJson,
    phi_rad: f64,
    id: &'static str,
    margin: f64,
}

impl CertificateJson {
    /// Creates the output for a certificate that took `seconds`.
    pub fn new(
        model: &Model,
        design: &Design,
        options: &CertifyOptions,
        certificate: &Certificate,
        homes: Option<Option<f64>>,
        seconds: f64,
    ) -> Self {
        let centre = model.workspace.centre;
        let (verdict, why) = match certificate.verdict {
            Verdict::Proved => ("proved", None),
            Verdict::Refuted => ("refuted", None),
            Verdict::OpenBudget => ("open", Some("budget")),
            Verdict::OpenPrecision => ("open", Some("precision")),
        };
        // The decimal text of a double may lie on either side of it. The gap is that of the numbers as printed.
        let printed = Certificate {
            lower: certificate.lower.next_down().max(0.0),
            upper: certificate
                .upper
                .map(|upper| if upper > 0.0 { upper.next_up() } else { upper }),
            ..*certificate
        };
        Self {
            architecture: design.architecture.name(),
            design: design.into(),
            working_mode: design.working_mode.signs(),
            home: PoseJson {
                x_m: centre.x,
                y_m: centre.y,
                phi_deg: options.phi_deg,
            },
            claimed_radius_m: options.claimed_radius,
            lower_m: printed.lower,
            upper_m: printed.upper,
            relative_gap: printed.relative_gap(),
            tolerance: options.tolerance,
            closed: printed.is_closed(options.tolerance),
            verdict,
            why,
            violation: certificate.violation.map(|violation| ViolationJson {
                pose: PoseJson::new(&violation.pose, violation.pose.phi.to_degrees()),
                phi_rad: violation.pose.phi,
                id: violation.constraint.id(),
                margin: model.margin_at(design, &violation.pose, violation.constraint),
            }),
            boxes: certificate.boxes,
            seconds,
            upper_all_homes_m: homes.map(|bound| bound.map(f64::next_up)),
        }
    }
}

/// The output of `kinefront pose --json`.
#[derive(Debug, Serialize)]
pub struct PoseReportJson {
    reachable: bool,
    reason: Option<String>,
    actuators: Option<[f64; 3]>,
    #[serde(rename = "B")]
    b: Option<[[f64; 2]; 3]>,
    #[serde(rename = "C")]
    c: Option<[[f64; 2]; 3]>,
    inverse_condition: Option<f64>,
    k_xy: Option<f64>,
    k_z: Option<f64>,
    k_phi_z: Option<f64>,
    clearance_m: Option<f64>,
    clearance_pair: Option<[String; 2]>,
    stiffness: Option<[[f64; 6]; 6]>,
}

impl From<&Result<PoseEvaluation, Unreachable>> for PoseReportJson {
    fn from(outcome: &Result<PoseEvaluation, Unreachable>) -> Self {
        let report = outcome.as_ref().ok();
        Self {
            reachable: report.is_some(),
            reason: outcome.as_ref().err().map(ToString::to_string),
            actuators: report.map(|report| report.actuators),
            b: report.map(|report| report.b),
            c: report.map(|report| report.c),
            inverse_condition: report.map(|report| report.inverse_condition),
            k_xy: report.map(|report| report.stiffness_values.k_xy),
            k_z: report.map(|report| report.stiffness_values.k_z),
            k_phi_z: report.map(|report| report.stiffness_values.k_phi_z),
            clearance_m: report.map(|report| report.clearance.distance),
            clearance_pair: report.map(|report| report.clearance.pair()),
            stiffness: report.map(|report| std::array::from_fn(|i| std::array::from_fn(|j| report.stiffness[(i, j)]))),
        }
    }
}

/// The output of `kinefront pose --actuators --json`.
#[derive(Debug, Serialize)]
pub struct AssemblyModesJson {
    modes: Vec<AssemblyModeJson>,
}

#[derive(Debug, Serialize)]
struct AssemblyModeJson {
    pose: PoseJson,
    working_mode: Option<[i8; 3]>,
    within_limits: bool,
    of_this_design: bool,
}

impl AssemblyModesJson {
    /// Creates the output for the modes of a design.
    pub fn new(modes: &[AssemblyMode]) -> Self {
        let mode = |mode: &AssemblyMode| AssemblyModeJson {
            pose: PoseJson::new(&mode.pose, mode.pose.phi.to_degrees()),
            working_mode: mode.working_mode.map(WorkingMode::signs),
            within_limits: mode.is_within_limits,
            of_this_design: mode.is_of_design,
        };
        Self {
            modes: modes.iter().map(mode).collect(),
        }
    }
}

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
}

impl From<&Material> for MaterialJson {
    fn from(material: &Material) -> Self {
        Self {
            youngs_modulus_pa: material.youngs_modulus,
            shear_modulus_pa: material.shear_modulus,
            density_kg_per_m3: material.density,
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

impl From<&Frame> for FrameJson {
    fn from(frame: &Frame) -> Self {
        Self {
            x_m: frame.origin.x,
            y_m: frame.origin.y,
            angle_rad: frame.angle,
        }
    }
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
            frame: (&body.frame).into(),
            height_m: body.height,
            joint: body.joint.map(|joint| JointJson {
                kind: kind(joint.kind),
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

fn kind(actuator: JointKind) -> &'static str {
    match actuator {
        JointKind::Prismatic => "prismatic",
        JointKind::Revolute => "revolute",
    }
}

pub(super) fn write(subject: &Prepared) -> Result<Vec<u8>, AnyError> {
    let Prepared {
        study,
        evaluation,
        model,
        pose,
        linkage,
        ..
    } = subject;
    let design = &evaluation.design;
    let at = |pose: &Pose| model.pose(design, pose);
    let actuator = design.architecture.actuator();
    let tour = subject.tour.iter().flat_map(|tour| &tour.poses);
    let document = ExportJson {
        kinefront_version: env!("CARGO_PKG_VERSION"),
        study: &study.name,
        design: subject.title(),
        evaluation: EvaluationJson::new(evaluation),
        pose: PoseJson::new(pose, pose.phi.to_degrees()),
        at_pose: (&at(pose)).into(),
        material: (&model.material).into(),
        actuator: ActuatorJson {
            kind: kind(actuator),
            unit: actuator.unit(),
            stiffness: model.actuators.of(actuator),
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
