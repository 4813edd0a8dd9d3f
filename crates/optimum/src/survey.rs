//! Where a design is nearest to missing a requirement: the local minima over all poses of the region.

use glam::DVec2;
use kinefront_model::evaluation::PoseScalar;
use kinefront_model::lanes::padded_length;
use kinefront_model::spatial::LEGS;
use kinefront_model::workspace::ValueColumns;
use nalgebra::{DMatrix, DVector};

use super::place::{Area, Density, Place, Spot, Spots};
use super::prepared::Prepared;
use super::problem::LocalProblem;
use super::requirement::{Critical, NOWHERE, Requirement};

/// Minima that exceed the least one by more than this are left out.
const NEAR: f64 = 0.1;

/// Largest number of minima of one requirement that are refined.
const MOST: usize = 12;

/// Joint limits that exceed the nearest one by less than this share of `R` are examined too.
const ALSO: f64 = 0.02;

/// Accuracy of a place.
const ACCURACY: f64 = 1e-8;

/// The same where some slack is asked for and the values around the place differ by no more than [`FLAT`].
const ROUGH_ACCURACY: f64 = 1e-5;

/// Difference of values that is less than the slack which is asked for.
const FLAT: f64 = 1e-10;

/// Step from which the place of a minimum is refined, for both coordinates and the orientation.
const FIRST_STEP: f64 = 0.08;

/// Steps after which the place of a minimum is no longer refined: along a valley that is not parallel to a coordinate, steps stay short.
const PATIENCE: usize = 200;

/// Places that are nearer to each other than this are one.
const SAME: f64 = 1e-5;

/// Slack below which a critical pose is followed from one design to the next.
pub(crate) const FOLLOWED: f64 = 0.02;

/// Half the width of a parabola through values of a requirement.
const PARABOLA: f64 = 1e-3;

/// Largest distance of a vertex, as a multiple of that width.
const NEARBY: f64 = 20.0;

/// Number of times that a critical pose is moved to the vertex of a paraboloid.
const VERTICES: usize = 3;

impl LocalProblem {
    /// Returns the local minima of all requirements over the region.
    pub(crate) fn survey(&self, prepared: &Prepared, density: Density) -> Vec<Critical> {
        let spots = self.spots(density);
        let fields = Fields::new(spots, prepared, spots.turns.iter().map(|turn| prepared.arms(*turn)));
        let mut found: Vec<Critical> = Vec::new();
        for requirement in self.requirements() {
            if requirement.is_of_reach() {
                continue;
            }
            if !requirement.is_of_poses(self) {
                let place = Place {
                    spot: Spot::Inside([0.0; 2]),
                    turn: 0.0,
                };
                found.push(self.critical_at(prepared, *requirement, place));
                continue;
            }
            let value = |index: usize| self.of_scalars(prepared, *requirement, |scalar| fields.scalar(scalar, index));
            for place in fields.minima(value) {
                add(&mut found, self.refined(prepared, *requirement, place, FIRST_STEP));
            }
        }
        if self.requirements().iter().any(|requirement| requirement.is_of_reach()) {
            let value = |index: usize| self.reach(prepared, fields.scalar(PoseScalar::Reach, index));
            for place in fields.minima(value) {
                for critical in self.limits_at(prepared, place) {
                    add(
                        &mut found,
                        self.refined(prepared, critical.requirement, critical.place, FIRST_STEP),
                    );
                }
            }
        }
        found
    }

    /// Returns a requirement with its value at a place.
    fn critical_at(&self, prepared: &Prepared, requirement: Requirement, place: Place) -> Critical {
        Critical {
            requirement,
            place,
            slack: self.value(prepared, requirement, &place),
        }
    }

    /// Returns the requirements of g2 that are nearest at a place.
    fn limits_at(&self, prepared: &Prepared, place: Place) -> Vec<Critical> {
        let requirements = self.requirements().iter();
        let of_reach = requirements.filter(|requirement| requirement.is_of_reach());
        let mut all: Vec<Critical> = of_reach
            .map(|requirement| self.critical_at(prepared, *requirement, place))
            .filter(|critical| critical.slack > NOWHERE)
            .collect();
        let slacks = all.iter().map(|critical| critical.slack);
        let least = slacks.fold(f64::INFINITY, f64::min);
        all.retain(|critical| critical.slack <= least + ALSO);
        all
    }

    /// Returns the critical poses of a design: those that spots of the region lead to, and those that `known` ones of a design near it lead
    /// to by steps of `step` at first, which may lie between the spots.
    pub(crate) fn survey_from(
        &self,
        prepared: &Prepared,
        density: Density,
        known: &[Critical],
        step: f64,
    ) -> Vec<Critical> {
        let mut found = self.survey(prepared, density);
        for critical in known {
            let slack = self.value(prepared, critical.requirement, &critical.place);
            if critical.requirement.is_of_poses(self) && slack < FOLLOWED && slack > NOWHERE {
                let next = self.refined(prepared, critical.requirement, critical.place, step);
                add(&mut found, next);
            }
        }
        found
    }

    /// Returns the minimum of a requirement near a place, by steps along each coordinate that are halved where none helps.
    pub(crate) fn refined(&self, prepared: &Prepared, requirement: Requirement, from: Place, first: f64) -> Critical {
        let mut best = self.critical_at(prepared, requirement, from);
        let freedoms = Area::freedoms(from.spot);
        let rough = if self.question().slack > 0.0 {
            ROUGH_ACCURACY
        } else {
            0.0
        };
        let mut step = first;
        let mut left = PATIENCE;
        while step > ACCURACY && left > 0 {
            left -= 1;
            let mut is_lower = false;
            let mut is_flat = step <= rough;
            for freedom in 0..=freedoms {
                let (mut rise, mut is_at_end) = (0.0f64, false);
                for way in [-step, step] {
                    let Some(place) = moved(prepared, best.place, freedom, freedoms, way) else {
                        is_at_end = true;
                        continue;
                    };
                    let next = self.critical_at(prepared, requirement, place);
                    rise = rise.max(next.slack - best.slack);
                    // Where the requirement has no value, another one is missed.
                    if next.slack < best.slack && next.slack > NOWHERE {
                        best = next;
                        is_lower = true;
                    }
                }
                is_flat &= is_at_end || rise <= FLAT;
            }
            if !is_lower {
                if is_flat {
                    break;
                }
                step *= 0.5;
            }
        }
        best
    }

    /// Returns the minimum of a requirement at a place that is one already, with the place more exact: to the vertex of a paraboloid
    /// through values around it, three times. The values near a minimum are equal up to rounding, and a gradient at a place that is slightly off
    /// is off by as much. All coordinates change together, because a valley may be parallel to none of them.
    pub(crate) fn sharpened(&self, prepared: &Prepared, from: &Critical) -> Critical {
        let requirement = from.requirement;
        let mut place = from.place;
        for _ in 0..VERTICES {
            let Some(next) = self.vertex(prepared, requirement, place) else {
                break;
            };
            place = next;
        }
        // The known slack may be that of another design. Rounding aside, the vertex is no higher.
        let [known, found] = [from.place, place].map(|place| self.critical_at(prepared, requirement, place));
        if found.slack <= known.slack + 1e-9 {
            found
        } else {
            known
        }
    }

    /// Returns the vertex of the paraboloid through the values of a requirement around a place; `None` if there is none nearby. A
    /// coordinate stays as it is at an end of its range.
    fn vertex(&self, prepared: &Prepared, requirement: Requirement, place: Place) -> Option<Place> {
        let freedoms = Area::freedoms(place.spot);
        let shifted =
            |place: Place, freedom: usize, way: f64| moved(prepared, place, freedom, freedoms, way * PARABOLA);
        let at = |place: Place| Some(self.value(prepared, requirement, &place)).filter(|value| *value > NOWHERE);
        let here = at(place)?;
        let mut free: Vec<usize> = Vec::new();
        let (mut slopes, mut bends): (Vec<f64>, Vec<f64>) = Default::default();
        for freedom in 0..=freedoms {
            let around = |way: f64| Some([at(shifted(place, freedom, -way)?)?, at(shifted(place, freedom, way)?)?]);
            let (Some([below, above]), Some(nearer)) = (around(1.0), around(0.5)) else {
                continue;
            };
            // A third derivative would move the vertex: the slope is that of the cubic through four values.
            let slope = (8.0 * (nearer[1] - nearer[0]) - (above - below)) / 6.0;
            let bend = below - 2.0 * here + above;
            if bend > 0.0 && slope.abs() < NEARBY * bend {
                free.push(freedom);
                slopes.push(slope);
                bends.push(bend);
            }
        }
        let mut matrix = DMatrix::from_diagonal(&DVector::from_column_slice(&bends));
        for row in 0..free.len() {
            for column in 0..row {
                let corner = |a: f64, b: f64| at(shifted(shifted(place, free[row], a)?, free[column], b)?);
                let twist =
                    || Some(0.25 * (corner(1.0, 1.0)? + corner(-1.0, -1.0)? - corner(1.0, -1.0)? - corner(-1.0, 1.0)?));
                // Where a corner lies outside the region, both coordinates are taken alone.
                let twist = twist().unwrap_or(0.0);
                (matrix[(row, column)], matrix[(column, row)]) = (twist, twist);
            }
        }
        let slopes = DVector::from_vec(slopes);
        // So they are where the values have no minimum together.
        let steps = match matrix.cholesky() {
            Some(factors) => factors.solve(&slopes),
            None => slopes.component_div(&DVector::from_vec(bends)),
        };
        if steps.iter().any(|step| step.abs() > NEARBY) {
            return None;
        }
        let steps = free.iter().zip(steps.iter());
        // A coordinate that does not change stays.
        Some(steps.fold(place, |place, (freedom, step)| {
            shifted(place, *freedom, -step).unwrap_or(place)
        }))
    }
}

fn moved(prepared: &Prepared, place: Place, freedom: usize, freedoms: usize, step: f64) -> Option<Place> {
    if freedom < freedoms {
        let spot = prepared.area.moved(place.spot, freedom, step)?;
        return Some(Place { spot, ..place });
    }
    let turn = (place.turn + step).clamp(-1.0, 1.0);
    (turn != place.turn).then_some(Place { turn, ..place })
}

/// Returns the largest amount by which a requirement is missed.
pub(crate) fn missed(critical: &[Critical]) -> f64 {
    largest_violation(critical.iter().map(|critical| critical.slack))
}

/// Returns the largest amount by which some values are negative.
pub(crate) fn largest_violation(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |most, value| most.max(-value))
}

/// Adds a minimum unless it is one that was found before.
pub(crate) fn add(found: &mut Vec<Critical>, next: Critical) {
    let is_known = |other: &Critical| {
        other.requirement == next.requirement
            && is_same(&other.place, &next.place)
            && (other.slack - next.slack).abs() < SAME
    };
    if !found.iter().any(is_known) {
        found.push(next);
    }
}

/// Returns whether two places are one.
pub(crate) fn is_same(a: &Place, b: &Place) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() < SAME;
    let spot = match (a.spot, b.spot) {
        (Spot::Rim(a), Spot::Rim(b)) => near(libm::remainder(a - b, std::f64::consts::TAU), 0.0),
        (Spot::Side(i, a), Spot::Side(j, b)) => i == j && near(a, b),
        (Spot::Inside(a), Spot::Inside(b)) => near(a[0], b[0]) && near(a[1], b[1]),
        _ => false,
    };
    spot && near(a.turn, b.turn)
}

/// The scalars at all spots in some orientations.
pub(crate) struct Fields<'a> {
    spots: &'a Spots,
    columns: Vec<ValueColumns>,
}

impl<'a> Fields<'a> {
    /// Evaluates the spots for the arms of each orientation.
    pub fn new(spots: &'a Spots, prepared: &Prepared, orientations: impl Iterator<Item = [DVec2; LEGS]>) -> Self {
        let positions = spots
            .all
            .iter()
            .map(|spot| prepared.centre + prepared.area.position(*spot));
        let (mut xs, mut ys): (Vec<f64>, Vec<f64>) = positions.map(|position| (position.x, position.y)).unzip();
        for column in [&mut xs, &mut ys] {
            column.resize(padded_length(column.len()), column[0]);
        }
        let of_orientation = |arms: [DVec2; LEGS]| {
            let mut values = ValueColumns::default();
            prepared.evaluator().evaluate_positions(&arms, &xs, &ys, &mut values);
            values
        };
        Self {
            spots,
            columns: orientations.map(of_orientation).collect(),
        }
    }

    /// Number of spots in each orientation.
    pub fn count(&self) -> usize {
        self.spots.all.len()
    }

    /// Returns a scalar at one of the poses, which are counted orientation by orientation; NaN if it was not computed.
    pub fn scalar(&self, scalar: PoseScalar, index: usize) -> f64 {
        let column = self.columns[index / self.count()].column(scalar);
        column.get(index % self.count()).copied().unwrap_or(f64::NAN)
    }

    /// Returns the places at which a function has no higher value than at any neighbour, the lowest first.
    fn minima(&self, value: impl Fn(usize) -> f64) -> Vec<Place> {
        let spots = self.spots;
        let turns = spots.turns.len();
        let values: Vec<f64> = (0..turns * self.count())
            .map(|index| {
                Some(value(index))
                    .filter(|value| !value.is_nan())
                    .unwrap_or(f64::INFINITY)
            })
            .collect();
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let is_minimum = |index: usize| {
            let (own, turn, spot) = (values[index], index / self.count(), index % self.count());
            let around = [
                turn.checked_sub(1),
                Some(turn),
                Some(turn + 1).filter(|turn| *turn < turns),
            ];
            own <= least + NEAR
                && own.is_finite()
                && around.into_iter().flatten().all(|other| {
                    let near = spots.neighbours[spot].iter().chain([&spot]);
                    near.into_iter().all(|near| own <= values[other * self.count() + near])
                })
        };
        let mut minima: Vec<usize> = (0..values.len()).filter(|index| is_minimum(*index)).collect();
        minima.sort_by(|a, b| values[*a].total_cmp(&values[*b]).then(a.cmp(b)));
        minima.truncate(MOST);
        let place = |index: usize| Place {
            spot: spots.all[index % self.count()],
            turn: spots.turns[index / self.count()],
        };
        minima.into_iter().map(place).collect()
    }
}
