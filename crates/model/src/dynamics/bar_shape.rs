//! How a bar moves between its ends, and what it contributes to the mass.

use super::displacement::{Row, add, add_square, combined};
use crate::lanes::{LaneJob, Real, less, scaled, sum};
use crate::strength::bars::BarLanes;

/// Abscissas and weights of the Gauss rule with four points on `[−1, 1]`, which is exact for the product of two cubics.
pub(super) const GAUSS: [[f64; 2]; 4] = [
    [-0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
    [-0.339_981_043_584_856_26, 0.652_145_154_862_546_2],
    [0.339_981_043_584_856_26, 0.652_145_154_862_546_2],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
];

/// Displacement across a bar, as the coefficients of a polynomial in the distance from its base.
type Cubic<V> = [Row<V>; 4];

/// Displacements of the ends of a bar.
pub(super) struct BarEnds<V> {
    /// Displacement across the bar, and slope, at the base.
    pub base: [Row<V>; 2],
    /// The same at the tip.
    pub tip: [Row<V>; 2],
    /// Displacement along the bar, or rotation about it, at each end.
    pub along: [Row<V>; 2],
}

impl<V: Real> BarEnds<V> {
    /// Adds what a bar of uniform mass contributes to the mass, out of the plane if `is_torsion`: the second displacement is then the
    /// rotation about the bar.
    #[inline(always)]
    pub(super) fn add_uniform(&self, mass: &mut [V; 6], bar: &BarLanes<V>, gyration: f64, is_torsion: bool) {
        let inertia = Inertia::of(bar.length, bar.pieces[0].density, gyration, is_torsion);
        let added = bar.length.call_apart(Uniform {
            ends: self,
            length: bar.length,
            inertia,
        });
        add(mass, &added);
    }
}

/// What a bar of uniform mass contributes to the mass, as a function of its own.
///
/// The cubic between the ends is taken at the shares of the Gauss rule, where its parts are the same for bars of all lengths.
struct Uniform<'a, V> {
    ends: &'a BarEnds<V>,
    length: V,
    inertia: Inertia<V>,
}

impl<V: Real> LaneJob for Uniform<'_, V> {
    type Output = [V; 6];

    #[inline(always)]
    fn run(self) -> [V; 6] {
        let Self { ends, length, inertia } = self;
        let mut mass = [length.splat(0.0); 6];
        let turned = [scaled(&ends.base[1], length), scaled(&ends.tip[1], length)];
        let apart = less(&ends.tip[0], &ends.base[0]);
        let (across, slopes) = (inertia.across * length, inertia.slope / length);
        for [abscissa, weight] in GAUSS {
            let (share, weight) = (0.5 * (1.0 + abscissa), length.splat(0.5 * weight));
            let rest = 1.0 - share;
            let chord = scaled(&apart, length.splat(share * share * (3.0 - 2.0 * share)));
            let bent = combined(
                &turned[0],
                length.splat(share * rest * rest),
                &turned[1],
                length.splat(-share * share * rest),
            );
            add_square(&mut mass, &sum(&sum(&ends.base[0], &chord), &bent), across * weight);
            let chord = scaled(&apart, length.splat(6.0 * share * rest));
            let bent = combined(
                &turned[0],
                length.splat(rest * (1.0 - 3.0 * share)),
                &turned[1],
                length.splat(share * (3.0 * share - 2.0)),
            );
            add_square(&mut mass, &sum(&chord, &bent), slopes * weight);
        }
        // The second displacement is linear: its mean and the difference from it at the ends are enough.
        let (along, half) = (inertia.along * length, length.splat(0.5));
        let mean = scaled(&sum(&ends.along[0], &ends.along[1]), half);
        let off = scaled(&less(&ends.along[1], &ends.along[0]), half);
        add_square(&mut mass, &mean, along);
        add_square(&mut mass, &off, along * length.splat(1.0 / 3.0));
        mass
    }
}

/// How a bar moves between its ends.
pub(super) struct BarShape<V> {
    /// Between the ends, before the base, and beyond the tip, where a guide goes on straight.
    across: [Cubic<V>; 3],
    /// Displacement along the bar, or rotation about it, at each end.
    along: [Row<V>; 2],
    per_length: V,
}

/// The mass that a displacement along or about the bar moves.
#[derive(Clone, Copy)]
struct Inertia<V> {
    /// Per length, of a displacement across the bar and of one along it or a rotation about it \[kg/m or kg·m\].
    across: V,
    along: V,
    /// Per length, of a rotation of the section \[kg·m\].
    slope: V,
}

impl<V: Real> Inertia<V> {
    /// Returns the inertia of a piece of a bar, out of the plane if `is_torsion`.
    #[inline(always)]
    fn of(like: V, density: f64, gyration: f64, is_torsion: bool) -> Self {
        let per_length = like.splat(density);
        let slope = per_length * like.splat(gyration);
        Self {
            across: per_length,
            slope,
            along: match is_torsion {
                true => slope * like.splat(2.0),
                false => per_length,
            },
        }
    }
}

/// Returns the value and the slope of a polynomial at a distance.
#[inline(always)]
fn at<V: Real>(cubic: &Cubic<V>, distance: V) -> [Row<V>; 2] {
    let [a, b, c, d] = cubic;
    let two = distance.splat(2.0);
    let three = distance.splat(3.0);
    let mut value = [distance; 3];
    let mut slope = [distance; 3];
    for k in 0..3 {
        value[k] = a[k] + distance * (b[k] + distance * (c[k] + distance * d[k]));
        slope[k] = b[k] + distance * (two * c[k] + distance * three * d[k]);
    }
    [value, slope]
}

impl<V: Real> BarShape<V> {
    /// Returns the shape of a bar of which the displacements of the ends are given.
    #[inline(always)]
    pub(super) fn new(length: V, ends: &BarEnds<V>) -> Self {
        let ([base, base_slope], [tip, tip_slope], along) = (ends.base, ends.tip, ends.along);
        let (zero, one) = (length.splat(0.0), length.splat(1.0));
        let exists = length.exceeds(zero);
        let per_length = (one / length.select(exists, one)).select(exists, zero);
        let mut between = [base, base_slope, base, base];
        let mut beyond = [tip, tip_slope, [zero; 3], [zero; 3]];
        for k in 0..3 {
            let apart = (tip[k] - base[k]) * per_length;
            let (two, three) = (zero.splat(2.0), zero.splat(3.0));
            between[2][k] = (three * apart - two * base_slope[k] - tip_slope[k]) * per_length;
            between[3][k] = (base_slope[k] + tip_slope[k] - two * apart) * per_length * per_length;
            beyond[0][k] = tip[k] - tip_slope[k] * length;
        }
        Self {
            across: [between, [base, base_slope, [zero; 3], [zero; 3]], beyond],
            along,
            per_length,
        }
    }

    /// Returns the displacement across the bar at a share of its length, and that along it.
    #[inline(always)]
    pub(super) fn at_share(&self, length: V, share: V) -> [Row<V>; 2] {
        let [across, _] = at(&self.across[0], length * share);
        let rest = share.splat(1.0) - share;
        [across, combined(&self.along[0], rest, &self.along[1], share)]
    }

    /// Returns the displacement across the bar at a distance from its base.
    #[inline(always)]
    pub(super) fn at_distance(&self, distance: V) -> Row<V> {
        at(&self.across[0], distance)[0]
    }

    /// Adds what a stretch of the bar, or of a guide beyond its ends, contributes to the mass.
    #[inline(always)]
    fn add_stretch(&self, mass: &mut [V; 6], which: usize, [from, to]: [V; 2], inertia: Inertia<V>) {
        let added = from.call_apart(Stretch {
            across: &self.across[which],
            along: &self.along,
            share: match which {
                0 => self.per_length,
                _ => from.splat(0.0),
            },
            begin: from.splat(if which == 2 { 1.0 } else { 0.0 }),
            ends: [from, to],
            inertia,
        });
        add(mass, &added);
    }

    /// Adds what the pieces of a bar contribute to the mass, out of the plane if `is_torsion`: the second displacement is then the rotation
    /// about the bar. What lies beyond an end is added where there is something.
    #[inline(always)]
    pub(super) fn add_pieces(
        &self,
        mass: &mut [V; 6],
        bar: &BarLanes<V>,
        gyration: f64,
        is_torsion: bool,
        is_telescopic: bool,
        at_shares: bool,
    ) {
        let zero = bar.length.splat(0.0);
        for (place, piece) in bar.pieces.iter().enumerate() {
            if piece.density == 0.0 {
                continue;
            }
            let inertia = Inertia::of(zero, piece.density, gyration, is_torsion);
            // The tube stays with the base, and the rod with the platform.
            let own = [self.along[place]; 2];
            let whole;
            let shape = if is_telescopic && !is_torsion {
                whole = Self {
                    along: own,
                    across: self.across,
                    per_length: self.per_length,
                };
                &whole
            } else {
                self
            };
            if bar.is_uniform {
                shape.add_stretch(mass, 0, [zero, bar.length], inertia);
                continue;
            }
            let (from, to) = (piece.from, piece.to);
            // A comparison of enclosures would not tell that nothing lies beyond the ends.
            if at_shares && piece.is_within {
                shape.add_stretch(mass, 0, [from, to], inertia);
                continue;
            }
            let within = [
                from.larger(zero).smaller(bar.length),
                to.larger(zero).smaller(bar.length),
            ];
            shape.add_stretch(mass, 0, within, inertia);
            if V::any(zero.exceeds(from)) {
                shape.add_stretch(mass, 1, [from.smaller(zero), to.smaller(zero)], inertia);
            }
            if V::any(to.exceeds(bar.length)) {
                shape.add_stretch(mass, 2, [from.larger(bar.length), to.larger(bar.length)], inertia);
            }
        }
    }
}

/// What a stretch of a bar contributes to the mass, as a function of its own: there are many of them.
struct Stretch<'a, V> {
    across: &'a Cubic<V>,
    along: &'a [Row<V>; 2],
    /// How the share of the second displacement along the bar grows with the distance, and where it begins.
    share: V,
    begin: V,
    ends: [V; 2],
    inertia: Inertia<V>,
}

impl<V: Real> LaneJob for Stretch<'_, V> {
    type Output = [V; 6];

    #[inline(always)]
    fn run(self) -> [V; 6] {
        let [from, to] = self.ends;
        let mut mass = [from.splat(0.0); 6];
        let half = (to - from) * from.splat(0.5);
        let middle = (to + from) * from.splat(0.5);
        for [abscissa, weight] in GAUSS {
            let distance = middle + half * from.splat(abscissa);
            let weight = half * from.splat(weight);
            let [value, slope] = at(self.across, distance);
            add_square(&mut mass, &value, weight * self.inertia.across);
            add_square(&mut mass, &slope, weight * self.inertia.slope);
            let share = self.begin + distance * self.share;
            let along = combined(&self.along[0], from.splat(1.0) - share, &self.along[1], share);
            add_square(&mut mass, &along, weight * self.inertia.along);
        }
        mass
    }
}
