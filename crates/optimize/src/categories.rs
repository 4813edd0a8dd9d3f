//! Combinations of the values of categorical variables.

use crate::Variable;

/// Returns every combination of the values of the categorical variables.
pub fn combinations(variables: &[Variable]) -> Vec<Vec<f64>> {
    variables.iter().fold(vec![Vec::new()], |combinations, variable| {
        let Variable::Categorical { choices } = *variable else {
            return combinations;
        };
        combinations
            .iter()
            .flat_map(|start| {
                (0..choices.max(1)).map(move |choice| {
                    let mut next = start.clone();
                    next.push(choice as f64);
                    next
                })
            })
            .collect()
    })
}

/// Sets the categorical variables of a candidate.
pub fn set_categories(variables: &[Variable], x: &mut [f64], categories: &[f64]) {
    let places = x
        .iter_mut()
        .zip(variables)
        .filter(|(_, variable)| matches!(variable, Variable::Categorical { .. }));
    for ((value, _), category) in places.zip(categories) {
        *value = *category;
    }
}
