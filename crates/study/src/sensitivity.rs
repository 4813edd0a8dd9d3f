//! Sensitivity to assumptions: the studies in which one assumption of a study is replaced by an alternative.

use crate::{LengthChoice, StiffnessChoice, Study, TelescopicBar};

/// What an alternative can change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// The evaluation of a design.
    Evaluation,
    /// Which designs are searched.
    Search,
    /// The random seed of the search alone, so that all differences are due to chance.
    Chance,
}

/// An alternative to one assumption of a study.
#[derive(Debug, Clone, Copy)]
pub struct Alternative {
    /// Short name, as shown in legends and tables.
    pub name: &'static str,
    /// What the alternative changes and, where it is not obvious, why one might choose it.
    pub meaning: &'static str,
    /// What the alternative can change.
    pub effect: Effect,
    change: fn(&mut Study),
}

impl Alternative {
    /// An alternative that changes only the random seed.
    const fn of_seed(name: &'static str, change: fn(&mut Study)) -> Self {
        Self {
            name,
            meaning: "only the random seed of the search",
            effect: Effect::Chance,
            change,
        }
    }

    /// Whether only the random seed differs, so that all differences are due to chance.
    pub fn is_chance(&self) -> bool {
        self.effect == Effect::Chance
    }
}

/// Name of the alternative in which members must keep a clearance.
pub const CLEAR: &str = "5 mm clearance";

/// Name of the alternative in which members may collide.
pub const COLLIDING: &str = "members may collide";

/// Name of the alternative with the bound of the platform radius that the paper prints.
pub const LARGER_PLATFORM: &str = "r ≥ 0.5 m";

/// Name of the alternative with the torque that the text of the paper has.
pub const LARGER_TORQUE: &str = "τ_z = 100 N·m";

/// Name of the alternative with the number of platform bars that the equation of the paper counts.
pub const ONE_PLATFORM_BAR: &str = "one platform bar";

/// Clearance that is tried if the study requires none \[m\].
pub const CLEARANCE: f64 = 5e-3;

/// Name of the study without an alternative.
pub const AS_STATED: &str = "study as given";

/// Returns the short name of an alternative, or of the study without one.
pub fn name_of(alternative: Option<&Alternative>) -> &'static str {
    alternative.map_or(AS_STATED, |alternative| alternative.name)
}

/// The alternative assumptions tried. The last ones change only the random seed: their differences are due to chance.
pub const ALTERNATIVES: [Alternative; 15] = [
    Alternative {
        name: "K_act / 10",
        meaning: "actuators ten times softer",
        effect: Effect::Evaluation,
        change: |study| scale_actuators(study, 0.1),
    },
    Alternative {
        name: "K_act × 10",
        meaning: "actuators ten times stiffer",
        effect: Effect::Evaluation,
        change: |study| scale_actuators(study, 10.0),
    },
    Alternative {
        name: "other stiffness definition",
        meaning: "stiffness from the blocks of the compliance matrix (all other directions free) instead of the \
                  blocks of the stiffness matrix (all other directions held), or vice versa",
        effect: Effect::Evaluation,
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
        effect: Effect::Evaluation,
        change: |study| study.model.characteristic_length = LengthChoice::Isotropic,
    },
    Alternative {
        name: LARGER_PLATFORM,
        meaning: "a lower bound of 0.5 m for r instead of that of the study",
        effect: Effect::Search,
        change: |study| study.bounds.r_m[0] = study.bounds.r_m[0].max(0.5),
    },
    Alternative {
        name: "telescopic bar L_b",
        meaning: "the beam of a telescopic leg as long as the fully extended leg, whatever the pose",
        effect: Effect::Evaluation,
        change: |study| study.model.telescopic_bar = TelescopicBar::Longest,
    },
    Alternative {
        name: "φ_c = 0",
        meaning: "the home orientation fixed, with the platform triangle parallel to the base triangle",
        effect: Effect::Evaluation,
        change: |study| study.workspace.home_phi_deg = Some(0.0),
    },
    Alternative {
        name: LARGER_TORQUE,
        meaning: "a required torque about z of 100 N·m instead of the one of the study",
        effect: Effect::Evaluation,
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
        effect: Effect::Evaluation,
        change: |study| study.model.platform_bars = 1,
    },
    Alternative {
        name: "G − 7 %",
        meaning: "a shear modulus smaller by 7 %",
        effect: Effect::Evaluation,
        change: |study| study.material.shear_modulus_pa *= 0.93,
    },
    Alternative {
        name: CLEAR,
        meaning: "a clearance of 5 mm between members that are not joined, which the study does not require",
        effect: Effect::Evaluation,
        change: |study| {
            study.requirements.clearance_min_m.get_or_insert(CLEARANCE);
        },
    },
    Alternative {
        name: COLLIDING,
        meaning: "no clearance required, unlike in the study",
        effect: Effect::Evaluation,
        change: |study| study.requirements.clearance_min_m = None,
    },
    Alternative::of_seed("seed + 1", |study| study.optimizer.seed += 1),
    Alternative::of_seed("seed + 2", |study| study.optimizer.seed += 2),
    Alternative::of_seed("seed + 3", |study| study.optimizer.seed += 3),
];

/// Returns the study as given, without an alternative, and the study under each alternative that changes it and leaves it valid. Each
/// search of these studies has the given number of evaluations: neither a time limit nor stagnation ends one earlier.
///
/// ```
/// use kinefront_study::{Study, sensitivity};
///
/// let paper = Study::load("paper".as_ref())?;
/// let studies = sensitivity::studies(&paper, 1000);
/// assert!(studies[0].0.is_none());
/// // The paper requires no clearance: an alternative that lifts the requirement changes nothing.
/// assert!(studies.iter().flat_map(|(alternative, _)| alternative).all(|tried| tried.name != sensitivity::COLLIDING));
/// # Ok::<(), kinefront_study::StudyError>(())
/// ```
pub fn studies(study: &Study, evaluations: usize) -> Vec<(Option<Alternative>, Study)> {
    let mut base = study.clone();
    base.optimizer.evaluations = evaluations;
    base.optimizer.time_limit_s = None;
    base.optimizer.stagnation = None;
    let changed = ALTERNATIVES.into_iter().filter_map(|alternative| {
        let mut study = base.clone();
        (alternative.change)(&mut study);
        (study != base && study.faults().is_empty()).then_some((Some(alternative), study))
    });
    let changed: Vec<_> = changed.collect();
    std::iter::once((None, base)).chain(changed).collect()
}

fn scale_actuators(study: &mut Study, factor: f64) {
    study.actuators.prismatic_stiffness_n_per_m *= factor;
    study.actuators.revolute_stiffness_nm_per_rad *= factor;
}
