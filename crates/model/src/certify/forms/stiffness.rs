//! Forms of the constraints on stiffness, g4 and g6, and which of them a study needs; those of g5 are in `out_of_plane` (docs/model.md,
//! section 13.3).

use super::rails::{RailCompliances, RailForms};
use super::{Enclosures, Forms, determinant, others, sum_of_legs, turn};
use crate::enclosure::{Interval, PlanarModel, TaylorModel, dot};
use crate::evaluation::PoseScalar;
use crate::mechanism::LegEnclosure;
use crate::spatial::LEGS;
use crate::stiffness::StiffnessDefinition;

/// What the forms in the plane have in common: with `γ_i` the compliances along the lines of the legs, `γ_j γ_k` for each leg and
/// `γ_1 γ_2 γ_3`.
struct AlongLines {
    one: [TaylorModel; LEGS],
    pairs: [TaylorModel; LEGS],
    product: TaylorModel,
}

impl Forms<'_> {
    /// g4, g5 and g6, as the study defines the stiffness values.
    pub(super) fn enclose_stiffness(&self, legs: &[LegEnclosure; LEGS], found: &mut Enclosures) {
        let definition = self.model.settings().stiffness_definition;
        let in_plane = [
            PoseScalar::StiffnessXy,
            PoseScalar::StiffnessPhiZ,
            PoseScalar::Displacement,
        ];
        if in_plane.iter().any(|&scalar| self.is_required(scalar, found)) {
            let one = [0, 1, 2].map(|i| self.along_line(&legs[i], i));
            let pairs = [one[1] * one[2], one[2] * one[0], one[0] * one[1]];
            let along = AlongLines {
                one,
                pairs,
                product: one[0] * pairs[0],
            };
            match definition {
                StiffnessDefinition::Stiffness => self.enclose_entries(legs, &along, found),
                StiffnessDefinition::Compliance => self.enclose_reciprocals(legs, &along, found),
            }
            if self.is_required(PoseScalar::Displacement, found) {
                self.enclose_compliant_xy(
                    legs,
                    &along,
                    (PoseScalar::Displacement, self.compliance.yielding),
                    found,
                );
            }
        }
        if self.is_required(PoseScalar::StiffnessZ, found) {
            match definition {
                StiffnessDefinition::Stiffness => self.enclose_vertical(legs, found),
                StiffnessDefinition::Compliance => self.enclose_vertical_reciprocal(legs, found),
            }
        }
    }

    /// Whether a scalar has a threshold that is not proved yet.
    fn is_required(&self, scalar: PoseScalar, found: &Enclosures) -> bool {
        self.limit(scalar) > 0.0 && found.needs(scalar)
    }

    /// g4 and g6 for the entries of `K`. With `T` the threshold, `k_xy > T` where `(λ₁ − T)(λ₂ − T) > 0` and `λ₁ + λ₂ > 2T`.
    fn enclose_entries(&self, legs: &[LegEnclosure; LEGS], along: &AlongLines, found: &mut Enclosures) {
        let product = along.product;
        if self.is_required(PoseScalar::StiffnessXy, found) {
            let sum = along.pairs[0] + along.pairs[1] + along.pairs[2];
            let threshold = self.compliance.in_plane;
            let determinant = sum_of_legs(|i| along.one[i] * turn(legs, i).squared()) - sum.scaled(threshold)
                + product.scaled(threshold.square());
            let excess = sum - product.times(2.0).scaled(threshold);
            let part = |i: usize| (along.pairs[i], legs[i].u);
            push_smaller_eigenvalue(found, PoseScalar::StiffnessXy, [determinant, excess], part);
        }
        if self.is_required(PoseScalar::StiffnessPhiZ, found) {
            let moments = sum_of_legs(|i| legs[i].moment.squared() * along.pairs[i]);
            found.push(
                PoseScalar::StiffnessPhiZ,
                moments - product.scaled(self.compliance.rotation),
            );
        }
    }

    /// The least stiffness in the plane of a platform that is free to turn, as the limit of a scalar. Let `S = K_xy − k k^T/K_φφ`, with
    /// `k` the column of the rotation, whose inverse is the block of `K⁻¹`. Multiplied by `γ_1 γ_2 γ_3 K_φφ/r²`, its determinant is
    /// `D²`, its trace `Σ γ_i (μ_j² + μ_k² − 2 μ_j μ_k C_i)`, and 1 is `Σ μ_i² γ_j γ_k`.
    fn enclose_compliant_xy(
        &self,
        legs: &[LegEnclosure; LEGS],
        along: &AlongLines,
        (scalar, threshold): (PoseScalar, Interval),
        found: &mut Enclosures,
    ) {
        let square = determinant(legs).squared();
        let trace = sum_of_legs(|i| {
            let [a, b] = others(i).map(|leg| legs[leg]);
            let mixed = (a.moment * b.moment * dot(a.u, b.u)).times(2.0);
            along.one[i] * (a.moment.squared() + b.moment.squared() - mixed)
        });
        let whole = sum_of_legs(|i| legs[i].moment.squared() * along.pairs[i]);
        let determinant = square - trace.scaled(threshold) + whole.scaled(threshold.square());
        let excess = trace - whole.times(2.0).scaled(threshold);
        let part = |i: usize| {
            let [a, b] = others(i).map(|leg| legs[leg]);
            let part = |k: usize| a.moment * b.u[k] - b.moment * a.u[k];
            (along.one[i], [part(0), part(1)])
        };
        push_smaller_eigenvalue(found, scalar, [determinant, excess], part);
    }

    /// g4 and g6 for the reciprocals of entries of `K⁻¹`. That for the rotation is `r² D²/Σ γ_i w_i²`.
    fn enclose_reciprocals(&self, legs: &[LegEnclosure; LEGS], along: &AlongLines, found: &mut Enclosures) {
        if self.is_required(PoseScalar::StiffnessXy, found) {
            self.enclose_compliant_xy(legs, along, (PoseScalar::StiffnessXy, self.compliance.in_plane), found);
        }
        if self.is_required(PoseScalar::StiffnessPhiZ, found) {
            let square = determinant(legs).squared();
            let turns = sum_of_legs(|i| along.one[i] * turn(legs, i).squared());
            found.push(
                PoseScalar::StiffnessPhiZ,
                square - turns.scaled(self.compliance.rotation),
            );
        }
    }

    /// Encloses the compliance along the line of a leg.
    pub(super) fn along_line(&self, leg: &LegEnclosure, index: usize) -> TaylorModel {
        let of_bars = self.along_bars(leg, index);
        let Some((rail, forms)) = self.rail(leg, index) else {
            return of_bars;
        };
        let across = self.frames[index].rail.enter(leg.u)[1];
        let mut of_rail = across.squared() * forms.force;
        if let Some(loads) = &leg.loads {
            let [_, _, moment] = loads.proximal;
            of_rail = of_rail + (across * moment * forms.coupling).times(2.0) + moment.squared() * forms.moment;
        }
        of_bars + of_rail.scaled(rail.in_plane)
    }

    /// Returns the rail of a leg and what a unit load does to it, if it bends.
    pub(super) fn rail(&self, leg: &LegEnclosure, index: usize) -> Option<(&RailCompliances, RailForms)> {
        let (rail, slider) = (self.compliance.rail.as_ref()?, leg.chain.slider?);
        Some((rail, rail.forms(&self.frames[index], slider)))
    }

    /// Encloses the part of the actuator and the bars.
    fn along_bars(&self, leg: &LegEnclosure, index: usize) -> TaylorModel {
        let compliance = &self.compliance;
        let platform = &compliance.platform[index];
        let chain = &leg.chain;
        let actuator = leg.transmission_square.scaled(compliance.actuator);
        let Some(loads) = &leg.loads else {
            let sum = actuator
                + chain.beam.scaled(compliance.leg_axial)
                + leg.moment.squared().scaled(platform.moment).plus(platform.base);
            return match &chain.proximal {
                Some(bar) => {
                    let [x, y] = bar.vector.map(|part| part.squared());
                    sum + x.scaled(compliance.proximal_axial) + y.scaled(compliance.proximal_bending)
                }
                None => sum,
            };
        };
        let of_bar = |[force, first, second]: [TaylorModel; 3], axial: Interval, bending: Interval| {
            let squares = first.squared() + first * second + second.squared();
            force.squared().scaled(axial) + squares.scaled(bending)
        };
        let of_leg = |load| of_bar(load, compliance.leg_axial, compliance.leg_bending);
        let sum =
            actuator + chain.beam * of_leg(loads.distal) + of_bar(loads.platform, platform.axial, platform.bending);
        match &chain.proximal {
            Some(bar) => sum + bar.length * of_leg(loads.proximal),
            None => sum,
        }
    }
}

/// Adds the forms of a limit `T` of the smaller eigenvalue of `Σ w_i v_i v_i^T`: the determinant of the matrix less `T`, and the trace less
/// `2T`. Neither is needed where the deviator proves the limit and the forms do not.
fn push_smaller_eigenvalue(
    found: &mut Enclosures,
    scalar: PoseScalar,
    [determinant, excess]: [TaylorModel; 2],
    part: impl Fn(usize) -> (TaylorModel, PlanarModel),
) {
    let is_proved = determinant.is_positive() && excess.is_positive();
    if is_proved || !exceeds_deviator(&excess, part) {
        found.push(scalar, determinant);
        found.push(scalar, excess);
    }
}

/// Whether the smaller eigenvalue of `Σ w_i v_i v_i^T` is above `T` on the whole box, where `excess` is the trace less `2T`: it is where the excess
/// is above the norm of the deviator `Σ w_i (v_x² − v_y², 2 v_x v_y)`, the difference of the eigenvalues. Where both eigenvalues are near
/// `T`, as in the centre of a symmetric manipulator, the determinant of the matrix less `T` is small of second order and decides nothing.
fn exceeds_deviator(excess: &TaylorModel, part: impl Fn(usize) -> (TaylorModel, PlanarModel)) -> bool {
    let [least, _] = excess.range();
    // Where the excess is not positive, or is not a number, the deviator proves nothing.
    if least.is_nan() || least <= 0.0 {
        return false;
    }
    let zero = TaylorModel::exactly(0.0);
    let mut deviator = [zero; 2];
    for i in 0..LEGS {
        let (weight, [x, y]) = part(i);
        deviator[0] = deviator[0] + weight * (x.squared() - y.squared());
        deviator[1] = deviator[1] + weight * (x * y).times(2.0);
    }
    let squares = deviator.map(|part| {
        let [lower, upper] = part.range();
        Interval::exactly(upper.max(-lower)).square()
    });
    let margin = Interval::exactly(least).square() - (squares[0] + squares[1]);
    deviator.iter().all(|part| !part.range()[0].is_nan()) && margin.lower() > 0.0
}
