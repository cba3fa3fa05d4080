//! Rays through the structure: the nearer child first, boxes and triangles exact.

use super::map::{LEAVES, NODES, VERTICES};
use super::tree::{Kind, LEAF, LEAF_LINES, NODE_LINES, TRIPLE_BYTES, Tree};
use crate::block::Block;
use crate::block::box_test32::{self, BoxTest32};
use crate::block::child_sort;
use crate::block::child_test::sort;
use crate::block::ray_setup::{self, RaySetup};
use crate::block::start_setup::{self, StartSetup};
use crate::block::start_test::{self, Below, StartTest};
use crate::block::tri_test::{self, TriTest};
use crate::method::bvh::cut_triangle;
use crate::method::{Departure, HitSink, is_beyond};
use crate::num::{LINE_BYTES, Point, Ray, Start, TNear, Vec3};
use crate::step::{Act, Fetch, MemoryMap, NodeShape, SectionId, Step, StepSink, TriangleRun};

/// A node that is to be visited.
#[derive(Clone, Copy, Default)]
struct Entry {
    /// Lower bound of the distance to its box.
    t_near: TNear,
    node: u32,
    /// The first leaf at or below it.
    leaf: u32,
}

/// Traces rays; keeps its stack from ray to ray.
pub struct Traverser<'a> {
    tree: &'a Tree,
    map: MemoryMap,
    stack: Vec<Entry>,
    /// Lines of vertices of a leaf.
    lines: Vec<u64>,
}

impl<'a> Traverser<'a> {
    /// A traverser of `tree`, whose lines lie as `map` says.
    pub fn new(tree: &'a Tree, map: MemoryMap) -> Self {
        Self { tree, map, stack: Vec::new(), lines: Vec::new() }
    }

    /// Traces `ray` from its beginning to its end: every triangle met goes to `sink`, every step to `steps`. With a `departure` its origin is the whole point of the start of that.
    pub fn trace<S: StepSink, H: HitSink>(&mut self, ray: &Ray, departure: Option<&Departure>, steps: &mut S, sink: &mut H) {
        self.descend(ray, departure, steps, sink);
        steps.step(Step::end(sink.found(), false));
    }

    /// The same without the ray's end: it may go on elsewhere.
    pub fn descend<S: StepSink, H: HitSink>(&mut self, ray: &Ray, departure: Option<&Departure>, steps: &mut S, sink: &mut H) {
        match departure {
            Some(from) => {
                debug_assert_eq!(from.start.point, ray.origin);
                let setup = StartSetup::eval(&start_setup::In { start: from.start, direction: ray.direction });
                self.run::<S, H, true>(ray, &from.start, &setup, steps, sink);
            }
            None => {
                let setup = RaySetup::eval(&ray_setup::In { origin: ray.origin, direction: ray.direction });
                self.run::<S, H, false>(ray, &Start::default(), &setup, steps, sink);
            }
        }
    }

    /// The same, compiled for rays that start at `start` if they are ones `LEAVING` a surface.
    fn run<S: StepSink, H: HitSink, const LEAVING: bool>(
        &mut self,
        ray: &Ray,
        start: &Start,
        setup: &ray_setup::Out,
        steps: &mut S,
        sink: &mut H,
    ) {
        self.stack.clear();
        // Nodes are read with their siblings, when their boxes are tested; the root has none.
        steps.step(Step::on(self.fetch(NODES, 0, NODE_LINES), Act::Fetch));
        let mut next = Some(Entry::default());
        while !sink.is_done() {
            // A child just tested is not beyond the closest hit; an entry that waited may be by now.
            let Some(entry) = next.take().or_else(|| self.pop(steps, sink)) else {
                if self.stack.is_empty() {
                    break;
                }
                continue;
            };
            match self.tree.nodes[entry.node as usize].kind() {
                Kind::Inner { nodes, leaves } => next = self.children::<S, H, LEAVING>(entry, [nodes, leaves], setup, steps, sink),
                Kind::Leaf(triangles) => self.leaf::<S, H, LEAVING>(ray, start, entry.leaf as usize, triangles, steps, sink),
            }
        }
    }

    /// Takes the next entry from the stack; `None` if there is none, or it lies behind the closest hit.
    fn pop<S: StepSink, H: HitSink>(&mut self, steps: &mut S, sink: &H) -> Option<Entry> {
        let entry = self.stack.pop()?;
        let dropped = is_beyond(entry.t_near, sink.t_max());
        steps.step(Step::of(Act::Pop { dropped }));
        (!dropped).then_some(entry)
    }

    /// Tests both children of an inner node, whose left subtree has so many nodes and leaves; gives the nearer one that is met, and lets the other wait.
    #[inline(always)]
    fn children<S: StepSink, H: HitSink, const LEAVING: bool>(
        &mut self,
        Entry { node, leaf, .. }: Entry,
        [nodes, leaves]: [u32; 2],
        setup: &ray_setup::Out,
        steps: &mut S,
        sink: &H,
    ) -> Option<Entry> {
        let left = node + 1;
        let children = [(left, leaf), (left + nodes, leaf + leaves)];
        let mut tests = child_sort::In::default();
        for (k, (child, _)) in children.into_iter().enumerate() {
            let bounds = &self.tree.nodes[child as usize].bounds;
            // What is ahead of a start is ahead of its whole point, if the box reaches as far down as the start's fraction can.
            let lo = bounds.lo.map(|c| i64::from(c) - i64::from(LEAVING));
            let input =
                box_test32::In { ray: *setup, t_max: sink.t_max(), lo: Vec3::new(lo[0], lo[1], lo[2]), hi: Point::from_i32(bounds.hi) };
            let test = BoxTest32::eval(&input);
            (tests.hit[k], tests.t_near[k]) = (test.hit, test.t_near);
        }
        let tests = sort(&tests);
        let act = Act::Children { shape: NodeShape::Pair, met: tests.met() };
        let line = |child: u32| NODE_LINES * u64::from(child);
        if nodes == 1 {
            steps.step(Step::on(self.fetch(NODES, line(left), 2 * NODE_LINES), act).visiting());
        } else {
            steps.step(Step::on(self.fetch(NODES, line(left), NODE_LINES), Act::Fetch).visiting());
            steps.step(Step::on(self.fetch(NODES, line(left + nodes), NODE_LINES).at(1).joining(), act));
        }
        let entry = |place: usize| {
            let k = tests.order[place].get() as usize;
            Entry { t_near: tests.t_near[k], node: children[k].0, leaf: children[k].1 }
        };
        match tests.met() {
            0 => None,
            1 => Some(entry(0)),
            _ => {
                self.stack.push(entry(1));
                Some(entry(0))
            }
        }
    }

    /// Reads the index triples of a leaf, then their vertices, and tests its triangles.
    #[inline(always)]
    fn leaf<S: StepSink, H: HitSink, const LEAVING: bool>(
        &mut self,
        ray: &Ray,
        start: &Start,
        leaf: usize,
        triangles: usize,
        steps: &mut S,
        sink: &mut H,
    ) {
        let tree = self.tree;
        let triples = &tree.triples[LEAF * leaf..][..triangles];
        let used = (TRIPLE_BYTES * triangles as u64).div_ceil(LINE_BYTES);
        steps.step(Step::on(self.fetch(LEAVES, LEAF_LINES * leaf as u64, used), Act::Fetch).visiting());
        self.vertex_lines(triples);
        for (k, &line) in (0..).zip(&self.lines) {
            // All at once, but not before the indices are there.
            let fetch = self.fetch(VERTICES, line, 1).at(LEAF_LINES as u32 + k);
            steps.step(Step::on(if k == 0 { fetch } else { fetch.joining() }, Act::Fetch));
        }
        let mut run = TriangleRun::default();
        for (triple, &id) in triples.iter().zip(&tree.ids[LEAF * leaf..]) {
            let corners = triple.map(|v| Point::from_i32(tree.vertices[v as usize]));
            let [p0, p1, p2] = corners;
            let start_test::Out { test, below } = if LEAVING {
                StartTest::eval(&start_test::In { start: *start, direction: ray.direction, p0, p1, p2 })
            } else {
                let input = tri_test::In { origin: ray.origin, direction: ray.direction, p0, p1, p2 };
                start_test::Out { test: TriTest::eval(&input), below: Below::default() }
            };
            run.add(test.hit, steps);
            if test.hit {
                sink.offer(cut_triangle(tree.levels, id), &corners, &test, &below);
            }
        }
        run.state(steps);
    }

    /// The lines of the vertices of some triangles, each once, in the order in which they are first needed.
    fn vertex_lines(&mut self, triples: &[[u32; 3]]) {
        self.lines.clear();
        for &v in triples.as_flattened() {
            let first = TRIPLE_BYTES * u64::from(v);
            // Twelve bytes lie in one or two lines.
            for line in [first / LINE_BYTES, (first + TRIPLE_BYTES - 1) / LINE_BYTES] {
                if !self.lines.contains(&line) {
                    self.lines.push(line);
                }
            }
        }
    }

    /// Lines of a section; at most seven.
    fn fetch(&self, section: SectionId, line: u64, lines: u64) -> Fetch {
        Fetch::new(section, self.map.line(section, line), lines as u32)
    }
}
