//! The drives of a study, and catalogues of drives (docs/model.md, section 15.9).

use serde::{Deserialize, Serialize};

use super::catalogue::{BuiltinCatalogue, CatalogueChoice, CatalogueFault, CatalogueItem};
use super::declare::{Check, Initial, section};
use kinefront_model::dynamics::{Drive, DriveCatalogue};
use kinefront_model::mechanism::JointKind;

section! {
    /// What the drives move besides the members, and the drives that can be bought.
    pub struct DriveSection in "drives" {
        /// Mass of a slider on a rail of the base, in addition to that of its carriage in `joints`.
        slider_mass_kg: f64 = 0.0, Check::Within(0.0, 1e12, " kg");
        /// Rotor inertia, reflected to a prismatic actuator as a mass.
        prismatic_inertia_kg: f64 = 0.0, Check::Within(0.0, 1e12, " kg");
        /// Rotor inertia, reflected to a revolute actuator.
        revolute_inertia_kg_m2: f64 = 0.0, Check::Within(0.0, 1e12, " kg·m²");
        optional {
            /// Catalogue from which each design selects the lightest drive that can perform the motion, within a limit of `drive_utilization`
            /// if there is one: a built-in name, the path of a CSV file, or its rows.
            catalogue: CatalogueChoice<DriveRow>, Check::Any, Initial::Name(DRIVE_CATALOGUES[0].name);
        }
    }
}

/// Kind of the joint that a drive moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DriveKind {
    /// A sliding joint.
    Prismatic,
    /// A turning joint.
    Revolute,
}

/// An entry of a catalogue of drives, in SI units of its kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DriveRow {
    /// Name, as it is ordered.
    pub name: String,
    /// Kind of the joint that it moves.
    pub kind: DriveKind,
    /// Force \[N\] or torque \[N·m\] that it gives all the time.
    pub rated: f64,
    /// Force or torque that it gives for a short time.
    pub peak: f64,
    /// Largest speed \[m/s or rad/s\].
    pub speed: f64,
    /// Inertia of what turns in it, reflected to the joint \[kg or kg·m²\].
    pub inertia: f64,
    /// Mass.
    pub mass_kg: f64,
}

/// All catalogues of drives that come with the program.
pub const DRIVE_CATALOGUES: [BuiltinCatalogue; 1] = [BuiltinCatalogue {
    name: "generic-drives",
    source: "rounded values for common classes of linear motors, ball screws and geared servo motors, not from a particular manufacturer",
    text: include_str!("../../assets/catalogues/generic-drives.csv"),
}];

impl CatalogueItem for DriveRow {
    const COLUMNS: &'static str = "name, kind (prismatic or revolute), rated, peak, speed, inertia and mass_kg";
    const REQUIRED: &'static [&'static str] = &["name", "kind", "rated", "peak", "speed", "inertia", "mass_kg"];
    const BUILTIN: &'static [BuiltinCatalogue] = &DRIVE_CATALOGUES;

    fn name(&self) -> &str {
        &self.name
    }
}

impl DriveSection {
    /// Returns the drives of which a design selects one; none without a catalogue.
    ///
    /// # Errors
    /// [`CatalogueFault`].
    pub(crate) fn drives(&self) -> Result<DriveCatalogue, CatalogueFault> {
        let Some(choice) = &self.catalogue else {
            return Ok(DriveCatalogue::default());
        };
        let drives = choice.rows()?.into_iter().map(|row| Drive {
            name: row.name,
            kind: match row.kind {
                DriveKind::Prismatic => JointKind::Prismatic,
                DriveKind::Revolute => JointKind::Revolute,
            },
            rated: row.rated,
            peak: row.peak,
            speed: row.speed,
            inertia: row.inertia,
            mass: row.mass_kg,
        });
        Ok(DriveCatalogue::new(drives.collect())?)
    }
}
