//! The motion of a study in equal steps of time: what a controller of the actuators takes as its reference.

use super::ExportError;
use super::format::{AnyError, Contents, Format};
use super::prepared::Prepared;
use kinefront_model::evaluation::TaskSample;

pub(super) const FORMAT: Format = Format {
    key: "csv-trajectory",
    file: "trajectory.csv",
    name: "the reference trajectory",
    title: "CSV, reference trajectory of the motion",
    lost: None,
    contents: Contents::Text,
    write,
};

/// Least step of time \[s\], that of common controllers.
const STEP: f64 = 1e-3;

/// Largest number of steps: that of longer motions is longer.
const MOST_STEPS: f64 = 1e6;

/// The quantities, each of which has a column for each axis of the pose or for each leg.
const HEADINGS: [&str; 16] = [
    "t_s", "x_m", "y_m", "phi_deg", "q1", "q2", "q3", "qd1", "qd2", "qd3", "qdd1", "qdd2", "qdd3", "tau1", "tau2",
    "tau3",
];

fn write(subject: &Prepared) -> Result<Vec<u8>, AnyError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(HEADINGS)?;
    for sample in samples(subject)? {
        writer.write_record(record(&sample))?;
    }
    Ok(writer.into_inner()?)
}

fn samples(subject: &Prepared) -> Result<Vec<TaskSample>, ExportError> {
    let motion = subject.motion().map_err(ExportError::NoMotion)?;
    let step = STEP * (motion.cycle_time() / STEP / MOST_STEPS).ceil();
    let followed = subject
        .driven
        .posed(&subject.evaluation.design)
        .trajectory(&motion, step);
    followed.map_err(|failure| ExportError::NoMotion(kinefront_scene::text::motion_failure(&failure)))
}

fn record(sample: &TaskSample) -> impl Iterator<Item = String> {
    let (pose, response) = (&sample.instant.pose, &sample.response);
    let of_platform = [
        sample.instant.time,
        pose.position.x,
        pose.position.y,
        pose.phi.to_degrees(),
    ];
    let of_legs = [
        sample.actuators,
        response.speeds,
        response.accelerations,
        response.forces,
    ];
    let numbers = of_platform.into_iter().chain(of_legs.into_iter().flatten());
    // A table shows no zero with a sign.
    numbers.map(|number| (number + 0.0).to_string())
}
