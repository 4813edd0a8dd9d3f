//! A wish: the nearest design of which some quantities have other values.

use std::str::FromStr;

use kinefront_model::certify::CertifyOptions;
use kinefront_model::evaluation::{
    Better, Bound, Evaluation, GridChoice, Model, ModelSettings, PoseScalar, Quantity, QuantityLimit,
};
use kinefront_model::mechanism::Design;
use kinefront_model::workspace::Region;
use kinefront_optimum::{LocalProblem, LocalQuestion, Polished};

use super::grid::{ANSWERS, LARGEST_ROOM, ROOM};
use super::{LocalAnswer, LocalDesign, LocalFault};
use crate::prove::SLACK;
use crate::settings::unknown_quantity;
use crate::{DesignProblem, FrontMember, FrontProver, PoolWorkers};

/// Part of a wish up to which the largest one that can be had is determined.
const RESOLUTION: f64 = 1.0 / 64.0;

/// Number of steps to the entries of lists and catalogues that are tried for the whole of a wish.
const FAR: usize = 3;

/// Relative increase of the radius of a disc, so that the radius that is proved is still the one that is wished for.
const PROOF: f64 = CertifyOptions::TOLERANCE;

/// A condition of a wish.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Condition(pub QuantityLimit);

/// Why a text is no condition.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ConditionError {
    /// There is no comparison.
    #[error("`{0}` is not a condition; write a quantity, >= or <=, and a number, as in \"k_xy_n_per_m >= 1.2e6\"")]
    Form(String),
    /// The quantity is unknown.
    #[error("`{0}` {told}", told = unknown_quantity(.0))]
    Quantity(String),
    /// The number is none.
    #[error("`{0}` is not a number above 0")]
    Number(String),
}

impl Condition {
    /// Returns the condition that a quantity has a value or a better one.
    pub fn no_worse_than(quantity: Quantity, value: f64) -> Self {
        let bound = Bound::no_worse_than(value, quantity.entry().better);
        Self(QuantityLimit { quantity, bound })
    }

    /// Returns whether an evaluated design satisfies the condition, but for rounding.
    fn holds_for(&self, evaluation: &Evaluation) -> bool {
        let value = evaluation.quantities.get(self.0.quantity);
        value.is_some_and(|value| self.0.margin(value) >= -1e-6)
    }
}

impl FromStr for Condition {
    type Err = ConditionError;

    fn from_str(text: &str) -> Result<Self, ConditionError> {
        let (key, bound, number) = match (text.split_once(">="), text.split_once("<=")) {
            (Some((key, number)), None) => (key, Bound::AtLeast as fn(f64) -> Bound, number),
            (None, Some((key, number))) => (key, Bound::AtMost as fn(f64) -> Bound, number),
            _ => return Err(ConditionError::Form(text.to_owned())),
        };
        let quantity = Wish::quantity(key.trim())?;
        let value = number
            .trim()
            .parse::<f64>()
            .ok()
            .filter(|value| value.is_finite() && *value > 0.0);
        let value = value.ok_or_else(|| ConditionError::Number(number.trim().to_owned()))?;
        Ok(Self(QuantityLimit {
            quantity,
            bound: bound(value),
        }))
    }
}

impl std::fmt::Display for Condition {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (sign, value) = match self.0.bound {
            Bound::AtLeast(value) => (">=", value),
            Bound::AtMost(value) => ("<=", value),
        };
        write!(f, "{} {sign} {value}", self.0.quantity.entry().key)
    }
}

/// What a person wishes of a design.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Wish {
    /// Values that quantities are to have.
    pub conditions: Vec<Condition>,
    /// Quantities that are not to become worse.
    pub keep: Vec<Quantity>,
}

impl Wish {
    /// Returns the quantity with the given key.
    ///
    /// # Errors
    /// [`ConditionError::Quantity`], which names the nearest key, if there is none.
    pub fn quantity(key: &str) -> Result<Quantity, ConditionError> {
        Quantity::find(key).ok_or_else(|| ConditionError::Quantity(key.to_owned()))
    }

    /// Returns the quantities that a wish compares, and those of which one may be wished for next.
    fn quantities(&self, model: &Model) -> impl Iterator<Item = Quantity> {
        let named = self.conditions.iter().map(|condition| condition.0.quantity);
        let limited = model.settings().thresholds.iter().map(|(scalar, _)| scalar);
        let limited = limited.chain([PoseScalar::Footprint]).map(Quantity::Worst);
        named.chain(self.keep.iter().copied()).chain(limited)
    }
}

/// What became of a wish.
#[derive(Debug, Clone)]
pub struct WishOutcome {
    /// The design as it was given, on the fine grid.
    pub before: Evaluation,
    /// The nearest design that satisfies the wish, verified and proved; or, if none does, the one that comes nearest.
    pub found: FrontMember,
    /// Whether the given design satisfies the wish already.
    pub was_true: bool,
    /// The conditions that cannot be had, each with the value that can be had instead; empty if the wish is answer.
    pub unmet: Vec<(Condition, f64)>,
    /// Dimensions of lists and catalogues that have another entry, in words.
    pub changed_entries: Vec<String>,
    /// Quantities of the wish that are not part of a local problem; they are compared at the end alone.
    pub left_out: Vec<Quantity>,
}

/// Why a wish has no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WishFault {
    /// There is no local problem.
    #[error(transparent)]
    Local(#[from] LocalFault),
    /// The design is infeasible.
    #[error("the design is infeasible; a wish must start from a design that is feasible on the fine grid")]
    Infeasible,
    /// The design that was found does not hold on the fine grid.
    #[error("the nearest design, {0}, is infeasible on the fine grid")]
    NotVerified(Box<Design>),
}

impl DesignProblem {
    /// Answers a wish: of the designs that satisfy it, the one whose first objective is best and whose other objectives are those of the
    /// given design, verified on the fine grid and proved. It is found by following the optimum from the given design, so that it is the
    /// nearest one of its architecture.
    ///
    /// # Errors
    /// [`WishFault`] if the design is infeasible, or if its question has no local problem.
    pub fn grant(&self, design: &Design, wish: &Wish) -> Result<WishOutcome, WishFault> {
        let model = self.model().clone().with_quantities(wish.quantities(self.model()));
        let before = model.evaluate_by(&PoolWorkers, design, GridChoice::Fine);
        if !before.is_feasible() {
            return Err(WishFault::Infeasible);
        }
        let kept = wish.keep.iter().filter_map(|quantity| kept(&before, *quantity));
        let conditions: Vec<Condition> = wish.conditions.iter().copied().chain(kept).collect();
        if conditions.iter().all(|condition| condition.holds_for(&before)) {
            let found = self.proved(before.clone());
            return Ok(WishOutcome {
                found,
                before,
                was_true: true,
                unmet: Vec::new(),
                changed_entries: Vec::new(),
                left_out: Vec::new(),
            });
        }
        let local = self.local_of(&before, &[])?;
        let target = Target {
            settings: self.model().settings(),
            local: &local,
            before: &before,
            conditions: &conditions,
        };
        let mut fault = None;
        // A part of a wish is of use only where no entries near those of the design satisfy the whole.
        for is_whole in [true, false] {
            for answer in self.answers(&target, is_whole).iter().take(ANSWERS) {
                let (wished, found) = match self.for_grid(answer, &model) {
                    Ok(held) => held,
                    Err(error) => {
                        fault = fault.or(Some(error));
                        continue;
                    }
                };
                let unmet = conditions.iter().filter(|condition| !condition.holds_for(&found));
                let unmet =
                    unmet.filter_map(|condition| Some((*condition, found.quantities.get(condition.0.quantity)?)));
                return Ok(WishOutcome {
                    unmet: unmet.collect(),
                    changed_entries: self.changed_entries(design, &found.design),
                    left_out: answer.problem.left_out(),
                    found: wished.proved(found),
                    was_true: false,
                    before,
                });
            }
        }
        Err(fault.unwrap_or(WishFault::Local(LocalFault::Infeasible(Box::new(*design)))))
    }

    /// Returns optima with the entries of a design and with those that are better, the best first: those that satisfy the whole of a wish,
    /// or as large a part of it as possible.
    fn answers(&self, target: &Target, is_whole: bool) -> Vec<LocalAnswer> {
        let local = target.local;
        let (design, home) = (local.design, local.home.unwrap_or_default());
        let whole = |design: &Design, home: f64, _: bool| target.answer(1.0, design, home);
        let most = |design: &Design, home: f64, is_whole: bool| {
            let found = target.answer(1.0, design, home);
            found.or_else(|| target.part(design, home).filter(|_| !is_whole))
        };
        match is_whole {
            true => self.follow_entries((design, home), whole(&design, home, true), FAR, &whole),
            false => self.follow_entries((design, home), target.part(&design, home), 1, &most),
        }
    }

    /// Returns the design of an answer as it holds on the fine grid, with the problem whose requirements the wish states.
    fn for_grid(&self, answer: &LocalAnswer, model: &Model) -> Result<(Self, Evaluation), WishFault> {
        let LocalAnswer { polished, problem, .. } = answer;
        // The requirements, of which the wish is one, decide which home orientations can be selected.
        let wished = self
            .with_thresholds(problem.question().settings.thresholds)
            .map_err(|error| WishFault::Local(LocalFault::Question(error.into())))?;
        let evaluated = wished
            .model()
            .clone()
            .with_quantities(model.settings().quantities.iter());
        let evaluate = |design: &Design| evaluated.evaluate_by(&PoolWorkers, design, GridChoice::Fine);
        // The proof that members carry their loads takes long where no slack is left.
        let thresholds = problem.question().settings.thresholds;
        let room = match thresholds.iter().any(|(scalar, _)| scalar.is_of_loads()) {
            true => SLACK,
            false => ROOM,
        };
        let found = self.held_with_room((problem, polished), [room, LARGEST_ROOM], PROOF, evaluate);
        let found = found.ok_or_else(|| WishFault::NotVerified(Box::new(polished.design)))?;
        Ok((wished, found))
    }

    /// Proves a design that was evaluated on the fine grid.
    fn proved(&self, evaluation: Evaluation) -> FrontMember {
        let member = FrontMember::of(0, evaluation);
        let prover = FrontProver::at_once(self, &PoolWorkers);
        prover.prove(&member).reported().cloned().unwrap_or(member)
    }
}

/// Returns the condition that a quantity does not become worse.
fn kept(evaluation: &Evaluation, quantity: Quantity) -> Option<Condition> {
    let value = evaluation.quantities.get(quantity)?;
    Some(Condition::no_worse_than(quantity, value))
}

/// A wish, on the way from a design.
struct Target<'a> {
    /// The settings of the study, without the values at which objectives are held.
    settings: &'a ModelSettings,
    local: &'a LocalDesign,
    before: &'a Evaluation,
    conditions: &'a [Condition],
}

impl Target<'_> {
    /// Returns the optimum near a design that satisfies a part of the wish; `None` if there is none.
    fn answer(&self, part: f64, design: &Design, home: f64) -> Option<LocalAnswer> {
        let problem = LocalProblem::new(self.question(part), design).ok()?;
        let polished = problem.polish(design, home).filter(Polished::is_feasible)?;
        Some(LocalAnswer {
            polished,
            problem,
            part,
        })
    }

    /// Returns the optimum near a design that satisfies as large a part of the wish as possible, which is approached from what the design
    /// has.
    fn part(&self, design: &Design, home: f64) -> Option<LocalAnswer> {
        let (mut had, mut step) = (self.answer(0.0, design, home)?, 0.25);
        while step > RESOLUTION && had.part < 1.0 {
            let part = (had.part + step).min(1.0);
            match self.answer(part, &had.polished.design, had.polished.home) {
                Some(found) => had = found,
                None => step *= 0.5,
            }
        }
        Some(had)
    }

    /// Returns the question with a part of the wish, from the values that the design has (0) to those that are wished for (1).
    fn question(&self, part: f64) -> LocalQuestion {
        let mut question = self.local.problem.question().clone();
        // The answer is optimised again for the fine grid, so that it need not be exact.
        question.slack = ROOM;
        let first = question.objective.quantity;
        for Condition(limit) in self.conditions {
            let (quantity, wished) = (limit.quantity, limit.threshold());
            let had = self.before.quantities.get(quantity).unwrap_or(wished);
            // What the design has already is asked for as it is wished.
            let value = match limit.margin(had) >= 0.0 {
                true => wished,
                false => had * libm::pow(wished / had, part),
            };
            let (is_at_least, is_of_disc) = (
                matches!(limit.bound, Bound::AtLeast(_)),
                matches!(question.workspace.region, Region::Disc(_)),
            );
            match quantity {
                // It is improved as far as possible, and compared at the end.
                quantity if quantity == first => {}
                Quantity::WorkspaceRadius if is_at_least && is_of_disc => {
                    question.workspace.region = Region::Disc(value);
                }
                Quantity::Worst(scalar)
                    if scalar.bounds_poses() && is_at_least == (scalar.entry().quantity.better == Better::Higher) =>
                {
                    // A wish never breaks the study.
                    let stated = self.settings.thresholds.get(scalar).unwrap_or(value);
                    let limit = scalar.stricter(value, stated);
                    question.settings.thresholds.set(scalar, Some(limit));
                }
                _ => {
                    let limits = &mut question.settings.limits;
                    limits.retain(|limit| limit.quantity != quantity || self.settings.limits.contains(limit));
                    limits.push(QuantityLimit {
                        quantity,
                        bound: if is_at_least {
                            Bound::AtLeast(value)
                        } else {
                            Bound::AtMost(value)
                        },
                    });
                }
            }
        }
        question
    }
}
