//! A design and its evaluation as JSON that other programs rely on. Keys are a contract: new ones may be added, none may be renamed.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};

use super::dynamics::{DynamicsJson, OverWorkspaceJson, TaskJson};
use super::pose::PoseJson;
use super::strength::StrengthJson;
use kinefront_model::clearance::{Clearance, StackOrder, Stacking};
use kinefront_model::evaluation::{
    Bound, Evaluation, LimitResult, Model, PoseEvaluation, PoseScalar, Quantity, Unreachable,
};
use kinefront_model::mechanism::{CrossSection, DESIGN_VARIABLES, Design};
use kinefront_model::spatial::LEGS;
use kinefront_model::strength::StrengthReport;

/// The variables of a design \[m, and deg where the key says so\] by their keys, in their order.
#[derive(Debug)]
pub struct DesignJson(Vec<(&'static str, f64)>);

impl From<&Design> for DesignJson {
    fn from(design: &Design) -> Self {
        // As in the text of a design, what is not given has its default.
        let variables = DESIGN_VARIABLES.into_iter().chain(design.given_variables());
        Self(
            variables
                .map(|variable| (variable.key(), design.value(variable)))
                .collect(),
        )
    }
}

impl Serialize for DesignJson {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().copied())
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
    /// What the motion of the study asks of the drives, if it states one and it was determined.
    #[serde(skip_serializing_if = "Option::is_none")]
    task: Option<TaskJson>,
    /// The largest rates, forces and errors over the workspace, and the lowest frequencies, if they were determined.
    #[serde(skip_serializing_if = "Option::is_none")]
    over_workspace: Option<OverWorkspaceJson>,
    /// Name of the bars of the legs, where the study has a catalogue of them; null if the catalogue does not have such a bar.
    #[serde(skip_serializing_if = "Option::is_none")]
    leg_section: Option<Option<String>>,
    /// Name of the bars of the platform, where the study has a catalogue of them; null if the catalogue does not have such a bar.
    #[serde(skip_serializing_if = "Option::is_none")]
    platform_section: Option<Option<String>>,
    /// How the legs are stacked, where the study lets the stack be chosen.
    #[serde(skip_serializing_if = "Option::is_none")]
    layers: Option<LayersJson>,
}

/// How the legs of a design are stacked.
#[derive(Debug, Serialize)]
struct LayersJson {
    /// `common`, `distal` or `legs`.
    stack: &'static str,
    /// Numbers of the legs from the platform; absent for common layers.
    #[serde(skip_serializing_if = "Option::is_none")]
    order: Option<[usize; LEGS]>,
}

impl From<StackOrder> for LayersJson {
    fn from(order: StackOrder) -> Self {
        let (stack, order) = match order {
            StackOrder::Common => ("common", None),
            StackOrder::Distal(order) => ("distal", Some(order)),
            StackOrder::Legs(order) => ("legs", Some(order)),
        };
        Self {
            stack,
            order: order.map(|order| order.map(|leg| leg + 1)),
        }
    }
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
    /// Creates the output for an evaluation by `model`.
    pub fn new(evaluation: &Evaluation, model: &Model) -> Self {
        let design = &evaluation.design;
        let sections = &model.settings().sections;
        let name_of = |section: &CrossSection, radius: f64| {
            let name = section.catalogue_name(radius).map(str::to_owned);
            section.catalogue().map(|_| name)
        };
        Self {
            architecture: design.architecture().name(),
            design: design.into(),
            working_mode: design.working_mode().signs(),
            mass_kg: evaluation.mass(),
            workspace_radius_m: evaluation.workspace_radius(),
            home: evaluation
                .home
                .zip(evaluation.home_phi_deg)
                .map(|(pose, phi_deg)| PoseJson::new(&pose, phi_deg)),
            feasible: evaluation.is_feasible(),
            violation: evaluation.violation,
            clearance_m: evaluation.clearance(),
            clearance_pair: evaluation.nearest.as_ref().map(Clearance::pair),
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
            task: None,
            over_workspace: None,
            leg_section: name_of(&sections.legs, design.leg_bar_radius()),
            platform_section: name_of(&sections.platform, design.platform_bar_radius()),
            layers: (model.settings().bodies.stacking == Stacking::Chosen).then(|| model.stack_of(design).order.into()),
        }
    }

    /// Adds what the motion of the study asks of the drives, and the worst figures of the motion over the workspace, at the
    /// poses of the reference grid.
    pub fn with_dynamics(mut self, model: &Model, evaluation: &Evaluation) -> Self {
        let followed = model.follow_task(evaluation);
        self.task = followed.map(|(outcome, _)| TaskJson::new(&outcome, &model.settings().drive_catalogue));
        let over_workspace = model.over_workspace(evaluation);
        self.over_workspace = over_workspace.as_ref().map(OverWorkspaceJson::from);
        self
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
    /// Strength under the loads of the study or a given wrench; nothing at a singularity.
    strength: Option<StrengthJson>,
    /// Frequencies, masses, gains and errors; nothing at a singularity.
    #[serde(flatten)]
    dynamics: Option<DynamicsJson>,
}

impl PoseReportJson {
    /// Creates the output for a pose, with the strength and the motion there.
    pub fn new(
        outcome: &Result<PoseEvaluation, Unreachable>,
        strength: Option<&StrengthReport>,
        dynamics: Option<DynamicsJson>,
    ) -> Self {
        let report = outcome.as_ref().ok();
        let value = |scalar: PoseScalar| report.map(|report| report.values[scalar]);
        Self {
            reachable: report.is_some(),
            reason: outcome.as_ref().err().map(ToString::to_string),
            actuators: report.map(|report| report.actuators),
            b: report.map(|report| report.b),
            c: report.map(|report| report.c),
            inverse_condition: value(PoseScalar::Dexterity),
            k_xy: value(PoseScalar::StiffnessXy),
            k_z: value(PoseScalar::StiffnessZ),
            k_phi_z: value(PoseScalar::StiffnessPhiZ),
            clearance_m: value(PoseScalar::Clearance),
            clearance_pair: report.map(|report| report.nearest.pair()),
            stiffness: report.map(|report| std::array::from_fn(|i| std::array::from_fn(|j| report.stiffness[(i, j)]))),
            strength: strength.map(StrengthJson::from),
            dynamics,
        }
    }
}
