//! The command `kinefront pose`.

use std::ffi::OsString;
use std::io::Write;

use kinefront::export::PoseReportJson;
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Pose;

use super::{Ending, Failure, load_study, tables, to_json};

#[derive(Debug, clap::Args)]
pub struct PoseArguments {
    /// Design, as in "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056" (metres; optional mode=+++).
    #[arg(long)]
    design: String,
    /// Pose, as in "x=0.1 y=0.2 phi_deg=30" (metres and degrees).
    #[arg(long)]
    pose: String,
    /// Study file, or name of a built-in study [default: paper].
    #[arg(long, value_name = "FILE")]
    study: Option<OsString>,
    /// Print the result as one JSON object.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &PoseArguments) -> Result<Ending, Failure> {
    let study = load_study(arguments.study.as_deref()).map_err(Failure::Input)?;
    let design = Design::parse(&arguments.design, study.working_mode).map_err(Failure::input)?;
    let pose = arguments.pose.parse::<Pose>().map_err(Failure::input)?;
    let outcome = study.model().map_err(Failure::runtime)?.pose(&design, &pose);
    let mut out = std::io::stdout().lock();
    if arguments.json {
        writeln!(
            out,
            "{}",
            to_json(&PoseReportJson::from(&outcome)).map_err(Failure::Runtime)?
        )?;
    } else {
        writeln!(out, "{}", tables::pose(&design, &pose, &outcome))?;
    }
    Ok(Ending::Done)
}
