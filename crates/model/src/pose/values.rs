//! The scalars of one pose or of several, and the limits that a study sets them.

use std::ops::{Index, IndexMut};

use super::entry::Better;
use super::scalars::PoseScalar;
use crate::lanes::Real;
use crate::spatial::NUMBER_LIMIT;

/// A value for each scalar of a pose.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PoseScalars<T>([T; PoseScalar::COUNT]);

impl<T> PoseScalars<T> {
    /// Creates the values by a function.
    pub fn from_fn(mut value: impl FnMut(PoseScalar) -> T) -> Self {
        Self(PoseScalar::ALL.map(&mut value))
    }

    /// Iterates over the scalars with their values.
    pub fn iter(&self) -> impl Iterator<Item = (PoseScalar, &T)> {
        PoseScalar::ALL.iter().copied().zip(&self.0)
    }

    /// Borrows the values.
    #[inline(always)]
    pub(crate) fn each_mut(&mut self) -> PoseScalars<&mut T> {
        PoseScalars(self.0.each_mut())
    }

    /// Converts the values by a function.
    #[inline(always)]
    pub(crate) fn map<U>(self, convert: impl FnMut(T) -> U) -> PoseScalars<U> {
        PoseScalars(self.0.map(convert))
    }
}

impl<T: Copy> PoseScalars<T> {
    /// Creates the values, all of them the same.
    #[inline(always)]
    pub const fn splat(value: T) -> Self {
        Self([value; PoseScalar::COUNT])
    }

    /// Creates the values of all scalars from those that are known.
    #[inline(always)]
    pub(crate) fn of_core(core: &CoreScalars<T>) -> Self {
        let mut all = Self::splat(core.0[0]);
        all.0[..core.0.len()].copy_from_slice(&core.0);
        all
    }
}

impl<T> Index<PoseScalar> for PoseScalars<T> {
    type Output = T;

    #[inline(always)]
    fn index(&self, scalar: PoseScalar) -> &T {
        &self.0[scalar as usize]
    }
}

impl<T> IndexMut<PoseScalar> for PoseScalars<T> {
    #[inline(always)]
    fn index_mut(&mut self, scalar: PoseScalar) -> &mut T {
        &mut self.0[scalar as usize]
    }
}

/// A value for each scalar that every evaluation determines. Loops over poses hold no more than these: an array of all scalars does not
/// stay in registers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CoreScalars<T>([T; PoseScalar::ALWAYS.len()]);

impl<T: Copy> CoreScalars<T> {
    /// Creates the values, all of them the same.
    #[inline(always)]
    pub fn splat(value: T) -> Self {
        Self([value; PoseScalar::ALWAYS.len()])
    }
}

impl<T> Index<PoseScalar> for CoreScalars<T> {
    type Output = T;

    #[inline(always)]
    fn index(&self, scalar: PoseScalar) -> &T {
        &self.0[scalar as usize]
    }
}

impl<T> IndexMut<PoseScalar> for CoreScalars<T> {
    #[inline(always)]
    fn index_mut(&mut self, scalar: PoseScalar) -> &mut T {
        &mut self.0[scalar as usize]
    }
}

/// A set of scalars.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ScalarSet(u64);

const _: () = assert!(
    PoseScalar::COUNT <= u64::BITS as usize,
    "a set of scalars has a bit for each"
);

impl ScalarSet {
    /// Returns the set of all scalars.
    pub fn all() -> Self {
        PoseScalar::ALL.iter().copied().collect()
    }

    /// Returns whether the set contains a scalar.
    #[inline(always)]
    pub fn contains(self, scalar: PoseScalar) -> bool {
        self.0 & (1 << scalar as u32) != 0
    }

    /// Returns the scalars of the set that are computed on demand.
    #[inline(always)]
    pub(crate) fn on_demand(self) -> Self {
        // Those of every evaluation are the first ones of the table.
        Self(self.0 >> PoseScalar::ALWAYS.len() << PoseScalar::ALWAYS.len())
    }

    /// Returns the scalars of the set that do not depend on a motion.
    #[inline(always)]
    pub(crate) fn without_motion(self) -> Self {
        // Those of a motion are the last ones of the table.
        Self(self.0 & ((1 << (PoseScalar::COUNT - PoseScalar::OF_MOTION.len())) - 1))
    }

    /// Returns whether the set is empty.
    #[inline(always)]
    pub(crate) fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Iterates over the scalars of the set.
    #[inline(always)]
    pub fn iter(self) -> impl Iterator<Item = PoseScalar> {
        let mut left = self.0;
        std::iter::from_fn(move || {
            let place = left.trailing_zeros() as usize;
            left &= left.wrapping_sub(1);
            PoseScalar::ALL.get(place).copied()
        })
    }

    /// Returns the set with a scalar.
    pub fn with(self, scalar: PoseScalar) -> Self {
        Self(self.0 | 1 << scalar as u32)
    }

    /// Returns the scalars that are in this set or in another one.
    pub fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns the scalars that are not in the set.
    pub fn complement(self) -> Self {
        Self(Self::all().0 & !self.0)
    }
}

impl FromIterator<PoseScalar> for ScalarSet {
    fn from_iter<I: IntoIterator<Item = PoseScalar>>(scalars: I) -> Self {
        scalars.into_iter().fold(Self::default(), Self::with)
    }
}

/// Scalars at one reachable pose; those that were not computed have no value.
#[derive(Debug, Clone, Copy)]
pub struct PoseValues(PoseScalars<f64>);

impl PoseValues {
    /// Creates the values from numbers; those that are not finite become finite, so that the model returns only such.
    pub(crate) fn new(value: impl Fn(PoseScalar) -> f64, computed: ScalarSet) -> Self {
        let mut values = PoseScalars::splat(f64::NAN);
        for scalar in computed.iter() {
            values[scalar] = finite(scalar, value(scalar));
        }
        Self(values)
    }

    /// Returns the value of a scalar; `None` if it was not computed.
    pub fn get(&self, scalar: PoseScalar) -> Option<f64> {
        Some(self.0[scalar]).filter(|value| !value.is_nan())
    }
}

/// Returns the value of a scalar that the model reports: a number that is not finite becomes the worst one, or NaN for a scalar
/// of loads or of a motion.
#[inline]
pub(crate) fn finite(scalar: PoseScalar, value: f64) -> f64 {
    match scalar.entry().quantity.better {
        _ if value.is_finite() => value.clamp(-NUMBER_LIMIT, NUMBER_LIMIT),
        _ if scalar.may_be_missing() => f64::NAN,
        Better::Higher => 0.0,
        Better::Lower => NUMBER_LIMIT,
    }
}

impl Index<PoseScalar> for PoseValues {
    type Output = f64;

    /// Returns the value of a scalar that was computed; NaN for any other.
    fn index(&self, scalar: PoseScalar) -> &f64 {
        &self.0[scalar]
    }
}

/// The scalars that every evaluation determines, at several poses at once.
#[derive(Clone, Copy)]
pub struct CoreLanes<V: Real> {
    /// Mask of the poses that every leg reaches; elsewhere only the limit margin is meaningful, which is at most 0 there.
    pub reachable: V::Mask,
    /// The scalars.
    pub scalars: CoreScalars<V>,
}

/// [`PoseValues`] at several poses at once.
#[derive(Clone, Copy)]
pub struct PoseLanes<V: Real> {
    /// Mask of the poses that every leg reaches; elsewhere only the limit margin is meaningful, which is at most 0 there.
    pub reachable: V::Mask,
    /// The scalars; those that were not computed are meaningless.
    pub scalars: PoseScalars<V>,
}

/// The scalars whose limits every loop over poses examines; those of all others cost a loop of its own.
pub(crate) const EXAMINED_ALWAYS: [PoseScalar; 5] = [
    PoseScalar::Dexterity,
    PoseScalar::StiffnessXy,
    PoseScalar::StiffnessPhiZ,
    PoseScalar::StiffnessZ,
    PoseScalar::Clearance,
];

/// The values that a study allows at a feasible pose: of each scalar, the smallest one, or the largest one where smaller values are
/// better.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thresholds(PoseScalars<f64>);

impl Default for Thresholds {
    fn default() -> Self {
        Self::NONE
    }
}

impl Thresholds {
    /// No limit at all.
    pub const NONE: Self = {
        let mut limits = [0.0; PoseScalar::COUNT];
        let mut place = 0;
        while place < PoseScalar::COUNT {
            limits[place] = unlimited(PoseScalar::ALL[place]);
            place += 1;
        }
        Self(PoseScalars(limits))
    };

    /// Returns the limits with one more.
    pub fn with(mut self, scalar: PoseScalar, limit: f64) -> Self {
        self.set(scalar, Some(limit));
        self
    }

    /// Sets the limit of a scalar, or removes it.
    pub fn set(&mut self, scalar: PoseScalar, limit: Option<f64>) {
        self.0[scalar] = limit.unwrap_or(unlimited(scalar));
    }

    /// Returns the limit of a scalar, if there is one.
    pub fn get(&self, scalar: PoseScalar) -> Option<f64> {
        Some(self.0[scalar]).filter(|limit| limit.is_finite())
    }

    /// Returns the limit of a scalar, or an infinite one that excludes nothing.
    #[inline(always)]
    pub(crate) fn bound(&self, scalar: PoseScalar) -> f64 {
        self.0[scalar]
    }

    /// Iterates over the limits that there are.
    pub fn iter(&self) -> impl Iterator<Item = (PoseScalar, f64)> {
        PoseScalar::ALL
            .iter()
            .copied()
            .filter_map(|scalar| Some((scalar, self.get(scalar)?)))
    }

    /// Returns the limited scalars that take long.
    pub(crate) fn that_take_long(&self) -> ScalarSet {
        let limited = self.iter().map(|(scalar, _)| scalar);
        limited.filter(|scalar| scalar.takes_long()).collect()
    }

    /// Returns whether a limit is of a scalar that depends on a motion.
    #[inline(always)]
    pub(crate) fn limit_motion(&self) -> bool {
        PoseScalar::OF_MOTION.iter().any(|&scalar| self.0[scalar].is_finite())
    }

    /// Returns whether a limit is of a scalar that not every loop over poses examines.
    pub(crate) fn need_all_scalars(&self) -> bool {
        self.iter().any(|(scalar, _)| !EXAMINED_ALWAYS.contains(&scalar))
    }

    /// Returns whether the values of a reachable pose keep all limits.
    pub fn are_met_by(&self, values: &PoseValues) -> bool {
        // A value that was not computed meets no limit.
        self.iter()
            .all(|(scalar, limit)| is_within(scalar, values[scalar], limit))
    }
}

/// Returns whether a value keeps a limit.
#[inline]
pub(crate) fn is_within(scalar: PoseScalar, value: f64, limit: f64) -> bool {
    match scalar.entry().quantity.better {
        Better::Higher => value >= limit,
        Better::Lower => value <= limit,
    }
}

/// The limit that excludes no number.
const fn unlimited(scalar: PoseScalar) -> f64 {
    match scalar.entry().quantity.better {
        Better::Higher => f64::NEG_INFINITY,
        Better::Lower => f64::INFINITY,
    }
}
