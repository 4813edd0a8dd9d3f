//! Variation of real and categorical variables: simulated binary crossover and polynomial mutation, both within the
//! bounds of the variables (Deb and Agrawal 1995; Deb and Goyal 1996).

use super::Variable;
use super::random::Random;

/// Applies simulated binary crossover with distribution index `index` in place.
///
/// Each variable is crossed with probability 0.5 and otherwise left unchanged, as in Deb's own program. Crossing swaps
/// the values of a categorical variable.
pub fn cross(random: &mut Random, variables: &[Variable], index: f64, [first, second]: &mut [Vec<f64>; 2]) {
    for (k, variable) in variables.iter().enumerate() {
        if !random.chance(0.5) {
            continue;
        }
        match *variable {
            Variable::Categorical { .. } => std::mem::swap(&mut first[k], &mut second[k]),
            Variable::Real { lower, upper } => {
                let (low, high) = (first[k].min(second[k]), first[k].max(second[k]));
                let draw = random.uniform();
                let swap = random.chance(0.5);
                if high - low <= 1e-14 * (upper - lower) {
                    continue;
                }
                let spread = |room: f64| {
                    let beta = 1.0 + 2.0 * room / (high - low);
                    let power = index + 1.0;
                    let alpha = 2.0 - libm::pow(beta, -power);
                    let base = if draw <= 1.0 / alpha {
                        draw * alpha
                    } else {
                        1.0 / (2.0 - draw * alpha)
                    };
                    libm::pow(base, 1.0 / power)
                };
                let middle = 0.5 * (low + high);
                let half = 0.5 * (high - low);
                let below = (middle - spread(low - lower) * half).clamp(lower, upper);
                let above = (middle + spread(upper - high) * half).clamp(lower, upper);
                (first[k], second[k]) = if swap { (above, below) } else { (below, above) };
            }
        }
    }
}

/// Mutates each variable with the given probability in place: a real variable by polynomial mutation with distribution
/// index `index`, a categorical variable by redrawing it.
pub fn mutate(random: &mut Random, variables: &[Variable], probability: f64, index: f64, x: &mut [f64]) {
    for (value, variable) in x.iter_mut().zip(variables) {
        if !random.chance(probability) {
            continue;
        }
        match *variable {
            Variable::Categorical { choices } => *value = random.below(choices) as f64,
            Variable::Real { lower, upper } => {
                let range = upper - lower;
                if range <= 0.0 {
                    continue;
                }
                let power = index + 1.0;
                let draw = random.uniform();
                let step = if draw < 0.5 {
                    let room = 1.0 - (*value - lower) / range;
                    libm::pow(2.0 * draw + (1.0 - 2.0 * draw) * libm::pow(room, power), 1.0 / power) - 1.0
                } else {
                    let room = 1.0 - (upper - *value) / range;
                    1.0 - libm::pow(
                        2.0 * (1.0 - draw) + (2.0 * draw - 1.0) * libm::pow(room, power),
                        1.0 / power,
                    )
                };
                *value = (*value + step * range).clamp(lower, upper);
            }
        }
    }
}
