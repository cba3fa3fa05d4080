//! From a hit on a coarse triangle to the full-resolution triangle it stands for.

const ONE: u32 = 1 << 31;
const HALF: u32 = ONE / 2;

/// `node` and barycentrics (sum 2^31) after `steps` splits. Exactly 1/2 goes to the centre.
pub(super) fn descend(node: u32, bary: [u32; 3], steps: u32) -> (u32, [u32; 3]) {
    (0..steps).fold((node, bary), |(node, b), _| match b.iter().position(|&x| x > HALF) {
        // Near corner k: twice as far from the other two corners, what is left to this one.
        Some(k) => (4 * node + k as u32, std::array::from_fn(|i| if i == k { 2 * (b[i] - HALF) } else { 2 * b[i] })), // k < 3
        None => (4 * node + 3, b.map(|x| 2 * (HALF - x))),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::lattice;
    use proptest::prelude::*;

    #[test]
    fn halves_go_to_the_centre() {
        assert_eq!(descend(0, [HALF, HALF, 0], 1), (3, [0, 0, ONE]));
        assert_eq!(descend(5, [0, HALF, HALF], 1), (23, [ONE, 0, 0]));
        assert_eq!(descend(0, [HALF + 1, HALF - 1, 0], 1), (0, [2, ONE - 2, 0]));
        assert_eq!(descend(0, [HALF - 1, HALF + 1, 0], 1), (1, [ONE - 2, 2, 0]));
        assert_eq!(descend(0, [0, 0, ONE], 3), (2 * 16 + 2 * 4 + 2, [0, 0, ONE]));
        assert_eq!(descend(7, [1, 2, ONE - 3], 0), (7, [1, 2, ONE - 3]));
        assert_eq!(descend(0, [HALF, HALF / 2, HALF / 2], 2), (3 * 4 + 3, [ONE, 0, 0]));
    }

    proptest! {
        #[test]
        fn the_place_on_the_base_triangle_stays(b1 in 0..=ONE, part in 0.0f64..=1.0, steps in 0u32..=10) {
            let b2 = ((f64::from(ONE - b1) * part) as u32).min(ONE - b1);
            let (node, b) = descend(0, [ONE - b1 - b2, b1, b2], steps);
            prop_assert_eq!(b.iter().map(|&x| u64::from(x)).sum::<u64>(), u64::from(ONE));
            // Lattice coordinates of the mapped point, in steps of 2^-(31 + steps), are those of the hit.
            let p = lattice::node(steps, steps, node);
            let at = |k: fn((u32, u32)) -> u32| (0..3).map(|c| u64::from(b[c]) * u64::from(k(p[c]))).sum::<u64>();
            prop_assert_eq!((at(|p| p.0), at(|p| p.1)), (u64::from(b1) << steps, u64::from(b2) << steps));
        }
    }
}
