//! What a frame's work on clusters is made of, in operations that no block does.

use crate::block::Work;

/// Bits of a float's significand, and of a word.
const SIGNIFICAND: u32 = 24;
const WORD: u32 = 32;
/// Bits of a coordinate of a place, and of a step of the grid.
const PLACE: u32 = 16;
const STEP: u32 = 17;

/// Number of [`TEST`] among the works.
pub const GROUP_TEST: u32 = 0;
/// Number of [`DECODE`].
pub const VERTEX_DECODE: u32 = 1;
/// Number of [`BIN`].
pub const TRIANGLE_BIN: u32 = 2;
/// Number of [`ENCODE`].
pub const CHILD_ENCODE: u32 = 3;

/// Does a group serve: the vector to its centre, its length and that less the radius, the product with pixels; and whether the view's cone meets its sphere: the length along the axis, what
/// is beside it, and the distance from the side. Two roots take a step for each bit of the significand.
const TEST: Work = Work {
    name: "group_test",
    products: &[[3 + 2 + 3 + 1 + 2, SIGNIFICAND, SIGNIFICAND]],
    add_bits: (3 + 2 + 2 + 2 + 1 + 2 + 2) * WORD + 2 * SIGNIFICAND * (SIGNIFICAND + 2),
    select_bits: 2 * SIGNIFICAND * (SIGNIFICAND + 2),
    written_bits: 1,
};

/// A vertex leaves its cluster: a product and a sum for each coordinate.
const DECODE: Work =
    Work { name: "vertex_decode", products: &[[3, PLACE, STEP]], add_bits: 3 * WORD, select_bits: 0, written_bits: 3 * WORD };

/// A triangle, a cluster or a part of either on one level of a binary tree by the surface area heuristic: its bin on three axes, and the box of that bin, which grows.
const BIN: Work = Work {
    name: "box_bin",
    products: &[[3, WORD, PLACE]],
    add_bits: 3 * WORD + 3 * 6 * WORD,
    select_bits: 3 * 6 * WORD,
    written_bits: 3 * 6 * WORD,
};

/// A child's box in the frame of a node: six differences, shifts of five steps, and rounding outwards; or a triangle's corners in a leaf.
const ENCODE: Work =
    Work { name: "child_encode", products: &[], add_bits: 2 * 6 * WORD, select_bits: 6 * 5 * WORD, written_bits: 6 * 8 + WORD };

/// All, by their numbers; the last is that of a turned node of six, which none of these has.
pub const WORKS: &[Work] = &[TEST, DECODE, BIN, ENCODE];
