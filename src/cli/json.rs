//! The JSON that other programs rely on. Keys are a contract: add, never rename.

use kinefront::evaluation::{Evaluation, PoseReport, Unreachable};
use kinefront::mechanism::Design;
use kinefront::spatial::Pose;
use serde::Serialize;

#[derive(Serialize)]
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
}

impl From<&Design> for DesignJson {
    fn from(design: &Design) -> Self {
        Self {
            base_radius: design.base_radius,
            platform_radius: design.platform_radius,
            link_length: design.link_length,
            leg_bar_radius: design.leg_bar_radius,
            platform_bar_radius: design.platform_bar_radius,
        }
    }
}

#[derive(Serialize)]
pub struct PoseJson {
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

#[derive(Serialize)]
pub struct ConstraintJson {
    id: &'static str,
    name: &'static str,
    value: Option<f64>,
    threshold: f64,
    margin: f64,
    active: bool,
    pose: Option<PoseJson>,
}

#[derive(Serialize)]
pub struct EvaluationJson {
    architecture: &'static str,
    design: DesignJson,
    working_mode: [i8; 3],
    mass_kg: f64,
    workspace_radius_m: f64,
    home: Option<PoseJson>,
    feasible: bool,
    violation: f64,
    constraints: Vec<ConstraintJson>,
}

impl From<&Evaluation> for EvaluationJson {
    fn from(evaluation: &Evaluation) -> Self {
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
            constraints: evaluation
                .constraints
                .iter()
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
        }
    }
}

#[derive(Serialize)]
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
    stiffness: Option<[[f64; 6]; 6]>,
}

impl From<&Result<PoseReport, Unreachable>> for PoseReportJson {
    fn from(outcome: &Result<PoseReport, Unreachable>) -> Self {
        let report = outcome.as_ref().ok();
        Self {
            reachable: report.is_some(),
            reason: outcome.as_ref().err().map(ToString::to_string),
            actuators: report.map(|report| report.actuators),
            b: report.map(|report| report.b),
            c: report.map(|report| report.c),
            inverse_condition: report.map(|report| report.inverse_condition),
            k_xy: report.map(|report| report.rigidity.k_xy),
            k_z: report.map(|report| report.rigidity.k_z),
            k_phi_z: report.map(|report| report.rigidity.k_phi_z),
            stiffness: report.map(|report| std::array::from_fn(|i| std::array::from_fn(|j| report.stiffness[(i, j)]))),
        }
    }
}
