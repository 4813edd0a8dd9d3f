//! The constraints as functions that are positive exactly where they hold strictly (docs/model.md, section 13.3).
//!
//! They are cleared of roots and quotients where this keeps the enclosures narrow, and are written apart from those that the
//! evaluation uses.

use super::CertifyError;
use crate::enclosure::{Interval, LegEnclosure, PoseEnclosure, TaylorModel};
use crate::evaluation::{Constraint, Model};
use crate::kinematics::CharacteristicLength;
use crate::mechanism::{Design, Leg};
use crate::spatial::{LEGS, Pose};
use crate::stiffness::StiffnessDefinition;

/// Largest number of constraints that are evaluated at a pose: three per leg, and those of the manipulator.
const MOST: usize = 3 * LEGS + 6;

/// The constraints over a box of poses.
#[derive(Debug, Clone)]
pub(super) struct Enclosures {
    values: [(Constraint, TaylorModel); MOST],
    count: usize,
    /// Whether every constraint could be evaluated: where a leg may not reach, the others have no value.
    pub is_complete: bool,
}

impl Enclosures {
    fn new() -> Self {
        Self {
            values: [(Constraint::Reach, TaylorModel::exactly(1.0)); MOST],
            count: 0,
            is_complete: true,
        }
    }

    fn push(&mut self, constraint: Constraint, value: TaylorModel) {
        self.values[self.count] = (constraint, value);
        self.count += 1;
    }

    /// The constraints with their values.
    pub fn iter(&self) -> impl Iterator<Item = &(Constraint, TaylorModel)> {
        self.values[..self.count].iter()
    }
}

/// The constraints of one design, prepared for many boxes.
pub(super) struct Forms<'a, L> {
    /// Sign of `det A` at the home pose.
    sign: f64,
    design: &'a Design,
    model: &'a Model,
    compliance: Compliances,
    leg: std::marker::PhantomData<L>,
}

/// Compliances of a design, as multiples of two units.
struct Compliances {
    actuator: Interval,
    distal_axial: Interval,
    proximal_axial: Interval,
    proximal_bending: Interval,
    platform_base: Interval,
    platform_moment: Interval,
    /// `T`, as a multiple of the reciprocal of the unit; the threshold of `k_xy`.
    in_plane: Interval,
    /// `T_φ / r²`, likewise.
    rotation: Interval,
    /// `T_z`, as a multiple of the reciprocal of the unit of bending.
    vertical: Interval,
    /// Bending and torsional compliance of a leg bar of length `L_b`.
    leg: [Interval; 2],
    /// Bending and torsional compliance of the platform bar.
    platform: [Interval; 2],
    /// `r / L_b`.
    radius: Interval,
    /// `r / ℓ`.
    to_length: Interval,
}

impl Compliances {
    fn new<L: Leg>(model: &Model, design: &Design) -> Result<Self, CertifyError> {
        let exactly = Interval::exactly;
        let one = exactly(1.0);
        let material = &model.material;
        let (radius, link) = (exactly(design.platform_radius), exactly(design.link_length));
        let section = |bar: f64| {
            let area = Interval::PI * exactly(bar).square();
            let inertia = area * exactly(bar).square() / exactly(4.0);
            let [e, g] = [material.youngs_modulus, material.shear_modulus].map(exactly);
            // Axial, bending and torsional compliance per length.
            [
                one / (e * area),
                one / (e * inertia),
                one / (g * exactly(2.0) * inertia),
            ]
        };
        let [leg, platform] = [design.leg_bar_radius, design.platform_bar_radius].map(section);
        let actuator = one / exactly(model.actuators.of(L::ACTUATOR));
        // The transmission of a revolute actuator is a lever.
        let actuator = match L::ACTUATOR {
            crate::mechanism::Actuator::Prismatic => actuator,
            crate::mechanism::Actuator::Revolute => actuator * link.square(),
        };
        // Units near the values, so that products neither overflow nor underflow. They are exact numbers.
        let unit = exactly((actuator + link * leg[0] + radius * platform[0]).upper);
        // The bending unit belongs to deflections: a compliance times the cube of a length.
        let bend = exactly((link * leg[1]).upper.max((radius * platform[1]).upper));
        if !(unit.lower > 0.0 && unit.upper < 1e60 && bend.lower > 0.0 && bend.upper < 1e60) {
            return Err(CertifyError::Degenerate);
        }
        let thresholds = &model.thresholds;
        let length = match model.characteristic_length {
            CharacteristicLength::PlatformRadius => radius,
            CharacteristicLength::Fixed(length) => exactly(length),
            CharacteristicLength::Isotropic => return Err(CertifyError::NoForm("the isotropic characteristic length")),
        };
        Ok(Self {
            actuator: actuator / unit,
            distal_axial: link * leg[0] / unit,
            proximal_axial: link * leg[0] / unit,
            proximal_bending: link * link.square() * leg[1] / exactly(3.0) / unit,
            platform_base: radius * platform[0] / unit,
            platform_moment: (radius * radius.square() * platform[1] / exactly(3.0) - radius * platform[0]) / unit,
            in_plane: exactly(thresholds.k_xy) * unit,
            rotation: exactly(thresholds.k_phi_z) * unit / radius.square(),
            vertical: exactly(thresholds.k_z) * bend * link.square(),
            leg: [link * leg[1] / bend, link * leg[2] / bend],
            platform: [radius * platform[1] / bend, radius * platform[2] / bend],
            radius: radius / link,
            to_length: radius / length,
        })
    }
}

impl<'a, L: Leg> Forms<'a, L> {
    /// Prepares the forms of a design; the sign of `det A` counts as positive.
    pub fn new(model: &'a Model, design: &'a Design) -> Result<Self, CertifyError> {
        if model.thresholds.clearance.is_some() {
            return Err(CertifyError::NoForm("a required clearance (g7)"));
        }
        if model.stiffness_definition == StiffnessDefinition::Compliance {
            return Err(CertifyError::NoForm("the stiffness definition `compliance`"));
        }
        Ok(Self {
            sign: 1.0,
            design,
            model,
            compliance: Compliances::new::<L>(model, design)?,
            leg: std::marker::PhantomData,
        })
    }

    /// Takes the sign of `det A` from a pose; if it cannot be told there, it stays positive.
    pub fn with_sign_at(mut self, pose: &Pose) -> Self {
        if let Ok(found) = self.model.pose(self.design, pose)
            && found.determinant < 0.0
        {
            self.sign = -1.0;
        }
        self
    }

    /// Encloses the constraints over a box of poses.
    pub fn enclose(&self, pose: &PoseEnclosure) -> Enclosures {
        let mut found = Enclosures::new();
        let legs: [LegEnclosure; LEGS] = [0, 1, 2].map(|index| L::enclose(self.design, &self.model.legs, index, pose));
        for reach in legs.iter().flat_map(|leg| leg.reach) {
            found.push(Constraint::Reach, reach);
            found.is_complete &= reach.range()[0] > 0.0;
        }
        if found.is_complete {
            self.enclose_dexterity(&legs, &mut found);
            self.enclose_stiffness(&legs, &mut found);
            let has_values = found.iter().all(|(_, value)| !value.range()[0].is_nan());
            found.is_complete = has_values;
        }
        found
    }

    /// g3, `9 D² − t² Σ β_i² (μ_j² + μ_k² − 2 μ_j μ_k C_i + w_i²) Σ (1 + μ_i²)/β_i²`, where `t` is the threshold. If that is 0,
    /// `det A` takes its place, with the sign that it has at the home pose.
    fn enclose_dexterity(&self, legs: &[LegEnclosure; LEGS], found: &mut Enclosures) {
        let one = TaylorModel::exactly(1.0);
        let moments = legs.map(|leg| leg.moment.scaled(self.compliance.to_length));
        let squares = moments.map(|moment| moment.squared());
        let mut determinant = TaylorModel::exactly(0.0);
        let (mut forward, mut inverse) = (TaylorModel::exactly(0.0), TaylorModel::exactly(0.0));
        for i in 0..LEGS {
            let (j, k) = ((i + 1) % LEGS, (i + 2) % LEGS);
            let turn = crate::enclosure::cross(legs[j].u, legs[k].u);
            let cosine = crate::enclosure::dot(legs[j].u, legs[k].u);
            determinant = determinant + moments[i] * turn;
            let mixed = (moments[j] * moments[k] * cosine).times(2.0);
            let row = squares[j] + squares[k] - mixed + turn.squared();
            forward = forward + legs[i].transmission_square * row;
            inverse = inverse + (one + squares[i]) * legs[i].transmission_square.reciprocal();
        }
        let threshold = self.model.thresholds.inverse_condition;
        if threshold > 0.0 {
            let scaled = (forward * inverse).scaled(Interval::exactly(threshold).square());
            found.push(Constraint::Dexterity, determinant.squared().times(9.0) - scaled);
        } else {
            found.push(Constraint::DeterminantSign, determinant.times(self.sign));
        }
    }

    /// g4, g5 and g6. With `γ_i` the compliances along the lines and `T` the threshold, `k_xy > T` where
    /// `(λ₁ − T)(λ₂ − T) > 0` and `λ₁ + λ₂ > 2T`.
    fn enclose_stiffness(&self, legs: &[LegEnclosure; LEGS], found: &mut Enclosures) {
        let compliance = &self.compliance;
        let along = legs.map(|leg| self.along_line(&leg));
        let pairs = [along[1] * along[2], along[2] * along[0], along[0] * along[1]];
        let product = along[0] * pairs[0];
        let sum = pairs[0] + pairs[1] + pairs[2];
        let thresholds = &self.model.thresholds;
        if thresholds.k_xy > 0.0 {
            let mut turns = TaylorModel::exactly(0.0);
            for i in 0..LEGS {
                let turn = crate::enclosure::cross(legs[(i + 1) % LEGS].u, legs[(i + 2) % LEGS].u);
                turns = turns + along[i] * turn.squared();
            }
            let threshold = compliance.in_plane;
            let determinant = turns - sum.scaled(threshold) + product.scaled(threshold.square());
            found.push(Constraint::StiffnessXy, determinant);
            found.push(Constraint::StiffnessXy, sum - product.times(2.0).scaled(threshold));
        }
        if thresholds.k_phi_z > 0.0 {
            let mut moments = TaylorModel::exactly(0.0);
            for i in 0..LEGS {
                moments = moments + legs[i].moment.squared() * pairs[i];
            }
            found.push(Constraint::StiffnessPhiZ, moments - product.scaled(compliance.rotation));
        }
        if thresholds.k_z > 0.0 {
            let mut stiffness = TaylorModel::constant(-compliance.vertical);
            for leg in legs {
                let [minor, determinant] = self.vertical(leg);
                stiffness = stiffness + minor * determinant.reciprocal();
            }
            found.push(Constraint::StiffnessZ, stiffness);
        }
    }

    /// Encloses the compliance along the line of a leg.
    fn along_line(&self, leg: &LegEnclosure) -> TaylorModel {
        let compliance = &self.compliance;
        let sum = leg.transmission_square.scaled(compliance.actuator)
            + leg.distal.scaled(compliance.distal_axial)
            + leg
                .moment
                .squared()
                .scaled(compliance.platform_moment)
                .plus(compliance.platform_base);
        match leg.proximal {
            Some([x, y]) => {
                sum + x.squared().scaled(compliance.proximal_axial) + y.squared().scaled(compliance.proximal_bending)
            }
            None => sum,
        }
    }

    /// Encloses `det S_φφ` and `det S` of a leg out of the plane, at `C_i` in axes along `u_i`, with lengths in units of `L_b`
    /// (docs/model.md, section 4.4).
    fn vertical(&self, leg: &LegEnclosure) -> [TaylorModel; 2] {
        let compliance = &self.compliance;
        let ([b1, t1], [b2, t2], radius) = (compliance.leg, compliance.platform, compliance.radius);
        let third = Interval::exactly(1.0) / Interval::exactly(3.0);
        let half = Interval::exactly(0.5);
        let constant = TaylorModel::constant;
        // Direction of the platform bar, from C to P, in the axes of the distal bar.
        let (cosine, sine) = (-leg.along, leg.moment);
        let length = leg.distal;
        let (bend, twist) = (length.scaled(b1), length.scaled(t1));
        let lift = (bend * length.squared())
            .scaled(third)
            .plus(b2 * radius.square() * third);
        let p = (bend * length).times(0.5);
        let q = constant(half * b2 * radius);
        let square = cosine.squared();
        let (bend2, twist2) = (constant(b2), constant(t2));
        match leg.proximal {
            None => {
                let minor = [(twist + bend2) * (bend + twist2), (twist - bend) * (bend2 - twist2)];
                let (pp, qq) = (p.squared(), q.squared());
                let tilt = [
                    pp * (twist + bend2) + qq * (twist2 + bend),
                    (p * q).times(2.0) * (twist + twist2),
                    pp * (twist2 - bend2) + qq * (twist - bend),
                ];
                [
                    minor[0] + square * minor[1],
                    lift * minor[0] - tilt[0] + cosine * tilt[1] + square * (lift * minor[1] - tilt[2]),
                ]
            }
            Some([x, y]) => {
                let middle = x.plus(half);
                let twelfth = Interval::exactly(1.0) / Interval::exactly(12.0);
                let (xx_bar, yy_bar, xy_bar) = (x.squared(), y.squared(), x * y);
                let (long, wide, both) = (square, sine.squared(), cosine * sine);
                let lift = lift + length.squared() * (bend * middle.squared().plus(twelfth) + twist * yy_bar);
                let tilt_x = length * y * ((bend - twist) * x + bend.times(0.5)) - q * sine;
                let tilt_y = q * cosine - p - length * (twist * yy_bar + bend * middle * x);
                let xx = twist * xx_bar + bend * yy_bar + twist + twist2 * long + bend2 * wide;
                let xy = (twist - bend) * xy_bar + (twist2 - bend2) * both;
                let yy = twist * yy_bar + bend * xx_bar + bend + twist2 * wide + bend2 * long;
                let minor = xx * yy - xy.squared();
                let tilt = tilt_x.squared() * yy - (tilt_x * tilt_y * xy).times(2.0) + tilt_y.squared() * xx;
                [minor, lift * minor - tilt]
            }
        }
    }
}
