//! Validation of the values of a study.

use super::{Bounds, LengthChoice, Study};
use kinefront_model::mechanism::Design;
use kinefront_model::workspace::Grid;

/// A key with an invalid value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Dotted key of the value.
    pub key: String,
    /// Message that says what is wrong and what would be right, to be read after the key.
    pub message: String,
}

impl Study {
    /// Returns the faults of the study; the list is empty for a valid study.
    pub fn faults(&self) -> Vec<Fault> {
        let mut check = Check::default();
        check.that(
            "name",
            !self.name.trim().is_empty(),
            "is empty; give the study a short name",
        );
        check.that(
            "architectures",
            !self.architectures.is_empty(),
            "is empty; name at least one, as in [\"3-PRR\"]",
        );
        let twice = self
            .architectures
            .iter()
            .enumerate()
            .any(|(i, a)| self.architectures[..i].contains(a));
        check.that("architectures", !twice, "names an architecture twice");

        check.positive("material.youngs_modulus_pa", self.material.youngs_modulus_pa);
        check.positive("material.shear_modulus_pa", self.material.shear_modulus_pa);
        check.positive("material.density_kg_per_m3", self.material.density_kg_per_m3);
        check.positive(
            "actuators.prismatic_stiffness_n_per_m",
            self.actuators.prismatic_stiffness_n_per_m,
        );
        check.positive(
            "actuators.revolute_stiffness_nm_per_rad",
            self.actuators.revolute_stiffness_nm_per_rad,
        );

        let r = &self.requirements;
        let dexterity = r.inverse_condition_min;
        check.that(
            "requirements.inverse_condition_min",
            (0.0..1.0).contains(&dexterity),
            format!("is {dexterity}; it must be in [0, 1)"),
        );
        for (key, value) in [
            ("in_plane_force_n", r.in_plane_force_n),
            ("in_plane_displacement_m", r.in_plane_displacement_m),
            ("vertical_force_n", r.vertical_force_n),
            ("vertical_displacement_m", r.vertical_displacement_m),
            ("torque_z_nm", r.torque_z_nm),
            ("rotation_z_deg", r.rotation_z_deg),
        ] {
            check.positive(&format!("requirements.{key}"), value);
        }
        for (key, value) in [
            ("k_xy_min_n_per_m", r.k_xy_min_n_per_m),
            ("k_z_min_n_per_m", r.k_z_min_n_per_m),
            ("k_phi_z_min_nm_per_rad", r.k_phi_z_min_nm_per_rad),
        ] {
            if let Some(value) = value {
                check.at_least_zero(&format!("requirements.{key}"), value);
            }
        }
        if let Some(clearance) = r.clearance_min_m {
            let valid = (0.0..=1e3).contains(&clearance);
            check.that(
                "requirements.clearance_min_m",
                valid,
                format!("is {clearance}; it must be in [0, 1000], or be omitted if members may collide"),
            );
        }

        let w = &self.workspace;
        let range = w.rotation_range_deg;
        check.that(
            "workspace.rotation_range_deg",
            (0.0..=350.0).contains(&range),
            format!("is {range}; it must be in [0, 350]"),
        );
        for centre in w.centre_m {
            check.that(
                "workspace.centre_m",
                centre.is_finite(),
                format!("contains {centre}; it must consist of two finite lengths"),
            );
        }
        if let Some(phi) = w.home_phi_deg {
            let valid = phi.abs() <= 360.0;
            check.that(
                "workspace.home_phi_deg",
                valid,
                format!("is {phi}; it must be in [-360, 360]"),
            );
        }

        let m = &self.model;
        match (m.characteristic_length, m.characteristic_length_m) {
            (LengthChoice::Fixed, Some(length)) => check.positive("model.characteristic_length_m", length),
            (LengthChoice::Fixed, None) => check.that(
                "model.characteristic_length",
                false,
                "is \"fixed\", which requires the key `characteristic_length_m`",
            ),
            (_, Some(_)) => check.that(
                "model.characteristic_length_m",
                false,
                "has no effect unless `characteristic_length = \"fixed\"`",
            ),
            (_, None) => {}
        }
        check.that(
            "model.platform_bars",
            (1..=3).contains(&m.platform_bars),
            format!("is {}; it must be 1, 2 or 3", m.platform_bars),
        );
        let shortest = m.telescopic_shortest;
        check.that(
            "model.telescopic_shortest",
            (0.0..1.0).contains(&shortest),
            format!("is {shortest}; it must be a fraction of Lb in [0, 1)"),
        );

        let b = &self.bodies;
        check.positive("bodies.slider_half_width", b.slider_half_width);
        check.positive("bodies.slider_length", b.slider_length);
        check.that(
            "bodies.slider_length",
            b.slider_length >= 2.0 * b.slider_half_width,
            format!(
                "is {}; it must be at least twice slider_half_width = {}, because sliders have round ends",
                b.slider_length, b.slider_half_width
            ),
        );
        for (key, layer) in [
            ("platform", b.layers.platform),
            ("link", b.layers.link),
            ("telescopic_leg", b.layers.telescopic_leg),
            ("crank", b.layers.crank),
            ("slider", b.layers.slider),
        ] {
            let valid = layer.abs() <= 1e3;
            check.that(
                &format!("bodies.layers.{key}"),
                valid,
                format!("is {layer}; it must be in [-1000, 1000] diameters of the thicker bar"),
            );
        }

        for (variable, key) in Bounds::keys() {
            let [lower, upper] = self.bounds.range(variable);
            let key = format!("bounds.{key}");
            let least = if variable.may_be_zero() {
                lower >= 0.0
            } else {
                lower > 0.0
            };
            if !(lower.is_finite() && upper.is_finite() && least) {
                let wanted = if variable.may_be_zero() {
                    "at least 0"
                } else {
                    "above 0"
                };
                check.that(
                    &key,
                    false,
                    format!("is [{lower}, {upper}]; both must be finite and {wanted}"),
                );
            } else {
                check.that(
                    &key,
                    lower <= upper,
                    format!("has its lower bound {lower} above its upper bound {upper}"),
                );
            }
        }
        let [smallest, _] = self.bounds.R_m;
        for (key, range) in [("bounds.r_m", self.bounds.r_m), ("bounds.Lb_m", self.bounds.Lb_m)] {
            let limit = Design::MAX_RATIO;
            check.that(
                key,
                range[1].is_nan() || smallest.is_nan() || range[1] <= limit * smallest,
                format!("has an upper bound above {limit} times the smallest R; the workspace grid scales with R"),
            );
        }

        for (name, section) in [("reference", &self.grid.reference), ("fine", &self.grid.fine)] {
            let key = |key: &str| format!("grid.{name}.{key}");
            let step = section.phi_step_deg;
            let valid = step.is_finite() && (0.01..=120.0).contains(&step);
            check.that(
                &key("phi_step_deg"),
                valid,
                format!("is {step}; it must be in [0.01, 120]"),
            );
            check.range(&key("directions"), section.directions, 3, 3600);
            check.range(&key("ray_steps"), section.ray_steps, 1, 10_000);
            check.range(&key("halvings"), section.halvings as usize, 0, 40);
            if valid && section.directions > 0 && section.ray_steps > 0 {
                let grid = Grid::try_from(section);
                if let Err(error) = grid.and_then(|grid| grid.half_window(range)) {
                    check.that(&key("phi_step_deg"), false, format!("is invalid: {error}"));
                }
            }
        }

        let o = &self.optimizer;
        check.range("optimizer.evaluations", o.evaluations, 1, 100_000_000);
        if let Some(threads) = o.threads {
            check.range("optimizer.threads", threads, 1, 1024);
        }
        check.range("optimizer.front_designs", o.front_designs, 3, 100_000);
        if let Some(seconds) = o.time_limit_s {
            check.positive("optimizer.time_limit_s", seconds);
        }
        if let Some(stagnation) = &o.stagnation {
            let most = 100_000_000;
            check.range("optimizer.stagnation.evaluations", stagnation.evaluations, 1, most);
            check.at_least_zero("optimizer.stagnation.gain", stagnation.gain);
        }
        check.range("optimizer.front_de.generation", o.front_de.generation, 2, 65_536);
        check.range("optimizer.front_de.population", o.front_de.population, 4, 65_536);
        check.range("optimizer.front_de.growth", o.front_de.growth, 1, 100_000_000);
        check.range("optimizer.front_de.most", o.front_de.most, 4, 65_536);
        check.range("optimizer.front_de.neighbours", o.front_de.neighbours, 1, 65_536);
        check.positive("optimizer.front_de.scale", o.front_de.scale);
        check.range("optimizer.moga2.population", o.moga2.population, 2, 65_536);
        check.range("optimizer.nsga2.population", o.nsga2.population, 2, 65_536);
        for (key, fraction) in [
            ("front_de.crossover", o.front_de.crossover),
            ("front_de.best", o.front_de.best),
            ("moga2.directional_crossover", o.moga2.directional_crossover),
            ("moga2.selection", o.moga2.selection),
            ("moga2.mutation", o.moga2.mutation),
            ("moga2.mutation_ratio", o.moga2.mutation_ratio),
            ("nsga2.crossover", o.nsga2.crossover),
            ("nsga2.mutation", o.nsga2.mutation.unwrap_or(0.5)),
        ] {
            let valid = (0.0..=1.0).contains(&fraction);
            check.that(
                &format!("optimizer.{key}"),
                valid,
                format!("is {fraction}; it must be in [0, 1]"),
            );
        }
        let sum = o.moga2.directional_crossover + o.moga2.selection + o.moga2.mutation;
        check.that(
            "optimizer.moga2.directional_crossover",
            sum.is_nan() || sum <= 1.0 + 1e-12,
            format!("has the sum {sum} together with selection and mutation; the sum must be at most 1"),
        );
        check.at_least_zero("optimizer.moga2.penalty", o.moga2.penalty);
        check.at_least_zero("optimizer.nsga2.crossover_index", o.nsga2.crossover_index);
        check.at_least_zero("optimizer.nsga2.mutation_index", o.nsga2.mutation_index);
        check.positive("hypervolume.reference_mass_kg", self.hypervolume.reference_mass_kg);
        for reference in &self.references {
            if let Err(error) = reference.parse(self.working_mode) {
                check.that("references", false, format!("`{}`: {error}", reference.name));
            }
            for value in [reference.mass_kg, reference.workspace_radius_m].into_iter().flatten() {
                check.at_least_zero("references", value);
            }
        }
        check.0
    }
}

#[derive(Default)]
struct Check(Vec<Fault>);

impl Check {
    fn that(&mut self, key: &str, valid: bool, message: impl Into<String>) {
        if !valid {
            self.0.push(Fault {
                key: key.to_owned(),
                message: message.into(),
            });
        }
    }

    /// Checks that a value is positive, and within limits that keep squares and quotients of such values finite.
    fn positive(&mut self, key: &str, value: f64) {
        let valid = (1e-12..=1e15).contains(&value);
        self.that(key, valid, format!("is {value}; it must be above 0 (1e-12 to 1e15)"));
    }

    fn at_least_zero(&mut self, key: &str, value: f64) {
        let valid = (0.0..=1e15).contains(&value);
        self.that(
            key,
            valid,
            format!("is {value}; it must be at least 0 (and at most 1e15)"),
        );
    }

    fn range(&mut self, key: &str, value: usize, least: usize, most: usize) {
        self.that(
            key,
            (least..=most).contains(&value),
            format!("is {value}; it must be from {least} to {most}"),
        );
    }
}
