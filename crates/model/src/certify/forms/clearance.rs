//! Forms of the clearance, g7 (docs/model.md, section 13.3).
//!
//! Two members are farther apart than `δ` in the plane if a direction `n` separates them: `n · (b − a) > δ |n|` for all points `a`
//! of one axis and `b` of the other. The axes are straight, so that their ends suffice. The direction is that of the shortest line
//! between the axes in the middle of the box, and it turns with the members. The forms are therefore positive only where the
//! constraint holds, and for small boxes almost everywhere there.

use glam::DVec2;

use super::Enclosures;
use crate::clearance::{Barrier, BodySettings, DISTAL, PLATFORM, PROXIMAL, ROWS, kinds, pairs_not_joined};
use crate::enclosure::{
    AxisEnclosure, Interval, MembersEnclosure, PlanarModel, PoseEnclosure, TaylorModel, difference, dot, sum,
};
use crate::evaluation::{Model, PoseScalar};
use crate::mechanism::{AnyLeg, Design, LegEnclosure, LegFrameEnclosure, LegSettings, MemberKind};
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
    pairs: Vec<SeparatedPair>,
    barriers: Vec<SeparatedBarrier>,
}

/// Two members that must keep a distance.
struct SeparatedPair {
    /// Indices of both members: `LEGS · row + leg`.
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
    /// What the axes of the members of each row must keep from its edges; `None` where their layer alone does.
    rows: [Option<Distance>; ROWS],
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
    /// The axes, indexed by `LEGS · row + leg`.
    axes: [Option<AxisEnclosure>; ROWS * LEGS],
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
        Some(Self {
            settings: model.settings().legs,
            to_unit,
            slider: Interval::new(half_axis.lower().max(0.0), half_axis.upper().max(0.0)) * to_unit,
            from_rail_end: half_length + clearance,
            pairs: pairs(model, design, clearance),
            barriers: barriers(model, design, clearance),
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
            axes: [None; ROWS * LEGS],
            rails: [None; LEGS],
        };
        let position = pose.position.map(|part| part.scaled(self.to_unit));
        for (index, leg) in legs.iter().enumerate() {
            let frame = &frames[index];
            let arm = leg.arm;
            let length = frame.arm_length * frame.to_unit;
            let tip = arm.map(|part| part.scaled(length));
            let at_base = frame.anchor.map(|part| TaylorModel::constant(part * frame.to_unit));
            let anchor = difference(at_base, position);
            let MembersEnclosure { proximal, distal, rail } =
                AnyLeg::enclose_members(frame, design, &self.settings, leg, anchor, tip);
            boxes.axes[LEGS * PROXIMAL + index] = proximal.map(|axis| match design.architecture().chain().proximal {
                Some(MemberKind::Slider) => {
                    let half = axis.direction.map(|part| part.scaled(self.slider));
                    let [centre, ..] = axis.points;
                    AxisEnclosure::between(difference(centre, half), sum(centre, half), axis.direction)
                }
                _ => axis,
            });
            boxes.axes[LEGS * DISTAL + index] = Some(distal);
            let middle = [TaylorModel::exactly(0.0); 2];
            boxes.axes[LEGS * PLATFORM + index] = Some(AxisEnclosure::between(middle, tip, arm));
            boxes.rails[index] = rail;
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
        self.for_near_edges(boxes, |seen| match seen {
            Seen::Edge { axis, edge, distance } => separate(axis, edge, distance.upper, found),
            Seen::WrongSide(distance) => found.push(PoseScalar::Clearance, wrong_side(distance)),
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
        self.for_near_edges(boxes, |seen| match seen {
            Seen::Edge { axis, edge, distance } => {
                let way = difference(nearest(edge, axis), nearest(axis, edge));
                let form = dot(way, way).plus(-distance.square);
                let is_refuted = form.is_negative() && !distance.is_certain;
                found.push(PoseScalar::Clearance, if is_refuted { undecided() } else { form });
            }
            Seen::WrongSide(distance) => found.push(PoseScalar::Clearance, wrong_side(distance)),
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
        let bounds = boxes.axes.map(|axis| axis.map(|axis| Bounds::of(&axis)));
        for pair in &self.pairs {
            let [first, second] = pair.places;
            if let (Some(a), Some(b), Some(bounds_a), Some(bounds_b)) =
                (&boxes.axes[first], &boxes.axes[second], &bounds[first], &bounds[second])
                && !bounds_a.is_farther(bounds_b, pair.distance)
            {
                examine(pair, a, b);
            }
        }
    }
}

/// What is to be proved of a member and an outline.
enum Seen<'a> {
    /// That its axis keeps a distance from an edge.
    Edge {
        axis: &'a AxisEnclosure,
        edge: &'a AxisEnclosure,
        distance: Distance,
    },
    /// Nothing: it is on the wrong side in the middle of the box.
    WrongSide(Distance),
}

/// A form of which nothing is known.
fn undecided() -> TaylorModel {
    TaylorModel::constant(Interval::new(-1.0, 1.0))
}

/// The form of a member that is on the wrong side of an outline.
fn wrong_side(distance: Distance) -> TaylorModel {
    if distance.is_certain {
        TaylorModel::exactly(-1.0)
    } else {
        undecided()
    }
}

impl Separations {
    /// Calls `examine` with the edges of outlines that are not far enough from a member, and with the members that are on the wrong side.
    ///
    /// A member that keeps a distance from every edge over a box does not change its side there.
    fn for_near_edges(&self, boxes: &MemberBoxes, mut examine: impl FnMut(Seen<'_>)) {
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
                let (Some(axis), Some(distance)) = (axis, separated.rows[place / LEGS]) else {
                    continue;
                };
                let middle = [0, 1].map(|k| {
                    let of_member = axis.points[0][k].constant;
                    (of_member + position[k].constant) / self.to_unit.lower()
                });
                if !barrier.is_on_right_side(DVec2::from_array(middle)) {
                    examine(Seen::WrongSide(distance));
                    continue;
                }
                let bounds = Bounds::of(axis);
                for (edge, of_edge) in &edges {
                    if !bounds.is_farther(of_edge, distance.upper) {
                        examine(Seen::Edge { axis, edge, distance });
                    }
                }
            }
        }
    }
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

/// The outlines, with what members of each row must keep from them.
fn barriers(model: &Model, design: &Design, clearance: Interval) -> Vec<SeparatedBarrier> {
    let exactly = Interval::exactly;
    let members = Members::new(model, design);
    let kinds = kinds(design.architecture());
    let of_row = |barrier: &Barrier, row: usize| {
        let kind = kinds[row]?;
        let radius = members.radius(kind);
        let height = members.height(kind);
        let [low, high] = barrier.heights.map(exactly);
        let [below, above] = [low - height, height - high];
        // By how much the layer lies above or below, if it does.
        let gap = Interval::new(
            below.lower().max(above.lower()).max(0.0),
            below.upper().max(above.upper()).max(0.0),
        );
        let distance = radius + clearance;
        let (keep, is_certain) = if members.are_square[row] {
            let apart = gap - radius;
            (
                between_prisms(radius, gap, clearance)?,
                apart.upper() < clearance.lower(),
            )
        } else {
            let keep = distance.square() - gap.square();
            (keep, keep.lower() > 0.0)
        };
        if distance.upper() <= 0.0 || keep.upper() <= 0.0 {
            return None;
        }
        let keep = Interval::new(keep.lower().max(0.0), keep.upper());
        let square = (keep.sqrt() + exactly(barrier.rounding)).square() * members.to_unit.square();
        Some(Distance {
            square,
            upper: exactly(square.upper()).sqrt().upper(),
            is_certain,
        })
    };
    let all = model.barriers().iter().map(|barrier| SeparatedBarrier {
        barrier: barrier.clone(),
        rows: [0, 1, 2].map(|row| of_row(barrier, row)),
    });
    all.collect()
}

/// Sizes and heights of the members of a design as intervals \[m\].
struct Members<'a> {
    bodies: &'a BodySettings,
    design: &'a Design,
    /// Rows that consist of square tubes.
    are_square: [bool; ROWS],
    /// `1/L_b`.
    to_unit: Interval,
}

impl<'a> Members<'a> {
    fn new(model: &'a Model, design: &'a Design) -> Self {
        let sections = &model.settings().sections;
        let (legs, platform) = (sections.legs.is_square(), sections.platform.is_square());
        Self {
            bodies: &model.settings().bodies,
            design,
            are_square: [legs, legs, platform],
            to_unit: Interval::exactly(1.0) / Interval::exactly(design.link_length()),
        }
    }

    fn radius(&self, kind: MemberKind) -> Interval {
        let exactly = Interval::exactly;
        match kind {
            MemberKind::Slider => exactly(self.bodies.slider_half_width) * exactly(self.design.leg_bar_radius()),
            kind => exactly(self.bodies.radius(kind, self.design)),
        }
    }

    fn height(&self, kind: MemberKind) -> Interval {
        let exactly = Interval::exactly;
        let thicker = self.design.leg_bar_radius().max(self.design.platform_bar_radius());
        exactly(self.bodies.layers.of(kind)) * exactly(2.0) * exactly(thicker)
    }
}

/// The pairs that their layers alone do not keep apart.
fn pairs(model: &Model, design: &Design, clearance: Interval) -> Vec<SeparatedPair> {
    let members = Members::new(model, design);
    let exactly = Interval::exactly;
    let kinds = kinds(design.architecture());
    let keep = |places: [usize; 2]| {
        let [Some(first), Some(second)] = places.map(|place| kinds[place / LEGS]) else {
            return None;
        };
        let radii = members.radius(first) + members.radius(second);
        let distance = radii + clearance;
        let layers = members.height(first) - members.height(second);
        let square = if places.iter().any(|place| members.are_square[place / LEGS]) {
            between_prisms(radii, layers, clearance)?
        } else {
            distance.square() - layers.square()
        };
        let square = square * members.to_unit.square();
        (distance.upper() > 0.0 && square.upper() > 0.0).then(|| SeparatedPair {
            places,
            square,
            distance: exactly(square.upper()).sqrt().upper(),
        })
    };
    pairs_not_joined(kinds).filter_map(keep).collect()
}

/// The square of the distance that the axes of two prisms must keep in the plane; `None` if their layers alone keep the clearance.
fn between_prisms(radii: Interval, layers: Interval, clearance: Interval) -> Option<Interval> {
    let apart = layers.square().sqrt() - radii;
    if apart.lower() >= clearance.upper() {
        return None;
    }
    // Where the layers overlap, nothing of the clearance is kept by them.
    let kept = Interval::new(apart.lower().max(0.0), apart.upper().max(0.0));
    let left = clearance.square() - kept.square();
    let left = Interval::new(left.lower().max(0.0), left.upper().max(0.0));
    Some((radii + left.sqrt()).square())
}

/// A rectangle that contains an axis.
struct Bounds([[f64; 2]; 2]);

impl Bounds {
    fn of(axis: &AxisEnclosure) -> Self {
        let along = |k: usize| {
            let hull = |all: [f64; 2], [lower, upper]: [f64; 2]| {
                // The functions min and max pass over NaN.
                if lower.is_nan() || upper.is_nan() || all[0].is_nan() {
                    [f64::NAN; 2]
                } else {
                    [all[0].min(lower), all[1].max(upper)]
                }
            };
            let [first, second, third] = axis.points.map(|point| point[k].range());
            hull(hull(first, second), third)
        };
        Self([along(0), along(1)])
    }

    /// Whether two rectangles are farther apart than a distance. The factor covers the rounding of the comparison, and a comparison
    /// with NaN is false.
    fn is_farther(&self, other: &Self, distance: f64) -> bool {
        let gap = |k: usize| {
            (other.0[k][0] - self.0[k][1])
                .max(self.0[k][0] - other.0[k][1])
                .max(0.0)
        };
        let square = gap(0) * gap(0) + gap(1) * gap(1);
        let has_values = self.0.iter().chain(&other.0).flatten().all(|end| !end.is_nan());
        has_values && square > distance * distance * (1.0 + 1e-12)
    }
}

/// Pushes the forms of a pair that are not proved.
fn separate(a: &AxisEnclosure, b: &AxisEnclosure, distance: f64, found: &mut Enclosures) {
    let mut push = |value: TaylorModel| {
        if !value.is_positive() {
            found.push(PoseScalar::Clearance, value);
        }
    };
    let keep = Interval::exactly(distance);
    match direction(a, b) {
        None => push(TaylorModel::exactly(-1.0)),
        // All points of the axis to which the direction is normal lie on one side.
        Some(Direction::Normal { of_first, sign }) => {
            let (straight, other) = if of_first { (a, b) } else { (b, a) };
            let [x, y] = straight.direction;
            let normal = [-y.times(sign), x.times(sign)];
            for point in distinct(other) {
                push(dot(normal, difference(point, straight.points[0])).plus(-keep));
            }
        }
        Some(Direction::Between { from, to }) => {
            let way = difference(b.points[to], a.points[from]);
            let square = dot(way, way);
            // |n| ≤ (|n|²/m + m)/2 for every m, with equality at m = |n|.
            let length = square.constant.sqrt();
            let half = Interval::exactly(0.5);
            let longest = square
                .scaled(half / Interval::exactly(length))
                .plus(half * Interval::exactly(length));
            let least = longest.scaled(keep);
            for end in distinct(b) {
                for start in distinct(a) {
                    push(dot(way, difference(end, start)) - least);
                }
            }
        }
    }
}

/// The direction of the shortest line from one axis to another, in the middle of a box.
enum Direction {
    /// Normal to one of the axes; `sign` tells to which side of it the other one lies.
    Normal { of_first: bool, sign: f64 },
    /// From a point of the first axis to a point of the second.
    Between { from: usize, to: usize },
}

/// Returns the direction of the shortest line between two axes, in plain doubles; `None` if they cross.
fn direction(a: &AxisEnclosure, b: &AxisEnclosure) -> Option<Direction> {
    let [first, second] = [a, b].map(middle);
    if crossing(a, b).is_some() {
        return None;
    }
    let mut best: Option<(f64, Direction)> = None;
    let mut offer = |square: f64, direction: Direction| {
        if best.as_ref().is_none_or(|(least, _)| square < *least) {
            best = Some((square, direction));
        }
    };
    for (from, p) in first.iter().enumerate() {
        for (to, q) in second.iter().enumerate() {
            offer(length_squared(minus(*q, *p)), Direction::Between { from, to });
        }
    }
    for (of_first, straight, other, axis) in [(true, &first, &second, a), (false, &second, &first, b)] {
        let along = axis.direction.map(|part| part.constant);
        let places = straight.map(|point| scalar(minus(point, straight[0]), along));
        let (least, most) = places
            .iter()
            .fold((0.0f64, 0.0f64), |(low, high), &at| (low.min(at), high.max(at)));
        for point in other {
            let way = minus(*point, straight[0]);
            let (place, height) = (scalar(way, along), along[0] * way[1] - along[1] * way[0]);
            if place > least && place < most {
                offer(
                    height * height,
                    Direction::Normal {
                        of_first,
                        sign: if height < 0.0 { -1.0 } else { 1.0 },
                    },
                );
            }
        }
    }
    best.map(|(_, direction)| direction)
}

/// Encloses the point of an axis that is nearest to another axis in the middle of a box; it lies on the axis in any case.
fn nearest(of: &AxisEnclosure, to: &AxisEnclosure) -> PlanarModel {
    let (own, other) = (middle(of), middle(to));
    let [first, last] = ends(of);
    let way = minus(own[last], own[first]);
    let square = length_squared(way);
    let fraction = crossing(of, to).unwrap_or_else(|| {
        let on_segment = |from: [f64; 2], way: [f64; 2], point: [f64; 2]| {
            let square = length_squared(way);
            if square > 0.0 {
                (scalar(minus(point, from), way) / square).clamp(0.0, 1.0)
            } else {
                0.0
            }
        };
        let [start, end] = ends(to);
        let other_way = minus(other[end], other[start]);
        // An end of one of the axes is nearest.
        let mut best = (f64::INFINITY, 0.0);
        let mut offer = |fraction: f64, other_fraction: f64| {
            let between = minus(
                [0, 1].map(|k| other[start][k] + other_fraction * other_way[k]),
                [0, 1].map(|k| own[first][k] + fraction * way[k]),
            );
            if length_squared(between) < best.0 {
                best = (length_squared(between), fraction);
            }
        };
        for (at, point) in [(0.0, own[first]), (1.0, own[last])] {
            offer(at, on_segment(other[start], other_way, point));
        }
        for (at, point) in [(0.0, other[start]), (1.0, other[end])] {
            offer(on_segment(own[first], way, point), at);
        }
        best.1
    });
    if square == 0.0 {
        return of.points[first];
    }
    let part = difference(of.points[last], of.points[first]).map(|part| part.times(fraction));
    sum(of.points[first], part)
}

/// Returns the fraction of the first axis, from its first end, at which it crosses the second in the middle of a box, if it does.
fn crossing(a: &AxisEnclosure, b: &AxisEnclosure) -> Option<f64> {
    let span = |axis: &AxisEnclosure| {
        let points = middle(axis);
        let [first, last] = ends(axis);
        (points[first], minus(points[last], points[first]))
    };
    let ((from_a, way_a), (from_b, way_b)) = (span(a), span(b));
    let turn = way_a[0] * way_b[1] - way_a[1] * way_b[0];
    let between = minus(from_b, from_a);
    let on_a = (between[0] * way_b[1] - between[1] * way_b[0]) / turn;
    let on_b = (between[0] * way_a[1] - between[1] * way_a[0]) / turn;
    let crosses = (0.0..=1.0).contains(&on_a) && (0.0..=1.0).contains(&on_b);
    crosses.then_some(on_a)
}

/// The points of an axis in the middle of the box.
fn middle(axis: &AxisEnclosure) -> [[f64; 2]; 3] {
    axis.points.map(|point| point.map(|part| part.constant))
}

/// Places of the first and the last point of an axis along its direction, in the middle of the box.
fn ends(axis: &AxisEnclosure) -> [usize; 2] {
    let along = axis.direction.map(|part| part.constant);
    let points = middle(axis);
    let place = |k: usize| scalar(points[k], along);
    let order = |better: fn(&f64, &f64) -> bool| {
        (1..3).fold(0, |best, k| if better(&place(k), &place(best)) { k } else { best })
    };
    [order(f64::lt), order(f64::gt)]
}

/// The points of an axis, each once.
fn distinct(axis: &AxisEnclosure) -> impl Iterator<Item = PlanarModel> {
    let [_, second, third] = axis.points;
    let count = if second == third { 2 } else { 3 };
    axis.points.into_iter().take(count)
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn scalar(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn length_squared(a: [f64; 2]) -> f64 {
    scalar(a, a)
}
