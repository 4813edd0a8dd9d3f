//! The manipulator as a tree of rigid bodies with loop closures, as simulators and animations need it.

mod body;

use glam::DVec2;

pub use body::{Body, Frame, Joint, MassBar};

use super::Solid;
use super::manipulator::{Sizes, motor, posed};
use kinefront_model::evaluation::{Model, Unreachable};
use kinefront_model::mechanism::{
    AnyLeg, ChainPosture, CrossSection, Design, JointKind, JointPart, JointPoint, LegBody, LegPart, LegPosture,
    MemberKind,
};
use kinefront_model::spatial::{LEGS, Pose, Rotation};

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
    let (manipulator, posture) = posed(model, design, pose)?;
    let arranged = model.bodies_of(design);
    let kinds = design.architecture().chain().joints;
    let builder = Builder {
        model,
        design,
        sizes: Sizes::new(model, design, *arranged.stack()),
        has_mounts: design.architecture().driven() == 2 && kinds[2] == JointKind::Revolute,
    };
    let mut bodies: Vec<Body> = Vec::new();
    let (mut first_of_leg, mut last) = ([0; LEGS], [0; LEGS]);
    for (index, (leg, state)) in manipulator.legs.iter().zip(&posture.legs).enumerate() {
        first_of_leg[index] = bodies.len();
        builder.add_leg(&mut bodies, index, leg, state, pose);
        last[index] = bodies.len() - 1;
    }
    let ends = posture.arms.map(|arm| pose.position + arm);
    bodies.push(builder.platform(pose, ends));
    let closures = [0, 1, 2].map(|index| {
        let on = |frame: &Frame| Rotation::new(-frame.angle).apply(ends[index] - frame.origin);
        Closure {
            is_rigid: builder.has_mounts || kinds[2] == JointKind::Prismatic,
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

/// What the bodies of a design are built from.
struct Builder<'a> {
    model: &'a Model,
    design: &'a Design,
    sizes: Sizes<'a>,
    /// Whether a motor at the platform turns a mount, on which the platform is fixed.
    has_mounts: bool,
}

impl Builder<'_> {
    /// Adds the bodies of leg `index`, from the base outwards.
    fn add_leg(&self, bodies: &mut Vec<Body>, index: usize, leg: &AnyLeg, state: &LegPosture, pose: &Pose) {
        let first = bodies.len();
        for (depth, body) in leg.bodies(state).iter().enumerate() {
            let parent = (depth > 0).then(|| bodies.len() - 1);
            bodies.push(self.leg_body(index, body, parent));
        }
        if self.has_mounts {
            let value = leg.joint_values(state)[2];
            bodies.push(self.mount(index, state.chain.c, pose, value, bodies.len() - 1));
        }
        if let [.., before, end] = bodies.as_mut_slice() {
            share_mass(before, end, &self.sizes);
        }
        self.add_joints(&mut bodies[first..], &state.chain);
    }

    /// A body of leg `index`; `parent` is the place of the body that it hangs on, or `None` for the base.
    fn leg_body(&self, index: usize, body: &LegBody, parent: Option<usize>) -> Body {
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
        let solid = |part| self.sizes.solid(index, part).seen_from(frame.origin, frame.angle);
        let bars = body.parts.iter().filter_map(|part| match *part {
            LegPart::Tube { from, to }
            | LegPart::Rod { from, to }
            | LegPart::Crank { from, to }
            | LegPart::Link { from, to } => Some(self.leg_bar(&frame, [from, to], 1.0)),
            LegPart::GuideBar { from, to, kind } => {
                // The mass is that of the length in the design, wherever the travel begins.
                let length = match kind {
                    MemberKind::TurningGuide => self.design.proximal_length(),
                    _ => self.design.link_length(),
                };
                Some(self.leg_bar(&frame, [from, to], length / from.distance(to)))
            }
            LegPart::Slider { .. } | LegPart::Carriage { .. } | LegPart::Joint { .. } => None,
        });
        Body {
            name: format!("leg{}_{}", index + 1, body.name),
            parent,
            frame,
            height: self.sizes.height(body.kind, index),
            joint: Some(joint),
            bars: bars.collect(),
            solids: body.parts.iter().map(solid).collect(),
            ..Body::default()
        }
    }

    /// Gives the bodies of a leg the masses of its joints, of its slider and of its motor that move: a joint belongs to the body that it carries, and to the
    /// last one if that is the platform; a motor belongs to the body before its joint.
    fn add_joints(&self, bodies: &mut [Body], chain: &ChainPosture) {
        let settings = self.model.settings();
        let architecture = self.design.architecture();
        let description = architecture.chain();
        let tube = settings.legs.tube_length(self.design.link_length());
        let last = bodies.len() - 1;
        let slider = description.is_on_rails().then_some(JointPart {
            place: 0,
            kind: JointKind::Prismatic,
            is_motor: false,
            moves: true,
            mass: settings.dynamics.drives.slider_mass,
        });
        let parts = settings.joints.of_leg(architecture).chain(slider);
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
    fn mount(&self, index: usize, at: DVec2, pose: &Pose, value: f64, parent: usize) -> Body {
        let frame = Frame {
            origin: at,
            angle: pose.phi,
        };
        Body {
            name: format!("leg{}_mount", index + 1),
            parent: Some(parent),
            frame,
            height: self.sizes.height(MemberKind::PlatformBar, index),
            joint: Some(Joint {
                kind: JointKind::Revolute,
                actuated: true,
                value,
                limits: None,
            }),
            bars: vec![self.platform_bar(&frame, [at, pose.position])],
            ..Body::default()
        }
    }

    /// The platform, with its joints `C_i` at `ends`.
    fn platform(&self, pose: &Pose, ends: [DVec2; LEGS]) -> Body {
        let frame = Frame {
            origin: pose.position,
            angle: pose.phi,
        };
        let solid = |index: usize| {
            let bar = self.sizes.platform_bar(index, ends[index], pose.position);
            bar.seen_from(frame.origin, frame.angle)
        };
        Body {
            name: "platform".to_owned(),
            frame,
            height: self.sizes.height(MemberKind::PlatformBar, 0),
            bars: ends.map(|end| self.platform_bar(&frame, [end, pose.position])).to_vec(),
            payload: self.model.settings().dynamics.payload,
            solids: (0..LEGS).map(solid).collect(),
            ..Body::default()
        }
    }

    fn leg_bar(&self, frame: &Frame, ends: [DVec2; 2], fraction: f64) -> MassBar {
        let section = &self.model.settings().sections.legs;
        self.mass_bar(frame, ends, (section, self.design.leg_bar_radius()), fraction)
    }

    /// A bar of the platform with the fraction of its mass that its body has. The study may count fewer platform bars than the three that
    /// exist (docs/model.md, section 11), and a mount on which the bar is fixed has half of it: a body that a motor turns needs inertia.
    fn platform_bar(&self, frame: &Frame, ends: [DVec2; 2]) -> MassBar {
        let fraction = f64::from(self.model.settings().platform_bars) / LEGS as f64;
        let fraction = if self.has_mounts { 0.5 * fraction } else { fraction };
        let section = &self.model.settings().sections.platform;
        self.mass_bar(frame, ends, (section, self.design.platform_bar_radius()), fraction)
    }

    fn mass_bar(
        &self,
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
            mass: fraction * self.model.bar_mass(section, radius, from.distance(to)),
        }
    }
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
