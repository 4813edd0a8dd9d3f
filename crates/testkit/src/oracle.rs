//! Oracle of the clearance: capsules constructed here from the joints in a pose evaluation, and the distance of segments
//! in space by `parry3d`.

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
    let layers = &model.settings().bodies.layers;
    let diameter = 2.0 * design.leg_bar_radius().max(design.platform_bar_radius());
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
        let rj = design.leg_bar_radius();
        let number = leg + 1;
        let toward = |from: [f64; 2], to: [f64; 2], length: f64| {
            let way = [to[0] - from[0], to[1] - from[1]];
            let fraction = length / way[0].hypot(way[1]);
            [from[0] + fraction * way[0], from[1] + fraction * way[1]]
        };
        let link = body(
            format!("leg{number}_link"),
            &[b.clone(), c.clone()],
            [at_b, at_c],
            layers.link,
            rj,
        );
        // The guide on the platform, or on a slider, and its two ends.
        let turn = |[x, y]: [f64; 2], degrees: f64| {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            [cosine * x - sine * y, sine * x + cosine * y]
        };
        let along = |from: [f64; 2], to: [f64; 2]| {
            let way = [to[0] - from[0], to[1] - from[1]];
            let length = way[0].hypot(way[1]);
            way.map(|part| part / length)
        };
        let ends = |at: [f64; 2], way: [f64; 2], length: f64| {
            let [low, high] = model.settings().legs.geometry.arrangement().guide;
            let end = |share: f64| [at[0] + share * length * way[0], at[1] + share * length * way[1]];
            [end(low.min(0.0)), end(high.max(0.0))]
        };
        let chain = design.architecture().chain_name();
        let guide = if chain == "PPR" {
            let rail = turn(along(at_a, anchor(design, leg + 1)), design.rail_angle_deg());
            Some(ends(at_b, turn(rail, design.guide_angle_deg()), design.link_length()))
        } else if chain.ends_with('P') {
            let arm = along(pose.position.to_array(), at_c);
            Some(ends(
                at_c,
                turn(arm, design.platform_guide_angle_deg()),
                design.link_length(),
            ))
        } else {
            None
        };
        let slider = || {
            let half = (0.5 * model.settings().bodies.slider_length - model.settings().bodies.slider_half_width) * rj;
            let rail = turn(along(at_a, anchor(design, leg + 1)), design.rail_angle_deg());
            let end = |by: f64| [at_b[0] + by * rail[0], at_b[1] + by * rail[1]];
            let thick = model.settings().bodies.slider_half_width * rj;
            body(
                format!("leg{number}_slider"),
                std::slice::from_ref(&b),
                [end(-half), end(half)],
                layers.slider,
                thick,
            )
        };
        let crank = || {
            body(
                format!("leg{number}_crank"),
                &[a.clone(), b.clone()],
                [at_a, at_b],
                layers.crank,
                rj,
            )
        };
        let guide = guide.map(|ends| {
            body(
                format!("leg{number}_guide"),
                &[b.clone(), c.clone()],
                ends,
                layers.guide,
                rj,
            )
        });
        match chain {
            "PRR" => all.extend([slider(), link]),
            "PRP" | "PPR" => all.extend([slider()].into_iter().chain(guide)),
            "RRP" => all.extend([crank()].into_iter().chain(guide)),
            "RRR" => all.extend([crank(), link]),
            "RPP" => {
                let arm = along(pose.position.to_array(), at_c);
                let way = turn(arm, design.platform_guide_angle_deg() + design.guide_angle_deg());
                let turning = body(
                    format!("leg{number}_turning_guide"),
                    &[a, b.clone()],
                    ends(at_a, way, design.proximal_length()),
                    layers.turning_guide,
                    rj,
                );
                all.extend([turning].into_iter().chain(guide));
            }
            _ => {
                let shortest = model.settings().legs.telescopic_shortest;
                let rod = (1.0 - shortest.min(0.5)) * design.link_length();
                let length = (at_c[0] - at_a[0]).hypot(at_c[1] - at_a[1]);
                let tail = if rod > length { toward(at_c, at_a, rod) } else { at_a };
                all.push(body(
                    format!("leg{number}_telescopic_leg"),
                    &[a, c.clone()],
                    [tail, at_c],
                    layers.telescopic_leg,
                    rj,
                ));
            }
        }
        all.push(body(
            format!("platform_bar{number}"),
            &[c, "P".to_owned()],
            [at_c, pose.position.to_array()],
            layers.platform,
            design.platform_bar_radius(),
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
