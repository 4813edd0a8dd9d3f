//! Evaluates the paper's three designs and prints what limits each.
//!
//! `cargo run --release -p kinefront-model --example evaluate`

use kinefront_model::evaluation::{GridChoice, Model};
use kinefront_model::mechanism::{Design, TextError};

const DESIGNS: [(&str, &str); 3] = [
    ("ID-I", "3-PRR R=1.412 r=0.319 Lb=0.620 rj=0.026 rp=0.023"),
    ("ID-II", "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056"),
    ("ID-III", "3-PRR R=3.872 r=1.947 Lb=1.977 rj=0.039 rp=0.096"),
];

fn main() -> Result<(), TextError> {
    let model = Model::default();
    for (name, text) in DESIGNS {
        let design: Design = text.parse()?;
        let evaluation = model.evaluate(&design, GridChoice::Fine);
        let active: Vec<&str> = evaluation.active().map(|constraint| constraint.name()).collect();
        println!(
            "{name}: {:.1} kg, R_w {:.4} m, limited by {}",
            evaluation.mass(),
            evaluation.workspace_radius(),
            active.join(" and ")
        );
        assert!(evaluation.is_feasible() && !active.is_empty());
    }
    Ok(())
}
