//! The worst values of the constraints of a design and the poses where they occur, derived from the search of its workspace; which
//! constraints are active, and by how much they are violated.

use glam::DVec2;

use super::{Better, Constraint, ConstraintResult, Model, PoseScalar, PoseValues};
use crate::clearance::Clearance;
use crate::mechanism::{Design, Leg};
use crate::pose::{PoseChecker, ScalarSet};
use crate::spatial::Pose;
use crate::workers::{Workers, map};
use crate::workspace::{Grid, OrientationLanes, Positions, RegularWorkspace, ValueColumns};

/// Largest number of rings of a disc, besides its centre, on which values are evaluated; smooth fields need no more.
const MAX_RINGS: f64 = 24.0;

/// Smallest violation of an infeasible design: 0 is reserved for feasible designs.
const SMALLEST_VIOLATION: f64 = 1e-9;

/// Margins that differ from the worst one by no more than this are active over a prescribed region.
const ACTIVE: f64 = 1e-3;

/// Looks for the worst values of the constraints of a design whose workspace was searched.
pub(super) struct ConstraintSearch<'a, L> {
    pub model: &'a Model,
    pub checker: &'a PoseChecker<L>,
    pub design: &'a Design,
    pub found: &'a RegularWorkspace,
    /// Threads for the orientations of a window.
    pub workers: &'a dyn Workers,
}

/// Returns the centre of a disc, and the positions on equal rings about it in some directions, direction by direction. The rings are no
/// farther from each other than `spacing`, unless that needs more than [`MAX_RINGS`].
pub(super) fn positions_in_disc(
    centre: DVec2,
    directions: &[DVec2],
    radius: f64,
    spacing: f64,
) -> impl Iterator<Item = DVec2> {
    let rings = (radius / spacing).ceil().clamp(1.0, MAX_RINGS) as usize;
    let on_rings = directions.iter().flat_map(move |direction| {
        (1..=rings).map(move |ring| {
            // The radius of the last ring equals that of the rim to the bit.
            let radius = if ring == rings {
                radius
            } else {
                radius * ring as f64 / rings as f64
            };
            centre + *direction * radius
        })
    });
    std::iter::once(centre).chain(on_rings)
}

/// Returns positions in columns of the length that loops read.
pub(super) fn padded(positions: impl IntoIterator<Item = DVec2>) -> Positions {
    let mut columns = Positions::default();
    for position in positions {
        columns.push(position);
    }
    columns.pad();
    columns
}

type ConstraintResults = [ConstraintResult; Constraint::COUNT];

impl<L: Leg> ConstraintSearch<'_, L> {
    /// Returns the nearest pair of members at a pose that the search has found reachable.
    pub fn nearest(&self, pose: Pose) -> Option<Clearance> {
        // At the very end of a leg's reach, rounding decides whether the leg reaches the pose; slightly nearer to the
        // centre it does, or, at the centre, slightly beside it.
        let step = 1e-9 * self.design.base_radius();
        let inwards = (self.model.settings().workspace.centre - pose.position).clamp_length_max(step);
        let aside = [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y].map(|direction| step * direction);
        let manipulator = &self.checker.manipulator;
        [DVec2::ZERO, inwards].into_iter().chain(aside).find_map(|way| {
            let position = pose.position + way;
            let posture = manipulator.posture(&Pose { position, ..pose }).ok()?;
            Some(self.checker.bodies.nearest(manipulator, position, &posture))
        })
    }

    /// Returns reports without values, except for g1, which needs no pose.
    fn blank(&self) -> ConstraintResults {
        Constraint::ALL.map(|constraint| {
            let threshold = constraint.threshold(&self.checker.assembly, &self.checker.thresholds);
            let value = matches!(constraint, Constraint::Assembly).then_some(self.checker.assembly.value);
            ConstraintResult {
                constraint,
                value,
                threshold,
                required: constraint.is_required(&self.checker.thresholds),
                margin: value.map_or(-1.0, |value| constraint.margin(value, threshold, self.design)),
                active: value.is_some_and(|value| !constraint.holds(value, threshold)),
                pose: None,
            }
        })
    }

    /// Lowers the reports to the values at one pose, with `det A` multiplied by `sign`.
    fn visit(
        &self,
        reports: &mut ConstraintResults,
        values: &Result<PoseValues, f64>,
        pose: impl Fn() -> Pose,
        sign: f64,
    ) {
        for report in reports {
            if let Some(value) = self.value(report.constraint, values, sign) {
                self.lower(report, value, &pose);
            }
        }
    }

    /// Lowers a report to the value at a pose, if that is smaller.
    fn lower(&self, report: &mut ConstraintResult, value: f64, pose: impl FnOnce() -> Pose) {
        let is_worse = |than: f64| match report.constraint.better() {
            Better::Higher => value < than,
            Better::Lower => value > than,
        };
        if report.value.is_none_or(is_worse) {
            report.value = Some(value);
            report.margin = report.constraint.margin(value, report.threshold, self.design);
            report.pose = Some(pose());
        }
    }

    /// Returns the value of a constraint at one pose; `None` for g1, which needs no pose, and for values that do not
    /// exist at an unreachable pose.
    #[inline]
    fn value(&self, constraint: Constraint, values: &Result<PoseValues, f64>, sign: f64) -> Option<f64> {
        match (constraint, values) {
            (Constraint::Assembly, _) => None,
            (_, Ok(values)) => constraint.value(values, sign),
            (Constraint::Reach, Err(limit_margin)) => Some(*limit_margin),
            (_, Err(_)) => None,
        }
    }

    /// Marks as active the constraints that fail at one pose.
    fn mark_failing(&self, reports: &mut ConstraintResults, values: &Result<PoseValues, f64>, sign: f64) {
        for report in reports {
            // A limit margin of exactly 0 can belong to an unreachable pose (a leg at its very end, or without length).
            let unreached = report.constraint == Constraint::Reach && values.is_err();
            let broken = |value: f64| !report.constraint.holds(value, report.threshold);
            let value = self.value(report.constraint, values, sign);
            report.active |= unreached || report.required && value.is_some_and(broken);
        }
    }

    /// Returns the positions over which the smallest values are determined, padded.
    pub fn positions(&self, grid: &Grid) -> Positions {
        let found = self.found;
        if !found.samples.is_empty() {
            return padded(found.samples.iter().copied());
        }
        let centre = self.model.settings().workspace.centre;
        let spacing = self.design.base_radius() / grid.ray_steps() as f64;
        padded(positions_in_disc(centre, &found.directions, found.radius, spacing))
    }

    /// Returns the reports of the constraints, the violation, and the home orientation of a design that has a workspace; `worst` is the worst
    /// margin over a region, if the study prescribes one.
    pub fn report(&self, worst: Option<f64>, grid: &Grid) -> (ConstraintResults, f64, Option<usize>) {
        let assembly = &self.checker.assembly;
        match (self.found.home, worst) {
            (Some(home), None) if assembly.value >= assembly.threshold => {
                (self.over_workspace(home, grid), 0.0, Some(home))
            }
            (Some(home), Some(worst)) => {
                let (constraints, violation) = self.over_region(home, worst);
                (constraints, violation, Some(home).filter(|_| violation == 0.0))
            }
            _ => {
                let (constraints, violation) = self.at_best_centre();
                (constraints, violation, None)
            }
        }
    }

    /// Returns the smallest values over the regular workspace. The constraints that fail just beyond it are active.
    fn over_workspace(&self, home: usize, grid: &Grid) -> ConstraintResults {
        let mut reports = self.smallest_over(home, &self.positions(grid));
        self.mark_beyond(&mut reports, self.found.home_sign);
        reports
    }

    /// Returns the smallest values over a prescribed region whose worst margin is `worst`, and the violation. The constraints
    /// with the worst margin are active.
    fn over_region(&self, home: usize, worst: f64) -> (ConstraintResults, f64) {
        let mut reports = self.smallest_over(home, &padded(self.found.samples.iter().copied()));
        let near = worst + ACTIVE;
        for report in &mut reports {
            report.active |= report.required && report.pose.is_some() && report.margin <= near;
        }
        let assembly = (-reports[Constraint::Assembly as usize].margin).max(0.0);
        let violation = if worst >= 0.0 {
            0.0
        } else {
            (-worst).max(SMALLEST_VIOLATION)
        };
        (reports, violation + assembly)
    }

    fn smallest_over(&self, home: usize, disc: &Positions) -> ConstraintResults {
        let found = self.found;
        let sign = found.home_sign;
        let mut reports = self.blank();
        let indices = disc.indices();
        let of_reports = reports.iter().filter(|report| report.required);
        let scalars = of_reports.filter_map(|report| report.constraint.scalar());
        let further: ScalarSet = scalars.filter(|scalar| !PoseScalar::ALWAYS.contains(scalar)).collect();
        let window: Vec<usize> = found.orientation_grid.window(home).collect();
        for part in window.chunks(self.workers.count().max(1)) {
            let clearance = reports[Constraint::Clearance as usize].value.unwrap_or(f64::INFINITY);
            let of_orientation = |index: &usize| {
                let arms = &found.orientations[*index].arms;
                let oriented = OrientationLanes { arms, sign };
                let minima = self.checker.smallest(oriented, &disc.xs, &disc.ys, &indices, clearance);
                (minima, self.checker.worst(further, arms, &disc.xs, &disc.ys, &indices))
            };
            for (index, (minima, further)) in part.iter().zip(map(self.workers, part, of_orientation)) {
                for report in &mut reports {
                    let Some(scalar) = report.constraint.scalar() else {
                        continue;
                    };
                    let (minimum, sign) = match minima.get(scalar as usize) {
                        Some(minimum) => (*minimum, 1.0),
                        None if report.required => (further[scalar as usize], scalar.entry().quantity.better.sign()),
                        None => continue,
                    };
                    if minimum.value.is_finite() {
                        let (x, y) = (disc.xs[minimum.index], disc.ys[minimum.index]);
                        let pose = || Pose::new(x, y, found.orientations[*index].phi_deg.to_radians());
                        self.lower(report, sign * minimum.value, pose);
                    }
                }
            }
        }
        reports
    }

    /// Marks as active the constraints that fail just beyond the workspace radius, in the orientations that limit it.
    fn mark_beyond(&self, reports: &mut ConstraintResults, sign: f64) {
        self.look_beyond(|_, _, values| self.mark_failing(reports, values, sign));
    }

    /// Shows the poses just beyond the limits that the search has recorded: the place of the orientation, the position, and the values.
    fn look_beyond(&self, mut show: impl FnMut(usize, DVec2, &Result<PoseValues, f64>)) {
        let centre = self.model.settings().workspace.centre;
        let mut values = ValueColumns::default();
        for &(index, beyond) in &self.found.limits {
            let rim = || {
                self.found
                    .directions
                    .iter()
                    .map(|direction| centre + *direction * beyond)
            };
            let columns = padded(rim());
            let arms = &self.found.orientations[index].arms;
            self.checker.at_positions(arms, &columns.xs, &columns.ys, &mut values);
            for (at, position) in rim().enumerate() {
                show(index, position, &values.get(at));
            }
        }
    }

    /// Returns the values at the centre pose of the best orientation of a design without a workspace, and its
    /// violation.
    ///
    /// The best orientation is the one with the smallest shortfall at the centre, the best window the one with the
    /// smallest mean shortfall. The constraints that fail at a centre pose of the best window are active; if there are
    /// none, those that fail just beyond the limits that the search recorded.
    fn at_best_centre(&self) -> (ConstraintResults, f64) {
        let found = self.found;
        let centre = self.model.settings().workspace.centre;
        let shortfalls: Vec<(f64, f64)> = (0..found.orientations.len())
            .map(|index| self.shortfall(&found.centres.get(index)))
            .collect();
        let best = smallest(shortfalls.iter().map(|(shortfall, _)| *shortfall)).unwrap_or(0);
        let homes = found.orientation_grid.homes();
        let mean = |home: usize| {
            let (mut sum, mut count, mut signs) = (0.0, 0.0, [false; 2]);
            for index in found.orientation_grid.window(home) {
                let (shortfall, sign) = shortfalls[index];
                sum += shortfall;
                count += 1.0;
                signs[usize::from(sign > 0.0)] |= sign != 0.0;
            }
            // A window with both signs is cut by a singularity, which counts as much as a constraint that is missed
            // entirely.
            sum / count + if signs == [true; 2] { 1.0 } else { 0.0 }
        };
        let best_home = homes.start + smallest(homes.clone().map(mean)).unwrap_or(0);

        let mut reports = self.blank();
        let sign_of = |index: usize| if shortfalls[index].1 < 0.0 { -1.0 } else { 1.0 };
        let phi = found.orientations[best].phi_deg.to_radians();
        let pose = || Pose::new(centre.x, centre.y, phi);
        self.visit(&mut reports, &found.centres.get(best), pose, sign_of(best));
        // The search has not computed the clearance if it is not required.
        if let Ok(posture) = self
            .checker
            .manipulator
            .posture_at(centre, &found.orientations[best].arms)
        {
            let clearance = self.checker.nearest(centre, &posture).distance;
            self.lower(&mut reports[Constraint::Clearance as usize], clearance, pose);
        }
        for index in found.orientation_grid.window(best_home) {
            self.mark_failing(&mut reports, &found.centres.get(index), sign_of(best_home));
        }
        if !reports.iter().any(|report| report.active) {
            self.mark_beyond(&mut reports, sign_of(best_home));
        }
        if !reports.iter().any(|report| report.required && report.margin < 0.0) {
            self.visit_window(&mut reports, best_home, sign_of(best_home));
        }
        let assembly = (-reports[Constraint::Assembly as usize].margin).max(0.0);
        (reports, (mean(best_home) + assembly).max(SMALLEST_VIOLATION))
    }

    /// Lowers the reports to the poses that leave the design without a workspace although its best centre pose is
    /// feasible: the centres of the best window, and what lies just beyond them.
    fn visit_window(&self, reports: &mut ConstraintResults, home: usize, sign: f64) {
        let centre = self.model.settings().workspace.centre;
        let pose = |position: DVec2, index: usize| Pose {
            position,
            phi: self.found.orientations[index].phi_deg.to_radians(),
        };
        for index in self.found.orientation_grid.window(home) {
            self.visit(reports, &self.found.centres.get(index), || pose(centre, index), sign);
        }
        self.look_beyond(|index, position, values| self.visit(reports, values, || pose(position, index), sign));
        // At the very end of a leg's reach the distance to the limit is 0, though the leg does not reach the pose.
        let reach = &mut reports[Constraint::Reach as usize];
        if reach.active && reach.margin == 0.0 {
            reach.margin = -SMALLEST_VIOLATION;
        }
    }

    /// Returns the sum of the relative shortfalls of the limits at a pose, and the sign of `det A` (0 if it vanishes or
    /// the pose is unreachable).
    fn shortfall(&self, values: &Result<PoseValues, f64>) -> (f64, f64) {
        let thresholds = &self.checker.thresholds;
        match values {
            Ok(values) => {
                let missed = |(scalar, threshold): (PoseScalar, f64)| {
                    // The shortfall is at most that of a constraint missed entirely, as at an unreachable pose.
                    let margin = scalar.margin(values.get(scalar)?, threshold, self.design);
                    Some((-margin).clamp(0.0, 1.0))
                };
                let sum = thresholds.iter().filter_map(missed).sum();
                let determinant = values[PoseScalar::Determinant];
                (sum, if determinant == 0.0 { 0.0 } else { determinant.signum() })
            }
            // At an unreachable pose no other scalar has a value: each of the constraints with an id counts as missed entirely.
            Err(limit_margin) => {
                let of_reach = PoseScalar::Reach.margin(*limit_margin, 0.0, self.design);
                let others = thresholds
                    .iter()
                    .filter(|(scalar, _)| *scalar != PoseScalar::Reach && Constraint::of_scalar(*scalar).is_some());
                (others.count() as f64 - of_reach, 0.0)
            }
        }
    }
}

/// Returns the index of the smallest number, the first one among equals.
fn smallest(numbers: impl Iterator<Item = f64>) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for (index, number) in numbers.enumerate() {
        if best.is_none_or(|(_, smallest)| number < smallest) {
            best = Some((index, number));
        }
    }
    best.map(|(index, _)| index)
}
