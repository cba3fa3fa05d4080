//! What a grid's rays do that no block does, stated by what it is made of in hardware of 32-bit floats, as the paper has it.

use crate::block::Work;

/// Bits of a significand.
const SIGNIFICAND: u32 = 24;
/// Bits of a float, of an index, of a coordinate.
const WORD: u32 = 32;
/// Bits selected in a sum of floats: two shifts of a significand, to align and to normalise, in five steps each.
const ALIGN: u32 = 2 * 5 * SIGNIFICAND;

/// Number of [`SPHERE_TEST`] among the works.
pub const SPHERE: u32 = 0;
/// Number of [`INDEX_TRANSLATION`].
pub const INDEX: u32 = 1;
/// Number of [`SPHERE_SORT`].
pub const SORT: u32 = 2;
/// Number of [`BOX_PAIR`].
pub const PAIR: u32 = 3;

/// Sums of floats in a sphere test: the centre six, L = centre - origin three, L.d and L.L two each, L.L - (L.d)^2 and r^2 less that, t0 and t1, and three comparisons.
const SPHERE_SUMS: u32 = 6 + 3 + 2 * 2 + 2 + 2 + 3;

/// A sphere: its centre, and where a ray of direction 1 enters and leaves it.
///
/// Products: three by 1/3, L.d and L.L three each, (L.d)^2, r^2. The root takes a step for each bit of the significand, each a difference and a choice of two bits more.
/// Written: t0 and t1, and whether it is met.
const SPHERE_TEST: Work = Work {
    name: "sphere_test",
    products: &[[3 + 2 * 3 + 2, SIGNIFICAND, SIGNIFICAND]],
    add_bits: SPHERE_SUMS * WORD + SIGNIFICAND * (SIGNIFICAND + 2),
    select_bits: SPHERE_SUMS * ALIGN + SIGNIFICAND * (SIGNIFICAND + 2),
    written_bits: 2 * WORD + 1,
};

/// A preliminary index becomes a final one: a sum and its magnitude (equation 3), one of six bases, and which of three places vertices lie at.
const INDEX_TRANSLATION: Work =
    Work { name: "index_translation", products: &[], add_bits: 2 * WORD, select_bits: (5 + 1 + 2) * WORD, written_bits: WORD };

/// Four spheres in the order of t0: five comparisons, as `child_sort` has them, of 32-bit floats with the number of the child.
const SPHERE_SORT: Work =
    Work { name: "sphere_sort", products: &[], add_bits: 5 * WORD, select_bits: 5 * 2 * (WORD + 2), written_bits: 4 * (WORD + 2) };

/// Two boxes of 32-bit coordinates, and which of them is entered first: two of `box_test32`, of 33 x 31-bit products and entry distances of 17 x 18 bits, and a comparison.
const BOX_PAIR: Work = Work {
    name: "box_pair",
    products: &[[2 * 12, WORD + 1, 31], [2 * 3, 17, 18]],
    add_bits: 2 * (6 * (WORD + 1) + 6 * WORD + 6 * (WORD + 1 + 31) + 3 * 17) + 17,
    select_bits: 2 * (6 * WORD + 3 * 17 + 3 * 36 * 5 + 6 * 17) + 2 * 17,
    written_bits: 2 * (17 + 1),
};

/// All, by their numbers.
pub const WORKS: &[Work] = &[SPHERE_TEST, INDEX_TRANSLATION, SPHERE_SORT, BOX_PAIR];
