//! Threads of a caller, on which one evaluation can carry out its parts at the same time. The model has none of its own.

use std::sync::OnceLock;

/// Carries out tasks that do not depend on each other.
pub trait Workers: Sync {
    /// Returns the number of tasks that can be carried out at the same time.
    fn count(&self) -> usize;

    /// Calls `task` once with each number below `tasks`, in any order, and returns when all calls have ended.
    fn carry_out(&self, tasks: usize, task: &(dyn Fn(usize) + Sync));
}

/// The thread that asks, alone.
#[derive(Debug, Clone, Copy)]
pub struct OneWorker;

impl Workers for OneWorker {
    fn count(&self) -> usize {
        1
    }

    fn carry_out(&self, tasks: usize, task: &(dyn Fn(usize) + Sync)) {
        (0..tasks).for_each(task);
    }
}

/// Returns the results of a function for some inputs, in their order.
pub(crate) fn map<I: Sync, T: Send + Sync>(workers: &dyn Workers, inputs: &[I], of: impl Fn(&I) -> T + Sync) -> Vec<T> {
    if inputs.len() < 2 || workers.count() < 2 {
        return inputs.iter().map(of).collect();
    }
    let results: Vec<OnceLock<T>> = inputs.iter().map(|_| OnceLock::new()).collect();
    workers.carry_out(inputs.len(), &|number| {
        results[number].get_or_init(|| of(&inputs[number]));
    });
    let results = results.into_iter().zip(inputs);
    // A task that was left out is carried out here.
    results
        .map(|(result, input)| result.into_inner().unwrap_or_else(|| of(input)))
        .collect()
}
