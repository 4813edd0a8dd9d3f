//! Fronts of several studies side by side: the first objective at equal values of the second.

use kinefront_model::evaluation::Objective;
use kinefront_optimize::Objectives;

/// Places at which fronts are compared, as fractions of the way from the worst value of the second objective to the best one.
const FRACTIONS: [f64; 8] = [0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95];

/// The first objective of each front at one value of the second.
#[derive(Debug, Clone, PartialEq)]
pub struct EqualLevel {
    /// Value of the second objective; `None` for one objective.
    pub at: Option<f64>,
    /// The best first objective of the designs of each front whose second one is at least as good; `None` where there is no such design.
    pub costs: Vec<Option<f64>>,
}

/// Compares the first objective of fronts at equal values of the second one, rounded to two digits. Of one objective, the best values are
/// compared; of more than two, nothing is.
pub fn equal_levels(objectives: &[Objective], fronts: &[Vec<Objectives>]) -> Vec<EqualLevel> {
    let best = |front: &Vec<Objectives>, most: Option<f64>| {
        let holds = |point: &&Objectives| most.is_none_or(|most| point[1] <= most);
        let costs = front.iter().filter(holds).map(|point| point[0]);
        costs.reduce(f64::min).map(|cost| objectives[0].value(cost))
    };
    match objectives {
        [_] => vec![EqualLevel {
            at: None,
            costs: fronts.iter().map(|front| best(front, None)).collect(),
        }],
        [_, second] => levels(fronts)
            .into_iter()
            .map(|level| EqualLevel {
                at: Some(second.value(level)),
                costs: fronts.iter().map(|front| best(front, Some(level))).collect(),
            })
            .collect(),
        _ => Vec::new(),
    }
}

/// Returns values of the second objective, as it is minimised, over all fronts, the worst first.
fn levels(fronts: &[Vec<Objectives>]) -> Vec<f64> {
    let values = || fronts.iter().flatten().map(|point| point[1]);
    let (Some(best), Some(worst)) = (values().reduce(f64::min), values().reduce(f64::max)) else {
        return Vec::new();
    };
    levels_between(worst, best)
}

/// Returns values between the worst and the best value of an objective at which fronts are compared, rounded to two digits, the worst
/// first.
pub fn levels_between(worst: f64, best: f64) -> Vec<f64> {
    let span = (best - worst).abs().max(f64::MIN_POSITIVE);
    let decade = libm::pow(10.0, libm::floor(libm::log10(span)) - 1.0);
    let level = |fraction: f64| ((worst + fraction * (best - worst)) / decade).round() * decade;
    let mut levels: Vec<f64> = FRACTIONS.into_iter().map(level).collect();
    levels.dedup();
    levels
}
