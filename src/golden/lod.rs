//! Displacement bounds, edge states and inserted vertices, as the definitions say.

use super::predicates::{Vector, sub};
use crate::num::{BoundScale, Cone};
use num_bigint::BigUint;
use std::sync::LazyLock;

/// What of a ray the level of detail depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Viewer {
    pub origin: Vector,
    pub direction: Vector,
    pub cone: Cone,
}

/// The displacement that a code stands for: none for code 0, else the largest h with 256 h <= M 2^(k div 16) for k = code + offset and M = [`ROOTS`] of k mod 16.
pub(super) fn displacement(scale: BoundScale, code: u8) -> i128 {
    let k = u64::from(code) + scale.offset.get();
    let root = i128::from(ROOTS[(k % 16) as usize]); // below 16
    if code == 0 { 0 } else { (root * power(k / 16)).div_euclid(256) }
}

/// For i = 0 to 15 the least M with M^16 >= 2^128 2^i: 2^(i / 16) in 256ths, rounded up.
static ROOTS: LazyLock<[u32; 16]> = LazyLock::new(|| {
    std::array::from_fn(|i| {
        let least = BigUint::from(1u32) << (128 + i);
        let mut m = 0u32;
        while BigUint::from(m).pow(16) < least {
            m += 1;
        }
        m
    })
});

fn power(exponent: u64) -> i128 {
    2i128.pow(exponent as u32) // a shift of 6 bits
}

/// State s, 0 to 256, of the edge (a, b) whose displacement bound is `h`.
///
/// With X = offset + l slope, the tolerated displacement is D = X / 2^shift rounded down, at least 0. (Its upper limit 2^34 - 1 is
/// above every h and changes no state.) The two decisions are taken on X itself:
/// h <= D iff h 2^shift <= X or h = 0; h >= 2D iff X < (floor(h / 2) + 1) 2^shift.
pub(super) fn state(viewer: &Viewer, a: Vector, b: Vector, h: i128) -> i64 {
    let x = tolerance(viewer, a, b);
    let one = power(viewer.cone.shift.get());
    if h == 0 || h * one <= x {
        0
    } else if x < (h / 2 + 1) * one {
        256
    } else {
        // D < h < 2D: h / D in 256ths, less 1, and at least one step as s = 0 is for h <= D only.
        let tolerated = x / one;
        (256 * h / tolerated - 256).max(1) as i64 // below 256
    }
}

/// How far the two decisions of [`state`] are from going the other way, in steps of 2^-shift units: the lesser of |h 2^shift - X| and
/// |(floor(h / 2) + 1) 2^shift - X|. `None` for h = 0, which decides nothing.
pub(super) fn margin(viewer: &Viewer, a: Vector, b: Vector, h: i128) -> Option<u128> {
    let x = tolerance(viewer, a, b);
    let one = power(viewer.cone.shift.get());
    (h > 0).then(|| (h * one - x).unsigned_abs().min(((h / 2 + 1) * one - x).unsigned_abs()))
}

/// X = offset + l slope: the tolerated displacement in steps of 2^-shift units, not clamped.
fn tolerance(viewer: &Viewer, a: Vector, b: Vector) -> i128 {
    let along = |p| -> i128 {
        let p = sub(p, viewer.origin);
        (0..3).map(|k| i128::from(p[k]) * i128::from(viewer.direction[k])).sum()
    };
    let l = along(a).min(along(b)).div_euclid(power(30));
    i128::from(viewer.cone.offset.get()) + l * i128::from(viewer.cone.slope.get())
}

/// The vertex q moved towards the midpoint m of (a, b): m + (q - m) s / 256, the product rounded down to a multiple of 2^grid.
pub(super) fn inserted(a: Vector, b: Vector, q: Vector, s: i64, grid: u32) -> Vector {
    let unit = 256i64 << grid;
    std::array::from_fn(|k| {
        let m = (a[k] + b[k]).div_euclid(2); // exact: both lie on a grid of at least two units
        m + ((q[k] - m) * s).div_euclid(unit) * (1 << grid)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::U;
    use proptest::prelude::*;

    fn viewer(offset: u64, slope: u64, shift: u64) -> Viewer {
        Viewer {
            origin: [0; 3],
            direction: [0, 0, 1 << 30],
            cone: Cone { offset: U::new(offset), slope: U::new(slope), shift: U::new(shift) },
        }
    }

    #[test]
    fn displacements_by_hand() {
        let h = |offset, code| displacement(BoundScale { offset: U::new(offset) }, code);
        // Whole octaves are powers of two; half an octave is 362.04 of 256.
        assert_eq!([0, 1, 15, 16, 17, 32, 160, 168].map(|code| h(0, code)), [0, 1, 1, 2, 2, 4, 1024, 1452]);
        assert_eq!([0, 1, 15, 255].map(|code| h(145, code)), [0, 560, 1024, 1 << 25]);
        assert_eq!(h(272, 255), 491 << 24);
    }

    #[test]
    fn displacements_are_those_of_the_blocks_table() {
        // The production decode must say the same; here only as a second opinion.
        for offset in 0..=crate::num::MAX_BOUND_OFFSET {
            let scale = BoundScale { offset: U::new(offset) };
            for code in 0..=u8::MAX {
                assert_eq!(displacement(scale, code), i128::from(crate::num::bound_decode(scale, code)), "{offset} {code}");
            }
        }
    }

    #[test]
    fn states_at_the_limits_by_hand() {
        // D = 100 wherever the edge is.
        let v = viewer(1000, 0, 3); // 125
        let s = |h| state(&v, [0, 0, 5], [3, 3, 9], h);
        assert_eq!((s(0), s(125), s(126), s(187), s(249), s(250), s(1 << 32)), (0, 0, 2, 126, 253, 256, 256));
        // D = 1 has nothing between: 2 >= 2D.
        let v = viewer(15, 0, 3);
        assert_eq!([0, 1, 2].map(|h| state(&v, [0; 3], [0; 3], h)), [0, 0, 256]);
        // At or behind the origin.
        let v = viewer(0, 1 << 17, 3);
        assert_eq!(state(&v, [0; 3], [0, 0, 9], 0), 0);
        assert_eq!(state(&v, [0; 3], [0, 0, 9], 1), 256);
        assert_eq!(state(&v, [0, 0, -4], [0, 0, 9], 1), 256);
        // A large D: the smallest fraction is one step, not none.
        let v = viewer(1 << 20, 0, 0);
        assert_eq!(state(&v, [0; 3], [0; 3], (1 << 20) + 1), 1);
    }

    #[test]
    fn margins_by_hand() {
        // X = 1000, in eighths of a unit: D = 125 has none, and D = 250 one of 8 to (250 / 2 + 1) 8.
        let v = viewer(1000, 0, 3);
        assert_eq!([0, 120, 125, 130, 250].map(|h| margin(&v, [0; 3], [5; 3], h)), [None, Some(40), Some(0), Some(40), Some(8)]);
    }

    #[test]
    fn inserted_vertices_reach_both_ends_and_keep_to_the_grid() {
        let (a, b, q) = ([0, -64, 32], [64, 0, 96], [48, -128, 64]);
        assert_eq!(inserted(a, b, q, 0, 4), [32, -32, 64]);
        assert_eq!(inserted(a, b, q, 256, 4), q);
        assert_eq!(inserted(a, b, q, 128, 4), [32, -80, 64]); // 8 is below a step of 16: down to 0
        assert_eq!(inserted(a, b, q, 1, 4), [32, -48, 64]); // -96 / 256 goes down a whole step
    }

    /// The words of `docs/numbers.md`, transcribed.
    fn as_stated(l: i128, cone: Cone, h: i128) -> i64 {
        let x = i128::from(cone.offset.get()) + l * i128::from(cone.slope.get());
        let d = (x >> cone.shift.get()).clamp(0, (1 << 34) - 1);
        if h <= d {
            0
        } else if h >= 2 * d {
            256
        } else {
            ((h - d) * 256 / d).clamp(1, 255) as i64
        }
    }

    proptest! {
        #[test]
        fn decisions_on_fractions_are_the_stated_ones(offset in 0u64..1 << 53, slope in 0u64..1 << 18, shift in 0u64..64, z in -(1i64 << 32)..1 << 32,
                                                      h in 0i128..1 << 33, near in any::<bool>(), bits in 0u32..53) {
            let v = viewer(offset >> bits, slope, shift);
            let x = i128::from(v.cone.offset.get()) + i128::from(z) * i128::from(slope);
            // Half of the cases close to D and 2D, where it matters.
            let h = if near { ((x >> shift) * (1 + (h & 1)) + (h >> 1) % 3 - 1).clamp(0, (1 << 33) - 1) } else { h };
            prop_assert_eq!(state(&v, [0, 0, z], [9, 9, z], h), as_stated(i128::from(z), v.cone, h));
        }

        #[test]
        fn states_are_monotone_and_symmetric(offset in 0u64..1 << 40, slope in 0u64..1 << 18, shift in 0u64..40, z in 0i64..1 << 32, dz in 0i64..1 << 20,
                                             h in 0i128..1 << 32, dh in 0i128..1 << 20, a in prop::array::uniform3(-(1i64 << 31)..1 << 31)) {
            let v = viewer(offset, slope, shift);
            let s = state(&v, a, [0, 0, z], h);
            prop_assert_eq!(s, state(&v, [0, 0, z], a, h));
            prop_assert!(state(&v, a, [0, 0, z], h + dh) >= s);
            prop_assert!(state(&v, [a[0], a[1], a[2] + dz], [0, 0, z + dz], h) <= s);
            prop_assert_eq!(s == 0, h <= 0 || as_stated(i128::from(a[2].min(z)), v.cone, h) == 0);
        }

        #[test]
        fn inserted_vertices_lie_between_midpoint_and_vertex(a in -(1i64 << 20)..1 << 20, b in -(1i64 << 20)..1 << 20, q in -(1i64 << 21)..1 << 21, s in 0i64..=256, grid in 0u32..10) {
            let (a, b, q) = (a << (grid + 1), b << (grid + 1), q << grid);
            let [x, ..] = inserted([a; 3], [b; 3], [q; 3], s, grid);
            let m = (a + b) / 2;
            prop_assert!(x >= m.min(q) && x <= m.max(q) && x.trailing_zeros() >= grid);
        }
    }
}
