//! A design as the unknown of a local problem: what may change, what is minimised, and what has to hold.

use std::sync::{Arc, OnceLock};

use kinefront_model::evaluation::{Bound, Model, PoseScalar, Quantity, QuantityLimit, ScalarSet};
use kinefront_model::mechanism::{AnyLeg, Architecture, Design, DesignVariable, Leg};
use kinefront_model::workspace::GridError;

use super::place::{Area, Density, Spots};
use super::prepared::Prepared;
use super::question::{FreeVariable, LocalQuestion};
use super::requirement::{End, Requirement};

/// Least radius of a bar in a local problem \[m\]: its logarithm is an unknown.
const THINNEST: f64 = 1e-9;

/// Why a design has no local problem.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum LocalError {
    /// The first objective is not one that a local problem minimises.
    #[error(
        "{} is the first objective; a local optimum can be computed only for a mass, the height, the workspace radius, or the worst value of a scalar \
         over the poses",
        .0.entry().key
    )]
    Objective(Quantity),
    /// The region is the largest disc, whose radius must be stated.
    #[error("the region is the largest disc; its radius must be known")]
    NoRadius,
    /// A grid does not fit the workspace.
    #[error(transparent)]
    Grid(#[from] GridError),
}

/// What is minimised or maximised, by its logarithm.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Goal {
    /// A quantity of the design.
    Design(Quantity),
    /// The radius of the disc, which is an unknown.
    Radius,
    /// The limit of a scalar, which is an unknown.
    Level(PoseScalar),
}

/// A [`LocalQuestion`], prepared for many designs of one architecture.
#[derive(Debug, Clone)]
pub struct LocalProblem {
    pub(crate) question: LocalQuestion,
    pub(crate) model: Model,
    area: Area,
    goal: Goal,
    /// The design whose other variables are kept.
    start: Design,
    requirements: Vec<Requirement>,
    is_three_fold: bool,
    /// Spots that cover the region, for each [`Density`], once they are asked for.
    spots: Arc<[OnceLock<Spots>; 2]>,
}

impl LocalProblem {
    /// Prepares a question for the designs that have the architecture of `start`, and its values of all variables that are not free.
    ///
    /// # Errors
    /// [`LocalError`] if the question is none.
    pub fn new(question: LocalQuestion, start: &Design) -> Result<Self, LocalError> {
        let model = Model::new(question.settings.clone())?;
        let goal = match question.objective.quantity {
            quantity if model.quantity_of_dimensions(quantity, start).is_some() => Goal::Design(quantity),
            Quantity::WorkspaceRadius => Goal::Radius,
            Quantity::Worst(scalar) if scalar.bounds_poses() || scalar == PoseScalar::Footprint => Goal::Level(scalar),
            other => return Err(LocalError::Objective(other)),
        };
        let area = Area::new(&question.workspace.region).ok_or(LocalError::NoRadius)?;
        let is_three_fold = matches!(area, Area::Disc(_)) && model.is_symmetric(start);
        let mut problem = Self {
            spots: Arc::default(),
            is_three_fold,
            requirements: Vec::new(),
            question,
            model,
            area,
            goal,
            start: *start,
        };
        problem.requirements = problem.all_requirements();
        Ok(problem)
    }

    /// Returns the problem with another question: of the same objective, and for the same region but for its size.
    ///
    /// # Errors
    /// As [`LocalProblem::new`].
    pub fn with_question(&self, question: LocalQuestion) -> Result<Self, LocalError> {
        let area = Area::new(&question.workspace.region).ok_or(LocalError::NoRadius)?;
        let mut problem = Self {
            model: Model::new(question.settings.clone())?,
            area,
            question,
            ..self.clone()
        };
        problem.requirements = problem.all_requirements();
        Ok(problem)
    }

    /// The architecture of the designs.
    pub(crate) fn architecture(&self) -> Architecture {
        self.start.architecture()
    }

    /// The design whose other variables are kept.
    pub fn start(&self) -> &Design {
        &self.start
    }

    /// The question.
    pub fn question(&self) -> &LocalQuestion {
        &self.question
    }

    fn all_requirements(&self) -> Vec<Requirement> {
        let settings = &self.question.settings;
        let mut found = Vec::new();
        let legs = [0, 1, 2].map(|leg| AnyLeg::new(&self.start, &settings.legs, leg));
        if !self.question.is_of_bars {
            for (leg, any) in legs.iter().enumerate() {
                if self.architecture().has_working_modes() {
                    found.push(Requirement::EndOfReach { leg });
                }
                for (joint, limits) in any.joint_limits().iter().enumerate() {
                    if limits.is_some() {
                        found.extend([End::Lower, End::Upper].map(|end| Requirement::Limit { leg, joint, end }));
                    }
                }
            }
            found.push(Requirement::Assembly);
        }
        let limited = settings.thresholds.iter().map(|(scalar, _)| scalar);
        let level = match self.goal {
            Goal::Level(scalar) => Some(scalar),
            _ => None,
        };
        for scalar in limited.chain(level) {
            let entry = scalar.entry();
            let counts = self.model.has(&self.start, scalar) && (entry.is_of_bars || !self.question.is_of_bars);
            let requirement = Requirement::Scalar(scalar);
            if counts && scalar != PoseScalar::Reach && !found.contains(&requirement) {
                found.push(requirement);
            }
        }
        if settings
            .thresholds
            .get(PoseScalar::Dexterity)
            .is_none_or(|least| least <= 0.0)
        {
            found.push(Requirement::Determinant);
        }
        let of_designs = settings.limits.iter().enumerate();
        found.extend(of_designs.filter_map(|(place, limit)| self.requirement_of(place, limit)));
        let of_footprint = |requirement: &Requirement| requirement.scalar_in(settings) == Some(PoseScalar::Footprint);
        if found.iter().any(of_footprint) {
            found.push(Requirement::Base);
        }
        found
    }

    /// Returns the requirement that a limit of the design as a whole is; `None` if it is of no design or not part of a local problem.
    fn requirement_of(&self, place: usize, limit: &QuantityLimit) -> Option<Requirement> {
        let is_known = match limit.quantity {
            Quantity::Worst(scalar) => scalar == PoseScalar::Footprint && matches!(limit.bound, Bound::AtMost(_)),
            quantity => self.model.quantity_of_dimensions(quantity, &self.start).is_some(),
        };
        (is_known && limit.quantity.is_of(&self.start) && !self.question.is_of_bars)
            .then_some(Requirement::Quantity(place))
    }

    /// Returns the quantities whose limits are not part of the problem, because they have no value at a pose.
    pub fn left_out(&self) -> Vec<Quantity> {
        let limits = self.question.settings.limits.iter().enumerate();
        let left = limits.filter(|(place, limit)| {
            limit.quantity != Quantity::WorkspaceRadius
                && limit.quantity.is_of(&self.start)
                && self.requirement_of(*place, limit).is_none()
        });
        left.map(|(_, limit)| limit.quantity).collect()
    }

    /// The requirements.
    pub(crate) fn requirements(&self) -> &[Requirement] {
        &self.requirements
    }

    /// Spots that cover the region.
    pub(crate) fn spots(&self, density: Density) -> &Spots {
        self.spots[density as usize].get_or_init(|| self.area.spots(self.is_three_fold, density))
    }

    /// Returns whether the home orientation is an unknown.
    pub(crate) fn has_free_home(&self) -> bool {
        self.question.workspace.home_phi_deg.is_none()
    }

    /// Returns the number of unknowns.
    pub(crate) fn count(&self) -> usize {
        let level = !matches!(self.goal, Goal::Design(..));
        self.question.variables.len() + usize::from(self.has_free_home()) + usize::from(level)
    }

    /// Returns the place of the home orientation among the unknowns, if it is one.
    fn home_place(&self) -> Option<usize> {
        self.has_free_home().then_some(self.question.variables.len())
    }

    fn level_place(&self) -> usize {
        self.question.variables.len() + usize::from(self.has_free_home())
    }

    /// Returns the unknowns of a design with a home orientation \[rad\].
    pub(crate) fn unknowns(&self, design: &Design, home: f64) -> Vec<f64> {
        let of_variable = |free: &FreeVariable| unknown(free.variable, design.value(free.variable));
        let mut unknowns: Vec<f64> = self.question.variables.iter().map(of_variable).collect();
        if self.has_free_home() {
            unknowns.push(home);
        }
        match self.goal {
            Goal::Design(..) => {}
            Goal::Radius => {
                let radius = self.question.workspace.region.inscribed_radius().unwrap_or(1.0);
                unknowns.push(libm::log(radius));
            }
            Goal::Level(scalar) => {
                let stated = self.question.settings.thresholds.get(scalar).unwrap_or(1.0);
                unknowns.push(libm::log(stated.max(f64::MIN_POSITIVE)));
            }
        }
        unknowns
    }

    /// Returns the smallest and the largest value of each unknown.
    pub(crate) fn bounds(&self) -> Vec<[f64; 2]> {
        let of_variable = |free: &FreeVariable| free.range.map(|end| unknown(free.variable, end));
        let mut bounds: Vec<[f64; 2]> = self.question.variables.iter().map(of_variable).collect();
        bounds.resize(self.count(), [f64::NEG_INFINITY, f64::INFINITY]);
        bounds
    }

    /// Returns the design of some unknowns; `None` if they are no design.
    pub(crate) fn design(&self, unknowns: &[f64]) -> Option<Design> {
        let mut design = self.start;
        let mut values = design.values();
        let given: Vec<(DesignVariable, f64)> = self
            .question
            .variables
            .iter()
            .zip(unknowns)
            .flat_map(|(free, unknown)| {
                let value = at_bound(known(free.variable, *unknown), free.range);
                let tied = free.tied.iter();
                let tied = tied.map(move |(variable, factor)| (*variable, value * factor));
                std::iter::once((free.variable, value)).chain(tied)
            })
            .collect();
        for (variable, value) in &given {
            if let Some(place) = values.get_mut(*variable as usize) {
                *place = *value;
            }
        }
        design = design.with_dimensions(values).ok()?;
        let is_further = |variable: DesignVariable| variable as usize >= values.len();
        for (variable, value) in given.into_iter().filter(|(variable, _)| is_further(*variable)) {
            design = design.with(variable, value).ok()?;
        }
        Some(design)
    }

    /// Returns the value that is minimised: the logarithm of the objective, with the sign of its goal.
    pub(crate) fn minimised(&self, unknowns: &[f64]) -> f64 {
        let logarithm = match self.goal {
            Goal::Design(quantity) => {
                let design = self.design(unknowns);
                let value = design.and_then(|design| self.model.quantity_of_dimensions(quantity, &design));
                let Some(value) = value else { return f64::INFINITY };
                libm::log(value)
            }
            Goal::Radius | Goal::Level(_) => unknowns[self.level_place()],
        };
        self.goal_sign() * logarithm
    }

    /// Returns the sign with which the logarithm of the objective is minimised: 1 if less is better.
    pub fn goal_sign(&self) -> f64 {
        -self.question.objective.goal.sign()
    }

    /// Returns the value of the objective.
    pub(crate) fn objective(&self, unknowns: &[f64]) -> f64 {
        libm::exp(self.goal_sign() * self.minimised(unknowns))
    }

    /// Returns the design that is similar to one, within the bounds; `None` if it is no design.
    pub fn scaled(&self, design: &Design, factor: f64) -> Option<Design> {
        let mut free = self.question.variables.iter().filter(|free| !free.variable.is_angle());
        free.try_fold(*design, |design, free| {
            let scaled = (design.value(free.variable) * factor).clamp(free.range[0], free.range[1]);
            design.with(free.variable, scaled).ok()
        })
    }

    /// Returns the mass of a design \[kg\].
    pub fn mass_of(&self, design: &Design) -> f64 {
        self.model.mass(design)
    }

    /// Returns the objective of a design, if it is a quantity of the design as a whole.
    pub fn objective_of(&self, design: &Design) -> Option<f64> {
        self.model
            .quantity_of_dimensions(self.question.objective.quantity, design)
    }

    /// Prepares the design of some unknowns; `None` if they are no design.
    pub(crate) fn prepare(&self, unknowns: &[f64]) -> Option<Prepared> {
        let design = self.design(unknowns)?;
        let legs = [0, 1, 2].map(|leg| AnyLeg::new(&design, &self.question.settings.legs, leg));
        let compared = self.requirements.iter();
        let compared = compared.filter_map(|requirement| requirement.scalar_in(&self.question.settings));
        let compared: ScalarSet = compared.collect();
        let mut evaluator = self.model.pose_evaluator_of(&design, compared);
        compared.iter().for_each(|scalar| evaluator.ask_for(scalar));
        evaluator.leave_out_base();
        let home = match self.home_place() {
            Some(place) => unknowns[place],
            None => self.question.workspace.home_phi_deg.unwrap_or(0.0).to_radians(),
        };
        let level = match self.goal {
            Goal::Level(scalar) => Some((scalar, libm::exp(unknowns[self.level_place()]))),
            _ => None,
        };
        let area = match self.goal {
            Goal::Radius => Area::Disc(libm::exp(unknowns[self.level_place()])),
            _ => self.area.clone(),
        };
        Some(Prepared {
            design,
            home,
            area,
            half_range: 0.5 * self.question.workspace.rotation_range_deg.to_radians(),
            centre: self.question.workspace.centre,
            evaluator,
            limits: [0, 1, 2].map(|leg| legs[leg].joint_limits()),
            legs,
            level,
        })
    }

    /// Returns the limit of a scalar, or 0 if there is none.
    pub(crate) fn limit(&self, prepared: &Prepared, scalar: PoseScalar) -> f64 {
        match prepared.level {
            Some((leveled, level)) if leveled == scalar => level,
            _ => self.question.settings.thresholds.get(scalar).unwrap_or(0.0),
        }
    }

    /// Returns the excess of a quantity of the design as a whole over its limit, as a logarithm.
    pub(crate) fn excess_of_quantity(&self, prepared: &Prepared, limit: &QuantityLimit) -> Option<f64> {
        let value = self.model.quantity_of_dimensions(limit.quantity, &prepared.design)?;
        Some(excess(value, limit))
    }
}

/// Returns by how much a value keeps a limit, as a logarithm.
pub(crate) fn excess(value: f64, limit: &QuantityLimit) -> f64 {
    match limit.bound {
        Bound::AtLeast(least) => libm::log(value / least),
        Bound::AtMost(most) => libm::log(most / value),
    }
}

/// Returns the unknown that a variable is: the logarithm of a length, or an angle \[rad\].
fn unknown(variable: DesignVariable, value: f64) -> f64 {
    if variable.is_angle() {
        value.to_radians()
    } else {
        libm::log(value.max(THINNEST))
    }
}

/// Returns an end of a range in place of a value that differs from it by rounding alone.
fn at_bound(value: f64, range: [f64; 2]) -> f64 {
    let is_at = |end: &f64| (value - end).abs() <= 1e-12 * end.abs();
    range.into_iter().find(is_at).unwrap_or(value)
}

fn known(variable: DesignVariable, unknown: f64) -> f64 {
    if variable.is_angle() {
        unknown.to_degrees()
    } else {
        libm::exp(unknown)
    }
}
