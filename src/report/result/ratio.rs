//! Shares of nothing.

/// `a` of `b`; 0 if there is no `b`, as JSON has no infinities.
pub(super) fn ratio(a: f64, b: f64) -> f64 {
    if b == 0.0 { 0.0 } else { a / b }
}
