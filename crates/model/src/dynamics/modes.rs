//! Mass that the bars, drives and payload oppose to a vibration, and the natural frequencies (docs/model.md, section 15.4).
//!
//! A leg follows the platform as its stiffness makes it: the displacements of the ends of its bars are those of the legs under the loads
//! that displace the platform, and each bar bends between its ends as a cubic.

use super::DynamicsModel;
use super::legs::{DynamicsInputs, MovingLeg};
use crate::lanes::{LaneJob, Planar, Real, dot, scaled, sum};
use crate::spatial::LEGS;
use crate::stiffness::add_bar;
use crate::strength::path::{BARS, BarLanes, DISTAL, PLATFORM, PathJoint};

/// How a displacement depends on the three of the platform.
pub(super) type Row<V> = [V; 3];

/// Displacements of a body at `P`, each as a row: two components and the rotation, or that along z and both rotations.
type Displacement<V> = [Row<V>; 3];

/// Abscissas and weights of the Gauss rule with four points on `[−1, 1]`, which is exact for the product of two cubics.
pub(super) const GAUSS: [[f64; 2]; 4] = [
    [-0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
    [-0.339_981_043_584_856_26, 0.652_145_154_862_546_2],
    [0.339_981_043_584_856_26, 0.652_145_154_862_546_2],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
];

/// Displacement across a bar, as the coefficients of a polynomial in the distance from its base.
type Cubic<V> = [Row<V>; 4];

/// Displacements of the ends of a bar, and how it moves between them.
pub(super) struct BarShape<V> {
    /// Between the ends, before the base, and beyond the tip, where a guide goes on straight.
    across: [Cubic<V>; 3],
    /// Displacement along the bar, or rotation about it, at each end.
    along: [Row<V>; 2],
    per_length: V,
}

/// The mass that a displacement along or about the bar moves.
#[derive(Clone, Copy)]
struct Inertia<V> {
    /// Per length, of a displacement across the bar and of one along it or a rotation about it \[kg/m or kg·m\].
    across: V,
    along: V,
    /// Per length, of a rotation of the section \[kg·m\].
    slope: V,
}

/// Adds the outer product of a row with itself to an upper triangle.
#[inline(always)]
fn add_square<V: Real>(m: &mut [V; 6], row: &Row<V>, by: V) {
    let scaled = scaled(row, by);
    m[0] = m[0] + row[0] * scaled[0];
    m[1] = m[1] + row[0] * scaled[1];
    m[2] = m[2] + row[0] * scaled[2];
    m[3] = m[3] + row[1] * scaled[1];
    m[4] = m[4] + row[1] * scaled[2];
    m[5] = m[5] + row[2] * scaled[2];
}

#[inline(always)]
fn combined<V: Real>(a: &Row<V>, by_a: V, b: &Row<V>, by_b: V) -> Row<V> {
    sum(&scaled(a, by_a), &scaled(b, by_b))
}

/// Returns the value and the slope of a polynomial at a distance.
#[inline(always)]
fn at<V: Real>(cubic: &Cubic<V>, distance: V) -> [Row<V>; 2] {
    let [a, b, c, d] = cubic;
    let two = distance.splat(2.0);
    let three = distance.splat(3.0);
    let mut value = [distance; 3];
    let mut slope = [distance; 3];
    for k in 0..3 {
        value[k] = a[k] + distance * (b[k] + distance * (c[k] + distance * d[k]));
        slope[k] = b[k] + distance * (two * c[k] + distance * three * d[k]);
    }
    [value, slope]
}

impl<V: Real> BarShape<V> {
    /// Returns the shape of a bar of which the displacement across it and the slope at both ends are given.
    #[inline(always)]
    fn new(length: V, [base, base_slope]: [Row<V>; 2], [tip, tip_slope]: [Row<V>; 2], along: [Row<V>; 2]) -> Self {
        let (zero, one) = (length.splat(0.0), length.splat(1.0));
        let exists = length.exceeds(zero);
        let per_length = (one / length.select(exists, one)).select(exists, zero);
        let mut between = [base, base_slope, base, base];
        let mut beyond = [tip, tip_slope, [zero; 3], [zero; 3]];
        for k in 0..3 {
            let apart = (tip[k] - base[k]) * per_length;
            let (two, three) = (zero.splat(2.0), zero.splat(3.0));
            between[2][k] = (three * apart - two * base_slope[k] - tip_slope[k]) * per_length;
            between[3][k] = (base_slope[k] + tip_slope[k] - two * apart) * per_length * per_length;
            beyond[0][k] = tip[k] - tip_slope[k] * length;
        }
        Self {
            across: [between, [base, base_slope, [zero; 3], [zero; 3]], beyond],
            along,
            per_length,
        }
    }

    /// Returns the displacement across the bar at a share of its length, and that along it.
    #[inline(always)]
    pub(super) fn at_share(&self, length: V, share: V) -> [Row<V>; 2] {
        let [across, _] = at(&self.across[0], length * share);
        let rest = share.splat(1.0) - share;
        [across, combined(&self.along[0], rest, &self.along[1], share)]
    }

    /// Adds what a stretch of the bar, or of a guide beyond its ends, contributes to the mass.
    #[inline(always)]
    fn add_stretch(&self, mass: &mut [V; 6], which: usize, [from, to]: [V; 2], inertia: Inertia<V>) {
        let added = from.call_apart(Stretch {
            across: &self.across[which],
            along: &self.along,
            share: match which {
                0 => self.per_length,
                _ => from.splat(0.0),
            },
            begin: from.splat(if which == 2 { 1.0 } else { 0.0 }),
            ends: [from, to],
            inertia,
        });
        add(mass, &added);
    }

    /// Adds what the pieces of a bar contribute to the mass, out of the plane if `is_torsion`: the second displacement is then the rotation
    /// about the bar.
    #[inline(always)]
    fn add_pieces(&self, mass: &mut [V; 6], bar: &BarLanes<V>, gyration: f64, is_torsion: bool, is_telescopic: bool) {
        let zero = bar.length.splat(0.0);
        for (place, piece) in bar.pieces.iter().enumerate() {
            if piece.density == 0.0 {
                continue;
            }
            let per_length = zero.splat(piece.density);
            let slope = per_length * zero.splat(gyration);
            let inertia = Inertia {
                across: per_length,
                slope,
                along: match is_torsion {
                    true => slope * zero.splat(2.0),
                    false => per_length,
                },
            };
            // The tube stays with the base, and the rod with the platform.
            let own = [self.along[place]; 2];
            let whole;
            let shape = if is_telescopic && !is_torsion {
                whole = Self {
                    along: own,
                    across: self.across,
                    per_length: self.per_length,
                };
                &whole
            } else {
                self
            };
            if bar.is_uniform {
                shape.add_stretch(mass, 0, [zero, bar.length], inertia);
                continue;
            }
            let clamp = |value: V| value.larger(zero).smaller(bar.length);
            let (from, to) = (piece.from, piece.to);
            shape.add_stretch(mass, 0, [clamp(from), clamp(to)], inertia);
            shape.add_stretch(mass, 1, [from.smaller(zero), to.smaller(zero)], inertia);
            shape.add_stretch(mass, 2, [from.larger(bar.length), to.larger(bar.length)], inertia);
        }
    }
}

/// Adds a mass to another one.
#[inline(always)]
fn add<V: Real>(mass: &mut [V; 6], added: &[V; 6]) {
    for (sum, entry) in mass.iter_mut().zip(added) {
        *sum = *sum + *entry;
    }
}

/// What a leg contributes to the mass in the plane, as a function of its own.
struct LegInPlane<'a, V> {
    model: &'a DynamicsModel,
    leg: &'a MovingLeg<V>,
    compliance: V,
}

impl<V: Real> LaneJob for LegInPlane<'_, V> {
    type Output = [V; 6];

    #[inline(always)]
    fn run(self) -> [V; 6] {
        let mut mass = [self.compliance.splat(0.0); 6];
        self.model
            .add_leg_in_plane(&mut mass, self.leg, self.compliance, |_, _| {});
        mass
    }
}

/// What a leg contributes to the mass out of the plane, as a function of its own.
struct LegOutOfPlane<'a, V> {
    model: &'a DynamicsModel,
    leg: &'a MovingLeg<V>,
    stiffness: &'a [V; 6],
}

impl<V: Real> LaneJob for LegOutOfPlane<'_, V> {
    type Output = [V; 6];

    #[inline(always)]
    fn run(self) -> [V; 6] {
        let mut mass = [self.stiffness[0].splat(0.0); 6];
        self.model
            .add_leg_out_of_plane(&mut mass, self.leg, self.stiffness, |_, _| {});
        mass
    }
}

/// What a stretch of a bar contributes to the mass, as a function of its own: there are many of them.
struct Stretch<'a, V> {
    across: &'a Cubic<V>,
    along: &'a [Row<V>; 2],
    /// How the share of the second displacement along the bar grows with the distance, and where it begins.
    share: V,
    begin: V,
    ends: [V; 2],
    inertia: Inertia<V>,
}

impl<V: Real> LaneJob for Stretch<'_, V> {
    type Output = [V; 6];

    #[inline(always)]
    fn run(self) -> [V; 6] {
        let [from, to] = self.ends;
        let mut mass = [from.splat(0.0); 6];
        let half = (to - from) * from.splat(0.5);
        let middle = (to + from) * from.splat(0.5);
        for [abscissa, weight] in GAUSS {
            let distance = middle + half * from.splat(abscissa);
            let weight = half * from.splat(weight);
            let [value, slope] = at(self.across, distance);
            add_square(&mut mass, &value, weight * self.inertia.across);
            add_square(&mut mass, &slope, weight * self.inertia.slope);
            let share = self.begin + distance * self.share;
            let along = combined(&self.along[0], from.splat(1.0) - share, &self.along[1], share);
            add_square(&mut mass, &along, weight * self.inertia.along);
        }
        mass
    }
}

/// Returns the displacement of a place in a direction in the plane.
#[inline(always)]
fn in_direction<V: Real>(of: &Displacement<V>, direction: Planar<V>, place: Planar<V>) -> Row<V> {
    let turned = direction.dot(place.perp());
    let both = combined(&of[0], direction.x, &of[1], direction.y);
    sum(&both, &scaled(&of[2], turned))
}

/// Returns the displacement of a place along z.
#[inline(always)]
fn lift<V: Real>(of: &Displacement<V>, place: Planar<V>) -> Row<V> {
    sum(&of[0], &combined(&of[1], place.y, &of[2], -place.x))
}

/// Returns the rotation about an axis in the plane.
#[inline(always)]
fn rotation<V: Real>(of: &Displacement<V>, axis: Planar<V>) -> Row<V> {
    combined(&of[1], axis.x, &of[2], axis.y)
}

/// Returns the displacements of the platform itself.
#[inline(always)]
fn identity<V: Real>(like: V) -> Displacement<V> {
    let (zero, one) = (like.splat(0.0), like.splat(1.0));
    [[one, zero, zero], [zero, one, zero], [zero, zero, one]]
}

impl DynamicsModel {
    /// Returns the mass in the plane at `P`, for `x`, `y` and `φz`, as an upper triangle.
    #[inline(always)]
    pub(super) fn mass_in_plane<V: Real>(&self, inputs: &DynamicsInputs<V>, legs: &[MovingLeg<V>; LEGS]) -> [V; 6] {
        let like = legs[0].transmission;
        let mut mass = [like.splat(0.0); 6];
        for (index, leg) in legs.iter().enumerate() {
            let compliance = inputs.legs.along[index];
            add(
                &mut mass,
                &like.call_apart(LegInPlane {
                    model: self,
                    leg,
                    compliance,
                }),
            );
        }
        let payload = &self.settings.payload;
        let centre = self.payload_centre(inputs);
        let platform = identity(like);
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        for direction in [Planar::new(one, zero), Planar::new(zero, one)] {
            let row = in_direction(&platform, direction, centre);
            add_square(&mut mass, &row, like.splat(payload.mass));
        }
        add_square(&mut mass, &platform[2], like.splat(payload.inertia));
        mass
    }

    /// Returns the displacement of a bar's tip, at `P`, for a unit force along the line of the leg.
    #[inline(always)]
    fn give<V: Real>(&self, leg: &MovingLeg<V>, bar: usize) -> [V; 3] {
        let lanes = &leg.path.bars[bar];
        let compliance = self.compliance(bar);
        let (axis, length) = (lanes.axis, lanes.length);
        let line = Planar::new(leg.wrench[0], leg.wrench[1]);
        let tip = lanes.place(length);
        let first = leg.wrench[2] - lanes.base.cross(line);
        let second = leg.wrench[2] - tip.cross(line);
        let bending = length.splat(compliance.bending);
        let stretch = length * length.splat(compliance.axial) * line.dot(axis);
        let turn = length * bending * (first + second) * length.splat(0.5);
        let across = length * length * bending * (first + first + second) * length.splat(1.0 / 6.0);
        let moved = axis.scaled(stretch).plus(axis.perp().scaled(across));
        let moved = moved.minus(tip.perp().scaled(turn));
        [moved.x, moved.y, turn]
    }

    /// Adds what a leg contributes to the mass in the plane, and shows how each of its bars moves.
    #[inline(always)]
    pub(super) fn add_leg_in_plane<V: Real>(
        &self,
        mass: &mut [V; 6],
        leg: &MovingLeg<V>,
        compliance: V,
        mut show: impl FnMut(usize, &BarShape<V>),
    ) {
        let like = leg.transmission;
        let zero = like.splat(0.0);
        let force = scaled(&leg.wrench, like.splat(1.0) / compliance);
        let of = &self.paths[0];
        let first = of.first;
        let mut gives = [[zero; 3]; BARS];
        let mut given = [zero; 3];
        for bar in first..BARS {
            gives[bar] = self.give(leg, bar);
            given = sum(&given, &gives[bar]);
        }
        // What the joints have to add to what the bars give.
        let platform = identity(like);
        let mut rates = [[zero; 3]; 3];
        for joint in 0..3 {
            let taken = dot(&leg.rates[joint], &given);
            rates[joint] = combined(&leg.rates[joint], like.splat(1.0), &force, -taken);
        }
        add_square(
            mass,
            &rates[self.driven],
            like.splat(self.settings.drives.of(self.actuator)),
        );
        let mut moved = [[zero; 3]; 3];
        let mut joint = 0;
        for bar in first..BARS {
            let mut slide = None;
            while joint < 3 && of.joints[joint].before <= bar {
                if of.joints[joint].is_bush {
                    slide = Some(joint);
                } else {
                    let before = moved;
                    add_twist(&mut moved, &leg.twists[joint], &rates[joint]);
                    self.add_points_in_plane(mass, leg, joint, [&before, &moved]);
                }
                joint += 1;
            }
            let lanes = &leg.path.bars[bar];
            let tip_place = lanes.place(lanes.length);
            let base = moved;
            if let Some(joint) = slide {
                add_twist(&mut moved, &leg.twists[joint], &rates[joint]);
                self.add_points_in_plane(mass, leg, joint, [&base, &moved]);
            }
            add_twist(&mut moved, &gives[bar], &force);
            let tip = if bar == PLATFORM { platform } else { moved };
            let (axis, normal) = (lanes.axis, lanes.axis.perp());
            let shape = BarShape::new(
                lanes.length,
                [in_direction(&base, normal, lanes.base), base[2]],
                [in_direction(&tip, normal, tip_place), tip[2]],
                [
                    in_direction(&base, axis, lanes.base),
                    in_direction(&tip, axis, tip_place),
                ],
            );
            shape.add_pieces(mass, lanes, self.gyration(bar), false, self.is_telescopic(bar));
            show(bar, &shape);
        }
    }

    /// Returns whether a bar consists of a tube and a rod.
    #[inline(always)]
    pub(super) fn is_telescopic(&self, bar: usize) -> bool {
        bar == DISTAL && self.paths[0].joints.iter().any(|joint| joint.is_bush)
    }

    /// Adds the point masses at a joint, before and behind which the leg moves as given.
    #[inline(always)]
    fn add_points_in_plane<V: Real>(
        &self,
        mass: &mut [V; 6],
        leg: &MovingLeg<V>,
        joint: usize,
        sides: [&Displacement<V>; 2],
    ) {
        let like = leg.transmission;
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        for point in self.points.iter().flatten().filter(|point| point.joint == joint) {
            let moved = sides[point.body - joint];
            for direction in [Planar::new(one, zero), Planar::new(zero, one)] {
                let row = in_direction(moved, direction, leg.path.joints[joint]);
                add_square(mass, &row, like.splat(point.mass));
            }
        }
    }

    /// Returns the mass out of the plane at `P`, for `z`, `φx` and `φy`, as an upper triangle.
    #[inline(always)]
    pub(super) fn mass_out_of_plane<V: Real>(&self, inputs: &DynamicsInputs<V>, legs: &[MovingLeg<V>; LEGS]) -> [V; 6] {
        let like = legs[0].transmission;
        let mut mass = [like.splat(0.0); 6];
        for (index, leg) in legs.iter().enumerate() {
            let stiffness = &inputs.legs.stiffness[index].at_platform;
            add(
                &mut mass,
                &like.call_apart(LegOutOfPlane {
                    model: self,
                    leg,
                    stiffness,
                }),
            );
        }
        let payload = &self.settings.payload;
        let platform = identity(like);
        let row = lift(&platform, self.payload_centre(inputs));
        add_square(&mut mass, &row, like.splat(payload.mass));
        for row in &platform[1..] {
            add_square(&mut mass, row, like.splat(0.5 * payload.inertia));
        }
        mass
    }

    /// Adds what a leg of the given stiffness contributes to the mass out of the plane, and shows how each of its bars moves.
    #[inline(always)]
    pub(super) fn add_leg_out_of_plane<V: Real>(
        &self,
        mass: &mut [V; 6],
        leg: &MovingLeg<V>,
        stiffness: &[V; 6],
        mut show: impl FnMut(usize, &BarShape<V>),
    ) {
        let like = leg.transmission;
        let zero = like.splat(0.0);
        let platform = identity(like);
        let mut ends = [[[zero; 3]; 3], platform, platform];
        if self.paths[0].first == 0 {
            ends[0] = times(&self.compliance_of(leg, 0), stiffness);
        }
        // Of the whole, what is not the platform bar's: a telescopic leg may bend as one that is longer.
        let of_platform = times(&self.compliance_of(leg, PLATFORM), stiffness);
        for (end, taken) in ends[DISTAL].iter_mut().zip(&of_platform) {
            *end = combined(end, like.splat(1.0), taken, like.splat(-1.0));
        }
        let mut base = [[zero; 3]; 3];
        for bar in self.paths[0].first..BARS {
            let lanes = &leg.path.bars[bar];
            let tip = ends[bar];
            let tip_place = lanes.place(lanes.length);
            // Positive slope lifts: a rotation about the normal to the left lowers what lies ahead.
            let slope = |of: &Displacement<V>| scaled(&rotation(of, lanes.axis.perp()), like.splat(-1.0));
            let shape = BarShape::new(
                lanes.length,
                [lift(&base, lanes.base), slope(&base)],
                [lift(&tip, tip_place), slope(&tip)],
                [rotation(&base, lanes.axis), rotation(&tip, lanes.axis)],
            );
            shape.add_pieces(mass, lanes, self.gyration(bar), true, self.is_telescopic(bar));
            show(bar, &shape);
            for point in self.points.iter().flatten() {
                let joint = &self.paths[0].joints[point.joint];
                if joint.before != bar {
                    continue;
                }
                let distance = distance_of_joint(leg, joint, point.joint, lanes);
                let [row, _] = at(&shape.across[0], distance);
                add_square(mass, &row, like.splat(point.mass));
            }
            base = tip;
        }
    }

    /// Returns the compliance of a bar out of the plane, at `P`.
    #[inline(always)]
    fn compliance_of<V: Real>(&self, leg: &MovingLeg<V>, bar: usize) -> [V; 6] {
        let lanes = &leg.path.bars[bar];
        let mut compliance = [lanes.length.splat(0.0); 6];
        let to_p = lanes.place(lanes.length).scaled(lanes.length.splat(-1.0));
        add_bar(
            &mut compliance,
            self.compliance(bar),
            lanes.axis,
            [lanes.length; 2],
            to_p,
        );
        compliance
    }
}

/// Returns the distance of a joint from the base of the bar that it is before: a bush is along the bar, all others are at its base.
#[inline(always)]
pub(super) fn distance_of_joint<V: Real>(leg: &MovingLeg<V>, joint: &PathJoint, place: usize, bar: &BarLanes<V>) -> V {
    match joint.is_bush {
        true => leg.path.joints[place].minus(bar.base).dot(bar.axis),
        false => bar.length.splat(0.0),
    }
}

/// Adds a displacement along a twist.
#[inline(always)]
fn add_twist<V: Real>(moved: &mut Displacement<V>, twist: &[V; 3], by: &Row<V>) {
    for (row, part) in moved.iter_mut().zip(twist) {
        *row = sum(row, &scaled(by, *part));
    }
}

/// Returns a symmetric matrix that is given as an upper triangle.
#[inline(always)]
pub(super) fn full<V: Copy>(m: &[V; 6]) -> [[V; 3]; 3] {
    [[m[0], m[1], m[2]], [m[1], m[3], m[4]], [m[2], m[4], m[5]]]
}

/// Returns the product of two symmetric matrices that are given as upper triangles.
#[inline(always)]
fn times<V: Real>(a: &[V; 6], b: &[V; 6]) -> Displacement<V> {
    let (a, b) = (full(a), full(b));
    // `b` is symmetric, so that its rows are its columns.
    [0, 1, 2].map(|i| [dot(&a[i], &b[0]), dot(&a[i], &b[1]), dot(&a[i], &b[2])])
}

/// Returns the natural frequency of the softest vibration of a block with its mass, both as upper triangles \[Hz\]; no number where the
/// stiffness is not positive definite.
#[inline(always)]
pub(super) fn lowest_frequency<V: Real>(stiffness: &[V; 6], mass: &[V; 6]) -> V {
    let compliance_of_mass = reduced(stiffness, mass);
    let largest = largest_eigenvalue(compliance_of_mass);
    let one = largest.splat(1.0);
    one / (largest.sqrt() * largest.splat(2.0 * std::f64::consts::PI))
}

/// Returns `L⁻¹ M L⁻ᵀ` of a mass, with the Cholesky factor `L` of a stiffness.
#[inline(always)]
fn reduced<V: Real>(k: &[V; 6], m: &[V; 6]) -> [V; 6] {
    let [a, b, c, d, e, f] = V::cholesky(k);
    // Columns of `L⁻¹ M`, and then rows.
    let forward = |x: V, y: V, z: V| {
        let first = x / a;
        let second = (y - b * first) / d;
        let third = (z - c * first - e * second) / f;
        [first, second, third]
    };
    let left = [
        forward(m[0], m[1], m[2]),
        forward(m[1], m[3], m[4]),
        forward(m[2], m[4], m[5]),
    ];
    let rows = [
        forward(left[0][0], left[1][0], left[2][0]),
        forward(left[0][1], left[1][1], left[2][1]),
        forward(left[0][2], left[1][2], left[2][2]),
    ];
    [rows[0][0], rows[0][1], rows[0][2], rows[1][1], rows[1][2], rows[2][2]]
}

/// Sweeps of the rotations; the third one already leaves nothing but rounding.
const SWEEPS: usize = 5;

/// Returns the largest eigenvalue of a symmetric matrix, given as an upper triangle, by Jacobi's rotations.
#[inline(always)]
fn largest_eigenvalue<V: Real>(matrix: [V; 6]) -> V {
    let [mut a, mut b, mut c, mut d, mut e, mut f] = matrix;
    for _ in 0..SWEEPS {
        (a, d, b, c, e) = rotated(a, d, b, c, e);
        (a, f, c, b, e) = rotated(a, f, c, b, e);
        (d, f, e, b, c) = rotated(d, f, e, b, c);
    }
    a.larger(d.larger(f))
}

/// Makes the entry `off` between two diagonal entries 0; `p` and `q` are the entries of both with the third coordinate.
#[inline(always)]
fn rotated<V: Real>(first: V, second: V, off: V, p: V, q: V) -> (V, V, V, V, V) {
    let (zero, one) = (first.splat(0.0), first.splat(1.0));
    let is_off = off.abs().exceeds(zero);
    let theta = (second - first) / (off + off);
    let tangent = one / (theta.abs() + (theta * theta + one).sqrt());
    let tangent = tangent.select(theta.at_least(zero), -tangent).select(is_off, zero);
    let cosine = one / (tangent * tangent + one).sqrt();
    let sine = tangent * cosine;
    (
        first - tangent * off,
        second + tangent * off,
        zero,
        cosine * p - sine * q,
        sine * p + cosine * q,
    )
}
