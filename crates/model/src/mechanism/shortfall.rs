//! Why a leg does not reach a point.

/// Reason why a leg does not reach a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReachReason {
    /// The links are too short, so that the inverse kinematics has no real solution.
    OutOfReach,
    /// A prismatic joint would be below its lower limit.
    BelowLimit,
    /// A prismatic joint would be above its upper limit.
    AboveLimit,
    /// Two joints of the leg coincide, so that the direction of the leg is undefined.
    Degenerate,
}

/// Distance by which a leg fails to reach a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shortfall {
    /// Limit margin: signed distance to the violated limit \[m\], ≤ 0.
    pub limit_margin: f64,
    /// Violated limit.
    pub reason: ReachReason,
}

impl Shortfall {
    /// The links are too short by a distance, given as a negative margin \[m\].
    pub(super) fn out_of_reach(limit_margin: f64) -> Self {
        let reason = ReachReason::OutOfReach;
        Self { limit_margin, reason }
    }

    /// The direction of the leg is undefined.
    pub(super) fn degenerate() -> Self {
        Self {
            limit_margin: 0.0,
            reason: ReachReason::Degenerate,
        }
    }
}

/// Where the joints of a leg stand between their limits: the smallest distance from a limit \[m\], negative beyond it, and what is
/// wrong there.
#[derive(Debug, Clone, Copy)]
pub struct Within {
    /// The smallest distance.
    pub margin: f64,
    /// What is wrong beyond a limit.
    pub beyond: Option<Shortfall>,
}

impl Within {
    /// Compares a value with two limits.
    pub(super) fn limits(value: f64, [lower, upper]: [f64; 2]) -> Self {
        let (from_lower, to_upper) = (value - lower, upper - value);
        let beyond = if from_lower < 0.0 {
            Some((from_lower, ReachReason::BelowLimit))
        } else if to_upper < 0.0 {
            Some((to_upper, ReachReason::AboveLimit))
        } else if value.is_nan() {
            Some((0.0, ReachReason::Degenerate))
        } else {
            None
        };
        Self {
            margin: beyond.map_or(from_lower.min(to_upper), |(margin, _)| margin),
            beyond: beyond.map(|(limit_margin, reason)| Shortfall { limit_margin, reason }),
        }
    }

    /// Combines two joints: the smaller margin counts.
    pub(super) fn and(self, other: Self) -> Self {
        if other.margin < self.margin { other } else { self }
    }

    /// Takes account of a distance to the end of reach, which is not negative.
    pub(super) fn and_reach(self, reach: f64) -> Self {
        Self {
            margin: self.margin.min(reach),
            ..self
        }
    }
}
