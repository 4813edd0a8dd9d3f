//! Compares clearances with those of the oracle.

use glam::DVec2;
use kinefront_model::clearance::{BodySettings, Layers, Obstacle, ObstacleShape};
use kinefront_model::evaluation::{Model, ModelSettings, PoseScalar};
use kinefront_model::mechanism::{AnyLeg, Architecture, Arrangement, Design, DesignVariable, Manipulator, WorkingMode};
use kinefront_model::polygon::Polygon;
use kinefront_model::spatial::{Pose, Rotation};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::strategies::{self, parsed};
use kinefront_testkit::oracle::{Fault, Found, distance_to_cylinder, distance_to_prism, oracle};
use kinefront_testkit::repetitions;

/// Generator of random numbers within a range.
pub struct Random(ChaCha8Rng);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Draws a model with random settings for members and legs, and a random design of an architecture.
    pub fn subject(&mut self, architecture: Architecture) -> (ModelSettings, Design) {
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
                turning_guide: self.between(-2.0, 2.0),
                guide: self.between(-2.0, 2.0),
            },
        };
        model.bodies = BodySettings {
            slider_half_width: half_width,
            slider_length: self.between(2.0 * half_width, 12.0),
            layers,
            ..BodySettings::default()
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
        if self.0.next_u32().is_multiple_of(2) {
            return (model, design);
        }
        let further = [
            self.between(0.5, 4.0),
            self.between(-90.0, 90.0),
            self.between(30.0, 150.0),
            self.between(-180.0, 180.0),
        ];
        model.legs.geometry = Arrangement {
            guide: [-0.5, 0.5],
            ..Arrangement::PAPER
        }
        .into();
        (model, strategies::with_variables(design, further))
    }

    pub fn pose(&mut self) -> Pose {
        Pose::new(
            self.between(-2.0, 2.0),
            self.between(-2.0, 2.0),
            self.between(-3.2, 3.2),
        )
    }
}

/// Returns the clearance that evaluations compute, by their loop over poses with a single pose.
fn in_lanes(model: &Model, design: &Design, pose: &Pose) -> Option<f64> {
    let mut evaluator = model.pose_evaluator(design);
    evaluator.ask_for(PoseScalar::Clearance);
    let arms = evaluator.arms(&Rotation::new(pose.phi));
    let values = evaluator.evaluate_position(&arms, pose.position).ok()?;
    values.get(PoseScalar::Clearance)
}

/// Compares random poses of random designs; returns the number of poses with an overlap and, for each fault of the
/// oracle, the number of poses at which it is detected.
fn compare(architecture: Architecture, poses: usize, faults: &[Fault]) -> (usize, Vec<usize>) {
    let mut random = Random::new(7);
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
            if report.values[PoseScalar::Reach] < 1e-9 {
                continue;
            }
            let Found {
                least: wanted,
                pair,
                second,
            } = oracle(&model, &design, &pose, &report, Fault::None);
            let told = &report.nearest;
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
        let poses = repetitions(3000, 100_000);
        let (overlapping, _) = compare(architecture, poses, &[]);
        assert!(
            (poses / 100..=poses * 99 / 100).contains(&overlapping),
            "{architecture}: {overlapping} of {poses} overlap"
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

/// Accuracy of the distances of the library, which iterates \[m\].
const TOLERANCE: f64 = 1e-5;

/// An upright obstacle: a cylinder, a prism with four sides, or one with three.
struct Post {
    kind: usize,
    centre: DVec2,
    size: f64,
    heights: [f64; 2],
}

impl Post {
    fn new(kind: usize, random: &mut Random) -> Self {
        let centre = DVec2::new(random.between(-2.0, 2.0), random.between(-2.0, 2.0));
        let low = random.between(-0.5, 0.3);
        Self {
            kind,
            centre,
            heights: [low, low + random.between(0.01, 0.5)],
            size: random.between(0.05, 0.6),
        }
    }

    fn corners(&self) -> Vec<[f64; 2]> {
        let corners = match self.kind {
            1 => [[-1.0, -0.4], [1.0, -0.4], [1.0, 0.4], [-1.0, 0.4]].to_vec(),
            _ => [[-1.0, -0.5], [0.8, -0.7], [0.1, 0.9]].to_vec(),
        };
        let placed = |[x, y]: [f64; 2]| [self.centre.x + self.size * x, self.centre.y + self.size * y];
        corners.into_iter().map(placed).collect()
    }

    fn obstacle(&self) -> Obstacle {
        let (centre, radius) = (self.centre, self.size);
        let corners = self.corners().into_iter().map(DVec2::from_array);
        Obstacle {
            name: "post".into(),
            shape: match self.kind {
                0 => ObstacleShape::Disc { centre, radius },
                _ => ObstacleShape::Polygon(Polygon::new(corners.collect()).expect("a polygon")),
            },
            heights: self.heights,
        }
    }

    /// The distance of an axis by the library; 0 where it meets the obstacle.
    fn distance(&self, ends: [[f64; 3]; 2]) -> f64 {
        match self.kind {
            0 => distance_to_cylinder(ends, self.centre.to_array(), self.size, self.heights),
            _ => distance_to_prism(ends, &self.corners(), self.heights),
        }
    }
}

/// Obstacles keep the distance that a library measures in space, and the name of the nearest one is told.
#[test]
fn obstacles_are_as_far_as_a_library_measures() {
    let mut random = Random::new(13);
    let (mut nearest, mut overlapping) = ([0; 3], 0);
    for round in 0..6000 {
        let architecture = Architecture::ALL[round % Architecture::ALL.len()];
        let (mut settings, design) = random.subject(architecture);
        let free = Model::new(settings.clone()).expect("the grids fit the rotation range");
        let pose = random.pose();
        let Ok(alone) = free.pose(&design, &pose) else { continue };
        if alone.values[PoseScalar::Reach] < 1e-9 {
            continue;
        }
        let kind = round % 3;
        let post = Post::new(kind, &mut random);
        settings.surroundings.obstacles = vec![post.obstacle()];
        let model = Model::new(settings).expect("the grids fit the rotation range");
        let members = model.members(&design, &pose).expect("reachable");
        let manipulator = Manipulator::<AnyLeg>::new(&design, &model.settings().legs);
        let posture = manipulator.posture(&pose).expect("reachable");
        let capsules = model.bodies_of(&design).capsules(&manipulator, pose.position, &posture);
        assert_eq!(members.len(), capsules.len());
        let wanted = capsules.iter().map(|capsule| {
            let distance = post.distance([capsule.from, capsule.to].map(|end| end.to_array()));
            // Where the axis meets the obstacle, only the sign is known.
            (distance, distance - capsule.radius)
        });
        let wanted: Vec<(f64, f64)> = wanted.collect();
        let clearances = wanted.iter().map(|(_, clearance)| *clearance);
        let least = clearances.fold(alone.nearest.distance, f64::min);
        let meets = wanted.iter().any(|(distance, _)| *distance == 0.0);
        let found = model.pose(&design, &pose).expect("reachable").nearest;
        let lanes = in_lanes(&model, &design, &pose).expect("a reachable pose");
        assert!(
            (lanes - found.distance).abs() < 1e-9,
            "{design} at {pose:?}: {lanes} and {found:?}"
        );
        overlapping += usize::from(meets);
        let agrees = match meets {
            true => found.distance <= least + TOLERANCE,
            false => (found.distance - least).abs() < TOLERANCE,
        };
        assert!(agrees, "{design} at {pose:?}: {found:?}, not {least}");
        if found.distance < alone.nearest.distance {
            assert_eq!(found.pair()[1], "post");
            nearest[kind] += 1;
            // The points between which it is measured are as far apart.
            let apart = found.between[0].distance(found.between[1]);
            let own = capsules.iter().find(|capsule| capsule.member == found.member);
            let radius = own.map_or(0.0, |capsule| capsule.radius);
            assert!(
                meets || (apart - radius - found.distance).abs() < 1e-6,
                "{design}: {found:?}"
            );
        }
    }
    let are_all_seen = nearest.iter().all(|count| *count > 30) && overlapping > 40;
    assert!(are_all_seen, "{nearest:?}, {overlapping}");
}

/// A member that leaves the room has a clearance below 0, and one within it the distance from the walls.
#[test]
fn the_room_is_not_left() {
    let design = parsed("3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056");
    // An L without its upper right quarter.
    let corners = [
        [-4.0, -4.0],
        [4.0, -4.0],
        [4.0, 0.6],
        [1.9, 0.6],
        [1.9, 4.0],
        [-4.0, 4.0],
    ];
    let model = strategies::model(|settings| {
        let corners = corners.iter().map(|&corner| DVec2::from_array(corner));
        settings.surroundings.room = Some(Polygon::new(corners.collect()).expect("a polygon"));
    });
    let at = |x: f64, y: f64| model.pose(&design, &Pose::new(x, y, 0.5)).expect("reachable").nearest;
    let inside = at(-0.6, -0.6);
    assert!(inside.distance > 0.0, "{inside:?}");
    let beyond = at(0.7, 0.9);
    assert!(beyond.distance < 0.0 && beyond.pair()[1] == "room", "{beyond:?}");
    assert!(!model.is_symmetric(&design));
}

/// Bars thickened until they touch have zero clearance, and bars thickened further overlap by the excess.
#[test]
fn touching_is_zero() {
    let mut random = Random::new(11);
    for &architecture in Architecture::ALL {
        let mut touched = 0;
        let (tries, least) = if Architecture::PAPER.contains(&architecture) {
            (400_000, 50)
        } else {
            (60_000, 0)
        };
        for _ in 0..tries {
            let (mut settings, mut design) = random.subject(architecture);
            settings.bodies.layers = Layers::ONE_PLANE;
            // Sliders are small, so that they stay clear as the legs are made thicker.
            (settings.bodies.slider_half_width, settings.bodies.slider_length) = (0.2, 0.4);
            let model = Model::new(settings).expect("the grids fit the rotation range");
            let pose = random.pose();
            design = design.with(DesignVariable::LegBarRadius, 0.01).expect("a design");
            let clearance = |design: &Design| {
                let report = model.pose(design, &pose).ok()?;
                Some(report.nearest)
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
                let radius = 0.01 + 0.5 * before.distance + thicker;
                design = design.with(DesignVariable::LegBarRadius, radius).expect("a design");
                let Some(found) = clearance(&design) else {
                    unreachable!("bar radii do not affect reach")
                };
                if found.pair() == before.pair() {
                    assert!((found.distance + 2.0 * thicker).abs() < 1e-12, "{design}: {found:?}");
                    touched += 1;
                }
            }
        }
        assert!(touched > least, "{architecture}: {touched} pairs touch");
    }
}
