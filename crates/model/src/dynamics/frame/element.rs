//! Elements of the bars, and how they move with the coordinates of a leg.

use nalgebra::DMatrix;

use super::Plane;
use crate::dynamics::bar_shape::GAUSS;
use crate::lanes::Planar;
use crate::strength::bars::{BarLanes, Span};

/// A displacement as a linear function of the coordinates of a leg: the coordinates that it depends on, with their factors.
#[derive(Clone, Default)]
pub(super) struct Displacement(Vec<(usize, f64)>);

impl Displacement {
    pub fn of_coordinate(coordinate: usize) -> Self {
        Self(vec![(coordinate, 1.0)])
    }

    /// Returns the sum of displacements with factors.
    pub fn sum<'a>(parts: impl IntoIterator<Item = (&'a Displacement, f64)>) -> Self {
        let terms = parts.into_iter().filter(|(_, by)| *by != 0.0).flat_map(|(part, by)| {
            part.0
                .iter()
                .map(move |(coordinate, factor)| (*coordinate, by * factor))
        });
        Self(terms.collect())
    }

    /// Adds the square of the displacement to a quadratic form.
    pub fn add_square(&self, form: &mut DMatrix<f64>, by: f64) {
        for (row, first) in &self.0 {
            for (column, second) in &self.0 {
                form[(*row, *column)] += by * first * second;
            }
        }
    }
}

/// The three displacements of a body at `P`.
#[derive(Clone, Default)]
pub(super) struct Body(pub [Displacement; 3]);

impl Body {
    /// Returns the body that moves with three coordinates of its own.
    pub fn of_coordinates(first: usize) -> Self {
        Self([0, 1, 2].map(|k| Displacement::of_coordinate(first + k)))
    }

    /// Returns the body that also moves along a twist, by a coordinate.
    pub fn with_twist(&self, twist: &[f64; 3], coordinate: usize) -> Self {
        let rate = Displacement::of_coordinate(coordinate);
        Self([0, 1, 2].map(|k: usize| Displacement::sum([(&self.0[k], 1.0), (&rate, twist[k])])))
    }

    /// Returns the displacement of a place in a direction in the plane.
    pub fn in_direction(&self, direction: Planar<f64>, place: Planar<f64>) -> Displacement {
        let [x, y, turn] = &self.0;
        Displacement::sum([(x, direction.x), (y, direction.y), (turn, direction.dot(place.perp()))])
    }

    /// Returns the displacement of a place along z.
    pub fn lift(&self, place: Planar<f64>) -> Displacement {
        let [z, x, y] = &self.0;
        Displacement::sum([(z, 1.0), (x, place.y), (y, -place.x)])
    }
}

/// How the end of an element moves: across the bar, by its slope, and along the bar or about it.
pub(super) struct ElementEnd {
    pub at: f64,
    across: Displacement,
    slope: Displacement,
    pub along: Displacement,
}

impl ElementEnd {
    pub fn new(plane: Plane, bar: &BarLanes<f64>, body: &Body, at: f64) -> Self {
        let (axis, normal, place) = (bar.axis, bar.axis.perp(), bar.place(at));
        let [_, x, y] = &body.0;
        match plane {
            Plane::In => Self {
                at,
                across: body.in_direction(normal, place),
                slope: body.0[2].clone(),
                along: body.in_direction(axis, place),
            },
            // A rotation about the normal to the left lowers what lies ahead.
            Plane::Out => Self {
                at,
                across: body.lift(place),
                slope: Displacement::sum([(x, -normal.x), (y, -normal.y)]),
                along: Displacement::sum([(x, axis.x), (y, axis.y)]),
            },
        }
    }
}

/// An element of a bar, which bends as a cubic.
pub(super) struct Element {
    pub ends: [ElementEnd; 2],
    pub is_rigid: bool,
}

impl Element {
    fn length(&self) -> f64 {
        self.ends[1].at - self.ends[0].at
    }

    /// Returns the displacement across the bar at a distance, and the slope there.
    pub fn at(&self, distance: f64) -> [Displacement; 2] {
        let [first, second] = &self.ends;
        let length = self.length();
        if length <= 0.0 {
            let by = distance - first.at;
            let value = Displacement::sum([(&first.across, 1.0), (&first.slope, by)]);
            return [value, first.slope.clone()];
        }
        let s = (distance - first.at) / length;
        let value = Displacement::sum([
            (&first.across, 1.0 - s * s * (3.0 - 2.0 * s)),
            (&first.slope, length * s * (1.0 - s) * (1.0 - s)),
            (&second.across, s * s * (3.0 - 2.0 * s)),
            (&second.slope, length * s * s * (s - 1.0)),
        ]);
        let slope = Displacement::sum([
            (&first.across, -6.0 * s * (1.0 - s) / length),
            (&first.slope, (1.0 - s) * (1.0 - 3.0 * s)),
            (&second.across, 6.0 * s * (1.0 - s) / length),
            (&second.slope, s * (3.0 * s - 2.0)),
        ]);
        [value, slope]
    }

    /// Returns the displacement along or about the bar at a distance.
    fn along(&self, distance: f64) -> Displacement {
        let [first, second] = &self.ends;
        let length = self.length();
        let share = if length > 0.0 {
            (distance - first.at) / length
        } else {
            0.0
        };
        Displacement::sum([(&first.along, 1.0 - share), (&second.along, share)])
    }

    /// Adds the elastic energy: of a uniform curvature, of one that changes its sign in the middle, and of the stretch or twist.
    pub fn add_stiffness(&self, stiffness: &mut DMatrix<f64>, bending: f64, along: f64) {
        if self.is_rigid {
            return;
        }
        let [first, second] = &self.ends;
        let length = self.length();
        let uniform = Displacement::sum([(&second.slope, 1.0), (&first.slope, -1.0)]);
        uniform.add_square(stiffness, 1.0 / (bending * length));
        let half = 0.5 * length;
        let changing = Displacement::sum([
            (&first.across, 1.0),
            (&first.slope, half),
            (&second.across, -1.0),
            (&second.slope, half),
        ]);
        changing.add_square(stiffness, 12.0 / (bending * length * length * length));
        let stretch = Displacement::sum([(&second.along, 1.0), (&first.along, -1.0)]);
        stretch.add_square(stiffness, 1.0 / (along * length));
    }
}

/// Adds the mass of that part of a piece that lies on an element; `own` is the displacement along the bar where it is not the element's.
pub(super) fn add_mass(
    mass: &mut DMatrix<f64>,
    plane: Plane,
    element: &Element,
    piece: &Span<f64>,
    gyration: f64,
    own: Option<&Displacement>,
) {
    let [first, second] = &element.ends;
    let (from, to) = (piece.from.max(first.at), piece.to.min(second.at));
    if piece.density == 0.0 || to <= from {
        return;
    }
    let (half, middle) = (0.5 * (to - from), 0.5 * (to + from));
    for [abscissa, weight] in GAUSS {
        let distance = middle + half * abscissa;
        let of_place = half * weight * piece.density;
        let [across, slope] = element.at(distance);
        across.add_square(mass, of_place);
        slope.add_square(mass, of_place * gyration);
        let along = own.cloned().unwrap_or_else(|| element.along(distance));
        let by = match plane {
            Plane::In => of_place,
            Plane::Out => 2.0 * of_place * gyration,
        };
        along.add_square(mass, by);
    }
}
