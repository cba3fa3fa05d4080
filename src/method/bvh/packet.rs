//! Packets through a BVH.

use super::trace::{BvhTraverser, Turned, waiting};
use crate::bvh::BvhChild32;
use crate::format::{BvhChild, BvhNode, ChildRef, SixNode};
use crate::method::HitSink;
use crate::method::children::{bvh_children, coded_children, quarter, six_children, wide_children};
use crate::method::mesh_bvh::{FullNodes, cut_triangle};
use crate::method::packet::{Lanes, Met, Packet, Waiting};
use crate::method::stack::Entry;
use crate::num::{Point, U, Wire};
use crate::step::{Act, NodeShape, Step, StepSink, TriangleRun};

impl BvhTraverser {
    /// Traces the rays of `packet`; without their end.
    pub(super) fn packet<S: StepSink, H: HitSink>(&self, packet: &mut Packet<H>, steps: &mut S) {
        let mut turned: Vec<Turned> = packet.lanes.iter().map(|lane| Turned::not(&lane.setup)).collect();
        packet.walk(steps, |packet, Waiting { entry, lanes }, steps| {
            let index = entry.index.get() as usize;
            if entry.kind.get() == Entry::BVH_NODE {
                return self.packet_node(packet, lanes, &mut turned, index, steps);
            }
            // Leaves keep their count in `level`, which trees need and leaves do not.
            let leaf = self.leaves.leaf(index, entry.level.get() as usize + 1);
            self.fetch_leaf(&leaf, steps);
            let mut run = TriangleRun::default();
            self.leaves.triangles(&leaf, |points, id| {
                packet.triangle(lanes, cut_triangle(self.levels, id), &points.map(Point::from_i32), &mut run, steps);
            });
            run.state(steps);
            None
        });
    }

    fn packet_node<S: StepSink, H: HitSink>(
        &self,
        packet: &mut Packet<H>,
        lanes: Lanes,
        turned: &mut [Turned],
        index: usize,
        steps: &mut S,
    ) -> Option<Waiting> {
        let fetch = self.fetch_node(index);
        let mut tested = |met: &Met, shape| {
            let act = Act::Children { shape, met: met.count() };
            steps.step(Step::on(fetch, act).visiting().by(lanes.count_ones()));
        };
        let (met, child): (Met, Box<dyn Fn(usize) -> ChildRef>) = match &*self.nodes {
            FullNodes::Local(nodes) => {
                let line = &nodes[index];
                let met = packet.test(lanes, |lane, own, t_max, met| met.add_sorted(lane, &bvh_children(&own.setup, t_max, line)));
                tested(&met, NodeShape::Local);
                (met, Box::new(|k| BvhNode::line_child(line, k)))
            }
            FullNodes::Boxes16(nodes) => {
                let group = &nodes[index];
                let met = packet.test(lanes, |lane, own, t_max, met| met.add_sorted(lane, &coded_children(&own.setup, t_max, group)));
                tested(&met, NodeShape::Plain);
                (met, Box::new(|k| quarter::<BvhChild>(group, k).child))
            }
            FullNodes::Boxes32(nodes) => {
                let group = &nodes[index];
                let met =
                    packet.test(lanes, |lane, own, t_max, met| met.add_sorted(lane, &wide_children::<false>(&own.setup, t_max, group)));
                tested(&met, NodeShape::Wide);
                (met, Box::new(|k| BvhChild32::from_words(&group[4 * k..4 * k + 4]).child))
            }
            FullNodes::Six(nodes) => {
                let node = SixNode::from_words(&nodes[index]);
                let mut turns = 0;
                let met = packet.test(lanes, |lane, own, t_max, met| {
                    turns += u32::from(turned[lane].turn(node.rotation.get() as u32, &own.ray));
                    let setup = if node.rotation == U::ZERO { &own.setup } else { &turned[lane].setup };
                    let (tests, t_near) = six_children(setup, t_max, &node);
                    for &k in &tests.order[..tests.count.get() as usize] {
                        let k = k.get() as usize;
                        met.add(lane, k, t_near[k]);
                    }
                });
                // Some rays may have been turned into this frame before.
                let act = |shape| Act::Children { shape, met: met.count() };
                let rest = lanes.count_ones() - turns;
                if turns > 0 {
                    steps.step(Step::on(fetch, act(NodeShape::Turned)).visiting().by(turns));
                    if rest > 0 {
                        steps.step(Step::of(act(NodeShape::Six)).by(rest));
                    }
                    steps.step(Step::of(Act::Work { work: 0, count: turns }));
                } else {
                    steps.step(Step::on(fetch, act(NodeShape::Six)).visiting().by(rest));
                }
                (met, Box::new(move |k| node.child(k)))
            }
        };
        packet.push(&met, |k| waiting(child(k)))
    }
}
