//! Every line of `evaluate --stdin` has an answer without a number that is not finite.

use kinefront_export::EvaluationJson;
use kinefront_model::evaluation::{GridChoice, Model, ModelSettings};
use kinefront_model::mechanism::{Design, WorkingMode};
use kinefront_model::workspace::Grid;

pub fn check(line: &str) {
    let settings = ModelSettings {
        reference_grid: Grid::new(10.0, 3, 6, 2).expect("a grid"),
        ..ModelSettings::default()
    };
    let model = Model::new(settings).expect("a model");
    let Ok(design) = Design::parse(line, WorkingMode::ALL_PLUS) else {
        return;
    };
    // A platform or a link that is long compared with R takes many steps.
    if design.platform_radius().max(design.link_length()) > 20.0 * design.base_radius() {
        return;
    }
    let found = model.evaluate(&design, GridChoice::Reference);
    let json = serde_json::to_value(EvaluationJson::new(&found, &model)).expect("JSON");
    for key in ["mass_kg", "workspace_radius_m", "violation"] {
        assert!(json[key].is_number(), "{key} of {line}: {json}");
    }
    let misses = found
        .constraints
        .iter()
        .any(|result| result.required && result.margin < 0.0);
    assert!(misses || found.is_feasible(), "{line}: {json}");
}
