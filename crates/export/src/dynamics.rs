//! The motion of a design as JSON and as a table. Keys are a contract: new ones may be added, none may be renamed.

use std::collections::BTreeMap;

use serde::Serialize;
use serde::ser::{SerializeStruct, Serializer};

use super::pose::PoseJson;
use kinefront_model::certify::MotionCertificate;
use kinefront_model::dynamics::{DriveCatalogue, DynamicsReport, Motion, TaskInstant};
use kinefront_model::evaluation::{OverWorkspace, PosedDynamics, SelectedDrive, TaskOutcome, TaskSample};

/// Frequencies, masses, gains and errors in the output of `kinefront pose --json`.
#[derive(Debug, Serialize)]
pub struct DynamicsJson {
    /// Three in the plane and three out of it, each in increasing order.
    frequencies_hz: Option<[f64; 6]>,
    /// How the platform moves at each of them.
    mode_shapes: Option<[[f64; 3]; 6]>,
    bar_frequency_hz: f64,
    /// For `x`, `y`, `φz`.
    mass_in_plane: [[f64; 3]; 3],
    /// For `z`, `φx`, `φy`.
    mass_out_of_plane: [[f64; 3]; 3],
    /// Of the rigid bodies, for `x`, `y`, `φz`.
    mass_rigid: [[f64; 3]; 3],
    gains: GainsJson,
    pose_error: PoseErrorJson,
    /// The lowest of the frame of finite elements, in the plane and out of it.
    frame_frequencies_hz: Option<[f64; 2]>,
    #[serde(flatten)]
    response: Option<ResponseJson>,
}

#[derive(Debug, Serialize)]
struct GainsJson {
    speed_gain: f64,
    speed_gain_phi: f64,
    force_gain: f64,
    force_gain_phi: f64,
    inertia_gain: f64,
    inertia_gain_phi: f64,
    /// Speed and force for the motion and load of the study in any direction.
    speed: f64,
    force: f64,
}

#[derive(Debug, Serialize)]
struct PoseErrorJson {
    worst_xy_m: f64,
    worst_phi_rad: f64,
    rms_xy_m: f64,
    rms_phi_rad: f64,
    eta: f64,
    /// Parts of the largest errors by their sources.
    budget_xy_m: BTreeMap<&'static str, f64>,
    budget_phi_rad: BTreeMap<&'static str, f64>,
    /// Variances along x and along y, and the covariance of both.
    covariance_m2: [f64; 3],
}

/// What the actuators do during a motion.
#[derive(Debug, Serialize)]
struct ResponseJson {
    actuator_speeds: [f64; 3],
    actuator_accelerations: [f64; 3],
    actuator_forces: [f64; 3],
}

impl DynamicsJson {
    /// Creates the output for a pose, with what the actuators do during a motion; `None` at a singularity.
    pub fn new(dynamics: &PosedDynamics<'_>, motion: Option<&Motion>) -> Option<Self> {
        let report: DynamicsReport = dynamics.report()?;
        let gains = &report.gains;
        let accuracy = &report.accuracy;
        Some(Self {
            frequencies_hz: report.frequencies.map(|[[a, b, c], [d, e, f]]| [a, b, c, d, e, f]),
            mode_shapes: report.shapes.map(|[[a, b, c], [d, e, f]]| [a, b, c, d, e, f]),
            bar_frequency_hz: report.bar_frequency,
            mass_in_plane: report.mass_in_plane,
            mass_out_of_plane: report.mass_out_of_plane,
            mass_rigid: report.rigid_mass,
            gains: GainsJson {
                speed_gain: gains.speed[0],
                speed_gain_phi: gains.speed[1],
                force_gain: gains.force[0],
                force_gain_phi: gains.force[1],
                inertia_gain: gains.inertia[0],
                inertia_gain_phi: gains.inertia[1],
                speed: report.anywhere_speed,
                force: report.anywhere_force,
            },
            pose_error: PoseErrorJson {
                worst_xy_m: accuracy.worst_position,
                worst_phi_rad: accuracy.worst_orientation,
                rms_xy_m: accuracy.rms_position,
                rms_phi_rad: accuracy.rms_orientation,
                eta: accuracy.nonlinearity,
                budget_xy_m: accuracy.budget_position.parts().into_iter().collect(),
                budget_phi_rad: accuracy.budget_orientation.parts().into_iter().collect(),
                covariance_m2: accuracy.covariance,
            },
            frame_frequencies_hz: dynamics.frame_frequencies(),
            response: motion.map(|motion| {
                let response = dynamics.response(motion);
                ResponseJson {
                    actuator_speeds: response.speeds,
                    actuator_accelerations: response.accelerations,
                    actuator_forces: response.forces,
                }
            }),
        })
    }
}

/// The largest rates, forces and errors over a workspace, and the lowest frequencies: by their keys a value and its pose.
#[derive(Debug, Serialize)]
pub struct OverWorkspaceJson {
    #[serde(flatten)]
    figures: BTreeMap<&'static str, Option<AtJson>>,
    footprint_m2: f64,
}

#[derive(Debug, Serialize)]
struct AtJson {
    value: f64,
    pose: PoseJson,
}

impl From<&OverWorkspace> for OverWorkspaceJson {
    fn from(found: &OverWorkspace) -> Self {
        let figures = found.figures.iter().map(|(key, at)| {
            let at = at.map(|at| AtJson {
                value: at.value,
                pose: PoseJson::new(&at.pose, at.pose.phi.to_degrees()),
            });
            (*key, at)
        });
        Self {
            figures: figures.collect(),
            footprint_m2: found.footprint,
        }
    }
}

/// What a motion asks of the drives. Where the motion ends early, its place and reason stand, and no figure but the path's reach does.
#[derive(Debug, Serialize)]
pub struct TaskJson {
    ok: bool,
    /// Durations of the pieces, without the dwells; nothing without a motion.
    pieces_s: Vec<f64>,
    dwell_s: Option<f64>,
    cycle_time_s: Option<f64>,
    path_reach_m: Option<f64>,
    /// Where the motion ends early: the piece, from 1, the time from the beginning of the cycle, and the leg, from 1.
    piece: Option<usize>,
    time_s: Option<f64>,
    leg: Option<usize>,
    /// `reach`, `limit`, `singularity`, or `no_path` where the path has no length.
    reason: Option<&'static str>,
    inside_workspace: Option<bool>,
    peak_speed: Option<[f64; 3]>,
    peak_acceleration: Option<[f64; 3]>,
    peak_force: Option<[f64; 3]>,
    rms_force: Option<[f64; 3]>,
    peak_power_w: Option<[f64; 3]>,
    corner_power_w: Option<f64>,
    peak_power_total_w: Option<f64>,
    energy_each_j: Option<f64>,
    energy_shared_j: Option<f64>,
    energy_net_j: Option<f64>,
    stroke: Option<[f64; 3]>,
    /// Drive of the catalogue that the design selects for the motion; nothing if none carries it, or without a catalogue.
    drive: Option<String>,
    /// Largest share of its limits that the motion uses, or that of the drive that misses by least.
    drive_utilization: Option<f64>,
}

impl TaskJson {
    /// Creates the output for a motion, whose drive is one of a catalogue.
    pub fn new(outcome: &TaskOutcome, catalogue: &DriveCatalogue) -> Self {
        let motion = outcome.motion.as_ref();
        let figures = outcome.figures();
        let failure = outcome.result.as_ref().and_then(|result| result.as_ref().err());
        Self {
            ok: figures.is_some(),
            pieces_s: motion.map_or_else(Vec::new, |motion| motion.durations().to_vec()),
            dwell_s: motion.map(|motion| motion.dwell()),
            cycle_time_s: motion.filter(|_| figures.is_some()).map(|motion| motion.cycle_time()),
            path_reach_m: figures
                .map(|figures| figures.path_reach)
                .or(failure.map(|failure| failure.path_reach)),
            piece: failure.map(|failure| failure.piece + 1),
            time_s: failure.map(|failure| failure.time),
            leg: failure.and_then(|failure| failure.leg).map(|leg| leg + 1),
            reason: failure
                .map(|failure| failure.fault.name())
                .or(outcome.result.is_none().then_some("no_path")),
            inside_workspace: figures.map(|figures| figures.inside_workspace),
            peak_speed: figures.map(|figures| figures.peak_speed),
            peak_acceleration: figures.map(|figures| figures.peak_acceleration),
            peak_force: figures.map(|figures| figures.peak_force),
            rms_force: figures.map(|figures| figures.rms_force),
            peak_power_w: figures.map(|figures| figures.peak_power),
            corner_power_w: figures.map(|figures| figures.corner_power),
            peak_power_total_w: figures.map(|figures| figures.peak_power_total),
            energy_each_j: figures.map(|figures| figures.energy_each),
            energy_shared_j: figures.map(|figures| figures.energy_shared),
            energy_net_j: figures.map(|figures| figures.energy_net),
            stroke: figures.map(|figures| figures.stroke),
            drive: outcome
                .drive
                .filter(SelectedDrive::carries)
                .and_then(|drive| Some(catalogue.get(drive.place)?.name.clone())),
            drive_utilization: outcome.drive.map(|drive| drive.utilization),
        }
    }
}

/// What is proved about a motion at every moment.
#[derive(Debug, Serialize)]
pub struct MotionProofJson {
    /// `proved`, `refuted` or `open`.
    verdict: &'static str,
    /// The distance to the joint limits and the ends of reach is nowhere smaller; nothing unless the motion is proved.
    reach_at_least_m: Option<f64>,
    /// No actuator is ever faster, in m/s or rad/s.
    speed_at_most: Option<f64>,
    /// No actuator ever gives more, in N or N·m.
    force_at_most: Option<f64>,
    /// Where a claim is wrong or open: the piece, from 1, and the time from the beginning of the cycle.
    piece: Option<usize>,
    time_s: Option<f64>,
    /// The claim: `reach`, `singularity`, `speed`, `force`, or the quantity whose limit is missed.
    claim: Option<&'static str>,
    /// Number of intervals of time that were examined.
    intervals: usize,
}

impl From<&MotionCertificate> for MotionProofJson {
    fn from(certificate: &MotionCertificate) -> Self {
        let verdict = &certificate.verdict;
        let (bounds, moment) = (verdict.bounds(), verdict.moment());
        Self {
            verdict: verdict.name(),
            reach_at_least_m: bounds.map(|bounds| bounds.reach),
            speed_at_most: bounds.map(|bounds| bounds.speed),
            force_at_most: bounds.map(|bounds| bounds.force),
            piece: moment.map(|moment| moment.piece + 1),
            time_s: moment.map(|moment| moment.time),
            claim: moment.map(|moment| moment.claim.name()),
            intervals: certificate.intervals,
        }
    }
}

/// Names of the pose of a sample with its rates and accelerations, and of the values, speeds, accelerations, forces and powers of the three
/// actuators.
const SAMPLED: [&str; 24] = [
    "x", "y", "phi_deg", "vx", "vy", "omega", "ax", "ay", "alpha", "q1", "q2", "q3", "qd1", "qd2", "qd3", "qdd1",
    "qdd2", "qdd3", "tau1", "tau2", "tau3", "p1", "p2", "p3",
];

/// A sample of a motion, as a row of the table and an object of JSON. Actuators are in metres and newtons, or in radians and newton
/// metres.
#[derive(Debug)]
pub struct TaskRow {
    time: f64,
    /// From 1.
    piece: usize,
    sampled: Vec<f64>,
}

impl From<&TaskSample> for TaskRow {
    fn from(sample: &TaskSample) -> Self {
        let TaskInstant { pose, motion, .. } = &sample.instant;
        let response = &sample.response;
        let of_pose = [pose.position.x, pose.position.y, pose.phi.to_degrees()];
        let others = [
            motion.twist,
            motion.acceleration,
            sample.actuators,
            response.speeds,
            response.accelerations,
            response.forces,
            sample.powers(),
        ];
        // A table shows no zero with a sign.
        let plain = others.into_iter().flatten().map(|value| value + 0.0);
        Self {
            time: sample.instant.time,
            piece: sample.instant.piece + 1,
            sampled: of_pose.into_iter().chain(plain).collect(),
        }
    }
}

impl Serialize for TaskRow {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut row = serializer.serialize_struct("TaskRow", 2 + SAMPLED.len())?;
        row.serialize_field("t_s", &self.time)?;
        row.serialize_field("piece", &self.piece)?;
        for (name, value) in SAMPLED.into_iter().zip(&self.sampled) {
            row.serialize_field(name, value)?;
        }
        row.end()
    }
}
