//! Trees: reading the stored nodes into lattices, and the checks that need one tree only.
//!
//! An inserted vertex stands for the edge that it splits: the edge's code and its true displacement are kept at the vertex's place.

use super::boxes::{Span, excess};
use super::tally::{CheckKind, Tallies};
use crate::format::{Displacements, L0Record, Scene, ShortLine, SplitRecord, VertexData};
use crate::mesh::{BoundKind, lattice};
use crate::num::{COORD_LIMIT, LARGEST_BOUND, VertexForm, Wire, sqrt_ceil};
use rayon::prelude::*;

/// Code of a lattice point at which no edge has been seen.
const UNSEEN: u16 = u16::MAX;

/// What was read, per lattice point, tree after tree.
pub(super) struct Lattices {
    /// Position in units.
    pub points: Vec<[i32; 3]>,
    /// Code of the edge that the point splits.
    pub codes: Vec<u16>,
    /// Displacement in squares of 8 units, the point's own.
    pub displacements: Vec<u64>,
}

/// The part of one tree.
pub(super) struct Lattice<'a> {
    points: &'a mut [[i32; 3]],
    codes: &'a mut [u16],
    displacements: &'a mut [u64],
}

impl Lattices {
    pub fn new(len: usize) -> Self {
        Self { points: vec![[0; 3]; len], codes: vec![UNSEEN; len], displacements: vec![0; len] }
    }

    /// The lattices of all trees, `len` points each.
    pub fn trees(&mut self, len: usize) -> impl IndexedParallelIterator<Item = Lattice<'_>> {
        self.points
            .par_chunks_mut(len)
            .zip(self.codes.par_chunks_mut(len))
            .zip(self.displacements.par_chunks_mut(len))
            .map(|((points, codes), displacements)| Lattice { points, codes, displacements })
    }

    /// Makes of each displacement the length in units, rounded up, that the edge's bound must cover, by those below it, finest level first, over all trees;
    /// `raise_shared` makes vertices inserted at a level that trees share equal to their largest.
    pub fn cover(&mut self, kind: BoundKind, levels: u32, raise_shared: impl Fn(u32, &mut [u64])) {
        self.displacements.par_iter_mut().for_each(|d| *d = sqrt_ceil(64 * u128::from(*d)));
        // Vertices of level `levels` stand for the finest edges with a bound: nothing is below them.
        for level in (1..=levels).rev() {
            if level < levels {
                self.displacements.par_chunks_mut(lattice::len(levels)).for_each(|d| {
                    each_inserted(levels, level, |at, meeting| {
                        let below = meeting.iter().map(|&finer| d[finer]).max().unwrap_or(0);
                        d[at] = match kind {
                            BoundKind::Largest => d[at].max(below),
                            BoundKind::Total => (d[at] + below).min(LARGEST_BOUND),
                        };
                    });
                });
            }
            raise_shared(level, &mut self.displacements);
        }
    }

    /// Codes against displacements, and against the codes of the edges that meet at the vertex; of each tree down to its level of `known`.
    pub fn check_codes(&self, levels: u32, known: &[u32], allowed: &[u64]) -> Tallies {
        let len = lattice::len(levels);
        let per_tree = self.codes.par_chunks(len).zip(self.displacements.par_chunks(len)).enumerate().map(|(t, (codes, truths))| {
            let mut found = Tallies::default();
            for level in 1..=known[t] {
                each_inserted(levels, level, |at, meeting| {
                    let code = codes[at];
                    let covers = allowed.get(usize::from(code)).is_some_and(|&most| truths[at] <= most);
                    found.check(CheckKind::Bounds, covers, || {
                        let truth = truths[at];
                        format!("tree {t}: edge of level {} split at lattice point {at} has code {code}, displacement {truth}", level - 1)
                    });
                    for &finer in meeting.iter().filter(|_| level < known[t]) {
                        found.check(CheckKind::Monotone, codes[finer] <= code, || {
                            format!(
                                "tree {t}: edge of level {} at lattice point {at} has code {code}, a finer one {}",
                                level - 1,
                                codes[finer]
                            )
                        });
                    }
                });
            }
            found
        });
        per_tree.reduce(Tallies::default, Tallies::join)
    }
}

/// Calls `f` for each vertex inserted at `level` (1 to N) with its index and those of the vertices that split the edges which meet at it (none
/// on the last level, whose edges have no bounds).
fn each_inserted(levels: u32, level: u32, mut f: impl FnMut(usize, &[usize])) {
    const AROUND: [(i32, i32); 6] = [(1, 0), (0, 1), (-1, 1), (-1, 0), (0, -1), (1, -1)];
    let (m, step) = (1i32 << levels, 1i32 << (levels - level));
    let half = step / 2;
    for j in (0..=m).step_by(step as usize) {
        for i in (0..=m - j).step_by(step as usize) {
            if (i | j) & step == 0 {
                continue; // of a coarser level
            }
            let mut meeting = [0; 6];
            let mut count = 0;
            for (di, dj) in AROUND {
                let (x, y) = (i + half * di, j + half * dj);
                if half > 0 && x >= 0 && y >= 0 && x + y <= m {
                    meeting[count] = lattice::index(levels, (x as u32, y as u32)); // not negative
                    count += 1;
                }
            }
            f(lattice::index(levels, (i as u32, j as u32)), &meeting[..count]);
        }
    }
}

/// Reads a tree by recursion over its nodes, down to level `known`, and checks what can be checked on the way.
pub(super) fn read(scene: &Scene, begins: &Begins, tree: usize, known: u32, lattice: Lattice<'_>) -> Tallies {
    let levels = scene.levels();
    let form = scene.meta().vertices;
    // Exact vertices have a second line with the corners.
    let lines = if form.is_compact() { 1 } else { 2 };
    let record = L0Record::from_words(&scene.records()[lines * tree]);
    let depth = record.depth.get() as u32; // 4 bits
    let mut reader = Reader {
        tree,
        levels,
        depth,
        known,
        form,
        offset: u64::from(scene.meta().bound_offset),
        lines: scene.vertices(),
        splits: scene.splits(),
        place: record.place.get() as usize, // 28 bits
        begins,
        lattice,
        found: Tallies::default(),
    };
    let [a, b, c] = scene.triangles()[tree];
    reader.found.check(CheckKind::BaseTriangles, a != b && b != c && c != a, || format!("tree {tree}: vertices {a}, {b}, {c}"));

    let codes = [record.e0, record.e1, record.e2].map(|c| c.get() as u8); // 8 bits
    let own = [record.p0, record.p1, record.p2].map(|p| p.get());
    let fine = record.reserved.get() == 0 && (depth > 0 || codes == [0; 3]) && (form.is_compact() || own == [[0; 3]; 3]);
    reader.found.check(CheckKind::Reserved, fine, || format!("tree {tree}: L0 record"));
    let points = if form.is_compact() {
        own.map(|p| p.map(|c| (c * 1024) as i32)) // 22 bits
    } else {
        let corners = VertexData::from_words(&scene.records()[lines * tree + 1]);
        reader.found.check(CheckKind::Reserved, corners.reserved.get() == 0, || format!("tree {tree}: corners of the L0 record"));
        corners.points().map(|p| p.get().map(|c| c as i32)) // 32 bits by their type
    };
    let places = [(0, 0), (1 << levels, 0), (0, 1 << levels)];
    // Vertices that nobody knows are somewhere in the tree.
    reader.lattice.points.fill(points[0]);
    for (point, place) in points.into_iter().zip(places) {
        reader.coordinates(0, point, || format!("tree {tree}: corner at {place:?}"));
        reader.lattice.points[lattice::index(levels, place)] = point;
    }
    let span = reader.node(0, 0, places, points, codes);
    reader.found.span = span;
    reader.found
}

/// What is stored of a tree.
pub(super) struct Stored {
    /// Groups of four nodes.
    pub groups: u64,
    /// Splits: of those that split into nodes, and of the root.
    pub splits: u64,
    /// Records of vertices outside of splits.
    pub vertices: u64,
}

impl Stored {
    /// Of one of this depth.
    pub fn of(form: VertexForm, depth: u32) -> Self {
        let inner = first(depth) as u64;
        let groups = if depth < 2 { 0 } else { (inner - 1) / 4 };
        let splits = groups.max(inner.min(1));
        Self { groups, splits, vertices: if form == VertexForm::Exact { inner } else { inner - splits } }
    }
}

/// Where levels begin, counted anew from the records.
pub(super) struct Begins {
    /// Splits on the levels above, of all trees, for each level.
    splits: Vec<usize>,
    /// Nodes that split on the levels above, of all trees, for each level.
    nodes: Vec<usize>,
    /// Nodes of last levels but roots on the levels above, of all trees, for each level.
    last: Vec<usize>,
    /// Trees that split on a deeper level, for each level.
    deeper: Vec<usize>,
}

impl Begins {
    /// Of the trees of a scene.
    pub fn of(scene: &Scene) -> Self {
        let depths = scene.depths();
        let deeper = |level: u32| depths.iter().filter(|&&depth| depth > level).count();
        let above = |of: &dyn Fn(u32) -> usize| {
            (0..scene.levels()).map(|level| (0..level).map(|above| 4usize.pow(above) * of(above)).sum()).collect()
        };
        Self {
            splits: above(&|level| deeper(if level == 0 { 0 } else { level + 1 })),
            nodes: above(&deeper),
            last: above(&|level| if level == 0 { 0 } else { deeper(level) - deeper(level + 1) }),
            deeper: (0..scene.levels()).map(|level| deeper(level + 1)).collect(),
        }
    }
}

struct Reader<'a> {
    tree: usize,
    levels: u32,
    /// Levels that are stored: below them every vertex is the middle of its edge, and every code 0.
    depth: u32,
    /// The level down to which anything is known: N, or in a scene that was pruned for a job as many as are stored.
    known: u32,
    form: VertexForm,
    /// Added to every code but 0.
    offset: u64,
    /// Of all trees.
    lines: &'a [[u64; 4]],
    /// Of all trees.
    splits: &'a [[u64; 4]],
    /// The tree's among those of each level.
    place: usize,
    begins: &'a Begins,
    lattice: Lattice<'a>,
    found: Tallies,
}

type Place = (u32, u32);

impl Reader<'_> {
    /// A node's split, if it has one.
    fn split(&self, level: u32, node: usize) -> Option<SplitRecord> {
        let has = self.depth > if level == 0 { 0 } else { level + 1 };
        let number = self.begins.splits[level as usize] + 4usize.pow(level) * self.place + node;
        has.then(|| SplitRecord::from_words(&self.splits[number]))
    }

    /// Checks a node and all below it; gives the box of its full-resolution vertices. `places` and `p` are its corners.
    fn node(&mut self, level: u32, node: usize, places: [Place; 3], p: [[i32; 3]; 3], codes: [u8; 3]) -> Span {
        let mut span = Span::around(p);
        if level == self.known {
            return span;
        }
        let split = self.split(level, node);
        let (q_places, q) = self.inserted(level, node, places, p, codes, split.as_ref());
        if level + 1 == self.known {
            return span.with(&Span::around(q));
        }
        let corners = [[(0, 0), (1, 2), (1, 1)], [(1, 2), (0, 1), (1, 0)], [(1, 1), (1, 0), (0, 2)], [(1, 0), (1, 1), (1, 2)]];
        let places_of = |k: usize| corners[k].map(|(new, i): (u8, usize)| if new == 1 { q_places[i] } else { places[i] });
        let triangle_of = |k: usize| corners[k].map(|(new, i)| if new == 1 { q[i] } else { p[i] });
        if level + 1 >= self.depth {
            return (0..4).fold(span, |span, k| span.with(&self.node(level + 1, 4 * node + k, places_of(k), triangle_of(k), [0; 3])));
        }
        let (tree, group) = (self.tree, split.unwrap_or_default());
        for k in 0..4 {
            let child = triangle_of(k);
            // The centre child has one edge of each sibling: e0 of child 0, e1 of child 1, e2 of child 2.
            let codes = [0, 1, 2].map(|i| group.codes[if k < 3 { 3 * k + i } else { 3 * i + i }].get() as u8); // 8 bits
            let below = self.node(level + 1, 4 * node + k, places_of(k), child, codes);
            let (lo, hi) = excess(&group, k, child);
            self.found.check(CheckKind::Boxes, below.is_within(lo, hi), || {
                let (number, level) = (4 * node + k, level + 1);
                format!("tree {tree}: node {number} of level {level} spans {below:?}, its box {lo:?} to {hi:?} (times 2^16)")
            });
            span = span.with(&below);
        }
        span
    }

    /// The inserted vertices of a node as they are stored.
    #[inline]
    fn stored(&mut self, level: u32, node: usize, p: [[i32; 3]; 3], codes: [u8; 3], split: Option<&SplitRecord>) -> [[i32; 3]; 3] {
        let tree = self.tree;
        if level >= self.depth {
            let middle = |a: usize, b: usize| std::array::from_fn(|c| (i64::from(p[a][c]) + i64::from(p[b][c])).div_euclid(2) as i32); // between them
            return [middle(1, 2), middle(2, 0), middle(0, 1)];
        }
        if let Some(split) = split {
            // A root that splits into triangles alone has its vertices there and nothing of children; exact vertices are elsewhere.
            let childless = SplitRecord { v0: split.v0, v1: split.v1, v2: split.v2, ..SplitRecord::default() };
            let own = [split.v0, split.v1, split.v2].map(|v| v.get());
            let fine =
                split.reserved.get() == 0 && (self.depth > 1 || *split == childless) && (self.form.is_compact() || own == [[0; 3]; 3]);
            self.found.check(CheckKind::Reserved, fine, || format!("tree {tree}: split of node {node} of level {level}"));
        }
        let name = || format!("tree {tree}: vertices of node {node} of level {level}");
        let (before, place) = (4usize.pow(level) * self.place + node, level as usize);
        if self.form == VertexForm::Exact {
            let line = VertexData::from_words(&self.lines[self.begins.nodes[place] + before]);
            self.found.check(CheckKind::Reserved, line.reserved.get() == 0, name);
            return line.points().map(|v| v.get().map(|c| c as i32)); // 32 bits by their type
        }
        let d = match split {
            Some(split) => [split.v0, split.v1, split.v2].map(|v| v.get()),
            None if self.form == VertexForm::Short => {
                // Four nodes share a line, from its low bits on, with a 64th of what steps have.
                let four = self.begins.last[place] + before - 4usize.pow(level) * self.begins.deeper[place];
                let line = ShortLine::from_words(&self.lines[four / 4]);
                self.found.check(CheckKind::Reserved, line.reserved.get() == 0, name);
                let own = line.siblings[four % 4];
                [own.v0, own.v1, own.v2].map(|v| v.get().map(|c| 64 * c))
            }
            None => {
                // Two nodes share a line, the first of them in its low half; the trees that have these levels begin behind the deeper ones.
                let half = self.begins.last[place] + before - 4usize.pow(level) * self.begins.deeper[place];
                let half = Displacements::from_words(&self.lines[half / 2][2 * (half % 2)..]);
                self.found.check(CheckKind::Reserved, half.reserved.get() == 0, name);
                [half.v0, half.v1, half.v2].map(|v| v.get())
            }
        };
        let zero = self.levels - level + 3;
        std::array::from_fn(|k| {
            let (a, b) = (p[(k + 1) % 3], p[(k + 2) % 3]);
            let octave = (u64::from(codes[k]) + self.offset) / 16;
            let unit = 2i64.pow(zero.max(octave.saturating_sub(11) as u32)); // below 48
            let d = d[k];
            std::array::from_fn(|c| {
                let v = (i64::from(a[c]) + i64::from(b[c])).div_euclid(2) + d[c] * unit;
                v.clamp(i32::MIN.into(), i32::MAX.into()) as i32 // beyond the limit if it had to be clamped
            })
        })
    }

    /// Checks the inserted vertices and codes of a node and gives the vertices.
    #[inline]
    fn inserted(
        &mut self,
        level: u32,
        node: usize,
        places: [Place; 3],
        p: [[i32; 3]; 3],
        codes: [u8; 3],
        split: Option<&SplitRecord>,
    ) -> ([Place; 3], [[i32; 3]; 3]) {
        let (tree, levels) = (self.tree, self.levels);
        let q = self.stored(level, node, p, codes, split);
        // The centre child's codes are its siblings': there is nothing to compare.
        let own_codes = level == 0 || node % 4 < 3;
        let mut q_places = places;
        for k in 0..3 {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            let place = (u32::midpoint(places[a].0, places[b].0), u32::midpoint(places[a].1, places[b].1));
            q_places[k] = place;
            let at = lattice::index(levels, place);
            let name = || format!("tree {tree}: q{k} of node {node} of level {level} (lattice point {at})");
            self.coordinates(level + 1, q[k], name);
            if self.lattice.codes[at] == UNSEEN {
                self.lattice.codes[at] = codes[k].into();
                self.lattice.points[at] = q[k];
                // 2q - a - b: stored coordinates are multiples of 16, so eighths of units of the displacement have 30 bits.
                let twice = |c: usize| (2 * i64::from(q[k][c]) - i64::from(p[a][c]) - i64::from(p[b][c])) / 16;
                self.lattice.displacements[at] = (0..3).map(|c| twice(c).unsigned_abs().pow(2)).sum();
            } else {
                let (code, point) = (self.lattice.codes[at], self.lattice.points[at]);
                self.found
                    .check(CheckKind::VerticesInTree, point == q[k], || format!("{} is {:?}, its other side {point:?}", name(), q[k]));
                if own_codes {
                    let equal = code == u16::from(codes[k]);
                    self.found.check(CheckKind::CodesInTree, equal, || format!("{}: code {}, its other side {code}", name(), codes[k]));
                }
            }
        }
        (q_places, q)
    }

    /// Limit and grid of a vertex of level `level`.
    #[inline]
    fn coordinates(&mut self, level: u32, v: [i32; 3], name: impl Fn() -> String) {
        let within = v.iter().all(|c| (-COORD_LIMIT..=COORD_LIMIT).contains(c));
        self.found.check(CheckKind::Limit, within, || format!("{} is {v:?}", name()));
        // Exact ones end in the four zero bits that are not stored, whatever their grid; compact ones have them besides it.
        let bits = self.levels - level + if self.form.is_compact() { 4 } else { 0 };
        let low = (1i32 << bits) - 1;
        self.found.check(CheckKind::LowBits, v.iter().all(|c| c & low == 0), || format!("{} is {v:?}", name()));
    }
}

/// Number of nodes on the levels above `level`.
fn first(level: u32) -> usize {
    (0..level).map(|n| 1 << (2 * n)).sum()
}
