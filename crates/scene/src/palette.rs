//! The colours of architectures, parts, constraints, clearances and series in every view, as red, green and blue.

use std::sync::LazyLock;

use crate::Part;
use kinefront_model::evaluation::{Constraint, PoseScalar};
use kinefront_model::mechanism::Architecture;

/// Contour at a field's threshold, and its mark in the legend.
pub const THRESHOLD: [u8; 3] = [255, 70, 200];

/// Bars that bend in a vibration.
pub const BENT: [u8; 3] = [240, 150, 60];

/// Colours of the series of a chart, which can be told apart on a light and on a dark ground.
pub const SERIES: [[u8; 3]; 10] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [230, 159, 0],
    [86, 180, 233],
    [120, 94, 240],
    [154, 99, 36],
    [100, 143, 20],
    [70, 90, 110],
];

/// Returns the colour of an architecture: a hue for each chain, and a shade for each actuated joint. The hues can be distinguished with
/// any type of colour vision (Okabe and Ito).
pub fn architecture(architecture: Architecture) -> [u8; 3] {
    const HUES: [[u8; 3]; 7] = [
        [86, 180, 233],
        [230, 159, 0],
        [0, 190, 140],
        [204, 121, 167],
        [240, 228, 66],
        [60, 125, 205],
        [224, 102, 40],
    ];
    // A plot asks for the colour of every design.
    static COLORS: LazyLock<Vec<[u8; 3]>> = LazyLock::new(|| {
        let mut chains: Vec<&str> = Vec::new();
        let color = |&architecture: &Architecture| {
            let own = architecture.chain_name();
            let chain = chains.iter().position(|&name| name == own).unwrap_or_else(|| {
                chains.push(own);
                chains.len() - 1
            });
            let of_chain = Architecture::ALL.iter().filter(|other| other.chain_name() == own);
            let shade = of_chain.take_while(|&&other| other != architecture).count();
            HUES[chain % HUES.len()].map(|part| match shade {
                0 => part,
                // Lighter, then darker.
                1 => part + (255 - part) / 2,
                _ => (u16::from(part) * 11 / 20) as u8,
            })
        };
        Architecture::ALL.iter().map(color).collect()
    });
    COLORS[architecture as usize]
}

/// Returns the colour of a part: orange for actuated parts, darker grey for fixed parts, steel grey for other moving
/// parts, blue for the bars of the platform.
pub fn part(part: Part) -> [u8; 3] {
    match part {
        Part::Base => [120, 126, 138],
        Part::Rail => [150, 156, 168],
        Part::Stroke => [255, 170, 70],
        Part::Slider | Part::ActuatedJoint => [255, 128, 20],
        Part::Tube => [92, 104, 124],
        Part::Rod | Part::Link | Part::Guide => [190, 200, 214],
        Part::Crank => [150, 164, 186],
        Part::PlatformBar => [90, 150, 235],
        Part::PassiveJoint | Part::Carriage => [238, 240, 244],
        Part::AxisX => [230, 70, 70],
        Part::AxisY => [80, 200, 90],
        Part::Workspace => [255, 255, 255],
        Part::Obstacle => [214, 106, 96],
        Part::Room => [120, 126, 138],
    }
}

/// Returns the colour of the nearest pair of members: red if it is too near, otherwise green.
pub fn nearest(too_near: bool) -> [u8; 3] {
    if too_near { [255, 60, 60] } else { [90, 225, 130] }
}

/// Returns the colour of the limit of a scalar: that of its constraint, if it has an id of its own.
pub fn limited(scalar: PoseScalar) -> [u8; 3] {
    match scalar {
        PoseScalar::Displacement => [238, 119, 170],
        PoseScalar::Transmission => [0, 153, 136],
        _ => constraint(Constraint::of_scalar(scalar).unwrap_or(Constraint::Assembly)),
    }
}

/// Returns the colour of a constraint. The colours can be distinguished with any type of colour vision (Tol's bright scheme).
pub fn constraint(constraint: Constraint) -> [u8; 3] {
    match constraint {
        Constraint::Assembly => [187, 187, 187],
        Constraint::Reach => [102, 204, 238],
        Constraint::Dexterity => [68, 119, 170],
        Constraint::StiffnessXy => [238, 102, 119],
        Constraint::StiffnessZ => [204, 187, 68],
        Constraint::StiffnessPhiZ => [34, 136, 51],
        Constraint::DeterminantSign => [170, 51, 119],
        Constraint::Clearance => [238, 153, 51],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_architecture_has_a_colour_of_its_own() {
        let mut colors: Vec<[u8; 3]> = Architecture::ALL.iter().map(|&each| architecture(each)).collect();
        colors.sort_unstable();
        colors.dedup();
        assert_eq!(colors.len(), Architecture::ALL.len());
    }
}
