//! What rays do in a kd-tree that no block does, stated by what it is made of in hardware of 32-bit floats, as the paper has it.

use crate::block::Work;

/// Bits of a significand.
const SIGNIFICAND: u32 = 24;
/// Bits of a float, and of a coordinate.
const WORD: u32 = 32;
/// Bits selected in a sum of floats: two shifts of a significand, to align and to normalise, in five steps each.
const ALIGN: u32 = 2 * 5 * SIGNIFICAND;

/// Number of [`SPLIT`] among the works.
pub const KD_SPLIT: u32 = 0;
/// Number of [`TEST`].
pub const RLOD_TEST: u32 = 1;
/// Number of [`PLANE`].
pub const RLOD_PLANE: u32 = 2;

/// Where a ray crosses a split, and which children it visits in which order: a difference, a product with 1 / d, and two comparisons with the ends of what is left of the ray.
const SPLIT: Work = Work {
    name: "kd_split",
    products: &[[1, SIGNIFICAND, SIGNIFICAND]],
    add_bits: (1 + 2) * WORD,
    select_bits: ALIGN + 3 * WORD,
    written_bits: WORD + 2,
};

/// Does an R-LOD serve (equation 1): its error out of a table of 32, the cone's radius where the cell is entered, a product and a sum, and a comparison.
const TEST: Work = Work {
    name: "rlod_test",
    products: &[[1, SIGNIFICAND, SIGNIFICAND]],
    add_bits: 2 * WORD,
    select_bits: 31 * WORD + ALIGN,
    written_bits: 1,
};

/// A ray and a plane: n.o and n.d, a difference, their quotient, which takes a step for each bit of the significand, and two comparisons with the cell's ends, each widened by a sum.
const PLANE: Work = Work {
    name: "rlod_plane",
    products: &[[6 + 1, SIGNIFICAND, SIGNIFICAND]],
    add_bits: (4 + 1 + 2 + 2) * WORD + SIGNIFICAND * (SIGNIFICAND + 2),
    select_bits: 7 * ALIGN + SIGNIFICAND * (SIGNIFICAND + 2),
    written_bits: WORD + 1,
};

/// All, by their numbers.
pub const WORKS: &[Work] = &[SPLIT, TEST, PLANE];
