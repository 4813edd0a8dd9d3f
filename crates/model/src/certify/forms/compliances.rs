//! Compliances of a design as intervals.

use crate::certify::CertifyError;
use crate::enclosure::Interval;
use crate::evaluation::Model;
use crate::mechanism::{Actuator, Design, Leg};
use crate::stiffness::{CrossSection, Material};

/// Compliances of a design, as multiples of two units.
pub(super) struct Compliances {
    pub actuator: Interval,
    pub distal_axial: Interval,
    pub proximal_axial: Interval,
    pub proximal_bending: Interval,
    pub platform_base: Interval,
    pub platform_moment: Interval,
    /// `T`, as a multiple of the reciprocal of the unit; the threshold of `k_xy`.
    pub in_plane: Interval,
    /// `T_φ / r²`, likewise.
    pub rotation: Interval,
    /// `T_z`, as a multiple of the reciprocal of the unit of bending.
    pub vertical: Interval,
    /// Bending and torsional compliance of a leg bar of length `L_b`.
    pub leg: [Interval; 2],
    /// Bending and torsional compliance of the platform bar.
    pub platform: [Interval; 2],
    /// `r / L_b`.
    pub radius: Interval,
}

impl Compliances {
    pub fn new<L: Leg>(model: &Model, design: &Design) -> Result<Self, CertifyError> {
        let exactly = Interval::exactly;
        let one = exactly(1.0);
        let material = &model.material;
        let (radius, link) = (exactly(design.platform_radius), exactly(design.link_length));
        let sections = &model.sections;
        let leg = per_length(material, &sections.legs, design.leg_bar_radius);
        let platform = per_length(material, &sections.platform, design.platform_bar_radius);
        let actuator = one / exactly(model.actuators.of(L::ACTUATOR));
        // The transmission of a revolute actuator is a lever.
        let actuator = match L::ACTUATOR {
            Actuator::Prismatic => actuator,
            Actuator::Revolute => actuator * link.square(),
        };
        // Units near the values, so that products neither overflow nor underflow. They are exact numbers.
        let unit = exactly((actuator + link * leg[0] + radius * platform[0]).upper);
        // The bending unit belongs to deflections: a compliance times the cube of a length.
        let bend = exactly((link * leg[1]).upper.max((radius * platform[1]).upper));
        if !(unit.lower > 0.0 && unit.upper < 1e60 && bend.lower > 0.0 && bend.upper < 1e60) {
            return Err(CertifyError::Degenerate);
        }
        let thresholds = &model.thresholds;
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
        })
    }
}

/// Returns the axial, bending and torsional compliance per length of a bar, with the wall ratio as the double that the model uses.
fn per_length(material: &Material, section: &CrossSection, radius: f64) -> [Interval; 3] {
    let exactly = Interval::exactly;
    let (one, squared) = (exactly(1.0), exactly(radius).square());
    let [e, g] = [material.youngs_modulus, material.shear_modulus].map(exactly);
    let wall = exactly(section.wall_ratio(radius));
    let inner = one - wall;
    let filled = wall * (one + inner);
    let (outline, gyration, torsion) = if section.is_square() {
        let middle = one + inner;
        let torsion = wall * middle * middle.square() * squared.square();
        (exactly(4.0), exactly(3.0), Some(torsion))
    } else {
        (Interval::PI, exactly(4.0), None)
    };
    let (mut area, mut inertia) = (outline * squared, outline * squared * squared / gyration);
    // Each operation rounds outwards, so that a solid bar does without those that do not change it.
    if section.wall_ratio(radius) < 1.0 {
        area = area * filled;
        inertia = inertia * filled * (one + inner.square());
    }
    let torsion = torsion.unwrap_or(exactly(2.0) * inertia);
    [one / (e * area), one / (e * inertia), one / (g * torsion)]
}
