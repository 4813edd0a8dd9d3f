//! Contributions of the actuators and bars to the compliance at `P` (docs/model.md, section 4.6).
//!
//! A wrench stores elastic energy in every actuator and bar. The contribution of an actuator or bar to the compliance
//! along the wrench is its fraction of that energy. If the compliance of the actuator or bar grows by a small relative
//! amount, the compliance at `P` grows by that amount times the contribution.

use nalgebra::{Matrix3, Vector3};

use super::StiffnessModel;
use super::blocks::symmetric;
use crate::kinematics::Jacobian;
use crate::mechanism::Posture;
use crate::spatial::LEGS;

/// Contribution of an actuator or bar to three compliances of the platform, as fractions of each compliance. The
/// contributions of all actuators and bars sum to 1.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Contribution {
    /// Fraction of the compliance to a force in the plane, averaged over the directions of the force.
    pub in_plane: f64,
    /// Fraction of the compliance to a force along z.
    pub vertical: f64,
    /// Fraction of the compliance to a torque about z.
    pub rotation: f64,
}

/// Contributions of the actuator and bars of one leg.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LegContributions {
    /// Contribution of the actuator.
    pub actuator: Contribution,
    /// Contribution of the proximal bar, or of the rail; zero if there is neither.
    pub proximal: Contribution,
    /// Contribution of the distal bar.
    pub distal: Contribution,
    /// Contribution of the platform bar.
    pub platform: Contribution,
}

impl StiffnessModel {
    /// Computes the contributions of all actuators and bars at a posture; returns `None` if the stiffness is singular
    /// or a compliance is not finite and positive.
    pub fn contributions(&self, posture: &Posture, jacobian: &Jacobian) -> Option<[LegContributions; LEGS]> {
        let mut contributions = [LegContributions::default(); LEGS];
        self.add_in_plane(&mut contributions, posture, jacobian)?;
        self.add_vertical(&mut contributions, posture)?;
        Some(contributions)
    }

    fn add_in_plane(
        &self,
        contributions: &mut [LegContributions; LEGS],
        posture: &Posture,
        jacobian: &Jacobian,
    ) -> Option<()> {
        let compliance = symmetric(&self.in_plane(posture, jacobian)).try_inverse()?;
        let (in_plane, rotation) = (compliance[(0, 0)] + compliance[(1, 1)], compliance[(2, 2)]);
        for (index, contributions) in contributions.iter_mut().enumerate() {
            let parts = self.line_compliances(&posture.legs[index]);
            let line = Vector3::new(jacobian.ux[index], jacobian.uy[index], jacobian.moment[index]);
            // Components: force along the leg's line for a unit force along x, a unit force along y, and a unit torque.
            let forces = (compliance * line) / parts.iter().sum::<f64>();
            let of = |part: f64| Contribution {
                in_plane: part * (forces.x * forces.x + forces.y * forces.y) / in_plane,
                rotation: part * forces.z * forces.z / rotation,
                vertical: 0.0,
            };
            let [actuator, distal, platform, proximal] = parts.map(of);
            *contributions = LegContributions {
                actuator,
                proximal,
                distal,
                platform,
            };
        }
        finite(&[in_plane, rotation])
    }

    fn add_vertical(&self, contributions: &mut [LegContributions; LEGS], posture: &Posture) -> Option<()> {
        let mut stiffness = [Matrix3::zeros(); LEGS];
        let mut parts = [[Matrix3::zeros(); 3]; LEGS];
        for index in 0..LEGS {
            let mut compliances = [[0.0; 6]; 3];
            for (s, bar) in compliances.iter_mut().zip(self.bars(&posture.legs[index])) {
                if let Some(bar) = bar {
                    bar.add_to(s);
                }
            }
            if let Some(rail) = self.loaded_rail(&posture.legs[index]) {
                compliances[2] = [0.0; 6];
                rail.add_to(&mut compliances[2]);
            }
            parts[index] = compliances.map(|s| symmetric(&s));
            stiffness[index] = parts[index].iter().sum::<Matrix3<f64>>().try_inverse()?;
        }
        let compliance = stiffness.iter().sum::<Matrix3<f64>>().try_inverse()?;
        let displacement: Vector3<f64> = compliance.column(0).into();
        for (index, contributions) in contributions.iter_mut().enumerate() {
            let wrench = stiffness[index] * displacement;
            let [platform, distal, proximal] = parts[index].map(|part| wrench.dot(&(part * wrench)) / displacement.x);
            contributions.platform.vertical = platform;
            contributions.distal.vertical = distal;
            contributions.proximal.vertical = proximal;
        }
        finite(&[displacement.x])
    }
}

/// Returns `Some(())` if all compliances are finite and positive, so that fractions of them are defined.
fn finite(compliances: &[f64]) -> Option<()> {
    compliances
        .iter()
        .all(|compliance| compliance.is_finite() && *compliance > 0.0)
        .then_some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::Model;
    use crate::mechanism::{AnyLeg, Design};
    use crate::spatial::Pose;
    use crate::stiffness::BarCompliance;

    /// Returns the in-plane (twice the mean over the directions), vertical and rotational compliance.
    fn compliances(model: &StiffnessModel, posture: &Posture) -> [f64; 3] {
        let stiffness = model.stiffness(posture, &Jacobian::new(posture));
        let in_plane = symmetric(&stiffness.in_plane).try_inverse().expect("a stiffness");
        let vertical = symmetric(&stiffness.out_of_plane).try_inverse().expect("a stiffness");
        [in_plane[(0, 0)] + in_plane[(1, 1)], vertical[(0, 0)], in_plane[(2, 2)]]
    }

    fn check(design: &Design) {
        let text = design.to_string();
        let checker = Model::default().checker::<AnyLeg>(design);
        let turns = (0..36).map(|k| Pose::new(0.02, -0.03, 0.1 + 0.17 * f64::from(k)));
        let posture = turns
            .into_iter()
            .find_map(|pose| checker.manipulator.posture(&pose).ok())
            .expect("reachable");
        let model = checker.stiffness.expect("stiff");
        let contributions = model.contributions(&posture, &Jacobian::new(&posture)).expect("stiff");
        let values = |contribution: Contribution| [contribution.in_plane, contribution.vertical, contribution.rotation];
        let sum = |of: &dyn Fn(&LegContributions) -> [f64; 3]| {
            contributions
                .iter()
                .map(of)
                .fold([0.0; 3], |sum, each| [0, 1, 2].map(|k| sum[k] + each[k]))
        };
        let actuators = sum(&|leg| values(leg.actuator));
        let bars = sum(&|leg| [0, 1, 2].map(|k| values(leg.proximal)[k] + values(leg.distal)[k]));
        let platform = sum(&|leg| values(leg.platform));
        for k in 0..3 {
            assert!((actuators[k] + bars[k] + platform[k] - 1.0).abs() < 1e-9, "{text}");
        }
        // A contribution equals the relative growth of the compliance divided by that of its actuators or bars.
        let base = compliances(&model, &posture);
        let softer = |bar: BarCompliance, by: f64| BarCompliance {
            axial: bar.axial * by,
            bending: bar.bending * by,
            torsion: bar.torsion * by,
        };
        let step = 1e-6;
        let mut changed = [model; 3];
        changed[0].actuator *= 1.0 + step;
        changed[1].leg_bar = softer(model.leg_bar, 1.0 + step);
        changed[2].platform_bar = softer(model.platform_bar, 1.0 + step);
        for (changed, wanted) in changed.iter().zip([actuators, bars, platform]) {
            let after = compliances(changed, &posture);
            for k in 0..3 {
                let growth = (after[k] / base[k] - 1.0) / step;
                assert!(
                    (growth - wanted[k]).abs() < 1e-4,
                    "{text}: {growth} instead of {}",
                    wanted[k]
                );
            }
        }
    }

    #[test]
    fn shares_are_what_the_compliance_grows_by() {
        for text in [
            "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056",
            "3-RPR R=1.5636 r=0.1006 Lb=2.2135 rj=0.017 rp=0.021",
            "3-RRR R=0.7 r=0.31 Lb=0.66 rj=0.03 rp=0.02",
            "3-RR_R R=0.7 r=0.31 Lb=0.66 rj=0.03 rp=0.02 La=0.5",
            "3-_RRP R=0.7 r=0.31 Lb=0.8 rj=0.03 rp=0.02",
            "3-R_PP R=0.7 r=0.31 Lb=1.5 rj=0.03 rp=0.02",
            "3-_PRP R=0.7 r=0.31 Lb=1.5 rj=0.03 rp=0.02",
        ] {
            let design: Design = text.parse().expect("a design");
            check(&design);
        }
    }
}
