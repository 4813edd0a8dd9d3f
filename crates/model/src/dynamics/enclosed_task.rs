//! Motions over an interval of time, for the proof that a design follows them (docs/model.md, section 15.11).

use super::task::{Piece, TaskMotion};
use crate::enclosure::{EnclosedNumber, PoseEnclosure, TaylorModel};
use crate::lanes::Real as _;

/// By how much an interval of time reaches over the ends of its stretch, as a share of the time of a piece: the ends are rounded, and
/// the law is enclosed on both sides of them.
const OVERLAP: f64 = 1e-15;

/// The poses of a motion over an interval of time, with velocities and accelerations of the platform.
pub(crate) struct EnclosedMotion {
    /// The poses.
    pub pose: PoseEnclosure,
    /// `vx`, `vy` \[m/s\] and `ω` \[rad/s\].
    pub twist: [EnclosedNumber; 3],
    /// `ax`, `ay` \[m/s²\] and `α` \[rad/s²\].
    pub acceleration: [EnclosedNumber; 3],
}

impl TaskMotion {
    /// Returns the intervals of the time of a piece on which the law is one polynomial, as shares of that time.
    pub(crate) fn stretches(&self) -> Vec<[f64; 2]> {
        let breaks = self.law.breaks();
        breaks.windows(2).map(|pair| [pair[0], pair[1]]).collect()
    }

    /// Encloses the motion over an interval of the time of a piece that lies in one stretch.
    pub(crate) fn enclose(&self, piece: usize, [from, to]: [f64; 2]) -> EnclosedMotion {
        let middle = 0.5 * (from + to);
        let radius = (to - middle).max(middle - from) + OVERLAP;
        let share = EnclosedNumber(TaylorModel::variable(0, middle, radius));
        let [way, speed, acceleration] = self.law.on_stretch(share, middle);
        let rate = share.splat(1.0) / share.splat(self.durations()[piece]);
        self.pieces[piece].enclose([way, speed * rate, acceleration * (rate * rate)])
    }
}

impl Piece {
    /// Encloses what [`Piece::at`] returns.
    fn enclose(&self, [way, speed, acceleration]: [EnclosedNumber; 3]) -> EnclosedMotion {
        // The numbers that define a path are exact.
        let exactly = |value: f64| EnclosedNumber(TaylorModel::exactly(value));
        let (at, twist, acceleration) = match self {
            Piece::Straight { from, by } => (
                [0, 1, 2].map(|k: usize| exactly(from[k]) + exactly(by[k]) * way),
                by.map(|by| exactly(by) * speed),
                by.map(|by| exactly(by) * acceleration),
            ),
            Piece::Circle { centre, arm, phi } => {
                let turn = way.splat(2.0 * std::f64::consts::PI);
                let (sine, cosine) = (turn * way).0.sine_and_cosine_of();
                let (sine, cosine) = (EnclosedNumber(sine), EnclosedNumber(cosine));
                let out = [
                    exactly(arm.x) * cosine - exactly(arm.y) * sine,
                    exactly(arm.y) * cosine + exactly(arm.x) * sine,
                ];
                let along = [-out[1], out[0]];
                let (rate, change) = (turn * speed, turn * acceleration);
                let towards = [0, 1].map(|k: usize| along[k] * change - out[k] * (rate * rate));
                let still = exactly(0.0);
                (
                    [exactly(centre.x) + out[0], exactly(centre.y) + out[1], exactly(*phi)],
                    [along[0] * rate, along[1] * rate, still],
                    [towards[0], towards[1], still],
                )
            }
        };
        let [x, y, phi] = at.map(|coordinate| coordinate.0);
        let (sine, cosine) = phi.sine_and_cosine_of();
        EnclosedMotion {
            pose: PoseEnclosure {
                position: [x, y],
                cosine,
                sine,
            },
            twist,
            acceleration,
        }
    }
}
