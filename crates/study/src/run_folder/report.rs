//! Contents of `run.json`.

use serde::{Deserialize, Serialize};

use crate::FileSum;
use crate::{AlgorithmName, EndReason, FrontProofs, GenerationSummary, ObjectiveChoice, RunSummary, RunTimes, Study};
use kinefront_model::evaluation::Objective;
use kinefront_model::mechanism::Architecture;

/// Contents of `run.json`.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RunReport {
    /// Version of the program.
    pub kinefront_version: String,
    /// Name of the study.
    pub study: String,
    /// Algorithm of the search.
    pub algorithm: AlgorithmName,
    /// Architectures searched.
    pub architectures: Vec<Architecture>,
    /// Random seed.
    pub seed: u64,
    /// Worker threads used.
    pub threads: usize,
    /// Why the run ended.
    pub outcome: EndReason,
    /// Designs evaluated.
    pub evaluations: usize,
    /// Feasible designs.
    pub feasible: usize,
    /// Generations.
    pub generations: usize,
    /// Designs of `front.csv`.
    pub front_size: usize,
    /// Designs of the front on the reference grid that are infeasible or dominated on the fine grid.
    pub front_dropped_by_verification: usize,
    /// Designs of the verified front before it was thinned; 0 in a report of a version that did not thin.
    #[serde(default)]
    pub front_verified: usize,
    /// Reference point of the hypervolumes.
    pub hypervolume_reference: HypervolumeReference,
    /// Hypervolume of the front on the reference grid in the product of the units of the objectives, whatever the key says.
    pub hypervolume_kg_m: f64,
    /// Hypervolume of the verified front in the product of the units of the objectives, whatever the key says.
    pub verified_hypervolume_kg_m: f64,
    /// Times taken by the stages of the run.
    pub times: RunTimes,
    /// State after each generation.
    pub history: Vec<GenerationSummary>,
    /// Every how many generations one is recorded; `None` for a run without a recording.
    #[serde(default)]
    pub record_every: Option<usize>,
    /// Sums of the files; `None` in a report that was not written to a run folder, and of earlier versions.
    #[serde(default)]
    pub files: Option<FileSums>,
    /// What the proofs of the workspaces of the front found; `None` if the study asks for none.
    #[serde(default)]
    pub proofs: Option<FrontProofs>,
    /// Objectives of the study, and their values at the reference point; none in a report of earlier versions on the default ones.
    #[serde(default)]
    pub objectives: Vec<ReportedObjective>,
    /// The runs whose designs the folder holds; absent for a folder of one run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub merged: Vec<MergedRun>,
}

/// An objective in `run.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReportedObjective {
    /// Whether the quantity is minimised or maximised, and its key.
    #[serde(flatten)]
    pub objective: ObjectiveChoice,
    /// Its value at the reference point of the hypervolume.
    pub reference: f64,
}

/// Sums of the files of a run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileSums {
    /// Sum of `study.toml`.
    #[serde(rename = "study.toml")]
    pub study: Option<FileSum>,
    /// Sum of `designs.csv`.
    #[serde(rename = "designs.csv")]
    pub designs: Option<FileSum>,
    /// Sum of `front.csv`; `None` for a run that did not verify a front.
    #[serde(rename = "front.csv")]
    pub front: Option<FileSum>,
}

/// Reference point of a hypervolume.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HypervolumeReference {
    /// Mass \[kg\].
    pub mass_kg: f64,
    /// Workspace radius \[m\].
    pub workspace_radius_m: f64,
}

impl RunReport {
    /// Creates the report on a run of `study`.
    pub fn new(study: &Study, summary: &RunSummary) -> Self {
        let last = summary.history.last();
        Self {
            kinefront_version: env!("CARGO_PKG_VERSION").to_owned(),
            study: study.name.clone(),
            algorithm: study.optimizer.algorithm,
            architectures: study.architectures.clone(),
            seed: study.optimizer.seed,
            threads: summary.threads,
            outcome: summary.outcome,
            evaluations: last.map_or(0, |last| last.evaluations),
            feasible: last.map_or(0, |last| last.feasible),
            generations: summary.history.len(),
            front_size: summary.front.len(),
            front_dropped_by_verification: summary.dropped,
            front_verified: summary.verified,
            hypervolume_reference: HypervolumeReference {
                mass_kg: study.hypervolume.reference_mass_kg,
                workspace_radius_m: 0.0,
            },
            hypervolume_kg_m: last.map_or(0.0, |last| last.hypervolume),
            verified_hypervolume_kg_m: summary.verified_hypervolume,
            times: summary.times,
            history: summary.history.clone(),
            record_every: None,
            files: None,
            proofs: summary.proofs.clone(),
            objectives: reported_objectives(study),
            merged: Vec::new(),
        }
    }
}

fn reported_objectives(study: &Study) -> Vec<ReportedObjective> {
    let reference = study.hypervolume_reference();
    let of = |((choice, objective), minimised): ((&ObjectiveChoice, Objective), &f64)| ReportedObjective {
        objective: choice.clone(),
        // The negative of 0 is stated as 0.
        reference: objective.value(*minimised) + 0.0,
    };
    study
        .objectives
        .iter()
        .zip(study.objectives())
        .zip(reference.iter())
        .map(of)
        .collect()
}

/// A run whose designs a merged folder holds.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct MergedRun {
    /// Name of its folder.
    pub run: String,
    /// Random seed.
    pub seed: u64,
    /// Designs evaluated.
    pub evaluations: usize,
    /// Designs that were kept.
    pub kept: usize,
    /// Sum of its table of designs; `None` for a run that states none.
    pub designs: Option<FileSum>,
}
