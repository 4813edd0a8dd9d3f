//! Buckling of the bars and of the manipulator at several poses at once (docs/model.md, section 14.5).

use std::f64::consts::PI;

use super::path::{BARS, End};
use super::resultants::{LoadedLeg, LoadedLegs, times};
use super::{LARGEST_FACTOR, StrengthInputs, StrengthModel};
use crate::lanes::{Planar, Real, dot};
use crate::spatial::LEGS;

/// A compression below this part of the largest force is a rounding error.
const NEGLIGIBLE: f64 = 1e-12;

/// A bar that may buckle.
#[derive(Clone, Copy)]
pub(super) struct Column<V> {
    /// `N_j⁻`: largest compression \[N\].
    pub compression: V,
    /// `1/N_E`: reciprocal of Euler's load \[1/N\].
    pub per_euler: V,
    /// `L_j c_j` in the plane and out of it: by how much the yielding of the machine adds to `1/N_E` \[1/N\].
    pub give: [V; 2],
}

impl<V: Real> Column<V> {
    /// Returns `k_j` in the plane and out of it: the effective length of the bar in units of its length.
    #[inline(always)]
    pub fn effective_lengths(&self) -> [V; 2] {
        let one = self.per_euler.splat(1.0);
        [
            (one + self.give[0] / self.per_euler).sqrt(),
            (one + self.give[1] / self.per_euler).sqrt(),
        ]
    }

    /// Returns the factor by which the loads have to grow until the bar buckles, were it alone compressed.
    #[inline(always)]
    pub fn factor(&self) -> V {
        let [inside, outside] = self.give;
        factor(self.compression * (self.per_euler + inside.larger(outside)))
    }
}

/// Returns the reciprocal of a factor, at most [`LARGEST_FACTOR`].
#[inline(always)]
pub(super) fn factor<V: Real>(reciprocal: V) -> V {
    let least = reciprocal.splat(1.0 / LARGEST_FACTOR);
    // The order keeps what is not a number.
    reciprocal.splat(1.0) / least.larger(reciprocal)
}

impl StrengthModel {
    /// Returns the columns of all legs.
    #[inline(always)]
    pub(super) fn columns<V: Real>(
        &self,
        loaded: &LoadedLegs<'_, V>,
        inputs: &StrengthInputs<V>,
    ) -> [[Column<V>; BARS]; LEGS] {
        let zero = loaded.legs[0].moment.splat(0.0);
        let nothing = Column {
            compression: zero,
            per_euler: zero,
            give: [zero; 2],
        };
        let mut columns = [[nothing; BARS]; LEGS];
        let mut largest = zero;
        for (index, leg) in loaded.legs.iter().enumerate() {
            largest = largest.larger(leg.line.most());
            for bar in self.first()..BARS {
                let [compression, most] = self.compression(leg, bar);
                let length = leg.path.bars[bar].length;
                let bending = self.section(bar).compliance.bending;
                let inside = self.give_in_plane(loaded, index, bar, &inputs.along);
                let outside = self.give_out_of_plane(loaded, index, bar);
                largest = largest.larger(most);
                columns[index][bar] = Column {
                    compression,
                    per_euler: length * length * length.splat(bending / (PI * PI)),
                    // Below 0 by rounding alone.
                    give: [length * zero.larger(inside), length * zero.larger(outside)],
                };
            }
        }
        let least = largest * largest.splat(NEGLIGIBLE);
        for column in columns.as_flattened_mut() {
            column.compression = zero.select(least.exceeds(column.compression), column.compression);
        }
        columns
    }

    /// Returns the reciprocal of the factor by which the loads have to grow until the manipulator buckles; the factor is a lower bound.
    #[inline(always)]
    pub(super) fn buckling_demand<V: Real>(&self, columns: &[[Column<V>; BARS]; LEGS]) -> V {
        let zero = columns[0][BARS - 1].compression.splat(0.0);
        let (mut shape, mut inside, mut outside) = (zero, zero, zero);
        for column in columns.as_flattened() {
            shape = shape.larger(column.compression * column.per_euler);
            inside = inside + column.compression * column.give[0];
            outside = outside + column.compression * column.give[1];
        }
        shape + inside.larger(outside)
    }

    /// Returns the largest compression of a bar, and the largest magnitude of the force along it \[N\].
    #[inline(always)]
    fn compression<V: Real>(&self, leg: &LoadedLeg<'_, V>, bar: usize) -> [V; 2] {
        let zero = leg.moment.splat(0.0);
        let (mut compression, mut most) = (zero, zero);
        let loads = self.bar_loads(leg, bar);
        // Without weight along the plane, the force is the same in every section.
        let [changes, _] = self.loads.weighs();
        let sections = if changes { self.sections() } else { 1 };
        for section in 0..sections {
            let axial = self.section_loads(leg, bar, &loads, section).axial;
            compression = compression.larger(axial.range - axial.value);
            most = most.larger(axial.most());
        }
        [compression, most]
    }

    /// Returns `c_in`: by how much the chord of a bar turns in the plane per unit couple of two forces at its ends \[rad/(N·m)\]; `along` are
    /// the `c_i`.
    #[inline(always)]
    fn give_in_plane<V: Real>(&self, loaded: &LoadedLegs<'_, V>, index: usize, column: usize, along: &[V; LEGS]) -> V {
        let leg = &loaded.legs[index];
        let like = leg.moment;
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        // The wrench at `P` that keeps the drives and joints of the leg in balance with the couple.
        let mut own = [zero; 3];
        for joint in 0..LEGS {
            let path = &self.paths[index];
            if path.is_revolute(joint) && path.joints[joint].before <= column {
                for entry in 0..own.len() {
                    own[entry] = own[entry] - leg.reactions[joint][entry];
                }
            }
        }
        let force = Planar::new(own[0], own[1]);
        let (mut of_couple, mut of_both) = (zero, zero);
        for bar in self.first()..BARS {
            let lanes = &leg.path.bars[bar];
            let section = &self.section(bar).compliance;
            let [from, to] = [lanes.base, lanes.place(lanes.length)];
            // The couple bends what is inboard of the bar, and dies out along it.
            let (at_from, at_to) = match bar.cmp(&column) {
                std::cmp::Ordering::Less => (one, one),
                std::cmp::Ordering::Equal => (one, zero),
                std::cmp::Ordering::Greater => (zero, zero),
            };
            let m1 = own[2] - from.cross(force) + at_from;
            let m2 = own[2] - to.cross(force) + at_to;
            let w1 = self.paths[0].lever(bar, End::Base, leg.lever(from));
            let w2 = self.paths[0].lever(bar, End::Platform, leg.lever(to));
            let (n, nw) = (force.dot(lanes.axis), leg.u.dot(lanes.axis));
            let axial = lanes.length * like.splat(section.axial);
            let bending = lanes.length * like.splat(section.bending);
            let third = bending * like.splat(1.0 / 3.0);
            let sixth = bending * like.splat(1.0 / 6.0);
            of_couple = of_couple + axial * n * n + third * (m1 * m1 + m1 * m2 + m2 * m2);
            of_both = of_both + axial * n * nw + sixth * (m1 * w1 + m1 * w1 + m1 * w2 + m2 * w1 + m2 * w2 + m2 * w2);
        }
        // The lines of the legs carry the wrench. Their forces are statically determinate, so that nothing is inverted but the Jacobian.
        let lines = [
            dot(&loaded.by[0], &own),
            dot(&loaded.by[1], &own),
            dot(&loaded.by[2], &own),
        ];
        let mut give = of_couple - of_both * (lines[index] + lines[index]);
        for leg in 0..LEGS {
            give = give + along[leg] * lines[leg] * lines[leg];
        }
        give
    }

    /// Returns `c_out`, the same about the normal of the bar \[rad/(N·m)\].
    #[inline(always)]
    fn give_out_of_plane<V: Real>(&self, loaded: &LoadedLegs<'_, V>, index: usize, column: usize) -> V {
        let leg = &loaded.legs[index];
        let like = leg.moment;
        let zero = like.splat(0.0);
        let normal = leg.path.bars[column].axis.perp();
        let mut displacement = [zero; 3];
        let mut turn = zero;
        for bar in self.first()..=column {
            let lanes = &leg.path.bars[bar];
            let compliance = &self.section(bar).compliance;
            let (axis, across) = (lanes.axis, lanes.axis.perp());
            let bend = lanes.length * like.splat(compliance.bending);
            let twist = lanes.length * like.splat(compliance.torsion);
            let curvature = across
                .scaled(bend * normal.dot(across))
                .plus(axis.scaled(twist * normal.dot(axis)));
            // The couple is constant in the bars inboard of this one, and dies out along this one.
            let (weight, share, part) = match bar == column {
                true => (0.5, 1.0 / 3.0, 1.0 / 3.0),
                false => (1.0, 0.5, 1.0),
            };
            let place = lanes.place(lanes.length * like.splat(share));
            let weight = like.splat(weight);
            displacement = [
                displacement[0] + weight * place.perp().dot(curvature),
                displacement[1] + weight * curvature.x,
                displacement[2] + weight * curvature.y,
            ];
            turn = turn + like.splat(part) * normal.dot(curvature);
        }
        let held = times(&leg.stiffness.at_platform, &displacement);
        turn - dot(&displacement, &held) + dot(&held, &times(&loaded.bending, &held))
    }
}
