//! Sensitivity to assumptions: how fronts and reference designs change when an assumption of the study is changed.

use super::fronts::Front;
use super::source::Source;
use super::{Fronts, ReportError};
use crate::study::{DesignProblem, LengthChoice, StiffnessChoice, Study, TelescopicBar};
use kinefront_model::evaluation::GridChoice;
use kinefront_model::mechanism::Architecture;

/// An alternative to one assumption of a study.
#[derive(Debug, Clone, Copy)]
pub struct Alternative {
    /// Short name, as shown in legends and tables.
    pub name: &'static str,
    /// What the alternative changes and, where it is not obvious, why one might choose it.
    pub meaning: &'static str,
    /// Whether the alternative can change the evaluation of a design, rather than only the search.
    affects_evaluation: bool,
    change: fn(&mut Study),
}

/// Meaning of the alternatives that change only the random seed.
const SEED: &str = "only the random seed of the search";

/// Names of the alternatives in which members must keep a clearance, or may collide.
const CLEAR: &str = "5 mm clearance";
const COLLIDING: &str = "members may collide";

/// Names of the alternatives on which the paper says something.
pub(super) const LARGER_PLATFORM: &str = "r ≥ 0.5 m";
pub(super) const LARGER_TORQUE: &str = "τ_z = 100 N·m";
pub(super) const ONE_PLATFORM_BAR: &str = "one platform bar";

/// Clearance that is tried if the study requires none \[m\].
const CLEARANCE: f64 = 5e-3;

/// The alternative assumptions tried. The last ones change only the random seed: their differences are due to chance.
pub const ALTERNATIVES: [Alternative; 15] = [
    Alternative {
        name: "K_act / 10",
        meaning: "actuators ten times softer",
        affects_evaluation: true,
        change: |study| scale_actuators(study, 0.1),
    },
    Alternative {
        name: "K_act × 10",
        meaning: "actuators ten times stiffer",
        affects_evaluation: true,
        change: |study| scale_actuators(study, 10.0),
    },
    Alternative {
        name: "other stiffness definition",
        meaning: "stiffness from the blocks of the compliance matrix (all other directions free) instead of the \
                  blocks of the stiffness matrix (all other directions held), or vice versa",
        affects_evaluation: true,
        change: |study| {
            study.model.stiffness_definition = match study.model.stiffness_definition {
                StiffnessChoice::Stiffness => StiffnessChoice::Compliance,
                StiffnessChoice::Compliance => StiffnessChoice::Stiffness,
            };
        },
    },
    Alternative {
        name: "isotropic length",
        meaning: "the Jacobian normalised with the isotropic characteristic length",
        affects_evaluation: true,
        change: |study| study.model.characteristic_length = LengthChoice::Isotropic,
    },
    Alternative {
        name: LARGER_PLATFORM,
        meaning: "a lower bound of r of 0.5 m instead of the one of the study",
        affects_evaluation: false,
        change: |study| study.bounds.r_m[0] = study.bounds.r_m[0].max(0.5),
    },
    Alternative {
        name: "telescopic bar L_b",
        meaning: "the beam of a telescopic leg as long as the fully extended leg, whatever the pose",
        affects_evaluation: true,
        change: |study| study.model.telescopic_bar = TelescopicBar::Longest,
    },
    Alternative {
        name: "φ_c = 0",
        meaning: "the home orientation fixed, with the platform triangle parallel to the base triangle",
        affects_evaluation: true,
        change: |study| study.workspace.home_phi_deg = Some(0.0),
    },
    Alternative {
        name: LARGER_TORQUE,
        meaning: "a required torque about z of 100 N·m instead of the one of the study",
        affects_evaluation: true,
        change: |study| {
            // A threshold that is set explicitly does not depend on the torque.
            if study.requirements.k_phi_z_min_nm_per_rad.is_none() {
                study.requirements.torque_z_nm = 100.0;
            }
        },
    },
    Alternative {
        name: ONE_PLATFORM_BAR,
        meaning: "only one platform bar counted in the mass",
        affects_evaluation: true,
        change: |study| study.model.platform_bars = 1,
    },
    Alternative {
        name: "G − 7 %",
        meaning: "a smaller shear modulus",
        affects_evaluation: true,
        change: |study| study.material.shear_modulus_pa *= 0.93,
    },
    Alternative {
        name: CLEAR,
        meaning: "a clearance of 5 mm between members that are not joined, which the study does not require",
        affects_evaluation: true,
        change: |study| {
            study.requirements.clearance_min_m.get_or_insert(CLEARANCE);
        },
    },
    Alternative {
        name: COLLIDING,
        meaning: "no clearance required, unlike in the study",
        affects_evaluation: true,
        change: |study| study.requirements.clearance_min_m = None,
    },
    Alternative {
        name: "seed + 1",
        meaning: SEED,
        affects_evaluation: false,
        change: |study| study.optimizer.seed += 1,
    },
    Alternative {
        name: "seed + 2",
        meaning: SEED,
        affects_evaluation: false,
        change: |study| study.optimizer.seed += 2,
    },
    Alternative {
        name: "seed + 3",
        meaning: SEED,
        affects_evaluation: false,
        change: |study| study.optimizer.seed += 3,
    },
];

/// Name of the variation in which the study is unchanged.
pub(super) const AS_STATED: &str = "study as given";

fn scale_actuators(study: &mut Study, factor: f64) {
    study.actuators.prismatic_stiffness_n_per_m *= factor;
    study.actuators.revolute_stiffness_nm_per_rad *= factor;
}

/// The fronts and the reference designs under one alternative assumption.
#[derive(Debug, Clone)]
pub struct Variation {
    /// The alternative assumption; `None` for the study as given.
    pub alternative: Option<Alternative>,
    /// Front of each architecture; empty if no feasible design was found.
    pub alone: Vec<(Architecture, Front)>,
    /// `R_w` of each reference design of the study on the fine grid \[m\].
    pub references: Vec<f64>,
}

impl Variation {
    /// Returns the short name of the alternative assumption.
    pub fn name(&self) -> &'static str {
        self.alternative.map_or(AS_STATED, |alternative| alternative.name)
    }

    /// Returns whether the alternative can change the evaluation of a design, rather than only the search.
    pub fn affects_evaluation(&self) -> bool {
        self.alternative
            .is_none_or(|alternative| alternative.affects_evaluation)
    }

    /// Returns whether only the random seed differs, so that all differences are due to chance.
    pub fn is_chance(&self) -> bool {
        self.alternative.is_some_and(|alternative| alternative.meaning == SEED)
    }

    /// Returns the front of an architecture, unless it is empty.
    pub fn of(&self, architecture: Architecture) -> Option<&Front> {
        let found = self.alone.iter().find(|(other, _)| *other == architecture);
        found.map(|(_, front)| front).filter(|front| !front.members.is_empty())
    }
}

/// Cost of a required clearance, from the searches with and without it.
#[derive(Debug, Clone, Copy)]
pub struct ClearanceCost<'a> {
    /// The clearance \[m\].
    pub clearance: f64,
    /// Searches in which the clearance is required.
    pub with: &'a Variation,
    /// Searches in which members may collide.
    pub without: &'a Variation,
}

impl<'a> ClearanceCost<'a> {
    /// Finds the two variations to compare; `None` if one of them was not searched.
    pub fn of(study: &Study, variations: &'a [Variation]) -> Option<Self> {
        let base = variations.iter().find(|variation| variation.alternative.is_none())?;
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

/// Searches each architecture of the study on its own, with the given number of `evaluations`, for the study as given
/// and for every alternative assumption that changes the study.
///
/// # Errors
/// [`ReportError`] if a search fails.
pub(super) fn search_alternatives(
    study: &Study,
    evaluations: usize,
    tell: &mut dyn FnMut(&str),
) -> Result<Vec<Variation>, ReportError> {
    let mut base = study.clone();
    base.optimizer.evaluations = evaluations;
    // All searches must have the same number of evaluations: neither a time limit nor stagnation may end one earlier.
    base.optimizer.time_limit_s = None;
    base.optimizer.stagnation = None;
    let alternatives = std::iter::once(None).chain(ALTERNATIVES.into_iter().map(Some));
    let mut variations = Vec::new();
    for alternative in alternatives {
        let mut study = base.clone();
        if let Some(alternative) = alternative {
            (alternative.change)(&mut study);
            // The study may already make this assumption, or the changed study may be invalid.
            if study == base || !study.faults().is_empty() {
                continue;
            }
        }
        let name = alternative.map_or(AS_STATED, |alternative| alternative.name);
        let problem = DesignProblem::new(&study)?;
        let mut alone = Vec::new();
        for &architecture in &base.architectures {
            tell(&format!("sensitivity: {name}, {architecture}"));
            let mut single = study.clone();
            single.architectures = vec![architecture];
            let source = Source::run(name, single)?;
            match Fronts::new(&[source], &problem, study.optimizer.front_designs) {
                Some(fronts) => alone.extend(fronts.alone),
                None => alone.push((architecture, Front::default())),
            }
        }
        let references = study
            .references
            .iter()
            .filter_map(|reference| reference.parse(study.working_mode).ok())
            .map(|design| problem.model().evaluate(&design, GridChoice::Fine).workspace_radius)
            .collect();
        variations.push(Variation {
            alternative,
            alone,
            references,
        });
    }
    Ok(variations)
}
