//! What a question leaves open: what a machine needs and the study does not ask for.

use super::Study;
use kinefront_model::evaluation::PoseScalar;

impl Study {
    /// Returns what the study does not require of a machine that is to be built, each as a sentence with the key that requires it.
    pub fn open_points(&self) -> Vec<String> {
        let thresholds = self.thresholds();
        let limits = |scalar: PoseScalar| thresholds.get(scalar).is_some();
        let joints = &self.joints;
        let points = [
            (
                !limits(PoseScalar::Clearance),
                "members may collide; requirements.clearance_min_m requires a clearance",
            ),
            (
                !limits(PoseScalar::Stress) && !limits(PoseScalar::SafetyFactor),
                "nothing limits the stress; constraints.safety_factor_min does, with material.yield_strength_pa",
            ),
            (
                !limits(PoseScalar::BucklingFactor),
                "nothing limits buckling; constraints.buckling_factor_min does",
            ),
            (
                [joints.revolute_kg, joints.carriage_kg, joints.motor_kg] == [0.0; 3],
                "joints and motors have no mass; [joints] gives them one",
            ),
            (
                !self.workspace.certify,
                "nothing is proved; workspace.certify = true proves the reported designs",
            ),
        ];
        let open = points.into_iter().filter(|(is_open, _)| *is_open);
        open.map(|(_, point)| point.to_owned()).collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::Study;

    #[test]
    fn a_study_says_what_it_leaves_open() {
        let of = |text: &str| Study::parse(text, "mine.toml").expect("a study").open_points();
        let paper = of("");
        for words in ["may collide", "the stress", "buckling", "no mass"] {
            assert_eq!(
                paper.iter().filter(|point| point.contains(words)).count(),
                1,
                "{words}: {paper:?}"
            );
        }
        let complete = of(
            "[requirements]\nclearance_min_m = 0.005\n[material]\nname = \"S235\"\n[joints]\nrevolute_kg = 1.0\n\
                           [constraints]\nsafety_factor_min = { at_least = 2.0 }\nbuckling_factor_min = { at_least = 3.0 }",
        );
        assert!(complete.is_empty(), "{complete:?}");
        assert!(
            of("[workspace]\ncertify = false")
                .iter()
                .any(|point| point.contains("nothing is proved"))
        );
    }
}
