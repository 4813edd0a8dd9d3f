//! What a niche learns of its part of the front: from the candidates nearest to a place of the front, a local model of the objectives
//! proposes the candidate that is best there.
//!
//! It needs a problem that completes its candidates for the best level that their free variables allow: only then are both objectives
//! smooth functions of few variables, with no constraint left between them.

use super::gaps::Gaps;
use super::quadratic::{Datum, Quadratics};
use crate::random::Random;
use crate::selection::squared_distance;
use crate::{Archive, Evaluated, Target, Variable};

/// Number of data of a model, as a multiple of its coefficients.
const DATA: usize = 3;

/// Largest number of samples that are kept; beyond it, the oldest quarter is forgotten.
const MOST_SAMPLES: usize = 20_000;

/// Number of trial points at which the models are compared.
const TRIALS: usize = 300;

/// Number of members on either side of a gap whose differences the trial points use.
const NEIGHBOURS: usize = 8;

/// Ratio of the spread of the trial points around the differences to that of the neighbours.
const NOISE: f64 = 0.5;

/// Least spread of the trial points, as a fraction of the range of a variable.
const LEAST_SPREAD: f64 = 1e-3;

/// Growth of the logarithm of the sized objective that a lack of level as large as the whole front counts as.
const LACK: f64 = 10.0;

/// Fraction of a gap at either end in which no level is asked for.
const MARGIN: f64 = 0.2;

/// Where a candidate is to improve the front.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Aim {
    /// Between two members, at this level.
    Gap(f64),
    /// At the end with the best sized objective.
    Size,
    /// At the end with the best level.
    Level,
}

/// What a niche has learned.
#[derive(Debug, Clone)]
pub struct Learner {
    /// Places and ranges of the variables that the problem does not determine.
    free: Vec<(usize, [f64; 2])>,
    /// Free variables of the samples as fractions of their ranges, one sample after another.
    points: Vec<f64>,
    /// Sized objective and level of each sample.
    values: Vec<[f64; 2]>,
    /// Whether the sized objective is modelled by its logarithm: no sample denies it.
    is_logarithmic: bool,
    front: Archive,
    gaps: Gaps,
    /// Whether the gaps are those of the front.
    is_current: bool,
    /// Place of the objective that is learned besides the sized one: the level.
    leveled: usize,
}

impl Learner {
    /// Prepares to learn; `None` if there is no free variable or no level.
    pub fn new(variables: &[Variable], determined: &[usize], leveled: usize) -> Option<Self> {
        let free = |(place, variable): (usize, &Variable)| match *variable {
            Variable::Real { lower, upper } if lower < upper && !determined.contains(&place) => {
                Some((place, [lower, upper]))
            }
            _ => None,
        };
        let free: Vec<_> = variables.iter().enumerate().filter_map(free).collect();
        (!free.is_empty() && leveled < 2).then(|| Self {
            free,
            points: Vec::new(),
            values: Vec::new(),
            is_logarithmic: true,
            front: Archive::default(),
            gaps: Gaps::default(),
            is_current: false,
            leveled,
        })
    }

    /// Learns from a candidate and the target that it was completed for.
    pub fn learn(&mut self, id: usize, candidate: &Evaluated, target: Option<Target>) {
        let objectives = &candidate.outcome.objectives;
        if !candidate.outcome.is_feasible() || objectives.len() != 2 {
            return;
        }
        self.front.insert(id, &candidate.x, &candidate.outcome);
        self.is_current = false;
        let level = objectives[self.leveled];
        // A candidate that missed its level has the best one that its free variables allow.
        let has_best_level = match target {
            Some(Target::Best) => true,
            Some(Target::Level(asked)) => level > asked,
            None => false,
        };
        if !has_best_level {
            return;
        }
        if self.values.len() >= MOST_SAMPLES {
            self.values.drain(..MOST_SAMPLES / 4);
            self.points.drain(..MOST_SAMPLES / 4 * self.free.len());
        }
        let point = self.fractions(&candidate.x);
        self.points.extend(point);
        let size = objectives[1 - self.leveled];
        self.values.push([size, level]);
        self.is_logarithmic &= size > 0.0;
    }

    fn fractions(&self, x: &[f64]) -> Vec<f64> {
        let fraction = |&(place, [lower, upper]): &(usize, [f64; 2])| (x[place] - lower) / (upper - lower);
        self.free.iter().map(fraction).collect()
    }

    fn logarithm(&self, value: f64) -> f64 {
        if self.is_logarithmic { libm::log(value) } else { value }
    }

    fn level_of(&self, place: usize) -> f64 {
        self.front[place].objectives[self.leveled]
    }

    /// Whether enough is known to propose candidates; never with three objectives.
    pub fn can_propose(&self) -> bool {
        self.front.len() >= 2 && self.values.len() >= Quadratics::count_terms(self.free.len()) + 2
    }

    /// Proposes the variables of a candidate, with the given probability for one that extends the front past an end. `None` if
    /// no model can be fitted. It must be [able to](Self::can_propose).
    pub fn propose(&mut self, random: &mut Random, common: &Archive, past: f64) -> Option<Vec<f64>> {
        let (aim, ends, base) = self.aim(random, common, past);
        let mut models = self.fit(&base)?;
        let found = self.best_trial(random, &mut models, aim, ends, &base);
        let mut x = self.front[ends[0]].x.clone();
        for (&(place, [lower, upper]), fraction) in self.free.iter().zip(found) {
            x[place] = (lower + fraction * (upper - lower)).min(upper);
        }
        Some(x)
    }

    /// Draws where to improve the front: the aim, the two members beside it, and the point between them.
    fn aim(&mut self, random: &mut Random, common: &Archive, past: f64) -> (Aim, [usize; 2], Vec<f64>) {
        let last = self.front.len() - 1;
        if random.chance(past) {
            let is_size = random.chance(0.5);
            // The front ascends in the first objective.
            let is_first = is_size == (self.leveled == 1);
            let (aim, ends) = (
                if is_size { Aim::Size } else { Aim::Level },
                if is_first { [0, 1] } else { [last, last - 1] },
            );
            return (aim, ends, self.fractions(&self.front[ends[0]].x));
        }
        if !self.is_current {
            let mut gaps = std::mem::take(&mut self.gaps);
            gaps.update(&self.front, common, self.leveled, |value| self.logarithm(value));
            self.gaps = gaps;
            self.is_current = true;
        }
        let place = self.gaps.draw(random);
        let share = MARGIN + (1.0 - 2.0 * MARGIN) * random.uniform();
        let [from, to] = [place, place + 1].map(|place| self.fractions(&self.front[place].x));
        let base = from.iter().zip(&to).map(|(from, to)| from + share * (to - from));
        let level = self.level_of(place) + share * (self.level_of(place + 1) - self.level_of(place));
        (Aim::Gap(level), [place, place + 1], base.collect())
    }

    /// Fits the logarithm of the sized objective and the level to the samples nearest to a point.
    fn fit(&self, base: &[f64]) -> Option<Quadratics> {
        let count = self.free.len();
        let most = DATA * Quadratics::count_terms(count);
        // The nearest samples so far, in ascending order of the squared distance; of equals, the earlier sample first.
        let mut nearest: Vec<(f64, usize)> = Vec::with_capacity(most + 1);
        for (sample, point) in self.points.chunks_exact(count).enumerate() {
            let square = squared_distance(point, base);
            if nearest.len() == most && square >= nearest[most - 1].0 {
                continue;
            }
            let place = nearest.partition_point(|(other, _)| *other <= square);
            nearest.insert(place, (square, sample));
            nearest.truncate(most);
        }
        let data: Vec<Datum> = nearest
            .into_iter()
            .map(|(square, sample)| Datum {
                point: &self.points[sample * count..][..count],
                distance: libm::sqrt(square),
                values: [self.logarithm(self.values[sample][0]), self.values[sample][1]],
            })
            .collect();
        Quadratics::fit(base.to_vec(), &data)
    }

    /// Returns the best of many trial points around `base`, according to the models. They are spread as the members around it are.
    fn best_trial(
        &self,
        random: &mut Random,
        models: &mut Quadratics,
        aim: Aim,
        ends: [usize; 2],
        base: &[f64],
    ) -> Vec<f64> {
        let last = self.front.len() - 1;
        let span = (self.level_of(0) - self.level_of(last)).abs().max(f64::MIN_POSITIVE);
        let (offsets, spread) = self.neighbours(aim, ends);
        let mut best = (f64::INFINITY, base.to_vec());
        let mut trial = base.to_vec();
        for number in 0..TRIALS {
            let [to, from] = [(); 2].map(|()| &offsets[random.below(offsets.len())]);
            let scale = if number == 0 { 0.0 } else { random.uniform() };
            for (k, value) in trial.iter_mut().enumerate() {
                let step = to[k] - from[k] + NOISE * spread[k] * random.almost_normal();
                *value = (base[k] + scale * step).clamp(0.0, 1.0);
            }
            let [size, level] = models.at(&trial);
            let cost = match aim {
                Aim::Gap(asked) => size + LACK * ((level - asked) / span).max(0.0),
                Aim::Size => size,
                Aim::Level => level,
            };
            if cost < best.0 {
                best.0 = cost;
                best.1.copy_from_slice(&trial);
            }
        }
        best.1
    }

    /// Returns the offsets of the members around the ends of a gap from their mean, and the spread of each variable among them. Within
    /// the front, the offsets are those across it, from the trend along the level: along it, the level asked for decides.
    fn neighbours(&self, aim: Aim, [a, b]: [usize; 2]) -> (Vec<Vec<f64>>, Vec<f64>) {
        let first = a.min(b).saturating_sub(NEIGHBOURS);
        let last = (a.max(b) + NEIGHBOURS).min(self.front.len() - 1);
        let mut offsets: Vec<Vec<f64>> = (first..=last)
            .map(|place| self.fractions(&self.front[place].x))
            .collect();
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut levels: Vec<f64> = (first..=last).map(|place| self.level_of(place)).collect();
        let middle = mean(&levels);
        levels.iter_mut().for_each(|level| *level -= middle);
        let variance = dot(&levels, &levels);
        let has_trend = matches!(aim, Aim::Gap(_)) && variance > 0.0;
        let spread = (0..self.free.len()).map(|k| {
            let mut column: Vec<f64> = offsets.iter().map(|point| point[k]).collect();
            let middle = mean(&column);
            let slope = if has_trend {
                dot(&column, &levels) / variance
            } else {
                0.0
            };
            for ((value, level), point) in column.iter_mut().zip(&levels).zip(&mut offsets) {
                *value -= middle + slope * level;
                point[k] = *value;
            }
            libm::sqrt(dot(&column, &column) / column.len() as f64).max(LEAST_SPREAD)
        });
        let spread = spread.collect();
        (offsets, spread)
    }
}
