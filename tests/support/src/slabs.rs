//! A ray against a box in exact fractions.

/// A number as (numerator, denominator), the denominator above 0.
pub type Fraction = (i128, i128);

/// Whether a < b.
pub fn less(a: Fraction, b: Fraction) -> bool {
    a.0 * b.1 < b.0 * a.1
}

/// Exact: is there a real t >= 0 with x + t d in the closed box? Gives the entry t.
pub fn slabs(x: [i64; 3], d: [i64; 3], lo: [i64; 3], hi: [i64; 3]) -> Option<Fraction> {
    let (mut near, mut far) = ((0i128, 1i128), None::<Fraction>);
    for k in 0..3 {
        if d[k] == 0 {
            if x[k] < lo[k] || x[k] > hi[k] {
                return None;
            }
            continue;
        }
        let fraction = |wall: i64| {
            let (n, m) = (i128::from(wall - x[k]), i128::from(d[k]));
            if m < 0 { (-n, -m) } else { (n, m) }
        };
        let (a, b) = if d[k] > 0 { (fraction(lo[k]), fraction(hi[k])) } else { (fraction(hi[k]), fraction(lo[k])) };
        if less(near, a) {
            near = a;
        }
        if far.is_none_or(|f| less(b, f)) {
            far = Some(b);
        }
    }
    match far {
        Some(far) if less(far, near) => None,
        _ => Some(near),
    }
}
