//! The manipulator as a tree of rigid bodies with loop closures, as simulators and animations need it.

use glam::DVec2;

use super::Solid;
use super::manipulator::{Sizes, motor};
use kinefront_model::dynamics::Payload;
use kinefront_model::evaluation::{Model, Unreachable};
use kinefront_model::mechanism::{
    AnyLeg, ChainPosture, CrossSection, Design, JointKind, JointPart, JointPoint, LegBody, LegPart, Manipulator,
    MemberKind,
};
use kinefront_model::spatial::{LEGS, Pose, Rotation};

/// A planar frame, given in the base frame or in the frame of another body.
#[derive(Debug, Clone, Copy, PartialEq)]
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
#[derive(Debug, Clone, PartialEq)]
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

/// Connection of a leg's last body to the platform, which closes a loop, at `C_i`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closure {
    /// Whether the body cannot turn in the platform either, because it is a guide of the platform.
    pub is_rigid: bool,
    /// Index of the leg's last body.
    pub leg: usize,
    /// `C_i` in the frame of that body \[m\].
    pub on_leg: DVec2,
    /// `C_i` in the platform frame \[m\].
    pub on_platform: DVec2,
    /// Angle from the platform frame to the frame of the leg's last body \[rad\].
    pub angle: f64,
}

/// The manipulator at a pose as rigid bodies: the bodies of legs 1, 2 and 3, each from the base outwards, then the
/// platform.
#[derive(Debug, Clone, PartialEq)]
pub struct Linkage {
    /// The bodies.
    pub bodies: Vec<Body>,
    /// The connections at `C_1`, `C_2`, `C_3`.
    pub closures: [Closure; LEGS],
    /// The motors that stand on the base and to which the study gives a size, in the base frame.
    pub base_motors: Vec<Solid>,
}

impl Linkage {
    /// Returns the index of the platform.
    pub fn platform(&self) -> usize {
        self.bodies.len() - 1
    }

    /// Returns the frame of a body in the frame of its parent.
    pub fn local_frame(&self, body: &Body) -> Frame {
        let Some(parent) = body.parent.map(|parent| self.bodies[parent].frame) else {
            return body.frame;
        };
        let back = Rotation::new(-parent.angle);
        Frame {
            origin: back.apply(body.frame.origin - parent.origin),
            angle: body.frame.angle - parent.angle,
        }
    }
}

/// Builds the rigid bodies of `design` at `pose`.
///
/// # Errors
/// [`Unreachable`], which names the leg that does not reach the pose.
pub fn linkage(model: &Model, design: &Design, pose: &Pose) -> Result<Linkage, Unreachable> {
    let manipulator = Manipulator::<AnyLeg>::new(design, &model.settings().legs);
    let posture = manipulator
        .posture(pose)
        .map_err(|(leg, shortfall)| Unreachable { leg, shortfall })?;
    let arranged = model.bodies_of(design);
    let sizes = Sizes::in_stack(model, design, *arranged.stack());
    let description = design.architecture().chain();
    // A motor at the platform turns a mount, on which the platform is fixed.
    let has_mounts = design.architecture().driven() == 2 && description.joints[2] == JointKind::Revolute;
    let mut bodies: Vec<Body> = Vec::new();
    let (mut first_of_leg, mut last) = ([0; LEGS], [0; LEGS]);
    for (index, (leg, state)) in manipulator.legs.iter().zip(&posture.legs).enumerate() {
        let first = bodies.len();
        first_of_leg[index] = first;
        for (depth, body) in leg.bodies(state).iter().enumerate() {
            last[index] = bodies.len();
            let parent = (depth > 0).then(|| bodies.len() - 1);
            bodies.push(leg_body(model, design, &sizes, index, body, parent));
        }
        if has_mounts {
            let value = leg.joint_values(state)[2];
            let mut mount = mount(&sizes, index, state.chain.c, pose.phi, value, bodies.len() - 1);
            let bar = (&model.settings().sections.platform, design.platform_bar_radius());
            let ends = [state.chain.c, pose.position];
            let fraction = platform_fraction(model, has_mounts);
            mount.bars.push(mass_bar(model, &mount.frame, ends, bar, fraction));
            bodies.push(mount);
            last[index] = bodies.len() - 1;
        }
        if let [.., before, end] = bodies.as_mut_slice() {
            share_mass(before, end, &sizes);
        }
        add_joints(model, design, &mut bodies[first..], &state.chain);
    }
    let ends = posture.arms.map(|arm| pose.position + arm);
    bodies.push(platform_body(model, design, &sizes, pose, ends, has_mounts));
    let closures = [0, 1, 2].map(|index| {
        let on = |frame: &Frame| Rotation::new(-frame.angle).apply(ends[index] - frame.origin);
        Closure {
            is_rigid: has_mounts || description.joints[2] == JointKind::Prismatic,
            leg: last[index],
            on_leg: on(&bodies[last[index]].frame),
            on_platform: manipulator.platform_joints[index],
            angle: bodies[last[index]].frame.angle - pose.phi,
        }
    });
    let mut base_motors = Vec::new();
    let uprights = arranged.joints(&manipulator, pose.position, &posture).into_iter();
    for upright in uprights.filter(|upright| upright.member.kind == MemberKind::Motor) {
        let motor = motor(&upright);
        // A motor moves with the body before its joint.
        match design.architecture().driven().checked_sub(1) {
            Some(before) => {
                let body = &mut bodies[first_of_leg[upright.member.leg] + before];
                body.solids.push(motor.seen_from(body.frame.origin, body.frame.angle));
            }
            None => base_motors.push(motor),
        }
    }
    Ok(Linkage {
        bodies,
        closures,
        base_motors,
    })
}

/// A body of leg `index`; `parent` is the place of the body that it hangs on, or `None` for the base.
fn leg_body(
    model: &Model,
    design: &Design,
    sizes: &Sizes,
    index: usize,
    body: &LegBody,
    parent: Option<usize>,
) -> Body {
    let frame = Frame {
        origin: body.origin,
        angle: libm::atan2(body.axis.y, body.axis.x),
    };
    let joint = Joint {
        kind: body.joint.kind,
        actuated: body.joint.is_driven,
        value: if body.joint.is_driven || body.joint.kind == JointKind::Prismatic {
            body.joint.value
        } else {
            0.0
        },
        limits: body.joint.limits,
    };
    let solid = |part| sizes.solid(index, part).seen_from(frame.origin, frame.angle);
    let bars = body.parts.iter().filter_map(|part| match *part {
        LegPart::Tube { from, to }
        | LegPart::Rod { from, to }
        | LegPart::Crank { from, to }
        | LegPart::Link { from, to } => {
            let bar = (&model.settings().sections.legs, design.leg_bar_radius());
            Some(mass_bar(model, &frame, [from, to], bar, 1.0))
        }
        LegPart::GuideBar { from, to, kind } => {
            let bar = (&model.settings().sections.legs, design.leg_bar_radius());
            // The mass is that of the length in the design, wherever the travel begins.
            let length = match kind {
                MemberKind::TurningGuide => design.proximal_length(),
                _ => design.link_length(),
            };
            Some(mass_bar(model, &frame, [from, to], bar, length / from.distance(to)))
        }
        LegPart::Slider { .. } | LegPart::Carriage { .. } | LegPart::Joint { .. } => None,
    });
    Body {
        name: format!("leg{}_{}", index + 1, body.name),
        parent,
        frame,
        height: sizes.height(body.kind, index),
        joint: Some(joint),
        bars: bars.collect(),
        joints: Vec::new(),
        payload: Payload::default(),
        solids: body.parts.iter().map(solid).collect(),
    }
}

/// Gives the bodies of a leg the masses of its joints, of its slider and of its motor that move: a joint belongs to the body that it carries, and to the
/// last one if that is the platform; a motor belongs to the body before its joint.
fn add_joints(model: &Model, design: &Design, bodies: &mut [Body], chain: &ChainPosture) {
    let architecture = design.architecture();
    let description = architecture.chain();
    let tube = model.settings().legs.tube_length(design.link_length());
    let last = bodies.len() - 1;
    let slider = description.is_on_rails().then_some(JointPart {
        place: 0,
        kind: JointKind::Prismatic,
        is_motor: false,
        moves: true,
        mass: model.settings().dynamics.drives.slider_mass,
    });
    let parts = model.settings().joints.of_leg(architecture).chain(slider);
    for part in parts.filter(|part| part.moves && part.mass > 0.0) {
        let is_bush = part.kind == JointKind::Prismatic && description.distal == MemberKind::TelescopicLeg;
        let at = match description.points[part.place] {
            _ if is_bush => chain.a + chain.distal.direction * tube,
            JointPoint::A => chain.a,
            JointPoint::B => chain.b,
            JointPoint::C => chain.c,
        };
        // The bush belongs to the tube, and a carriage on a guide of the platform to what it connects the guide with.
        let carries_next = part.kind == JointKind::Prismatic && (is_bush || part.place == 2);
        let carrier = match part.is_motor || carries_next {
            true => part.place - 1,
            false => part.place,
        };
        let body = &mut bodies[carrier.min(last)];
        let at = Rotation::new(-body.frame.angle).apply(at - body.frame.origin);
        body.joints.push((at, part.mass));
    }
}

/// What the actuated joint at the end of leg `index` turns; it is fixed on the platform and has no size of its own.
fn mount(sizes: &Sizes, index: usize, at: DVec2, phi: f64, value: f64, parent: usize) -> Body {
    Body {
        name: format!("leg{}_mount", index + 1),
        parent: Some(parent),
        frame: Frame { origin: at, angle: phi },
        height: sizes.height(MemberKind::PlatformBar, index),
        joint: Some(Joint {
            kind: JointKind::Revolute,
            actuated: true,
            value,
            limits: None,
        }),
        bars: Vec::new(),
        joints: Vec::new(),
        payload: Payload::default(),
        solids: Vec::new(),
    }
}

/// Fraction of the mass of a platform bar that its body has. The study may count fewer platform bars than the three that exist
/// (docs/model.md, section 11), and a mount on which the bar is fixed has half of it: a body that a motor turns needs inertia.
fn platform_fraction(model: &Model, has_mounts: bool) -> f64 {
    let fraction = f64::from(model.settings().platform_bars) / LEGS as f64;
    if has_mounts { 0.5 * fraction } else { fraction }
}

/// Gives a driven body without mass at the end of a leg, a carriage on the guide of the body before it, half the mass of that guide: a
/// body that a motor moves needs inertia.
fn share_mass(before: &mut Body, end: &mut Body, sizes: &Sizes) {
    if !end.bars.is_empty() || !end.joint.is_some_and(|joint| joint.actuated) {
        return;
    }
    let Some(guide) = before.bars.first_mut().filter(|_| end.parent.is_some()) else {
        return;
    };
    guide.mass *= 0.5;
    let half = DVec2::X * sizes.carriage_half_length();
    end.bars.push(MassBar {
        from: -half,
        to: half,
        ..*guide
    });
}

/// The platform, with its joints `C_i` at `ends`.
fn platform_body(
    model: &Model,
    design: &Design,
    sizes: &Sizes,
    pose: &Pose,
    ends: [DVec2; LEGS],
    has_mounts: bool,
) -> Body {
    let frame = Frame {
        origin: pose.position,
        angle: pose.phi,
    };
    let fraction = platform_fraction(model, has_mounts);
    let bars = ends.map(|end| {
        let bar = (&model.settings().sections.platform, design.platform_bar_radius());
        mass_bar(model, &frame, [end, pose.position], bar, fraction)
    });
    let solid = |index: usize| {
        let bar = sizes.platform_bar(index, ends[index], pose.position);
        bar.seen_from(frame.origin, frame.angle)
    };
    Body {
        name: "platform".to_owned(),
        parent: None,
        frame,
        height: sizes.height(MemberKind::PlatformBar, 0),
        joint: None,
        bars: bars.to_vec(),
        joints: Vec::new(),
        payload: model.settings().dynamics.payload,
        solids: (0..LEGS).map(solid).collect(),
    }
}

fn mass_bar(
    model: &Model,
    frame: &Frame,
    [from, to]: [DVec2; 2],
    (section, radius): (&CrossSection, f64),
    fraction: f64,
) -> MassBar {
    let back = Rotation::new(-frame.angle);
    MassBar {
        from: back.apply(from - frame.origin),
        to: back.apply(to - frame.origin),
        radius,
        inner_radius: section.inner_radius(radius),
        is_square: section.is_square(),
        mass: fraction * model.bar_mass(section, radius, from.distance(to)),
    }
}
