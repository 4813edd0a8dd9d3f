//! Stress in the bars at several poses at once (docs/model.md, sections 14.2 and 14.6).

use super::path::{BARS, BarSection, End};
use super::resultants::{LoadedLeg, Ranged};
use super::{LoadShape, StrengthModel};
use crate::lanes::{Planar, Real};

/// Number of stretches between the sections of a bar whose weight counts; without weight both ends suffice.
const STRETCHES: usize = 8;

/// What a section of a bar carries.
#[derive(Clone, Copy)]
pub(super) struct SectionLoads<V> {
    /// Force along the bar, positive in tension \[N\].
    pub axial: Ranged<V>,
    /// Bending moment about z \[N·m\].
    pub in_plane: Ranged<V>,
    /// Bending moment about the normal of the bar in the plane \[N·m\].
    pub out_of_plane: Ranged<V>,
    /// Torsion \[N·m\].
    pub torsion: Ranged<V>,
}

impl<V: Real> SectionLoads<V> {
    /// Returns bounds of all magnitudes and ranges.
    #[inline(always)]
    fn bound(&self) -> Self {
        Self {
            axial: self.axial.bound(),
            in_plane: self.in_plane.bound(),
            out_of_plane: self.out_of_plane.bound(),
            torsion: self.torsion.bound(),
        }
    }
}

/// What a bar carries at its end at the platform, without its own weight. Towards the base, the moments change in proportion to the
/// distance.
#[derive(Clone, Copy)]
pub(super) struct BarLoads<V> {
    axial: Ranged<V>,
    shear: V,
    in_plane: V,
    /// Moment of the leg's line about the end, and by how much it grows per length \[m, –\].
    lever: V,
    lever_slope: V,
    lift: V,
    out_of_plane: V,
    /// Derivatives by `f_z`, `m_x` and `m_y`.
    out_of_plane_by: [V; 3],
    torsion: Ranged<V>,
}

impl StrengthModel {
    /// Returns the number of sections of a bar.
    #[inline(always)]
    pub(super) fn sections(&self) -> usize {
        if self.weighs() { STRETCHES + 1 } else { 2 }
    }

    /// Returns what a bar carries.
    #[inline(always)]
    pub(super) fn bar_loads<V: Real>(&self, leg: &LoadedLeg<'_, V>, bar: usize) -> BarLoads<V> {
        let lanes = &leg.path.bars[bar];
        let end = lanes.place(lanes.length);
        let lever = self.paths[0].lever(bar, End::Platform, leg.lever(end));
        let carried = self.resultants(leg, (end, lever), &leg.from[bar + 1]);
        let (axis, normal) = (lanes.axis, lanes.axis.perp());
        let (mut shear, mut lever_slope) = (carried.force.dot(normal), leg.u.dot(normal));
        if self.paths[0].is_on_line(bar) {
            lever_slope = lever_slope.known_to_be(0.0);
            let [is_loaded_across, _] = self.loads.weighs();
            if !is_loaded_across {
                shear = shear.known_to_be(0.0);
            }
        }
        BarLoads {
            axial: Ranged {
                value: carried.force.dot(axis),
                range: leg.u.dot(axis).abs() * leg.line.range,
            },
            shear,
            in_plane: carried.turn.value,
            lever,
            lever_slope,
            lift: carried.lift.value,
            out_of_plane: carried.moment.dot(normal),
            out_of_plane_by: leg.moment_by(end, normal),
            torsion: self.about(leg, end, carried.moment, axis),
        }
    }

    /// Returns what a section of a bar carries; the sections are counted from the base.
    #[inline(always)]
    pub(super) fn section_loads<V: Real>(
        &self,
        leg: &LoadedLeg<'_, V>,
        bar: usize,
        loads: &BarLoads<V>,
        section: usize,
    ) -> SectionLoads<V> {
        let lanes = &leg.path.bars[bar];
        let like = lanes.length;
        let share = section as f64 / (self.sections() - 1) as f64;
        let distance = like * like.splat(share);
        let left = like - distance;
        let [a, b, c] = loads.out_of_plane_by;
        let [da, db, dc] = leg.share[0];
        let range = self
            .loads
            .out_of_plane_range(&[a - left * da, b - left * db, c - left * dc]);
        let mut axial = loads.axial;
        let mut in_plane = loads.in_plane + left * loads.shear;
        let mut out_of_plane = loads.out_of_plane - left * loads.lift;
        if self.weighs() {
            let (mass, lever) = lanes.mass_on(distance);
            let [x, y, z] = self.loads.gravity.map(|part| like.splat(part));
            let gravity = Planar::new(x, y);
            axial.value = axial.value + mass * gravity.dot(lanes.axis);
            in_plane = in_plane + lever * gravity.dot(lanes.axis.perp());
            out_of_plane = out_of_plane - lever * z;
        }
        SectionLoads {
            axial,
            in_plane: Ranged {
                value: in_plane,
                range: (loads.lever + left * loads.lever_slope).abs() * leg.line.range,
            },
            out_of_plane: Ranged {
                value: out_of_plane,
                range,
            },
            torsion: loads.torsion,
        }
    }

    /// Returns the component of a moment about an axis in the plane.
    #[inline(always)]
    pub(super) fn about<V: Real>(
        &self,
        leg: &LoadedLeg<'_, V>,
        place: Planar<V>,
        moment: Planar<V>,
        axis: Planar<V>,
    ) -> Ranged<V> {
        Ranged {
            value: moment.dot(axis),
            range: self.loads.out_of_plane_range(&leg.moment_by(place, axis)),
        }
    }

    /// Returns the squared stress of a section \[Pa²\].
    #[inline(always)]
    pub(super) fn squared_stress<V: Real>(&self, bar: usize, carried: &SectionLoads<V>) -> V {
        let section = self.section(bar);
        match self.loads.shape {
            LoadShape::Box | LoadShape::Cylinder => squared_stress(
                section,
                carried.axial.most(),
                carried.in_plane.most(),
                carried.out_of_plane.most(),
                carried.torsion.most(),
            ),
            LoadShape::Ellipsoid => {
                let given = squared_stress(
                    section,
                    carried.axial.value.abs(),
                    carried.in_plane.value.abs(),
                    carried.out_of_plane.value.abs(),
                    carried.torsion.value.abs(),
                );
                let like = given;
                let axial = carried.axial.range * like.splat(section.per_area)
                    + carried.in_plane.range * like.splat(section.bending);
                let bending = carried.out_of_plane.range * like.splat(section.bending);
                let shear = carried.torsion.range * like.splat(section.torsion);
                let varied = axial * axial + bending * bending + like.splat(3.0) * shear * shear;
                let stress = given.sqrt() + varied.sqrt();
                stress * stress
            }
        }
    }

    /// Returns an upper bound of the squared stress anywhere in a bar \[Pa²\]: between the ends, a moment differs from a line by at most
    /// `q L²/8`, where `q` is the largest weight per length. The squared stress is convex, so that it nowhere exceeds that of an end at which both
    /// moments are larger by as much.
    #[inline(always)]
    fn bound_of_bar<V: Real>(&self, leg: &LoadedLeg<'_, V>, bar: usize, ends: &[SectionLoads<V>; 2]) -> V {
        let lanes = &leg.path.bars[bar];
        let [x, y, z] = self.loads.gravity;
        let gravity = Planar::new(lanes.length.splat(x), lanes.length.splat(y));
        let [first, second] = &lanes.pieces;
        let length = lanes.length.magnitude_bound();
        let eighth = length * length * length.splat((first.density + second.density) / 8.0);
        let in_plane = eighth * gravity.dot(lanes.axis.perp()).magnitude_bound();
        let out_of_plane = eighth * length.splat(z.abs());
        let [mut base, mut platform] = [ends[0].bound(), ends[1].bound()];
        // The force along the bar need not change in proportion to the distance.
        let axial = base.axial.value.larger(platform.axial.value);
        for end in [&mut base, &mut platform] {
            end.axial.value = axial;
            end.in_plane.value = end.in_plane.value + in_plane;
            end.out_of_plane.value = end.out_of_plane.value + out_of_plane;
        }
        let bound = self
            .squared_stress(bar, &base)
            .larger(self.squared_stress(bar, &platform));
        // The factor covers rounding.
        bound * length.splat(1.0 + 1e-9)
    }

    /// Returns the largest stress of any bar \[Pa\]; a guide whose carriage is at its joint has none. Bars that nowhere exceed
    /// the stress `kept` are left out.
    #[inline(always)]
    pub(super) fn largest_stress<V: Real>(&self, legs: &[LoadedLeg<'_, V>], kept: Option<f64>) -> V {
        let zero = legs[0].moment.splat(0.0);
        let mut most = zero;
        for leg in legs {
            for bar in self.first()..BARS {
                let loads = self.bar_loads(leg, bar);
                let last = self.sections() - 1;
                let ends = [
                    self.section_loads(leg, bar, &loads, 0),
                    self.section_loads(leg, bar, &loads, last),
                ];
                let bound = match last > 1 || kept.is_some() {
                    true => self.bound_of_bar(leg, bar, &ends),
                    false => zero,
                };
                if let Some(kept) = kept
                    && !V::any(bound.exceeds(zero.splat(kept) * zero.splat(kept)))
                {
                    continue;
                }
                let mut of_bar = zero.larger(self.squared_stress(bar, &ends[0]));
                of_bar = of_bar.larger(self.squared_stress(bar, &ends[1]));
                // Most bars are loaded most at an end, or less than another bar wherever they are loaded most.
                if last > 1 && V::any(bound.exceeds(most.larger(of_bar))) {
                    for section in 1..last {
                        let carried = self.section_loads(leg, bar, &loads, section);
                        of_bar = of_bar.larger(self.squared_stress(bar, &carried));
                    }
                }
                let length = leg.path.bars[bar].length;
                most = most.larger(of_bar.select(length.exceeds(zero), zero));
            }
        }
        most.sqrt()
    }
}

/// Returns the squared equivalent stress of a section under magnitudes of the force along it, of both bending moments and of the
/// torsion.
#[inline(always)]
fn squared_stress<V: Real>(section: &BarSection, axial: V, in_plane: V, out_of_plane: V, torsion: V) -> V {
    let bending = if section.is_square {
        in_plane + out_of_plane
    } else {
        (in_plane * in_plane + out_of_plane * out_of_plane).sqrt()
    };
    let normal = axial * axial.splat(section.per_area) + bending * axial.splat(section.bending);
    let shear = torsion * axial.splat(section.torsion);
    normal * normal + axial.splat(3.0) * shear * shear
}
