//! Design of experiments: the first sample of candidates of an algorithm.

use super::Variable;

/// Largest number of points of one sample.
const MOST_POINTS: usize = 1 << 16;

/// Returns `count` points of an Owen-scrambled Sobol sequence over the ranges of the variables; each random seed gives
/// a different scrambling.
///
/// For a categorical variable, \[0, 1) is divided into equal intervals, one per choice, and the coordinate selects the
/// choice whose interval contains it. The choices are thus sampled as evenly as the sequence is distributed.
///
/// # Panics
/// If more than 65 536 points or 256 variables are requested: the sequence has no more.
pub fn sobol(variables: &[Variable], count: usize, seed: u64) -> Vec<Vec<f64>> {
    assert!(
        count <= MOST_POINTS && variables.len() <= 256,
        "the Sobol sequence has 65536 points in 256 dimensions"
    );
    // The sequence takes a seed of 32 bits.
    let seed = (seed ^ (seed >> 32)) as u32;
    (0..count as u32)
        .map(|index| {
            variables
                .iter()
                .zip(0u32..)
                .map(|(variable, dimension)| {
                    let fraction = f64::from(sobol_burley::sample(index, dimension, seed));
                    match *variable {
                        Variable::Real { lower, upper } => lower + fraction * (upper - lower),
                        Variable::Categorical { choices } => (fraction * choices as f64).floor(),
                    }
                })
                .collect()
        })
        .collect()
}
