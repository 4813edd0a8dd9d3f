//! What drives the objective of a design, as other programs read it: prices, active requirements, slack, and why a wish cannot be had.

use kinefront_model::evaluation::{PoseScalar, Quantity};
use kinefront_model::mechanism::JointKind;
use kinefront_optimum::{
    Critical, LocalProblem, PRICE_STEPS, ParameterKind, Polished, Price, Relaxation, RelaxationOf, Requirement,
    reported_place,
};
use serde::Serialize;

use super::{AlternativeJson, LocalDesign, LocalFault};

/// What is determined beside the prices.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DriversOptions {
    /// Whether the geometry stays as it is, so that the bars alone change.
    pub bars_only: bool,
    /// Whether the design is optimised again after finite steps of each parameter.
    pub steps: bool,
    /// Whether the next entries of lists and catalogues are examined.
    pub alternatives: bool,
    /// A value of the objective that is wished for.
    pub wish: Option<f64>,
}

/// What drives the objective of a design.
#[derive(Debug, Clone, Serialize)]
pub struct Drivers {
    /// The optimum, as text.
    pub design: String,
    /// Key of the objective.
    pub objective: &'static str,
    /// Value of the objective of the given design.
    pub value: f64,
    /// Value of the objective of the optimum.
    pub polished_value: f64,
    /// Mass of the given design \[kg\].
    pub mass_kg: f64,
    /// Mass of the optimum \[kg\].
    pub polished_mass_kg: f64,
    /// Relative amount by which the given design is worse than the optimum.
    pub excess: f64,
    /// Home orientation of the optimum \[deg\].
    pub home_phi_deg: f64,
    /// Largest element of what the multipliers leave of the gradient.
    pub residual: f64,
    /// The active requirements.
    pub active: Vec<ActiveJson>,
    /// The prices.
    pub prices: Vec<PriceJson>,
    /// The requirements that are not active.
    pub inactive: Vec<InactiveJson>,
    /// Why a wished value cannot be had.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why_not: Option<WhyNotJson>,
    /// The design with the next entries of lists and catalogues.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub alternatives: Vec<AlternativeJson>,
    /// What the figures leave out.
    pub warnings: Vec<String>,
}

/// An active requirement at its critical pose.
#[derive(Debug, Clone, Serialize)]
pub struct ActiveJson {
    /// Name of the requirement.
    pub constraint: String,
    /// The leg that it is of: 1, 2 or 3.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub leg: Option<usize>,
    /// The pose: x \[m\], y \[m\] and the orientation \[deg\].
    pub pose: [f64; 3],
    /// The pose as shares of the region and of half the rotation range.
    pub place: [f64; 3],
    /// Multiplier: the relative change of the objective for a relative change of the requirement at this pose.
    pub multiplier: f64,
}

/// What a parameter costs.
#[derive(Debug, Clone, Serialize)]
pub struct PriceJson {
    /// Name of the parameter.
    pub parameter: String,
    /// Name for a person.
    pub label: String,
    /// Value of the parameter; absent for `E` and `G` together.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Unit of the value.
    pub unit: &'static str,
    /// Relative change of the objective for a relative change of the parameter.
    pub price: f64,
    /// The price where the parameter falls.
    pub below: f64,
    /// The price where the parameter rises.
    pub above: f64,
    /// Relative change of the workspace radius for a relative change of the parameter, at a constant objective.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius_price: Option<f64>,
    /// The price if the bars alone change.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bars_only: Option<f64>,
    /// Changes of the parameter for which thicker bars are no remedy: `down`, `up`.
    pub bars_cannot_repair: Vec<&'static str>,
    /// Steps of the logarithm of the parameter with the change of the logarithm of the objective.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub steps: Vec<[f64; 2]>,
    /// Steps, down and up, at which the linear price is off by 20 %.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub off_by_20_percent: Option<[Option<f64>; 2]>,
    /// Whether the price below and the price above differ.
    pub kink: bool,
    /// What the parameter is part of.
    #[serde(skip)]
    pub kind: ParameterKind,
}

/// A requirement that is not active.
#[derive(Debug, Clone, Serialize)]
pub struct InactiveJson {
    /// Name of the requirement.
    pub constraint: String,
    /// Its name for a person.
    pub label: String,
    /// How far the threshold may rise without cost, relative to itself; for a distance, as a share of `R`.
    pub slack: f64,
}

/// Why a wished value of the objective cannot be had.
#[derive(Debug, Clone, Serialize)]
pub struct WhyNotJson {
    /// The wished value.
    pub wished: f64,
    /// Logarithm of the wished value divided by that of the optimum; not negative if it can be had.
    pub log_deficit: f64,
    /// What each requirement would have to give.
    pub relaxations: Vec<RelaxationJson>,
}

/// What a requirement would have to give.
#[derive(Debug, Clone, Serialize)]
pub struct RelaxationJson {
    /// Name of the parameter; `all_thresholds` for the same factor on all limits, `least_norm` for the least change in all.
    pub parameter: String,
    /// Factor by the prices alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub linear: Option<f64>,
    /// Factor that is needed; absent if no factor down to 1/20 suffices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub needed: Option<f64>,
    /// Value of the objective with that factor, or the best that can be had.
    pub objective: f64,
    /// The design that has it.
    pub design: String,
    /// Its home orientation \[deg\].
    pub home_phi_deg: f64,
}

impl LocalDesign {
    /// Determines what drives the objective of the design.
    ///
    /// # Errors
    /// [`LocalFault`] if no design near it keeps every requirement.
    pub fn drivers(&self, options: DriversOptions) -> Result<Drivers, LocalFault> {
        let polished = self.best()?;
        if !options.bars_only {
            return Ok(self.drivers_of(&self.problem, &polished, options));
        }
        let question = self.problem.question().of_bars(polished.home.to_degrees());
        let problem = LocalProblem::new(question, &self.design)?;
        let of_bars = problem
            .polish(&self.design, polished.home)
            .ok_or_else(|| LocalFault::Infeasible(Box::new(self.design)))?;
        Ok(self.drivers_of(&problem, &of_bars, options))
    }

    pub(super) fn drivers_of(&self, problem: &LocalProblem, polished: &Polished, options: DriversOptions) -> Drivers {
        let question = problem.question();
        let objective = question.objective;
        let actuator = self.design.architecture().actuator();
        let mut warnings: Vec<String> = problem
            .left_out()
            .iter()
            .map(|quantity| format!("the prices do not include the limit of {}", quantity.entry().key))
            .collect();
        let is_explained = polished.multipliers.explain();
        if !is_explained {
            warnings.push(format!(
                "no optimum was found near the design: the multipliers leave {:.1e} of the gradient, so there are no prices",
                polished.multipliers.residual
            ));
        }
        let mut found = match is_explained {
            true => problem.prices(polished, !question.is_of_bars).prices,
            false => Vec::new(),
        };
        if options.steps {
            for price in &mut found {
                price.steps = problem.steps(polished, price.parameter, &PRICE_STEPS);
            }
        }
        let why_not = options.wish.map(|wished| why_not(problem, polished, &found, wished));
        let value = problem.objective_of(&self.design).unwrap_or(polished.objective);
        Drivers {
            design: polished.design.to_string(),
            objective: objective.quantity.entry().key,
            value,
            polished_value: polished.objective,
            mass_kg: problem.mass_of(&self.design),
            polished_mass_kg: problem.mass_of(&polished.design),
            excess: value / polished.objective - 1.0,
            home_phi_deg: polished.home.to_degrees().rem_euclid(360.0),
            residual: polished.multipliers.residual,
            active: polished
                .multipliers
                .active()
                .map(|(critical, multiplier)| active(problem, polished, critical, multiplier))
                .collect(),
            prices: found.iter().map(|price| price_json(problem, price, actuator)).collect(),
            inactive: inactive(problem, &polished.critical),
            why_not,
            alternatives: match options.alternatives {
                true => self.alternatives(problem, polished),
                false => Vec::new(),
            },
            warnings,
        }
    }
}

impl Drivers {
    /// Returns the prices of at least `free` \[% for 1 %\], and those at kinks, the largest first.
    pub fn dear(&self, free: f64) -> Vec<&PriceJson> {
        let mut dear: Vec<&PriceJson> = self.prices.iter().filter(|price| price.is_dear(free)).collect();
        dear.sort_by(|a, b| b.price.abs().total_cmp(&a.price.abs()));
        dear
    }

    /// Returns the names of the requirements that cost less.
    pub fn free(&self, free: f64) -> Vec<&str> {
        let cheap = self
            .prices
            .iter()
            .filter(|price| price.kind.is_requirement() && !price.is_dear(free));
        cheap.map(|price| price.label.as_str()).collect()
    }

    /// Returns the name of the objective where there is little room, and its unit.
    pub fn objective_name(&self) -> (&'static str, &'static str) {
        Quantity::find(self.objective).map_or(("objective", ""), |quantity| {
            (quantity.entry().short, quantity.entry().unit)
        })
    }
}

impl PriceJson {
    fn is_dear(&self, free: f64) -> bool {
        self.price.abs() >= free || self.kink
    }
}

fn active(problem: &LocalProblem, polished: &Polished, critical: &Critical, multiplier: f64) -> ActiveJson {
    ActiveJson {
        constraint: critical.requirement.name(problem),
        leg: critical.requirement.leg().map(|leg| leg + 1),
        pose: problem.pose(polished, &critical.place),
        place: reported_place(problem.question(), &critical.place),
        multiplier,
    }
}

fn price_json(problem: &LocalProblem, price: &Price, actuator: JointKind) -> PriceJson {
    let question = problem.question();
    let parameter = price.parameter;
    let ways = ["down", "up"].into_iter().zip(price.bars_cannot_repair);
    PriceJson {
        parameter: parameter.name(question),
        label: parameter.label(question),
        value: parameter.value(question, actuator),
        unit: parameter.unit(question, actuator),
        price: price.price,
        below: price.one_sided[0],
        above: price.one_sided[1],
        radius_price: price.radius_price,
        bars_only: price.bars_only,
        bars_cannot_repair: ways.filter(|(_, cannot)| *cannot).map(|(way, _)| way).collect(),
        steps: price.steps.iter().map(|step| [step.step, step.change]).collect(),
        off_by_20_percent: (!price.steps.is_empty()).then(|| price.off_by_20_percent()),
        kink: price.is_kink(),
        kind: parameter.kind(),
    }
}

/// Returns the requirements that are not active, each with its least slack.
fn inactive(problem: &LocalProblem, critical: &[Critical]) -> Vec<InactiveJson> {
    let name = |critical: &Critical| {
        let name = critical.requirement.name(problem);
        name.split(":leg").next().unwrap_or_default().to_owned()
    };
    let active: Vec<String> = critical
        .iter()
        .filter(|critical| critical.is_active())
        .map(name)
        .collect();
    let mut found: Vec<InactiveJson> = Vec::new();
    for critical in critical {
        let constraint = name(critical);
        let slack = match critical.requirement {
            Requirement::Scalar(PoseScalar::Dexterity) => (1.0 + 2.0 * critical.slack).max(0.0).sqrt() - 1.0,
            Requirement::Scalar(PoseScalar::Clearance) => critical.slack,
            Requirement::Scalar(_) | Requirement::Quantity(_) => libm::exp(critical.slack.min(700.0)) - 1.0,
            _ => critical.slack,
        };
        match found.iter_mut().find(|other| other.constraint == constraint) {
            Some(other) => other.slack = other.slack.min(slack),
            None if active.contains(&constraint) => {}
            None => found.push(InactiveJson {
                constraint,
                label: critical.requirement.label(problem),
                slack,
            }),
        }
    }
    found
}

fn why_not(problem: &LocalProblem, polished: &Polished, prices: &[Price], wished: f64) -> WhyNotJson {
    let log_deficit = problem.goal_sign() * libm::log(wished / polished.objective);
    let relaxations = match log_deficit < 0.0 {
        true => problem.relaxations(polished, prices, wished),
        false => Vec::new(),
    };
    let of = |relaxation: &Relaxation| RelaxationJson {
        parameter: match &relaxation.of {
            RelaxationOf::Single(parameter) => parameter.name(problem.question()),
            RelaxationOf::AllThresholds => "all_thresholds".to_owned(),
            RelaxationOf::LeastNorm => "least_norm".to_owned(),
        },
        linear: relaxation.linear,
        needed: relaxation.needed,
        objective: relaxation.objective,
        design: relaxation.design.to_string(),
        home_phi_deg: relaxation.home.to_degrees().rem_euclid(360.0),
    };
    WhyNotJson {
        wished,
        log_deficit,
        relaxations: relaxations.iter().map(of).collect(),
    }
}
