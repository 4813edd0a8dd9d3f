//! Strength, buckling, and the forces of joints and drives, compared with values from an independent program
//! (tests/fixtures/README.md), and identities.

use kinefront_model::evaluation::{GridChoice, Model, PoseScalar, Quantity, WorkspaceTarget};
use kinefront_model::lanes::InstructionSet;
use kinefront_model::mechanism::{Design, DesignVariable};
use kinefront_model::spatial::Pose;
use kinefront_model::stiffness::RailSupports;
use kinefront_model::strength::{LARGEST_FACTOR, LoadShape, Loads, StrengthReport};
use kinefront_testkit::numbers as random_numbers;
use serde_json::Value;

use super::legs::settings;
use super::reference::{cases_of, design, number, numbers, pose};
use super::sections::sections;
use super::strategies::{self, bar_ranges, parsed, round_rails};

fn model(case: &Value, loads: Loads) -> Model {
    strategies::model(|model| {
        model.legs = settings(case);
        if let Some(guide) = case["geometry"].get("guide") {
            let mut arrangement = *model.legs.geometry.arrangement();
            arrangement.guide = numbers(guide);
            model.legs.geometry = arrangement.into();
        }
        if let Some(shortest) = case.get("telescopic_shortest") {
            model.legs.telescopic_shortest = number(shortest);
        }
        model.sections = sections(case);
        model.loads = loads;
    })
}

/// The loads of a case: its wrench alone, or the set about it.
fn loads(case: &Value, with_range: bool) -> Loads {
    let alone = Loads {
        gravity: numbers(&case["gravity"]),
        ..Loads::default().with_wrench(numbers(&case["wrench"]))
    };
    if !with_range {
        return alone;
    }
    Loads {
        range: numbers(&case["range"]),
        shape: match case["shape"].as_str() {
            Some("box") => LoadShape::Box,
            Some("ellipsoid") => LoadShape::Ellipsoid,
            _ => LoadShape::Cylinder,
        },
        ..alone
    }
}

fn report(case: &Value, with_range: bool) -> StrengthReport {
    under(case, loads(case, with_range))
}

/// Asserts that a value agrees, relative to the largest value of its kind.
fn agree(value: f64, wanted: f64, largest: f64, tolerance: f64, what: &str) {
    let off = (value - wanted).abs() / largest.max(f64::MIN_POSITIVE);
    assert!(off < tolerance, "{what}: {value} instead of {wanted}, off by {off:e}");
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most, value| most.max(value.abs()))
}

/// Asserts that the forces of the drives and the worst values of a report agree with the expected ones.
fn worst_values_agree(found: &StrengthReport, wanted: &Value, name: &str) {
    for (value, key, tolerance) in [
        (found.stress, "stress_max_pa", 1e-9),
        (found.buckling_factor.expect("rigid rails"), "buckling_factor_min", 1e-8),
        (found.joint_force, "joint_force_max_n", 1e-9),
        (found.joint_moment, "joint_moment_max_nm", 1e-9),
    ] {
        let wanted = number(&wanted[key]);
        agree(value, wanted, wanted, tolerance, &format!("{name}: {key}"));
    }
    let efforts: [f64; 3] = numbers(&wanted["actuators"]);
    let most = largest(efforts.into_iter());
    for (value, wanted) in found.actuators.into_iter().zip(efforts) {
        agree(value, wanted, most, 1e-9, &format!("{name}: drive"));
    }
}

/// Asserts that the members of a report agree with the expected ones. Between the ends, weight bends a bar more.
fn members_agree(found: &StrengthReport, members: &[Value], weighs: bool, name: &str) {
    assert_eq!(found.members.len(), members.len(), "{name}");
    let of = |key: &str| largest(members.iter().map(|member| number(&member[key])));
    let ends = |member: &Value, entry: usize| [&member["start"], &member["end"]].map(|end| number(&end[entry]));
    let at_ends = |entry: usize| largest(members.iter().flat_map(|member| ends(member, entry)));
    for (member, wanted) in found.members.iter().zip(members) {
        let (k_in, k_out) = (number(&wanted["k_in_plane"]), number(&wanted["k_out_of_plane"]));
        let factor = number(&wanted["buckling_factor"]);
        let [inside, outside] = member.effective_lengths.expect("rigid rails");
        let ([first, last], axial) = (ends(wanted, 0), at_ends(0));
        let bent = |value: f64, entry: usize| {
            let at_end = largest(ends(wanted, entry).into_iter());
            if weighs { value.max(at_end) } else { at_end }
        };
        let (torsion, out_of_plane, in_plane) = (member.torsion, member.moment_out_of_plane, member.moment_in_plane);
        for (value, wanted_value, largest, tolerance, text) in [
            (
                member.stress,
                number(&wanted["stress_pa"]),
                of("stress_pa"),
                1e-9,
                "stress",
            ),
            (
                member.euler,
                number(&wanted["euler_n"]),
                of("euler_n"),
                1e-9,
                "Euler's load",
            ),
            (inside, k_in, k_in, 1e-8, "k in the plane"),
            (outside, k_out, k_out, 1e-8, "k out of the plane"),
            (
                member.buckling_factor.expect("rigid rails"),
                factor,
                factor,
                1e-8,
                "factor",
            ),
            (member.axial[0], first.min(last), axial, 1e-9, "least axial force"),
            (member.axial[1], first.max(last), axial, 1e-9, "largest axial force"),
            (torsion, bent(torsion, 3), at_ends(3), 1e-9, "torsion"),
            (
                out_of_plane,
                bent(out_of_plane, 4),
                at_ends(4),
                1e-9,
                "moment out of the plane",
            ),
            (in_plane, bent(in_plane, 5), at_ends(5), 1e-9, "moment in the plane"),
        ] {
            let what = format!("{name}: {text} of {}", wanted["name"]);
            agree(value, wanted_value, largest, tolerance, &what);
        }
    }
}

#[test]
fn stresses_forces_and_factors_agree() {
    for case in &cases() {
        let wanted = &case["expected"];
        let found = report(case, false);
        let name = design(case).to_string();
        let weighs = numbers::<3>(&case["gravity"]) != [0.0; 3];
        members_agree(&found, wanted["members"].as_array().expect("members"), weighs, &name);
        let joints = wanted["joints"].as_array().expect("joints");
        let of = |key: &str| largest(joints.iter().map(|joint| number(&joint[key])));
        for (joint, wanted) in found.joints.iter().zip(joints) {
            for (value, key, largest) in [
                (joint.radial, "radial_n", "force_n"),
                (joint.axial, "axial_n", "force_n"),
                (joint.force, "force_n", "force_n"),
                (joint.moment, "moment_nm", "moment_nm"),
            ] {
                let what = format!("{name}: {key} of {}", wanted["name"]);
                agree(value, number(&wanted[key]), of(largest), 1e-9, &what);
            }
        }
        worst_values_agree(&found, wanted, &name);
    }
}

#[test]
fn the_worst_of_a_set_agrees() {
    let cases = cases();
    let with_sets = cases.iter().filter(|case| case.get("shape").is_some());
    assert!(with_sets.clone().count() >= 9);
    for case in with_sets {
        let wanted = &case["expected"]["set"];
        let found = report(case, true);
        let name = design(case).to_string();
        let stresses = wanted["member_stress_pa"].as_array().expect("stresses");
        for (member, stress) in found.members.iter().zip(stresses) {
            let stress = number(stress);
            agree(member.stress, stress, found.stress, 1e-9, &format!("{name}: stress"));
        }
        let compressions = wanted["compression_n"].as_array().expect("compressions");
        let most = largest(compressions.iter().map(number));
        for (member, compression) in found.members.iter().zip(compressions) {
            let value = (-member.axial[0]).max(0.0);
            agree(value, number(compression), most, 1e-9, &format!("{name}: compression"));
        }
        worst_values_agree(&found, wanted, &name);
    }
}

fn cases() -> Vec<Value> {
    cases_of("strength_cases.json", "cases")
}

fn under(case: &Value, loads: Loads) -> StrengthReport {
    let (design, pose) = (design(case), pose(case));
    let found = model(case, loads).posed(&design).strength_at(&pose, None);
    found.expect("reachable").expect("no singularity")
}

#[test]
fn twice_the_load_is_twice_the_stress_and_half_the_factor() {
    for case in cases() {
        let alone = loads(&case, false);
        let twice = alone.with_wrench(alone.wrench.map(|part| 2.0 * part));
        let still = |loads: Loads| Loads {
            gravity: [0.0; 3],
            ..loads
        };
        let (once, twice) = (under(&case, still(alone)), under(&case, still(twice)));
        let name = design(&case).to_string();
        for (once, twice) in [
            (once.stress, twice.stress),
            (once.joint_force, twice.joint_force),
            (once.joint_moment, twice.joint_moment),
            (once.actuators[0], twice.actuators[0]),
        ] {
            agree(twice, 2.0 * once, (2.0 * once).abs(), 1e-12, &name);
        }
        let [once, twice] = [once, twice].map(|report| report.buckling_factor.expect("rigid rails"));
        if once < LARGEST_FACTOR {
            agree(twice, 0.5 * once, once, 1e-12, &name);
        }
    }
}

/// Wrenches on the boundary of a set and in it: none is worse than what the set is said to be.
#[test]
fn no_wrench_of_a_set_is_worse_than_its_worst() {
    let mut random = random_numbers(7);
    for case in cases() {
        for shape in [LoadShape::Box, LoadShape::Cylinder, LoadShape::Ellipsoid] {
            let set = Loads {
                range: [80.0, 80.0, 60.0, 5.0, 5.0, 9.0],
                shape,
                ..loads(&case, false)
            };
            let worst = under(&case, set);
            let name = format!("{} {shape:?}", design(&case));
            for _ in 0..100 {
                let direction: [f64; 6] = std::array::from_fn(|_| 2.0 * random() - 1.0);
                let wrench = std::array::from_fn(|k| set.wrench[k] + set.range[k] * on_boundary(shape, &direction)[k]);
                let one = under(&case, set.with_wrench(wrench));
                let is_below = |one: f64, worst: f64| one <= worst * (1.0 + 1e-9) + 1e-9;
                for (one, worst) in one.members.iter().zip(&worst.members) {
                    assert!(is_below(one.stress, worst.stress), "{name}: {}", one.member);
                    assert!(
                        one.axial[0] >= worst.axial[0] - 1e-9 * worst.axial[0].abs() - 1e-9,
                        "{name}"
                    );
                }
                for (one, worst) in one.joints.iter().zip(&worst.joints) {
                    assert!(is_below(one.force, worst.force), "{name}: force of {}", one.name());
                    assert!(is_below(one.moment, worst.moment), "{name}: moment of {}", one.name());
                }
                for (one, worst) in one.actuators.iter().zip(worst.actuators) {
                    assert!(is_below(one.abs(), worst), "{name}");
                }
                let [one, worst] = [&one, &worst].map(|report| report.buckling_factor.expect("rigid rails"));
                assert!(one >= worst * (1.0 - 1e-9), "{name}: {one} < {worst}");
            }
        }
    }
}

/// Scales a direction to the boundary of a set with half widths of 1.
fn on_boundary(shape: LoadShape, direction: &[f64; 6]) -> [f64; 6] {
    let [a, b, c, d, e, f] = *direction;
    match shape {
        LoadShape::Box => direction.map(f64::signum),
        LoadShape::Cylinder => {
            let (force, moment) = (a.hypot(b), d.hypot(e));
            [a / force, b / force, c.signum(), d / moment, e / moment, f.signum()]
        }
        LoadShape::Ellipsoid => {
            let length = direction.iter().map(|part| part * part).sum::<f64>().sqrt();
            direction.map(|part| part / length)
        }
    }
}

fn limited(change: impl FnOnce(&mut kinefront_model::evaluation::ModelSettings)) -> Model {
    strategies::model(|settings| {
        settings.thresholds = settings.thresholds.with(PoseScalar::Stress, 60e6);
        settings.thresholds = settings.thresholds.with(PoseScalar::BucklingFactor, 3.0);
        settings.quantities = [PoseScalar::Stress, PoseScalar::BucklingFactor]
            .map(Quantity::Worst)
            .into_iter()
            .collect();
        settings.loads.range = [500.0, 500.0, 500.0, 0.0, 0.0, 50.0];
        change(settings);
    })
}

/// Bars are sized for strength as they are for stiffness: what limits them is just kept.
#[test]
fn bars_are_sized_for_a_stress_that_they_just_keep() {
    let ranges = bar_ranges(false);
    let model = limited(|_| {});
    let mut kept = 0;
    for (text, radius) in [
        ("3-PRR R=0.559 r=0.1 Lb=0.5 rj=0.0085 rp=0.0081", 0.11),
        ("3-PRR R=1.06 r=0.121 Lb=0.758 rj=0.01 rp=0.01", 0.3),
        ("3-RPR R=1.5636 r=0.1006 Lb=2.2135 rj=0.017 rp=0.021", 0.5),
        ("3-RRR R=0.7 r=0.11 Lb=0.56 rj=0.03 rp=0.02", 0.3),
    ] {
        let design = parsed(text);
        let sized = model
            .sized(&design, &ranges, WorkspaceTarget::Radius(radius))
            .expect("bars");
        let evaluation = model.evaluate(&sized, GridChoice::Reference);
        assert!(evaluation.workspace_radius() >= 0.99 * radius, "{text}");
        let stress = evaluation
            .quantities
            .get(Quantity::Worst(PoseScalar::Stress))
            .expect("a stress");
        assert!(stress <= 60e6, "{text}: {stress}");
        // On the disc for which the bars were sized, unless the evaluation found a larger one.
        kept += usize::from(stress > 60e6 * (1.0 - 1e-3));
    }
    assert!(kept >= 2, "the stress limits {kept} designs");
}

#[test]
fn a_limit_of_the_strength_bounds_the_workspace() {
    let design = parsed("3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056");
    let radius_of = |model: &Model| model.evaluate(&design, GridChoice::Reference).workspace_radius();
    let free = radius_of(&strategies::model(|_| {}));
    let bounded = limited(|_| {});
    let radius = radius_of(&bounded);
    assert!(radius < free && radius > 0.0, "{radius} of {free}");
    let found = bounded.evaluate(&design, GridChoice::Reference);
    let limits: Vec<&str> = found
        .limits
        .iter()
        .map(|limit| limit.limit.quantity.entry().key)
        .collect();
    assert_eq!(limits, ["stress_max_pa", "buckling_factor_min"]);
    assert!(found.limits.iter().all(|limit| limit.margin >= 0.0));
    // A vertical plane has no symmetry.
    let vertical = limited(|settings| settings.loads.gravity = [0.0, -9.81, 0.0]);
    assert!(bounded.is_symmetric(&design) && !vertical.is_symmetric(&design));
    for instructions in InstructionSet::available() {
        for model in [&bounded, &vertical] {
            let found = model.evaluate_with(&design, GridChoice::Reference, instructions);
            let best = model.evaluate(&design, GridChoice::Reference);
            assert_eq!(format!("{found:?}"), format!("{best:?}"), "{}", instructions.name());
        }
    }
}

#[test]
fn what_does_not_exist_has_no_value() {
    let at_origin = Pose::new(0.0, 0.0, 0.3);
    let model = Model::default();
    let design = parsed("3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056");
    let report = |model: &Model, design: &Design, pose: &Pose| model.posed(design).strength_at(pose, None);
    let of_bars = |model: &Model| {
        report(model, &design, &at_origin)
            .expect("reachable")
            .expect("strength")
    };
    let found = of_bars(&model);
    assert_eq!(found.safety_factor, None);
    let at_pose = model.pose(&design, &at_origin).expect("reachable").values;
    assert_eq!(at_pose.get(PoseScalar::SafetyFactor), None);
    assert_eq!(at_pose.get(PoseScalar::ActuatorTorque), None);
    assert_eq!(at_pose.get(PoseScalar::Stress), Some(found.stress));
    assert!(at_pose.get(PoseScalar::ActuatorForce).is_some());
    // Without bars, and at a pose out of reach.
    let thin = design.with(DesignVariable::LegBarRadius, 0.0).expect("a design");
    assert_eq!(report(&model, &thin, &at_origin).expect("reachable"), None);
    assert!(report(&model, &design, &Pose::new(9.0, 0.0, 0.0)).is_err());
    // On rails that bend, the share of the rails in buckling is not known.
    let on_rails = strategies::model(|settings| settings.rails = round_rails(0.03, RailSupports::Pinned));
    let found = of_bars(&on_rails);
    assert_eq!(
        (found.buckling_factor, found.members[0].effective_lengths),
        (None, None)
    );
    assert!(found.stress > 0.0);
    // Nothing pushes or pulls.
    let idle = strategies::model(|settings| {
        settings.loads = Loads {
            gravity: [0.0; 3],
            ..Loads::default().with_wrench([0.0; 6])
        };
    });
    let found = of_bars(&idle);
    assert_eq!(
        (found.stress, found.joint_force, found.buckling_factor),
        (0.0, 0.0, Some(LARGEST_FACTOR))
    );
}
