//! The cross-sections of the bars, and catalogues of bars (docs/interfaces.md).

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::catalogue::{BuiltinCatalogue, CatalogueChoice, CatalogueFault, CatalogueItem};
use kinefront_model::mechanism::{Catalogue, CatalogueEntry, CrossSection, CrossSections, Wall};

/// Shape of a cross-section.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SectionKind {
    /// Solid circle.
    #[default]
    Round,
    /// Circular tube.
    Tube,
    /// Square tube; the radius of the design is half of the outer width.
    SquareTube,
}

/// An entry of a catalogue, as in a study file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CatalogueRow {
    /// Name, as it is ordered.
    pub name: String,
    /// Outer diameter, or outer width.
    pub outer_mm: f64,
    /// Thickness of the wall.
    pub wall_mm: f64,
    /// Mass per length; if omitted, it follows from the section and the density.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kg_per_m: Option<f64>,
}

/// Cross-section of the bars of the legs or of the platform, or of the rails.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SectionChoice {
    /// Shape.
    pub kind: SectionKind,
    /// Thickness of the wall as a fraction of the outer radius.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wall_ratio: Option<f64>,
    /// Thickness of the wall.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wall_m: Option<f64>,
    /// Catalogue that the bars are selected from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub catalogue: Option<CatalogueChoice<CatalogueRow>>,
}

/// The section `[sections]` of a study.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SectionsSection {
    /// Bars of the legs.
    pub legs: SectionChoice,
    /// Bars of the platform.
    pub platform: SectionChoice,
    /// Rails of the base, if they bend.
    pub rails: SectionChoice,
}

/// All catalogues of bars that come with the program.
pub const CATALOGUES: [BuiltinCatalogue; 1] = [BuiltinCatalogue {
    name: "en-10255-medium",
    source: "EN 10255:2004, table 2: steel tubes for welding and threading, medium series (M)",
    text: include_str!("../../assets/catalogues/en-10255-medium.csv"),
}];

impl CatalogueItem for CatalogueRow {
    const COLUMNS: &'static str = "name, outer_mm, wall_mm and, if known, kg_per_m";
    const REQUIRED: &'static [&'static str] = &["name", "outer_mm", "wall_mm"];
    const OPTIONAL: &'static [&'static str] = &["kg_per_m"];
    const BUILTIN: &'static [BuiltinCatalogue] = &CATALOGUES;

    fn name(&self) -> &str {
        &self.name
    }
}

impl CatalogueChoice<CatalogueRow> {
    /// Returns the catalogue.
    ///
    /// # Errors
    /// [`CatalogueFault`].
    pub fn catalogue(&self) -> Result<Catalogue, CatalogueFault> {
        let entries = self.rows()?.into_iter().map(|row| CatalogueEntry {
            name: row.name,
            radius: 0.0005 * row.outer_mm,
            wall: 0.001 * row.wall_mm,
            mass_per_length: row.kg_per_m,
        });
        Ok(Catalogue::new(entries.collect())?)
    }
}

impl SectionChoice {
    /// Returns the cross-section, or what is wrong: a key and a message.
    ///
    /// # Errors
    /// The key of this section at fault, and a message.
    pub(crate) fn cross_section(&self) -> Result<CrossSection, (&'static str, String)> {
        let stated = [
            ("wall_ratio", self.wall_ratio.is_some()),
            ("wall_m", self.wall_m.is_some()),
            ("catalogue", self.catalogue.is_some()),
        ];
        let stated: Vec<&'static str> = stated.into_iter().filter(|(_, is)| *is).map(|(key, _)| key).collect();
        let wall = match (stated.as_slice(), self.kind) {
            ([], SectionKind::Round) => return Ok(CrossSection::Round),
            ([], _) => {
                let message = "requires the wall of the tube: state wall_ratio, wall_m or catalogue".to_owned();
                return Err(("kind", message));
            }
            ([key, ..], SectionKind::Round) => {
                let message = "has no effect on a solid bar; set kind = \"tube\" or \"square_tube\", or omit it";
                return Err((key, message.to_owned()));
            }
            ([_, second, ..], _) => {
                let message = format!("is stated together with {}; state only one of them", stated[0]);
                return Err((second, message));
            }
            _ => match (self.wall_ratio, self.wall_m, &self.catalogue) {
                (Some(ratio), ..) if ratio > 0.0 && ratio <= 1.0 => Wall::Ratio(ratio),
                (Some(ratio), ..) => {
                    return Err((
                        "wall_ratio",
                        format!("is {ratio}; it must be in (0, 1], where 1 is a solid bar"),
                    ));
                }
                (_, Some(wall), _) if wall > 1e-6 && wall < 1e3 => Wall::Thickness(wall),
                (_, Some(wall), _) => {
                    return Err((
                        "wall_m",
                        format!("is {wall}; it must be a thickness of 1e-6 m to 1e3 m"),
                    ));
                }
                (_, _, choice) => {
                    let catalogue = choice.as_ref().map(CatalogueChoice::catalogue);
                    match catalogue {
                        Some(Ok(catalogue)) => Wall::Listed(Arc::new(catalogue)),
                        Some(Err(error)) => return Err(("catalogue", error.to_string())),
                        None => return Ok(CrossSection::Round),
                    }
                }
            },
        };
        Ok(match self.kind {
            SectionKind::SquareTube => CrossSection::SquareTube(wall),
            _ => CrossSection::Tube(wall),
        })
    }
}

impl SectionsSection {
    /// Returns the cross-sections of the bars of a study without faults; one at fault is taken as solid.
    pub fn cross_sections(&self) -> CrossSections {
        CrossSections {
            legs: self.legs.cross_section().unwrap_or_default(),
            platform: self.platform.cross_section().unwrap_or_default(),
        }
    }

    /// The catalogues of the section.
    pub(crate) fn catalogues(&mut self) -> impl Iterator<Item = (&'static str, &mut CatalogueChoice<CatalogueRow>)> {
        [
            ("sections.legs.catalogue", &mut self.legs),
            ("sections.platform.catalogue", &mut self.platform),
            ("sections.rails.catalogue", &mut self.rails),
        ]
        .into_iter()
        .filter_map(|(key, choice)| Some((key, choice.catalogue.as_mut()?)))
    }
}
