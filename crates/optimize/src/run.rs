//! The loop of a search: asks an algorithm for candidates, evaluates them, and tells it the outcomes.

use super::{Algorithm, Archive, Evaluated, Problem};

/// Runs `algorithm` on `problem` for `evaluations` evaluations in the current thread and returns the archive of the
/// non-dominated feasible candidates.
pub fn run(problem: &impl Problem, algorithm: &mut (impl Algorithm + ?Sized), evaluations: usize) -> Archive {
    let mut archive = Archive::default();
    let mut done = 0;
    while done < evaluations {
        let mut candidates = algorithm.ask();
        candidates.truncate(evaluations - done);
        let evaluated: Vec<Evaluated> = candidates
            .into_iter()
            .map(|candidate| {
                let x = problem.completed(candidate);
                let outcome = problem.evaluate(&x);
                Evaluated { x, outcome }
            })
            .collect();
        for (offset, candidate) in evaluated.iter().enumerate() {
            archive.insert(done + offset, &candidate.x, &candidate.outcome);
        }
        done += evaluated.len();
        algorithm.tell(evaluated);
    }
    archive
}
