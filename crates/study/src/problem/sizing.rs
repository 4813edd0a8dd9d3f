//! What follows from the geometry of a design: the lightest bars, and for a prescribed region the scale.

use super::{BARS, DesignProblem, Dimensions, LENGTHS};
use kinefront_model::evaluation::{
    Better, Bound, Evaluation, GridChoice, Objective, PoseScalar, Quantity, QuantityLimit, SizingRanges,
    WorkspaceTarget,
};
use kinefront_model::mechanism::{DESIGN_VARIABLES, Design, DesignVariable};

impl DesignProblem {
    /// Whether the mass is an objective and no objective asks for thick bars, so that the lightest bars are best.
    pub(super) fn seeks_light_bars(&self) -> bool {
        let asks_for_stiffness = |objective: &Objective| match objective.quantity {
            Quantity::Worst(scalar) => scalar.entry().is_of_bars,
            _ => false,
        };
        let is_mass = |objective: &Objective| objective.quantity == Quantity::Mass && objective.goal == Better::Lower;
        let objectives = &self.model.settings().objectives;
        objectives.iter().any(is_mass) && !objectives.iter().any(asks_for_stiffness)
    }

    /// Whether a prescribed region and the least mass determine the scale of a geometry: of all that the study asks, only masses
    /// and the footprint depend on it.
    pub(super) fn may_scale(&self) -> bool {
        let grows_with_scale = |limit: &QuantityLimit| {
            let quantities = [
                Quantity::Mass,
                Quantity::LegsMass,
                Quantity::PlatformMass,
                Quantity::Worst(PoseScalar::Footprint),
            ];
            matches!(limit.bound, Bound::AtMost(_)) && quantities.contains(&limit.quantity)
        };
        let is_free = |length: &DesignVariable| {
            let [lower, upper] = self.ranges[*length as usize];
            let has_range = match self.ties[*length as usize] {
                Some(tie) => !BARS.contains(&tie.source),
                None => lower < upper,
            };
            has_range && self.listed[*length as usize].is_none()
        };
        self.is_prescribed
            && self.model.settings().objectives.len() == 1
            && self.seeks_light_bars()
            && self.model.is_free_of_scale()
            && self.model.settings().limits.iter().all(grows_with_scale)
            && LENGTHS.iter().all(is_free)
            && self.further.iter().all(|(variable, _)| variable.is_angle())
    }

    /// The lengths that follow from no other variable.
    pub(super) fn untied_lengths(&self) -> impl Iterator<Item = DesignVariable> {
        LENGTHS
            .into_iter()
            .filter(|length| self.ties[*length as usize].is_none())
    }

    /// Returns what sizing a design may change.
    pub(super) fn sizing_ranges(&self, design: &Design) -> SizingRanges {
        let [leg, platform] = BARS.map(|bar| self.ranges[bar as usize]);
        let scale = if self.may_scale() {
            self.untied_lengths()
                .fold([0.0, f64::INFINITY], |[least, most], length| {
                    let value = design.values()[length as usize];
                    let [lower, upper] = self.ranges[length as usize].map(|bound| bound / value);
                    [lower.max(least), upper.min(most)]
                })
        } else {
            [1.0; 2]
        };
        SizingRanges {
            leg,
            platform,
            listed: BARS.map(|bar| self.listed[bar as usize].clone()),
            is_exact: self.model.settings().objectives.len() == 1,
            scale,
        }
    }

    /// Evaluates a design on the fine grid. A design for a prescribed region that does not hold it there, because it was sized for
    /// the poses of the reference grid, is sized again; it is then another one.
    pub fn verify(&self, design: &Design) -> Evaluation {
        let evaluation = self.model.evaluate(design, GridChoice::Fine);
        if evaluation.is_feasible() || !self.is_prescribed || !self.seeks_light_bars() {
            return evaluation;
        }
        let target = WorkspaceTarget::Prescribed(GridChoice::Fine);
        let resized = self
            .model
            .sized(design, &self.sizing_ranges(design), target)
            .and_then(|sized| {
                let values = self.with_ties_raised(&sized);
                sized.with_dimensions(values).ok()
            });
        match resized.map(|design| self.model.evaluate(&design, GridChoice::Fine)) {
            Some(resized) if resized.is_feasible() => resized,
            _ => evaluation,
        }
    }

    /// Raises the radius that a bar is tied to, if the bar needs more, so that the tie does not weaken sized bars.
    pub(super) fn with_ties_raised(&self, design: &Design) -> Dimensions {
        let mut values = design.values();
        for (variable, tie) in DESIGN_VARIABLES.into_iter().zip(&self.ties) {
            if let Some(tie) = tie
                && variable.may_be_zero()
                && tie.source.may_be_zero()
            {
                let needed = values[variable as usize] / tie.factor;
                let source = &mut values[tie.source as usize];
                *source = source.max(needed);
            }
        }
        self.settled(values)
    }
}
