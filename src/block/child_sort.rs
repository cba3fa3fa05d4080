//! Order of four children by entry distance (paper figure 9, "sort child nodes").
//!
//! Hit children first, nearer before farther, equal distances by child number; `count` of them are hit. The rest of `order` holds the missed
//! children, by number. Legal: anything.

use super::parts::{Parts, Registers, TAG};
use super::{Block, Form, Timing};
use crate::num::{TNear, U, Wire, wire_struct};

wire_struct! {
    /// Input of [`ChildSort`].
    pub struct In {
        /// Child k is hit.
        hit: [bool; 4],
        /// Entry distance of child k.
        t_near: [TNear; 4],
    }
}

wire_struct! {
    /// Output of [`ChildSort`].
    pub struct Out {
        /// Number of children hit, 0 to 4.
        count: U<3>,
        /// Child numbers, nearest first.
        order: [U<2>; 4],
    }
}

/// The block.
pub struct ChildSort;

/// Missed or not, distance, number.
const KEY: u32 = 1 + TNear::WIDTH + 2;

impl ChildSort {
    /// Registers with a tag of so many bits: three steps of the network, each with the count.
    pub(super) fn registers(tag: u32) -> Registers {
        let step = Registers::stage(3 + 4 * KEY + tag);
        // The first step knows a bit of each number; the second compares the middle two, so that the others are numbers alone; the last gives numbers.
        step.without(4) + step.without(2 * (KEY - 2)) + step.without(4 * (KEY - 2))
    }
}

impl Block for ChildSort {
    const NAME: &'static str = "child_sort";
    const TIMING: Timing = Timing::pipelined(3);
    type In = In;
    type Out = Out;
    fn parts(_: &Form) -> Parts {
        // Five comparators, and the count.
        Parts { products: vec![], add_bits: 5 * KEY + 9, select_bits: 5 * 2 * KEY, registers: Self::registers(TAG) }
    }
    #[inline(always)]
    fn eval(input: &In) -> Out {
        // Key: missed, t_near (17 bits), number (2): all different.
        let key = |k: usize, number: u64| (if input.hit[k] { input.t_near[k].get() << 2 } else { 1 << 20 }) | number;
        let mut keys = [key(0, 0), key(1, 1), key(2, 2), key(3, 3)];
        // A five-comparator network.
        for (a, b) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
            let (low, high) = (keys[a].min(keys[b]), keys[a].max(keys[b]));
            keys[a] = low;
            keys[b] = high;
        }
        let [a, b, c, d] = input.hit;
        let count = u64::from(a) + u64::from(b) + u64::from(c) + u64::from(d);
        let number = |key: u64| U::new(key & 3);
        Out { count: U::new(count), order: [number(keys[0]), number(keys[1]), number(keys[2]), number(keys[3])] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn order_is_a_stable_sort(hit in prop::array::uniform4(any::<bool>()), t in prop::array::uniform4(0u64..6)) {
            let out = ChildSort::eval(&In { hit, t_near: t.map(U::new) });
            let mut wanted: Vec<usize> = (0..4).collect();
            wanted.sort_by_key(|&k| (!hit[k], if hit[k] { t[k] } else { 0 }));
            prop_assert_eq!(out.order.map(|o| o.get() as usize).to_vec(), wanted);
            prop_assert_eq!(out.count.get() as usize, hit.iter().filter(|&&h| h).count());
        }
    }
}
