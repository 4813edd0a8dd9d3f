//! The sections of a study file about the search, each with its defaults.

use serde::{Deserialize, Serialize};

use kinefront_optimize::{FrontDeSettings, Moga2Settings, Nsga2Settings};

/// Name of an algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum AlgorithmName {
    /// Differential evolution along the front, with the lightest bars for each geometry.
    FrontDe,
    /// After MOGA-II, the paper's optimizer.
    Moga2,
    /// NSGA-II with constraint domination.
    Nsga2,
}

impl AlgorithmName {
    /// All of them.
    pub const ALL: [AlgorithmName; 3] = [AlgorithmName::FrontDe, AlgorithmName::Moga2, AlgorithmName::Nsga2];

    /// Its name, as in study files and arguments.
    pub fn name(self) -> &'static str {
        match self {
            AlgorithmName::FrontDe => "front-de",
            AlgorithmName::Moga2 => "moga2",
            AlgorithmName::Nsga2 => "nsga2",
        }
    }
}

impl std::fmt::Display for AlgorithmName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

/// Algorithm, budget and seed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OptimizerSection {
    /// Which algorithm.
    pub algorithm: AlgorithmName,
    /// Number of evaluations, the first sample included.
    pub evaluations: usize,
    /// Seed of every random draw; TOML has no larger number than 2⁶³ − 1.
    pub seed: u64,
    /// Ends the search after the generation in which this time is up \[s\]; what it found then depends on the machine.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_limit_s: Option<f64>,
    /// Designs of the verified front that are kept: evenly spread, its ends and its knee among them.
    pub front_designs: usize,
    /// Worker threads; all cores where it is left out. The result does not depend on it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub threads: Option<usize>,
    /// `[optimizer.stagnation]`: ends the search when it hardly gains any more.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stagnation: Option<Stagnation>,
    /// `[optimizer.front_de]`.
    pub front_de: FrontDeSettings,
    /// `[optimizer.moga2]`.
    pub moga2: Moga2Settings,
    /// `[optimizer.nsga2]`.
    pub nsga2: Nsga2Settings,
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
        }
    }
}

/// When a search counts as stagnated: the hypervolume grew by less than the share `gain` over the last `evaluations`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stagnation {
    /// Evaluations over which the gain is measured.
    pub evaluations: usize,
    /// Least relative gain.
    pub gain: f64,
}

/// Where the hypervolume is measured from: this mass and `R_w` = 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HypervolumeSection {
    /// Designs heavier than this add nothing.
    pub reference_mass_kg: f64,
}

impl Default for HypervolumeSection {
    fn default() -> Self {
        Self {
            reference_mass_kg: 2000.0,
        }
    }
}
