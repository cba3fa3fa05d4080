//! Blocks of the dense geometry format, version 1 (AMD, `VK_AMDX_dense_geometry_format`): up to 64 triangles and 64 vertices in 128 bytes, as a strip.
//!
//! Bits count from the lowest of the first word on.
//!
//! | bits | what |
//! |---|---|
//! | 8, 2, 6, 6, 10 | 6; bits of an index less three; vertices less one; triangles less one; geometry (opaque, number 0) |
//! | 8, 24 | exponent: how many zero bits all coordinates end with, and 127; anchor x |
//! | 4, 4, 24 | bits of an offset along x and y less one; anchor y |
//! | 4, 3, 1, 24 | along z less one; no opacity maps; one geometry; anchor z |
//! | 29, 3 | number of the first triangle; nothing |
//! | a multiple of 4 for each vertex | its offsets from the anchor |
//! | from the next byte on | indices of vertices that were met before, 3 to 6 bits each |
//! | at the end, backwards | two bits for each triangle but the first: how it goes on from those before |
//! | before that, backwards | a bit for each index but three: whether its vertex is met for the first time |
//!
//! A decoded coordinate is (anchor + offset) 2^(exponent - 127), here in units, so exact. Triangles go on over an edge of the one before, or of the one before that; the format turns their
//! corners as the strip has them, so what belongs to corners has to be turned too. Here [`Coded::turns`] says how far.

use crate::format::Line;

/// Lines of a block.
pub const LINES: usize = 4;
/// Most triangles of a block, and most vertices.
pub const MOST: usize = 64;
/// Names of a block's triangles: from the first on, and up to the last.
pub const PLACES: usize = 2 * MOST;
/// Bits of coordinates in a block's grid, of the numbers of triangles, and most of an offset.
const ANCHOR: u32 = 24;
const NUMBER: u32 = 29;
const OFFSET: u32 = 16;
const BITS: usize = 1024;
const HEADER: usize = 160;
/// Most bits of all vertices, and of all indices of vertices that were met before.
const VERTICES: usize = 96 * 8;
const REUSED: usize = 24 * 8;
const MAGIC: u64 = 6;
const OPAQUE: u64 = 1;
const BIAS: u32 = 127;

/// How a triangle goes on, the specification's control values: with three vertices of its own; over the second or the third edge of the one before; over the edge of the one before
/// that which this one did not take.
const RESTART: u8 = 0;
const EDGE1: u8 = 1;
const EDGE2: u8 = 2;
const BACKTRACK: u8 = 3;

/// Corners in units.
pub type Triangle = [[i32; 3]; 3];
/// A block of the dense geometry format, version 1.
pub type Block = [Line; LINES];

/// The ends of the edge over which a triangle goes on, as it has them itself: those of the one before, turned round.
fn shared<T: Copy>(control: u8, before: &[([T; 3], u8); 2]) -> [T; 2] {
    let second = |t: [T; 3]| [t[2], t[1]];
    let third = |t: [T; 3]| [t[0], t[2]];
    match (control, before[0].1) {
        (EDGE1, _) => second(before[0].0),
        (EDGE2, _) => third(before[0].0),
        (_, EDGE1) => third(before[1].0),
        _ => second(before[1].0),
    }
}

/// Corners from the one of this number on.
fn turned(t: &Triangle, turn: u8) -> Triangle {
    std::array::from_fn(|k| t[(k + usize::from(turn)) % 3])
}

/// The last two triangles of a strip, the last one first, as the strip has them, and how they went on.
#[derive(Clone, Copy)]
struct Tail([(Triangle, u8); 2]);

impl Tail {
    const NONE: Self = Self([([[0; 3]; 3], RESTART); 2]);

    /// How `triangle` goes on behind `length` triangles, and from which of its corners on it is stored.
    fn way(&self, length: usize, triangle: &Triangle, next: Option<&Triangle>) -> (u8, u8) {
        let goes_back = length > 1 && matches!(self.0[0].1, EDGE1 | EDGE2);
        let ways = [EDGE1, EDGE2, BACKTRACK].into_iter().take(if length == 0 { 0 } else { 2 + usize::from(goes_back) });
        let over = |way: u8| (0..3).find(|&turn| turned(triangle, turn)[..2] == shared(way, &self.0)).map(|turn| (way, turn));
        ways.filter_map(over).next().unwrap_or_else(|| {
            // So that the next one can go on.
            let serves = |&turn: &u8| next.is_some_and(|next| Self([(turned(triangle, turn), RESTART); 2]).way(1, next, None).0 != RESTART);
            (RESTART, (0..3).find(serves).unwrap_or(0))
        })
    }

    fn push(&mut self, triangle: Triangle, way: u8) {
        self.0 = [(triangle, way), self.0[0]];
    }
}

/// Triangles in the order of a strip, and what their block needs. The last one is placed when what follows it is known.
#[derive(Clone)]
pub struct Strip {
    vertices: [[i32; 3]; MOST],
    count: usize,
    tail: Tail,
    waiting: Option<Triangle>,
    /// How each goes on, and how far its corners are turned.
    ways: [u8; MOST],
    turns: [u8; MOST],
    length: usize,
    /// Whether an index is that of a new vertex; first ones too.
    is_new: [u64; 3],
    indices: usize,
    reused: [u8; 3 * MOST],
    reuses: usize,
    /// More than a block can have.
    is_over: bool,
}

impl Default for Strip {
    fn default() -> Self {
        Self {
            vertices: [[0; 3]; MOST],
            count: 0,
            tail: Tail::NONE,
            waiting: None,
            ways: [RESTART; MOST],
            turns: [0; MOST],
            length: 0,
            is_new: [0; 3],
            indices: 0,
            reused: [0; 3 * MOST],
            reuses: 0,
            is_over: false,
        }
    }
}

impl Strip {
    /// The strip of some triangles in this order.
    pub fn of(triangles: impl IntoIterator<Item = Triangle>) -> Self {
        let mut strip = Self::default();
        triangles.into_iter().for_each(|triangle| strip.push(triangle));
        strip
    }

    /// Goes on with a triangle.
    pub fn push(&mut self, triangle: Triangle) {
        if let Some(last) = self.waiting.replace(triangle) {
            self.place(&last, Some(&triangle));
        }
    }

    /// Which order of up to four triangles goes on best, as their numbers: the one with the fewest restarts, of those the first.
    pub fn best(&self, triangles: &[Triangle]) -> [usize; 4] {
        let restarts = |order: &[usize]| {
            let (mut tail, mut length, mut waiting, mut count) = (self.tail, self.length, self.waiting, 0);
            let follow = order.iter().map(|&k| Some(triangles[k])).chain([None]);
            for next in follow {
                if let Some(own) = std::mem::replace(&mut waiting, next) {
                    let (way, turn) = tail.way(length, &own, next.as_ref());
                    tail.push(turned(&own, turn), way);
                    (length, count) = (length + 1, count + usize::from(way == RESTART));
                }
            }
            count
        };
        let all = ORDERS.iter().filter(|order| order[triangles.len()..].iter().zip(triangles.len()..).all(|(&own, k)| own == k));
        all.copied().min_by_key(|order| restarts(&order[..triangles.len()])).unwrap_or([0, 1, 2, 3])
    }

    fn place(&mut self, triangle: &Triangle, next: Option<&Triangle>) {
        if self.length == MOST {
            self.is_over = true;
            return;
        }
        let (way, turn) = self.tail.way(self.length, triangle, next);
        let stored = turned(triangle, turn);
        for &vertex in if way == RESTART { &stored[..] } else { &stored[2..] } {
            // The first three are always new ones.
            let known = if self.length == 0 { None } else { self.vertices[..self.count].iter().position(|other| *other == vertex) };
            match known {
                Some(known) => {
                    self.reused[self.reuses] = known as u8; // below 64
                    self.reuses += 1;
                }
                None if self.count == MOST => {
                    self.is_over = true;
                    return;
                }
                None => {
                    self.is_new[self.indices / 64] |= 1 << (self.indices % 64);
                    self.vertices[self.count] = vertex;
                    self.count += 1;
                }
            }
            self.indices += 1;
        }
        (self.ways[self.length], self.turns[self.length]) = (way, turn);
        self.tail.push(stored, way);
        self.length += 1;
    }

    /// Whether nothing was pushed.
    pub fn is_empty(&self) -> bool {
        self.length == 0 && self.waiting.is_none()
    }

    /// Whether it fits a block.
    pub fn fits(&self) -> bool {
        self.ended().frame().is_some()
    }

    /// The block, whose first triangle has this number; none if it does not fit one.
    pub fn block(&self, first: u32) -> Option<Coded> {
        self.ended().write(first)
    }

    /// With nothing behind the last triangle.
    fn ended(&self) -> Self {
        let mut all = self.clone();
        if let Some(last) = all.waiting.take() {
            all.place(&last, None);
        }
        all
    }

    /// What its block's fields are like; none if it does not fit one.
    fn frame(&self) -> Option<Framed> {
        if self.is_over || self.length == 0 {
            return None;
        }
        let mut frame = Framed::of(&self.vertices[..self.count])?;
        while frame.widths.iter().sum::<u32>() % 4 != 0 {
            *frame.widths.iter_mut().min()? += 1; // three times 16 is a multiple
        }
        // At least 3 bits, at most 6: they number 64.
        frame.index = (usize::BITS - (self.count - 1).leading_zeros()).max(3) as usize;
        frame.vertices = (self.count * frame.widths.iter().sum::<u32>() as usize).next_multiple_of(8);
        let (reused, back) = (self.reuses * frame.index, self.indices - 3 + 2 * (self.length - 1));
        let fits = frame.vertices <= VERTICES && reused <= REUSED && HEADER + frame.vertices + reused + back <= BITS;
        fits.then_some(frame)
    }

    fn write(&self, first: u32) -> Option<Coded> {
        let Framed { zeros, anchor, widths, index, vertices: front } = self.frame().filter(|_| first >> NUMBER == 0)?;
        let vertices = &self.vertices[..self.count];
        let mut bits = Bits::default();
        let mut at = 0;
        let mut put = |value: u64, width: u32| {
            bits.put(at, value, width);
            at += width as usize;
        };
        let signed = |c: i32| u64::from(c as u32) & ((1 << ANCHOR) - 1);
        for (value, width) in [
            (MAGIC, 8),
            (index as u64 - 3, 2),
            (self.count as u64 - 1, 6),
            (self.length as u64 - 1, 6),
            (OPAQUE, 10),
            (u64::from(BIAS + zeros), 8),
            (signed(anchor[0]), ANCHOR),
            (u64::from(widths[0]) - 1, 4),
            (u64::from(widths[1]) - 1, 4),
            (signed(anchor[1]), ANCHOR),
            (u64::from(widths[2]) - 1, 4),
            (0, 4),
            (signed(anchor[2]), ANCHOR),
            (u64::from(first), 32),
        ] {
            put(value, width);
        }
        for vertex in vertices {
            (0..3).for_each(|k| put(((vertex[k] >> zeros) - anchor[k]) as u64, widths[k])); // not below the anchor
        }
        for (k, &own) in self.reused[..self.reuses].iter().enumerate() {
            bits.put(HEADER + front + k * index, u64::from(own), index as u32);
        }
        for (k, &way) in self.ways[1..self.length].iter().enumerate() {
            bits.put(BITS - 2 * (k + 1), u64::from(way), 2);
        }
        let ways = BITS - 2 * (self.length - 1);
        for k in 3..self.indices {
            bits.put(ways - (k - 2), self.is_new[k / 64] >> (k % 64) & 1, 1);
        }
        Some(Coded { block: bits.0, turns: self.turns, vertices: self.count })
    }
}

/// All orders of four, those of three and of two first in theirs.
const ORDERS: [[usize; 4]; 24] = {
    let (mut all, mut k) = ([[0; 4]; 24], 0);
    let mut code = 0;
    while code < 256 {
        let order = [code >> 6, code >> 4 & 3, code >> 2 & 3, code & 3];
        if 1 << order[0] | 1 << order[1] | 1 << order[2] | 1 << order[3] == 15 {
            all[k] = order;
            k += 1;
        }
        code += 1;
    }
    all
};

/// A block's grid, bits of an index, and of all vertices.
struct Framed {
    zeros: u32,
    anchor: [i32; 3],
    widths: [u32; 3],
    index: usize,
    vertices: usize,
}

impl Framed {
    /// The grid of some vertices; none if a block's numbers are too narrow for them.
    fn of(vertices: &[[i32; 3]]) -> Option<Self> {
        let any = vertices.as_flattened().iter().fold(0, |any, c| any | c);
        let zeros = if any == 0 { 0 } else { any.trailing_zeros() };
        let ends = |k: usize| vertices.iter().fold((i32::MAX, i32::MIN), |(lo, hi), v| (lo.min(v[k] >> zeros), hi.max(v[k] >> zeros)));
        let (mut anchor, mut widths) = ([0; 3], [0; 3]);
        for k in 0..3 {
            let (lo, hi) = ends(k);
            let half = 1 << (ANCHOR - 1);
            let extent = hi.checked_sub(lo)? as u32;
            if lo < -half || lo >= half || extent >> OFFSET != 0 {
                return None;
            }
            (anchor[k], widths[k]) = (lo, (u32::BITS - extent.leading_zeros()).max(1));
        }
        Some(Self { zeros, anchor, widths, index: 0, vertices: 0 })
    }
}

/// Whether a block's numbers are wide enough for some triangles.
pub fn in_range(triangles: &[Triangle]) -> bool {
    Framed::of(triangles.as_flattened()).is_some()
}

#[derive(Default)]
struct Bits(Block);

impl Bits {
    fn put(&mut self, at: usize, value: u64, width: u32) {
        let words = self.0.as_flattened_mut();
        let (word, shift) = (at / 64, (at % 64) as u32);
        words[word] |= value << shift;
        if shift + width > 64 {
            words[word + 1] |= value >> (64 - shift);
        }
    }
}

/// `width` bits, up to 32, from bit `at` on.
fn get(block: &Block, at: usize, width: usize) -> u32 {
    let words = block.as_flattened();
    let (word, shift) = (at / 64, at % 64);
    let low = words[word] >> shift;
    let high = if shift + width > 64 { words[word + 1] << (64 - shift) } else { 0 };
    ((low | high) & ((1 << width) - 1)) as u32
}

/// A block and what it leaves out.
pub struct Coded {
    /// The block.
    pub block: Block,
    /// From which corner on it has each triangle.
    pub turns: [u8; MOST],
    /// Its vertices.
    pub vertices: usize,
}

/// Gives the triangles of a block from the first to before `end`, in order, as it has them.
#[inline]
pub fn triangles(block: &Block, end: usize, mut give: impl FnMut(usize, Triangle)) {
    let field = |at: usize, width: usize| get(block, at, width);
    let (index, count, length) = (field(8, 2) as usize + 3, field(10, 6) as usize + 1, field(16, 6) as usize + 1);
    let zeros = field(32, 8) - BIAS;
    // The sign of 24 bits is where that of 32 is.
    let anchor = [40, 72, 104].map(|at| (field(at, 24) << 8) as i32 >> 8);
    let widths = [64, 68, 96].map(|at| field(at, 4) as usize + 1);
    let each: usize = widths.iter().sum();
    let vertex = |number: usize| -> [i32; 3] {
        let mut at = HEADER + number * each;
        std::array::from_fn(|k| {
            let offset = field(at, widths[k]) as i32;
            at += widths[k];
            (anchor[k] + offset) << zeros
        })
    };
    let reused = HEADER + (count * each).next_multiple_of(8);
    let ways = BITS - 2 * (length - 1);
    let (mut known, mut indices) = (0, 0);
    let mut next = || {
        let is_new = indices < 3 || field(ways - (indices - 2), 1) == 1;
        let own = if is_new { known } else { field(reused + (indices - known) * index, index) as usize };
        known += usize::from(is_new);
        indices += 1;
        own
    };
    let mut tail = [([0; 3], RESTART); 2];
    for k in 0..end {
        let way = if k == 0 { RESTART } else { field(BITS - 2 * k, 2) as u8 };
        let own = if way == RESTART {
            [next(), next(), next()]
        } else {
            let [a, b] = shared(way, &tail);
            [a, b, next()]
        };
        tail = [(own, way), tail[0]];
        give(k, own.map(vertex));
    }
}

/// Gives all triangles of a block, in order, as it has them.
pub fn all(block: &Block, mut give: impl FnMut(Triangle)) {
    triangles(block, len(block), |_, triangle| give(triangle));
}

/// Number of its triangles.
#[inline]
pub fn len(block: &Block) -> usize {
    get(block, 16, 6) as usize + 1
}

/// Which of `len` triangles of a block has a name; none if none has.
#[inline]
pub fn named(place: usize, len: usize) -> Option<usize> {
    if place < MOST { Some(place) } else { (place + len).checked_sub(PLACES) }.filter(|&own| own < len)
}

/// The number of its first triangle.
#[inline]
pub fn first(block: &Block) -> u32 {
    get(block, 128, NUMBER as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn holds(own: &[Triangle]) -> Option<usize> {
        let coded = Strip::of(own.iter().copied()).block(77)?;
        assert_eq!((len(&coded.block), first(&coded.block)), (own.len(), 77));
        let mut read = Vec::new();
        triangles(&coded.block, own.len(), |k, t| {
            assert_eq!(k, read.len());
            read.push(t);
        });
        for (k, (own, read)) in own.iter().zip(&read).enumerate() {
            assert_eq!(turned(own, coded.turns[k]), *read, "{k}");
        }
        Some(coded.vertices)
    }

    fn grid(x: i32, y: i32) -> [i32; 3] {
        [256 * (1000 + x), 256 * (y - 3), 256 * (x * y % 7)]
    }

    /// The strip that the specification shows, with each of its four ways on.
    #[test]
    fn the_strip_of_the_specification() {
        let v: Vec<[i32; 3]> = (0..8).map(|k| [k, k * k, 7 * k % 5].map(|c| 256 * c)).collect();
        let of = |t: [usize; 3]| t.map(|k| v[k]);
        for (last, way) in [([5, 6, 7], RESTART), ([4, 1, 5], EDGE1), ([3, 4, 5], EDGE2), ([2, 3, 5], BACKTRACK)] {
            let strip = Strip::of([[0, 1, 2], [2, 1, 3], [3, 1, 4], last].map(of));
            let coded = strip.block(0).unwrap();
            // Of four triangles three have ways, the first of them at the very end.
            let ways = [1, 2, 3].map(|k| get(&coded.block, BITS - 2 * k, 2) as u8);
            assert_eq!(ways, [EDGE1, EDGE1, way]);
            // Five vertices and those of the last, all new; header as the specification has it.
            let count = if way == RESTART { 8 } else { 6 };
            assert_eq!((coded.vertices, get(&coded.block, 0, 8), get(&coded.block, 10, 6)), (count, 6, count as u32 - 1));
            holds(&[[0, 1, 2], [2, 1, 3], [3, 1, 4], last].map(of)).unwrap();
        }
    }

    #[test]
    fn a_patch_fills_a_block() {
        // Rows of a height field: two triangles for each vertex, nearly.
        let square = |x: i32, y: i32| {
            let [a, b, c, d] = [grid(x, y), grid(x + 1, y), grid(x, y + 1), grid(x + 1, y + 1)];
            [[a, b, c], [c, b, d]]
        };
        // 44 vertices of 12 bits; a restart for each row but the first, so 22 vertices met again, of 6 bits; 181 bits behind: 1,001 with the header.
        let rows = |length: i32| (0..3).flat_map(move |y| (0..length).flat_map(move |x| square(x, y))).collect::<Vec<Triangle>>();
        assert_eq!((rows(10).len(), holds(&rows(10))), (60, Some(44)));
        assert_eq!(holds(&rows(11)), None);
    }

    #[test]
    fn what_is_too_wide_fits_none() {
        let at = |c: i32| [[c, 0, 0], [0, 0, 0], [0, 256, 0]];
        for (c, fits) in [(255 << 8, true), (65_535 << 8, true), (65_536 << 8, false), (65_535, true), (65_537, false)] {
            // In the last two 256 has zeros that the others do not.
            assert_eq!(in_range(&[at(c)]), fits, "{c}");
            assert_eq!(Strip::of([at(c)]).fits(), fits);
        }
        let far = |c: i32| [[c; 3], [c + 256; 3], [c, c, c + 256]];
        assert!(in_range(&[far(-0x8000_0000)]) && in_range(&[far(0x7fff_0000)]));
        assert!(!in_range(&[far(0x0800_0001)]));
        // One place thrice is a triangle too, also as the first.
        assert_eq!(holds(&[[[0; 3]; 3], [[0; 3]; 3]]), Some(3));
    }

    #[test]
    fn the_best_order_restarts_least() {
        let [a, b, c, d, e, f] = [grid(0, 0), grid(1, 0), grid(0, 1), grid(1, 1), grid(2, 0), grid(2, 1)];
        let strip = [[a, b, c], [c, b, d], [d, b, e], [d, e, f]];
        for order in ORDERS {
            let own = order.map(|k| strip[k]);
            let best = Strip::default().best(&own).map(|k| own[k]);
            let ways = |all: [Triangle; 4]| {
                Strip::of(all).block(0).map(|coded| (1..4).filter(|k| get(&coded.block, BITS - 2 * k, 2) == 0).count())
            };
            assert_eq!(ways(best), Some(0), "{order:?}");
        }
        assert_eq!(Strip::default().best(&strip[..2]), [0, 1, 2, 3]);
    }

    #[test]
    fn triangles_have_two_names() {
        for (place, len, own) in
            [(0, 1, Some(0)), (127, 1, Some(0)), (1, 1, None), (126, 1, None), (63, 64, Some(63)), (64, 64, Some(0)), (118, 10, Some(0))]
        {
            assert_eq!(named(place, len), own, "{place} of {len}");
        }
    }

    proptest! {
        #[test]
        fn what_was_written_is_read(
            raw in prop::collection::vec(prop::array::uniform3(prop::array::uniform3(any::<i32>())), 1..=66),
            bits in 8u32..32, zeros in 0u32..12, pool in 1usize..40,
        ) {
            let vertices: Vec<[i32; 3]> = raw.iter().flatten().map(|v| v.map(|c| (c >> bits) >> zeros << zeros)).collect();
            let all: Vec<Triangle> = raw.iter().map(|t| t.map(|v| vertices[v[0] as u32 as usize % vertices.len().min(pool)])).collect();
            // As many as fit.
            let most = (1..=all.len()).rev().find(|&count| holds(&all[..count]).is_some());
            prop_assert!(most.is_some() || !in_range(&all[..1]));
        }
    }
}
