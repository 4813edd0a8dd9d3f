//! The parts that a design is made of: what has to be ordered and cut (docs/model.md, section 5.1).

use super::Model;
use crate::dynamics::Drive;
use crate::mechanism::{Architecture, CrossSection, Design, JointKind, JointMasses, MemberKind};
use crate::spatial::LEGS;

/// Equal parts of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// What they are, for example `link`.
    pub name: &'static str,
    /// The bar that it is cut from; `None` for a joint or a motor.
    pub bar: Option<CutBar>,
    /// The drive that is ordered, if it is a motor that a catalogue has.
    pub drive: Option<String>,
    /// How many there are.
    pub pieces: usize,
    /// Mass of one \[kg\]; that of a platform bar as it counts in the mass of the design.
    pub mass: f64,
    /// Whether it counts in the mass of the design: what stands on the base does not, but for rails.
    pub counts: bool,
}

/// A bar that is cut to length.
#[derive(Debug, Clone, PartialEq)]
pub struct CutBar {
    /// Cross-section.
    pub section: CrossSection,
    /// Outer radius, or half of the outer width \[m\].
    pub radius: f64,
    /// Length \[m\].
    pub length: f64,
}

impl CutBar {
    /// Returns the name in the catalogue, if the bar is one of its bars.
    pub fn catalogue_name(&self) -> Option<&str> {
        self.section.catalogue_name(self.radius)
    }
}

impl Part {
    /// Returns the mass of all pieces \[kg\].
    pub fn total_mass(&self) -> f64 {
        self.pieces as f64 * self.mass
    }
}

/// Adds a part, or its pieces to equal ones.
fn add(parts: &mut Vec<Part>, part: Part) {
    let is_equal = |other: &&mut Part| other.name == part.name && other.bar == part.bar;
    match parts.iter_mut().find(is_equal) {
        Some(equal) => equal.pieces += part.pieces,
        None => parts.push(part),
    }
}

impl Model {
    /// Returns the bars and rails of a design, from the base to the platform, then its joints and motors if the study gives them a
    /// mass. The masses of those that count sum to the mass of the design. The motors are the drive at a place of the catalogue, if one is
    /// selected.
    pub fn parts(&self, design: &Design, drive: Option<usize>) -> Vec<Part> {
        let settings = self.settings();
        let chain = design.architecture().chain();
        let mut parts = Vec::new();
        if let Some(rails) = self.rails_of(design) {
            for leg in 0..LEGS {
                let [lower, upper] = settings.legs.geometry.rail_travel(leg, design.base_radius());
                let rail = self.cut("rail", (&rails.section, rails.radius), upper - lower);
                add(&mut parts, rail);
            }
        }
        let of_leg = |name: &'static str, length: f64| Part {
            pieces: LEGS,
            ..self.cut(name, (&settings.sections.legs, design.leg_bar_radius()), length)
        };
        if chain.has_proximal_bar {
            let name = match chain.proximal {
                Some(MemberKind::TurningGuide) => "turning guide",
                _ => "crank",
            };
            parts.push(of_leg(name, design.proximal_length()));
        }
        let length = design.link_length();
        match chain.distal {
            MemberKind::TelescopicLeg => {
                let tube = settings.legs.tube_length(length);
                parts.extend([of_leg("tube", tube), of_leg("rod", length - tube)]);
            }
            MemberKind::Guide => parts.push(of_leg("guide", length)),
            _ => parts.push(of_leg("link", length)),
        }
        for leg in 0..LEGS {
            let length = settings.legs.geometry.platform_length(leg, design.platform_radius());
            let bar = (&settings.sections.platform, design.platform_bar_radius());
            let mut part = self.cut("platform bar", bar, length);
            part.mass *= f64::from(settings.platform_bars) / LEGS as f64;
            add(&mut parts, part);
        }
        let drive = drive.and_then(|place| settings.drive_catalogue.get(place));
        self.add_joints(&mut parts, design.architecture(), drive);
        parts
    }

    fn add_joints(&self, parts: &mut Vec<Part>, architecture: Architecture, drive: Option<&Drive>) {
        let stated = self.settings().joints;
        let joints = JointMasses {
            motor: drive.map_or(stated.motor, |drive| drive.mass),
            ..stated
        };
        let of_leg = joints.of_leg(architecture);
        for part in of_leg.filter(|part| part.mass > 0.0) {
            let name = match (part.is_motor, part.kind, part.moves) {
                (true, _, true) => "motor",
                (true, _, false) => "motor on the base",
                (false, JointKind::Prismatic, _) => "carriage",
                (false, JointKind::Revolute, true) => "revolute joint",
                (false, JointKind::Revolute, false) => "revolute joint on the base",
            };
            let pieces = Part {
                name,
                bar: None,
                drive: drive.filter(|_| part.is_motor).map(|drive| drive.name.clone()),
                pieces: LEGS,
                mass: part.mass,
                counts: part.moves,
            };
            add(parts, pieces);
        }
    }

    fn cut(&self, name: &'static str, (section, radius): (&CrossSection, f64), length: f64) -> Part {
        Part {
            name,
            bar: Some(CutBar {
                section: section.clone(),
                radius,
                length,
            }),
            drive: None,
            pieces: 1,
            mass: self.bar_mass(section, radius, length),
            counts: true,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::evaluation::{Model, ModelSettings};
    use crate::mechanism::{Architecture, CrossSection, Design, JointMasses, WorkingMode};
    use crate::stiffness::{RailSettings, RailSupports};

    #[test]
    fn the_parts_sum_to_the_mass() {
        let mut settings = ModelSettings {
            platform_bars: 2,
            joints: JointMasses {
                revolute: 0.3,
                carriage: 0.7,
                motor: 2.0,
            },
            rails: Some(RailSettings {
                section: CrossSection::Round,
                radius: 0.02,
                supports: RailSupports::Pinned,
            }),
            ..ModelSettings::default()
        };
        let mut arrangement = *settings.legs.geometry.arrangement();
        arrangement.platform_radii = [1.0, 1.5, 0.7];
        arrangement.base_radii = [1.0, 1.0, 1.2];
        settings.legs.geometry = arrangement.into();
        settings.legs.telescopic_shortest = 0.3;
        let general = Model::new(settings).expect("the grids fit");
        for &architecture in Architecture::ALL {
            let values = [1.0, 0.3, 1.4, 0.02, 0.03];
            let design = Design::new(architecture, WorkingMode::ALL_PLUS, values).expect("a design");
            for (model, joints) in [(&Model::default(), 0), (&general, 12)] {
                let parts = model.parts(&design, None);
                let counted = parts.iter().filter(|part| part.counts);
                let total: f64 = counted.map(|part| part.total_mass()).sum();
                let mass = model.mass(&design);
                assert!(
                    (total - mass).abs() < 1e-12 * mass,
                    "{architecture}: {total} kg of {mass} kg"
                );
                let pieces = |of_bars: bool| {
                    let found = parts.iter().filter(|part| part.bar.is_some() == of_bars);
                    found.map(|part| part.pieces).sum::<usize>()
                };
                assert!(pieces(true) >= 6, "{architecture}: {parts:?}");
                assert_eq!(pieces(false), joints, "{architecture}: {parts:?}");
            }
        }
        // The motor of a crank stands, that of an elbow moves.
        for (name, moves) in [("3-RRR", false), ("3-R_RR", true)] {
            let design: Design = format!("{name} R=1 r=0.3 Lb=1 rj=0.02 rp=0.02")
                .parse()
                .expect("a design");
            let parts = general.parts(&design, None);
            let motor = parts.iter().find(|part| part.name.starts_with("motor"));
            assert_eq!(motor.expect("a motor").counts, moves, "{name}");
        }
    }
}
