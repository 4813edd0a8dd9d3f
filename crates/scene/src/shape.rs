//! Named shapes.

use glam::DVec3;
use kinefront_model::clearance::MemberId;
use kinefront_model::mechanism::MemberKind;
use kinefront_model::stiffness::RailSettings;

/// The part of the manipulator or drawing that a shape represents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// Triangle `A1A2A3`.
    Base,
    /// Rail of a slider, over the slider's travel.
    Rail,
    /// Stroke of a telescopic leg, from its shortest to its longest length.
    Stroke,
    /// Driven slider or carriage.
    Slider,
    /// Slider or carriage that no actuator drives.
    Carriage,
    /// Bar on which a carriage moves.
    Guide,
    /// Fixed half of a telescopic leg.
    Tube,
    /// Moving half of a telescopic leg.
    Rod,
    /// Bar between a revolute base joint and the next one.
    Crank,
    /// Last bar of a leg, up to `C_i`.
    Link,
    /// Bar of the platform, from `C_i` to `P`.
    PlatformBar,
    /// Actuated joint.
    ActuatedJoint,
    /// Passive joint.
    PassiveJoint,
    /// x axis of a frame.
    AxisX,
    /// y axis of a frame.
    AxisY,
    /// The regular workspace.
    Workspace,
    /// Edges of an obstacle.
    Obstacle,
    /// Edges of the room.
    Room,
}

/// Shape of a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SolidShape {
    /// Circular cylinder or tube, given by the centres of its end faces.
    Bar {
        /// Centre of one end.
        from: DVec3,
        /// Centre of the other end.
        to: DVec3,
        /// Radius.
        radius: f64,
        /// Radius of the bore of a tube; 0 for a solid cylinder.
        inner: f64,
    },
    /// Box rotated about z.
    Block {
        /// Centre.
        centre: DVec3,
        /// Half of the size along the box's own axes.
        half_size: DVec3,
        /// Angle of its x axis to `Ox` \[rad\].
        angle: f64,
        /// Half the width of the opening of a square tube along its x axis; 0 for a solid box.
        inner: f64,
    },
}

/// A solid of the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solid {
    /// The part that the solid represents.
    pub part: Part,
    /// Index of the leg that the solid belongs to.
    pub leg: Option<usize>,
    /// Shape.
    pub shape: SolidShape,
    /// Value that its colour tells in place of the part, as a place on the scale from 0 to 1.
    pub value: Option<f64>,
}

impl Solid {
    /// Creates a solid that has the colour of its part.
    pub(super) fn new(part: Part, leg: Option<usize>, shape: SolidShape) -> Self {
        Self {
            part,
            leg,
            shape,
            value: None,
        }
    }

    /// Returns whether the solid shows a member, or a part of it.
    pub fn shows(&self, member: &MemberId) -> bool {
        let kinds: &[MemberKind] = match self.part {
            Part::Tube | Part::Rod => &[MemberKind::TelescopicLeg],
            Part::Crank => &[MemberKind::Crank],
            Part::Link => &[MemberKind::Link],
            Part::Guide => &[MemberKind::Guide, MemberKind::TurningGuide],
            Part::PlatformBar => &[MemberKind::PlatformBar],
            Part::Slider => &[MemberKind::Slider],
            _ => &[],
        };
        self.leg == Some(member.leg) && kinds.contains(&member.kind)
    }
}

/// A polyline of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// The part that the line represents.
    pub part: Part,
    /// Points.
    pub points: Vec<DVec3>,
}

/// A text at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// Position of the text.
    pub at: DVec3,
    /// The text, in the paper's notation: `A1`, `C3`, `P`.
    pub text: String,
}

/// The pair of members with the smallest clearance, as a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Nearest {
    /// Line from one surface to the other; if the members overlap, a line along z through the point of overlap.
    pub line: [DVec3; 2],
    /// The distance, as in `12.3 mm`; negative if the members overlap.
    pub text: String,
    /// Whether the distance is less than the clearance that the study requires, or less than 0 if it requires none.
    pub too_near: bool,
}

/// Shapes of one design at one pose.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Scene {
    /// Solids.
    pub solids: Vec<Solid>,
    /// Lines.
    pub lines: Vec<Line>,
    /// Labels.
    pub labels: Vec<Label>,
    /// The pair of members with the smallest clearance.
    pub nearest: Option<Nearest>,
}

impl Scene {
    pub(super) fn add_line(&mut self, part: Part, points: impl IntoIterator<Item = DVec3>) {
        let points = points.into_iter().collect();
        self.lines.push(Line { part, points });
    }

    pub(super) fn add_label(&mut self, at: DVec3, text: impl Into<String>) {
        let text = text.into();
        self.labels.push(Label { at, text });
    }

    /// Returns the solids that represent a part.
    pub fn solids_of(&self, part: Part) -> impl Iterator<Item = &Solid> {
        self.solids.iter().filter(move |solid| solid.part == part)
    }

    /// Returns the base triangle, the rails and the edges of obstacles as bars for a manipulator of base radius `R` \[m\], for formats and
    /// renderers that show no lines: rails that have a cross-section with theirs, all others as thin bars.
    pub fn base_bars(&self, base_radius: f64, rails: Option<&RailSettings>) -> Vec<Solid> {
        let bars = self.lines.iter().flat_map(|line| {
            let [radius, inner] = match (line.part, rails) {
                (Part::Rail, Some(rails)) => [rails.radius, rails.section.inner_radius(rails.radius)],
                (Part::Rail, None) => [0.006 * base_radius, 0.0],
                (Part::Base | Part::Obstacle, _) => [0.003 * base_radius, 0.0],
                _ => [0.0; 2],
            };
            line.points.windows(2).map(move |ends| {
                let shape = SolidShape::Bar {
                    from: ends[0],
                    to: ends[1],
                    radius,
                    inner,
                };
                Solid::new(line.part, None, shape)
            })
        });
        bars.filter(|bar| bar.shape.has_volume()).collect()
    }
}
