//! Checks that scenes show what the model computes.

mod fields;
mod linkages;
mod manipulators;
mod motions;

use glam::DVec2;
use kinefront_model::evaluation::{Evaluation, GridChoice, Model, ModelSettings, PoseEvaluation};
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Pose;

/// The paper's designs, and feasible designs of the other architectures, one of them in another working mode.
const DESIGNS: [&str; 8] = [
    "3-PRR R=1.412 r=0.319 Lb=0.620 rj=0.026 rp=0.023",
    "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056",
    "3-PRR R=3.872 r=1.947 Lb=1.977 rj=0.039 rp=0.096",
    "3-RPR R=2.2462 r=1.2453 Lb=3.5382 rj=0.0224 rp=0.083",
    "3-RRR R=3.3658 r=0.2537 Lb=1.9157 rj=0.0787 rp=0.0891",
    "3-RRR R=1.2777 r=1.5205 Lb=3.8009 rj=0.0528 rp=0.0821 mode=---",
    // From Pareto fronts; the platform is so small that another assembly mode is near.
    "3-RPR R=1.3439 r=0.1172 Lb=1.9493 rj=0.01577 rp=0.01891",
    "3-RRR R=0.6373 r=0.1184 Lb=0.6471 rj=0.03206 rp=0.02846",
];

fn design(text: &str) -> Design {
    text.parse().expect("a design")
}

fn model_of(settings: ModelSettings) -> Model {
    Model::new(settings).expect("the grids fit")
}

/// Checks each of the designs with its evaluation on a grid; all of them are feasible on the fine one.
fn each(grid: GridChoice, check: impl Fn(&Model, &Evaluation)) {
    let model = Model::default();
    for text in DESIGNS {
        let evaluation = model.evaluate(&design(text), grid);
        assert!(grid != GridChoice::Fine || evaluation.is_feasible(), "{text}");
        check(&model, &evaluation);
    }
}

fn report(model: &Model, design: &Design, position: DVec2, phi: f64) -> PoseEvaluation {
    let pose = Pose { position, phi };
    model.pose(design, &pose).expect("reachable")
}
