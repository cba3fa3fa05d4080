//! A uniform cubic B-spline, from its control points.

/// Value, first and second derivative at `t`, 0..=1, of the curve that begins in the first and ends in the last of `points`.
///
/// It is straight at its ends (no second derivative there), and so is what it answers a little before 0 and after 1 if the outermost points are in line.
pub(super) fn spline<const D: usize>(points: &[[f64; D]], t: f64) -> [[f64; D]; 3] {
    let last = points.len() - 1;
    let pieces = last as f64;
    let x = t * pieces;
    // The cast takes what is below 0 for 0.
    let piece = (x as usize).min(last - 1);
    let f = x - piece as f64;
    // Beyond the ends a point mirrored in the end.
    let mirrored = |end: usize, inner: usize| std::array::from_fn(|k| 2.0 * points[end][k] - points[inner][k]);
    let before = if piece == 0 { mirrored(0, 1) } else { points[piece - 1] };
    let after = if piece + 1 == last { mirrored(last, last - 1) } else { points[piece + 2] };
    let near = [before, points[piece], points[piece + 1], after];
    let (g, ff) = (1.0 - f, f * f);
    let sum = |weights: [f64; 4], scale: f64| std::array::from_fn(|k| scale * (0..4).map(|i| weights[i] * near[i][k]).sum::<f64>());
    [
        sum([g * g * g, (3.0 * f - 6.0) * ff + 4.0, 3.0 * (f + ff - ff * f) + 1.0, ff * f], 1.0 / 6.0),
        sum([-g * g, 3.0 * ff - 4.0 * f, 2.0 * f - 3.0 * ff + 1.0, ff], 0.5 * pieces),
        sum([g, 3.0 * f - 2.0, 1.0 - 3.0 * f, f], pieces * pieces),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_the_curve_and_ends_are_met() {
        let points = [[0.0, 1.0], [0.5, 1.2], [0.9, 0.3], [1.0, -0.4], [0.2, -1.0]];
        let e = 1e-5;
        for n in 0..50 {
            let t = f64::from(n) / 50.0 + 0.01;
            let [_, first, second] = spline(&points, t);
            let [a, b] = [t - e, t + e].map(|t| spline(&points, t));
            for k in 0..2 {
                assert!(((b[0][k] - a[0][k]) / (2.0 * e) - first[k]).abs() < 1e-6);
                assert!(((b[1][k] - a[1][k]) / (2.0 * e) - second[k]).abs() < 1e-3);
            }
        }
        for (t, end) in [(0.0, points[0]), (1.0, points[4])] {
            let [p, _, second] = spline(&points, t);
            assert!((0..2).all(|k| (p[k] - end[k]).abs() < 1e-15 && second[k].abs() < 1e-12));
        }
    }
}
