//! What a study asks: its objectives and limits, the quantities that it names, and the reference point of its hypervolume.

use super::Study;
use crate::settings::ObjectiveChoice;
use kinefront_model::evaluation::{
    Better, Bound, Objective, PoseScalar, Quantity, QuantityLimit, QuantitySet, Reference, Thresholds,
};
use kinefront_model::mechanism::DesignVariable;
use kinefront_optimize::Objectives;

impl Study {
    /// Returns the objectives of the study; a study without faults has one to three.
    pub fn objectives(&self) -> Vec<Objective> {
        self.objectives.iter().filter_map(ObjectiveChoice::objective).collect()
    }

    /// Iterates over the limits of the study.
    pub fn limits(&self) -> impl Iterator<Item = QuantityLimit> {
        self.constraints.iter().flat_map(|(key, limits)| {
            let quantity = Quantity::find(key);
            let limit = move |bound| quantity.map(|quantity| QuantityLimit { quantity, bound });
            limits.bounds().filter_map(limit)
        })
    }

    /// Returns the quantities that an evaluation has to determine besides those that it always does.
    pub fn asked_quantities(&self) -> QuantitySet {
        let named = self.named_quantities();
        named.iter().filter(|quantity| !quantity.is_always_known()).collect()
    }

    /// Returns the quantities that the study names: in its objectives, its limits, and those to be reported.
    pub fn named_quantities(&self) -> QuantitySet {
        let of_objectives = self.objectives().into_iter().map(|objective| objective.quantity);
        let of_limits = self.limits().map(|limit| limit.quantity);
        let reported = self.quantities.iter().filter_map(|key| Quantity::find(key));
        let of_task = self.task.shape.map(|_| Quantity::PathReach);
        let of_drives = self
            .drives
            .catalogue
            .iter()
            .flat_map(|_| [Quantity::DriveMass, Quantity::DriveUtilization]);
        of_objectives
            .chain(of_limits)
            .chain(reported)
            .chain(of_task)
            .chain(of_drives)
            .collect()
    }

    /// Returns the quantities that describe a design of the study in brief: mass and workspace radius, which every design has, then
    /// the others that the study names.
    pub fn shown_quantities(&self) -> Vec<Quantity> {
        let of_every_study = [Quantity::Mass, Quantity::WorkspaceRadius];
        let named = self.named_quantities();
        let others = named.iter().filter(|quantity| !of_every_study.contains(quantity));
        of_every_study.into_iter().chain(others).collect()
    }

    /// Returns the limits that hold for the region as a whole, not for each of its poses.
    pub fn limits_of_designs(&self) -> Vec<QuantityLimit> {
        let stated = self.limits().filter(|limit| limited_scalar(limit).is_none());
        // A design is infeasible that does not follow the motion of the study, or for which no drive of the catalogue carries it.
        let implied = [
            (self.task.shape.is_some(), Quantity::PathReach, Bound::AtLeast(0.0)),
            (
                self.drives.catalogue.is_some(),
                Quantity::DriveUtilization,
                Bound::AtMost(1.0),
            ),
        ];
        let implied = implied.into_iter().filter(|(is_asked, quantity, _)| {
            let is_stated = |limit: QuantityLimit| limit.quantity == *quantity;
            *is_asked && !self.limits().any(is_stated)
        });
        let implied = implied.map(|(_, quantity, bound)| QuantityLimit { quantity, bound });
        stated.chain(implied).collect()
    }

    /// Applies the limits that hold for each pose to thresholds.
    pub(crate) fn bound_poses(&self, thresholds: &mut Thresholds) {
        for limit in self.limits() {
            if let Some(scalar) = limited_scalar(&limit) {
                thresholds.set(scalar, Some(limit.threshold()));
            }
        }
    }

    /// Returns the reference point of the hypervolume, as it is minimised: the reference mass \[kg\] and 0 for the paper's
    /// objectives.
    pub fn hypervolume_reference(&self) -> Objectives {
        let of_objective = |(place, objective): (usize, Objective)| {
            let stated = self.hypervolume.reference.iter().flatten().nth(place);
            let value = stated.copied().unwrap_or(match objective.goal {
                Better::Higher => 0.0,
                Better::Lower => self.exceeded(objective.quantity),
            });
            objective.minimised(Some(value))
        };
        Objectives::new(self.objectives().into_iter().enumerate().map(of_objective))
    }

    /// Returns a value of a quantity that few designs exceed.
    fn exceeded(&self, quantity: Quantity) -> f64 {
        match quantity.entry().reference {
            Reference::Number(number) => number,
            Reference::Mass => self.hypervolume.reference_mass_kg,
            Reference::BaseRadius(factor) => factor * self.range(DesignVariable::BaseRadius)[1],
            Reference::LinkLength(factor) => factor * self.range(DesignVariable::LinkLength)[1],
            Reference::BarRadius(factor) => factor * self.thickest_bars().into_iter().fold(0.0, f64::max),
            Reference::Displacement(factor) => factor * self.requirements.in_plane_displacement_m,
            Reference::Limit(factor) => match quantity {
                Quantity::Worst(scalar) => factor * self.thresholds().get(scalar).unwrap_or(1.0),
                _ => factor,
            },
        }
    }

    /// Returns the best value so far of the only objective, by the hypervolume; `None` for several objectives, or before a design is
    /// feasible.
    pub fn best_value(&self, hypervolume: f64) -> Option<(Objective, f64)> {
        let [objective] = self.objectives()[..] else {
            return None;
        };
        let value = objective.value(self.hypervolume_reference()[0] - hypervolume);
        (hypervolume > 0.0).then_some((objective, value))
    }

    /// Returns the unit of the hypervolume: the product of the units of the objectives.
    pub fn hypervolume_unit(&self) -> String {
        let units = self
            .objectives()
            .into_iter()
            .map(|objective| objective.quantity.entry().unit);
        let units: Vec<&str> = units.filter(|unit| !unit.is_empty()).collect();
        units.join("·")
    }
}

/// Returns the scalar that a limit bounds at each pose of the region: that of the least value over poses from below, or that of the
/// largest value from above.
fn limited_scalar(limit: &QuantityLimit) -> Option<PoseScalar> {
    let Quantity::Worst(scalar) = limit.quantity else {
        return None;
    };
    let from = match limit.bound {
        Bound::AtLeast(_) => Better::Higher,
        Bound::AtMost(_) => Better::Lower,
    };
    (scalar.bounds_poses() && scalar.entry().quantity.better == from).then_some(scalar)
}
