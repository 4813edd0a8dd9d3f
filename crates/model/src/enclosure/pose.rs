//! Enclosures of a pose, and of what a leg is over a box of poses.

use super::{Interval, TaylorModel};

/// A vector in the plane whose components are enclosed.
pub type PlanarModel = [TaylorModel; 2];

/// A box of poses: position of `P` in the base frame \[m\], and cosine and sine of the orientation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseEnclosure {
    /// Position of `P` \[m\].
    pub position: PlanarModel,
    /// `cos φ`.
    pub cosine: TaylorModel,
    /// `sin φ`.
    pub sine: TaylorModel,
}

impl PoseEnclosure {
    /// A box without width: position of `P` \[m\] and orientation \[rad\].
    pub fn point(position: [Interval; 2], phi: Interval) -> Self {
        let (sine, cosine) = phi.sine_and_cosine();
        Self {
            position: position.map(TaylorModel::constant),
            cosine: TaylorModel::constant(cosine),
            sine: TaylorModel::constant(sine),
        }
    }
}

/// Axis of a member in the base frame, relative to `P`, over a box of poses; lengths are multiples of `L_b`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisEnclosure {
    /// Points whose hull the axis is; they lie on one line.
    pub points: [PlanarModel; 3],
    /// Unit vector along the axis.
    pub direction: PlanarModel,
}

impl AxisEnclosure {
    /// The axis between two points.
    pub fn between(from: PlanarModel, to: PlanarModel, direction: PlanarModel) -> Self {
        Self {
            points: [from, to, to],
            direction,
        }
    }
}

/// The axes of a leg's members, over a box of poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MembersEnclosure {
    /// Axis of the proximal member, for leg types that have one; that of a slider is the point at its centre, with the direction of
    /// its rail.
    pub proximal: Option<AxisEnclosure>,
    /// Axis of the distal member.
    pub distal: AxisEnclosure,
    /// Distances of a slider's centre from the ends of its rail \[m\].
    pub rail: Option<[TaylorModel; 2]>,
}

/// A frame that is turned by an angle whose cosine and sine are known exactly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurnedFrame {
    cosine: Interval,
    sine: Interval,
}

impl TurnedFrame {
    /// The frame that is turned by `thirds` · 30°.
    pub fn by_thirties(thirds: u8) -> Self {
        let half = Interval::exactly(0.5);
        let long = Interval::sqrt_3() * half;
        let (zero, one) = (Interval::exactly(0.0), Interval::exactly(1.0));
        let cosine = |thirds: u8| match thirds % 12 {
            0 => one,
            1 | 11 => long,
            2 | 10 => half,
            3 | 9 => zero,
            4 | 8 => -half,
            5 | 7 => -long,
            _ => -one,
        };
        Self {
            cosine: cosine(thirds),
            sine: cosine(thirds + 9),
        }
    }

    /// The frame that is turned by an angle \[deg\].
    pub fn by_degrees(angle: f64) -> Self {
        let thirds = angle.rem_euclid(360.0) / 30.0;
        if thirds.fract() == 0.0 && thirds < 12.0 {
            return Self::by_thirties(thirds as u8);
        }
        let (sine, cosine) = Interval::radians(angle).sine_and_cosine();
        Self { cosine, sine }
    }

    /// The frame whose x axis is a unit vector in the frame from which it is turned.
    pub fn along([cosine, sine]: [Interval; 2]) -> Self {
        Self { cosine, sine }
    }

    /// The x axis, in the frame from which this one is turned.
    pub fn axis(&self) -> [Interval; 2] {
        [self.cosine, self.sine]
    }

    /// Returns the components in this frame of a vector in the frame from which it is turned.
    pub fn enter(&self, [x, y]: PlanarModel) -> PlanarModel {
        [
            x.scaled(self.cosine) + y.scaled(self.sine),
            y.scaled(self.cosine) - x.scaled(self.sine),
        ]
    }

    /// Returns the components in the frame from which this one is turned.
    pub fn leave(&self, [x, y]: PlanarModel) -> PlanarModel {
        [
            x.scaled(self.cosine) - y.scaled(self.sine),
            x.scaled(self.sine) + y.scaled(self.cosine),
        ]
    }

    /// Returns the unit vector at this frame's angle plus the pose's orientation.
    pub fn direction(&self, pose: &PoseEnclosure) -> PlanarModel {
        self.leave([pose.cosine, pose.sine])
    }
}

/// `a × b`.
pub fn cross(a: PlanarModel, b: PlanarModel) -> TaylorModel {
    a[0] * b[1] - a[1] * b[0]
}

/// `a · b`.
pub fn dot(a: PlanarModel, b: PlanarModel) -> TaylorModel {
    a[0] * b[0] + a[1] * b[1]
}

/// `a + b`.
pub fn sum(a: PlanarModel, b: PlanarModel) -> PlanarModel {
    [a[0] + b[0], a[1] + b[1]]
}

/// `a − b`.
pub fn difference(a: PlanarModel, b: PlanarModel) -> PlanarModel {
    [a[0] - b[0], a[1] - b[1]]
}
