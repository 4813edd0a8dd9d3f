//! Where the lengths of a design are, for a sketch that shows what its variables mean.

use glam::DVec2;

use kinefront_model::evaluation::Model;
use kinefront_model::mechanism::{AnyLeg, Design, DesignVariable, Leg, Manipulator};
use kinefront_model::spatial::Pose;

/// Returns the lengths of a design at a pose as lines in the plane, from their beginning to their end \[m\]; none if the legs do not
/// reach the pose. A guide on the platform begins at the platform, and the longest length of a telescopic leg at its base joint.
pub fn dimension_lines(model: &Model, design: &Design, pose: &Pose) -> Vec<(DesignVariable, [DVec2; 2])> {
    let manipulator = Manipulator::<AnyLeg>::new(design, &model.settings().legs);
    let Ok(posture) = manipulator.posture(pose) else {
        return Vec::new();
    };
    let joint = |leg: usize| pose.position + posture.arms[leg];
    // Each length is shown at another leg, so that the lines do not cover each other.
    let along = |from: DVec2, to: DVec2, length: f64| [from, from + (to - from).normalize_or_zero() * length];
    let b = posture.legs[0].chain.b;
    let is_on_platform = design.architecture().chain().name.ends_with('P');
    let [from, to] = if is_on_platform { [joint(0), b] } else { [b, joint(0)] };
    let mut lines = vec![
        (
            DesignVariable::BaseRadius,
            [DVec2::ZERO, manipulator.legs[2].frame().anchor],
        ),
        (DesignVariable::PlatformRadius, [pose.position, joint(1)]),
        (DesignVariable::LinkLength, along(from, to, design.link_length())),
    ];
    if design.architecture().has(DesignVariable::ProximalLength) {
        let anchor = manipulator.legs[0].frame().anchor;
        let length = design.value(DesignVariable::ProximalLength);
        lines.push((DesignVariable::ProximalLength, along(anchor, b, length)));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::example;
    use kinefront_model::mechanism::Architecture;

    #[test]
    fn lines_are_as_long_as_the_variables_say() {
        let model = Model::default();
        for &architecture in Architecture::ALL {
            let (design, pose) = example(&model, architecture).expect("an example");
            let lines = dimension_lines(&model, &design, &pose);
            assert!(lines.len() >= 3, "{architecture}");
            for (variable, [from, to]) in lines {
                let length = from.distance(to);
                assert!(
                    (length - design.value(variable)).abs() < 1e-12,
                    "{architecture} {variable:?}: {length}"
                );
            }
        }
        // The links of the paper's legs end at the platform joints.
        for name in ["3-PRR", "3-RRR"] {
            let architecture = name.parse().expect("an architecture");
            let (design, pose) = example(&model, architecture).expect("an example");
            let lines = dimension_lines(&model, &design, &pose);
            let end = |place: usize| lines[place].1[1];
            let radius = (end(2) - pose.position).length();
            assert!((radius - design.platform_radius()).abs() < 1e-9, "{name}: {radius}");
        }
    }
}
