//! Values that a command or a caller states instead of those of a study.

use crate::{AlgorithmName, Fault, Study};
use kinefront_model::mechanism::Architecture;

/// Values that take the place of those of a study; `None` keeps the value of the study.
#[derive(Debug, Clone, Default)]
pub struct Overrides {
    /// The algorithm.
    pub algorithm: Option<AlgorithmName>,
    /// Number of evaluations.
    pub evaluations: Option<usize>,
    /// Random seed.
    pub seed: Option<u64>,
    /// Number of worker threads.
    pub threads: Option<usize>,
    /// Number of designs that are reported.
    pub front_designs: Option<usize>,
    /// The architectures that are searched.
    pub architectures: Option<Vec<Architecture>>,
}

impl Overrides {
    /// Returns the study with these values.
    ///
    /// # Errors
    /// The first [`Fault`] of the study with these values.
    pub fn apply(self, mut study: Study) -> Result<Study, Fault> {
        let optimizer = &mut study.optimizer;
        optimizer.algorithm = self.algorithm.unwrap_or(optimizer.algorithm);
        optimizer.evaluations = self.evaluations.unwrap_or(optimizer.evaluations);
        optimizer.seed = self.seed.unwrap_or(optimizer.seed);
        optimizer.front_designs = self.front_designs.unwrap_or(optimizer.front_designs);
        optimizer.threads = self.threads.or(optimizer.threads);
        if let Some(architectures) = self.architectures {
            // Bounds of a variable that no architecture has are a fault of a study, not of who selects architectures.
            study.bounds.omit_unused(&architectures);
            study.architectures = architectures;
        }
        match study.faults().into_iter().next() {
            None => Ok(study),
            Some(fault) => Err(fault),
        }
    }
}
