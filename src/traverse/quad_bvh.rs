//! The baseline: the full-resolution mesh under a quad-BVH with 16-bit or 32-bit boxes, built from the same blocks (paper section 6.1).

use super::children::bvh_children;
use super::lod::{is_beyond, push_sorted, quarter, read_pair};
use super::stack::{Entry, Op, TraversalStack};
use super::{HitSink, Kind, Probe, Section, TriangleId};
use crate::block::Block;
use crate::block::box_test32::{self, BoxTest32};
use crate::block::child_sort;
use crate::block::child_test::sort;
use crate::block::ray_setup::{self, RaySetup};
use crate::block::tri_test::{self, TriTest};
use crate::bvh::{BvhChild32, FullBvh, FullNodes, LINE_BYTES, Leaves};
use crate::format::{BvhChild, ChildRef};
use crate::num::{Point, Ray, U, Wire};

/// Traces rays through a full-resolution quad-BVH; keeps its stack from ray to ray.
pub struct BvhTraverser<'a> {
    levels: u32,
    nodes: &'a FullNodes,
    leaves: &'a Leaves,
    stack: TraversalStack,
}

/// The sections of a full-resolution BVH's memory.
pub fn bvh_sections(bvh: &FullBvh) -> Vec<Section> {
    let section = |kind, bytes: u64| Section { kind, lines: bytes.div_ceil(LINE_BYTES) };
    vec![section(Kind::BvhNode, bvh.nodes.bytes()), section(Kind::Leaf, bvh.leaves.bytes())]
}

impl<'a> BvhTraverser<'a> {
    /// A traverser of `bvh`.
    pub fn new(bvh: &'a FullBvh) -> Self {
        Self { levels: bvh.levels, nodes: &bvh.nodes, leaves: &bvh.leaves, stack: TraversalStack::default() }
    }

    /// Number of splits N of the hierarchy below which the mesh lies.
    pub fn levels(&self) -> u32 {
        self.levels
    }

    /// Traces `ray`: every triangle met goes to `sink`, every line read to `probe`.
    pub fn trace<P: Probe, H: HitSink>(&mut self, ray: &Ray, probe: &mut P, sink: &mut H) {
        let setup = RaySetup::eval(&ray_setup::In { origin: ray.origin, direction: ray.direction });
        self.stack.clear();
        let mut next = Some(Entry::default());
        loop {
            // A child just tested is not beyond the closest hit; an entry that waited may be by now.
            let Some(entry) = next.take().or_else(|| self.pop(probe, sink)) else {
                if self.stack.is_empty() {
                    return;
                }
                continue;
            };
            let index = entry.index.get() as usize;
            if entry.kind.get() == Entry::BVH_NODE {
                next = self.node(&setup, index, probe, sink);
            } else {
                // Leaves keep their count in `level`, which trees need and leaves do not.
                let slots = index..index + entry.level.get() as usize + 1;
                probe.leaf(slots.clone());
                self.leaves.lines(slots.clone(), |address| probe.line(Kind::Leaf, address / LINE_BYTES));
                for slot in slots {
                    self.triangle(ray, slot, probe, sink);
                }
            }
        }
    }

    /// Takes the next entry from the stack; `None` if there is none, or it lies behind the closest hit.
    #[inline(always)]
    fn pop<P: Probe, H: HitSink>(&mut self, probe: &mut P, sink: &H) -> Option<Entry> {
        let entry = self.stack.step(Op::Pop)?;
        let dropped = is_beyond(entry.t_near, sink.t_max());
        probe.pop(dropped);
        (!dropped).then_some(entry)
    }

    #[inline(always)]
    fn node<P: Probe, H: HitSink>(&mut self, setup: &ray_setup::Out, index: usize, probe: &mut P, sink: &H) -> Option<Entry> {
        let t_max = sink.t_max();
        // Inner nodes and leaves have the kinds of their entries one lower.
        let waiting = |child: ChildRef| Entry {
            kind: U::new(child.kind.get() - 1),
            level: U::new(child.count.get()),
            index: child.index,
            ..Entry::default()
        };
        match self.nodes {
            FullNodes::Boxes16(nodes) => {
                read_pair(probe, Kind::BvhNode, index);
                let child = |k| quarter::<BvhChild>(&nodes[index], k);
                let tests = bvh_children(setup, t_max, &nodes[index]);
                probe.node(tests.met());
                push_sorted(&mut self.stack, &tests, |k| waiting(child(k).child))
            }
            FullNodes::Boxes32(nodes) => {
                read_pair(probe, Kind::BvhNode, 2 * index);
                read_pair(probe, Kind::BvhNode, 2 * index + 1);
                let child = |k| BvhChild32::from_words(&nodes[index][4 * k..4 * k + 4]);
                let mut tests = child_sort::In::default();
                for k in 0..4 {
                    let BvhChild32 { child, lo, hi } = child(k);
                    if child.kind.get() != ChildRef::EMPTY {
                        let test = BoxTest32::eval(&box_test32::In { ray: *setup, t_max, lo, hi });
                        (tests.hit[k], tests.t_near[k]) = (test.hit, test.t_near);
                    }
                }
                let tests = sort(&tests);
                probe.node(tests.met());
                push_sorted(&mut self.stack, &tests, |k| waiting(child(k).child))
            }
        }
    }

    #[inline(always)]
    fn triangle<P: Probe, H: HitSink>(&mut self, ray: &Ray, slot: usize, probe: &mut P, sink: &mut H) {
        let (points, id) = self.leaves.triangle(slot);
        let [p0, p1, p2] = points.map(Point::from_i32);
        let test = TriTest::eval(&tri_test::In { origin: ray.origin, direction: ray.direction, p0, p1, p2 });
        probe.triangle(test.hit);
        if test.hit {
            let levels = self.levels;
            let (tree, node) = (id >> (2 * levels), id & ((1 << (2 * levels)) - 1));
            sink.offer(TriangleId { tree, level: levels, node }, &test);
        }
    }
}
