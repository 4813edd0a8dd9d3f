//! Study files, and what reads the files of others.

mod families;
mod pool;
mod refusals;
mod robustness;
mod settings;
mod studies;

use kinefront_study::{Builtin, DesignProblem, Study};

fn builtin(name: &str) -> Builtin {
    Builtin::find(name).expect("a study that comes with the program")
}

fn parsed(text: &str) -> Study {
    Study::parse(text, "mine.toml").unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// A study as it is read from the text that is written of it.
fn reread(study: &Study) -> Study {
    parsed(&toml::to_string(study).expect("TOML"))
}

fn problem(study: &Study) -> DesignProblem {
    DesignProblem::new(study).expect("a problem")
}
