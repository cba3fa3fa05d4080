//! Order of six children by entry distance: [`super::child_sort`] for nodes of six.
//!
//! Hit children first, nearer before farther, equal distances by child number; `count` of them are hit. The rest of `order` holds the missed
//! children, by number. Legal: anything.

use super::parts::{Parts, Registers, TAG};
use super::{Block, Form, Timing};
use crate::num::{TNear, U, Wire, wire_struct};

wire_struct! {
    /// Input of [`ChildSort6`].
    pub struct In {
        /// Child k is hit.
        hit: [bool; 6],
        /// Entry distance of child k.
        t_near: [TNear; 6],
    }
}

wire_struct! {
    /// Output of [`ChildSort6`].
    pub struct Out {
        /// Number of children hit, 0 to 6.
        count: U<3>,
        /// Child numbers, nearest first.
        order: [U<3>; 6],
    }
}

/// The block.
pub struct ChildSort6;

/// Bits of a child's number, and of missed or not, distance, number.
const NUMBER: u32 = 3;
const KEY: u32 = 1 + TNear::WIDTH + NUMBER;

/// Twelve comparators in five steps, none of which can be left out.
const NETWORK: [&[(usize, usize)]; 5] =
    [&[(0, 5), (1, 3), (2, 4)], &[(1, 2), (3, 4)], &[(0, 3), (2, 5)], &[(0, 1), (2, 3), (4, 5)], &[(1, 2), (3, 4)]];

impl Block for ChildSort6 {
    const NAME: &'static str = "child_sort6";
    const TIMING: Timing = Timing::pipelined(5);
    type In = In;
    type Out = Out;
    fn parts(_: &Form) -> Parts {
        let step = Registers::stage(3 + 6 * KEY + TAG);
        // The first step knows all but a bit or two of each number, the second of those at both ends; ends that no later step compares are numbers alone: both behind the fourth, all behind the fifth.
        let all = step.without(12) + step.without(4) + step + step.without(2 * (KEY - NUMBER)) + step.without(6 * (KEY - NUMBER));
        Parts { products: vec![], add_bits: 12 * KEY + 15, select_bits: 12 * 2 * KEY, registers: all }
    }
    #[inline(always)]
    fn eval(input: &In) -> Out {
        // All different.
        let key = |k: usize, number: u64| (if input.hit[k] { input.t_near[k].get() << NUMBER } else { 1 << (KEY - 1) }) | number;
        let mut keys = [key(0, 0), key(1, 1), key(2, 2), key(3, 3), key(4, 4), key(5, 5)];
        for &(a, b) in NETWORK.iter().copied().flatten() {
            (keys[a], keys[b]) = (keys[a].min(keys[b]), keys[a].max(keys[b]));
        }
        let count = input.hit.iter().map(|&hit| u64::from(hit)).sum();
        Out { count: U::new(count), order: keys.map(|key| U::new(key & U::<NUMBER>::MAX.get())) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_network_sorts() {
        // Zeros and ones suffice.
        for bits in 0u64..64 {
            let mut keys: [u64; 6] = std::array::from_fn(|k| bits >> k & 1);
            for &(a, b) in NETWORK.iter().copied().flatten() {
                (keys[a], keys[b]) = (keys[a].min(keys[b]), keys[a].max(keys[b]));
            }
            assert!(keys.is_sorted(), "{bits:06b}");
        }
    }

    proptest! {
        #[test]
        fn order_is_a_stable_sort(hit in prop::array::uniform6(any::<bool>()), t in prop::array::uniform6(0u64..8)) {
            let out = ChildSort6::eval(&In { hit, t_near: t.map(U::new) });
            let mut wanted: Vec<usize> = (0..6).collect();
            wanted.sort_by_key(|&k| (!hit[k], if hit[k] { t[k] } else { 0 }));
            prop_assert_eq!(out.order.map(|o| o.get() as usize).to_vec(), wanted);
            prop_assert_eq!(out.count.get() as usize, hit.iter().filter(|&&h| h).count());
        }
    }
}
