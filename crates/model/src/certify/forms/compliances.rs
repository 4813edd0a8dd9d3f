//! Compliances of a design as intervals.

use super::bars::per_length;
use super::rails::RailCompliances;
use crate::certify::CertifyError;
use crate::enclosure::Interval;
use crate::evaluation::{Model, PoseScalar};
use crate::mechanism::{Design, JointKind};
use crate::spatial::LEGS;

/// Compliances of a design, as multiples of two units.
pub(super) struct Compliances {
    /// The units: of compliances along a line \[m/N\], and of bending \[rad/(N·m)\].
    pub unit: Interval,
    pub bending_unit: Interval,
    pub actuator: Interval,
    /// Axial compliance of a leg bar of length `L_b`.
    pub leg_axial: Interval,
    /// A third of its bending compliance, for moments as multiples of `L_b`.
    pub leg_bending: Interval,
    /// Compliances of a proximal bar of length `L_a` whose distal end is on the line, for the components of the bar along and across
    /// the line as multiples of `L_b`.
    pub proximal_axial: Interval,
    pub proximal_bending: Interval,
    /// Platform bars of the legs.
    pub platform: [PlatformCompliances; LEGS],
    /// `T`, as a multiple of the reciprocal of the unit; the threshold of `k_xy`.
    pub in_plane: Interval,
    /// The least stiffness with which the displacement under the force in the plane keeps its limit, likewise.
    pub yielding: Interval,
    /// `T_φ / r²`, likewise.
    pub rotation: Interval,
    /// `T_z`, as a multiple of the reciprocal of the unit of bending.
    pub vertical: Interval,
    /// Bending and torsional compliance of a leg bar of length `L_b`.
    pub leg: [Interval; 2],
    /// Rails of the base, if they bend.
    pub rail: Option<RailCompliances>,
}

/// Compliances of a platform bar, as multiples of the same units.
pub(super) struct PlatformCompliances {
    /// Axial compliance divided by `(r_i/r)²`.
    pub axial: Interval,
    /// A third of the bending compliance, for moments as multiples of `L_b`.
    pub bending: Interval,
    /// Compliance if the leg's line passes through `C_i` and `P`.
    pub base: Interval,
    /// Additional compliance per squared moment about `P` of a line through `C_i`, as a multiple of `r`.
    pub moment: Interval,
    /// Bending and torsional compliance out of the plane.
    pub vertical: [Interval; 2],
    /// `r_i / L_b`.
    pub radius: Interval,
    /// `r / r_i`.
    pub per_multiple: Interval,
}

impl Compliances {
    pub fn new(model: &Model, design: &Design) -> Result<Self, CertifyError> {
        let exactly = Interval::exactly;
        let one = exactly(1.0);
        let settings = model.settings();
        let material = &settings.material;
        let (radius, link) = (exactly(design.platform_radius()), exactly(design.link_length()));
        let proximal = exactly(design.proximal_length());
        let leg = per_length(material, &settings.sections.legs, design.leg_bar_radius());
        let platform = per_length(material, &settings.sections.platform, design.platform_bar_radius());
        let actuator = one / exactly(settings.actuators.of(design.architecture().actuator()));
        // The transmission of a revolute actuator is a lever.
        let actuator = match design.architecture().actuator() {
            JointKind::Prismatic => actuator,
            JointKind::Revolute => actuator * link.square(),
        };
        // Units near the values, so that products neither overflow nor underflow. They are exact numbers.
        let unit = exactly((actuator + link * leg[0] + radius * platform[0]).upper());
        // The bending unit belongs to deflections: a compliance times the cube of a length.
        let bend = exactly((link * leg[1]).upper().max((radius * platform[1]).upper()));
        if !(unit.lower() > 0.0 && unit.upper() < 1e60 && bend.lower() > 0.0 && bend.upper() < 1e60) {
            return Err(CertifyError::Degenerate);
        }
        let limit = |scalar: PoseScalar| exactly(settings.thresholds.get(scalar).unwrap_or(0.0));
        let arrangement = settings.legs.geometry.arrangement();
        Ok(Self {
            unit,
            bending_unit: bend,
            actuator: actuator / unit,
            leg_axial: link * leg[0] / unit,
            leg_bending: link * link.square() * leg[1] / exactly(3.0) / unit,
            proximal_axial: link.square() / proximal * leg[0] / unit,
            proximal_bending: proximal * link.square() * leg[1] / exactly(3.0) / unit,
            platform: arrangement.platform_radii.map(|multiple| {
                let multiple = exactly(multiple);
                let length = radius * multiple;
                let bending = length * radius.square() * platform[1] / exactly(3.0);
                PlatformCompliances {
                    axial: radius / multiple * platform[0] / unit,
                    bending: length * link.square() * platform[1] / exactly(3.0) / unit,
                    base: length * platform[0] / unit,
                    moment: (bending - radius / multiple * platform[0]) / unit,
                    vertical: [length * platform[1] / bend, length * platform[2] / bend],
                    radius: length / link,
                    per_multiple: one / multiple,
                }
            }),
            in_plane: limit(PoseScalar::StiffnessXy) * unit,
            yielding: exactly(settings.in_plane_force) / limit(PoseScalar::Displacement) * unit,
            rotation: limit(PoseScalar::StiffnessPhiZ) * unit / radius.square(),
            vertical: limit(PoseScalar::StiffnessZ) * bend * link.square(),
            leg: [link * leg[1] / bend, link * leg[2] / bend],
            rail: RailCompliances::new(model, design, [unit, bend]),
        })
    }
}
