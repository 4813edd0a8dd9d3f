//! Error of the pose that errors of manufacture, assembly and control cause (docs/model.md, section 15.5).

use std::sync::LazyLock;

use super::effort::norm;
use super::legs::{DynamicsInputs, MovingLeg};
use super::{DynamicsModel, Rail};
use crate::lanes::{Planar, Real, dot};
use crate::spatial::LEGS;
use crate::strength::path::PLATFORM;

/// Number of directions in which the error of the position is determined, over half a turn.
const DIRECTIONS: usize = 72;

/// Unit vectors at 2.5° from each other.
static CIRCLE: LazyLock<[[f64; 2]; DIRECTIONS]> = LazyLock::new(|| {
    std::array::from_fn(|k| {
        let angle = k as f64 * std::f64::consts::PI / DIRECTIONS as f64;
        [libm::cos(angle), libm::sin(angle)]
    })
});

/// How the errors of a leg displace the platform, at several poses at once.
#[derive(Clone, Copy)]
pub(super) struct LegErrors<V> {
    /// Displacement of the platform for a unit of error along the line of the leg.
    pub column: [V; 3],
    /// Largest error along the line, without that of the base joints of a leg on rails \[m\].
    pub bound: V,
    /// Variance of the same error \[m²\].
    pub variance: V,
    /// Error along the line for a displacement of each of the two ends of the rail, for legs on rails.
    pub ends: Option<[Planar<V>; 2]>,
}

/// Error of the pose at several poses at once.
#[derive(Clone, Copy)]
pub(super) struct PoseErrors<V> {
    /// Largest error of the position \[m\].
    pub worst_position: V,
    /// The direction in which it occurs.
    pub direction: Planar<V>,
    /// Largest error of the orientation \[rad\].
    pub worst_orientation: V,
    /// Root mean squares of both.
    pub rms: [V; 2],
}

impl DynamicsModel {
    /// Returns how the errors of the legs displace the platform.
    #[inline(always)]
    pub(super) fn leg_errors<V: Real>(
        &self,
        inputs: &DynamicsInputs<V>,
        legs: &[MovingLeg<V>; LEGS],
    ) -> [LegErrors<V>; LEGS] {
        [
            self.errors_of(inputs, &legs[0], 0),
            self.errors_of(inputs, &legs[1], 1),
            self.errors_of(inputs, &legs[2], 2),
        ]
    }

    #[inline(always)]
    #[allow(
        clippy::manual_map,
        reason = "a closure that is not inlined is compiled for the baseline processor"
    )]
    fn errors_of<V: Real>(&self, inputs: &DynamicsInputs<V>, leg: &MovingLeg<V>, index: usize) -> LegErrors<V> {
        let like = leg.transmission;
        let tolerances = &self.settings.tolerances;
        let line = Planar::new(leg.wrench[0], leg.wrench[1]);
        let (mut links, mut squares) = (like.splat(0.0), like.splat(0.0));
        for bar in self.paths[0].first..PLATFORM {
            let share = line.dot(leg.path.bars[bar].axis);
            links = links + share.abs();
            squares = squares + share * share;
        }
        let encoder = tolerances.encoder(self.actuator);
        let base = match self.rails {
            Some(_) => 0.0,
            None => tolerances.base,
        };
        let discs = tolerances.platform + self.revolutes * tolerances.play + base;
        let disc_squares = tolerances.platform * tolerances.platform
            + self.revolutes * tolerances.play * tolerances.play
            + base * base;
        let scalars = leg.transmission * leg.transmission * like.splat(encoder * encoder)
            + squares * like.splat(tolerances.link * tolerances.link);
        let ends = match &self.rails {
            Some(rails) => Some(rail_ends(&rails[index], inputs.position.plus(leg.path.joints[0]), line)),
            None => None,
        };
        LegErrors {
            column: leg.column,
            bound: leg.transmission.abs() * like.splat(encoder)
                + links * like.splat(tolerances.link)
                + like.splat(discs),
            variance: scalars * like.splat(1.0 / 3.0) + like.splat(0.25 * disc_squares),
            ends,
        }
    }

    /// Returns the displacements of the platform in a direction for unit displacements of the ends of the rails, as the vector of each
    /// end, of which the length is the worst case.
    #[inline(always)]
    pub(super) fn base_errors<V: Real>(
        &self,
        legs: &[LegErrors<V>; LEGS],
        shares: &[V; LEGS],
    ) -> [Planar<V>; 2 * LEGS] {
        let zero = shares[0].splat(0.0);
        let mut found = [Planar::new(zero, zero); 2 * LEGS];
        let Some(rails) = &self.rails else {
            return found;
        };
        for leg in 0..LEGS {
            let Some([near, far]) = legs[leg].ends else {
                continue;
            };
            found[leg] = found[leg].plus(near.scaled(shares[leg]));
            // The far end of a rail that meets the next one is the base joint there, and no error of its own.
            let far_place = match rails[leg].meets_next {
                true => (leg + 1) % LEGS,
                false => LEGS + leg,
            };
            found[far_place] = found[far_place].plus(far.scaled(shares[leg]));
        }
        found
    }

    /// Returns the largest error in a direction.
    #[inline(always)]
    pub(super) fn worst_along<V: Real>(&self, legs: &[LegErrors<V>; LEGS], direction: &[V; 3]) -> V {
        let mut worst = direction[0].splat(0.0);
        let mut shares = [worst; LEGS];
        for leg in 0..LEGS {
            shares[leg] = dot(direction, &legs[leg].column);
            worst = worst + shares[leg].abs() * legs[leg].bound;
        }
        if self.rails.is_some() && self.settings.tolerances.base > 0.0 {
            let base = worst.splat(self.settings.tolerances.base);
            for end in self.base_errors(legs, &shares) {
                worst = worst + base * end.dot(end).sqrt();
            }
        }
        worst
    }

    /// Returns the largest error of the position with its direction.
    #[inline(always)]
    pub(super) fn worst_position<V: Real>(&self, legs: &[LegErrors<V>; LEGS]) -> (V, Planar<V>) {
        let zero = legs[0].bound.splat(0.0);
        let mut worst = zero;
        let mut direction = Planar::new(zero.splat(1.0), zero);
        for [x, y] in CIRCLE.iter() {
            let towards = Planar::new(zero.splat(*x), zero.splat(*y));
            let found = self.worst_along(legs, &[towards.x, towards.y, zero]);
            let is_worse = found.exceeds(worst);
            worst = found.select(is_worse, worst);
            direction = Planar::new(
                towards.x.select(is_worse, direction.x),
                towards.y.select(is_worse, direction.y),
            );
        }
        (worst, direction)
    }

    /// Returns a bound of the largest error of the position: the displacements that each source causes in two directions bound those in all.
    #[inline(always)]
    pub(super) fn position_bound<V: Real>(&self, legs: &[LegErrors<V>; LEGS]) -> V {
        let mut bound = legs[0].bound.splat(0.0);
        for leg in legs {
            bound = bound + norm(&leg.column) * leg.bound;
        }
        if self.rails.is_some() && self.settings.tolerances.base > 0.0 {
            let base = bound.splat(self.settings.tolerances.base);
            let x = [legs[0].column[0], legs[1].column[0], legs[2].column[0]];
            let y = [legs[0].column[1], legs[1].column[1], legs[2].column[1]];
            let (first, second) = (self.base_errors(legs, &x), self.base_errors(legs, &y));
            for end in 0..first.len() {
                bound = bound + base * (first[end].dot(first[end]) + second[end].dot(second[end])).sqrt();
            }
        }
        bound
    }

    /// Returns the largest error of the position in each of the directions in which it is determined.
    pub(super) fn position_errors<V: Real>(&self, legs: &[LegErrors<V>; LEGS]) -> impl Iterator<Item = V> {
        let zero = legs[0].bound.splat(0.0);
        CIRCLE
            .iter()
            .map(move |[x, y]| self.worst_along(legs, &[zero.splat(*x), zero.splat(*y), zero]))
    }

    /// Returns the largest error of the orientation.
    #[inline(always)]
    pub(super) fn worst_orientation<V: Real>(&self, legs: &[LegErrors<V>; LEGS]) -> V {
        let zero = legs[0].bound.splat(0.0);
        self.worst_along(legs, &[zero, zero, zero.splat(1.0)])
    }

    /// Returns the variance of the error in a direction, in which the errors along the lines of the legs displace the platform by shares.
    #[inline(always)]
    fn variance<V: Real>(&self, legs: &[LegErrors<V>; LEGS], shares: &[V; LEGS]) -> V {
        let mut variance = shares[0].splat(0.0);
        for leg in 0..LEGS {
            variance = variance + shares[leg] * shares[leg] * legs[leg].variance;
        }
        let base = self.settings.tolerances.base;
        for end in self.base_errors(legs, shares) {
            variance = variance + end.dot(end) * variance.splat(0.25 * base * base);
        }
        variance
    }

    /// Returns the variances of the error of the position along x and along y, and their covariance.
    pub(super) fn covariance(&self, legs: &[LegErrors<f64>; LEGS]) -> [f64; 3] {
        let along = |x: f64, y: f64| self.variance(legs, &legs.map(|leg| x * leg.column[0] + y * leg.column[1]));
        let [xx, yy] = [along(1.0, 0.0), along(0.0, 1.0)];
        [xx, yy, 0.25 * (along(1.0, 1.0) - along(1.0, -1.0))]
    }

    /// Returns the error of the pose.
    #[inline(always)]
    pub(super) fn pose_errors<V: Real>(&self, legs: &[LegErrors<V>; LEGS]) -> PoseErrors<V> {
        let (worst_position, direction) = self.worst_position(legs);
        let zero = worst_position.splat(0.0);
        let mut variances = [zero; 3];
        for (component, variance) in variances.iter_mut().enumerate() {
            let mut shares = [zero; LEGS];
            for leg in 0..LEGS {
                shares[leg] = legs[leg].column[component];
            }
            *variance = self.variance(legs, &shares);
        }
        PoseErrors {
            worst_position,
            direction,
            worst_orientation: self.worst_orientation(legs),
            rms: [(variances[0] + variances[1]).sqrt(), variances[2].sqrt()],
        }
    }
}

/// Returns the error along the line of a leg for a displacement of either end of its rail, with the slider at a point: along the rail,
/// positions are measured from the near end, and across it the slider follows both ends.
#[inline(always)]
fn rail_ends<V: Real>(rail: &Rail, slider: Planar<V>, line: Planar<V>) -> [Planar<V>; 2] {
    let like = line.x;
    let axis = Planar::splat(like, rail.axis);
    let share = slider.minus(Planar::splat(like, rail.from)).dot(axis) * like.splat(1.0 / rail.length);
    let across = axis.perp();
    let far = across.scaled(share * across.dot(line));
    [line.minus(far), far]
}
