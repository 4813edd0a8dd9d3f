//! Exports a design to file formats of other programs.
//!
//! | format | contents |
//! |---|---|
//! | [`Format::Gltf`] | coloured solids, the regular workspace, and a tour of it as an animation |
//! | [`Format::Mjcf`] | bodies with masses, loops closed by constraints, actuators with the study's stiffness |
//! | [`Format::Sdf`] | bodies with masses and every joint, with closed loops |
//! | [`Format::Urdf`] | bodies with masses; a tree, so the loops are cut |
//! | [`Format::Dxf`] | the plan view in layers, in millimetres |
//! | [`Format::Json`] | evaluation, bodies, joints, and a tour with its actuator values |
//!
//! Every format except the plan view takes its bodies from [`kinefront_scene::linkage()`], so the formats agree.

mod dxf;
mod gltf;
mod json;
mod mjcf;
mod sdf;
#[cfg(feature = "parquet")]
mod table;
mod urdf;
mod xml;

use glam::{DVec2, DVec3};

use kinefront_model::evaluation::{Evaluation, Model, Unreachable};
use kinefront_model::mechanism::JointKind;
use kinefront_model::spatial::{LEGS, Pose};
use kinefront_scene::palette;
use kinefront_scene::{
    Body, Linkage, Part, RegularCylinder, Scene, Solid, SolidShape, Tour, linkage, manipulator, region_corners,
    regular_workspace, tour,
};
use kinefront_study::Study;

pub use json::{AssemblyModesJson, CertificateJson, DesignJson, EvaluationJson, PoseReportJson};
#[cfg(feature = "parquet")]
pub use table::{ConversionError, front_to_parquet};

/// An error of a library that writes a format, whose message is shown with the name of what could not be written.
pub type AnyError = Box<dyn std::error::Error + Send + Sync>;

/// A file format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// glTF 2.0, binary.
    Gltf,
    /// MuJoCo's model format.
    Mjcf,
    /// Simulation Description Format of Gazebo.
    Sdf,
    /// Unified Robot Description Format of ROS.
    Urdf,
    /// Drawing Exchange Format.
    Dxf,
    /// JSON.
    Json,
}

impl Format {
    /// All formats.
    pub const ALL: [Format; 6] = [
        Format::Gltf,
        Format::Mjcf,
        Format::Sdf,
        Format::Urdf,
        Format::Dxf,
        Format::Json,
    ];

    /// Returns the format with a short name.
    pub fn find(key: &str) -> Option<Format> {
        Self::ALL.into_iter().find(|format| format.key() == key)
    }

    /// Returns the short name, as in arguments.
    pub fn key(self) -> &'static str {
        match self {
            Format::Gltf => "gltf",
            Format::Mjcf => "mjcf",
            Format::Sdf => "sdf",
            Format::Urdf => "urdf",
            Format::Dxf => "dxf",
            Format::Json => "json",
        }
    }

    /// Returns a default file name.
    pub fn file(self) -> &'static str {
        match self {
            Format::Gltf => "design.glb",
            Format::Mjcf => "design.xml",
            Format::Sdf => "design.sdf",
            Format::Urdf => "design.urdf",
            Format::Dxf => "design.dxf",
            Format::Json => "design.json",
        }
    }

    /// Returns the file name extension.
    pub fn extension(self) -> &'static str {
        self.file().rsplit('.').next().unwrap_or_default()
    }

    /// Returns the display name.
    pub fn name(self) -> &'static str {
        match self {
            Format::Gltf => "glTF",
            Format::Mjcf => "MJCF",
            Format::Sdf => "SDF",
            Format::Urdf => "URDF",
            Format::Dxf => "DXF",
            Format::Json => "JSON",
        }
    }

    /// Returns the display name with the intended use.
    pub fn title(self) -> &'static str {
        match self {
            Format::Gltf => "glTF, for viewers and CAD",
            Format::Mjcf => "MJCF, for MuJoCo",
            Format::Sdf => "SDF, for Gazebo",
            Format::Urdf => "URDF, for ROS",
            Format::Dxf => "DXF, plan view",
            Format::Json => "JSON, all data",
        }
    }

    /// Returns a text that lists what the format omits of a design's mechanics; `None` if it omits nothing.
    pub fn lost(self) -> Option<&'static str> {
        match self {
            Format::Mjcf | Format::Json => None,
            Format::Gltf => Some("joints, masses and actuators; the file contains only geometry and an animation"),
            Format::Dxf => Some("joints, masses, actuators and heights; the file contains only the plan view"),
            Format::Sdf => Some(
                "the stiffness of the actuators, and which joints are actuated; Gazebo's default physics engine does \
                 not close loops, that of Gazebo Classic does",
            ),
            Format::Urdf => Some(
                "the closed loops (URDF describes trees, so the platform is attached to leg 1, and legs 2 and 3 end \
                 free at C2 and C3); the stiffness of the actuators, and which joints are actuated; the effort and \
                 velocity limits are placeholders",
            ),
        }
    }
}

/// Why a design cannot be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The design does not reach the pose.
    #[error("the design does not reach the pose: {cause}")]
    Unreachable {
        /// The leg that does not reach the pose, and why.
        cause: Unreachable,
    },
    /// A bar has radius 0, but the format requires masses and shapes; contains the format's short name.
    #[error("a bar of radius 0 has no mass and no shape; {0} needs r_j and r_p above 0")]
    NoBar(&'static str),
    /// Writing the format failed.
    #[error("cannot write {format}: {cause}")]
    Format {
        /// Name of the format.
        format: &'static str,
        /// Cause of the failure.
        cause: AnyError,
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
    pub study: &'a Study,
    /// The model of the study.
    pub model: &'a Model,
    /// The evaluation of the design.
    pub evaluation: &'a Evaluation,
    /// Pose of the platform; the home pose if `None`.
    pub pose: Option<Pose>,
}

/// Number of poses around each rim of the exported tour.
const TOUR_STEPS: usize = 72;

/// A subject prepared for every format.
struct Prepared<'a> {
    study: &'a Study,
    model: &'a Model,
    evaluation: &'a Evaluation,
    pose: Pose,
    linkage: Linkage,
    scene: Scene,
    /// The fixed parts (base triangle and rails) as solids.
    base: Vec<Solid>,
    cylinder: Option<RegularCylinder>,
    /// Corners of the workspace if the study prescribes a polygon, in the base frame \[m\].
    corners: Option<Vec<DVec2>>,
    tour: Option<Tour>,
}

impl Prepared<'_> {
    /// Returns the design as text that the program can read: `3-PRR R=3.066 …`.
    fn title(&self) -> String {
        self.evaluation.design.to_string()
    }

    /// Returns the name of the model for formats that require an identifier.
    fn identifier(&self) -> String {
        let name = self.evaluation.design.architecture.name();
        format!("kinefront_{}", name.to_lowercase().replace('-', "_"))
    }

    /// Returns the comment at the head of every simulator file.
    fn preamble(&self, format: Format) -> String {
        let mut words = format!(
            "{}\nWritten by Kinefront {}. Lengths in m, angles in rad, masses in kg; base frame, z out of the plane of motion.\n\
             Bars are solid cylinders of density {} kg/m^3; bodies without mass in the model are given {MASSLESS} kg.",
            self.title(),
            env!("CARGO_PKG_VERSION"),
            self.model.material.density,
        );
        let counted = self.model.platform_bars;
        if counted as usize != LEGS {
            words +=
                &format!(" The study counts {counted} of the three platform bars; their masses are scaled to match.");
        }
        if matches!(format, Format::Sdf | Format::Urdf) {
            words += "\nJoint values are relative to the exported pose, at which they are 0.";
        }
        if let Some(lost) = format.lost() {
            words += "\nNot in this file: ";
            words += lost;
            words.push('.');
        }
        words
    }
}

/// Mass written for a body that has no mass in the model, because simulators require one \[kg\].
const MASSLESS: f64 = 1e-3;

/// Returns the mass, centre of mass and moments of inertia `[xx, yy, zz, xy]` of a body for a simulator.
fn inertial(body: &Body) -> (f64, DVec3, [f64; 4]) {
    let mass = body.mass();
    if mass > 0.0 {
        return (mass, body.centre_of_mass().extend(body.height), body.inertia());
    }
    // The moment of inertia of a solid sphere with a radius of 1 cm.
    let moment = 0.4 * MASSLESS * 1e-4;
    (MASSLESS, DVec3::Z * body.height, [moment, moment, moment, 0.0])
}

/// Formats a length, angle or direction with the fewest digits that read back to the same value. Values below 1e-14,
/// which the rotation of frames leaves in place of zeros, are written as 0.
fn text(value: f64) -> String {
    const NOTHING: f64 = 1e-14;
    if value.abs() < NOTHING {
        "0".to_owned()
    } else {
        value.to_string()
    }
}

/// Returns the colour of a part as RGBA, each value from 0 to 1.
fn rgba(part: Part) -> [f64; 4] {
    let [r, g, b] = palette::part(part).map(|value| (f64::from(value) / 255.0 * 1e3).round() / 1e3);
    [r, g, b, 1.0]
}

/// Returns the name of the joint between a body and its parent.
fn joint_name(body: &Body) -> String {
    format!("{}_joint", body.name)
}

/// Returns the axis of a joint in the frame of its body.
fn joint_axis(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Prismatic => "1 0 0",
        JointKind::Revolute => "0 0 1",
    }
}

/// Returns the position and the roll, pitch and yaw of a shape for SDF and URDF, in which a shape is centred at its
/// origin and a cylinder lies along z.
fn place(shape: &SolidShape) -> [f64; 6] {
    match *shape {
        SolidShape::Block { centre, angle, .. } => [centre.x, centre.y, centre.z, 0.0, 0.0, angle],
        SolidShape::Bar { from, to, .. } => {
            let middle = 0.5 * (from + to);
            let way = (to - from).truncate();
            // Bars lie in the plane; pins are along z.
            let (pitch, yaw) = if way.length() > 0.0 {
                (std::f64::consts::FRAC_PI_2, libm::atan2(way.y, way.x))
            } else {
                (0.0, 0.0)
            };
            [middle.x, middle.y, middle.z, 0.0, pitch, yaw]
        }
    }
}

/// Exports the design in a format.
///
/// # Errors
/// [`ExportError`] when the design does not reach the pose, when a simulator format is requested for a design with a
/// bar of radius 0, or when the format cannot be written.
pub fn export(subject: &ExportSubject, format: Format) -> Result<Vec<u8>, ExportError> {
    let ExportSubject {
        study,
        model,
        evaluation,
        pose,
    } = *subject;
    let design = &evaluation.design;
    let pose = pose.unwrap_or_else(|| model.home(evaluation));
    let linkage = linkage(model, design, &pose)?;
    let scene = manipulator(model, design, &pose)?;
    let solid = design.leg_bar_radius > 0.0 && design.platform_bar_radius > 0.0;
    if !solid && matches!(format, Format::Mjcf | Format::Sdf | Format::Urdf) {
        return Err(ExportError::NoBar(format.key()));
    }
    let cylinder = regular_workspace(evaluation, study.workspace.rotation_range_deg);
    let tour = cylinder.and_then(|cylinder| tour(model, design, &cylinder, TOUR_STEPS));
    let prepared = Prepared {
        study,
        model,
        evaluation,
        pose,
        linkage,
        base: scene.base_bars(design.base_radius),
        scene,
        corners: cylinder.and_then(|_| region_corners(model)),
        cylinder,
        tour,
    };
    let written = match format {
        Format::Gltf => gltf::write(&prepared),
        Format::Mjcf => mjcf::write(&prepared),
        Format::Sdf => sdf::write(&prepared),
        Format::Urdf => urdf::write(&prepared),
        Format::Dxf => dxf::write(&prepared),
        Format::Json => json::write(&prepared),
    };
    written.map_err(|cause| ExportError::Format {
        format: format.key(),
        cause,
    })
}
