//! A design as a file of other programs.
//!
//! | format | holds |
//! |---|---|
//! | [`Format::Gltf`] | solids in colour, the regular workspace, and a tour of it as an animation |
//! | [`Format::Mjcf`] | bodies with masses, loops closed by constraints, actuators as stiff as the study's |
//! | [`Format::Sdf`] | bodies with masses and every joint, loops closed |
//! | [`Format::Urdf`] | bodies with masses; a tree, so the loops are cut |
//! | [`Format::Dxf`] | the plan view in layers, in millimetres |
//! | [`Format::Json`] | evaluation, bodies, joints, and a tour with its actuator values |
//!
//! Every format but the plan view takes its bodies from [`crate::scene::linkage()`], so all agree.

mod dxf;
mod gltf;
mod json;
mod mjcf;
mod sdf;
mod table;
mod urdf;
mod xml;

use glam::DVec3;

use kinefront_model::evaluation::{Evaluation, Model, Unreachable};
use kinefront_model::mechanism::Actuator;
use crate::palette;
use crate::scene::{
    Body, Linkage, Part, RegularCylinder, Scene, Solid, SolidShape, Tour, linkage, manipulator, regular_workspace, tour,
};
use kinefront_model::spatial::{LEGS, Pose};
use crate::study::Study;

pub use json::{DesignJson, EvaluationJson, PoseReportJson};
pub use table::front_to_parquet;

/// A kind of file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// glTF 2.0, binary.
    Gltf,
    /// MuJoCo's model.
    Mjcf,
    /// Simulation Description Format, of Gazebo.
    Sdf,
    /// Unified Robot Description Format, of ROS.
    Urdf,
    /// Drawing Exchange Format.
    Dxf,
    /// JSON.
    Json,
}

impl Format {
    /// All of them.
    pub const ALL: [Format; 6] = [
        Format::Gltf,
        Format::Mjcf,
        Format::Sdf,
        Format::Urdf,
        Format::Dxf,
        Format::Json,
    ];

    /// The format of a short name.
    pub fn find(key: &str) -> Option<Format> {
        Self::ALL.into_iter().find(|format| format.key() == key)
    }

    /// Short name, as in arguments.
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

    /// A name for a file.
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

    /// Extension of its files.
    pub fn extension(self) -> &'static str {
        self.file().rsplit('.').next().unwrap_or_default()
    }

    /// Its name alone.
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

    /// Its name and what it is for.
    pub fn title(self) -> &'static str {
        match self {
            Format::Gltf => "glTF, for viewers and CAD",
            Format::Mjcf => "MJCF, for MuJoCo",
            Format::Sdf => "SDF, for Gazebo",
            Format::Urdf => "URDF, for ROS",
            Format::Dxf => "DXF, plan view",
            Format::Json => "JSON, everything",
        }
    }

    /// What of a design's mechanics the format does not hold, in words; `None` where it holds all.
    pub fn lost(self) -> Option<&'static str> {
        match self {
            Format::Mjcf | Format::Json => None,
            Format::Gltf => Some("joints, masses and actuators: it is a picture that moves"),
            Format::Dxf => Some("joints, masses, actuators and heights: it is a plan"),
            Format::Sdf => Some(
                "the actuators' stiffness, and which joints are driven; Gazebo's default engine does not close loops, that of \
                 Gazebo Classic does",
            ),
            Format::Urdf => Some(
                "the closed loops: URDF holds trees, so the platform hangs on leg 1 and legs 2 and 3 end free at C2 and C3; \
                 the actuators' stiffness, and which joints are driven; its limits of effort and speed are placeholders",
            ),
        }
    }
}

/// Why a design cannot be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The pose is not reached.
    #[error("the design does not reach the pose")]
    Unreachable(#[from] Unreachable),
    /// A bar without a radius.
    #[error("a bar of radius 0 has no mass and no shape; {0} needs r_j and r_p above 0")]
    NoBar(&'static str),
    /// Writing the format failed.
    #[error("cannot write {format}: {message}")]
    Format {
        /// Name of the format.
        format: &'static str,
        /// Why.
        message: String,
    },
}

/// What is exported: a design at a pose.
#[derive(Debug, Clone, Copy)]
pub struct Subject<'a> {
    /// The study that it was evaluated for.
    pub study: &'a Study,
    /// The design's evaluation.
    pub evaluation: &'a Evaluation,
    /// Where the platform is; its home where there is none.
    pub pose: Option<Pose>,
}

/// Poses around each rim of the tour that files hold.
const TOUR_STEPS: usize = 72;

/// A subject made ready for every format.
struct Prepared<'a> {
    study: &'a Study,
    evaluation: &'a Evaluation,
    model: Model,
    pose: Pose,
    linkage: Linkage,
    scene: Scene,
    /// What stands still, as solids.
    base: Vec<Solid>,
    cylinder: Option<RegularCylinder>,
    tour: Option<Tour>,
}

impl Prepared<'_> {
    /// `3-PRR R=3.066 …`, as the program reads it.
    fn title(&self) -> String {
        self.evaluation.design.to_string()
    }

    /// Name of the model in files that want an identifier.
    fn identifier(&self) -> String {
        let name = self.evaluation.design.architecture.name();
        format!("kinefront_{}", name.to_lowercase().replace('-', "_"))
    }

    /// What every simulator's file says at its head.
    fn preamble(&self, format: Format) -> String {
        let mut words = format!(
            "{}\nWritten by Kinefront {}. Lengths in m, angles in rad, masses in kg; base frame, z out of the plane of motion.\n\
             Bars are solid cylinders of density {} kg/m^3; bodies without mass in the model have {MASSLESS} kg here.",
            self.title(),
            env!("CARGO_PKG_VERSION"),
            self.model.material.density,
        );
        let counted = self.model.platform_bars;
        if counted as usize != LEGS {
            words +=
                &format!(" The study counts {counted} of the platform's three bars: each has that share of its mass.");
        }
        if matches!(format, Format::Sdf | Format::Urdf) {
            words += "\nJoint values count from the pose that is written.";
        }
        if let Some(lost) = format.lost() {
            words += "\nNot in this file: ";
            words += lost;
            words.push('.');
        }
        words
    }
}

/// Mass that simulators are given for a body that has none in the model \[kg\].
const MASSLESS: f64 = 1e-3;

/// Mass, centre and moments of inertia `[xx, yy, zz, xy]` of a body for a simulator.
fn inertial(body: &Body) -> (f64, DVec3, [f64; 4]) {
    let mass = body.mass();
    if mass > 0.0 {
        return (mass, body.centre_of_mass().extend(body.height), body.inertia());
    }
    // Of a ball with a radius of a centimetre.
    let moment = 0.4 * MASSLESS * 1e-4;
    (MASSLESS, DVec3::Z * body.height, [moment, moment, moment, 0.0])
}

/// A length, angle or direction as text: the shortest that reads back to the same bits. What turning frames leaves of a zero
/// is a zero.
fn text(value: f64) -> String {
    const NOTHING: f64 = 1e-14;
    if value.abs() < NOTHING {
        "0".to_owned()
    } else {
        value.to_string()
    }
}

/// A part's colour, 0 to 1.
fn rgba(part: Part) -> [f64; 4] {
    let [r, g, b] = palette::part(part).map(|value| (f64::from(value) / 255.0 * 1e3).round() / 1e3);
    [r, g, b, 1.0]
}

/// Name of the joint by which a body hangs on its parent.
fn joint_name(body: &Body) -> String {
    format!("{}_joint", body.name)
}

/// Axis of a joint in its body's frame.
fn joint_axis(kind: Actuator) -> &'static str {
    match kind {
        Actuator::Prismatic => "1 0 0",
        Actuator::Revolute => "0 0 1",
    }
}

/// Where SDF and URDF put a shape that they centre, with cylinders along z: position and roll, pitch, yaw.
fn place(shape: &SolidShape) -> [f64; 6] {
    match *shape {
        SolidShape::Block { centre, angle, .. } => [centre.x, centre.y, centre.z, 0.0, 0.0, angle],
        SolidShape::Bar { from, to, .. } => {
            let middle = 0.5 * (from + to);
            let way = (to - from).truncate();
            // Bars lie in the plane; pins stand upright.
            let (pitch, yaw) = if way.length() > 0.0 {
                (std::f64::consts::FRAC_PI_2, libm::atan2(way.y, way.x))
            } else {
                (0.0, 0.0)
            };
            [middle.x, middle.y, middle.z, 0.0, pitch, yaw]
        }
    }
}

/// The design in a format.
///
/// # Errors
/// [`ExportError`] when the pose is not reached, or a simulator's bar has no radius.
pub fn export(subject: &Subject, format: Format) -> Result<Vec<u8>, ExportError> {
    let Subject {
        study,
        evaluation,
        pose,
    } = *subject;
    let model = study.model();
    let design = &evaluation.design;
    let pose = pose.unwrap_or_else(|| model.home(evaluation));
    let linkage = linkage(&model, design, &pose)?;
    let scene = manipulator(&model, design, &pose)?;
    let solid = design.leg_bar_radius > 0.0 && design.platform_bar_radius > 0.0;
    if !solid && matches!(format, Format::Mjcf | Format::Sdf | Format::Urdf) {
        return Err(ExportError::NoBar(format.key()));
    }
    let cylinder = regular_workspace(evaluation, study.workspace.rotation_range_deg);
    let tour = cylinder.and_then(|cylinder| tour(&model, design, &cylinder, TOUR_STEPS));
    let prepared = Prepared {
        study,
        evaluation,
        model,
        pose,
        linkage,
        base: scene.base_bars(design.base_radius),
        scene,
        cylinder,
        tour,
    };
    let failed = |message: String| ExportError::Format {
        format: format.key(),
        message,
    };
    match format {
        Format::Gltf => gltf::write(&prepared).map_err(failed),
        Format::Mjcf => mjcf::write(&prepared).map_err(failed),
        Format::Sdf => sdf::write(&prepared).map_err(failed),
        Format::Urdf => urdf::write(&prepared).map_err(failed),
        Format::Dxf => dxf::write(&prepared).map_err(failed),
        Format::Json => json::write(&prepared).map_err(failed),
    }
}
