//! Records the motion of a design: the manipulator and the curves of its actuators over the time of a cycle.

use rerun::TimeColumn;

use super::draw::Canvas;
use super::subject::DrawnDesign;
use super::writer::{ALWAYS, RecordingError, RecordingWriter};
use super::{paths, timelines};
use kinefront_model::evaluation::TaskSample;
use kinefront_model::mechanism::JointKind;
use kinefront_scene::{MotionCurve, MotionPath, PathColor, drawn_samples, palette};

/// Largest number of poses at which the manipulator is drawn.
const MOST_POSES: usize = 240;

/// Nanoseconds of a second, in which the timeline counts.
const NANOSECONDS: f64 = 1e9;

/// Returns the path of the entities of a curve.
pub(super) fn curve_path(curve: MotionCurve) -> String {
    format!("{}/{}", paths::MOTION, curve.name(JointKind::Prismatic))
}

/// Records the samples of a motion that a design follows.
pub(super) fn record_motion(
    writer: &RecordingWriter,
    subject: &DrawnDesign<'_>,
    samples: &[TaskSample],
) -> Result<(), RecordingError> {
    let nanoseconds = |sample: &TaskSample| (sample.instant.time * NANOSECONDS).round();
    let actuator = subject.evaluation.design.architecture().actuator();
    let drawn = drawn_samples(samples);
    for curve in MotionCurve::ALL {
        for leg in 0..3 {
            let entity = format!("{}/leg{}", curve_path(curve), leg + 1);
            let name = format!("leg {}: {}", leg + 1, curve.title(actuator));
            let times = drawn.iter().map(|sample| nanoseconds(sample) as i64);
            let times = TimeColumn::new_duration_nanos(timelines::TIME, times);
            let values = drawn.iter().map(|sample| curve.values(sample)[leg]);
            writer.curve(&entity, name, palette::SERIES[leg], times, values)?;
        }
    }
    let step = samples.len().div_ceil(MOST_POSES).max(1);
    let last = samples.last().filter(|_| !(samples.len() - 1).is_multiple_of(step));
    for sample in samples.iter().step_by(step).chain(last) {
        let moment = [(timelines::TIME, nanoseconds(sample) as usize)];
        subject.at_pose(&Canvas::at(writer, &moment), &sample.instant.pose)?;
    }
    let canvas = Canvas::at(writer, ALWAYS);
    if let Some(path) = MotionPath::new(subject.model, &subject.evaluation.design, samples, PathColor::FORCE) {
        subject.path(&canvas, &path)?;
        subject.path_in_space(&canvas, &path)?;
    }
    Ok(())
}
