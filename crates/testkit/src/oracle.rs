//! Oracle of the clearance: capsules constructed here from the joints in a pose evaluation, and the distance of segments
//! in space by `parry3d`.

use kinefront_model::clearance::Layers;
use kinefront_model::evaluation::{Model, PoseEvaluation};
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Pose;
use parry3d_f64::math::{Pose as Placement, Vector};
use parry3d_f64::query;
use parry3d_f64::query::details::closest_points_segment_segment_with_locations_nD;
use parry3d_f64::shape::{ConvexPolyhedron, Cylinder, Segment};

/// Returns the distance in space of an axis from the upright prism over a convex outline \[m\]; 0 where they meet.
pub fn distance_to_prism(ends: [[f64; 3]; 2], corners: &[[f64; 2]], heights: [f64; 2]) -> f64 {
    let points: Vec<Vector> = corners
        .iter()
        .flat_map(|&[x, y]| heights.map(|z| Vector::new(x, y, z)))
        .collect();
    let prism = ConvexPolyhedron::from_convex_hull(&points).expect("a prism");
    let [from, to] = ends.map(|[x, y, z]| Vector::new(x, y, z));
    let here = Placement::IDENTITY;
    query::distance(&here, &Segment::new(from, to), &here, &prism)
        .expect("both shapes are known")
        .distance
}

/// Returns the distance in space of an axis from an upright cylinder \[m\]; 0 where they meet.
pub fn distance_to_cylinder(ends: [[f64; 3]; 2], centre: [f64; 2], radius: f64, [low, high]: [f64; 2]) -> f64 {
    // The axis of a cylinder of this library is y: z takes its place.
    let turned = |[x, y, z]: [f64; 3]| Vector::new(y - centre[1], z - 0.5 * (low + high), x - centre[0]);
    let [from, to] = ends.map(turned);
    let here = Placement::IDENTITY;
    let cylinder = Cylinder::new(0.5 * (high - low), radius);
    query::distance(&here, &Segment::new(from, to), &here, &cylinder)
        .expect("both shapes are known")
        .distance
}

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
pub enum Fault {
    /// No fault.
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
    [design.base_radius() * angle.cos(), design.base_radius() * angle.sin()]
}

fn bodies(model: &Model, design: &Design, pose: &Pose, report: &PoseEvaluation) -> Vec<Body> {
    let leg = |index: usize| LegMembers {
        model,
        design,
        index,
        platform: pose.position.to_array(),
        a: anchor(design, index),
        b: report.b[index],
        c: report.c[index],
    };
    (0..3).flat_map(|index| leg(index).all()).collect()
}

/// The joints of a leg, from which its members are built.
struct LegMembers<'a> {
    model: &'a Model,
    design: &'a Design,
    index: usize,
    platform: [f64; 2],
    a: [f64; 2],
    b: [f64; 2],
    c: [f64; 2],
}

impl LegMembers<'_> {
    fn all(&self) -> Vec<Body> {
        let mut all = match self.design.architecture().chain_name() {
            "PRR" => vec![self.slider(), self.link()],
            "PRP" => vec![self.slider(), self.guide_on_platform()],
            "PPR" => vec![self.slider(), self.guide_on_slider()],
            "RRP" => vec![self.crank(), self.guide_on_platform()],
            "RRR" => vec![self.crank(), self.link()],
            "RPP" => vec![self.turning_guide(), self.guide_on_platform()],
            "RPR" => vec![self.telescopic_leg()],
            other => panic!("which members has a leg of the chain {other}?"),
        };
        all.push(self.platform_bar());
        all
    }

    /// A member with the radius of the bars of the legs; `joints` are the letters of its joints.
    fn body(&self, name: &str, joints: &[&str], ends: [[f64; 2]; 2], layer: f64) -> Body {
        let design = self.design;
        let diameter = 2.0 * design.leg_bar_radius().max(design.platform_bar_radius());
        Body {
            name: format!("leg{}_{name}", self.index + 1),
            joints: joints.iter().map(|joint| format!("{joint}{}", self.index)).collect(),
            ends: ends.map(|[x, y]| Vector::new(x, y, layer * diameter)),
            radius: design.leg_bar_radius(),
        }
    }

    fn layers(&self) -> &Layers {
        &self.model.settings().bodies.layers
    }

    /// Direction of the rail.
    fn rail(&self) -> [f64; 2] {
        let way = direction(self.a, anchor(self.design, self.index + 1));
        turned(way, self.design.rail_angle_deg())
    }

    /// Direction of the arm of the platform.
    fn arm(&self) -> [f64; 2] {
        direction(self.platform, self.c)
    }

    fn link(&self) -> Body {
        self.body("link", &["B", "C"], [self.b, self.c], self.layers().link)
    }

    fn crank(&self) -> Body {
        self.body("crank", &["A", "B"], [self.a, self.b], self.layers().crank)
    }

    fn slider(&self) -> Body {
        let bodies = &self.model.settings().bodies;
        let half = (0.5 * bodies.slider_length - bodies.slider_half_width) * self.design.leg_bar_radius();
        let rail = self.rail();
        let ends = [-half, half].map(|by| moved(self.b, by, rail));
        Body {
            radius: bodies.slider_half_width * self.design.leg_bar_radius(),
            ..self.body("slider", &["B"], ends, bodies.layers.slider)
        }
    }

    /// The two ends of a guide about the joint that it is fixed to.
    fn guide_ends(&self, at: [f64; 2], way: [f64; 2], length: f64) -> [[f64; 2]; 2] {
        let [low, high] = self.model.settings().legs.geometry.arrangement().guide;
        [low.min(0.0), high.max(0.0)].map(|share| moved(at, share * length, way))
    }

    fn guide_on_slider(&self) -> Body {
        let way = turned(self.rail(), self.design.guide_angle_deg());
        let ends = self.guide_ends(self.b, way, self.design.link_length());
        self.body("guide", &["B", "C"], ends, self.layers().guide)
    }

    fn guide_on_platform(&self) -> Body {
        let way = turned(self.arm(), self.design.platform_guide_angle_deg());
        let ends = self.guide_ends(self.c, way, self.design.link_length());
        self.body("guide", &["B", "C"], ends, self.layers().guide)
    }

    fn turning_guide(&self) -> Body {
        let degrees = self.design.platform_guide_angle_deg() + self.design.guide_angle_deg();
        let ends = self.guide_ends(self.a, turned(self.arm(), degrees), self.design.proximal_length());
        self.body("turning_guide", &["A", "B"], ends, self.layers().turning_guide)
    }

    fn telescopic_leg(&self) -> Body {
        let shortest = self.model.settings().legs.telescopic_shortest;
        let rod = (1.0 - shortest.min(0.5)) * self.design.link_length();
        let length = (self.c[0] - self.a[0]).hypot(self.c[1] - self.a[1]);
        let tail = if rod > length {
            moved(self.c, rod, direction(self.c, self.a))
        } else {
            self.a
        };
        self.body(
            "telescopic_leg",
            &["A", "C"],
            [tail, self.c],
            self.layers().telescopic_leg,
        )
    }

    fn platform_bar(&self) -> Body {
        let mut bar = self.body("platform_bar", &["C"], [self.c, self.platform], self.layers().platform);
        bar.joints.push("P".to_owned());
        Body {
            name: format!("platform_bar{}", self.index + 1),
            radius: self.design.platform_bar_radius(),
            ..bar
        }
    }
}

fn turned([x, y]: [f64; 2], degrees: f64) -> [f64; 2] {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    [cosine * x - sine * y, sine * x + cosine * y]
}

fn direction(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    let way = [to[0] - from[0], to[1] - from[1]];
    let length = way[0].hypot(way[1]);
    way.map(|part| part / length)
}

fn moved(from: [f64; 2], by: f64, way: [f64; 2]) -> [f64; 2] {
    [from[0] + by * way[0], from[1] + by * way[1]]
}

fn distance(a: &Body, b: &Body) -> f64 {
    let (on_a, on_b) =
        closest_points_segment_segment_with_locations_nD((&a.ends[0], &a.ends[1]), (&b.ends[0], &b.ends[1]));
    let at = |body: &Body, on| Segment::new(body.ends[0], body.ends[1]).point_at(&on);
    at(a, on_a).distance(at(b, on_b)) - a.radius - b.radius
}

/// The nearest pair of members according to the oracle.
pub struct Found {
    /// Its clearance.
    pub least: f64,
    /// Names of its two members.
    pub pair: [String; 2],
    /// Clearance of the second nearest pair.
    pub second: f64,
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

/// Returns the nearest pair of members at a reachable pose, with `fault` introduced.
pub fn oracle(model: &Model, design: &Design, pose: &Pose, report: &PoseEvaluation, fault: Fault) -> Found {
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
    if design.architecture().chain_name().starts_with('P') && fault != Fault::NoRailEnds {
        let half = 0.5 * model.settings().bodies.slider_length * design.leg_bar_radius();
        let travel = 3f64.sqrt() * design.base_radius();
        for leg in 0..3 {
            let (from, to) = (anchor(design, leg), report.b[leg]);
            let along = (to[0] - from[0]).hypot(to[1] - from[1]);
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
