//! Descent to the lowest point of a function with kinks, by cutting planes in a trust region (Kelley 1960; Schramm and Zowe 1992).
//!
//! Where the best choice among many decides, such as the home orientation of a workspace or the pose that is weakest, an objective
//! has valleys with steep walls and sharp floors. An evolution strategy follows them slowly. Here every iteration takes the value and
//! the slopes at one point, and the largest of the planes so found is the model of which the next point is the lowest.

use super::polyhedron::{Plane, largest, lowest_point};

/// Widths of the trust region, as fractions of the ranges, at which a descent ends: the best one, and the others.
const NARROWEST: [f64; 2] = [1e-8, 1e-5];

/// Distance of the point at which slopes are taken from the trial, as a fraction of the trust region, and the smallest one.
const ASIDE: [f64; 2] = [0.02, 1e-7];

/// Step of difference quotients as a fraction of that distance.
const STEP: f64 = 0.05;

/// Planes of points that are farther away than this multiple of the trust region are dropped.
const FAR: f64 = 8.0;

/// Number of planes that are kept for each variable.
const PLANES: usize = 6;

/// A descent is given up when this multiple of what its model promises would not make it the best.
const HOPE: f64 = 30.0;

/// A descent in the unit cube.
#[derive(Debug, Clone)]
pub struct Descent {
    /// The lowest point so far, and its value; infinite before the first one is known.
    centre: Vec<f64>,
    value: f64,
    width: f64,
    planes: Vec<Plane>,
    /// Point whose value is asked for, and the value that the model promises there.
    trial: Vec<f64>,
    promised: f64,
    /// Point beside the trial at which slopes are taken, because the model has its own kinks at the trial, and the steps of the
    /// differences.
    aside: Vec<f64>,
    steps: Vec<f64>,
    iteration: u32,
    is_over: bool,
}

impl Descent {
    /// Starts a descent at a point of the unit cube with a trust region of a width.
    pub fn new(start: Vec<f64>, width: f64) -> Self {
        let mut descent = Self {
            trial: start.clone(),
            centre: start,
            value: f64::INFINITY,
            width,
            planes: Vec::new(),
            promised: f64::NEG_INFINITY,
            aside: Vec::new(),
            steps: Vec::new(),
            iteration: 0,
            is_over: false,
        };
        descent.set_steps();
        descent
    }

    /// Whether the descent has ended.
    pub fn is_over(&self) -> bool {
        self.is_over
    }

    /// Number of points that [`Descent::ask`] returns.
    pub fn points(&self) -> usize {
        self.trial.len() + 2
    }

    /// Returns the next points: the trial, the point beside it, and one for each of its slopes.
    pub fn ask(&self) -> Vec<Vec<f64>> {
        let slopes = self.steps.iter().enumerate().map(|(k, step)| {
            let mut point = self.aside.clone();
            point[k] += step;
            point
        });
        [self.trial.clone(), self.aside.clone()]
            .into_iter()
            .chain(slopes)
            .collect()
    }

    /// Takes the values at the points asked for. `best` is the lowest value of all descents.
    pub fn tell(&mut self, values: &[f64], best: f64) {
        let value = values[0];
        if values.iter().all(|value| value.is_finite()) {
            let slopes = values[2..].iter().zip(&self.steps);
            self.planes.push(Plane {
                point: self.aside.clone(),
                value: values[1],
                slopes: slopes.map(|(beside, step)| (beside - values[1]) / step).collect(),
            });
        }
        if self.value == f64::INFINITY {
            // A descent needs a value to start with.
            self.is_over = !value.is_finite();
            self.value = value;
        } else {
            let gain = (self.value - value) / (self.value - self.promised);
            if value < self.value {
                self.value = value;
                self.centre.clone_from(&self.trial);
            }
            self.width *= match gain {
                gain if gain > 0.7 => 2.0,
                gain if gain > 0.1 => 1.0,
                _ => 0.5,
            };
        }
        if !self.is_over {
            self.look_ahead(best);
        }
    }

    /// Determines the next trial.
    fn look_ahead(&mut self, best: f64) {
        let (centre, far) = (&self.centre, (FAR * self.width).max(FAR * ASIDE[1]));
        let is_near = |plane: &Plane| plane.point.iter().zip(centre).all(|(a, b)| libm::fabs(a - b) <= far);
        self.planes.retain(is_near);
        let surplus = self.planes.len().saturating_sub(PLANES * (centre.len() + 1));
        self.planes.drain(..surplus);
        // A plane that lies above the lowest value, because the function is not convex, is lowered.
        let lowered: Vec<Plane> = self
            .planes
            .iter()
            .map(|plane| Plane {
                value: plane.value - (plane.at(centre) - self.value).max(0.0),
                ..plane.clone()
            })
            .collect();
        let side = |by: f64| -> Vec<f64> { centre.iter().map(|x| (x + by).clamp(0.0, 1.0)).collect() };
        let (low, high) = (side(-self.width), side(self.width));
        let trial = lowest_point(&lowered, &low, &high);
        let promised = largest(&lowered, &trial);
        let promise = self.value - promised;
        let narrowest = NARROWEST[usize::from(self.value > best)];
        self.is_over = self.width < narrowest || self.value - HOPE * promise > best;
        if promise <= 1e-12 * libm::fabs(self.value) {
            // The planes of neighbouring valleys leave no way down.
            self.width *= 0.3;
            self.planes.drain(..self.planes.len().saturating_sub(1));
            if self.width >= narrowest && !self.planes.is_empty() {
                return self.look_ahead(best);
            }
        }
        self.trial = trial;
        self.promised = promised;
        self.set_steps();
    }

    /// Sets the point beside the trial, in changing directions, and the steps of the difference quotients, into the cube.
    fn set_steps(&mut self) {
        let aside = (ASIDE[0] * self.width).max(ASIDE[1]);
        let place = |k: usize| {
            let turn = libm::fmod(0.618_034 * f64::from(self.iteration) + 0.754_878 * k as f64, 1.0);
            (self.trial[k] + aside * (2.0 * turn - 1.0)).clamp(0.0, 1.0)
        };
        self.aside = (0..self.trial.len()).map(place).collect();
        let step = STEP * aside;
        self.steps = self
            .aside
            .iter()
            .map(|x| if x + step > 1.0 { -step } else { step })
            .collect();
        self.iteration += 1;
    }
}
