//! Named shapes.

use glam::DVec3;

/// What a shape is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// Triangle `A1A2A3`.
    Base,
    /// Path of a slider with its travel.
    Rail,
    /// Between the shortest and the longest length of a telescopic leg.
    Stroke,
    /// Slider block, actuated.
    Slider,
    /// Fixed half of a telescopic leg.
    Tube,
    /// Moving half of a telescopic leg.
    Rod,
    /// Bar clamped to the actuator.
    Crank,
    /// Last bar of a leg, up to `C_i`.
    Link,
    /// Bar of the platform, from `C_i` to `P`.
    PlatformBar,
    /// Joint that is driven.
    ActuatedJoint,
    /// Joint that follows.
    PassiveJoint,
    /// x axis of a frame.
    AxisX,
    /// y axis of a frame.
    AxisY,
    /// The regular workspace.
    Workspace,
}

/// Shape of a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SolidShape {
    /// Circular bar between the centres of its end faces.
    Bar {
        /// Centre of one end.
        from: DVec3,
        /// Centre of the other end.
        to: DVec3,
        /// Radius.
        radius: f64,
    },
    /// Box turned about z.
    Block {
        /// Centre.
        centre: DVec3,
        /// Half its size along its own axes.
        half_size: DVec3,
        /// Angle of its x axis to `Ox` \[rad\].
        angle: f64,
    },
}

/// A solid of the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solid {
    /// What it is.
    pub part: Part,
    /// Index of the leg it belongs to.
    pub leg: Option<usize>,
    /// Its shape.
    pub shape: SolidShape,
}

/// A polyline of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// What it is.
    pub part: Part,
    /// Its points.
    pub points: Vec<DVec3>,
}

/// A word at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// Where.
    pub at: DVec3,
    /// The word, as the paper writes it: `A1`, `C3`, `P`.
    pub text: String,
}

/// The nearest pair of bodies that are not joined, as a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Nearest {
    /// From one surface to the other; where the bodies overlap, a needle through the place.
    pub line: [DVec3; 2],
    /// The distance, as in `12.3 mm`; negative where they overlap.
    pub text: String,
    /// Whether it is less than the study asks for, or than 0.
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
    /// The bodies that are nearest to each other.
    pub nearest: Option<Nearest>,
}

impl Scene {
    /// Solids of one kind.
    pub fn solids_of(&self, part: Part) -> impl Iterator<Item = &Solid> {
        self.solids.iter().filter(move |solid| solid.part == part)
    }

    /// Base triangle and rails as thin bars on a manipulator of base radius `R` \[m\], for what shows no lines.
    pub fn base_bars(&self, base_radius: f64) -> Vec<Solid> {
        let bars = self.lines.iter().flat_map(|line| {
            let thickness = match line.part {
                Part::Rail => 0.006,
                Part::Base => 0.003,
                _ => 0.0,
            };
            line.points.windows(2).map(move |ends| Solid {
                part: line.part,
                leg: None,
                shape: SolidShape::Bar {
                    from: ends[0],
                    to: ends[1],
                    radius: thickness * base_radius,
                },
            })
        });
        bars.filter(|bar| bar.shape.has_volume()).collect()
    }
}
