//! The traversal loop of the paper's figure 9: quad-BVH over base triangles, then tessellation trees with an LOD test at every node.

use super::image::{BOUNDS, LodImage, NODES, RECORDS, VERTEX_PLACE, VERTICES};
use crate::block::Block;
use crate::block::lod_test::{self, LodTest};
use crate::block::ray_setup::{self, RaySetup};
use crate::block::tessellate::{self, Tessellate, child_triangle};
use crate::block::tri_test::{self, TriTest};
use crate::format::{BoundData, BvhChild, L0Record, VertexData, layout};
use crate::method::children::{Split, bvh_children, quarter, tree_children};
use crate::method::stack::{Entry, Op, TraversalStack, push_sorted};
use crate::method::{HitSink, TriangleId, is_beyond};
use crate::num::{BoundCode, MAX_LEVELS, Point, Ray, TNear, U, Wire};
use crate::step::{Act, Fetch, Step, StepSink, TriangleRun};

/// Traces rays through one image; keeps its stack from ray to ray.
pub struct LodTraverser<'a> {
    image: LodImage<'a>,
    stack: TraversalStack,
    /// The split triangle of each level on the way to the current node.
    splits: [Split; MAX_LEVELS as usize],
}

/// One ray under way.
struct Journey<'a, S, H> {
    image: &'a LodImage<'a>,
    stack: &'a mut TraversalStack,
    splits: &'a mut [Split; MAX_LEVELS as usize],
    ray: &'a Ray,
    setup: ray_setup::Out,
    /// The current tree.
    tree: u32,
    steps: &'a mut S,
    sink: &'a mut H,
}

impl<'a> LodTraverser<'a> {
    /// A traverser of `image`, which must be consistent (a scene that was opened or built is).
    pub fn new(image: LodImage<'a>) -> Self {
        Self { image, stack: TraversalStack::default(), splits: Default::default() }
    }

    /// Number of splits N of the image.
    pub fn levels(&self) -> u32 {
        self.image.levels
    }

    /// Traces `ray`: every triangle that serves the ray and is met goes to `sink`, every step to `steps`.
    pub fn trace<S: StepSink, H: HitSink>(&mut self, ray: &Ray, steps: &mut S, sink: &mut H) {
        let setup = RaySetup::eval(&ray_setup::In { origin: ray.origin, direction: ray.direction });
        self.stack.clear();
        let Self { image, stack, splits } = self;
        let mut journey = Journey { image, stack, splits, ray, setup, tree: 0, steps, sink };
        let mut next = Some(Entry::default());
        loop {
            // A child just tested is not beyond the closest hit; an entry that waited may be by now.
            while let Some(entry) = next {
                next = journey.visit(&entry);
            }
            if journey.sink.is_done() {
                break;
            }
            let Some(entry) = journey.stack.step(Op::Pop) else { break };
            let dropped = is_beyond(entry.t_near, journey.sink.t_max());
            journey.steps.step(Step::of(Act::Pop { dropped }));
            next = (!dropped).then_some(entry);
        }
        // A hit on a coarse triangle is mapped to the full resolution.
        let found = journey.sink.found();
        journey.steps.step(Step::end(found, true));
    }
}

impl<S: StepSink, H: HitSink> Journey<'_, S, H> {
    #[inline(always)]
    fn visit(&mut self, entry: &Entry) -> Option<Entry> {
        match entry.kind.get() {
            Entry::BVH_NODE => self.bvh_node(entry.index.get() as usize),
            Entry::TREE => self.root(entry.index.get() as usize),
            _ => {
                let (level, node) = (entry.level.get() as u32, entry.index.get() as u32);
                let split = &self.splits[level as usize - 1];
                let p = child_triangle(split.p, split.q, node as usize & 3);
                self.tree_node(level, node, p, [entry.e0, entry.e1, entry.e2])
            }
        }
    }

    /// Tests the four children of a quad-BVH node.
    #[inline(always)]
    fn bvh_node(&mut self, index: usize) -> Option<Entry> {
        let group = &self.image.nodes[index];
        let tests = bvh_children(&self.setup, self.sink.t_max(), group);
        self.steps.step(Step::on(self.image.pair(NODES, index), Act::Children { met: tests.met() }).visiting());
        push_sorted(self.stack, &tests, |k| {
            let BvhChild { child, .. } = quarter(group, k);
            // Inner nodes and leaves have the kinds of their entries one lower.
            Entry { kind: U::new(child.kind.get() - 1), index: child.index, ..Entry::default() }
        })
    }

    /// Enters a tree.
    #[inline(always)]
    fn root(&mut self, tree: usize) -> Option<Entry> {
        self.steps.step(Step::on(self.image.pair(RECORDS, tree), Act::TreeBase).visiting());
        let record = &self.image.records[tree];
        self.tree = tree as u32; // an index of 28 bits
        let p = VertexData::from_words(&record[..4]).points();
        let root = L0Record::from_words(&record[4..]).root;
        self.tree_node(0, 0, p, [root.e0, root.e1, root.e2])
    }

    /// Decides whether the triangle `p` of node (`level`, `node`) serves the ray, and tests it or goes down.
    #[inline(always)]
    fn tree_node(&mut self, level: u32, node: u32, p: [Point; 3], [e0, e1, e2]: [BoundCode; 3]) -> Option<Entry> {
        let levels = self.image.levels;
        if level == levels {
            self.triangles(level, node, [p]);
            return None;
        }
        let lod = LodTest::eval(&lod_test::In { ray: *self.ray, p0: p[0], p1: p[1], p2: p[2], e0, e1, e2, scale: self.image.scale });
        // A tree's root was visited for its record.
        self.steps.step(Step { visits: level > 0, ..Step::of(Act::LodTest { refine: lod.refine }) });
        if !lod.refine {
            self.triangles(level, node, [p]);
            return None;
        }

        let line = layout::vertex_line(levels, self.tree as usize, level, node as usize);
        let fetch = Fetch::new(VERTICES, self.image.map.line(VERTICES, line as u64), 1).at(VERTEX_PLACE);
        self.steps.step(Step::on(fetch, Act::Tessellate));
        let [q0, q1, q2] = VertexData::from_words(&self.image.vertices[line]).points();
        let grid = U::new(u64::from(levels - level - 1));
        let t = Tessellate::eval(&tessellate::In { grid, s0: lod.s0, s1: lod.s1, s2: lod.s2, p0: p[0], p1: p[1], p2: p[2], q0, q1, q2 });
        let q = [t.q0, t.q1, t.q2];

        if level + 1 == levels {
            self.triangles(levels, 4 * node, std::array::from_fn::<_, 4, _>(|k| child_triangle(p, q, k)));
            return None;
        }
        let group = layout::child_group(levels, self.tree as usize, level, node as usize);
        self.splits[level as usize] = Split { p, q };
        self.tree_children(level + 1, 4 * node, group)
    }

    /// Tests the boxes of the four children, widened by their morphed triangles.
    #[inline(always)]
    fn tree_children(&mut self, level: u32, first: u32, group: usize) -> Option<Entry> {
        let fetch = self.image.pair(BOUNDS, group).joining();
        let split = &self.splits[level as usize - 1];
        let group = &self.image.bounds[group];
        let tests = tree_children(&self.setup, self.sink.t_max(), group, split);
        self.steps.step(Step::on(fetch, Act::Children { met: tests.met() }));
        push_sorted(self.stack, &tests, |k| {
            let BoundData { e0, e1, e2, .. } = quarter(group, k);
            Entry {
                t_near: TNear::ZERO,
                kind: U::new(Entry::TREE_NODE),
                level: U::new(u64::from(level)),
                index: U::new(u64::from(first) + k as u64),
                e0,
                e1,
                e2,
            }
        })
    }

    /// Tests triangles of one level, the first of them of node `first`.
    #[inline(always)]
    fn triangles<const COUNT: usize>(&mut self, level: u32, first: u32, triangles: [[Point; 3]; COUNT]) {
        let mut run = TriangleRun::default();
        for (node, corners) in (first..).zip(triangles) {
            let [p0, p1, p2] = corners;
            let test = TriTest::eval(&tri_test::In { origin: self.ray.origin, direction: self.ray.direction, p0, p1, p2 });
            run.add(test.hit, self.steps);
            if test.hit {
                self.sink.offer(TriangleId { tree: self.tree, level, node }, &corners, &test);
            }
        }
        run.state(self.steps);
    }
}
