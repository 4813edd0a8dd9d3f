//! A rigid body: its frame, its joint, its bars, and its mass with the moments of inertia.

use glam::DVec2;

use crate::Solid;
use kinefront_model::dynamics::Payload;
use kinefront_model::mechanism::JointKind;

/// A planar frame, given in the base frame or in the frame of another body.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Frame {
    /// Origin \[m\].
    pub origin: DVec2,
    /// Angle from the reference x axis to the x axis of this frame \[rad\].
    pub angle: f64,
}

/// The joint that connects a body to its parent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joint {
    /// Kind of the joint: a prismatic joint moves along the body's x axis, a revolute joint turns about z at the body's
    /// origin.
    pub kind: JointKind,
    /// Whether the joint is actuated.
    pub actuated: bool,
    /// Joint value \[m or rad\]; that of a passive revolute joint counts from the pose of the linkage.
    pub value: f64,
    /// Smallest and largest value, if the joint has limits.
    pub limits: Option<[f64; 2]>,
}

/// A bar with mass, in the frame of its body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassBar {
    /// One end \[m\].
    pub from: DVec2,
    /// The other end \[m\].
    pub to: DVec2,
    /// Radius, or half of the width of a square bar \[m\].
    pub radius: f64,
    /// Inner radius, or half of the inner width \[m\]; 0 for a solid bar.
    pub inner_radius: f64,
    /// Whether the cross-section is square rather than round.
    pub is_square: bool,
    /// Mass \[kg\].
    pub mass: f64,
}

/// A rigid body.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Body {
    /// Name, such as `leg1_crank` or `platform`.
    pub name: String,
    /// Index of the parent body; `None` if the parent is the base, and for the platform, which has no parent.
    pub parent: Option<usize>,
    /// Frame of the body in the base frame.
    pub frame: Frame,
    /// Height of the bars above the plane of the frames \[m\].
    pub height: f64,
    /// The joint to the parent; `None` for the platform, which only the closures hold in the plane.
    pub joint: Option<Joint>,
    /// The bars that have mass.
    pub bars: Vec<MassBar>,
    /// Joints and motors that move with the body: where they are \[m\], and their masses \[kg\]. They have none in the paper.
    pub joints: Vec<(DVec2, f64)>,
    /// What the body carries: the payload of the study, on the platform.
    pub payload: Payload,
    /// The solids to draw, in the frame of the body.
    pub solids: Vec<Solid>,
}

impl Body {
    /// Returns the mass with that of the payload \[kg\].
    pub fn mass(&self) -> f64 {
        let bars = self.bars.iter().fold(0.0, |sum, bar| sum + bar.mass);
        self.points().fold(bars, |sum, (_, mass)| sum + mass)
    }

    /// Joints, motors and the payload: where their centres of mass are \[m\], and their masses \[kg\].
    fn points(&self) -> impl Iterator<Item = (DVec2, f64)> {
        let payload = (DVec2::from(self.payload.centre), self.payload.mass);
        self.joints.iter().copied().chain([payload])
    }

    /// Returns the centre of mass in the body's frame \[m\]; the origin if the body has no mass.
    pub fn centre_of_mass(&self) -> DVec2 {
        let mass = self.mass();
        let bars: DVec2 = self.bars.iter().map(|bar| 0.5 * (bar.from + bar.to) * bar.mass).sum();
        let weighted = self.points().fold(bars, |sum, (at, mass)| sum + at * mass);
        if mass > 0.0 { weighted / mass } else { DVec2::ZERO }
    }

    /// Computes the elements `xx, yy, zz, xy` of the inertia tensor about the centre of mass in the body's axes
    /// \[kg·m²\], with the bars as prisms of their cross-sections; `xy` is `−∫xy dm`. The payload has half of its moment of inertia
    /// about x and about y, as in the natural frequencies.
    pub fn inertia(&self) -> [f64; 4] {
        let centre = self.centre_of_mass();
        let of_payload = self.payload.inertia;
        let mut inertia = [0.5 * of_payload, 0.5 * of_payload, of_payload, 0.0];
        for bar in &self.bars {
            let way = bar.to - bar.from;
            let length = way.length();
            let axis = way.normalize_or(DVec2::X);
            let squares = bar.radius * bar.radius + bar.inner_radius * bar.inner_radius;
            // Twelve times the squared radius of gyration of the section about an axis in its plane.
            let section = if bar.is_square { 4.0 } else { 3.0 } * squares;
            let along = bar.mass * section / 6.0;
            let across = bar.mass * (section + length * length) / 12.0;
            let offset = 0.5 * (bar.from + bar.to) - centre;
            let (cc, ss, cs) = (axis.x * axis.x, axis.y * axis.y, axis.x * axis.y);
            inertia[0] += along * cc + across * ss + bar.mass * offset.y * offset.y;
            inertia[1] += along * ss + across * cc + bar.mass * offset.x * offset.x;
            inertia[2] += across + bar.mass * offset.length_squared();
            inertia[3] += (along - across) * cs - bar.mass * offset.x * offset.y;
        }
        for (at, mass) in self.points() {
            let offset = at - centre;
            inertia[0] += mass * offset.y * offset.y;
            inertia[1] += mass * offset.x * offset.x;
            inertia[2] += mass * offset.length_squared();
            inertia[3] -= mass * offset.x * offset.y;
        }
        inertia
    }
}
