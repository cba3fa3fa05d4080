//! Packets through trees: one level of detail for all rays of a packet (paper section 4.4).
//!
//! An edge is as open as the ray of the packet that wants it the most open has it, so each ray sees at least its own detail. Every ray of the packet decides about every edge, whether it
//! meets the node or not: who meets a node differs from one triangle to its neighbour, and the surface would have cracks where they decided otherwise about the edge between them. So the
//! packet has one surface, and it is watertight for each of its rays.

use super::image::{LodImage, TreeAt, With};
use super::trace::{LodTraverser, waiting};
use crate::block::Block;
use crate::block::child_boxes::Corners;
use crate::block::lod_test::{self, LodTest};
use crate::block::tessellate::child_triangle;
use crate::format::{BvhNode, L0Record};
use crate::method::children::{Split, bvh_children};
use crate::method::packet::{Lanes, Packet, Waiting};
use crate::method::stack::Entry;
use crate::method::{HitSink, TriangleId};
use crate::num::{BoundCode, MAX_LEVELS, Point, Ray, S_ONE, U, Wire};
use crate::step::{Act, NodeShape, Step, StepSink, TriangleRun};

impl LodTraverser<'_> {
    /// Traces `rays` together as a packet, to their end; what each of them meets goes to its sink, and these come back.
    ///
    /// # Panics
    /// There are more than [`MOST_LANES`](crate::method::packet::MOST_LANES).
    pub fn trace_packet<S: StepSink, H: HitSink>(&self, rays: &[Ray], steps: &mut S, sinks: impl IntoIterator<Item = H>) -> Vec<H> {
        let mut packet = Packet::of(rays, sinks);
        if self.image().form.is_compact() {
            PacketTrace::<true, false>::run(self.image(), &mut packet, steps);
        } else {
            PacketTrace::<false, false>::run(self.image(), &mut packet, steps);
        }
        let sinks = packet.into_sinks();
        let found = sinks.iter().filter(|sink| sink.found()).count() as u32; // at most 32
        steps.step(Step::of(Act::End { found, mapped: true }).by(rays.len() as u32));
        sinks
    }
}

/// A packet under way.
pub(super) struct PacketTrace<'a, const COMPACT: bool, const FULL_DETAIL: bool> {
    image: &'a LodImage<'a>,
    splits: [Split; MAX_LEVELS as usize],
    /// The current tree.
    tree: TreeAt,
}

impl<'a, const COMPACT: bool, const FULL_DETAIL: bool> PacketTrace<'a, COMPACT, FULL_DETAIL> {
    /// Traces the rays of `packet` through `image`; without their end.
    pub fn run<S: StepSink, H: HitSink>(image: &'a LodImage<'a>, packet: &mut Packet<H>, steps: &mut S) {
        let mut own = Self { image, splits: Default::default(), tree: TreeAt::default() };
        packet.walk(steps, |packet, at, steps| own.visit(packet, at, steps));
    }

    fn visit<S: StepSink, H: HitSink>(
        &mut self,
        packet: &mut Packet<H>,
        Waiting { entry, lanes }: Waiting,
        steps: &mut S,
    ) -> Option<Waiting> {
        match entry.kind.get() {
            Entry::BVH_NODE => self.bvh_node(packet, lanes, entry.index.get() as usize, steps),
            Entry::TREE => self.root(packet, lanes, entry.index.get() as usize, steps),
            _ => {
                let (level, node) = (entry.level.get() as u32, entry.index.get() as u32); // 4 and 28 bits
                let (split, child) = (&self.splits[level as usize - 1], node as usize & 3);
                let corners = [split.full.child(child), split.morphed.child(child)];
                self.tree_node(packet, lanes, (level, node), corners, [entry.e0, entry.e1, entry.e2], steps)
            }
        }
    }

    fn bvh_node<S: StepSink, H: HitSink>(&mut self, packet: &mut Packet<H>, lanes: Lanes, index: usize, steps: &mut S) -> Option<Waiting> {
        let line = &self.image.nodes[index];
        let met = packet.test(lanes, |lane, own, t_max, met| met.add_sorted(lane, &bvh_children(&own.setup, t_max, line)));
        let act = Act::Children { shape: NodeShape::Tree, met: met.count() };
        steps.step(Step::on(self.image.node(index), act).visiting().by(lanes.count_ones()));
        packet.push(&met, |k| {
            let child = BvhNode::line_child(line, k);
            // Inner nodes and leaves have the kinds of their entries one lower.
            Entry { kind: U::new(child.kind.get() - 1), index: child.index, ..Entry::default() }
        })
    }

    fn root<S: StepSink, H: HitSink>(&mut self, packet: &mut Packet<H>, lanes: Lanes, tree: usize, steps: &mut S) -> Option<Waiting> {
        steps.step(Step::on(self.image.l0_record(tree), Act::Fetch).visiting());
        let line = self.image.record(tree);
        self.tree = TreeAt { index: tree as u32, lines: L0Record::line_tree(line) }; // an index of 28 bits
        let record = L0Record::from_words(line);
        let p = if COMPACT { record.corners() } else { self.image.corners(tree) };
        self.tree_node(packet, lanes, (0, 0), [p, p], [record.e0, record.e1, record.e2], steps)
    }

    /// Decides whether the triangle of node (`level`, `node`) serves all rays, and tests it or goes down. Its corners are of full resolution and as morphed.
    fn tree_node<S: StepSink, H: HitSink>(
        &mut self,
        packet: &mut Packet<H>,
        lanes: Lanes,
        (level, node): (u32, u32),
        [f, p]: [[Point; 3]; 2],
        codes: [BoundCode; 3],
        steps: &mut S,
    ) -> Option<Waiting> {
        let depth = self.tree.lines.depth;
        if level == depth {
            self.triangles(packet, lanes, (level, node), [p], steps);
            return None;
        }
        let (lod, asked) = self.lod_test(packet, p, codes);
        // A tree's root was visited for its record.
        let act = Act::LodTest { refine: lod.refine };
        steps.step(Step { visits: level > 0, ..Step::of(act) }.by(asked));
        if !lod.refine {
            self.triangles(packet, lanes, (level, node), [p], steps);
            return None;
        }

        let with = self.image.vertices_with(depth, level);
        steps.step(match with {
            With::Record => Step::of(Act::Tessellate),
            With::Split => Step::on(self.image.split(self.tree, level, node as usize), Act::Tessellate),
            With::Nothing => Step::on(self.image.inserted(self.tree, level, node as usize), Act::Tessellate),
        });
        let t = self.image.tessellated::<COMPACT, FULL_DETAIL>(self.tree, level, node, codes, &lod, [f, p]);
        let (g, q) = ([t.g0, t.g1, t.g2], [t.q0, t.q1, t.q2]);
        if level + 1 == depth {
            self.triangles(packet, lanes, (depth, 4 * node), std::array::from_fn::<_, 4, _>(|k| child_triangle(p, q, k)), steps);
            return None;
        }
        self.splits[level as usize] = Split { full: Corners::of(f, g), morphed: Corners::of(p, q) };
        self.children(packet, lanes, (level, node), with, steps)
    }

    /// Each edge as open as any ray has it, and how many rays were asked: no more once all three are open.
    fn lod_test<H: HitSink>(&self, packet: &Packet<H>, [p0, p1, p2]: [Point; 3], [e0, e1, e2]: [BoundCode; 3]) -> (lod_test::Out, u32) {
        let scale = self.image.scale;
        if FULL_DETAIL {
            return (LodTest::of_full_detail([e0, e1, e2], scale), 1);
        }
        let (mut most, mut asked) = (lod_test::Out::default(), 0);
        for lane in &packet.lanes {
            let own = LodTest::eval(&lod_test::In { ray: lane.ray, p0, p1, p2, e0, e1, e2, scale });
            most = lod_test::Out {
                refine: most.refine | own.refine,
                s0: most.s0.max(own.s0),
                s1: most.s1.max(own.s1),
                s2: most.s2.max(own.s2),
            };
            asked += 1;
            if [most.s0, most.s1, most.s2].iter().all(|s| s.get() == S_ONE) {
                break;
            }
        }
        (most, asked)
    }

    /// Tests the four children of a node, whose inserted vertices came `with` that.
    fn children<S: StepSink, H: HitSink>(
        &mut self,
        packet: &mut Packet<H>,
        lanes: Lanes,
        (level, node): (u32, u32),
        with: With,
        steps: &mut S,
    ) -> Option<Waiting> {
        let number = self.image.starts.split(self.tree.lines, level, node as usize);
        let (line, split) = (&self.image.splits[number], &self.splits[level as usize]);
        let mut shape = NodeShape::Tree;
        let met = packet.test(lanes, |lane, own, t_max, met| {
            let tests;
            (shape, tests) = self.image.children(number, &own.setup, t_max, split);
            met.add_sorted(lane, &tests);
        });
        let fetch = || self.image.split(self.tree, level, node as usize);
        let act = Act::Children { shape, met: met.count() };
        let step = match with {
            With::Split => Step::of(act),
            With::Record => Step::on(fetch(), act),
            With::Nothing => Step::on(fetch().joining(), act),
        };
        steps.step(step.by(lanes.count_ones()));
        packet.push(&met, |k| waiting(line, level, node, k))
    }

    /// Tests triangles of one level, the first of them of node `first`.
    fn triangles<S: StepSink, H: HitSink, const COUNT: usize>(
        &mut self,
        packet: &mut Packet<H>,
        lanes: Lanes,
        (level, first): (u32, u32),
        triangles: [[Point; 3]; COUNT],
        steps: &mut S,
    ) {
        let mut run = TriangleRun::default();
        for (node, corners) in (first..).zip(&triangles) {
            packet.triangle(lanes, TriangleId { tree: self.tree.index, level, node }, corners, &mut run, steps);
        }
        run.state(steps);
    }
}
