//! The traversal loop of the paper's figure 9: quad-BVH over base triangles, then tessellation trees with an LOD test at every node.

use super::image::{LodImage, TreeAt, With};
use crate::block::Block;
use crate::block::child_boxes::Corners;
use crate::block::lod_test::{self, LodTest};
use crate::block::node_deciders::{self, NodeDeciders};
use crate::block::ray_setup::{self, RaySetup};
use crate::block::start_setup::{self, StartSetup};
use crate::block::start_test::{self, Below, StartTest};
use crate::block::tessellate::child_triangle;
use crate::block::tri_test::{self, TriTest};
use crate::format::{BvhNode, L0Record, Line, SplitRecord};
#[cfg(target_arch = "x86_64")]
use crate::method::children::has_lanes;
use crate::method::children::{Split, bvh_children};
use crate::method::leave;
use crate::method::stack::{Entry, Op, TraversalStack, push_sorted};
use crate::method::{Deciders, Departure, Hit, HitSink, Prior, TriangleId, is_beyond};
use crate::num::{BoundCode, MAX_LEVELS, Point, Ray, Start, TNear, U, VertexForm, Wire};
use crate::step::{Act, NodeShape, Step, StepSink, TriangleRun};

/// Traces rays through one image; keeps its stack from ray to ray.
pub struct LodTraverser<'a> {
    image: LodImage<'a>,
    stack: TraversalStack,
    /// The triangles that the current node and its siblings on each level on the way to it are.
    splits: [Split; MAX_LEVELS as usize],
}

/// The entry of child `k` of a node with split `line`, but for its distance.
#[inline(always)]
pub(super) fn waiting(line: &Line, level: u32, node: u32, k: usize) -> Entry {
    let [e0, e1, e2] = SplitRecord::line_codes(line, k);
    Entry {
        t_near: TNear::ZERO,
        kind: U::new(Entry::TREE_NODE),
        level: U::new(u64::from(level + 1)),
        index: U::new(u64::from(4 * node) + k as u64),
        e0,
        e1,
        e2,
    }
}

/// One ray under way.
struct Journey<'a, S, H, const COMPACT: bool, const FULL_DETAIL: bool, const LEAVES: bool> {
    image: &'a LodImage<'a>,
    stack: &'a mut TraversalStack,
    splits: &'a mut [Split; MAX_LEVELS as usize],
    ray: &'a Ray,
    setup: ray_setup::Out,
    /// Of a ray that leaves a surface: its start, and who decides in the current tree.
    start: Start,
    prior: Option<&'a Prior>,
    deciders: Deciders,
    /// The current tree.
    tree: TreeAt,
    steps: &'a mut S,
    sink: &'a mut H,
}

impl<'a> LodTraverser<'a> {
    /// A traverser of `image`, which must be consistent (a scene that was opened or built is).
    pub fn new(image: LodImage<'a>) -> Self {
        Self { image, stack: TraversalStack::default(), splits: Default::default() }
    }

    /// What it traces through.
    pub(super) fn image(&self) -> &LodImage<'a> {
        &self.image
    }

    /// Number of splits N of the image.
    pub fn levels(&self) -> u32 {
        self.image.levels
    }

    /// Traces `ray` from its beginning to its end: every triangle that serves the ray and is met goes to `sink`, every step to `steps`.
    pub fn trace<S: StepSink, H: HitSink>(&mut self, ray: &Ray, steps: &mut S, sink: &mut H) {
        match self.image.form {
            VertexForm::Compact | VertexForm::Short => self.trace_as::<S, H, true, false, false>(ray, None, steps, sink),
            VertexForm::Exact => self.trace_as::<S, H, false, false, false>(ray, None, steps, sink),
        }
        // A hit on a coarse triangle is mapped to the full resolution.
        steps.step(Step::end(sink.found(), true));
    }

    /// Traces `ray` from the surface: its origin is the whole point of `departure.start`, and what it needs of the rays before it is there.
    pub fn trace_from<S: StepSink, H: HitSink>(&mut self, ray: &Ray, departure: &Departure, steps: &mut S, sink: &mut H) {
        match self.image.form {
            VertexForm::Compact | VertexForm::Short => self.trace_as::<S, H, true, false, true>(ray, Some(departure), steps, sink),
            VertexForm::Exact => self.trace_as::<S, H, false, false, true>(ray, Some(departure), steps, sink),
        }
        steps.step(Step::end(sink.found(), true));
    }

    /// Where rays start that leave the surface where `ray` hit it, and what they need of it and the rays before it; `from` is where `ray` started.
    pub fn departure(&self, ray: &Ray, from: Option<&Departure>, hit: &Hit, corners: &[Point; 3]) -> Departure {
        let tree = hit.tree.get() as u32; // 28 bits
        let base = self.image.corners(tree as usize);
        let (prior, crowded) = Prior::after(ray, from.and_then(|from| from.prior.as_ref()), tree, base);
        let start = leave::start(corners, [hit.b0, hit.b1, hit.b2]);
        Departure { start, corners: *corners, prior: Some(prior), crowded, clear: 0 }
    }

    /// The same without the ray's end, compiled for scenes of one form of vertices, for rays that tolerate nothing if they are of `FULL_DETAIL`, and for those that have a
    /// departure if they are ones that `LEAVES` a surface.
    #[inline(always)]
    pub(super) fn trace_as<S: StepSink, H: HitSink, const COMPACT: bool, const FULL_DETAIL: bool, const LEAVES: bool>(
        &mut self,
        ray: &Ray,
        departure: Option<&Departure>,
        steps: &mut S,
        sink: &mut H,
    ) {
        debug_assert_eq!(COMPACT, self.image.form.is_compact());
        #[cfg(target_arch = "x86_64")]
        if has_lanes() {
            #[target_feature(enable = "avx2,bmi1,bmi2")]
            fn lanes<S: StepSink, H: HitSink, const COMPACT: bool, const FULL_DETAIL: bool, const LEAVES: bool>(
                by: &mut LodTraverser<'_>,
                ray: &Ray,
                departure: Option<&Departure>,
                steps: &mut S,
                sink: &mut H,
            ) {
                by.run::<S, H, COMPACT, FULL_DETAIL, LEAVES>(ray, departure, steps, sink);
            }
            // SAFETY: the processor has them, as was just asked.
            return unsafe { lanes::<S, H, COMPACT, FULL_DETAIL, LEAVES>(self, ray, departure, steps, sink) };
        }
        #[cfg(target_arch = "x86_64")]
        self.without_lanes::<COMPACT, FULL_DETAIL, LEAVES>(ray, departure, steps, sink);
        #[cfg(not(target_arch = "x86_64"))]
        self.run::<S, H, COMPACT, FULL_DETAIL, LEAVES>(ray, departure, steps, sink);
    }

    /// By a processor without lanes, which few have: compiled once for all sinks, as each copy of the loop takes the compiler long.
    #[cfg(target_arch = "x86_64")]
    #[inline(never)]
    fn without_lanes<const COMPACT: bool, const FULL_DETAIL: bool, const LEAVES: bool>(
        &mut self,
        ray: &Ray,
        departure: Option<&Departure>,
        mut steps: &mut dyn StepSink,
        mut sink: &mut dyn HitSink,
    ) {
        self.run::<_, _, COMPACT, FULL_DETAIL, LEAVES>(ray, departure, &mut steps, &mut sink);
    }

    #[inline(always)]
    fn run<S: StepSink, H: HitSink, const COMPACT: bool, const FULL_DETAIL: bool, const LEAVES: bool>(
        &mut self,
        ray: &Ray,
        departure: Option<&Departure>,
        steps: &mut S,
        sink: &mut H,
    ) {
        debug_assert_eq!(LEAVES, departure.is_some());
        let (start, prior, setup) = match departure {
            Some(from) if LEAVES => {
                debug_assert_eq!(from.start.point, ray.origin);
                let setup = StartSetup::eval(&start_setup::In { start: from.start, direction: ray.direction });
                (from.start, from.prior.as_ref(), setup)
            }
            _ => (Start::default(), None, RaySetup::eval(&ray_setup::In { origin: ray.origin, direction: ray.direction })),
        };
        self.stack.clear();
        let Self { image, stack, splits } = self;
        let (tree, deciders) = (TreeAt::default(), Deciders::default());
        let mut journey =
            Journey::<S, H, COMPACT, FULL_DETAIL, LEAVES> { image, stack, splits, ray, setup, start, prior, deciders, tree, steps, sink };
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
    }
}

impl<S: StepSink, H: HitSink, const COMPACT: bool, const FULL_DETAIL: bool, const LEAVES: bool>
    Journey<'_, S, H, COMPACT, FULL_DETAIL, LEAVES>
{
    #[inline(always)]
    fn visit(&mut self, entry: &Entry) -> Option<Entry> {
        let (level, node, corners, codes) = match entry.kind.get() {
            Entry::BVH_NODE => return self.bvh_node(entry.index.get() as usize),
            Entry::TREE => {
                let (corners, codes) = self.root(entry.index.get() as usize);
                (0, 0, [corners; 2], codes)
            }
            _ => {
                let (level, node) = (entry.level.get() as u32, entry.index.get() as u32);
                let (split, child) = (&self.splits[level as usize - 1], node as usize & 3);
                (level, node, [split.full.child(child), split.morphed.child(child)], [entry.e0, entry.e1, entry.e2])
            }
        };
        // Here alone: each copy takes the compiler long.
        self.tree_node(level, node, corners, codes)
    }

    /// Tests the four children of a quad-BVH node.
    #[inline(always)]
    fn bvh_node(&mut self, index: usize) -> Option<Entry> {
        let line = &self.image.nodes[index];
        let tests = bvh_children(&self.setup, self.sink.t_max(), line);
        self.steps.step(Step::on(self.image.node(index), Act::Children { shape: NodeShape::Tree, met: tests.met() }).visiting());
        push_sorted(self.stack, &tests, |k| {
            let child = BvhNode::line_child(line, k);
            // Inner nodes and leaves have the kinds of their entries one lower.
            Entry { kind: U::new(child.kind.get() - 1), index: child.index, ..Entry::default() }
        })
    }

    /// Enters a tree: corners and codes of its root.
    #[inline(always)]
    fn root(&mut self, tree: usize) -> ([Point; 3], [BoundCode; 3]) {
        self.steps.step(Step::on(self.image.l0_record(tree), Act::Fetch).visiting());
        let line = self.image.record(tree);
        self.tree = TreeAt { index: tree as u32, lines: L0Record::line_tree(line) }; // an index of 28 bits
        let record = L0Record::from_words(line);
        let p = if COMPACT { record.corners() } else { self.image.corners(tree) };
        if LEAVES && let Some(prior) = self.prior.filter(|_| self.tree.lines.depth > 0) {
            self.steps.step(Step::of(Act::Decide));
            self.deciders = prior.deciders(tree as u32, &p);
        }
        let L0Record { e0, e1, e2, .. } = record;
        (p, [e0, e1, e2])
    }

    /// Decides whether the triangle of node (`level`, `node`) serves the ray, and tests it or goes down. Its corners are of full resolution and as morphed.
    #[inline(always)]
    fn tree_node(&mut self, level: u32, node: u32, [f, p]: [[Point; 3]; 2], codes: [BoundCode; 3]) -> Option<Entry> {
        let depth = self.tree.lines.depth;
        let lod = (level < depth).then(|| self.lod_test(level, node, p, codes)).filter(|lod| lod.refine);
        let Some(lod) = lod else {
            self.triangles(level, node, [p]);
            return None;
        };

        let with = self.image.vertices_with(depth, level);
        self.steps.step(match with {
            With::Record => Step::of(Act::Tessellate),
            With::Split => Step::on(self.image.split(self.tree, level, node as usize), Act::Tessellate),
            With::Nothing => Step::on(self.image.inserted(self.tree, level, node as usize), Act::Tessellate),
        });
        let t = self.image.tessellated::<COMPACT, FULL_DETAIL>(self.tree, level, node, codes, &lod, [f, p]);
        let (g, q) = ([t.g0, t.g1, t.g2], [t.q0, t.q1, t.q2]);

        if level + 1 == depth {
            self.triangles(depth, 4 * node, std::array::from_fn::<_, 4, _>(|k| child_triangle(p, q, k)));
            return None;
        }
        let split = Split { full: Corners::of(f, g), morphed: Corners::of(p, q) };
        self.splits[level as usize] = split;
        self.tree_children(level, node, &split, with)
    }

    /// The LOD test of a node with corners `p`, by the rays that decide about its edges.
    #[inline(always)]
    fn lod_test(&mut self, level: u32, node: u32, p: [Point; 3], codes: [BoundCode; 3]) -> lod_test::Out {
        let ([p0, p1, p2], [e0, e1, e2], scale) = (p, codes, self.image.scale);
        let lod = if FULL_DETAIL {
            LodTest::of_full_detail(codes, scale)
        } else {
            let input = lod_test::In { ray: *self.ray, p0, p1, p2, e0, e1, e2, scale };
            match self.prior {
                Some(prior) if LEAVES && self.deciders.is_any() => {
                    let place = node_deciders::In { tree: self.deciders, level: U::new(u64::from(level)), node: U::new(u64::from(node)) };
                    LodTest::by(NodeDeciders::eval(&place).by.map(|by| prior.viewer(by).unwrap_or(self.ray)), &input)
                }
                _ => LodTest::eval(&input),
            }
        };
        // A tree's root was visited for its record.
        self.steps.step(Step { visits: level > 0, ..Step::of(Act::LodTest { refine: lod.refine }) });
        lod
    }

    /// Tests the boxes of the four children of a node, whose inserted vertices came `with` that.
    #[inline(always)]
    fn tree_children(&mut self, level: u32, node: u32, split: &Split, with: With) -> Option<Entry> {
        let number = self.image.starts.split(self.tree.lines, level, node as usize);
        let line = &self.image.splits[number];
        let (shape, tests) = self.image.children(number, &self.setup, self.sink.t_max(), split);
        let act = Act::Children { shape, met: tests.met() };
        let fetch = || self.image.split(self.tree, level, node as usize);
        self.steps.step(match with {
            With::Split => Step::of(act),
            With::Record => Step::on(fetch(), act),
            With::Nothing => Step::on(fetch().joining(), act),
        });
        push_sorted(self.stack, &tests, |k| waiting(line, level, node, k))
    }

    /// Tests triangles of one level, the first of them of node `first`.
    #[inline(always)]
    fn triangles<const COUNT: usize>(&mut self, level: u32, first: u32, triangles: [[Point; 3]; COUNT]) {
        let mut run = TriangleRun::default();
        for (node, corners) in (first..).zip(triangles) {
            let [p0, p1, p2] = corners;
            let direction = self.ray.direction;
            let start_test::Out { test, below } = match LEAVES {
                true => StartTest::eval(&start_test::In { start: self.start, direction, p0, p1, p2 }),
                false => {
                    let test = TriTest::eval(&tri_test::In { origin: self.ray.origin, direction, p0, p1, p2 });
                    start_test::Out { test, below: Below::default() }
                }
            };
            run.add(test.hit, self.steps);
            if test.hit {
                self.sink.offer(TriangleId { tree: self.tree.index, level, node }, &corners, &test, &below);
            }
        }
        run.state(self.steps);
    }
}
