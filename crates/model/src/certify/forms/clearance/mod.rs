//! Forms of the clearance, g7 (docs/model.md, section 13.3).
//!
//! Two members are farther apart than `δ` in the plane if a direction `n` separates them: `n · (b − a) > δ |n|` for all points `a`
//! of one axis and `b` of the other. The axes are straight, so that their ends suffice. The direction is that of the shortest line
//! between the axes in the middle of the box, and it turns with the members. The forms are therefore positive only where the
//! constraint holds, and for small boxes almost everywhere there.

mod separation;
mod sizes;

use glam::DVec2;

use self::separation::{Bounds, nearest, separate};
use self::sizes::{Members, barriers, pairs};
use super::Enclosures;
use crate::clearance::{Barrier, DISTAL, MEMBERS, PLATFORM, PROXIMAL};
use crate::enclosure::{
    AxisEnclosure, Interval, MembersEnclosure, PlanarModel, PoseEnclosure, TaylorModel, difference, dot, sum,
};
use crate::evaluation::{Model, PoseScalar};
use crate::mechanism::{AnyLeg, Design, JointPoint, LegEnclosure, LegFrameEnclosure, LegSettings, MemberKind};
use crate::spatial::LEGS;

/// What g7 needs of a design. Lengths are multiples of `L_b` unless stated otherwise.
pub(super) struct Separations {
    settings: LegSettings,
    /// `1/L_b` \[1/m\].
    to_unit: Interval,
    /// Half the length of the axis of a slider.
    slider: Interval,
    /// Distance that the centre of a slider must keep from the ends of its rail \[m\].
    from_rail_end: Interval,
    /// Joints that are bodies: their legs and where they are in the plane.
    joints: Vec<(usize, JointPoint)>,
    pairs: Vec<SeparatedPair>,
    barriers: Vec<SeparatedBarrier>,
}

/// Two bodies that must keep a distance.
struct SeparatedPair {
    /// Indices of both: `LEGS · row + leg` for a member, from [`MEMBERS`] for a joint.
    places: [usize; 2],
    /// Square of the distance that their axes must keep in the plane: that of the sum of the radii and the clearance, less that of
    /// their layers.
    square: Interval,
    /// Upper bound of this distance.
    distance: f64,
}

/// An outline that members must not cross.
struct SeparatedBarrier {
    barrier: Barrier,
    /// What the axis of each body must keep from its edges; `None` where its heights alone do.
    distances: Vec<Option<Distance>>,
}

/// A distance that two axes must keep in the plane.
#[derive(Clone, Copy)]
struct Distance {
    /// Its square.
    square: Interval,
    /// Upper bound of it.
    upper: f64,
    /// Whether it is certain that the layers alone do not keep the clearance.
    is_certain: bool,
}

/// The members over a box of poses.
pub(super) struct MemberBoxes {
    /// Position of `P` \[m\].
    position: PlanarModel,
    /// The axes, indexed by `LEGS · row + leg` for the members; then those of the joints.
    axes: Vec<Option<AxisEnclosure>>,
    rails: [Option<[TaylorModel; 2]>; LEGS],
}

impl Separations {
    /// Returns `None` if the study requires no clearance.
    pub fn new(model: &Model, design: &Design) -> Option<Self> {
        let clearance = Interval::exactly(model.settings().thresholds.get(PoseScalar::Clearance)?);
        let exactly = Interval::exactly;
        let bodies = &model.settings().bodies;
        let to_unit = exactly(1.0) / exactly(design.link_length());
        let leg_bar = exactly(design.leg_bar_radius());
        let half_length = exactly(0.5) * exactly(bodies.slider_length) * leg_bar;
        let half_axis = half_length - exactly(bodies.slider_half_width) * leg_bar;
        let members = Members::new(model, design);
        Some(Self {
            joints: members
                .uprights
                .iter()
                .map(|upright| (upright.leg, upright.point))
                .collect(),
            settings: model.settings().legs,
            to_unit,
            slider: half_axis.max(exactly(0.0)) * to_unit,
            from_rail_end: half_length + clearance,
            pairs: pairs(&members, clearance),
            barriers: barriers(model, &members, clearance),
        })
    }

    /// Lays the members out over a box of poses.
    pub fn lay_out(
        &self,
        design: &Design,
        frames: &[LegFrameEnclosure; LEGS],
        pose: &PoseEnclosure,
        legs: &[LegEnclosure; LEGS],
    ) -> MemberBoxes {
        let mut boxes = MemberBoxes {
            position: pose.position,
            axes: vec![None; MEMBERS],
            rails: [None; LEGS],
        };
        let position = pose.position.map(|part| part.scaled(self.to_unit));
        let anchor = |frame: &LegFrameEnclosure| {
            let at_base = frame.anchor.map(|part| TaylorModel::constant(part * frame.to_unit));
            difference(at_base, position)
        };
        let mut elbows = [None; LEGS];
        for (index, leg) in legs.iter().enumerate() {
            let frame = &frames[index];
            let arm = leg.arm;
            let length = frame.arm_length * frame.to_unit;
            let tip = arm.map(|part| part.scaled(length));
            let is_slider = design.architecture().chain().proximal == Some(MemberKind::Slider);
            let MembersEnclosure { proximal, distal, rail } =
                AnyLeg::enclose_members(frame, design, &self.settings, leg, anchor(frame), tip);
            // A slider is a point before it is extended, and a crank or turning guide leads from the base to the joint.
            elbows[index] = proximal.map(|axis| axis.points[if is_slider { 0 } else { 1 }]);
            boxes.axes[LEGS * PROXIMAL + index] = proximal.map(|axis| {
                if !is_slider {
                    return axis;
                }
                let half = axis.direction.map(|part| part.scaled(self.slider));
                let [centre, ..] = axis.points;
                AxisEnclosure::between(difference(centre, half), sum(centre, half), axis.direction)
            });
            boxes.axes[LEGS * DISTAL + index] = Some(distal);
            let middle = [TaylorModel::exactly(0.0); 2];
            boxes.axes[LEGS * PLATFORM + index] = Some(AxisEnclosure::between(middle, tip, arm));
            boxes.rails[index] = rail;
        }
        for &(leg, point) in &self.joints {
            let at = match point {
                JointPoint::A => Some(anchor(&frames[leg])),
                JointPoint::B => elbows[leg],
                JointPoint::C => boxes.axes[LEGS * PLATFORM + leg].map(|bar| bar.points[1]),
            };
            let right = [TaylorModel::exactly(1.0), TaylorModel::exactly(0.0)];
            boxes.axes.push(at.map(|at| AxisEnclosure::between(at, at, right)));
        }
        boxes
    }

    /// Encloses g7 over a box: a form per rail end, and those of the pairs that are not proved.
    ///
    /// On which side of an outline a member is follows from the forms of its edges on the whole box alone, so that no part of the box may
    /// be cut off by these forms.
    pub fn enclose(&self, boxes: &MemberBoxes, found: &mut Enclosures) {
        self.enclose_rail_ends(boxes, found);
        self.for_near_pairs(boxes, |pair, a, b| separate(a, b, pair.distance, found));
        let before = found.count();
        self.for_near_edges(boxes, found, |[axis, edge], distance, found| {
            separate(axis, edge, distance.upper, found);
        });
        found.may_contract &= found.count() == before;
    }

    /// Encloses g7 at a pose: the square of the distance between two points of the axes, less that which they must keep.
    pub fn enclose_pose(&self, boxes: &MemberBoxes, found: &mut Enclosures) {
        self.enclose_rail_ends(boxes, found);
        self.for_near_pairs(boxes, |pair, a, b| {
            let way = difference(nearest(b, a), nearest(a, b));
            found.push(PoseScalar::Clearance, dot(way, way).plus(-pair.square));
        });
        self.for_near_edges(boxes, found, |[axis, edge], distance, found| {
            let way = difference(nearest(edge, axis), nearest(axis, edge));
            let form = dot(way, way).plus(-distance.square);
            let is_refuted = form.is_negative() && !distance.is_certain;
            found.push(PoseScalar::Clearance, if is_refuted { undecided() } else { form });
        });
    }

    fn enclose_rail_ends(&self, boxes: &MemberBoxes, found: &mut Enclosures) {
        for distance in boxes.rails.iter().flatten().flatten() {
            found.push(PoseScalar::Clearance, distance.plus(-self.from_rail_end));
        }
    }

    /// Calls `examine` with the pairs whose bounding boxes are not far enough from each other.
    fn for_near_pairs(
        &self,
        boxes: &MemberBoxes,
        mut examine: impl FnMut(&SeparatedPair, &AxisEnclosure, &AxisEnclosure),
    ) {
        let axes = boxes.axes.iter().map(Option::as_ref);
        let bounded: Vec<_> = axes.map(|axis| axis.map(|axis| (axis, Bounds::of(axis)))).collect();
        for pair in &self.pairs {
            if let [Some((a, of_a)), Some((b, of_b))] = pair.places.map(|place| &bounded[place])
                && !of_a.is_farther(of_b, pair.distance)
            {
                examine(pair, a, b);
            }
        }
    }

    /// Calls `examine` with the axes of members and the edges of outlines that are not far enough from each other, and with the distance that
    /// they must keep. Of a member that is on the wrong side of an outline in the middle of the box, nothing is proved.
    ///
    /// A member that keeps a distance from every edge over a box does not change its side there.
    fn for_near_edges(
        &self,
        boxes: &MemberBoxes,
        found: &mut Enclosures,
        examine: impl Fn([&AxisEnclosure; 2], Distance, &mut Enclosures),
    ) {
        let position = boxes.position.map(|part| part.scaled(self.to_unit));
        for separated in &self.barriers {
            let barrier = &separated.barrier;
            let edges: Vec<(AxisEnclosure, Bounds)> = barrier
                .edges
                .iter()
                .map(|[from, to]| {
                    let place = |end: &DVec2| {
                        let fixed = end.to_array().map(|part| Interval::exactly(part) * self.to_unit);
                        difference(fixed.map(TaylorModel::constant), position)
                    };
                    let axis = AxisEnclosure::between(place(from), place(to), along(*from, *to));
                    let bounds = Bounds::of(&axis);
                    (axis, bounds)
                })
                .collect();
            for (place, axis) in boxes.axes.iter().enumerate() {
                let (Some(axis), Some(distance)) = (axis, separated.distances[place]) else {
                    continue;
                };
                let middle = [0, 1].map(|k| {
                    let of_member = axis.points[0][k].constant;
                    (of_member + position[k].constant) / self.to_unit.lower()
                });
                if !barrier.is_on_right_side(DVec2::from_array(middle)) {
                    let is_certain = distance.is_certain;
                    let form = if is_certain {
                        TaylorModel::exactly(-1.0)
                    } else {
                        undecided()
                    };
                    found.push(PoseScalar::Clearance, form);
                    continue;
                }
                let bounds = Bounds::of(axis);
                for (edge, of_edge) in &edges {
                    if !bounds.is_farther(of_edge, distance.upper) {
                        examine([axis, edge], distance, found);
                    }
                }
            }
        }
    }
}

/// A form of which nothing is known.
fn undecided() -> TaylorModel {
    TaylorModel::constant(Interval::new(-1.0, 1.0))
}

/// Encloses the unit vector along an edge; any vector for one without length.
fn along(from: DVec2, to: DVec2) -> PlanarModel {
    let exactly = Interval::exactly;
    let way = [exactly(to.x) - exactly(from.x), exactly(to.y) - exactly(from.y)];
    if from == to {
        return [TaylorModel::exactly(1.0), TaylorModel::exactly(0.0)];
    }
    let length = (way[0].square() + way[1].square()).sqrt();
    way.map(|part| TaylorModel::constant(part / length))
}
