//! Motion of a manipulator with its payload: rates, the forces of the actuators, natural frequencies, and the error of the pose
//! (docs/model.md, section 15).
//!
//! A leg is a chain of three joints, and what follows them are its bodies. One rule serves all chains: the twists of the joints give the
//! velocities and accelerations of the bodies, and virtual work gives the forces. Everything is written over [`Real`], so that a report
//! of one pose and an evaluation of many use the same formulas.

mod above;
mod bar_shape;
mod displacement;
mod drive;
mod effort;
mod enclosed_task;
mod error;
mod frame;
mod frequency;
mod inverse;
mod law;
mod legs;
mod limits;
mod modes;
mod report;
mod settings;
mod task;

pub use drive::{Drive, DriveCatalogue, DriveCatalogueError};
pub(crate) use effort::{MotionJob, MotionValue};
pub(crate) use enclosed_task::EnclosedMotion;
pub use law::MotionLaw;
pub(crate) use legs::DynamicsInputs;
pub(crate) use limits::{LegsJob, LimitJob};
pub use report::{Accuracy, DynamicsReport, ErrorBudget, Gains, Motion, Response, VibratingBar, VibratingPoint};
pub use settings::{Anywhere, DriveInertia, DynamicsSettings, Payload, Tolerances};
pub use task::{Task, TaskFrame, TaskInstant, TaskMotion, TaskShape, TaskTiming};

use glam::DVec2;

use crate::lanes::{Planar, Real};
use crate::mechanism::{
    Architecture, BarLength, CrossSection, CrossSections, Design, JointKind, JointMasses, JointPart, LegFrame,
    LegSettings, MemberKind,
};
use crate::spatial::LEGS;
use crate::stiffness::{BarCompliance, Material, StiffnessModel};
use crate::strength::path::{BARS, LegPath, PLATFORM, PathJoint};

/// What the motion of one design depends on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DynamicsModel {
    settings: DynamicsSettings,
    paths: [LegPath; LEGS],
    /// Place of the bodies of the pieces of each bar: the number of joints before it.
    bodies: [[usize; 2]; BARS],
    /// Square of the radius of gyration of the sections of the legs and of the platform about an axis in the section \[m²\].
    gyration: [f64; 2],
    compliance: [BarCompliance; 2],
    /// Compliance of an actuator \[m/N or rad/(N·m)\].
    actuator_compliance: f64,
    /// Length of a telescopic leg in the beam model where that is the same at all poses \[m\].
    telescopic_beam: Option<f64>,
    /// Bodies on points of each leg, in the order of its joints: joints, motors and sliders.
    points: [Option<PointMass>; POINTS],
    actuator: JointKind,
    driven: usize,
    /// Number of revolute joints of a leg.
    revolutes: f64,
    /// Whether the rails bend, of whose share in vibrations nothing is known.
    is_on_bending_rails: bool,
    /// Rails of the legs, for chains on rails.
    rails: Option<[Rail; LEGS]>,
    /// `c_1`, of which the orientation of the platform follows \[m\].
    first_joint: DVec2,
    /// `EI/m` of a leg bar, whose mass is that of the length `L_b`; the frequency of its own bending follows \[m³/s²\].
    bar_bending: f64,
}

/// A rail between two points of the base whose places have errors.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Rail {
    /// The point from which positions on the rail are measured \[m\].
    from: DVec2,
    /// Unit vector along the rail.
    axis: DVec2,
    /// Distance of the other point \[m\].
    length: f64,
    /// Whether the other point is the base joint of the next leg.
    meets_next: bool,
}

/// Most point masses of a leg: three joints, a motor and a slider.
const POINTS: usize = 5;

/// A mass at a joint of a leg.
#[derive(Debug, Clone, Copy, PartialEq)]
struct PointMass {
    /// The joint at whose place it is.
    joint: usize,
    /// The body with which it moves: the number of joints before it.
    body: usize,
    mass: f64,
}

/// Settings and constants from which the motion of a design is prepared.
pub(crate) struct DynamicsBasis<'a> {
    pub settings: &'a DynamicsSettings,
    pub legs: &'a LegSettings,
    pub material: &'a Material,
    pub sections: &'a CrossSections,
    pub joints: JointMasses,
    pub platform_bars: u32,
}

impl DynamicsModel {
    /// Prepares a design whose stiffness is known.
    pub fn new(design: &Design, basis: &DynamicsBasis<'_>, stiffness: &StiffnessModel) -> Self {
        let (settings, sections, material) = (basis.settings, basis.sections, basis.material);
        let architecture = design.architecture();
        let radii = [design.leg_bar_radius(), design.platform_bar_radius()];
        let density = |section: &CrossSection, radius: f64| section.mass_per_length(material.density, radius);
        let gyration = |section: &CrossSection, radius: f64| section.inertia(radius) / section.area(radius);
        let of_leg = density(&sections.legs, radii[0]);
        let of_platform = density(&sections.platform, radii[1]) * f64::from(basis.platform_bars) / LEGS as f64;
        let paths = [0, 1, 2].map(|index| LegPath::new(design, basis.legs, index, [of_leg, of_platform]));
        let chain = architecture.chain();
        let geometry = &basis.legs.geometry;
        let rail = |index: usize| {
            let frame = LegFrame::new(design, geometry, index);
            let next = geometry.base_joint((index + 1) % LEGS, design.base_radius()) - frame.anchor;
            let meets_next = frame.rail.distance(next / next.length()) <= 1e-9;
            let [from, to] = match meets_next {
                true => [0.0, next.length()],
                false => frame.rail_travel,
            };
            Rail {
                from: frame.anchor + frame.rail * from,
                axis: frame.rail,
                length: to - from,
                meets_next,
            }
        };
        let bending = 1.0 / stiffness.bars_of_design()[0].bending;
        let longest = design.link_length();
        Self {
            settings: *settings,
            bodies: bodies_of_pieces(&paths[0]),
            gyration: [
                gyration(&sections.legs, radii[0]),
                gyration(&sections.platform, radii[1]),
            ],
            compliance: stiffness.bars_of_design(),
            actuator_compliance: stiffness.actuator_compliance(),
            telescopic_beam: match basis.legs.telescopic_bar {
                BarLength::Longest if chain.distal == MemberKind::TelescopicLeg => Some(longest),
                _ => None,
            },
            points: points(architecture, basis.joints, settings.drives.slider_mass, &paths[0]),
            actuator: architecture.actuator(),
            driven: architecture.driven(),
            revolutes: chain.joints.iter().filter(|kind| **kind == JointKind::Revolute).count() as f64,
            is_on_bending_rails: stiffness.is_on_bending_rails(),
            rails: chain.is_on_rails().then(|| [0, 1, 2].map(rail)),
            first_joint: geometry.platform_joint(0, design.platform_radius()),
            bar_bending: bending / (of_leg * longest),
            paths,
        }
    }

    /// Returns the square of the radius of gyration of the section of a bar \[m²\].
    #[inline(always)]
    fn gyration(&self, bar: usize) -> f64 {
        self.gyration[usize::from(bar == PLATFORM)]
    }

    /// Returns the compliances per length of a bar.
    #[inline(always)]
    fn compliance(&self, bar: usize) -> &BarCompliance {
        &self.compliance[usize::from(bar == PLATFORM)]
    }

    /// Returns the part of gravity in the plane.
    #[inline(always)]
    fn gravity<V: Real>(&self, like: V) -> Planar<V> {
        let [x, y, _] = self.settings.gravity;
        Planar::new(like.splat(x), like.splat(y))
    }
}

/// Returns the number of joints before each piece of a bar.
fn bodies_of_pieces(path: &LegPath) -> [[usize; 2]; BARS] {
    let mut bodies = [[0; 2]; BARS];
    for (bar, pieces) in bodies.iter_mut().enumerate() {
        for (piece, body) in pieces.iter_mut().enumerate() {
            let is_beyond = |joint: &PathJoint| {
                if joint.is_bush {
                    // The rod, and what it carries.
                    bar == PLATFORM || bar + 1 == PLATFORM && piece == 1
                } else {
                    bar >= joint.before
                }
            };
            *body = path.joints.iter().filter(|joint| is_beyond(joint)).count();
        }
    }
    bodies
}

/// Returns the point masses of a leg.
fn points(architecture: Architecture, joints: JointMasses, slider: f64, path: &LegPath) -> [Option<PointMass>; POINTS] {
    let of = |part: JointPart| {
        let place = part.place;
        // A carriage moves with the member that is not its guide: the one before it where the guide is on the platform, or the rod of a
        // telescopic leg, and the one after it elsewhere.
        let carriage_follows = place < 2 && !path.joints[place].is_bush;
        let body = match part.kind {
            JointKind::Prismatic if carriage_follows && !part.is_motor => place + 1,
            _ => place,
        };
        PointMass {
            joint: place,
            body,
            mass: part.mass,
        }
    };
    let on_rails = architecture.chain().is_on_rails();
    let slider = on_rails.then_some(PointMass {
        joint: 0,
        body: 1,
        mass: slider,
    });
    let mut found = joints.of_leg(architecture).map(of).chain(slider);
    let mut points = [None; POINTS];
    for point in &mut points {
        // What stands still, or weighs nothing, moves nothing.
        *point = found.find(|point| point.mass > 0.0 && point.body > 0);
    }
    points
}
