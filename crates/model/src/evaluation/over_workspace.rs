//! The largest rates, forces and errors, and the lowest natural frequencies, over the workspace of a design (docs/model.md, section 15.7).

use glam::DVec2;

use super::worst::positions_in_disc;
use super::{Evaluation, Model, PosedDesign};
use crate::dynamics::DynamicsReport;
use crate::spatial::Pose;
use crate::workspace::{Region, directions};

/// A value with the pose at which it occurs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct At {
    /// The value.
    pub value: f64,
    /// The pose.
    pub pose: Pose,
}

/// A figure of a pose: its key in JSON, whether its smallest value is the worst one, and its value. The frequency of the frame of finite
/// elements, which costs more than all of them, is computed at one pose, that of `f1`.
type Figure = (&'static str, bool, fn(&DynamicsReport) -> Option<f64>);

const FIGURES: [Figure; 14] = [
    ("speed_gain", false, |report| Some(report.gains.speed[0])),
    ("speed_gain_phi", false, |report| Some(report.gains.speed[1])),
    ("force_gain", false, |report| Some(report.gains.force[0])),
    ("force_gain_phi", false, |report| Some(report.gains.force[1])),
    ("inertia_gain", false, |report| Some(report.gains.inertia[0])),
    ("inertia_gain_phi", false, |report| Some(report.gains.inertia[1])),
    ("speed", false, |report| Some(report.anywhere_speed)),
    ("force", false, |report| Some(report.anywhere_force)),
    ("worst_xy", false, |report| Some(report.accuracy.worst_position)),
    ("worst_phi", false, |report| Some(report.accuracy.worst_orientation)),
    ("rms_xy", false, |report| Some(report.accuracy.rms_position)),
    ("f1", true, DynamicsReport::lowest_frequency),
    ("f_in_plane", true, |report| {
        report.frequencies.map(|[in_plane, _]| in_plane[0])
    }),
    ("f_out_of_plane", true, |report| {
        report.frequencies.map(|[_, out_of_plane]| out_of_plane[0])
    }),
];

/// The worst figures over a workspace.
#[derive(Debug, Clone, PartialEq)]
pub struct OverWorkspace {
    /// By their keys, each with the pose where it occurs; `None` where a design has no such figure.
    pub figures: Vec<(&'static str, Option<At>)>,
    /// Area of the convex hull of all `A_i`, `B_i` and `C_i` \[m²\].
    pub footprint: f64,
}

impl Model {
    /// Returns the worst figures over the disc of an evaluated design, at the poses of the reference grid in all directions; `None` without
    /// a disc, for a prescribed region, and for a design that is infinitely compliant or singular in it.
    pub fn over_workspace(&self, evaluation: &Evaluation) -> Option<OverWorkspace> {
        let workspace = &self.settings().workspace;
        let is_disc = matches!(workspace.region, Region::Largest);
        let home = evaluation
            .home_phi_deg
            .filter(|_| is_disc && evaluation.workspace_radius() > 0.0)?;
        let grid = &self.settings().reference_grid;
        let directions = directions(grid, false);
        let spacing = evaluation.design.base_radius() / grid.ray_steps() as f64;
        let radius = evaluation.workspace_radius();
        let positions: Vec<DVec2> = positions_in_disc(workspace.centre, &directions, radius, spacing).collect();
        let half = grid.half_window(workspace.rotation_range_deg).ok()?;
        let posed = self.posed(&evaluation.design);
        let mut found = OverWorkspace {
            figures: FIGURES.iter().map(|(key, ..)| (*key, None)).collect(),
            footprint: 0.0,
        };
        let mut points = Vec::new();
        for step in 0..=2 * half {
            let phi_deg = home + (step as f64 - half as f64) * grid.phi_step_deg();
            for position in &positions {
                let pose = Pose {
                    position: *position,
                    phi: phi_deg.to_radians(),
                };
                found.visit(&posed, &pose, &mut points)?;
            }
        }
        found.footprint = hull_area(points);
        let lowest = found.figures.iter().find(|(key, _)| *key == "f1");
        let of_frame = lowest.and_then(|(_, lowest)| {
            let pose = lowest.as_ref()?.pose;
            let value = self.frame_frequency(&evaluation.design, &pose)?;
            Some(At { value, pose })
        });
        found.figures.push(("f1_frame", of_frame));
        Some(found)
    }
}

impl OverWorkspace {
    fn visit(&mut self, posed: &PosedDesign, pose: &Pose, points: &mut Vec<DVec2>) -> Option<()> {
        // At the very end of a leg's reach, rounding decides whether the leg reaches the pose.
        let Ok(dynamics) = posed.dynamics_at(pose) else {
            return Some(());
        };
        let dynamics = dynamics?;
        let report = dynamics.report()?;
        for ((_, is_least, value), (_, worst)) in FIGURES.iter().zip(&mut self.figures) {
            let Some(value) = value(&report) else { continue };
            let is_worse = |than: &At| {
                if *is_least {
                    value < than.value
                } else {
                    value > than.value
                }
            };
            if worst.as_ref().is_none_or(is_worse) {
                *worst = Some(At { value, pose: *pose });
            }
        }
        points.extend(dynamics.joints());
        Some(())
    }
}

/// Returns the area of the convex hull of some points.
fn hull_area(mut points: Vec<DVec2>) -> f64 {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let half = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut hull: Vec<DVec2> = Vec::new();
        for point in points {
            while let [.., a, b] = hull[..]
                && (b - a).perp_dot(point - a) <= 0.0
            {
                hull.pop();
            }
            hull.push(point);
        }
        hull
    };
    let lower = half(&mut points.iter().copied());
    let upper = half(&mut points.iter().rev().copied());
    let twice = |chain: &[DVec2]| chain.windows(2).map(|pair| pair[0].perp_dot(pair[1])).sum::<f64>();
    0.5 * (twice(&lower) + twice(&upper))
}
