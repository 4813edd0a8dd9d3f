//! Cross-sections of bars (docs/model.md, section 4.7).
//!
//! A design states only the outer radius of its bars. Shape and wall come from the study, so that the outer radius determines
//! area, second moment of area and torsion constant.

use std::f64::consts::PI;
use std::sync::Arc;

/// Thickness of the wall of a hollow bar.
#[derive(Debug, Clone, PartialEq)]
pub enum Wall {
    /// Fraction of the outer radius, in (0, 1]; 1 is a solid bar.
    Ratio(f64),
    /// Thickness \[m\]; a bar whose outer radius is no larger is solid.
    Thickness(f64),
    /// Wall of the entry of a catalogue whose outer radius is nearest.
    Listed(Arc<Catalogue>),
}

/// An entry of a catalogue of bars.
#[derive(Debug, Clone, PartialEq)]
pub struct CatalogueEntry {
    /// Name, as it is ordered.
    pub name: String,
    /// Outer radius, or half of the outer width \[m\].
    pub radius: f64,
    /// Thickness of the wall \[m\].
    pub wall: f64,
    /// Mass per length \[kg/m\], if the catalogue states it; otherwise it follows from the section and the density.
    pub mass_per_length: Option<f64>,
}

/// Bars that can be ordered, in the order of their outer radii, which differ.
#[derive(Debug, Clone, PartialEq)]
pub struct Catalogue(Vec<CatalogueEntry>);

/// Why entries do not form a catalogue.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CatalogueError {
    /// There is no entry.
    #[error("it has no entry; it must have at least one bar")]
    Empty,
    /// A number is not positive, or the wall is thicker than the outer radius.
    #[error(
        "`{0}` has an invalid outer size, wall or mass: all must be above 0, and the wall at most half the outer size"
    )]
    NoBar(String),
    /// Two entries have one outer radius, which is all that a design states.
    #[error(
        "`{0}` and `{1}` have the same outer size; a design states only the outer radius, so one of them must be removed"
    )]
    Twice(String, String),
}

impl Catalogue {
    /// Sorts the entries by their outer radii.
    ///
    /// # Errors
    /// [`CatalogueError`].
    pub fn new(mut entries: Vec<CatalogueEntry>) -> Result<Self, CatalogueError> {
        if entries.is_empty() {
            return Err(CatalogueError::Empty);
        }
        let is_length = |length: f64| length > 0.0 && length.is_finite();
        for entry in &entries {
            let is_bar = is_length(entry.radius)
                && is_length(entry.wall)
                && entry.wall <= entry.radius
                && entry.mass_per_length.is_none_or(is_length);
            if !is_bar {
                return Err(CatalogueError::NoBar(entry.name.clone()));
            }
        }
        entries.sort_by(|a, b| a.radius.total_cmp(&b.radius));
        if let Some(pair) = entries.windows(2).find(|pair| pair[0].radius == pair[1].radius) {
            return Err(CatalogueError::Twice(pair[0].name.clone(), pair[1].name.clone()));
        }
        Ok(Self(entries))
    }

    /// The entries, in the order of their outer radii.
    pub fn entries(&self) -> &[CatalogueEntry] {
        &self.0
    }

    /// Returns the entry whose outer radius is nearest; of two equally near ones, the thinner.
    pub fn nearest(&self, radius: f64) -> &CatalogueEntry {
        let after = self.0.partition_point(|entry| entry.radius < radius);
        let (thinner, thicker) = (after.checked_sub(1), self.0.get(after));
        match (thinner.map(|place| &self.0[place]), thicker) {
            (Some(thinner), Some(thicker)) if thicker.radius - radius < radius - thinner.radius => thicker,
            (Some(thinner), _) => thinner,
            (None, _) => &self.0[0],
        }
    }
}

/// Relative difference up to which a radius is that of an entry of a catalogue.
const SAME_RADIUS: f64 = 1e-6;

/// Cross-section of a bar whose outer radius is a design variable.
///
/// ```
/// use kinefront_model::mechanism::{CrossSection, Wall};
///
/// let tube = CrossSection::Tube(Wall::Thickness(0.002));
/// assert!((tube.area(0.01) - std::f64::consts::PI * (0.01f64.powi(2) - 0.008f64.powi(2))).abs() < 1e-18);
/// assert_eq!(CrossSection::Tube(Wall::Ratio(1.0)).area(0.01), CrossSection::Round.area(0.01));
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub enum CrossSection {
    /// Solid circle, as in the paper.
    #[default]
    Round,
    /// Circular tube.
    Tube(Wall),
    /// Square tube; the outer radius is half of the outer width.
    SquareTube(Wall),
}

/// Cross-sections of the bars of a manipulator.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CrossSections {
    /// Cross-section of the bars of the legs.
    pub legs: CrossSection,
    /// Cross-section of the bars of the platform.
    pub platform: CrossSection,
}

impl CrossSection {
    /// Returns whether the section is square rather than round.
    pub fn is_square(&self) -> bool {
        matches!(self, CrossSection::SquareTube(_))
    }

    /// Returns the wall of a hollow bar.
    fn wall(&self) -> Option<&Wall> {
        match self {
            CrossSection::Round => None,
            CrossSection::Tube(wall) | CrossSection::SquareTube(wall) => Some(wall),
        }
    }

    /// Returns the catalogue that the bars are selected from, if there is one.
    pub fn catalogue(&self) -> Option<&Catalogue> {
        match self.wall() {
            Some(Wall::Listed(catalogue)) => Some(catalogue),
            _ => None,
        }
    }

    /// Returns the name of the entry of the catalogue that has an outer radius, if there is a catalogue that has one.
    pub fn catalogue_name(&self, radius: f64) -> Option<&str> {
        let entry = self.catalogue()?.nearest(radius);
        let is_equal = (entry.radius - radius).abs() <= SAME_RADIUS * radius;
        is_equal.then_some(entry.name.as_str())
    }

    /// Returns whether all sections are similar, so that the area is in proportion to the squared outer radius.
    pub fn is_scaled_by_its_radius(&self) -> bool {
        matches!(self.wall(), None | Some(Wall::Ratio(_)))
    }

    /// Returns the thickness of the wall as a fraction of the outer radius; 1 for a solid bar.
    pub fn wall_ratio(&self, radius: f64) -> f64 {
        let of = |wall: f64| if wall < radius { wall / radius } else { 1.0 };
        match self.wall() {
            None => 1.0,
            Some(Wall::Ratio(ratio)) => ratio.min(1.0),
            Some(Wall::Thickness(wall)) => of(*wall),
            Some(Wall::Listed(catalogue)) => of(catalogue.nearest(radius).wall),
        }
    }

    /// Returns the mass per length \[kg/m\] of a bar of the given density \[kg/m³\].
    pub fn mass_per_length(&self, density: f64, radius: f64) -> f64 {
        let stated = self
            .catalogue()
            .and_then(|catalogue| catalogue.nearest(radius).mass_per_length);
        stated.unwrap_or_else(|| density * self.outline() * radius * radius * self.fill(radius))
    }

    /// Returns the inner radius, or half of the inner width, of a bar of the given outer radius \[m\]; 0 for a solid bar.
    pub fn inner_radius(&self, radius: f64) -> f64 {
        radius * (1.0 - self.wall_ratio(radius))
    }

    /// Returns the area of the outer outline divided by the squared outer radius.
    pub fn outline(&self) -> f64 {
        if self.is_square() { 4.0 } else { PI }
    }

    /// Returns the fraction of the outer outline that the material fills.
    pub fn fill(&self, radius: f64) -> f64 {
        let ratio = self.wall_ratio(radius);
        ratio * (2.0 - ratio)
    }

    /// Returns the area \[m²\].
    pub fn area(&self, radius: f64) -> f64 {
        self.outline() * radius * radius * self.fill(radius)
    }

    /// Returns the second moment of area about an axis through the centre, which is the same for all such axes \[m⁴\].
    pub fn inertia(&self, radius: f64) -> f64 {
        let inner = 1.0 - self.wall_ratio(radius);
        let area = self.area(radius);
        // The squared radius of gyration of the outer outline, per squared radius, is 1/4 for a circle and 1/3 for a square.
        let of_outline = if self.is_square() {
            area / 3.0 * radius * radius
        } else {
            0.25 * area * radius * radius
        };
        of_outline * (1.0 + inner * inner)
    }

    /// Returns the length by which the torsion constant is divided for the largest shear stress per torque \[m\]: the outer radius of a
    /// circular section. Of a square tube of width `b` and wall `t` it is `(b + t)/2`, which adds to Bredt's mean stress what the
    /// thickness of the wall does.
    pub fn torsion_radius(&self, radius: f64) -> f64 {
        if self.is_square() {
            radius * (1.0 + 0.5 * self.wall_ratio(radius))
        } else {
            radius
        }
    }

    /// Returns the torsion constant \[m⁴\]: the polar moment of a circular section, and Bredt's `t(b − t)³` of a square tube of
    /// width `b` and wall `t`. A thick square wall is stiffer than Bredt's formula says.
    pub fn torsion_constant(&self, radius: f64) -> f64 {
        if self.is_square() {
            let ratio = self.wall_ratio(radius);
            let middle = (2.0 - ratio) * radius;
            ratio * radius * (middle * middle * middle)
        } else {
            2.0 * self.inertia(radius)
        }
    }
}
