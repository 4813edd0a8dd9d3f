//! Design of experiments: the candidates an algorithm starts from.

use super::Variable;

/// Most points of one sample, and most variables.
const MOST_POINTS: usize = 1 << 16;

/// `count` points of an Owen-scrambled Sobol sequence over the variables; another seed is another scrambling.
///
/// A categorical variable takes the choice in whose equal share of \[0, 1) its coordinate falls, so every choice is drawn
/// as evenly as the sequence is.
///
/// # Panics
/// More than 65 536 points or 256 variables: the sequence has no more.
pub fn sobol(variables: &[Variable], count: usize, seed: u64) -> Vec<Vec<f64>> {
    assert!(
        count <= MOST_POINTS && variables.len() <= 256,
        "the Sobol sequence has 65536 points in 256 dimensions"
    );
    // The sequence takes 32 bits of seed.
    let seed = (seed ^ (seed >> 32)) as u32;
    (0..count as u32)
        .map(|index| {
            variables
                .iter()
                .zip(0u32..)
                .map(|(variable, dimension)| {
                    let share = f64::from(sobol_burley::sample(index, dimension, seed));
                    match *variable {
                        Variable::Real { lower, upper } => lower + share * (upper - lower),
                        Variable::Categorical { choices } => (share * choices as f64).floor(),
                    }
                })
                .collect()
        })
        .collect()
}
