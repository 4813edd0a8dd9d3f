//! The material of the bars, and the materials that come with the program (docs/interfaces.md).

use super::declare::{Check, Initial, section};
use kinefront_model::stiffness::Material;

/// A material that comes with the program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BuiltinMaterial {
    /// Name in study files.
    pub name: &'static str,
    /// Its figures.
    pub material: Material,
    /// Where they come from.
    pub source: &'static str,
}

const fn builtin(
    name: &'static str,
    [e, g, strength]: [f64; 3],
    density: f64,
    source: &'static str,
) -> BuiltinMaterial {
    BuiltinMaterial {
        name,
        material: Material {
            youngs_modulus: e,
            shear_modulus: g,
            density,
            yield_strength: Some(strength),
        },
        source,
    }
}

/// All materials that come with the program.
pub const MATERIALS: [BuiltinMaterial; 5] = [
    builtin(
        "S235",
        [210e9, 81e9, 235e6],
        7850.0,
        "EN 1993-1-1:2005, table 3.1 and section 3.2.6: structural steel S235; the product standards hold the strength for walls of at most \
         16 mm (EN 10025-2, EN 10210-1, EN 10219-1); density: EN 1991-1-1, table A.4",
    ),
    builtin(
        "S355",
        [210e9, 81e9, 355e6],
        7850.0,
        "EN 1993-1-1:2005, table 3.1 and section 3.2.6: structural steel S355; the product standards hold the strength for walls of at most \
         16 mm (EN 10025-2, EN 10210-1, EN 10219-1); density: EN 1991-1-1, table A.4",
    ),
    builtin(
        "EN AW-6060 T6",
        [70e9, 27e9, 140e6],
        2700.0,
        "EN 1999-1-1:2007, table 3.2b and section 3.2.5: extruded profiles, tubes and bars of EN AW-6060 T6, walls of at most 15 mm",
    ),
    builtin(
        "EN AW-6082 T6",
        [70e9, 27e9, 250e6],
        2700.0,
        "EN 1999-1-1:2007, table 3.2b and section 3.2.5: extruded profiles and tubes of EN AW-6082 T6, walls of at most 5 mm (260 MPa from 5 to 15 mm)",
    ),
    builtin(
        "CFRP quasi-isotropic",
        [69.7e9, 26.9e9, 280e6],
        1600.0,
        "Tsai and Hahn, Introduction to Composite Materials (1980): quasi-isotropic laminate of T300/5208 prepreg, by laminate theory; \
         the strength is no yield strength but that at a strain of 0.4 %, about where the first ply fails in tension, without holes or \
         impact; tubes of ordinary fibre content have 45 to 55 GPa",
    ),
];

const NAMES: [&str; MATERIALS.len()] = {
    let mut names = [""; MATERIALS.len()];
    let mut place = 0;
    while place < names.len() {
        names[place] = MATERIALS[place].name;
        place += 1;
    }
    names
};

section! {
    /// Material of every bar.
    pub struct MaterialSection in "material" {
        /// Young's modulus `E`.
        youngs_modulus_pa: f64 = Material::STEEL.youngs_modulus, Check::Positive;
        /// Shear modulus `G`.
        shear_modulus_pa: f64 = Material::STEEL.shear_modulus, Check::Positive;
        /// Density `ν`.
        density_kg_per_m3: f64 = Material::STEEL.density, Check::Positive;
        optional {
            /// Built-in material, which supplies the values that the section does not state.
            name: String, Check::Choice(&NAMES), Initial::AsText;
            /// Yield strength `f_y`, from which the safety factor is computed.
            yield_strength_pa: f64, Check::Positive, Initial::Number(235e6);
        }
    }
}

impl MaterialSection {
    /// Returns the material that the section names, if it names one that comes with the program.
    fn named(&self) -> Option<&'static BuiltinMaterial> {
        let name = self.name.as_deref()?;
        MATERIALS.iter().find(|builtin| builtin.name == name)
    }

    /// Takes the values of the material that the section names for all keys that are not stated.
    pub fn take_named_values(&mut self, is_stated: impl Fn(&str) -> bool) {
        let Some(builtin) = self.named() else {
            return;
        };
        let material = &builtin.material;
        for (key, place, value) in [
            (
                "youngs_modulus_pa",
                &mut self.youngs_modulus_pa,
                material.youngs_modulus,
            ),
            ("shear_modulus_pa", &mut self.shear_modulus_pa, material.shear_modulus),
            ("density_kg_per_m3", &mut self.density_kg_per_m3, material.density),
        ] {
            if !is_stated(key) {
                *place = value;
            }
        }
        if !is_stated("yield_strength_pa") {
            self.yield_strength_pa = material.yield_strength;
        }
    }
}

impl From<&MaterialSection> for Material {
    fn from(section: &MaterialSection) -> Self {
        Self {
            youngs_modulus: section.youngs_modulus_pa,
            shear_modulus: section.shear_modulus_pa,
            density: section.density_kg_per_m3,
            yield_strength: section.yield_strength_pa,
        }
    }
}
