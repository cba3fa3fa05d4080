//! Leaf blocks: up to 16 triangles that share vertices, in one to four lines, without loss (as dense geometry formats have them).
//!
//! Bits count from the lowest of the first word on; a field that crosses words goes on in the next.
//!
//! | bits | what |
//! |---|---|
//! | 4 | triangles less one |
//! | 6 | vertices less one |
//! | 5, 5, 5 | bits of an offset along x, y and z |
//! | 5 | zero bits that all offsets end with, which are not stored |
//! | 28, 28, 28 | the anchor: least x, y and z in steps of 16 units |
//! | the three above, for each vertex | its offsets from the anchor, vertices in the order in which the triangles first use them |
//! | 3 x as many as number the vertices, for each triangle | its corners |

use crate::format::Line;
use crate::num::{LINE_BYTES, PADDING_BITS as PADDING};

/// Most triangles of a block.
pub const MOST_TRIANGLES: usize = 16;
/// Most lines of a block.
pub const MOST_LINES: usize = 4;

const LINE_BITS: u32 = 8 * LINE_BYTES as u32;
/// Up to the first vertex.
const HEADER: u32 = 4 + 6 + 3 * 5 + 5 + 3 * 28;

/// Corners in units.
type Triangle = [[i32; 3]; 3];

/// What a block of some triangles needs.
struct Plan {
    vertices: [[i32; 3]; 3 * MOST_TRIANGLES],
    count: usize,
    corners: [[u8; 3]; MOST_TRIANGLES],
    anchor: [i32; 3],
    zeros: u32,
    widths: [u32; 3],
}

impl Plan {
    /// That of 1 to [`MOST_TRIANGLES`].
    fn new(triangles: &[Triangle]) -> Self {
        let mut plan = Self {
            vertices: [[0; 3]; 3 * MOST_TRIANGLES],
            count: 0,
            corners: [[0; 3]; MOST_TRIANGLES],
            anchor: triangles[0][0],
            zeros: 0,
            widths: [0; 3],
        };
        for (corners, triangle) in plan.corners.iter_mut().zip(triangles) {
            *corners = triangle.map(|vertex| {
                let known = plan.vertices[..plan.count].iter().position(|other| *other == vertex);
                known.unwrap_or_else(|| {
                    plan.vertices[plan.count] = vertex;
                    plan.count += 1;
                    plan.count - 1
                }) as u8 // below 48
            });
        }
        let vertices = &plan.vertices[..plan.count];
        let anchor: [i32; 3] = std::array::from_fn(|k| vertices.iter().map(|v| v[k]).min().unwrap_or(0));
        let all: [u32; 3] = std::array::from_fn(|k| vertices.iter().fold(0, |all, v| all | offset(v[k], anchor[k])));
        let any = all[0] | all[1] | all[2];
        (plan.anchor, plan.zeros) = (anchor, if any == 0 { 0 } else { any.trailing_zeros() });
        // All offsets or'ed have their highest bit where the largest has it.
        plan.widths = all.map(|bits| u32::BITS - (bits >> plan.zeros).leading_zeros());
        plan
    }

    fn index_bits(&self) -> u32 {
        index_bits(self.count)
    }

    fn bits(&self, triangles: usize) -> u32 {
        // At most 48 vertices of 84 bits and 16 x 18 bits.
        HEADER + self.count as u32 * self.widths.iter().sum::<u32>() + 3 * triangles as u32 * self.index_bits()
    }
}

/// How far a coordinate lies above the anchor's; up to 32 bits.
fn offset(coordinate: i32, anchor: i32) -> u32 {
    coordinate.wrapping_sub(anchor) as u32
}

/// Bits that number so many vertices.
fn index_bits(vertices: usize) -> u32 {
    usize::BITS - (vertices - 1).leading_zeros()
}

/// Lines of the block of these triangles, whose coordinates are multiples of 16; none if they are none, too many, or need more than [`MOST_LINES`].
pub fn lines(triangles: &[Triangle]) -> Option<u32> {
    if triangles.is_empty() || triangles.len() > MOST_TRIANGLES {
        return None;
    }
    let lines = Plan::new(triangles).bits(triangles.len()).div_ceil(LINE_BITS);
    (lines <= MOST_LINES as u32).then_some(lines)
}

/// The block of these triangles, of as many lines as [`lines`] says; none where that says so.
pub fn encode(triangles: &[Triangle]) -> Option<Vec<Line>> {
    let count = lines(triangles)? as usize;
    let plan = Plan::new(triangles);
    let mut block = vec![Line::default(); count];
    let words = block.as_flattened_mut();
    let mut at = 0;
    let mut put = |value: u64, width: u32| {
        let (word, shift) = ((at / u64::BITS) as usize, at % u64::BITS);
        words[word] |= value << shift;
        if shift + width > u64::BITS {
            words[word + 1] |= value >> (u64::BITS - shift);
        }
        at += width;
    };
    put(triangles.len() as u64 - 1, 4);
    put(plan.count as u64 - 1, 6);
    plan.widths.iter().for_each(|&width| put(u64::from(width), 5));
    put(u64::from(plan.zeros), 5);
    plan.anchor.iter().for_each(|&c| put((c >> PADDING) as u64 & MASK28, 28));
    for vertex in &plan.vertices[..plan.count] {
        for ((&c, &anchor), &width) in vertex.iter().zip(&plan.anchor).zip(&plan.widths) {
            put(u64::from(offset(c, anchor) >> plan.zeros), width);
        }
    }
    for corner in plan.corners[..triangles.len()].as_flattened() {
        put(u64::from(*corner), plan.index_bits());
    }
    Some(block)
}

const MASK28: u64 = (1 << 28) - 1;

/// A block to read.
pub struct Block<'a> {
    words: &'a [u64],
    triangles: usize,
    zeros: u32,
    widths: [u32; 3],
    anchor: [i32; 3],
    /// Of a vertex.
    vertex_bits: u32,
    index_bits: u32,
    /// Where the corners begin.
    corners: u32,
}

impl<'a> Block<'a> {
    /// The block in these lines, which [`encode`] made.
    #[inline]
    pub fn new(lines: &'a [Line]) -> Self {
        let words = lines.as_flattened();
        let [first, second, ..] = *words else { unreachable!("a line has four words") };
        let low = |at: u32, width: u32| (first >> at) as u32 & ((1 << width) - 1);
        let vertices = low(4, 6) + 1;
        let widths = [low(10, 5), low(15, 5), low(20, 5)];
        let vertex_bits = widths.iter().sum();
        // From bit 30 on: the sign of 28 bits is where that of 32 is, with their zeros.
        let all = u128::from(second) << 64 | u128::from(first);
        let anchor = [30, 58, 86].map(|at| ((all >> at) as u32) << PADDING).map(|c| c as i32);
        Self {
            words,
            triangles: low(0, 4) as usize + 1,
            zeros: low(25, 5),
            widths,
            anchor,
            vertex_bits,
            index_bits: index_bits(vertices as usize),
            corners: HEADER + vertices * vertex_bits,
        }
    }

    /// Number of triangles.
    #[inline]
    pub fn len(&self) -> usize {
        self.triangles
    }

    /// `width` bits, up to 32, from bit `at` on.
    #[inline(always)]
    fn get(&self, at: u32, width: u32) -> u32 {
        let (word, shift) = ((at / u64::BITS) as usize, at % u64::BITS);
        let low = self.words[word] >> shift;
        let high = if shift + width > u64::BITS { self.words[word + 1] << (u64::BITS - shift) } else { 0 };
        ((low | high) & ((1 << width) - 1)) as u32
    }

    /// The corners of triangle `k`, in units.
    ///
    /// By loops: closures of `array::from_fn` stayed calls, a quarter of the time of a ray.
    #[inline(always)]
    pub fn triangle(&self, k: usize) -> Triangle {
        let mut triangle = [[0; 3]; 3];
        for (corner, vertex) in triangle.iter_mut().enumerate() {
            let index = self.get(self.corners + (3 * k + corner) as u32 * self.index_bits, self.index_bits);
            let mut at = HEADER + index * self.vertex_bits;
            for (axis, coordinate) in vertex.iter_mut().enumerate() {
                let width = self.widths[axis];
                // Nothing is read where nothing is stored: it may be the end.
                let stored = if width == 0 { 0 } else { self.get(at, width) };
                at += width;
                *coordinate = self.anchor[axis].wrapping_add((stored << self.zeros) as i32);
            }
        }
        triangle
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn holds(triangles: &[Triangle]) {
        let Some(block) = encode(triangles) else {
            assert_eq!(lines(triangles), None);
            return;
        };
        assert_eq!(Some(block.len() as u32), lines(triangles));
        let read = Block::new(&block);
        assert_eq!(read.len(), triangles.len());
        for (k, triangle) in triangles.iter().enumerate() {
            assert_eq!(read.triangle(k), *triangle, "{k} of {triangles:?}");
        }
    }

    const LEAST: i32 = i32::MIN;
    const MOST: i32 = i32::MAX & !15;

    #[test]
    fn one_triangle_fits_two_lines_whatever_it_is() {
        for triangle in [[[0; 3]; 3], [[LEAST; 3], [MOST; 3], [0; 3]], [[LEAST, 0, MOST], [0, 0, 0], [16, MOST, LEAST]], [[MOST; 3]; 3]] {
            assert!(lines(&[triangle]).is_some_and(|lines| lines <= 2));
            holds(&[triangle]);
        }
        assert_eq!(lines(&[[[48; 3]; 3]; 16]), Some(1));
        holds(&[[[48; 3]; 3]; 16]);
        assert_eq!(lines(&[[[0; 3]; 3]; 17]), None);
        assert_eq!(lines(&[]), None);
    }

    #[test]
    fn neighbours_share_their_vertices() {
        let vertex = |x: i32, y: i32| [16 * (1000 + x), 16 * (y - 3), 16 * (x * y)];
        let square = |k: i32| {
            let [a, b, c, d] = [vertex(k, 0), vertex(k + 1, 0), vertex(k, 1), vertex(k + 1, 1)];
            [[a, b, c], [b, d, c]]
        };
        // Two triangles: 4 vertices of 1 + 1 + 10 bits and 6 corners of 2 bits behind 114: one line. Sixteen: 18 of 4 + 1 + 4 bits or so, 48 of 5: two.
        holds(&square(0));
        assert_eq!(lines(&square(0)), Some(1));
        let strip: Vec<Triangle> = (0..8).flat_map(square).collect();
        holds(&strip);
        assert_eq!(lines(&strip), Some(3));
    }

    proptest! {
        #[test]
        fn what_was_written_is_read(
            raw in prop::collection::vec(prop::array::uniform3(prop::array::uniform3(any::<i32>())), 1..=17),
            bits in 0u32..32, zeros in 4u32..20, pool in 1usize..40,
        ) {
            let vertices: Vec<[i32; 3]> = raw.iter().flatten().map(|v| v.map(|c| (c >> bits) >> zeros << zeros)).collect();
            let triangles: Vec<Triangle> = raw.iter().map(|t| t.map(|v| vertices[v[0] as u32 as usize % vertices.len().min(pool)])).collect();
            holds(&triangles);
        }
    }
}
