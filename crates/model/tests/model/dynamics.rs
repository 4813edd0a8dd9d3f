//! Rates, forces of actuators, masses, natural frequencies and errors of the pose, compared with values from an independent program
//! (tests/fixtures/README.md), and identities.

use glam::DVec2;
use kinefront_model::dynamics::{
    Anywhere, DriveInertia, DynamicsReport, DynamicsSettings, ErrorBudget, Motion, MotionLaw, Payload, Task, TaskFrame,
    TaskShape, TaskTiming, Tolerances,
};
use kinefront_model::evaluation::{Model, TaskFigures, TaskSample};
use kinefront_model::mechanism::JointKind;
use serde_json::Value;

use super::reference::{cases_of, design, number, numbers, pose_at};
use super::strategies;

/// The settings of a case, whose short names are those of the drives of its architecture.
fn settings(case: &Value) -> DynamicsSettings {
    let study = &case["study"];
    let or_zero = |value: &Value| value.as_f64().unwrap_or(0.0);
    let is_prismatic = design(case).architecture().actuator() == JointKind::Prismatic;
    let of_kind = |value: f64| if is_prismatic { [value, 0.0] } else { [0.0, value] };
    let [prismatic, revolute] = of_kind(or_zero(&study["actuator_inertia"]));
    let [encoder_prismatic, encoder_revolute] = of_kind(or_zero(&study["tolerances"]["encoder"]));
    let payload = &study["payload"];
    let anywhere = &study["anywhere"];
    let tolerances = &study["tolerances"];
    let vector = |value: &Value| match value {
        Value::Array(_) => numbers(value),
        _ => [0.0; 3],
    };
    DynamicsSettings {
        payload: Payload {
            mass: or_zero(&payload["mass_kg"]),
            inertia: or_zero(&payload["inertia_kgm2"]),
            centre: match &payload["centre_m"] {
                Value::Null => [0.0; 2],
                centre => numbers(centre),
            },
        },
        drives: DriveInertia {
            slider_mass: or_zero(&study["slider_mass"]) + or_zero(&study["slider_mass_kg"]),
            prismatic,
            revolute,
        },
        gravity: vector(&study["gravity_mps2"]),
        tool: vector(&study["tool_wrench"]),
        anywhere: Anywhere {
            velocity: or_zero(&anywhere["v"]),
            omega: or_zero(&anywhere["omega"]),
            acceleration: or_zero(&anywhere["a"]),
            alpha: or_zero(&anywhere["alpha"]),
            force: or_zero(&anywhere["force"]),
            moment: or_zero(&anywhere["moment"]),
        },
        tolerances: Tolerances {
            encoder_prismatic,
            encoder_revolute,
            link: or_zero(&tolerances["link"]),
            base: or_zero(&tolerances["base"]),
            platform: or_zero(&tolerances["platform"]),
            play: or_zero(&tolerances["play"]),
        },
    }
}

fn model(case: &Value) -> Model {
    strategies::model(|model| model.dynamics = settings(case))
}

/// Asserts that values agree, relative to the largest of them.
fn agree(values: &[f64], wanted: &[f64], tolerance: f64, what: &str) {
    assert_eq!(values.len(), wanted.len(), "{what}");
    let largest = wanted
        .iter()
        .fold(f64::MIN_POSITIVE, |most, value| value.abs().max(most));
    for (value, wanted) in values.iter().zip(wanted) {
        let off = (value - wanted).abs() / largest;
        assert!(off < tolerance, "{what}: {value} instead of {wanted}, off by {off:e}");
    }
}

fn matrix(value: &Value) -> Vec<f64> {
    (0..3).flat_map(|row| numbers::<3>(&value[row])).collect()
}

#[test]
fn poses_agree() {
    for case in cases_of("task_cases.json", "cases") {
        let (design, model) = (design(&case), model(&case));
        let posed = model.posed(&design);
        for wanted in case["poses"].as_array().expect("poses") {
            let at = &wanted["pose"];
            let name = |what: &str| format!("{design} at {at}: {what}");
            let dynamics = posed.dynamics_at(&pose_at(at)).expect("reached").expect("stiff");
            let motion = Motion {
                twist: numbers(&wanted["twist"]),
                acceleration: numbers(&wanted["acceleration"]),
            };
            let response = dynamics.response(&motion);
            let report = dynamics.report().expect("regular");
            let actuators = dynamics.actuators();
            for (found, key, tolerance) in [
                (&actuators, "actuators", 1e-9),
                (&response.speeds, "actuator_speeds", 1e-9),
                (&response.accelerations, "actuator_accelerations", 1e-9),
                (&response.forces, "actuator_forces", 1e-8),
            ] {
                agree(found, &numbers::<3>(&wanted[key]), tolerance, &name(key));
            }
            for (found, key) in [
                (&report.rigid_mass, "mass_rigid"),
                (&report.mass_out_of_plane, "mass_out_of_plane"),
                (&report.mass_in_plane, "mass_in_plane"),
            ] {
                agree(found.as_flattened(), &matrix(&wanted[key]), 1e-8, &name(key));
            }
            let [in_plane, out_of_plane] = report.frequencies.expect("rigid rails");
            for (found, key) in [
                (in_plane, "frequencies_in_plane_hz"),
                (out_of_plane, "frequencies_out_of_plane_hz"),
            ] {
                for (found, wanted) in found.iter().zip(numbers::<3>(&wanted[key])) {
                    agree(&[*found], &[wanted], 1e-7, &name(key));
                }
            }
            figures_agree(&report, wanted, &name);
        }
    }
}

/// Asserts that the numbers of a pose as a whole agree: the frequency of its bars, its gains, and its error.
fn figures_agree(report: &DynamicsReport, wanted: &Value, name: &dyn Fn(&str) -> String) {
    let (gains, accuracy) = (&report.gains, &report.accuracy);
    let (figures, error) = (&wanted["figures"], &wanted["error"]);
    for (found, of, key, tolerance) in [
        (report.bar_frequency, wanted, "bar_frequency_hz", 1e-7),
        (gains.speed[0], figures, "speed_gain", 1e-8),
        (gains.speed[1], figures, "speed_gain_phi", 1e-8),
        (gains.force[0], figures, "force_gain", 1e-8),
        (gains.force[1], figures, "force_gain_phi", 1e-8),
        (gains.inertia[0], figures, "inertia_gain", 1e-8),
        (gains.inertia[1], figures, "inertia_gain_phi", 1e-8),
        (report.anywhere_speed, figures, "speed", 1e-8),
        (report.anywhere_force, figures, "force", 1e-8),
        (accuracy.worst_position, error, "worst_xy_m", 1e-7),
        (accuracy.worst_orientation, error, "worst_phi_rad", 1e-7),
        (accuracy.rms_position, error, "rms_xy_m", 1e-7),
        (accuracy.rms_orientation, error, "rms_phi_rad", 1e-7),
        (accuracy.nonlinearity, error, "eta", 1e-7),
    ] {
        agree(&[found], &[number(&of[key])], tolerance, &name(key));
    }
    // The parts of an error sum to it, and the ellipse has the root mean square of the error as its size.
    let sum = |budget: ErrorBudget| budget.parts().iter().map(|(_, part)| part).sum::<f64>();
    let [xx, yy, _] = accuracy.covariance;
    for (found, whole) in [
        (sum(accuracy.budget_position), accuracy.worst_position),
        (sum(accuracy.budget_orientation), accuracy.worst_orientation),
        ((xx + yy).sqrt(), accuracy.rms_position),
    ] {
        agree(&[found], &[whole], 1e-12, &name("budget"));
    }
}

fn task(value: &Value) -> Task {
    let or = |key: &str, default: f64| value[key].as_f64().unwrap_or(default);
    let limit = |key: &str| value[key].as_f64();
    Task {
        shape: match value["shape"].as_str().expect("a shape") {
            "circle" => TaskShape::Circle,
            "star" => TaskShape::Star,
            "pick_and_place" => TaskShape::PickAndPlace {
                swing: or("swing_deg", 0.0).to_radians(),
            },
            _ => {
                let point = |point: &Value| {
                    let [x, y, phi_deg] = numbers(point);
                    [x, y, f64::to_radians(phi_deg)]
                };
                let points = value["waypoints"].as_array().expect("points").iter();
                TaskShape::Waypoints(points.map(point).collect())
            }
        },
        share: or("share", 0.8),
        angle: or("angle_deg", 0.0).to_radians(),
        closed: value["closed"].as_bool().unwrap_or(true),
        law: match value["law"].as_str() {
            Some("trapezoid") => MotionLaw::Trapezoid {
                blend: or("blend", 1.0 / 3.0),
                ramp: or("ramp", 0.25),
            },
            _ => MotionLaw::Quintic,
        },
        dwell: or("dwell_s", 0.0),
        samples: 200,
        timing: match value["cycle_time_s"].as_f64() {
            Some(time) => TaskTiming::Cycle(time),
            None => TaskTiming::Limits {
                velocity: limit("v_max"),
                acceleration: limit("a_max"),
                omega: limit("omega_max"),
                alpha: limit("alpha_max"),
            },
        },
    }
}

fn sample_agrees(found: &TaskSample, wanted: &Value, name: &str) {
    let instant = &found.instant;
    let at = [instant.time, instant.pose.position.x, instant.pose.position.y];
    let wanted_at = ["t_s", "x", "y"].map(|key| number(&wanted[key]));
    agree(&at, &wanted_at, 1e-9, &format!("{name}: place"));
    let phi_deg = instant.pose.phi.to_degrees();
    assert!(
        (phi_deg - number(&wanted["phi_deg"])).abs() < 1e-9,
        "{name}: {phi_deg}°"
    );
    let response = &found.response;
    for (values, key, tolerance) in [
        (&instant.motion.twist, "twist", 1e-9),
        (&instant.motion.acceleration, "acceleration", 1e-9),
        (&found.actuators, "actuators", 1e-9),
        (&response.speeds, "actuator_speeds", 1e-8),
        (&response.accelerations, "actuator_accelerations", 1e-8),
        (&response.forces, "actuator_forces", 1e-8),
    ] {
        let wanted = numbers::<3>(&wanted[key]);
        agree(values, &wanted, tolerance, &format!("{name}: {key}"));
    }
}

/// Asserts that what a motion asks of the drives agrees.
fn task_figures_agree(figures: &TaskFigures, wanted: &Value, name: &str) {
    let largest = number(&wanted["energy_each_j"]);
    for (found, key, scale) in [
        (figures.path_reach, "path_reach_m", None),
        (figures.corner_power, "corner_power_w", None),
        (figures.peak_power_total, "peak_power_total_w", None),
        (figures.energy_each, "energy_each_j", None),
        (figures.energy_shared, "energy_shared_j", None),
        (figures.energy_net, "energy_net_j", Some(largest)),
    ] {
        // The net energy is the difference of large numbers.
        let scale = scale.unwrap_or(number(&wanted[key]).abs());
        let off = (found - number(&wanted[key])).abs() / scale;
        assert!(
            off < 1e-7,
            "{name}: {key} {found} instead of {}, off by {off:e}",
            wanted[key]
        );
    }
    for (found, key) in [
        (&figures.peak_speed, "peak_speed"),
        (&figures.peak_acceleration, "peak_acceleration"),
        (&figures.peak_force, "peak_force"),
        (&figures.rms_force, "rms_force"),
        (&figures.peak_power, "peak_power_w"),
        (&figures.stroke, "stroke"),
    ] {
        agree(found, &numbers::<3>(&wanted[key]), 1e-7, &format!("{name}: {key}"));
    }
}

#[test]
fn motions_agree() {
    for case in cases_of("task_cases.json", "cases") {
        let (design, model) = (design(&case), model(&case));
        let posed = model.posed(&design);
        for motion in case["motions"].as_array().expect("motions") {
            let wanted = &motion["expect"];
            let name = format!("{design} along {}", motion["task"]);
            let frame = TaskFrame {
                centre: DVec2::ZERO,
                radius: case["workspace_radius_m"].as_f64().unwrap_or(0.0),
                polygon: None,
                home_phi: case["home_phi_deg"].as_f64().unwrap_or(0.0).to_radians(),
                half_range: 10f64.to_radians(),
                lever: design.platform_radius(),
            };
            let (outcome, samples) = posed.follow(&task(&motion["task"]), &frame);
            let moved = outcome.motion.expect("a motion");
            let pieces = wanted["pieces_s"].as_array().expect("pieces").iter();
            agree(
                moved.durations(),
                &pieces.map(number).collect::<Vec<f64>>(),
                1e-9,
                &name,
            );
            match outcome.result.expect("a result") {
                Err(failure) => {
                    assert_eq!(wanted["ok"], false, "{name}");
                    assert_eq!(
                        failure.piece + 1,
                        wanted["piece"].as_u64().expect("a piece") as usize,
                        "{name}"
                    );
                    assert_eq!(failure.leg.map(|leg| leg as u64 + 1), wanted["leg"].as_u64(), "{name}");
                    assert_eq!(
                        failure.fault.name(),
                        wanted["reason"].as_str().expect("a reason"),
                        "{name}"
                    );
                    agree(&[failure.time], &[number(&wanted["time_s"])], 1e-9, &name);
                    agree(&[failure.path_reach], &[number(&wanted["path_reach_m"])], 1e-7, &name);
                }
                Ok(figures) => {
                    assert_eq!(wanted["ok"], true, "{name}");
                    assert_eq!(wanted["inside_workspace"], figures.inside_workspace, "{name}");
                    agree(&[moved.cycle_time()], &[number(&wanted["cycle_time_s"])], 1e-9, &name);
                    task_figures_agree(&figures, wanted, &name);
                    for wanted in wanted["samples"].as_array().expect("samples") {
                        let index = wanted["index"].as_u64().expect("an index") as usize;
                        sample_agrees(&samples[index], wanted, &name);
                    }
                }
            }
        }
    }
}
