//! The sections of a study file that define the search, each with its defaults.

use serde::{Deserialize, Serialize};

use super::declare::{Check, Initial, section};
use kinefront_optimize::{CmaEsSettings, FrontDeSettings, Moga2Settings, Nsga2Settings};

/// Name of an algorithm.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AlgorithmName {
    /// Differential evolution along the front, with the lightest bars for each geometry.
    #[default]
    FrontDe,
    /// MOGA-II (reimplementation), the paper's optimizer.
    Moga2,
    /// NSGA-II with constraint domination.
    Nsga2,
    /// CMA-ES, for one objective.
    CmaEs,
}

impl AlgorithmName {
    /// All algorithms.
    pub const ALL: [AlgorithmName; 4] = [
        AlgorithmName::FrontDe,
        AlgorithmName::Moga2,
        AlgorithmName::Nsga2,
        AlgorithmName::CmaEs,
    ];

    /// Names of all algorithms.
    pub const NAMES: [&'static str; 4] = [
        Self::ALL[0].name(),
        Self::ALL[1].name(),
        Self::ALL[2].name(),
        Self::ALL[3].name(),
    ];

    /// Describes the algorithm in one sentence.
    pub fn description(self) -> &'static str {
        match self {
            AlgorithmName::FrontDe => {
                "Differential evolution along the front, with the lightest bars for each geometry; CMA-ES for one objective"
            }
            AlgorithmName::Moga2 => "MOGA-II (reimplementation), the paper's optimizer",
            AlgorithmName::Nsga2 => "NSGA-II with constraint domination",
            AlgorithmName::CmaEs => "CMA-ES with restarts, for one objective",
        }
    }

    /// Returns the algorithm of a name.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|algorithm| algorithm.name() == name)
    }

    /// Returns the name of the algorithm, as in study files and command-line arguments.
    pub const fn name(self) -> &'static str {
        match self {
            AlgorithmName::FrontDe => "front-de",
            AlgorithmName::Moga2 => "moga2",
            AlgorithmName::Nsga2 => "nsga2",
            AlgorithmName::CmaEs => "cma-es",
        }
    }
}

impl std::fmt::Display for AlgorithmName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

/// Largest number of designs that a run reports: as many as its front has.
pub const WHOLE_FRONT: usize = 100_000;

/// Algorithm, budget, random seed and settings of the search.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OptimizerSection {
    /// Algorithm of the search.
    pub algorithm: AlgorithmName,
    /// Number of evaluations, the first sample included.
    pub evaluations: usize,
    /// Random seed, which determines every random draw; at most 2⁶³ − 1, the largest integer in TOML.
    pub seed: u64,
    /// Time limit \[s\]: the search ends after the generation in which it is reached. The result then depends on the
    /// machine.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_limit_s: Option<f64>,
    /// Number of designs that are reported: those that together cover the front best, including the ends and the knee.
    pub front_designs: usize,
    /// Number of worker threads; all cores if omitted. The result does not depend on it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub threads: Option<usize>,
    /// The section `[optimizer.stagnation]`: ends the search when it has stagnated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stagnation: Option<Stagnation>,
    /// The section `[optimizer.front_de]`.
    pub front_de: FrontDeSettings,
    /// The section `[optimizer.moga2]`.
    pub moga2: Moga2Settings,
    /// The section `[optimizer.nsga2]`.
    pub nsga2: Nsga2Settings,
    /// The section `[optimizer.cma_es]`.
    pub cma_es: CmaEsSettings,
}

impl Default for OptimizerSection {
    fn default() -> Self {
        Self {
            algorithm: AlgorithmName::FrontDe,
            evaluations: 6000,
            seed: 1,
            time_limit_s: None,
            front_designs: 100,
            threads: None,
            stagnation: None,
            front_de: FrontDeSettings::default(),
            moga2: Moga2Settings::default(),
            nsga2: Nsga2Settings::default(),
            cma_es: CmaEsSettings::default(),
        }
    }
}

/// Stagnation rule: a search has stagnated if the hypervolume grew by less than the fraction `gain` over the last
/// `evaluations` evaluations.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stagnation {
    /// Number of evaluations over which the gain is measured.
    pub evaluations: usize,
    /// Smallest relative gain with which the search continues.
    pub gain: f64,
}

section! {
    /// Reference point of the hypervolume: for each objective, a value that every design of interest improves on.
    pub struct HypervolumeSection in "hypervolume" {
        /// Mass of the reference point; heavier designs contribute nothing.
        reference_mass_kg: f64 = 2000.0, Check::Positive;
        optional {
            /// Values of the objectives at the reference point, in their order; if omitted, the reference mass for masses, 0 for
            /// quantities that are maximised, and for others a value that few designs exceed.
            reference: Vec<f64>, Check::Finite, Initial::AsText;
        }
    }
}
