//! Compliance of a rail of the base over a box of poses (docs/model.md, section 4.8).

use super::bars::per_length;
use crate::enclosure::{Interval, TaylorModel};
use crate::evaluation::Model;
use crate::mechanism::{Design, LegFrameEnclosure};
use crate::stiffness::RailSupports;

/// Compliances of a rail of length `L_b`, as multiples of the units of the other compliances.
pub(super) struct RailCompliances {
    supports: RailSupports,
    /// Bending compliance in the plane, for moments as multiples of `L_b`.
    pub in_plane: Interval,
    /// Bending and torsional compliance out of the plane.
    pub vertical: [Interval; 2],
}

/// What a unit load does to a rail where its slider is, for lengths in units of `L_b` and unit compliances per length.
pub(super) struct RailForms {
    /// Displacement per force.
    pub force: TaylorModel,
    /// Slope per force, and displacement per moment.
    pub coupling: TaylorModel,
    /// Slope per moment.
    pub moment: TaylorModel,
    /// Rotation about the axis of the rail per moment about it.
    pub torsion: TaylorModel,
}

impl RailCompliances {
    /// Returns the compliances of a design on rails that bend; the units are those along a line and of bending.
    pub fn new(model: &Model, design: &Design, [along, bend]: [Interval; 2]) -> Option<Self> {
        let rails = model.rails_of(design)?;
        let [_, bending, torsion] = per_length(&model.settings().material, &rails.section, rails.radius);
        let link = Interval::exactly(design.link_length());
        Some(Self {
            supports: rails.supports,
            in_plane: bending * link * link.square() / along,
            vertical: [bending * link / bend, torsion * link / bend],
        })
    }

    /// Encloses the effect of unit loads, for a slider at the given distances from the ends of its rail \[m\], which are positive.
    pub fn forms(&self, frame: &LegFrameEnclosure, slider: [TaylorModel; 2]) -> RailForms {
        let [from_start, to_end] = slider.map(|way| way.scaled(frame.to_unit));
        let length = (frame.rail_travel[1] - frame.rail_travel[0]) * frame.to_unit;
        match self.supports {
            RailSupports::Pinned => pinned([from_start, to_end], length),
            RailSupports::Clamped { spans: 1 } => clamped([from_start, to_end], length),
            RailSupports::Clamped { spans } => {
                let span = length / Interval::exactly(f64::from(spans));
                let support = |index: u32| span * Interval::exactly(f64::from(index));
                let [least, most] = from_start.range();
                let touches = |index: &u32| support(*index).lower() <= most && support(index + 1).upper() >= least;
                let touched: Vec<u32> = (0..spans).filter(touches).collect();
                if let [index] = touched[..] {
                    let before = TaylorModel::constant(support(index));
                    let after = TaylorModel::constant(support(index + 1));
                    return clamped([from_start - before, after - from_start], span);
                }
                at_supports(&touched, [least, most], span)
            }
        }
    }
}

impl RailForms {
    /// Multiplies the effects of bending and of torsion by their compliances.
    pub fn scaled(&self, [bending, torsion]: [Interval; 2]) -> Self {
        Self {
            force: self.force.scaled(bending),
            coupling: self.coupling.scaled(bending),
            moment: self.moment.scaled(bending),
            torsion: self.torsion.scaled(torsion),
        }
    }
}

/// A span whose ends hold position and slope.
fn clamped([a, b]: [TaylorModel; 2], span: Interval) -> RailForms {
    let [one, two, three] = [1.0, 2.0, 3.0].map(Interval::exactly);
    let cube = span * span.square();
    let product = a * b;
    let square = product.squared();
    RailForms {
        force: (square * product).scaled(one / (three * cube)),
        coupling: (square * (b - a)).scaled(one / (two * cube)),
        // a² − ab + b² = ℓ² − 3ab
        moment: (product * (TaylorModel::constant(span.square()) - product.times(3.0))).scaled(one / cube),
        torsion: product.scaled(one / span),
    }
}

/// A span whose ends hold the position alone.
fn pinned([a, b]: [TaylorModel; 2], span: Interval) -> RailForms {
    let per_third = Interval::exactly(1.0) / (Interval::exactly(3.0) * span);
    let product = a * b;
    RailForms {
        force: product.squared().scaled(per_third),
        coupling: (product * (b - a)).scaled(per_third),
        moment: (TaylorModel::constant(span.square()) - product.times(3.0)).scaled(per_third),
        torsion: product.scaled(Interval::exactly(1.0) / span),
    }
}

/// Clamped spans with a slider that may be on either side of a support: bounds of all values. Near a support they are close to 0.
fn at_supports(touched: &[u32], [least, most]: [f64; 2], span: Interval) -> RailForms {
    let mut hull: Option<[[f64; 2]; 4]> = None;
    for &index in touched {
        let before = span * Interval::exactly(f64::from(index));
        let a = Interval::new(
            (Interval::exactly(least) - before).lower().max(0.0),
            (Interval::exactly(most) - before).upper().min(span.upper()),
        );
        let (middle, radius) = a.middle_and_radius();
        let a = TaylorModel::variable(0, middle, radius);
        let forms = clamped([a, TaylorModel::constant(span) - a], span);
        let found = [forms.force, forms.coupling, forms.moment, forms.torsion].map(|form| form.range());
        hull = Some(hull.map_or(found, |hull| {
            [0, 1, 2, 3].map(|k| [hull[k][0].min(found[k][0]), hull[k][1].max(found[k][1])])
        }));
    }
    let enclose = |k: usize| match hull {
        Some(hull) => TaylorModel::constant(Interval::new(hull[k][0], hull[k][1])),
        None => TaylorModel::exactly(f64::NAN),
    };
    RailForms {
        force: enclose(0),
        coupling: enclose(1),
        moment: enclose(2),
        torsion: enclose(3),
    }
}
