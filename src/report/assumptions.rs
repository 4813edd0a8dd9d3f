//! What a study assumes, and how fronts and reference designs move when an assumption is read otherwise.

use super::fronts::Front;
use super::source::Source;
use super::{Fronts, ReportError};
use kinefront_model::evaluation::GridChoice;
use kinefront_model::mechanism::Architecture;
use crate::study::{LengthChoice, StiffnessChoice, Study, TelescopicBar};

/// Another reading of one assumption.
#[derive(Debug, Clone, Copy)]
pub struct Reading {
    /// Short name, as in a legend.
    pub name: &'static str,
    /// What is read otherwise, and why one might.
    pub meaning: &'static str,
    /// Whether it can change what one design is worth, and not only what is searched.
    moves_designs: bool,
    change: fn(&mut Study),
}

/// What the last readings change: nothing but chance.
const SEED: &str = "nothing but the search's seed";

/// Names of the readings in which bodies must not collide, or may.
const CLEAR: &str = "5 mm clearance";
const COLLIDING: &str = "bodies may collide";

/// Clearance that is tried for a study that asks for none \[m\].
const CLEARANCE: f64 = 5e-3;

/// The readings tried. The last change nothing but the seed: what differs there is chance.
pub const READINGS: [Reading; 15] = [
    Reading {
        name: "K_act / 10",
        meaning: "actuators ten times softer",
        moves_designs: true,
        change: |study| scale_actuators(study, 0.1),
    },
    Reading {
        name: "K_act × 10",
        meaning: "actuators ten times stiffer",
        moves_designs: true,
        change: |study| scale_actuators(study, 10.0),
    },
    Reading {
        name: "other stiffness definition",
        meaning: "stiffness from the blocks of the compliance matrix instead of those of the stiffness matrix, or the other way \
                  round: with every other direction free instead of held",
        moves_designs: true,
        change: |study| {
            study.model.stiffness_definition = match study.model.stiffness_definition {
                StiffnessChoice::Stiffness => StiffnessChoice::Compliance,
                StiffnessChoice::Compliance => StiffnessChoice::Stiffness,
            };
        },
    },
    Reading {
        name: "isotropic length",
        meaning: "the Jacobian made homogeneous by the isotropic length",
        moves_designs: true,
        change: |study| study.model.characteristic_length = LengthChoice::Isotropic,
    },
    Reading {
        name: "r ≥ 0.5 m",
        meaning: "a larger least platform, as the 2010 paper prints it, which leaves out its own design I",
        moves_designs: false,
        change: |study| study.bounds.r_m[0] = study.bounds.r_m[0].max(0.5),
    },
    Reading {
        name: "telescopic bar L_b",
        meaning: "the beam of a telescopic leg as long as the leg can get, whatever the pose",
        moves_designs: true,
        change: |study| study.model.telescopic_bar = TelescopicBar::Longest,
    },
    Reading {
        name: "φ_c = 0",
        meaning: "the home orientation fixed with the platform's triangle parallel to the base's",
        moves_designs: true,
        change: |study| study.workspace.home_phi_deg = Some(0.0),
    },
    Reading {
        name: "τ_z = 100 N·m",
        meaning: "another torque to withstand: the 2010 paper has 100 N·m in its text and 10 N·m in its inequality",
        moves_designs: true,
        change: |study| {
            // Where the threshold is set outright, no torque matters.
            if study.requirements.k_phi_z_min_nm_per_rad.is_none() {
                study.requirements.torque_z_nm = 100.0;
            }
        },
    },
    Reading {
        name: "one platform bar",
        meaning: "the mass of one of the platform's bars counted, as the 2010 paper's equation has it",
        moves_designs: true,
        change: |study| study.model.platform_bars = 1,
    },
    Reading {
        name: "G − 7 %",
        meaning: "a softer shear modulus",
        moves_designs: true,
        change: |study| study.material.shear_modulus_pa *= 0.93,
    },
    Reading {
        name: CLEAR,
        meaning: "bodies that are not joined keep 5 mm from each other, which the study does not ask",
        moves_designs: true,
        change: |study| {
            study.requirements.clearance_min_m.get_or_insert(CLEARANCE);
        },
    },
    Reading {
        name: COLLIDING,
        meaning: "nothing asked of the clearance that the study asks for",
        moves_designs: true,
        change: |study| study.requirements.clearance_min_m = None,
    },
    Reading {
        name: "seed + 1",
        meaning: SEED,
        moves_designs: false,
        change: |study| study.optimizer.seed += 1,
    },
    Reading {
        name: "seed + 2",
        meaning: SEED,
        moves_designs: false,
        change: |study| study.optimizer.seed += 2,
    },
    Reading {
        name: "seed + 3",
        meaning: SEED,
        moves_designs: false,
        change: |study| study.optimizer.seed += 3,
    },
];

/// Name of the study as it is.
const AS_STATED: &str = "the study as it is";

fn scale_actuators(study: &mut Study, factor: f64) {
    study.actuators.prismatic_stiffness_n_per_m *= factor;
    study.actuators.revolute_stiffness_nm_per_rad *= factor;
}

/// The fronts and the reference designs under one reading.
#[derive(Debug, Clone)]
pub struct Variation {
    /// The reading; `None` for the study as it is.
    pub reading: Option<Reading>,
    /// Each architecture's front; empty where there is no feasible design.
    pub alone: Vec<(Architecture, Front)>,
    /// `R_w` of each of the study's reference designs on the fine grid \[m\].
    pub references: Vec<f64>,
}

impl Variation {
    /// Short name of the reading.
    pub fn name(&self) -> &'static str {
        self.reading.map_or(AS_STATED, |reading| reading.name)
    }

    /// Whether it can change what one design is worth, and not only what is searched.
    pub fn moves_designs(&self) -> bool {
        self.reading.is_none_or(|reading| reading.moves_designs)
    }

    /// Whether it shows nothing but chance.
    pub fn is_chance(&self) -> bool {
        self.reading.is_some_and(|reading| reading.meaning == SEED)
    }

    /// The front of an architecture.
    pub fn of(&self, architecture: Architecture) -> Option<&Front> {
        let found = self.alone.iter().find(|(other, _)| *other == architecture);
        found.map(|(_, front)| front).filter(|front| !front.members.is_empty())
    }
}

/// What a clearance costs: the searches with and without one.
#[derive(Debug, Clone, Copy)]
pub struct ClearanceCost<'a> {
    /// The clearance \[m\].
    pub clearance: f64,
    /// Where bodies keep it.
    pub with: &'a Variation,
    /// Where they may collide.
    pub without: &'a Variation,
}

impl<'a> ClearanceCost<'a> {
    /// The two of the searches under other readings, where they were made.
    pub fn of(study: &Study, variations: &'a [Variation]) -> Option<Self> {
        let base = variations.iter().find(|variation| variation.reading.is_none())?;
        let named = |name: &str| variations.iter().find(|variation| variation.name() == name);
        Some(match study.requirements.clearance_min_m {
            Some(clearance) => Self {
                clearance,
                with: base,
                without: named(COLLIDING)?,
            },
            None => Self {
                clearance: CLEARANCE,
                with: named(CLEAR)?,
                without: base,
            },
        })
    }
}

/// Searches every architecture of the study anew under every reading that changes it, each alone with so many evaluations.
///
/// # Errors
/// [`ReportError`] when a search breaks off.
pub(super) fn vary(
    study: &Study,
    evaluations: usize,
    tell: &mut dyn FnMut(&str),
) -> Result<Vec<Variation>, ReportError> {
    let mut base = study.clone();
    base.optimizer.evaluations = evaluations;
    // Every search shall have as many: no time, and no standstill, ends one sooner.
    base.optimizer.time_limit_s = None;
    base.optimizer.stagnation = None;
    let readings = std::iter::once(None).chain(READINGS.into_iter().map(Some));
    let mut variations = Vec::new();
    for reading in readings {
        let mut study = base.clone();
        if let Some(reading) = reading {
            (reading.change)(&mut study);
            // A study may have it so already, or rule it out.
            if study == base || !study.faults().is_empty() {
                continue;
            }
        }
        let name = reading.map_or(AS_STATED, |reading| reading.name);
        let mut alone = Vec::new();
        for &architecture in &base.architectures {
            tell(&format!("{name}, {architecture}"));
            let mut single = study.clone();
            single.architectures = vec![architecture];
            let model = single.model();
            let source = Source::run(name, single)?;
            match Fronts::new(&[source], &model, study.optimizer.front_designs) {
                Ok(fronts) => alone.extend(fronts.alone),
                Err(ReportError::NothingFeasible) => alone.push((architecture, Front::default())),
                Err(error) => return Err(error),
            }
        }
        let model = study.model();
        let references = study
            .references
            .iter()
            .filter_map(|reference| reference.parse(study.working_mode).ok())
            .map(|design| Ok(model.evaluate(&design, GridChoice::Fine)?.workspace_radius))
            .collect::<Result<_, ReportError>>()?;
        variations.push(Variation {
            reading,
            alone,
            references,
        });
    }
    Ok(variations)
}
