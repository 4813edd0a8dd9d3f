//! The threads of the pool as workers of one evaluation, for designs that a person waits for one at a time.

use kinefront_model::workers::Workers;
use rayon::prelude::*;

/// The threads of the pool from which it is used.
///
/// ```
/// use kinefront_model::evaluation::{GridChoice, Model};
/// use kinefront_study::PoolWorkers;
/// # let design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056".parse()?;
///
/// let model = Model::default();
/// let evaluation = model.evaluate_by(&PoolWorkers, &design, GridChoice::Fine);
/// assert_eq!(evaluation, model.evaluate(&design, GridChoice::Fine));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct PoolWorkers;

impl Workers for PoolWorkers {
    fn count(&self) -> usize {
        rayon::current_num_threads()
    }

    fn carry_out(&self, tasks: usize, task: &(dyn Fn(usize) + Sync)) {
        (0..tasks).into_par_iter().with_max_len(1).for_each(task);
    }
}
