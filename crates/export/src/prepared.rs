//! What every format is written from, and what several of them need.

use std::borrow::Cow;

use glam::{DVec2, DVec3};

use super::ExportSubject;
use kinefront_model::dynamics::TaskMotion;
use kinefront_model::evaluation::{Evaluation, Model, Unreachable};
use kinefront_model::mechanism::JointKind;
use kinefront_model::spatial::Pose;
use kinefront_scene::palette;
use kinefront_scene::{
    Body, Linkage, Part, RegularCylinder, Scene, Solid, SolidShape, Tour, linkage, manipulator, region_corners,
    regular_workspace, tour,
};
use kinefront_study::Study;

/// Number of poses around each rim of the exported tour.
const TOUR_STEPS: usize = 72;

/// A subject prepared for every format.
pub(super) struct Prepared<'a> {
    pub(super) study: &'a Study,
    pub(super) model: &'a Model,
    /// The model with the motors and rotors of the drive that the design selects, for what moves as a whole.
    pub(super) driven: Cow<'a, Model>,
    pub(super) evaluation: &'a Evaluation,
    pub(super) pose: Pose,
    pub(super) linkage: Linkage,
    pub(super) scene: Scene,
    /// The fixed parts (base triangle, rails, and motors on the base) as solids.
    pub(super) base: Vec<Solid>,
    pub(super) cylinder: Option<RegularCylinder>,
    /// Corners of the workspace if the study prescribes a polygon, in the base frame \[m\].
    pub(super) corners: Option<Vec<DVec2>>,
    pub(super) tour: Option<Tour>,
}

impl<'a> Prepared<'a> {
    pub(super) fn new(subject: &ExportSubject<'a>) -> Result<Self, Unreachable> {
        let ExportSubject {
            study,
            evaluation,
            pose,
        } = *subject;
        let (study, model) = (study.study(), study.model());
        let driven = model.driven_by(evaluation.drive);
        let design = &evaluation.design;
        let pose = pose.unwrap_or_else(|| model.home(evaluation));
        let linkage = linkage(&driven, design, &pose)?;
        let scene = manipulator(model, design, &pose)?;
        let cylinder = regular_workspace(evaluation, study.workspace.rotation_range_deg);
        let tour = cylinder.and_then(|cylinder| tour(model, design, &cylinder, TOUR_STEPS));
        Ok(Self {
            study,
            model,
            evaluation,
            pose,
            base: [
                scene.base_bars(design.base_radius(), model.rails_of(design)),
                linkage.base_motors.clone(),
            ]
            .concat(),
            linkage,
            scene,
            corners: cylinder.and_then(|_| region_corners(model)),
            cylinder,
            tour,
            driven,
        })
    }

    /// Returns the motion of the study, scaled to the workspace of the design.
    ///
    /// # Errors
    /// Why there is none, in words.
    pub(super) fn motion(&self) -> Result<TaskMotion, String> {
        let Some(task) = &self.model.settings().task else {
            return Err(format!("the study `{}` defines no motion in [task]", self.study.name));
        };
        let frame = self.model.frame_of_task(self.evaluation);
        task.motion(&frame)
            .ok_or_else(|| kinefront_scene::text::NO_MOTION.to_owned())
    }

    /// Whether every length, mass and moment of inertia is finite, as a double and with the single precision of triangles.
    pub(super) fn is_finite(&self) -> bool {
        let of_body = |body: &Body| {
            let (mass, centre, inertia) = inertial(body);
            let frame = [body.frame.origin.x, body.frame.origin.y, body.frame.angle, body.height];
            let numbers = [mass, centre.x, centre.y, centre.z];
            numbers
                .iter()
                .chain(&inertia)
                .chain(&frame)
                .all(|number| number.is_finite())
        };
        let solids = self.linkage.bodies.iter().flat_map(|body| &body.solids);
        let mut corners = solids
            .chain(&self.base)
            .chain(&self.scene.solids)
            .flat_map(|solid| solid.shape.mesh().positions);
        self.linkage.bodies.iter().all(of_body) && corners.all(|corner| corner.as_vec3().is_finite())
    }

    /// Returns the design as text that the program can read: `3-PRR R=3.066 …`.
    pub(super) fn title(&self) -> String {
        self.evaluation.design.to_string()
    }

    /// Returns the name of the model for formats that require an identifier.
    pub(super) fn identifier(&self) -> String {
        let name = self.evaluation.design.architecture().name();
        format!("kinefront_{}", name.to_lowercase().replace('-', "_"))
    }
}

/// Mass written for a body that has no mass in the model, because simulators require one \[kg\].
pub(super) const MASSLESS: f64 = 1e-3;

/// Mass up to which simulators refuse a body \[kg\].
const LEAST_MASS: f64 = 1e-12;

/// Returns the mass, centre of mass and moments of inertia `[xx, yy, zz, xy]` of a body for a simulator.
pub(super) fn inertial(body: &Body) -> (f64, DVec3, [f64; 4]) {
    let mass = match body.mass() {
        mass if mass > LEAST_MASS => mass,
        _ => MASSLESS,
    };
    let centre = body.centre_of_mass().extend(body.height);
    let [xx, yy, zz, xy] = body.inertia();
    if !body.bars.is_empty() {
        return (mass, centre, [xx, yy, zz, xy]);
    }
    // Joints are points, whose moments of inertia simulators refuse: they become a solid sphere with a radius of 1 cm.
    let sphere = 0.4 * mass * 1e-4;
    (mass, centre, [xx + sphere, yy + sphere, zz + sphere, xy])
}

/// Returns the elements of an inertia tensor in the plane by their names in SDF and URDF.
pub(super) fn inertia_elements([xx, yy, zz, xy]: [f64; 4]) -> impl Iterator<Item = (&'static str, String)> {
    let names = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"].into_iter();
    names.zip([xx, xy, 0.0, yy, 0.0, zz].map(|value| value.to_string()))
}

/// Formats a length, angle or direction with the fewest digits that read back to the same value. Values below 1e-14,
/// which the rotation of frames leaves in place of zeros, are written as 0.
pub(super) fn text(value: f64) -> String {
    const NOTHING: f64 = 1e-14;
    if value.abs() < NOTHING {
        "0".to_owned()
    } else {
        value.to_string()
    }
}

/// Returns the colour of a part as RGBA, each value from 0 to 1.
pub(super) fn rgba(part: Part) -> [f64; 4] {
    let [r, g, b] = palette::part(part).map(|value| (f64::from(value) / 255.0 * 1e3).round() / 1e3);
    [r, g, b, 1.0]
}

/// Returns the name of the joint between a body and its parent.
pub(super) fn joint_name(body: &Body) -> String {
    format!("{}_joint", body.name)
}

/// Returns the name of a kind of joint.
pub(super) fn kind_name(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Prismatic => "prismatic",
        JointKind::Revolute => "revolute",
    }
}

/// Returns the axis of a joint in the frame of its body.
pub(super) fn joint_axis(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Prismatic => "1 0 0",
        JointKind::Revolute => "0 0 1",
    }
}

/// Returns the position and the roll, pitch and yaw of a shape for SDF and URDF, in which a shape is centred at its
/// origin and a cylinder lies along z.
pub(super) fn place(shape: &SolidShape) -> [f64; 6] {
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

/// Whether a text has a number that is infinite or not a number.
pub(super) fn has_number_that_is_none(text: &[u8]) -> bool {
    let mut words = text.split(|byte| !byte.is_ascii_alphanumeric());
    words.any(|word| [&b"NaN"[..], b"inf"].contains(&word))
}
