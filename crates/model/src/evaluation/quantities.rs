//! The values of the quantities of a design (docs/model.md, section 6.5).

use super::worst::{ConstraintSearch, padded};
use super::{
    Constraint, ConstraintResult, Evaluation, LimitResult, Model, PoseScalar, Quantity, QuantityValues, SelectedDrive,
    TaskOutcome, largest_of_legs,
};
use crate::dynamics::TaskFrame;
use crate::mechanism::{Design, Leg};
use crate::pose::{PoseChecker, ScalarSet};
use crate::spatial::Pose;
use crate::workers::{OneWorker, Workers, map};
use crate::workspace::{Grid, Positions, RegularWorkspace, ValueColumns};

/// Returns the quantities of a design that its constraints and dimensions determine, as far as the study asks for them.
pub(super) fn known(
    model: &Model,
    height: f64,
    design: &Design,
    workspace_radius: f64,
    constraints: &[ConstraintResult; Constraint::COUNT],
) -> QuantityValues {
    let asked = |quantity: Quantity| quantity.is_always_known() || model.settings().quantities.contains(quantity);
    let mut values = QuantityValues::default();
    for quantity in Quantity::all().filter(|quantity| asked(*quantity)) {
        let value = match quantity {
            Quantity::Height => Some(height),
            Quantity::WorkspaceRadius => Some(workspace_radius),
            Quantity::Assembly | Quantity::Worst(_) => {
                let constraint = quantity.constraint();
                constraint.and_then(|constraint| constraints[constraint as usize].value)
            }
            // Others are of the region or of a motion, which only some designs have.
            other => model.quantity_of_dimensions(other, design),
        };
        values.set(quantity, value);
    }
    values
}

impl Model {
    /// Returns a quantity that the dimensions of a design determine alone, without any pose; `None` of any other quantity.
    pub fn quantity_of_dimensions(&self, quantity: Quantity, design: &Design) -> Option<f64> {
        match quantity {
            Quantity::Mass => Some(self.mass(design)),
            Quantity::LegsMass => Some(self.legs_mass(design)),
            Quantity::PlatformMass => Some(self.platform_mass(design)),
            Quantity::Height => Some(self.bodies_of(design).height()),
            _ => None,
        }
    }
}

/// Adds those quantities over the region of a design that the study asks for.
pub(super) fn add_of_region<L: Leg>(
    values: &mut QuantityValues,
    search: &ConstraintSearch<'_, L>,
    home: usize,
    grid: &Grid,
) {
    let &ConstraintSearch {
        model,
        checker,
        design,
        found,
        workers,
    } = search;
    let positions = &search.positions(grid);
    let asked = |quantity: Quantity| model.settings().quantities.contains(quantity);
    if asked(Quantity::FrameFrequency) {
        let pose = pose_of_lowest_frequency(checker, found, home, positions);
        let frequency = pose.and_then(|pose| model.frame_frequency(design, &pose));
        values.set(Quantity::FrameFrequency, frequency);
    }
    if asked(Quantity::DexterityMean) {
        let mean = dexterity_mean(model, checker, found, home, grid);
        values.set(Quantity::DexterityMean, Some(mean));
    }
    let on_demand = PoseScalar::on_demand().iter().copied();
    let set: ScalarSet = on_demand.filter(|scalar| asked(Quantity::Worst(*scalar))).collect();
    if set.is_empty() {
        return;
    }
    // The search of a prescribed region knows the limited ones that take long.
    let searched = if found.slow.is_empty() {
        ScalarSet::default()
    } else {
        checker.slow_limits()
    };
    let left: ScalarSet = set.iter().filter(|scalar| !searched.contains(*scalar)).collect();
    let window: Vec<usize> = found.orientation_grid.window(home).collect();
    let mut least = least_over(checker, found, left, &window, positions, workers);
    for index in window {
        for scalar in set.iter().filter(|scalar| searched.contains(*scalar)) {
            let least = &mut least[scalar as usize];
            *least = least.min(found.slow[index][scalar]);
        }
    }
    for scalar in set.iter() {
        let value = scalar.entry().quantity.better.sign() * least[scalar as usize];
        values.set(Quantity::Worst(scalar), Some(value));
    }
}

/// Returns the smallest values of some scalars, each with the sign with which more is better, over positions in some orientations.
fn least_over<L: Leg>(
    checker: &PoseChecker<L>,
    found: &RegularWorkspace,
    set: ScalarSet,
    orientations: &[usize],
    positions: &Positions,
    workers: &dyn Workers,
) -> [f64; PoseScalar::COUNT] {
    let mut least = [f64::INFINITY; PoseScalar::COUNT];
    if set.is_empty() {
        return least;
    }
    let indices = positions.indices();
    let of_orientation = |index: &usize| {
        let arms = &found.orientations[*index].arms;
        checker.worst(set, arms, &positions.xs, &positions.ys, &indices)
    };
    for minima in map(workers, orientations, of_orientation) {
        for (least, minimum) in least.iter_mut().zip(minima) {
            *least = least.min(minimum.value);
        }
    }
    least
}

/// Adds the values of the limits of an infeasible design that have none: the worst over a prescribed region in the best home orientation, or
/// the value at the pose at which the constraints are reported. A limit whose scalar has no value there keeps none.
pub(super) fn add_to_limits<L: Leg>(
    evaluation: &mut Evaluation,
    model: &Model,
    checker: &PoseChecker<L>,
    found: &RegularWorkspace,
) {
    let scalar_of = |limit: &LimitResult| match (limit.value, limit.limit.quantity) {
        (None, Quantity::Worst(scalar)) => Some(scalar),
        _ => None,
    };
    let set: ScalarSet = evaluation.limits.iter().filter_map(scalar_of).collect();
    let (positions, orientations): (Positions, Vec<usize>) = match found.home {
        Some(home) if !found.samples.is_empty() => {
            let window = found.orientation_grid.window(home);
            (padded(found.samples.iter().copied()), window.collect())
        }
        _ => {
            let pose = evaluation.constraint(Constraint::Reach).pose;
            let is_reported = |index: &usize| {
                let phi = found.orientations[*index].phi_deg.to_radians();
                pose.is_some_and(|pose| (phi - pose.phi).abs() < 1e-9)
            };
            let reported = (0..found.orientations.len()).find(is_reported);
            let centre = model.settings().workspace.centre;
            (padded([centre]), reported.into_iter().collect())
        }
    };
    let least = least_over(checker, found, set, &orientations, &positions, &OneWorker);
    for limit in &mut evaluation.limits {
        if let Some(scalar) = scalar_of(limit)
            && least[scalar as usize].is_finite()
        {
            let value = scalar.entry().quantity.better.sign() * least[scalar as usize];
            *limit = limit.limit.result(Some(value));
        }
    }
}

/// Adds those quantities of the motion of a study that it asks for, and returns the drive that the design selects for it. A motor that
/// moves has the mass of that drive.
pub(super) fn add_of_task(
    values: &mut QuantityValues,
    model: &Model,
    design: &Design,
    frame: &TaskFrame,
) -> Option<SelectedDrive> {
    let settings = model.settings();
    let asked = Quantity::OF_TASK
        .into_iter()
        .filter(|quantity| settings.quantities.contains(*quantity));
    let asked: Vec<Quantity> = asked.collect();
    let task = settings.task.as_ref()?;
    if asked.is_empty() && settings.drive_catalogue.is_empty() {
        return None;
    }
    let (outcome, _) = model.follow_driven(design, task, frame);
    if let Some(Err(failure)) = &outcome.result
        && asked.contains(&Quantity::PathReach)
    {
        values.set(Quantity::PathReach, Some(failure.path_reach));
        return None;
    }
    for quantity in asked {
        values.set(quantity, of_task(quantity, model, design, &outcome));
    }
    let selected = outcome.drive?;
    let drive = settings.drive_catalogue.get(selected.place)?;
    let more = model.drive_mass(design.architecture(), drive);
    for quantity in [Quantity::Mass, Quantity::LegsMass] {
        values.set(quantity, values.get(quantity).map(|mass| mass + more));
    }
    Some(selected)
}

/// Returns a quantity of a motion; `None` if the design does not follow the motion, or if it does not have the quantity.
pub(super) fn of_task(quantity: Quantity, model: &Model, design: &Design, outcome: &TaskOutcome) -> Option<f64> {
    let figures = outcome.figures()?;
    let value = match quantity {
        Quantity::CycleTime => outcome.motion.as_ref()?.cycle_time(),
        Quantity::PathReach => figures.path_reach,
        Quantity::CycleEnergy => figures.energy_shared,
        Quantity::CornerPower => figures.corner_power,
        Quantity::PathSpeed | Quantity::PathRate => largest_of_legs(figures.peak_speed),
        Quantity::PathForce | Quantity::PathTorque => largest_of_legs(figures.peak_force),
        Quantity::PathForceRms | Quantity::PathTorqueRms => largest_of_legs(figures.rms_force),
        Quantity::DriveMass => model.settings().drive_catalogue.get(outcome.drive?.place)?.mass,
        Quantity::DriveUtilization => outcome.drive?.utilization,
        _ => return None,
    };
    quantity.is_of(design).then_some(value)
}

/// Returns the pose of the region at which the condensed frame has the lowest natural frequency.
fn pose_of_lowest_frequency<L: Leg>(
    checker: &PoseChecker<L>,
    found: &RegularWorkspace,
    home: usize,
    positions: &Positions,
) -> Option<Pose> {
    let set: ScalarSet = [PoseScalar::NaturalFrequency].into_iter().collect();
    let indices = positions.indices();
    let mut lowest = (f64::INFINITY, None);
    for orientation in found.orientation_grid.window(home) {
        let orientation = &found.orientations[orientation];
        let minima = checker.worst(set, &orientation.arms, &positions.xs, &positions.ys, &indices);
        let lowest_here = &minima[PoseScalar::NaturalFrequency as usize];
        let (value, index) = (lowest_here.value, lowest_here.index);
        if value < lowest.0 {
            let phi = orientation.phi_deg.to_radians();
            lowest = (value, Some(Pose::new(positions.xs[index], positions.ys[index], phi)));
        }
    }
    lowest.1
}

/// Returns the mean inverse condition number over the region and the window: each position is weighted by its area, and each
/// orientation by its step, of which the ends of the window have half.
fn dexterity_mean<L: Leg>(
    model: &Model,
    checker: &PoseChecker<L>,
    found: &RegularWorkspace,
    home: usize,
    grid: &Grid,
) -> f64 {
    let spec = &model.settings().workspace;
    let spacing = checker.base_radius / grid.ray_steps() as f64;
    let rings = if found.samples.is_empty() {
        (found.radius / spacing).ceil().clamp(1.0, MEAN_RINGS) as usize
    } else {
        MEAN_RINGS as usize
    };
    let weighted = spec
        .region
        .quadrature(spec.centre, found.radius, rings, &found.directions);
    let positions = padded(weighted.iter().map(|(place, _)| *place));
    let mut columns = ValueColumns::default();
    let window: Vec<usize> = found.orientation_grid.window(home).collect();
    let (mut sum, mut total) = (0.0, 0.0);
    for (place, &index) in window.iter().enumerate() {
        let arms = &found.orientations[index].arms;
        checker.at_positions(arms, &positions.xs, &positions.ys, &mut columns);
        let mean: f64 = columns
            .column(PoseScalar::Dexterity)
            .iter()
            .zip(&weighted)
            .map(|(value, (_, weight))| weight * value)
            .sum();
        let is_end = window.len() > 1 && (place == 0 || place + 1 == window.len());
        let weight = if is_end { 0.5 } else { 1.0 };
        sum += weight * mean;
        total += weight;
    }
    sum / total
}

/// Largest number of rings, or half the number of lattice cells along a side, over which the mean is taken.
const MEAN_RINGS: f64 = 24.0;
