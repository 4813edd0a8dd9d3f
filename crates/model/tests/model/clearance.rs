//! Compares clearances with an oracle: capsules constructed here from the joints in a pose report, and the distance of
//! segments in space by `parry3d`.

use kinefront_model::clearance::{BodySettings, Layers};
use kinefront_model::evaluation::{Model, ModelSettings, PoseEvaluation};
use kinefront_model::mechanism::{Architecture, Design, Leg, WorkingMode};
use kinefront_model::spatial::{Pose, Rotation};
use kinefront_model::with_leg;
use parry3d_f64::math::Vector;
use parry3d_f64::query::details::closest_points_segment_segment_with_locations_nD;
use parry3d_f64::shape::Segment;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Number of poses of each architecture.
const POSES: usize = 100_000;

/// A member as the oracle models it: its joints and its capsule.
#[derive(Clone)]
struct Body {
    name: String,
    joints: Vec<String>,
    ends: [Vector; 2],
    radius: f64,
}

/// A fault that can be introduced into the oracle on purpose.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Fault {
    None,
    /// The members whose names contain this text are omitted.
    LeftOut(&'static str),
    /// The members whose names contain this text are 1 % thicker.
    Thicker(&'static str),
    /// Members that share a joint are compared, too.
    JoinedCounted,
    /// The ends of the rails are not considered.
    NoRailEnds,
}

fn anchor(design: &Design, index: usize) -> [f64; 2] {
    let angle = [210f64, 330.0, 90.0][index % 3].to_radians();
    [design.base_radius * angle.cos(), design.base_radius * angle.sin()]
}

fn bodies(model: &Model, design: &Design, pose: &Pose, report: &PoseEvaluation) -> Vec<Body> {
    let layers = &model.bodies.layers;
    let diameter = 2.0 * design.leg_bar_radius.max(design.platform_bar_radius);
    let body = |name: String, joints: &[String], ends: [[f64; 2]; 2], layer: f64, radius: f64| Body {
        name,
        joints: joints.to_vec(),
        ends: ends.map(|[x, y]| Vector::new(x, y, layer * diameter)),
        radius,
    };
    let mut all = Vec::new();
    for leg in 0..3 {
        let [a, b, c] = ["A", "B", "C"].map(|joint| format!("{joint}{leg}"));
        let (at_a, at_b, at_c) = (anchor(design, leg), report.b[leg], report.c[leg]);
        let rj = design.leg_bar_radius;
        let number = leg + 1;
        let toward = |from: [f64; 2], to: [f64; 2], length: f64| {
            let way = [to[0] - from[0], to[1] - from[1]];
            let fraction = length / way[0].hypot(way[1]);
            [from[0] + fraction * way[0], from[1] + fraction * way[1]]
        };
        match design.architecture {
            Architecture::Prr => {
                let half = (0.5 * model.bodies.slider_length - model.bodies.slider_half_width) * rj;
                let next = anchor(design, leg + 1);
                let way = [next[0] - at_a[0], next[1] - at_a[1]];
                let length = way[0].hypot(way[1]);
                let end = |by: f64| [at_b[0] + by * way[0] / length, at_b[1] + by * way[1] / length];
                let thick = model.bodies.slider_half_width * rj;
                all.push(body(
                    format!("leg{number}_slider"),
                    std::slice::from_ref(&b),
                    [end(-half), end(half)],
                    layers.slider,
                    thick,
                ));
                all.push(body(
                    format!("leg{number}_link"),
                    &[b, c.clone()],
                    [at_b, at_c],
                    layers.link,
                    rj,
                ));
            }
            Architecture::Rpr => {
                let shortest = model.legs.telescopic_shortest;
                let rod = (1.0 - shortest.min(0.5)) * design.link_length;
                let tail = if rod > report.actuators[leg] {
                    toward(at_c, at_a, rod)
                } else {
                    at_a
                };
                all.push(body(
                    format!("leg{number}_telescopic_leg"),
                    &[a, c.clone()],
                    [tail, at_c],
                    layers.telescopic_leg,
                    rj,
                ));
            }
            Architecture::Rrr => {
                all.push(body(
                    format!("leg{number}_crank"),
                    &[a, b.clone()],
                    [at_a, at_b],
                    layers.crank,
                    rj,
                ));
                all.push(body(
                    format!("leg{number}_link"),
                    &[b, c.clone()],
                    [at_b, at_c],
                    layers.link,
                    rj,
                ));
            }
        }
        all.push(body(
            format!("platform_bar{number}"),
            &[c, "P".to_owned()],
            [at_c, pose.position.to_array()],
            layers.platform,
            design.platform_bar_radius,
        ));
    }
    all
}

fn distance(a: &Body, b: &Body) -> f64 {
    let (on_a, on_b) =
        closest_points_segment_segment_with_locations_nD((&a.ends[0], &a.ends[1]), (&b.ends[0], &b.ends[1]));
    let at = |body: &Body, on| Segment::new(body.ends[0], body.ends[1]).point_at(&on);
    at(a, on_a).distance(at(b, on_b)) - a.radius - b.radius
}

/// The nearest pair of members according to the oracle.
struct Found {
    /// Its clearance.
    least: f64,
    /// Names of its two members.
    pair: [String; 2],
    /// Clearance of the second nearest pair.
    second: f64,
}

impl Found {
    fn lower(&mut self, gap: f64, pair: impl FnOnce() -> [String; 2]) {
        if gap < self.least {
            self.second = self.least;
            self.least = gap;
            self.pair = pair();
        } else {
            self.second = self.second.min(gap);
        }
    }
}

fn oracle(model: &Model, design: &Design, pose: &Pose, report: &PoseEvaluation, fault: Fault) -> Found {
    let mut bodies = bodies(model, design, pose, report);
    match fault {
        Fault::LeftOut(name) => bodies.retain(|body| !body.name.contains(name)),
        Fault::Thicker(name) => {
            for body in bodies.iter_mut().filter(|body| body.name.contains(name)) {
                body.radius *= 1.01;
            }
        }
        _ => {}
    }
    let mut found = Found {
        least: f64::INFINITY,
        pair: [String::new(), String::new()],
        second: f64::INFINITY,
    };
    for (index, a) in bodies.iter().enumerate() {
        for b in &bodies[index + 1..] {
            let joined = a.joints.iter().any(|joint| b.joints.contains(joint));
            if joined && fault != Fault::JoinedCounted {
                continue;
            }
            found.lower(distance(a, b), || [a.name.clone(), b.name.clone()]);
        }
    }
    if design.architecture == Architecture::Prr && fault != Fault::NoRailEnds {
        let half = 0.5 * model.bodies.slider_length * design.leg_bar_radius;
        let travel = 3f64.sqrt() * design.base_radius;
        for (leg, along) in report.actuators.iter().enumerate() {
            for (end, gap) in [along - half, travel - along - half].into_iter().enumerate() {
                found.lower(gap, || {
                    let rail = format!("rail{}_end_A{}", leg + 1, (leg + end) % 3 + 1);
                    [format!("leg{}_slider", leg + 1), rail]
                });
            }
        }
    }
    found
}

/// Generator of random numbers within a range.
struct Random(ChaCha8Rng);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Draws a model with random settings for members and legs, and a random design of an architecture.
    fn subject(&mut self, architecture: Architecture) -> (ModelSettings, Design) {
        let mut model = ModelSettings::default();
        let half_width = self.between(0.5, 3.0);
        // The default layers, all layers in one plane, or random layers.
        let layers = match self.0.next_u32() % 3 {
            0 => Layers::default(),
            1 => Layers::ONE_PLANE,
            _ => Layers {
                platform: self.between(-2.0, 2.0),
                link: self.between(-2.0, 2.0),
                telescopic_leg: self.between(-2.0, 2.0),
                crank: self.between(-2.0, 2.0),
                slider: self.between(-2.0, 2.0),
            },
        };
        model.bodies = BodySettings {
            slider_half_width: half_width,
            slider_length: self.between(2.0 * half_width, 12.0),
            layers,
        };
        model.legs.telescopic_shortest = self.between(0.0, 0.7);
        let signs = [(); 3].map(|()| self.0.next_u32().is_multiple_of(2));
        let values = [
            self.between(0.5, 4.0),
            self.between(0.1, 4.0),
            self.between(0.5, 4.0),
            self.between(0.001, 0.1),
            self.between(0.001, 0.1),
        ];
        let design = Design::new(architecture, WorkingMode::new(signs), values).expect("a valid design");
        (model, design)
    }

    fn pose(&mut self) -> Pose {
        Pose::new(
            self.between(-2.0, 2.0),
            self.between(-2.0, 2.0),
            self.between(-3.2, 3.2),
        )
    }
}

/// Returns the clearance that evaluations compute, by their loop over poses with a single pose.
fn in_lanes(model: &Model, design: &Design, pose: &Pose) -> Option<f64> {
    fn of<L: Leg>(model: &Model, design: &Design, pose: &Pose) -> Option<f64> {
        let mut checker = model.checker::<L>(design);
        checker.thresholds.clearance = Some(0.0);
        let [a, b, c] = checker.manipulator.arms(&Rotation::new(pose.phi));
        checker
            .lanes::<f64>(pose.position.into(), &[a.into(), b.into(), c.into()])
            .reached()?
            .clearance
    }
    with_leg!(design.architecture, L => of::<L>(model, design, pose))
}

/// Compares random poses of random designs; returns the number of poses with an overlap and, for each fault of the
/// oracle, the number of poses at which it is detected.
fn compare(architecture: Architecture, poses: usize, faults: &[Fault]) -> (usize, Vec<usize>) {
    let mut random = Random(ChaCha8Rng::seed_from_u64(7));
    let (mut done, mut overlapping, mut shown) = (0, 0, vec![0; faults.len()]);
    while done < poses {
        let (settings, design) = random.subject(architecture);
        let model = Model::new(settings).expect("the grids fit the rotation range");
        for _ in 0..20 {
            let pose = random.pose();
            let Ok(report) = model.pose(&design, &pose) else {
                continue;
            };
            // Within rounding of a singularity of a leg, its directions are undefined and the last digits are lost.
            if report.limit_margin < 1e-9 {
                continue;
            }
            let Found {
                least: wanted,
                pair,
                second,
            } = oracle(&model, &design, &pose, &report, Fault::None);
            let told = report.clearance;
            assert!(
                (told.distance - wanted).abs() < 1e-9,
                "{design} at {pose:?}: {} between {:?} instead of {wanted} between {pair:?}",
                told.distance,
                told.pair()
            );
            if second - wanted > 1e-9 {
                let names = |mut pair: [String; 2]| {
                    pair.sort();
                    pair
                };
                assert_eq!(names(told.pair()), names(pair), "{design} at {pose:?}");
            }
            let lanes = in_lanes(&model, &design, &pose).expect("a reachable pose");
            assert!(
                (lanes - wanted).abs() < 1e-9,
                "{design} at {pose:?}: {lanes} instead of {wanted}"
            );
            overlapping += usize::from(wanted < 0.0);
            done += 1;
            for (count, &fault) in shown.iter_mut().zip(faults) {
                let faulty = oracle(&model, &design, &pose, &report, fault).least;
                *count += usize::from((told.distance - faulty).abs() > 1e-9);
            }
        }
    }
    (overlapping, shown)
}

#[test]
fn clearances_are_those_of_capsules_in_space() {
    for &architecture in Architecture::ALL {
        let (overlapping, _) = compare(architecture, POSES, &[]);
        assert!(
            (POSES / 100..POSES * 99 / 100).contains(&overlapping),
            "{architecture}: {overlapping} of {POSES} overlap"
        );
    }
}

/// The comparison detects faults: a member omitted or too thick, or a pair counted in excess, makes the two sides
/// differ.
#[test]
fn a_planted_fault_shows() {
    let common = [
        Fault::LeftOut("platform_bar"),
        Fault::LeftOut("platform_bar2"),
        Fault::Thicker("platform_bar"),
        Fault::JoinedCounted,
    ];
    let link = [
        Fault::LeftOut("link"),
        Fault::LeftOut("leg3_link"),
        Fault::Thicker("link"),
    ];
    for (architecture, own) in [
        (
            Architecture::Prr,
            &[Fault::LeftOut("slider"), Fault::Thicker("slider"), Fault::NoRailEnds][..],
        ),
        (
            Architecture::Rpr,
            &[Fault::LeftOut("leg1_telescopic_leg"), Fault::Thicker("telescopic_leg")],
        ),
        (
            Architecture::Rrr,
            &[Fault::LeftOut("crank"), Fault::Thicker("leg2_crank")],
        ),
    ] {
        let mut faults = [&common[..], own].concat();
        if architecture != Architecture::Rpr {
            faults.extend(link);
        }
        let (_, shown) = compare(architecture, 2000, &faults);
        for (fault, count) in faults.iter().zip(shown) {
            assert!(
                count > 10,
                "{architecture}: {fault:?} is detected in {count} of 2000 poses"
            );
        }
    }
}

/// Bars thickened until they touch have zero clearance, and bars thickened further overlap by the excess.
#[test]
fn touching_is_zero() {
    let mut random = Random(ChaCha8Rng::seed_from_u64(11));
    for &architecture in Architecture::ALL {
        let mut touched = 0;
        for _ in 0..400_000 {
            let (mut settings, mut design) = random.subject(architecture);
            settings.bodies.layers = Layers::ONE_PLANE;
            // Sliders are small, so that they stay clear as the legs are made thicker.
            (settings.bodies.slider_half_width, settings.bodies.slider_length) = (0.2, 0.4);
            let model = Model::new(settings).expect("the grids fit the rotation range");
            let pose = random.pose();
            design.leg_bar_radius = 0.01;
            let clearance = |design: &Design| {
                let report = model.pose(design, &pose).ok()?;
                Some(report.clearance)
            };
            // Only pairs of legs: both radii are r_j, and no other pair may become the nearest as r_j grows.
            let legs = |pair: [String; 2]| {
                pair.iter()
                    .all(|name| name.starts_with("leg") && !name.contains("slider"))
            };
            let Some(before) = clearance(&design).filter(|found| legs(found.pair()) && found.distance > 0.0) else {
                continue;
            };
            for thicker in [0.0, 1e-3] {
                design.leg_bar_radius = 0.01 + 0.5 * before.distance + thicker;
                let Some(found) = clearance(&design) else {
                    unreachable!("bar radii do not affect reach")
                };
                if found.pair() == before.pair() {
                    assert!((found.distance + 2.0 * thicker).abs() < 1e-12, "{design}: {found:?}");
                    touched += 1;
                }
            }
        }
        assert!(touched > 50, "{architecture}: {touched} pairs touch");
    }
}
