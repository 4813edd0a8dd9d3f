//! What stands beside the manipulator: obstacles that no member may touch, and the room that no member may leave
//! (docs/model.md, section 8.3).

use std::sync::Arc;

use glam::DVec2;

use super::capsule::Neighbour;
use super::distance::{between_prisms, nearer, nearest_points, squared};
use crate::lanes::{Planar, Real};
use crate::mechanism::MemberAxis;
use crate::polygon::Polygon;
use crate::spatial::NUMBER_LIMIT;

/// Outline of an obstacle in the base frame \[m\].
#[derive(Debug, Clone, PartialEq)]
pub enum ObstacleShape {
    /// An upright cylinder.
    Disc {
        /// Centre.
        centre: DVec2,
        /// Radius.
        radius: f64,
    },
    /// An upright prism.
    Polygon(Polygon),
}

/// A body that stands still beside the manipulator.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    /// Name, as messages show it.
    pub name: Arc<str>,
    /// Outline.
    pub shape: ObstacleShape,
    /// Lowest and highest point above the layer of the platform bars \[m\]; infinite for a body without an end.
    pub heights: [f64; 2],
}

/// What stands beside a manipulator, by default nothing.
///
/// ```
/// use glam::DVec2;
/// use kinefront_model::clearance::{Obstacle, ObstacleShape, Surroundings};
/// use kinefront_model::evaluation::{Model, ModelSettings};
/// use kinefront_model::spatial::Pose;
///
/// let design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056".parse()?;
/// let column = Obstacle {
///     name: "column".into(),
///     shape: ObstacleShape::Disc { centre: DVec2::new(0.0, 2.0), radius: 0.1 },
///     heights: [f64::NEG_INFINITY, f64::INFINITY],
/// };
/// let surroundings = Surroundings { obstacles: vec![column], room: None };
/// let model = Model::new(ModelSettings { surroundings, ..ModelSettings::default() })?;
/// // The column stands in the way of the platform bar of leg 3.
/// let [member, neighbour] = model.pose(&design, &Pose::new(0.0, 0.75, 0.5))?.nearest.pair();
/// assert_eq!(neighbour, "column");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Surroundings {
    /// Bodies that no member may touch.
    pub obstacles: Vec<Obstacle>,
    /// Outline that no member may leave.
    pub room: Option<Polygon>,
}

/// Side of an outline on which the members have to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    Inside,
    Outside,
}

/// An outline that no member may cross, prepared for many poses.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Barrier {
    /// What it is.
    pub neighbour: Neighbour,
    /// Side of the outline on which the members have to be.
    pub side: Side,
    /// Ends of its edges \[m\]; those of a disc are both its centre.
    pub edges: Vec<[DVec2; 2]>,
    /// Radius by which the edges are rounded: that of a disc, otherwise 0 \[m\].
    pub rounding: f64,
    /// Lowest and highest point \[m\].
    pub heights: [f64; 2],
    /// A circle that contains the outline \[m\].
    circle: (DVec2, f64),
}

impl Surroundings {
    /// Whether there is nothing around the manipulator.
    pub fn is_empty(&self) -> bool {
        self.obstacles.is_empty() && self.room.is_none()
    }

    /// Prepares the outlines.
    pub(crate) fn barriers(&self) -> Vec<Barrier> {
        let room = self.room.as_ref().map(|room| {
            let anywhere = [f64::NEG_INFINITY, f64::INFINITY];
            Barrier::of_polygon(Neighbour::Room, Side::Inside, room, anywhere)
        });
        let obstacles = self.obstacles.iter().map(|obstacle| {
            let neighbour = Neighbour::Obstacle(obstacle.name.clone());
            match &obstacle.shape {
                ObstacleShape::Polygon(polygon) => {
                    Barrier::of_polygon(neighbour, Side::Outside, polygon, obstacle.heights)
                }
                ObstacleShape::Disc { centre, radius } => Barrier {
                    neighbour,
                    side: Side::Outside,
                    edges: vec![[*centre; 2]],
                    rounding: *radius,
                    heights: obstacle.heights,
                    circle: (*centre, *radius),
                },
            }
        });
        obstacles.chain(room).collect()
    }
}

/// Size of a body about its axis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BodySize {
    /// Twice the height of a horizontal axis, or the lowest and the highest point of an upright cylinder \[m\].
    pub heights: [f64; 2],
    /// Radius, or half the width of a square tube \[m\].
    pub radius: f64,
    /// How far the body extends beyond these heights \[m\].
    pub beyond: f64,
    /// Whether its sides are upright.
    pub is_prism: bool,
}

impl Barrier {
    fn of_polygon(neighbour: Neighbour, side: Side, polygon: &Polygon, heights: [f64; 2]) -> Self {
        let [low, high] = polygon.bounds();
        let middle = 0.5 * (low + high);
        Self {
            neighbour,
            side,
            edges: polygon.sides().collect(),
            rounding: 0.0,
            heights,
            circle: (middle, middle.distance(high)),
        }
    }

    /// Returns by how much a range of heights lies above or below the outline \[m\]; negative where they overlap.
    pub fn gap_to_heights(&self, [from, to]: [f64; 2]) -> f64 {
        let [low, high] = self.heights;
        (low - to).max(from - high).clamp(-NUMBER_LIMIT, NUMBER_LIMIT)
    }

    /// Returns whether a member with an axis is on the right side of the outline, of which it is known that the axis does not cross
    /// it.
    pub fn is_on_right_side(&self, point: DVec2) -> bool {
        self.is_on_right_side_lanes(point.into())
    }

    /// Does the same at several poses at once.
    #[inline(always)]
    fn is_on_right_side_lanes<V: Real>(&self, point: Planar<V>) -> V::Mask {
        let (zero, one) = (point.x.splat(0.0), point.x.splat(1.0));
        // How often the edges wind about the point (Hormann, Agathos 2001).
        let mut winding = zero;
        for [from, to] in &self.edges {
            let (from, to) = (Planar::splat(zero, *from), Planar::splat(zero, *to));
            let left = to.minus(from).cross(point.minus(from));
            let rises = point.y.at_least(from.y) & to.y.exceeds(point.y) & left.exceeds(zero);
            let falls = point.y.at_least(to.y) & from.y.exceeds(point.y) & zero.exceeds(left);
            winding = winding + one.select(rises, zero) - one.select(falls, zero);
        }
        let half = point.x.splat(0.5);
        match self.side {
            Side::Inside => winding.abs().exceeds(half),
            Side::Outside => half.exceeds(winding.abs()),
        }
    }

    /// Returns the clearance of a body from the outline at several poses at once \[m\]. Where it overlaps, the result is negative.
    #[inline(always)]
    pub fn clearance<V: Real>(&self, axis: &MemberAxis<V>, size: &BodySize) -> V {
        let like = axis.length;
        let mut nearest = like.splat(f64::INFINITY);
        for [from, to] in &self.edges {
            nearest = squared(axis, &edge(like, *from, *to)).smaller(nearest);
        }
        let distance = nearest.sqrt();
        // The only edge of a disc, its centre, winds about no point.
        let is_right = self.is_on_right_side_lanes(axis.from);
        let across = distance.select(is_right, -distance) - like.splat(self.rounding);
        // A bar keeps its radius in every direction, a square tube both widths, and an upright cylinder its radius in the plane.
        let (of_prism, of_bar) = if size.is_prism {
            (size.radius, 0.0)
        } else {
            (0.0, size.radius)
        };
        let across = across - like.splat(of_prism);
        let beyond = if size.is_prism { size.beyond } else { 0.0 };
        let along_z = like.splat(self.gap_to_heights(size.heights) - beyond);
        between_prisms(across, along_z) - like.splat(of_bar)
    }

    /// Returns where a member may be nearer to the outline than `distance`.
    #[inline(always)]
    pub fn may_be_nearer<V: Real>(&self, axis: &MemberAxis<V>, distance: V) -> V::Mask {
        let (centre, radius) = self.circle;
        let half = axis.length * axis.length.splat(0.5);
        let way = axis
            .from
            .plus(axis.direction.scaled(half))
            .minus(Planar::splat(half, centre));
        let reach = half + distance + distance.splat(radius);
        match self.side {
            Side::Inside => distance.at_least(distance),
            Side::Outside => reach.exceeds(reach.splat(0.0)) & (reach * reach).exceeds(way.dot(way)),
        }
    }

    /// Returns the point of an axis that is nearest to the outline in the plane, and the point of the outline that is nearest to it \[m\];
    /// a point of the axis that is on the wrong side, twice, if there is one.
    pub fn nearest_points(&self, axis: &MemberAxis<f64>) -> [DVec2; 2] {
        let ends = [axis.from, axis.to()].map(|end| DVec2::new(end.x, end.y));
        if !self.is_on_right_side(ends[0]) {
            return [ends[0]; 2];
        }
        let all = self.edges.iter().map(|edge| nearest_points(ends, *edge));
        let [at, on] = all.reduce(nearer).expect("an outline has edges");
        if at.distance(on) <= self.rounding {
            return [at; 2];
        }
        [at, on + (at - on).normalize_or_zero() * self.rounding]
    }
}

/// Returns an edge as an axis at several poses at once.
#[inline(always)]
fn edge<V: Real>(like: V, from: DVec2, to: DVec2) -> MemberAxis<V> {
    let way = to - from;
    let length = way.length();
    let direction = if length > 0.0 { way / length } else { DVec2::X };
    MemberAxis {
        from: Planar::splat(like, from),
        direction: Planar::splat(like, direction),
        length: like.splat(length),
    }
}
