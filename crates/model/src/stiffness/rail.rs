//! Rails of the base that bend under their sliders (docs/model.md, section 4.8).
//!
//! A rail is a beam along the travel of its slider. It carries the force across it, the force along z and all moments; the force along
//! it goes into the drive of the slider, or is zero if the slider is passive.

use glam::DVec2;
use nalgebra::Matrix6;

use super::BarCompliance;
use crate::lanes::{Planar, Real};
use crate::mechanism::CrossSection;

/// How the ends of the spans of a rail are supported. Every support keeps the rail from turning about its own axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RailSupports {
    /// Supports that hold position and slope, at both ends and between `spans` equally long spans; at least 1.
    Clamped {
        /// Number of spans.
        spans: u32,
    },
    /// A support at each end that holds the position, but not the slope.
    Pinned,
}

/// Rails of the base, all of which have one cross-section and the material of the bars.
#[derive(Debug, Clone, PartialEq)]
pub struct RailSettings {
    /// Cross-section.
    pub section: CrossSection,
    /// Outer radius, or half of the outer width \[m\].
    pub radius: f64,
    /// Supports.
    pub supports: RailSupports,
}

/// Compliance of a rail, whose length is the travel of its slider.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RailBeam {
    pub section: BarCompliance,
    pub supports: RailSupports,
}

/// Compliance of a rail where its slider is: to a force across the rail, to a moment about the normal of the plane of bending, and to
/// torsion. The same numbers hold in the plane and along z.
#[derive(Clone, Copy)]
pub(super) struct RailCompliance<V> {
    /// Displacement per force \[m/N\].
    pub force: V,
    /// Slope per force, and displacement per moment \[1/N\].
    pub coupling: V,
    /// Slope per moment \[1/(N·m)\].
    pub moment: V,
    /// Rotation about the axis of the rail per moment about it \[1/(N·m)\].
    pub torsion: V,
}

impl RailBeam {
    /// Computes the compliance for a slider at the given distances from the ends of its travel \[m\].
    ///
    /// A clamped span consists of two cantilevers in parallel, of the lengths `a` and `b`, and its compliance is the inverse of the sum of
    /// their stiffnesses.
    #[inline(always)]
    pub fn at<V: Real>(&self, [from_start, to_end]: [V; 2]) -> RailCompliance<V> {
        let like = from_start;
        let (zero, third) = (like.splat(0.0), like.splat(1.0 / 3.0));
        let (bending, torsion) = (like.splat(self.section.bending), like.splat(self.section.torsion));
        let length = from_start + to_end;
        match self.supports {
            RailSupports::Clamped { spans } => {
                let span = length * like.splat(1.0 / f64::from(spans));
                let mut before = zero;
                for index in 1..spans {
                    let support = span * like.splat(f64::from(index));
                    before = support.select(from_start.at_least(support), before);
                }
                let a = (from_start - before).larger(zero);
                let b = (span - a).larger(zero);
                let (one, product) = (like.splat(1.0) / span, a * b);
                let cube = one * one * one * bending;
                RailCompliance {
                    force: product * product * product * cube * third,
                    coupling: product * product * (b - a) * cube * like.splat(0.5),
                    moment: product * (a * a - product + b * b) * cube,
                    torsion: product * one * torsion,
                }
            }
            RailSupports::Pinned => {
                let (a, b) = (from_start.larger(zero), to_end.larger(zero));
                let (one, product) = (like.splat(1.0) / length, a * b);
                let scale = one * bending * third;
                RailCompliance {
                    force: product * product * scale,
                    coupling: product * (b - a) * scale,
                    moment: (a * a - product + b * b) * scale,
                    torsion: product * one * torsion,
                }
            }
        }
    }
}

impl<V: Real> RailCompliance<V> {
    /// Computes the displacement across the rail and the rotation, each times its load: the compliance along a line that loads the rail
    /// with the given force and moment.
    #[inline(always)]
    pub fn under(&self, force: V, moment: V) -> V {
        let mixed = force * moment * self.coupling;
        force * force * self.force + (mixed + mixed) + moment * moment * self.moment
    }

    /// Adds the out-of-plane compliance of a rail with the direction `axis` and its slider at `P − to_p` to `s`, the compliance at `P`.
    #[inline(always)]
    pub fn add_to(&self, s: &mut [V; 6], axis: Planar<V>, to_p: Planar<V>) {
        let normal = axis.perp();
        let lever = Planar::new(to_p.y, -to_p.x);
        let (twisted, bent) = (lever.dot(axis), lever.dot(normal));
        // A moment about the normal lowers the rail ahead of the slider, so that it acts against the slope.
        let (x, y) = (self.torsion * twisted, self.moment * bent - self.coupling);
        s[0] = s[0] + self.force + bent * (y - self.coupling) + x * twisted;
        s[1] = s[1] + x * axis.x + y * normal.x;
        s[2] = s[2] + x * axis.y + y * normal.y;
        s[3] = s[3] + self.torsion * axis.x * axis.x + self.moment * normal.x * normal.x;
        s[4] = s[4] + self.torsion * axis.x * axis.y + self.moment * normal.x * normal.y;
        s[5] = s[5] + self.torsion * axis.y * axis.y + self.moment * normal.y * normal.y;
    }
}

impl RailCompliance<f64> {
    /// Returns the 6×6 compliance matrix in the axes of the rail, linear first.
    pub fn matrix(&self) -> Matrix6<f64> {
        let mut c = Matrix6::zeros();
        (c[(1, 1)], c[(2, 2)]) = (self.force, self.force);
        (c[(5, 5)], c[(4, 4)]) = (self.moment, self.moment);
        (c[(1, 5)], c[(5, 1)]) = (self.coupling, self.coupling);
        (c[(2, 4)], c[(4, 2)]) = (-self.coupling, -self.coupling);
        c[(3, 3)] = self.torsion;
        c
    }
}

/// Rail under a slider at a posture.
pub(super) struct LoadedRail {
    pub compliance: RailCompliance<f64>,
    /// Unit vector along it.
    pub axis: DVec2,
    /// Vector from the slider to `P` \[m\].
    pub to_p: DVec2,
    /// Moment of the leg's line about the slider \[m\].
    pub moment: f64,
}

impl LoadedRail {
    /// Computes the compliance to a unit force along the line of the leg \[m/N\].
    pub fn line_compliance(&self, u: DVec2) -> f64 {
        self.compliance.under(self.axis.perp().dot(u), self.moment)
    }

    /// Adds the out-of-plane compliance at `P` to `s`.
    pub fn add_to(&self, s: &mut [f64; 6]) {
        self.compliance.add_to(s, self.axis.into(), self.to_p.into());
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    use super::*;

    const SECTION: BarCompliance = BarCompliance {
        axial: 1e-9,
        bending: 2e-6,
        torsion: 3e-6,
    };

    /// Returns displacement and slope under a unit force, and under a unit moment, at a distance from the start of a rail of the given
    /// length: beam elements between the supports and the load.
    fn by_elements(supports: RailSupports, length: f64, from_start: f64) -> [[f64; 2]; 2] {
        let spans = match supports {
            RailSupports::Clamped { spans } => spans,
            RailSupports::Pinned => 1,
        };
        let mut nodes: Vec<f64> = (0..=spans).map(|k| length * f64::from(k) / f64::from(spans)).collect();
        let held = nodes.clone();
        nodes.push(from_start);
        nodes.sort_by(f64::total_cmp);
        nodes.dedup();
        let mut stiffness = DMatrix::<f64>::zeros(2 * nodes.len(), 2 * nodes.len());
        for (index, pair) in nodes.windows(2).enumerate() {
            let l = pair[1] - pair[0];
            let rigidity = 1.0 / SECTION.bending;
            let rows = [
                [12.0, 6.0 * l, -12.0, 6.0 * l],
                [6.0 * l, 4.0 * l * l, -6.0 * l, 2.0 * l * l],
                [-12.0, -6.0 * l, 12.0, -6.0 * l],
                [6.0 * l, 2.0 * l * l, -6.0 * l, 4.0 * l * l],
            ];
            let element = nalgebra::Matrix4::from(rows) * (rigidity / (l * l * l));
            let mut block = stiffness.fixed_view_mut::<4, 4>(2 * index, 2 * index);
            block += element;
        }
        for (index, node) in nodes.iter().enumerate() {
            if held.contains(node) {
                let directions: &[usize] = if supports == RailSupports::Pinned {
                    &[0]
                } else {
                    &[0, 1]
                };
                for direction in directions.iter().map(|direction| 2 * index + direction) {
                    stiffness.row_mut(direction).fill(0.0);
                    stiffness.column_mut(direction).fill(0.0);
                    stiffness[(direction, direction)] = 1.0;
                }
            }
        }
        let loaded = 2 * nodes.iter().position(|node| *node == from_start).expect("a node");
        let factored = stiffness.lu();
        [0, 1].map(|load| {
            let mut loads = DVector::zeros(2 * nodes.len());
            loads[loaded + load] = 1.0;
            let moved = factored.solve(&loads).expect("a supported beam");
            [moved[loaded], moved[loaded + 1]]
        })
    }

    proptest! {
        #[test]
        fn a_rail_yields_as_its_beam_elements_do(
            length in 0.2..4.0f64, share in 0.01..0.99f64, spans in 0..6u32,
        ) {
            let supports = if spans == 0 { RailSupports::Pinned } else { RailSupports::Clamped { spans } };
            let place = share * length;
            let near_support = (share * f64::from(spans.max(1))).fract();
            prop_assume!((0.02..0.98).contains(&near_support));
            let found = RailBeam { section: SECTION, supports }.at([place, length - place]);
            let [force, moment] = by_elements(supports, length, place);
            let close = |found: f64, wanted: f64, scale: f64| (found - wanted).abs() <= 1e-7 * scale;
            let mixed = (force[0] * moment[1]).sqrt();
            prop_assert!(close(found.force, force[0], force[0]), "{} {force:?}", found.force);
            prop_assert!(close(found.coupling, force[1], mixed) && close(found.coupling, moment[0], mixed));
            prop_assert!(close(found.moment, moment[1], moment[1]), "{} {moment:?}", found.moment);
        }
    }

    /// Deflections in the middle of a span: `FL³/192EI` if it is clamped, `FL³/48EI` if it is pinned; supports are rigid.
    #[test]
    fn rails_have_the_deflections_of_beam_tables() {
        let beam = |supports| RailBeam {
            section: SECTION,
            supports,
        };
        let cube = 8.0 * SECTION.bending;
        let clamped = beam(RailSupports::Clamped { spans: 1 }).at([1.0, 1.0]);
        assert!((clamped.force / (cube / 192.0) - 1.0).abs() < 1e-14 && clamped.coupling == 0.0);
        let pinned = beam(RailSupports::Pinned).at([1.0, 1.0]);
        assert!((pinned.force / (cube / 48.0) - 1.0).abs() < 1e-14 && pinned.coupling == 0.0);
        assert!((pinned.torsion / (0.5 * SECTION.torsion) - 1.0).abs() < 1e-14);
        let two = beam(RailSupports::Clamped { spans: 2 });
        let at_support = two.at([1.0, 1.0]);
        assert_eq!([at_support.force, at_support.moment, at_support.torsion], [0.0; 3]);
        let half = two.at([0.5, 1.5]);
        assert!((half.force * 8.0 / clamped.force - 1.0).abs() < 1e-14);
    }
}
