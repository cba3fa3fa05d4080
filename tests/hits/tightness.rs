//! No ray visits a box in vain: which nodes, lines and triangles a traversal reads are those that boxes of their definition ask for, met in exact fractions.
//!
//! Equal hits do not show it: looser boxes, a looser box test or a worse order give the same hits for more lines. So the loop of the paper's figure 9
//! is written here once more, as a plain recursion with boxes taken from the model's points (not from what the scene stores), in the steps that docs/numbers.md says,
//! widened and tested in exact arithmetic. Without a closest hit to drop what is behind it, every count is the same; with one, the blocks' rounded entry distances drop a
//! little later, by a share that is bounded. States of edges, morphed vertices and triangles come from the blocks: other tests compare those.

use lodray::block::Block;
use lodray::block::lod_test::{self, LodTest};
use lodray::block::start_test::Below;
use lodray::block::tessellate::{self, Tessellate, child_triangle};
use lodray::block::tri_test::{self, TriTest};
use lodray::bvh::BvhChild32;
use lodray::format::{
    BvhChild, BvhNode, ChildRef, Displacements, L0Record, Line, ShortLine, SixNode, SplitRecord, TreeLines, VertexData, has_split,
};
use lodray::mesh::{Hierarchy, lattice};
use lodray::method::bvh::{self, BvhTraverser, FullBvh, FullNodes, FullOptions, LeafLayout, NodeBoxes};
use lodray::method::lod::{self, LodImage, LodTraverser};
use lodray::method::{ClosestHit, Crossings, HitSink, TriangleId};
use lodray::num::{BoundCode, LINE_BYTES, Point, Ray, U, VertexForm, Wire};
use lodray::step::{SectionId, StepCounts};
use lodray_test_support::models::{any_rays, ball, scene_of, terrain, with_vertices};
use lodray_test_support::slabs::{Fraction, slabs};

/// Units of a box code.
const STEP: i64 = 1 << 16;
/// No wall lies farther out, in codes.
const FARTHEST: i64 = 32_767;
/// Steps of t in a whole one.
const ONE_T: i128 = 1 << 32;

/// A closed box in units.
#[derive(Clone, Copy)]
struct Bounds {
    lo: [i64; 3],
    hi: [i64; 3],
}

impl Bounds {
    const EMPTY: Self = Self { lo: [i64::MAX; 3], hi: [i64::MIN; 3] };

    fn around(points: impl IntoIterator<Item = [i64; 3]>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| b.with(Self { lo: p, hi: p }))
    }

    fn with(self, other: Self) -> Self {
        Self { lo: std::array::from_fn(|k| self.lo[k].min(other.lo[k])), hi: std::array::from_fn(|k| self.hi[k].max(other.hi[k])) }
    }

    /// The smallest box with walls at whole codes around this one.
    fn at_codes(self) -> Self {
        Self { lo: self.lo.map(|v| v.div_euclid(STEP) * STEP), hi: self.hi.map(|v| -(-v).div_euclid(STEP) * STEP) }
    }

    /// Its walls in codes, of a box that has them at whole ones.
    fn codes(self) -> ([i64; 3], [i64; 3]) {
        (self.lo.map(|v| v / STEP), self.hi.map(|v| v / STEP))
    }

    fn of_codes(lo: [i64; 3], hi: [i64; 3]) -> Self {
        let within = |c: i64| c.clamp(-FARTHEST, FARTHEST) * STEP;
        Self { lo: lo.map(within), hi: hi.map(within) }
    }
}

/// Codes that whole steps reach, 1, 1 1/2, 2, 3, 4, 6, ... codes long and rounded down: the shortest steps of which `most` reach `extent` codes.
fn reached(extent: i64, most: i64) -> Vec<i64> {
    let lengths = (0..16).flat_map(|exponent| [2i64 << exponent, 3 << exponent]);
    let length = lengths.into_iter().find(|length| most * length / 2 >= extent).expect("not that far");
    (0..=most).map(|steps| steps * length / 2).collect()
}

/// The least of these that is not below `codes`, and the most that is not above.
fn up(reached: &[i64], codes: i64) -> i64 {
    reached[reached.partition_point(|&r| r < codes)]
}
fn down(reached: &[i64], codes: i64) -> i64 {
    reached[reached.partition_point(|&r| r <= codes) - 1]
}

/// Boxes of four siblings, `own` those of their triangles and `all` those of what is below, as a split holds them: by how far they reach beyond their triangles, in three steps.
fn in_excess(own: &[Bounds], all: &[Bounds]) -> Vec<Bounds> {
    let corners = |b: &[Bounds]| b.iter().map(|b| b.at_codes().codes()).collect::<Vec<_>>();
    let (own, all) = (corners(own), corners(all));
    let excess = |k: usize, axis: usize| [own[k].0[axis] - all[k].0[axis], all[k].1[axis] - own[k].1[axis]];
    let steps: [Vec<i64>; 3] = std::array::from_fn(|axis| reached((0..4).flat_map(|k| excess(k, axis)).max().expect("four of them"), 3));
    let stored = |k: usize| {
        Bounds::of_codes(
            std::array::from_fn(|axis| own[k].0[axis] - up(&steps[axis], excess(k, axis)[0])),
            std::array::from_fn(|axis| own[k].1[axis] + up(&steps[axis], excess(k, axis)[1])),
        )
    };
    (0..4).map(stored).collect()
}

/// Boxes at whole codes as a node with a frame of its own holds them: from the corner of all of them on, in `most` steps.
fn in_frame<const W: usize>(boxes: [Option<Bounds>; W], most: i64) -> [Option<Bounds>; W] {
    let (origin, end) = around(boxes.iter().flatten()).codes();
    let steps: [Vec<i64>; 3] = std::array::from_fn(|axis| reached(end[axis] - origin[axis], most));
    boxes.map(|b| {
        let (lo, hi) = b?.codes();
        Some(Bounds::of_codes(
            std::array::from_fn(|axis| origin[axis] + down(&steps[axis], lo[axis] - origin[axis])),
            std::array::from_fn(|axis| origin[axis] + up(&steps[axis], hi[axis] - origin[axis])),
        ))
    })
}

/// A ray, and what it did.
struct Walk<'a, H> {
    ray: &'a Ray,
    sink: &'a mut H,
    counts: StepCounts,
}

impl<'a, H: HitSink> Walk<'a, H> {
    fn new(ray: &'a Ray, sink: &'a mut H) -> Self {
        Self { ray, sink, counts: StepCounts::default() }
    }

    fn is_beyond(&self, (n, m): Fraction) -> bool {
        n * ONE_T > i128::from(self.sink.t_max().get()) * m
    }

    /// Tests a group of boxes (`None`: no child), and visits those that are met, nearest first and equal ones by number.
    fn children<const W: usize>(&mut self, boxes: [Option<Bounds>; W], mut visit: impl FnMut(&mut Self, usize)) {
        self.counts.nodes += 1;
        let entry = |b: Bounds| slabs(self.ray.origin.get(), self.ray.direction.get(), b.lo, b.hi).filter(|&t| !self.is_beyond(t));
        let mut met: Vec<(usize, Fraction)> = (0..W).filter_map(|k| Some((k, entry(boxes[k]?)?))).collect();
        met.sort_by(|a, b| (a.1.0 * b.1.1).cmp(&(b.1.0 * a.1.1)));
        for (k, t) in met {
            if !self.is_beyond(t) {
                visit(self, k);
            }
        }
    }

    fn triangle(&mut self, id: TriangleId, corners: [Point; 3]) {
        let [p0, p1, p2] = corners;
        let test = TriTest::eval(&tri_test::In { origin: self.ray.origin, direction: self.ray.direction, p0, p1, p2 });
        self.counts.triangles += 1;
        if test.hit {
            self.sink.offer(id, &corners, &test, &Below::default());
        }
    }

    fn reads(&mut self, section: SectionId, lines: u64) {
        self.counts.lines[section.place()] += lines;
    }
}

fn around<'a>(boxes: impl IntoIterator<Item = &'a Bounds>) -> Bounds {
    boxes.into_iter().copied().fold(Bounds::EMPTY, Bounds::with)
}

/// The boxes of the children of BVH node `index` and of all below it, from those of its leaves; gives the box around what is below. `frame`: steps of a node's
/// own frame, if it has one.
fn fill<const W: usize>(
    boxes: &mut [[Option<Bounds>; W]],
    index: usize,
    frame: Option<i64>,
    child: &impl Fn(usize, usize) -> ChildRef,
    leaf: &impl Fn(ChildRef) -> Bounds,
) -> Bounds {
    let own: [Option<Bounds>; W] = std::array::from_fn(|k| {
        let to = child(index, k);
        match to.kind.get() {
            ChildRef::EMPTY => None,
            ChildRef::INNER => Some(fill(boxes, to.index.get() as usize, frame, child, leaf)),
            _ => Some(leaf(to)),
        }
    });
    boxes[index] = frame.map_or(own, |most| in_frame(own, most));
    around(own.iter().flatten())
}

/// The LOD method.
struct Lod<'a> {
    image: LodImage<'a>,
    /// By level but the first, then by node through all trees: the box of the finest triangles below, as its group holds it.
    trees: Vec<Vec<Bounds>>,
    /// Of each quad-BVH node's children.
    nodes: Vec<[Option<Bounds>; 4]>,
}

/// A node's corners, of full resolution and as morphed.
type Corners = [[Point; 3]; 2];

impl<'a> Lod<'a> {
    fn new(h: &Hierarchy, image: LodImage<'a>) -> Self {
        let own = |level: u32| -> Vec<Bounds> {
            let of_tree = |tree: usize| {
                let at = move |p| h.tree(tree)[lattice::index(h.levels, p)].map(i64::from);
                (0..1u32 << (2 * level)).map(move |node| Bounds::around(lattice::node(h.levels, level, node).map(at)))
            };
            (0..h.triangles.len()).flat_map(of_tree).collect()
        };
        let mut below = own(h.levels);
        let mut trees = Vec::new();
        for level in (1..=h.levels).rev() {
            let groups = own(level);
            trees.push(groups.chunks(4).zip(below.chunks(4)).flat_map(|(own, all)| in_excess(own, all)).collect());
            below = below.chunks(4).map(around).collect();
        }
        trees.push(Vec::new()); // roots are in no group
        trees.reverse();
        let mut nodes = vec![[None; 4]; image.nodes.len()];
        fill(&mut nodes, 0, Some(31), &|at, k| line_child(&image.nodes[at], k), &|to| below[to.index.get() as usize].at_codes());
        Self { image, trees, nodes }
    }

    fn node<H: HitSink>(&self, walk: &mut Walk<'_, H>, index: usize) {
        walk.reads(lod::NODES, 1);
        walk.children(self.nodes[index], |walk, k| {
            let to = line_child(&self.image.nodes[index], k);
            let at = to.index.get() as usize;
            if to.kind.get() == ChildRef::INNER { self.node(walk, at) } else { self.tree(walk, at) }
        });
    }

    fn tree<H: HitSink>(&self, walk: &mut Walk<'_, H>, tree: usize) {
        walk.reads(lod::RECORDS, self.image.form.record_lines() as u64);
        let p = self.image.corners(tree);
        let L0Record { e0, e1, e2, .. } = L0Record::from_words(self.image.record(tree));
        self.tree_node(walk, TriangleId { tree: tree as u32, level: 0, node: 0 }, [p, p], [e0, e1, e2]);
    }

    fn lines(&self, tree: usize) -> TreeLines {
        L0Record::line_tree(self.image.record(tree))
    }

    /// A node's inserted vertices as they are stored, and how many lines they have besides the split.
    fn stored(&self, TriangleId { tree, level, node }: TriangleId) -> ([Point; 3], u64) {
        let (image, lines) = (&self.image, self.lines(tree as usize));
        let line = || &image.vertices[image.starts.vertex_line(image.form, lines, level, node as usize)];
        match image.form {
            VertexForm::Exact => (VertexData::from_words(line()).points(), 1),
            VertexForm::Compact | VertexForm::Short if has_split(lines.depth, level) => {
                (SplitRecord::line_displacements(&image.splits[image.starts.split(lines, level, node as usize)]), 0)
            }
            VertexForm::Compact => (Displacements::line_half(line(), node as usize), 1),
            VertexForm::Short => (ShortLine::line_steps(line(), node as usize), 1),
        }
    }

    fn tree_node<H: HitSink>(&self, walk: &mut Walk<'_, H>, id: TriangleId, [f, p]: Corners, [e0, e1, e2]: [BoundCode; 3]) {
        let (levels, scale) = (self.image.levels, self.image.scale);
        let TriangleId { tree, level, node } = id;
        let lines = self.lines(tree as usize);
        if level == lines.depth {
            return walk.triangle(id, p);
        }
        let ([f0, f1, f2], [p0, p1, p2]) = (f, p);
        let lod = LodTest::eval(&lod_test::In { ray: *walk.ray, p0, p1, p2, e0, e1, e2, scale });
        walk.counts.lod_tests += 1;
        if !lod.refine {
            return walk.triangle(id, p);
        }
        let ([v0, v1, v2], read) = self.stored(id);
        walk.reads(lod::VERTICES, read);
        // A root's split is read even if there are triangles alone below it, where it has the vertices.
        walk.reads(lod::SPLITS, u64::from(level + 1 < lines.depth || read == 0));
        let (compact, grid) = (self.image.form.is_compact(), U::new(u64::from(levels - level - 1)));
        let padding = U::new(4);
        let lod_test::Out { s0, s1, s2, .. } = lod;
        let t =
            Tessellate::eval(&tessellate::In { compact, grid, padding, scale, e0, e1, e2, s0, s1, s2, f0, f1, f2, p0, p1, p2, v0, v1, v2 });
        let corners: [Corners; 4] =
            std::array::from_fn(|k| [child_triangle(f, [t.g0, t.g1, t.g2], k), child_triangle(p, [t.q0, t.q1, t.q2], k)]);
        let below = |k: usize| TriangleId { tree, level: level + 1, node: 4 * node + k as u32 };
        if level + 1 == lines.depth {
            return (0..4).for_each(|k| walk.triangle(below(k), corners[k][1]));
        }
        let first = ((tree as usize) << (2 * (level + 1))) + 4 * node as usize;
        let stored = &self.trees[level as usize + 1][first..first + 4];
        let boxes: [Option<Bounds>; 4] =
            std::array::from_fn(|k| Some(stored[k].with(Bounds::around(corners[k][1].map(|p| p.get())).at_codes())));
        let record = SplitRecord::from_words(&self.image.splits[self.image.starts.split(lines, level, node as usize)]);
        walk.children(boxes, |walk, k| self.tree_node(walk, below(k), corners[k], record.codes_of(k)));
    }
}

fn line_child(line: &Line, k: usize) -> ChildRef {
    BvhNode::from_words(line).child(k)
}

/// The baseline.
struct Full<'a> {
    bvh: &'a FullBvh,
    /// With none beyond the fourth where nodes have four.
    nodes: Vec<[Option<Bounds>; 6]>,
}

impl<'a> Full<'a> {
    fn new(bvh: &'a FullBvh) -> Self {
        let points = |slot| bvh.leaves.triangle(slot).0.map(|p: [i32; 3]| p.map(i64::from));
        let is_wide = matches!(*bvh.nodes, FullNodes::Boxes32(_));
        let frame = match *bvh.nodes {
            FullNodes::Local(_) => Some(31),
            FullNodes::Six(_) => Some(255),
            FullNodes::Boxes16(_) | FullNodes::Boxes32(_) => None,
        };
        let leaf = |to: ChildRef| {
            let bounds = Bounds::around(leaf_of(bvh, to).slots.flat_map(points));
            if is_wide { bounds } else { bounds.at_codes() }
        };
        let mut nodes = vec![[None; 6]; bvh.nodes.len()];
        fill(&mut nodes, 0, frame, &|at, k| full_child(bvh, at, k), &leaf);
        Self { bvh, nodes }
    }

    fn node<H: HitSink>(&self, walk: &mut Walk<'_, H>, index: usize) {
        let lines = match *self.bvh.nodes {
            FullNodes::Local(_) => 1,
            FullNodes::Boxes16(_) | FullNodes::Six(_) => 2,
            FullNodes::Boxes32(_) => 4,
        };
        walk.reads(bvh::NODES, lines);
        walk.children(self.nodes[index], |walk, k| {
            let to = full_child(self.bvh, index, k);
            if to.kind.get() == ChildRef::INNER {
                return self.node(walk, to.index.get() as usize);
            }
            let mut lines = 0;
            let leaf = leaf_of(self.bvh, to);
            self.bvh.leaves.lines(&leaf, |address| lines += u64::from(address.is_multiple_of(LINE_BYTES)));
            walk.reads(bvh::LEAVES, lines);
            for slot in leaf.slots {
                let (points, id) = self.bvh.leaves.triangle(slot);
                let (level, bits) = (self.bvh.levels, 2 * self.bvh.levels);
                walk.triangle(TriangleId { tree: id >> bits, level, node: id & ((1 << bits) - 1) }, points.map(Point::from_i32));
            }
        });
    }
}

fn full_child(bvh: &FullBvh, index: usize, k: usize) -> ChildRef {
    match &*bvh.nodes {
        FullNodes::Six(nodes) => SixNode::from_words(&nodes[index]).child(k),
        _ if k >= 4 => ChildRef::default(),
        FullNodes::Local(nodes) => line_child(&nodes[index], k),
        FullNodes::Boxes16(nodes) => BvhChild::from_words(&nodes[index][2 * k..2 * k + 2]).child,
        FullNodes::Boxes32(nodes) => BvhChild32::from_words(&nodes[index][4 * k..4 * k + 4]).child,
    }
}

/// The leaf of a reference.
fn leaf_of(bvh: &FullBvh, to: ChildRef) -> bvh::Leaf {
    bvh.leaves.leaf(to.index.get() as usize, to.count.get() as usize + 1)
}

/// Sums over rays: by the blocks, and by exact boxes.
#[derive(Default)]
struct Sums {
    rays: u64,
    blocks: StepCounts,
    exact: StepCounts,
}

impl Sums {
    fn add(&mut self, blocks: &StepCounts, exact: &StepCounts) {
        self.rays += 1;
        self.blocks.add(blocks);
        self.exact.add(exact);
    }

    /// With a closest hit: the blocks do hardly more than exact distances ask for, and hardly less (equal steps of distance may come in another order).
    fn are_near(&self, name: &str) {
        let all = |c: &StepCounts| [c.nodes, c.triangles, c.lines.iter().sum()];
        for (what, (blocks, exact)) in
            ["groups of boxes", "triangles", "lines"].iter().zip(all(&self.blocks).into_iter().zip(all(&self.exact)))
        {
            let ratio = blocks as f64 / exact as f64;
            println!("{name}: {} rays, {what}: {blocks} by blocks, {exact} exactly: {ratio:.5}", self.rays);
            assert!(exact > 4 * self.rays, "{name}: only {exact} {what}");
            assert!((0.999..1.04).contains(&ratio), "{name}, {what}: {ratio}");
        }
    }
}

/// Rays of both methods at a model: without a closest hit every count is the same for every ray.
fn compare(h: &Hierarchy, rays: &[Ray], lod: &mut Sums, full: &mut Sums) {
    let scene = scene_of(h);
    // Its trees have an order of their own.
    let h = &scene.decode();
    let exact = Lod::new(h, LodImage::of(&scene));
    let mut blocks = LodTraverser::new(LodImage::of(&scene));
    let variants = [
        (NodeBoxes::Local, LeafLayout::Line, 4),
        (NodeBoxes::Codes, LeafLayout::Packed, 2),
        (NodeBoxes::Wide, LeafLayout::Indexed, 1),
        (NodeBoxes::Local, LeafLayout::Block, 16),
        (NodeBoxes::Wide, LeafLayout::Block, 8),
        (NodeBoxes::Six, LeafLayout::Block, 16),
        (NodeBoxes::Six, LeafLayout::Line, 2),
    ];
    let bvhs = variants.map(|(boxes, layout, size)| FullBvh::build(h, &FullOptions::new(size, boxes, layout)).expect("a valid model"));
    for ray in rays {
        let (mut counts, mut sink) = (StepCounts::default(), Crossings::default());
        blocks.trace(ray, &mut counts, &mut sink);
        let mut crossings = Crossings::default();
        let mut walk = Walk::new(ray, &mut crossings);
        exact.node(&mut walk, 0);
        assert_eq!(counts, walk.counts, "LOD, {ray:?}");
        assert_eq!((sink.front, sink.back), (crossings.front, crossings.back));

        let (mut counts, mut sink) = (StepCounts::default(), ClosestHit::new(h.levels));
        blocks.trace(ray, &mut counts, &mut sink);
        let mut closest = ClosestHit::new(h.levels);
        let mut walk = Walk::new(ray, &mut closest);
        exact.node(&mut walk, 0);
        lod.add(&counts, &walk.counts);
        assert_eq!(sink.record(), closest.record());
    }
    for bvh in &bvhs {
        let exact = Full::new(bvh);
        let mut blocks = BvhTraverser::new(bvh);
        for ray in rays {
            let (mut counts, mut crossings) = (StepCounts::default(), Crossings::default());
            blocks.trace(ray, &mut counts, &mut Crossings::default());
            let mut walk = Walk::new(ray, &mut crossings);
            exact.node(&mut walk, 0);
            assert_eq!(counts, walk.counts, "BVH, {ray:?}");

            let (mut counts, mut closest) = (StepCounts::default(), ClosestHit::new(h.levels));
            blocks.trace(ray, &mut counts, &mut ClosestHit::new(h.levels));
            let mut walk = Walk::new(ray, &mut closest);
            exact.node(&mut walk, 0);
            full.add(&counts, &walk.counts);
        }
    }
}

#[test]
fn every_box_that_is_visited_is_met_and_no_other() {
    let (mut lod, mut full) = (Sums::default(), Sums::default());
    for seed in 0..10u64 {
        let levels = seed as u32 % 5;
        let roughness = [0.05, 0.4, 1.5][seed as usize % 3];
        let form = VertexForm::ALL[seed as usize % 3];
        for h in [ball(levels, roughness, seed), terrain(3, levels, roughness, seed)] {
            let h = with_vertices(form, h);
            compare(&h, &any_rays(&h, 400, seed), &mut lod, &mut full);
        }
    }
    lod.are_near("LOD");
    full.are_near("BVH");
}
