//! Exports a design to file formats of other programs.
//!
//! | format | contents |
//! |---|---|
//! | `gltf` | coloured solids, the regular workspace, and a tour of it as an animation |
//! | `mjcf` | bodies with masses, loops closed by constraints, actuators with the study's stiffness |
//! | `sdf` | bodies with masses and every joint, with closed loops |
//! | `urdf` | bodies with masses; a tree, so the loops are cut |
//! | `step` | an assembly of exact solids in millimetres, for CAD |
//! | `dxf` | the plan view in layers, in millimetres |
//! | `csv-trajectory` | the motion of the study in equal steps of time, as a controller of the actuators takes it |
//! | `csv-parts` | the bars, joints and drives to be ordered and cut |
//! | `json` | evaluation, bodies, joints, and a tour with its actuator values |
//!
//! Every format except the plan view takes its bodies from [`kinefront_scene::linkage()`], so the formats agree.

mod assembly_modes;
mod certificate;
mod dxf;
mod dynamics;
mod format;
mod gltf;
mod json;
mod mjcf;
mod parts;
mod pose;
mod prepared;
mod sdf;
mod step;
mod strength;
#[cfg(feature = "parquet")]
mod table;
mod trajectory;
mod urdf;
mod wire;
mod xml;

use kinefront_model::evaluation::{Evaluation, Unreachable};
use kinefront_model::spatial::Pose;
use kinefront_study::PreparedStudy;

pub use assembly_modes::AssemblyModesJson;
pub use certificate::{CertificateJson, Claim};
pub use dynamics::{DynamicsJson, MotionProofJson, TaskJson, TaskRow};
use format::Contents;
pub use format::Format;
pub use pose::PoseJson;
#[cfg(feature = "parquet")]
pub use table::{ConversionError, front_to_parquet};
pub use wire::{DesignJson, EvaluationJson, PoseReportJson};

use prepared::Prepared;

impl Format {
    /// All formats.
    pub const ALL: &'static [Format] = &[
        gltf::FORMAT,
        mjcf::FORMAT,
        sdf::FORMAT,
        urdf::FORMAT,
        dxf::FORMAT,
        json::FORMAT,
        parts::FORMAT,
        step::FORMAT,
        trajectory::FORMAT,
    ];
}

/// Why a design cannot be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The design does not reach the pose.
    #[error("the design does not reach the pose, which is the home pose unless another one is given: {cause}")]
    Unreachable {
        /// The leg that does not reach the pose, and why.
        cause: Unreachable,
    },
    /// A bar has radius 0, but the format requires masses and shapes; contains the format's short name.
    #[error("a bar of radius 0 has no mass and no shape; {0} needs r_j and r_p above 0")]
    NoBar(&'static str),
    /// The format is one of a motion, which the study does not state or the design does not follow; contains why.
    #[error("{0}")]
    NoMotion(String),
    /// A number of the file would not be finite; contains the format's short name.
    #[error(
        "the dimensions of the design are too large or too small for {0}: a number in the file would not be finite"
    )]
    NotFinite(&'static str),
    /// Writing the format failed.
    #[error("cannot write {format}: {cause}")]
    Format {
        /// Name of the format.
        format: &'static str,
        /// Cause of the failure.
        cause: format::AnyError,
    },
}

impl From<Unreachable> for ExportError {
    fn from(cause: Unreachable) -> Self {
        Self::Unreachable { cause }
    }
}

/// The subject of an export: a design at a pose.
#[derive(Debug, Clone, Copy)]
pub struct ExportSubject<'a> {
    /// The study for which the design was evaluated.
    pub study: &'a PreparedStudy,
    /// The evaluation of the design.
    pub evaluation: &'a Evaluation,
    /// Pose of the platform; the home pose if `None`.
    pub pose: Option<Pose>,
}

/// Exports the design in a format.
///
/// # Errors
/// [`ExportError`] when the design does not reach the pose, when a simulator format is requested for a design with a
/// bar of radius 0, when a format of a motion is requested without one, when a number would not be finite, or when the format cannot be
/// written.
pub fn export(subject: &ExportSubject, format: Format) -> Result<Vec<u8>, ExportError> {
    let prepared = Prepared::new(subject)?;
    let design = &subject.evaluation.design;
    let is_simulated = matches!(format.contents, Contents::Simulator { .. });
    if is_simulated && !(design.leg_bar_radius() > 0.0 && design.platform_bar_radius() > 0.0) {
        return Err(ExportError::NoBar(format.key));
    }
    if !prepared.is_finite() {
        return Err(ExportError::NotFinite(format.key));
    }
    let written = (format.write)(&prepared).map_err(|cause| match cause.downcast::<ExportError>() {
        Ok(own) => *own,
        Err(cause) => ExportError::Format {
            format: format.key,
            cause,
        },
    })?;
    // A number that the writer itself derives may be beyond all doubles, too. JSON has no such numbers, but texts of a user.
    if format.is_text() && format.key != json::FORMAT.key && prepared::has_number_that_is_none(&written) {
        return Err(ExportError::NotFinite(format.key));
    }
    Ok(written)
}
