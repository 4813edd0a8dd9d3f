//! How a piece of a path is covered in time (docs/model.md, section 15.6).

use crate::lanes::Real;

/// How a piece of a path is covered from rest to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MotionLaw {
    /// A polynomial of the fifth degree.
    Quintic,
    /// An acceleration that is a trapezoid over the first share of the time, 0 then, and the reverse over the last share.
    Trapezoid {
        /// Share of the time in which the motion accelerates, above 0 and at most 1/2.
        blend: f64,
        /// Share of that in which the acceleration rises, and in which it falls, above 0 and at most 1/2.
        ramp: f64,
    },
}

impl MotionLaw {
    /// Returns the share of the path that is covered at a share of the time, and its first and second derivative.
    pub fn at(self, share: f64) -> [f64; 3] {
        self.on_stretch(share, share)
    }

    /// Returns the shares of the time between which the law is one polynomial, the ends 0 and 1 included.
    pub(super) fn breaks(self) -> Vec<f64> {
        match self {
            MotionLaw::Quintic => vec![0.0, 1.0],
            MotionLaw::Trapezoid { blend, ramp } => {
                let flank = ramp * blend;
                let half = [0.0, flank, blend - flank, blend, 0.5];
                let mirrored = half.iter().rev().skip(1).map(|share| 1.0 - share);
                let mut breaks: Vec<f64> = half.into_iter().chain(mirrored).collect();
                breaks.dedup();
                breaks
            }
        }
    }

    /// Returns what [`MotionLaw::at`] does, by the polynomial that holds at the share `stretch`.
    pub(super) fn on_stretch<V: Real>(self, share: V, stretch: f64) -> [V; 3] {
        let x = share;
        let number = |value: f64| x.splat(value);
        match self {
            MotionLaw::Quintic => [
                x * x * x * (number(10.0) + x * (number(-15.0) + number(6.0) * x)),
                number(30.0) * x * x * (number(1.0) + x * (x - number(2.0))),
                number(60.0) * x * (number(1.0) + x * (number(2.0) * x - number(3.0))),
            ],
            MotionLaw::Trapezoid { blend, ramp } => {
                if stretch > 0.5 {
                    let [way, speed, acceleration] = accelerating(number(1.0) - x, 1.0 - stretch, blend, ramp);
                    [number(1.0) - way, speed, -acceleration]
                } else {
                    accelerating(x, stretch, blend, ramp)
                }
            }
        }
    }
}

/// Returns the way, speed and acceleration of a rising acceleration, from rest.
fn rising<V: Real>(x: V, jerk: f64) -> [V; 3] {
    let number = |value: f64| x.splat(value);
    [
        number(jerk) * x * x * x / number(6.0),
        number(0.5 * jerk) * x * x,
        number(jerk) * x,
    ]
}

/// Returns the way, speed and acceleration of the acceleration `most`, from a way and speed.
fn plateau<V: Real>(x: V, [way, speed]: [f64; 2], most: f64) -> [V; 3] {
    let number = |value: f64| x.splat(value);
    [
        number(way) + x * (number(speed) + number(0.5 * most) * x),
        number(speed) + number(most) * x,
        number(most),
    ]
}

/// Returns the way, speed and acceleration of an acceleration that falls from `most`, from a way and speed.
fn falling<V: Real>(x: V, [way, speed]: [f64; 2], most: f64, jerk: f64) -> [V; 3] {
    let number = |value: f64| x.splat(value);
    [
        number(way) + x * (number(speed) + x * (number(0.5 * most) - number(jerk) * x / number(6.0))),
        number(speed) + x * (number(most) - number(0.5 * jerk) * x),
        number(most) - number(jerk) * x,
    ]
}

/// Returns the first half of a motion whose acceleration is a trapezoid, by the polynomial that holds at the share `stretch`.
fn accelerating<V: Real>(share: V, stretch: f64, blend: f64, ramp: f64) -> [V; 3] {
    let most = 1.0 / (blend * (1.0 - blend) * (1.0 - ramp));
    let flank = ramp * blend;
    let jerk = most / flank;
    let after = |begin: f64| share - share.splat(begin);
    if stretch <= flank {
        return rising(share, jerk);
    }
    let [way, speed, _] = rising(flank, jerk);
    if stretch <= blend - flank {
        return plateau(after(flank), [way, speed], most);
    }
    let [way, speed, _] = plateau(blend - 2.0 * flank, [way, speed], most);
    if stretch <= blend {
        return falling(after(blend - flank), [way, speed], most, jerk);
    }
    let [way, speed, _] = falling(flank, [way, speed], most, jerk);
    let zero = share.splat(0.0);
    [
        share.splat(way) + share.splat(speed) * after(blend),
        share.splat(speed),
        zero,
    ]
}
