//! Compliances of bars as intervals (docs/model.md, section 4.1).

use crate::enclosure::Interval;
use crate::mechanism::CrossSection;
use crate::stiffness::Material;

/// Returns the axial, bending and torsional compliance per length of a bar, with the wall ratio as the double that the model uses.
pub(super) fn per_length(material: &Material, section: &CrossSection, radius: f64) -> [Interval; 3] {
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
