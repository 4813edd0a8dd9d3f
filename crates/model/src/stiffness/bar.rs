//! Compliance of a cantilever bar (docs/model.md, sections 4.1 and 4.7).

use nalgebra::Matrix6;

use crate::mechanism::CrossSection;

/// Isotropic material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// `E`: Young's modulus \[Pa\].
    pub youngs_modulus: f64,
    /// `G`: shear modulus \[Pa\].
    pub shear_modulus: f64,
    /// `ν`: density \[kg/m³\].
    pub density: f64,
    /// `f_y`: yield strength \[Pa\], if it is known.
    pub yield_strength: Option<f64>,
}

impl Material {
    /// Steel of the paper; `G` is not given there and is set to 80 GPa (docs/model.md, section 11).
    pub const STEEL: Material = Material {
        youngs_modulus: 210e9,
        shear_modulus: 80e9,
        density: 7850.0,
        yield_strength: None,
    };
}

/// Compliance constants of a bar of some cross-section; together with a length they determine the bar's compliance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BarCompliance {
    /// Axial compliance per length, `1/(EA)` \[1/N\].
    pub axial: f64,
    /// Bending compliance per length, `1/(E I_y)` = `1/(E I_z)`; for a solid round bar `I_y = I_z = πρ⁴/4` \[1/(N·m²)\].
    pub bending: f64,
    /// Torsional compliance per length, `1/(G I_x)` with the torsion constant `I_x`, for a round bar `I_y + I_z` \[1/(N·m²)\].
    pub torsion: f64,
}

impl BarCompliance {
    /// Computes the constants for a bar of the outer radius `radius` \[m\]. Returns `None` if the bar is too thin (its radius is 0, its
    /// second moment of area underflows, or a constant exceeds 1e60) or too thick (a constant is below 1e-60).
    pub fn new(material: &Material, section: &CrossSection, radius: f64) -> Option<Self> {
        let (area, inertia) = (section.area(radius), section.inertia(radius));
        let compliance = Self {
            axial: 1.0 / (material.youngs_modulus * area),
            bending: 1.0 / (material.youngs_modulus * inertia),
            torsion: 1.0 / (material.shear_modulus * section.torsion_constant(radius)),
        };
        // Later computations form squares and products of these values, which must not overflow or underflow.
        let usable = |value: f64| value > 1e-60 && value < 1e60;
        (inertia > 0.0 && usable(compliance.axial) && usable(compliance.bending) && usable(compliance.torsion))
            .then_some(compliance)
    }

    /// Returns the 6×6 compliance matrix \[m/N, rad/N, rad/(N·m)\] at the tip of a cantilever of `length` \[m\], in the
    /// bar's axes (x along the bar), linear first.
    pub fn matrix(&self, length: f64) -> Matrix6<f64> {
        let l = length;
        let mut c = Matrix6::zeros();
        c[(0, 0)] = l * self.axial;
        c[(1, 1)] = l * l * l / 3.0 * self.bending;
        c[(2, 2)] = c[(1, 1)];
        c[(3, 3)] = l * self.torsion;
        c[(4, 4)] = l * self.bending;
        c[(5, 5)] = c[(4, 4)];
        c[(1, 5)] = l * l / 2.0 * self.bending;
        c[(5, 1)] = c[(1, 5)];
        c[(2, 4)] = -c[(1, 5)];
        c[(4, 2)] = c[(2, 4)];
        c
    }
}
