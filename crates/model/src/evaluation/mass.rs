//! Masses of a design and of its parts (docs/model.md, section 5.1).

use super::Model;
use crate::mechanism::{Architecture, CrossSection, Design};
use crate::spatial::LEGS;
use crate::stiffness::RailSettings;

impl Model {
    /// Returns the objective `f1` \[kg\], the mass in motion: `ν·π·(n·r_j²·L_b + 3·r_p²·r)` for solid round bars, where 3 is the
    /// default number of platform bars. Rails with a cross-section add their mass, although they do not move, and joints and motors
    /// that move add theirs.
    pub fn mass(&self, design: &Design) -> f64 {
        self.legs_mass(design) + self.platform_mass(design)
    }

    /// Returns the mass of all legs \[kg\]: their bars, their rails if these have a cross-section, and what moves of their joints and
    /// motors.
    pub fn legs_mass(&self, design: &Design) -> f64 {
        let bars = self.leg_bars_mass(design);
        let legs = (0..LEGS).fold(bars, |sum, leg| sum + self.rail_mass(design, leg));
        legs + LEGS as f64 * self.leg_joints_mass(design.architecture())
    }

    /// Returns the mass of the joints and the motor of a leg that move \[kg\].
    fn leg_joints_mass(&self, architecture: Architecture) -> f64 {
        let parts = self.settings().joints.of_leg(architecture);
        parts.filter(|part| part.moves).fold(0.0, |sum, part| sum + part.mass)
    }

    /// Returns the mass of the bars of all legs \[kg\].
    pub fn leg_bars_mass(&self, design: &Design) -> f64 {
        let section = &self.settings().sections.legs;
        LEGS as f64 * self.bar_mass(section, design.leg_bar_radius(), design.leg_bars_length())
    }

    /// Returns the rails of a design, if its chain has rails and they have a cross-section.
    pub fn rails_of(&self, design: &Design) -> Option<&RailSettings> {
        let has_rails = design.architecture().chain().is_on_rails();
        self.settings().rails.as_ref().filter(|_| has_rails)
    }

    /// Returns the mass of the rail of a leg (0, 1, 2) over the travel of its slider \[kg\]; 0 if the chain has none, or if rails have
    /// no cross-section.
    pub fn rail_mass(&self, design: &Design, leg: usize) -> f64 {
        let Some(rails) = self.rails_of(design) else {
            return 0.0;
        };
        let [lower, upper] = self.settings().legs.geometry.rail_travel(leg, design.base_radius());
        self.bar_mass(&rails.section, rails.radius, upper - lower)
    }

    /// Returns the mass of the platform bars \[kg\].
    pub fn platform_mass(&self, design: &Design) -> f64 {
        let bar = self.bar_mass(
            &self.settings().sections.platform,
            design.platform_bar_radius(),
            design.platform_radius(),
        );
        f64::from(self.settings().platform_bars) * self.settings().legs.geometry.mean_platform_radius() * bar
    }

    /// Returns the mass of one bar \[kg\].
    pub fn bar_mass(&self, section: &CrossSection, radius: f64, length: f64) -> f64 {
        section.mass_per_length(self.settings().material.density, radius) * length
    }
}
