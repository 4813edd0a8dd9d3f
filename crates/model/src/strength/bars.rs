//! The bars of a leg at several poses at once, and the mass on their lines (docs/model.md, section 14.4).

use crate::lanes::{Planar, Real};

/// Part of uniform mass along a bar at several poses at once.
#[derive(Clone, Copy)]
pub(crate) struct Span<V> {
    /// Distances from the end of the bar at the base \[m\].
    pub from: V,
    pub to: V,
    /// Mass per length \[kg/m\].
    pub density: f64,
    /// Whether it lies between the ends of the bar at all poses that the leg reaches.
    pub is_within: bool,
}

impl<V: Real> Span<V> {
    /// Returns the mass from a distance on, and the distance of its middle.
    #[inline(always)]
    fn mass_from(&self, distance: V) -> (V, V) {
        let from = self.from.larger(distance);
        let length = (self.to - from).larger(from.splat(0.0));
        let mass = length * from.splat(self.density);
        (mass, from + length * from.splat(0.5))
    }
}

/// A bar at several poses at once, relative to `P`.
#[derive(Clone, Copy)]
pub(crate) struct BarLanes<V> {
    /// End at the base \[m\].
    pub base: Planar<V>,
    /// Unit vector towards the platform.
    pub axis: Planar<V>,
    /// Length \[m\].
    pub length: V,
    pub pieces: [Span<V>; 2],
    /// Whether one piece covers the bar.
    pub is_uniform: bool,
}

/// Mass beyond a place, towards the platform, and its first moment about `P`.
#[derive(Clone, Copy)]
pub(crate) struct Beyond<V> {
    pub mass: V,
    pub moment: Planar<V>,
}

impl<V: Real> Beyond<V> {
    #[inline(always)]
    pub fn nothing(like: V) -> Self {
        let zero = like.splat(0.0);
        Self {
            mass: zero,
            moment: Planar::new(zero, zero),
        }
    }

    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        Self {
            mass: self.mass + other.mass,
            moment: self.moment.plus(other.moment),
        }
    }
}

impl<V: Real> BarLanes<V> {
    /// Returns the place at a distance from the end at the base.
    #[inline(always)]
    pub fn place(&self, distance: V) -> Planar<V> {
        self.base.plus(self.axis.scaled(distance))
    }

    /// Returns a mass whose middle is at a distance from the end at the base.
    #[inline(always)]
    fn at(&self, (mass, middle): (V, V)) -> Beyond<V> {
        Beyond {
            mass,
            moment: self.place(middle).scaled(mass),
        }
    }

    /// Returns the mass of a piece.
    #[inline(always)]
    pub fn mass_of_piece(&self, piece: usize) -> Beyond<V> {
        let piece = &self.pieces[piece];
        self.at(piece.mass_from(piece.from))
    }

    /// Returns the mass on the line of the bar.
    #[inline(always)]
    pub fn mass(&self) -> Beyond<V> {
        self.mass_of_piece(0).and(self.mass_of_piece(1))
    }

    /// Returns the mass on the line of the bar from a distance on, and its first moment about that place along the bar.
    #[inline(always)]
    pub fn mass_on(&self, distance: V) -> (V, V) {
        let [first, second] = &self.pieces;
        let (mass, middle) = first.mass_from(distance);
        let moment = mass * (middle - distance);
        if second.density == 0.0 {
            return (mass, moment);
        }
        let (more, middle) = second.mass_from(distance);
        (mass + more, moment + more * (middle - distance))
    }

    /// Returns the mass on the line of the bar from a distance on.
    #[inline(always)]
    pub fn mass_from(&self, distance: V) -> Beyond<V> {
        let [first, second] = &self.pieces;
        let mass = self.at(first.mass_from(distance));
        if second.density == 0.0 {
            return mass;
        }
        mass.and(self.at(second.mass_from(distance)))
    }
}
