//! The loads under which stresses, forces and buckling are computed: a wrench, a set about it, and gravity (docs/model.md,
//! section 14.6).

use crate::lanes::Real;

/// Shape of a set of wrenches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadShape {
    /// Each component varies by itself.
    Box,
    /// The force in the plane has any direction, and so has the moment about an axis in the plane; the others vary by themselves.
    Cylinder,
    /// All components vary together.
    Ellipsoid,
}

/// Wrenches that the surroundings exert on the platform at `P`, in base axes, and gravity.
///
/// ```
/// use kinefront_model::strength::Loads;
///
/// // The worst of 100 N in any direction of the plane, ±100 N along z and ±10 N·m about it, and the weight of the members.
/// assert_eq!(Loads::default().range, [100.0, 100.0, 100.0, 0.0, 0.0, 10.0]);
/// // A single wrench.
/// let pulled = Loads::default().with_wrench([0.0, 50.0, 0.0, 0.0, 0.0, 0.0]);
/// assert_eq!(pulled.range, [0.0; 6]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loads {
    /// `W_0`: `f_x`, `f_y`, `f_z` \[N\], `m_x`, `m_y`, `m_z` \[N·m\].
    pub wrench: [f64; 6],
    /// `d`: half widths of the set about `W_0`, in the same order.
    pub range: [f64; 6],
    /// Shape of the set.
    pub shape: LoadShape,
    /// Acceleration of gravity \[m/s²\].
    pub gravity: [f64; 3],
}

impl Default for Loads {
    /// The loads of the paper, in any direction, on a manipulator whose plane is horizontal.
    fn default() -> Self {
        Self {
            wrench: [0.0; 6],
            range: [100.0, 100.0, 100.0, 0.0, 0.0, 10.0],
            shape: LoadShape::Cylinder,
            gravity: [0.0, 0.0, -9.81],
        }
    }
}

impl Loads {
    /// Returns the loads with a single wrench in place of the set.
    pub fn with_wrench(self, wrench: [f64; 6]) -> Self {
        Self {
            wrench,
            range: [0.0; 6],
            ..self
        }
    }

    /// Returns whether a rotation by 120° about z maps the loads onto themselves.
    pub fn are_three_fold(&self) -> bool {
        let [fx, fy, _, mx, my, _] = self.wrench;
        let [dx, dy, _, tx, ty, _] = self.range;
        let of_set = match self.shape {
            LoadShape::Box => [dx, dy, tx, ty] == [0.0; 4],
            LoadShape::Cylinder | LoadShape::Ellipsoid => dx == dy && tx == ty,
        };
        [fx, fy, mx, my, self.gravity[0], self.gravity[1]] == [0.0; 6] && of_set
    }

    /// Returns whether the members weigh something in the plane, and along z.
    pub(super) fn weighs(&self) -> [bool; 2] {
        let [x, y, z] = self.gravity;
        [x != 0.0 || y != 0.0, z != 0.0]
    }

    /// Returns the largest value over the set of a resultant of the in-plane components, given its derivatives by `f_x`, `f_y`, `m_z`.
    #[inline(always)]
    pub(super) fn in_plane_range<V: Real>(&self, by: &[V; 3]) -> V {
        let like = by[0];
        let pair = [by[0] * like.splat(self.range[0]), by[1] * like.splat(self.range[1])];
        self.shape.largest(pair, by[2] * like.splat(self.range[5]))
    }

    /// Returns the largest value over the set of a resultant of the other components, given its derivatives by `f_z`, `m_x`, `m_y`.
    #[inline(always)]
    pub(super) fn out_of_plane_range<V: Real>(&self, by: &[V; 3]) -> V {
        let like = by[0];
        let lift = by[0] * like.splat(self.range[2]);
        // Most studies have no tilting moment, and all shapes are one then.
        if self.range[3] == 0.0 && self.range[4] == 0.0 {
            return lift.abs();
        }
        let pair = [by[1] * like.splat(self.range[3]), by[2] * like.splat(self.range[4])];
        self.shape.largest(pair, lift)
    }
}

impl LoadShape {
    /// Returns the largest sum of contributions: of two components in directions of the plane, and of one by itself.
    #[inline(always)]
    fn largest<V: Real>(self, [x, y]: [V; 2], single: V) -> V {
        match self {
            LoadShape::Box => x.abs() + y.abs() + single.abs(),
            LoadShape::Cylinder => (x * x + y * y).sqrt() + single.abs(),
            LoadShape::Ellipsoid => (x * x + y * y + single * single).sqrt(),
        }
    }
}
