//! Members of a design at a pose: their positions, their masses, and their contributions to the compliance.

use glam::DVec3;

use super::{Model, Unreachable};
use crate::clearance::MemberId;
use crate::kinematics::Jacobian;
use crate::mechanism::{AnyLeg, Design, Leg, Manipulator, MemberKind};
use crate::spatial::{LEGS, Pose};
use crate::stiffness::Contribution;

/// A member at a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MemberReport {
    /// The member.
    pub member: MemberId,
    /// Proximal end of the axis in the base frame \[m\]. For a telescopic leg it is the inner end of the rod, if that
    /// protrudes behind the base joint; for a slider it is the centre of an end face.
    pub from: DVec3,
    /// Distal end of the axis \[m\].
    pub to: DVec3,
    /// Radius, or half the width of a slider \[m\].
    pub radius: f64,
    /// Length of the bar between its joints at the pose, or length of the slider \[m\].
    pub length: f64,
    /// Mass \[kg\]; that of a slider is the mass of its rail.
    pub mass: f64,
    /// Fraction of the compliance at the pose that the member contributes; `None` if the platform is infinitely
    /// compliant.
    pub contribution: Option<Contribution>,
    /// Fraction that the actuator driving the member contributes, if an actuator drives it.
    pub actuator: Option<Contribution>,
}

impl Model {
    /// Returns the members of `design` at `pose`: the proximal members of all legs, if they have one, then the distal
    /// members, then the platform bars.
    ///
    /// # Errors
    /// Returns the leg that does not reach the pose, and why.
    pub fn members(&self, design: &Design, pose: &Pose) -> Result<Vec<MemberReport>, Unreachable> {
        let manipulator = Manipulator::<AnyLeg>::new(design, &self.settings().legs);
        let posture = manipulator
            .posture(pose)
            .map_err(|(leg, shortfall)| Unreachable { leg, shortfall })?;
        let contributions = self
            .stiffness(design)
            .and_then(|stiffness| stiffness.contributions(&posture, &Jacobian::new(&posture)));
        let chain = design.architecture().chain();
        let of_leg = |length: f64| self.bar_mass(&self.settings().sections.legs, design.leg_bar_radius(), length);
        let of_platform = self.platform_mass(design) / LEGS as f64;
        let capsules = self.bodies_of(design).capsules(&manipulator, pose.position, &posture);
        let members = capsules.into_iter().map(|capsule| {
            let kind = capsule.member.kind;
            let leg = capsule.member.leg;
            let of_leg_shares = contributions.as_ref().map(|contributions| &contributions[leg]);
            let ends = match kind {
                // The axis of a capsule ends before the end faces of the block.
                MemberKind::Slider => {
                    let axis = manipulator.legs[leg].frame().rail;
                    let middle = 0.5 * (capsule.from + capsule.to);
                    let half = axis.extend(0.0) * self.settings().bodies.slider_half_length(design);
                    [middle - half, middle + half]
                }
                _ => [capsule.from, capsule.to],
            };
            let driven = if design.architecture().driven() == 0 {
                chain.proximal.unwrap_or(chain.distal)
            } else {
                chain.distal
            };
            MemberReport {
                member: capsule.member,
                from: ends[0],
                to: ends[1],
                radius: capsule.radius,
                length: match kind {
                    MemberKind::Slider => 2.0 * self.settings().bodies.slider_half_length(design),
                    MemberKind::TelescopicLeg => posture.legs[leg].chain.distal.offset,
                    _ => capsule.from.distance(capsule.to),
                },
                mass: match kind {
                    MemberKind::Slider => self.rail_mass(design, leg),
                    MemberKind::PlatformBar => of_platform,
                    kind if kind == chain.distal => of_leg(design.link_length()),
                    _ => of_leg(design.proximal_length()),
                },
                contribution: of_leg_shares.map(|contributions| match kind {
                    MemberKind::PlatformBar => contributions.platform,
                    kind if kind == chain.distal => contributions.distal,
                    _ => contributions.proximal,
                }),
                actuator: of_leg_shares
                    .filter(|_| kind == driven)
                    .map(|contributions| contributions.actuator),
            }
        });
        Ok(members.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::GridChoice;
    use crate::mechanism::CrossSection;

    #[test]
    fn members_have_the_dimensions_and_masses_of_the_design() {
        let model = Model::default();
        for text in [
            "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056",
            "3-RPR R=2.0 r=0.5 Lb=3.0 rj=0.03 rp=0.02",
            "3-RRR R=2.0 r=0.6 Lb=1.6 rj=0.05 rp=0.04",
        ] {
            let design: Design = text.parse().expect("a design");
            let home = model.evaluate(&design, GridChoice::Reference).home.expect("a home");
            let members = model.members(&design, &home).expect("reachable");
            let total: f64 = members.iter().map(|report| report.mass).sum();
            assert!((total - model.mass(&design)).abs() < 1e-9 * total, "{text}: {total} kg");
            for report in members.iter().filter(|report| report.member.kind != MemberKind::Slider) {
                let (radius, length) = match report.member.kind {
                    MemberKind::PlatformBar => (design.platform_bar_radius(), Some(design.platform_radius())),
                    // The length of a telescopic leg depends on the pose; its mass is that of a bar of the design.
                    MemberKind::TelescopicLeg => (design.leg_bar_radius(), None),
                    _ => (design.leg_bar_radius(), Some(design.link_length())),
                };
                assert_eq!(report.radius, radius, "{text}: {report:?}");
                let of_bar = length.unwrap_or(design.link_length());
                assert!(
                    (report.mass - model.bar_mass(&CrossSection::Round, radius, of_bar)).abs() < 1e-9 * total,
                    "{text}: {report:?}"
                );
                assert!(
                    length.is_none_or(|length| (report.length - length).abs() < 1e-12),
                    "{text}: {report:?}"
                );
                // Each member lies in its layer, parallel to the plane of motion.
                let kind = report.member.kind;
                let same = members.iter().filter(|other| other.member.kind == kind);
                assert!(same.clone().count() == LEGS && same.clone().all(|other| other.from.z == report.to.z));
            }
        }
    }
}
