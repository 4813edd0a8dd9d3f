//! Sensitivity to assumptions: how fronts and reference designs change when an assumption of the study is changed.

use super::fronts::{Front, front_of};
use super::source::Source;
use super::{Fronts, ReportError};
use kinefront_model::evaluation::{Evaluation, GridChoice};
use kinefront_model::mechanism::Architecture;
use kinefront_study::sensitivity::{self, Alternative, CLEAR, CLEARANCE, COLLIDING, Effect};
use kinefront_study::{DesignProblem, Study};

/// The fronts and the reference designs under one alternative assumption.
#[derive(Debug, Clone)]
pub struct Variation {
    /// The alternative assumption; `None` for the study as given.
    pub alternative: Option<Alternative>,
    /// Front of each architecture; empty if no feasible design was found.
    pub alone: Vec<(Architecture, Front)>,
    /// Each reference design of the study on the fine grid.
    pub references: Vec<Evaluation>,
}

impl Variation {
    /// Returns the short name of the alternative assumption.
    pub fn name(&self) -> &'static str {
        sensitivity::name_of(self.alternative.as_ref())
    }

    /// Returns whether the alternative can change the evaluation of a design, rather than only the search.
    pub fn affects_evaluation(&self) -> bool {
        self.alternative
            .is_none_or(|alternative| alternative.effect == Effect::Evaluation)
    }

    /// Returns whether only the random seed differs, so that all differences are due to chance.
    pub fn is_chance(&self) -> bool {
        self.alternative.is_some_and(|alternative| alternative.is_chance())
    }

    /// Returns the front of an architecture, unless it is empty.
    pub fn of(&self, architecture: Architecture) -> Option<&Front> {
        front_of(&self.alone, architecture).filter(|front| !front.members.is_empty())
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
    let mut variations = Vec::new();
    for (alternative, study) in sensitivity::studies(study, evaluations) {
        let name = sensitivity::name_of(alternative.as_ref());
        let problem = DesignProblem::new(&study)?;
        let mut alone = Vec::new();
        for &architecture in &study.architectures {
            tell(&format!("sensitivity: {name}, {architecture}"));
            let source = Source::search(name, study.with_one_architecture(architecture))?;
            match Fronts::new(&[source], &problem, study.optimizer.front_designs) {
                Some(fronts) => alone.extend(fronts.alone),
                None => alone.push((architecture, Front::default())),
            }
        }
        let references = study
            .references
            .iter()
            .filter_map(|reference| reference.parse(study.working_mode).ok())
            .map(|design| problem.model().evaluate(&design, GridChoice::Fine))
            .collect();
        variations.push(Variation {
            alternative,
            alone,
            references,
        });
    }
    Ok(variations)
}
