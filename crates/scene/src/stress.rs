//! The stresses of the bars at a pose, as values of their solids.

use kinefront_model::clearance::MemberId;
use kinefront_model::evaluation::Model;
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Pose;

use crate::{Scene, Solid};

/// Stresses of the bars of a design at a pose.
#[derive(Debug, Clone, PartialEq)]
pub struct BarStresses {
    stresses: Vec<(MemberId, f64)>,
    /// The largest of them.
    pub legend: StressLegend,
}

/// What the colours of the bars stand for: the darkest is no stress, the brightest the largest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StressLegend {
    /// Largest equivalent stress \[Pa\].
    pub largest: f64,
    /// The bar that has it.
    pub member: MemberId,
    /// Part of the yield strength that it is, if the material has one.
    pub of_yield: Option<f64>,
}

impl BarStresses {
    /// Returns the stresses under the loads of the study, or under a single wrench on the platform, forces first; `None` where the design
    /// does not reach the pose, at a singularity, and where nothing is loaded.
    pub fn new(model: &Model, design: &Design, pose: &Pose, wrench: Option<[f64; 6]>) -> Option<Self> {
        let report = model.posed(design).strength_at(pose, wrench).ok()??;
        let stresses: Vec<(MemberId, f64)> = report
            .members
            .iter()
            .map(|member| (member.member, member.stress))
            .collect();
        let &(member, largest) = stresses.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let is_loaded = largest > 0.0 && largest.is_finite();
        is_loaded.then(|| Self {
            stresses,
            legend: StressLegend {
                largest,
                member,
                of_yield: model.settings().material.yield_strength.map(|limit| largest / limit),
            },
        })
    }

    /// Returns the stress of a bar \[Pa\]; `None` for what is no bar.
    pub fn of(&self, solid: &Solid) -> Option<f64> {
        let found = self.stresses.iter().find(|(member, _)| solid.shows(member));
        found.map(|(_, stress)| *stress)
    }
}

impl Scene {
    /// Gives the bars their stresses as values.
    pub fn set_values(&mut self, stresses: &BarStresses) {
        for solid in &mut self.solids {
            solid.value = stresses.of(solid).map(|stress| stress / stresses.legend.largest);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Part, manipulator};

    #[test]
    fn each_bar_has_the_value_of_its_stress_and_nothing_else_has_one() {
        let model = Model::default();
        for text in [
            "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056",
            "3-RRR R=2.0 r=0.6 Lb=1.6 rj=0.05 rp=0.04",
            "3-RPR R=2.0 r=0.5 Lb=2.4 rj=0.03 rp=0.03",
        ] {
            let design: Design = text.parse().expect("a design");
            let pose = Pose::new(0.05, -0.1, 0.1);
            let mut scene = manipulator(&model, &design, &pose).expect("the pose is reached");
            let stresses = BarStresses::new(&model, &design, &pose, None).expect("the study has a load");
            scene.set_values(&stresses);
            let report = model
                .posed(&design)
                .strength_at(&pose, None)
                .expect("a pose")
                .expect("a report");
            let mut bars = 0;
            for solid in &scene.solids {
                let is_bar = matches!(
                    solid.part,
                    Part::Crank | Part::Link | Part::Tube | Part::Rod | Part::PlatformBar
                );
                assert_eq!(solid.value.is_some(), is_bar, "{design}: {solid:?}");
                bars += usize::from(is_bar);
            }
            assert!(bars >= 6, "{design}: {bars}");
            assert_eq!(stresses.legend.largest, report.stress);
            let largest = scene.solids.iter().filter(|solid| solid.value == Some(1.0));
            assert!(largest.count() >= 1, "{design}");
            // The loads of the study have the worst of its wrenches.
            let wrench = |force: f64| Some([0.6 * force, 0.8 * force, 0.0, 0.0, 0.0, 0.0]);
            let under = |model: &Model, force: f64| {
                let stresses = BarStresses::new(model, &design, &pose, wrench(force));
                stresses.expect("a load").legend.largest
            };
            assert!(under(&model, 100.0) <= stresses.legend.largest, "{design}");
            // Bars without weight have twice the stress under twice the wrench, and none without a wrench.
            let mut settings = model.settings().clone();
            settings.loads.gravity = [0.0; 3];
            let weightless = Model::new(settings).expect("a model");
            let ratio = under(&weightless, 100.0) / under(&weightless, 50.0);
            assert!((ratio - 2.0).abs() < 1e-9, "{design}: {ratio}");
            assert_eq!(BarStresses::new(&weightless, &design, &pose, wrench(0.0)), None);
        }
    }
}
