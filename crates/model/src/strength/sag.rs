//! How legs sag under their own weight at several poses at once (docs/model.md, section 14.4).

use super::StrengthModel;
use super::path::BARS;
use super::resultants::{LegBasis, times, weight_moment};
use crate::lanes::{Planar, Real, sum};

/// Distance of a Gauss point from the middle of a stretch, as a share of half its length: `1/√3`.
const GAUSS: f64 = 0.577_350_269_189_625_8;

impl StrengthModel {
    /// Returns `S_i⁻¹ δ_i`: what at `P` keeps the free end of a leg where it is without weight.
    #[inline(always)]
    pub(super) fn held<V: Real>(&self, leg: &LegBasis<'_, V>) -> [V; 3] {
        match &leg.stiffness.at_centre {
            None => {
                let nowhere = Planar::new(leg.moment.splat(0.0), leg.moment.splat(0.0));
                times(&leg.stiffness.at_platform, &self.sag(leg, nowhere))
            }
            Some((centre, stiffness)) => {
                let [lift, x, y] = times(stiffness, &self.sag(leg, *centre));
                [lift, x + lift * centre.y, y - lift * centre.x]
            }
        }
    }

    /// Returns `δ_i`: the displacement along z and the rotations of the free end of a leg under its own weight, where it is fixed to a
    /// point relative to `P`.
    #[inline(always)]
    fn sag<V: Real>(&self, leg: &LegBasis<'_, V>, of: Planar<V>) -> [V; 3] {
        let zero = leg.moment.splat(0.0);
        let mut sag = [zero; 3];
        for bar in self.first()..BARS {
            let lanes = &leg.path.bars[bar];
            if lanes.is_uniform {
                self.add_sag(&mut sag, (leg, of), bar, [zero, lanes.length]);
            } else {
                // Between the ends of the pieces the load is uniform.
                let [first, second] = &lanes.pieces;
                let (a, b) = match second.density == 0.0 {
                    true => (first.from, first.to),
                    false => (first.to, second.from),
                };
                let a = a.larger(zero).smaller(lanes.length);
                let b = b.larger(zero).smaller(lanes.length);
                let (a, b) = (a.smaller(b), a.larger(b));
                self.add_sag(&mut sag, (leg, of), bar, [zero, a]);
                self.add_sag(&mut sag, (leg, of), bar, [a, b]);
                self.add_sag(&mut sag, (leg, of), bar, [b, lanes.length]);
            }
        }
        sag
    }

    /// Adds what a stretch of a bar contributes, by two Gauss points, which are exact there.
    #[inline(always)]
    fn add_sag<V: Real>(&self, sag: &mut [V; 3], leg: (&LegBasis<'_, V>, Planar<V>), bar: usize, [from, to]: [V; 2]) {
        let half = (to - from) * from.splat(0.5);
        let middle = (to + from) * from.splat(0.5);
        let apart = half * from.splat(GAUSS);
        self.add_sag_at(sag, leg, bar, middle - apart, half);
        self.add_sag_at(sag, leg, bar, middle + apart, half);
    }

    #[inline(always)]
    fn add_sag_at<V: Real>(
        &self,
        sag: &mut [V; 3],
        (leg, of): (&LegBasis<'_, V>, Planar<V>),
        bar: usize,
        distance: V,
        weight: V,
    ) {
        let lanes = &leg.path.bars[bar];
        let compliance = &self.section(bar).compliance;
        let place = lanes.place(distance);
        let beyond = lanes.mass_from(distance).and(leg.from[bar + 1]);
        let moment = weight_moment(&self.loads, &beyond, place);
        let (axis, normal) = (lanes.axis, lanes.axis.perp());
        let twist = weight * weight.splat(compliance.torsion) * axis.dot(moment);
        let bend = weight * weight.splat(compliance.bending) * normal.dot(moment);
        let turn = axis.scaled(twist).plus(normal.scaled(bend));
        let lift = place.minus(of).perp().dot(turn);
        *sag = sum(sag, &[lift, turn.x, turn.y]);
    }
}
