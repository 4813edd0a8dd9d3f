//! Prices: by how much the objective of an optimum changes with each requirement, bound and property.

use glam::DVec2;
use kinefront_model::mechanism::{DesignVariable, JointKind};
use kinefront_model::workspace::Region;

use super::multipliers::Multipliers;
use super::parameter::{Change, Parameter};
use super::place::{Area, Place, Spot};
use super::polished::Polished;
use super::problem::LocalProblem;
use super::question::LocalQuestion;
use super::requirement::{Critical, End, NOWHERE, Requirement};

/// Half the step of a parameter by which the effects on the requirements are determined.
const EFFECT_STEP: f64 = 1e-6;

/// Effects below this are rounding.
const NO_EFFECT: f64 = 1e-9;

/// One-sided prices that differ by less than this are one.
const ONE_PRICE: f64 = 5e-3;

/// Steps of a parameter after which the design is optimised again.
pub const PRICE_STEPS: [f64; 6] = [-0.2, -0.1, -0.03, 0.03, 0.1, 0.2];

/// What a parameter costs at an optimum.
#[derive(Debug, Clone, PartialEq)]
pub struct Price {
    /// The parameter.
    pub parameter: Parameter,
    /// Relative change of the objective for a relative change of the parameter; for a distance that is 0, for a change in multiples of
    /// `R`; for an angle, for a change of 1 rad.
    pub price: f64,
    /// The price where the parameter falls, and where it rises; both are `price` unless the optimum lies at a kink.
    pub one_sided: [f64; 2],
    /// Relative change of the radius of the workspace for a relative change of the parameter, if the objective is to stay the same.
    pub radius_price: Option<f64>,
    /// The price if the bars alone may change.
    pub bars_only: Option<f64>,
    /// Ways in which the bars cannot repair what a change of the parameter does to a requirement: where it falls, and where it rises.
    pub bars_cannot_repair: [bool; 2],
    /// Changes of the logarithm of the objective for some steps of the parameter, each with the design optimised again.
    pub steps: Vec<PriceStep>,
}

/// The design optimised again after a step of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PriceStep {
    /// Step of the logarithm of the parameter.
    pub step: f64,
    /// Change of the logarithm of the objective.
    pub change: f64,
}

/// The prices of a design.
#[derive(Debug, Clone)]
pub struct Prices {
    /// The prices, in the order of the parameters.
    pub prices: Vec<Price>,
    /// Prices of the dimensions that are kept if the bars alone may change.
    pub of_dimensions: Vec<(DesignVariable, f64)>,
}

impl LocalProblem {
    /// Returns the prices at an optimum. With `with_bars`, also those if the bars alone may change.
    pub fn prices(&self, polished: &Polished, with_bars: bool) -> Prices {
        let context = Context {
            problem: self,
            polished,
            actuator: polished.design.architecture().actuator(),
            base_radius: polished.design.base_radius(),
        };
        let bars = with_bars.then(|| context.of_bars()).flatten();
        let mut parameters = Parameter::all(self);
        let (_, bounds) = polished.multipliers.nearly_active();
        parameters.extend(
            bounds
                .iter()
                .filter(|(place, _)| *place < self.question().variables.len())
                .map(|&(place, end)| Parameter::Bound(place, end)),
        );
        let mut prices: Vec<Price> = parameters
            .into_iter()
            .filter_map(|parameter| context.price(parameter, bars.as_ref()))
            .collect();
        let of_radius = prices
            .iter()
            .find(|price| price.parameter == Parameter::WorkspaceRadius)
            .map(|price| price.price);
        for price in &mut prices {
            let radius =
                of_radius.filter(|radius| radius.abs() > 1e-9 && price.parameter != Parameter::WorkspaceRadius);
            price.radius_price = radius.map(|radius| -price.price / radius);
        }
        Prices {
            prices,
            of_dimensions: bars.map(|bars| context.of_dimensions(&bars)).unwrap_or_default(),
        }
    }

    /// Returns the changes of the logarithm of the objective after steps of a parameter, each with the design optimised again. A step
    /// after which no optimum was found is left out.
    pub fn steps(&self, polished: &Polished, parameter: Parameter, steps: &[f64]) -> Vec<PriceStep> {
        let mut found = Vec::new();
        for sign in [-1.0, 1.0] {
            let mut on_side: Vec<f64> = steps.iter().copied().filter(|step| step * sign > 0.0).collect();
            on_side.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
            let mut from = polished.clone();
            for step in on_side {
                let Some(next) = self.after(&from, &[(parameter, 1.0)], step) else {
                    break;
                };
                let change = self.log_of(&next) - self.log_of(polished);
                if next.is_optimal() {
                    found.push(PriceStep { step, change });
                }
                from = next;
            }
        }
        found.sort_by(|a, b| a.step.total_cmp(&b.step));
        found
    }

    /// Returns the optimum for parameters that are changed by a step times the weight of each, starting from another optimum.
    pub(crate) fn after(&self, from: &Polished, weights: &[(Parameter, f64)], step: f64) -> Option<Polished> {
        self.changed(from, weights, step)?.polish_from(&from.unknowns)
    }

    /// Returns the problem with parameters that are changed by a step times the weight of each, near an optimum.
    pub(crate) fn changed(&self, near: &Polished, weights: &[(Parameter, f64)], step: f64) -> Option<Self> {
        let actuator = near.design.architecture().actuator();
        let change = |question: LocalQuestion, (parameter, weight): &(Parameter, f64)| {
            parameter.changed(&question, weight * step, near.design.base_radius(), actuator)
        };
        let question = weights.iter().try_fold(self.question.clone(), change)?;
        self.with_question(question).ok()
    }

    /// Returns the logarithm of the objective of an optimum.
    pub(crate) fn log_of(&self, polished: &Polished) -> f64 {
        libm::log(polished.objective)
    }
}

/// What every price needs.
struct Context<'a> {
    problem: &'a LocalProblem,
    polished: &'a Polished,
    actuator: JointKind,
    base_radius: f64,
}

/// The multipliers if the bars alone may change.
struct OfBars {
    problem: LocalProblem,
    unknowns: Vec<f64>,
    multipliers: Multipliers,
}

impl Context<'_> {
    /// Returns the price of a parameter; `None` if it has no meaning for the design.
    fn price(&self, parameter: Parameter, bars: Option<&OfBars>) -> Option<Price> {
        let Self { problem, polished, .. } = self;
        let multipliers = &polished.multipliers;
        let (direct, effects) = self.effects(problem, &polished.unknowns, multipliers, parameter)?;
        let sign = problem.goal_sign();
        // The effect on what is minimised, as a change of the objective.
        let price = sign * (direct - multipliers.sum(&effects));
        let mut one_sided = [price; 2];
        if multipliers.are_ambiguous
            && let Some([least, largest]) = multipliers.range(&effects)
        {
            let mut ends = [direct - largest, direct - least].map(|end| sign * end);
            if sign < 0.0 {
                ends.swap(0, 1);
            }
            if ends[1] - ends[0] > ONE_PRICE * price.abs().max(1.0) {
                one_sided = ends;
            }
        }
        let of_bars = bars.and_then(|bars| {
            let (direct, effects) = self.effects(&bars.problem, &bars.unknowns, &bars.multipliers, parameter)?;
            Some(sign * (direct - bars.multipliers.sum(&effects)))
        });
        let (nearly, _) = multipliers.nearly_active();
        let not_of_bars = nearly
            .iter()
            .zip(&effects)
            .filter(|(critical, _)| !critical.requirement.is_of_bars());
        let mut bars_cannot_repair = [false; 2];
        for (_, effect) in not_of_bars {
            bars_cannot_repair[0] |= *effect > NO_EFFECT;
            bars_cannot_repair[1] |= *effect < -NO_EFFECT;
        }
        Some(Price {
            parameter,
            price,
            one_sided,
            radius_price: None,
            bars_only: of_bars.filter(|_| !matches!(parameter, Parameter::Bound(..))),
            bars_cannot_repair,
            steps: Vec::new(),
        })
    }

    /// Returns the effects of a parameter on what is minimised, and on the requirements and bounds that are nearly active, at fixed
    /// unknowns and places.
    fn effects(
        &self,
        problem: &LocalProblem,
        unknowns: &[f64],
        multipliers: &Multipliers,
        parameter: Parameter,
    ) -> Option<(f64, Vec<f64>)> {
        let (nearly, bounds) = multipliers.nearly_active();
        if let Parameter::Bound(place, end) = parameter {
            let of_bound = |(variable, side): &(usize, End)| {
                let is_it = *variable == place && *side == end;
                if is_it { -end.sign() } else { 0.0 }
            };
            let effects = nearly.iter().map(|_| 0.0).chain(bounds.iter().map(of_bound));
            return Some((0.0, effects.collect()));
        }
        let change = parameter.change(&problem.question, self.actuator);
        if change == Change::OfBaseRadius && matches!(parameter, Parameter::RailStart | Parameter::GuideStart) {
            let is_rail = parameter == Parameter::RailStart;
            let of_start = |critical: &Critical| match critical.requirement {
                Requirement::Limit {
                    joint, end: End::Lower, ..
                } if (joint == 0) == is_rail => -1.0,
                _ => 0.0,
            };
            let effects = nearly.iter().map(of_start).chain(bounds.iter().map(|_| 0.0));
            return Some((0.0, effects.collect()));
        }
        let at = |step: f64| -> Option<(f64, Vec<f64>)> {
            let question = parameter.changed(&problem.question, step, self.base_radius, self.actuator)?;
            let changed = problem.with_question(question).ok()?;
            Some((changed.minimised(unknowns), changed.values_of(unknowns, nearly)))
        };
        let ((below, lower), (above, upper)) = (at(-EFFECT_STEP)?, at(EFFECT_STEP)?);
        let width = 2.0 * EFFECT_STEP;
        let of_requirement = |(lower, upper): (&f64, &f64)| {
            if *lower > NOWHERE && *upper > NOWHERE {
                (upper - lower) / width
            } else {
                0.0
            }
        };
        let effects = lower
            .iter()
            .zip(&upper)
            .map(of_requirement)
            .chain(bounds.iter().map(|_| 0.0));
        Some(((above - below) / width, effects.collect()))
    }

    /// Returns the multipliers if the bars alone may change; `None` if none of them may.
    fn of_bars(&self) -> Option<OfBars> {
        let question = self.problem.question.of_bars(self.polished.home.to_degrees());
        if question.variables.is_empty() {
            return None;
        }
        let problem = LocalProblem::new(question, &self.polished.design).ok()?;
        let unknowns = problem.unknowns(&self.polished.design, self.polished.home);
        let of_bars = self
            .polished
            .critical
            .iter()
            .filter(|critical| critical.requirement.is_of_bars());
        let critical: Vec<Critical> = of_bars.copied().collect();
        let multipliers = Multipliers::new(&problem, &unknowns, &critical);
        Some(OfBars {
            problem,
            unknowns,
            multipliers,
        })
    }

    /// Returns the prices of the dimensions that are kept if the bars alone may change.
    fn of_dimensions(&self, bars: &OfBars) -> Vec<(DesignVariable, f64)> {
        let (nearly, bounds) = bars.multipliers.nearly_active();
        let kept = self
            .problem
            .question
            .variables
            .iter()
            .enumerate()
            .filter(|(_, free)| !free.variable.may_be_zero());
        kept.map(|(place, free)| {
            let at = |step: f64| {
                let mut unknowns = self.polished.unknowns.clone();
                unknowns[place] += step;
                // The places of bars are those of the whole problem, whose unknowns are more.
                (
                    self.problem.minimised(&unknowns),
                    self.problem.values_of(&unknowns, nearly),
                )
            };
            let ((below, lower), (above, upper)) = (at(-EFFECT_STEP), at(EFFECT_STEP));
            let width = 2.0 * EFFECT_STEP;
            let effects = lower.iter().zip(&upper).map(|(lower, upper)| (upper - lower) / width);
            let effects: Vec<f64> = effects.chain(bounds.iter().map(|_| 0.0)).collect();
            let price = (above - below) / width - bars.multipliers.sum(&effects);
            (free.variable, self.problem.goal_sign() * price)
        })
        .collect()
    }
}

impl Price {
    /// Returns whether the optimum lies at a kink.
    pub fn is_kink(&self) -> bool {
        self.one_sided[0] != self.one_sided[1]
    }

    /// Returns the steps, down and up, at which the linear price is off by 20 %, where the changes after finite steps show them.
    pub fn off_by_20_percent(&self) -> [Option<f64>; 2] {
        [-1.0, 1.0].map(|side| {
            let mut before = (0.0, 0.0);
            let mut on_side: Vec<&PriceStep> = self.steps.iter().filter(|step| step.step * side > 0.0).collect();
            on_side.sort_by(|a, b| a.step.abs().total_cmp(&b.step.abs()));
            for found in on_side {
                let linear = self.price * found.step;
                let off = if linear == 0.0 {
                    0.0
                } else {
                    (found.change / linear - 1.0).abs()
                };
                if off >= 0.2 {
                    let share = (0.2 - before.1) / (off - before.1);
                    return Some(before.0 + share * (found.step - before.0));
                }
                before = (found.step, off);
            }
            None
        })
    }
}

/// Returns the place of a critical pose as it is reported: share of the radius, angle \[rad\] and share of half the rotation range for a
/// disc, shares of half the sides and of half the range for a polygon.
pub fn reported_place(question: &LocalQuestion, place: &Place) -> [f64; 3] {
    let [first, second] = match place.spot {
        Spot::Rim(angle) => [1.0, angle],
        Spot::Inside(at) if matches!(question.workspace.region, Region::Disc(_)) => {
            let at = DVec2::from(at);
            [at.length(), libm::atan2(at.y, at.x)]
        }
        Spot::Inside(at) => at,
        Spot::Side(..) => match Area::new(&question.workspace.region) {
            Some(Area::Polygon(polygon, half)) => {
                let area = Area::Polygon(polygon, half);
                (area.position(place.spot) / half).to_array()
            }
            _ => [0.0; 2],
        },
    };
    [first, second, place.turn]
}
