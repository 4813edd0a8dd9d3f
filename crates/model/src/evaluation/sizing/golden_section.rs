//! Golden-section search (Kiefer 1953).

/// Fraction of an interval that one comparison leaves.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Returns where in an interval a function with one minimum is smallest, to within `accuracy`. The function may be infinite below
/// some place.
pub(super) fn golden_section([mut low, mut high]: [f64; 2], accuracy: f64, mut value: impl FnMut(f64) -> f64) -> f64 {
    let mut left = high - GOLDEN * (high - low);
    let mut right = low + GOLDEN * (high - low);
    let (mut at_left, mut at_right) = (value(left), value(right));
    while high - low > accuracy {
        if at_left <= at_right && at_left.is_finite() {
            high = right;
            (right, at_right) = (left, at_left);
            left = high - GOLDEN * (high - low);
            at_left = value(left);
        } else {
            low = left;
            (left, at_left) = (right, at_right);
            right = low + GOLDEN * (high - low);
            at_right = value(right);
        }
    }
    if at_left <= at_right { left } else { right }
}
