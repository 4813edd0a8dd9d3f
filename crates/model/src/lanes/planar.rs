//! Planar vectors on one number or on several at once.

use glam::DVec2;

use super::Real;

/// A planar vector, or several planar vectors in parallel lanes.
#[derive(Clone, Copy)]
pub struct Planar<V> {
    /// First component.
    pub x: V,
    /// Second component.
    pub y: V,
}

impl<V: Real> Planar<V> {
    /// Creates the vector with the given components.
    #[inline(always)]
    pub fn new(x: V, y: V) -> Self {
        Self { x, y }
    }

    /// Returns the dot product `self · other`.
    #[inline(always)]
    pub fn dot(self, other: Self) -> V {
        self.x * other.x + self.y * other.y
    }

    /// Returns the z component of `self × other`.
    #[inline(always)]
    pub fn cross(self, other: Self) -> V {
        self.x * other.y - self.y * other.x
    }

    /// Returns `self` rotated by +90°.
    #[inline(always)]
    pub fn perp(self) -> Self {
        Self::new(-self.y, self.x)
    }

    /// Returns `factor · self`.
    #[inline(always)]
    pub fn scaled(self, factor: V) -> Self {
        Self::new(factor * self.x, factor * self.y)
    }

    /// Returns `self + other`.
    #[inline(always)]
    pub fn plus(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y)
    }

    /// Returns `self − other`.
    #[inline(always)]
    pub fn minus(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y)
    }

    /// Returns `vector` in as many lanes as `like` has.
    #[inline(always)]
    pub fn splat(like: V, vector: DVec2) -> Self {
        Self::new(like.splat(vector.x), like.splat(vector.y))
    }
}

impl From<DVec2> for Planar<f64> {
    fn from(vector: DVec2) -> Self {
        Self::new(vector.x, vector.y)
    }
}
