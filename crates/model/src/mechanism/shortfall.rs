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
