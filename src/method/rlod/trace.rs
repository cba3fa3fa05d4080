//! Rays through a kd-tree with R-LODs (paper section 4.2).
//!
//! A ray is kept between where it enters and leaves the cell of a node, in steps of t and double precision. Both sides of a split are visited wherever a hit could lie on either, so nothing is
//! lost by rounding; triangles are tested exactly. A node whose R-LOD serves ends the way down, whether its plane is met or not.

use super::hits::{PlaneHit, PlaneSink};
use super::map::{NODES, REFERENCES, RLODS, TRIANGLES};
use super::tree::{Kind, Node, Tree};
use super::works::{KD_SPLIT, RLOD_PLANE, RLOD_TEST};
use crate::block::Block;
use crate::block::start_test::{self, Below, StartTest};
use crate::block::tri_test::{self, TriTest};
use crate::method::{Departure, HitSink, TriangleId};
use crate::num::{Point, RayT, START_BITS, Start};
use crate::rays::ModelRay;
use crate::step::{Act, Fetch, MAX_FETCH_LINES, MAX_PLACES, MemoryMap, SectionId, Step, StepSink, TriangleRun};
use std::sync::Arc;

/// Steps of t in a direction's length.
const STEPS: f64 = 4_294_967_296.0;
/// Units, and a share of t, by which a crossing may be off, and more.
const LOST: f64 = 1.0 / 65_536.0;
const LOST_SHARE: f64 = 1.0 / 1_099_511_627_776.0;

/// What R-LODs are chosen by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metric {
    /// Pixels of error: an R-LOD serves if its radius is less than that of so many pixels.
    pub pixels: f64,
    /// By how many times its deviation a plane reaches beyond its cell, along the ray.
    pub reach: f64,
}

/// The radius of a ray's cone along it, in units, by steps of t.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Width {
    /// At its origin.
    pub first: f64,
    /// For each step.
    pub slope: f64,
}

/// What is still to be visited.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    node: u32,
    enters: f64,
    leaves: f64,
}

/// A ray as splits and planes need it.
struct Shot<'a> {
    ray: &'a ModelRay,
    from: Option<&'a Start>,
    origin: [f64; 3],
    direction: [f64; 3],
    /// Steps of t for a unit.
    steps: [f64; 3],
    /// Steps by which a crossing may be off along each axis.
    lost: [f64; 3],
    width: Width,
}

impl<'a> Shot<'a> {
    fn new(ray: &'a ModelRay, from: Option<&'a Start>, width: Width) -> Self {
        let fraction = from.map_or([0.0; 3], |from| from.fraction.map(|f| f.get() as f64 / 2f64.powi(START_BITS as i32)));
        let whole = ray.ray.origin.get();
        let direction = ray.ray.direction.get().map(|c| c as f64);
        let steps = direction.map(|c| STEPS / c);
        let lost = steps.map(|steps| 2.0 + LOST * steps.abs());
        Self { ray, from, origin: std::array::from_fn(|k| whole[k] as f64 + fraction[k]), direction, steps, lost, width }
    }

    /// Where it enters and leaves the cell of the root; not if it misses it.
    fn root(&self, tree: &Tree) -> Option<[f64; 2]> {
        let [mut enters, mut leaves] = [0.0f64, end(self.ray.range[1])];
        for k in 0..3 {
            let sides = [tree.cell.lo[k], tree.cell.hi[k]].map(|side| f64::from(side) - self.origin[k]);
            if self.direction[k] == 0.0 {
                if sides[0] > LOST || sides[1] < -LOST {
                    return None;
                }
                continue;
            }
            let [a, b] = sides.map(|side| side * self.steps[k]);
            let lost = |t: f64| self.lost[k] + LOST_SHARE * t.abs();
            let (near, far) = (a.min(b), a.max(b));
            enters = enters.max(near - lost(near));
            leaves = leaves.min(far + lost(far));
        }
        (enters <= leaves).then_some([enters, leaves])
    }
}

/// Where a ray ends whose last step of t is this one: that stands for all beyond, too, which rays of short directions reach.
fn end(t: RayT) -> f64 {
    if t == RayT::MAX { f64::INFINITY } else { t.get() as f64 }
}

/// Traces rays through a tree; keeps its stack from ray to ray.
pub struct RlodTraverser {
    tree: Arc<Tree>,
    map: MemoryMap,
    metric: Metric,
    stack: Vec<Waiting>,
}

impl RlodTraverser {
    /// A traverser of `tree`, whose lines lie as `map` says.
    pub fn new(tree: Arc<Tree>, map: MemoryMap, metric: Metric) -> Self {
        Self { tree, map, metric, stack: Vec::new() }
    }

    /// Its tree.
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// Traces `ray`, which starts at `from` if there is one and is as wide as `width` says: whatever is met goes to `sink`, every step but its end to `steps`.
    pub fn descend<S: StepSink, H: PlaneSink>(
        &mut self,
        ray: &ModelRay,
        from: Option<&Departure>,
        width: Width,
        steps: &mut S,
        sink: &mut H,
    ) {
        let shot = Shot::new(ray, from.map(|from| &from.start), width);
        self.stack.clear();
        // Six sides of the root's cell.
        steps.step(Step::of(Act::Work { work: KD_SPLIT, count: 6 }));
        let Some([enters, leaves]) = shot.root(&self.tree) else { return };
        let tree = Arc::clone(&self.tree);
        let mut next = Some(Waiting { node: 0, enters, leaves });
        while !sink.is_done() {
            let Some(waiting) = next.take().or_else(|| self.pop(steps, sink)) else {
                if self.stack.is_empty() {
                    break;
                }
                continue;
            };
            let node = &tree.nodes[waiting.node as usize];
            self.visit(tree.node_bytes, waiting.node, steps);
            match node.kind() {
                Kind::Leaf { first, count } => self.leaf(&tree, &shot, first, count, steps, sink),
                Kind::Inner { axis, at, left } => {
                    if !self.served(&tree, &shot, node, &waiting, steps, sink) {
                        next = self.children(&shot, &waiting, axis, at, left, steps, sink);
                    }
                }
            }
        }
    }

    /// Takes what waits on top of the stack; nothing if there is none, or it lies behind the closest hit.
    #[inline(always)]
    fn pop<S: StepSink, H: HitSink>(&mut self, steps: &mut S, sink: &H) -> Option<Waiting> {
        let waiting = self.stack.pop()?;
        let dropped = waiting.enters > end(sink.t_max());
        steps.step(Step::of(Act::Pop { dropped }));
        (!dropped).then_some(waiting)
    }

    /// Reads a node: a line, or two where it lies across their border.
    #[inline(always)]
    fn visit<S: StepSink>(&self, bytes: u64, node: u32, steps: &mut S) {
        let first = bytes * u64::from(node);
        let [line, last] = [first / 32, (first + bytes - 1) / 32];
        let fetch = Fetch::new(NODES, self.map.line(NODES, line), (last - line + 1) as u32);
        steps.step(Step::on(fetch, Act::Fetch).visiting());
    }

    /// Whether the R-LOD of a node serves, if it has one; it is then met or not.
    #[inline(always)]
    fn served<S: StepSink, H: PlaneSink>(
        &self,
        tree: &Tree,
        shot: &Shot<'_>,
        node: &Node,
        waiting: &Waiting,
        steps: &mut S,
        sink: &mut H,
    ) -> bool {
        let Some([code, number]) = node.rlod() else { return false };
        steps.step(Step::of(Act::Work { work: RLOD_TEST, count: 1 }));
        let radius = shot.width.first + shot.width.slope * waiting.enters.max(0.0);
        if self.metric.pixels * radius <= f64::from(tree.errors.error(code)) || self.metric.pixels <= 0.0 {
            return false;
        }
        steps.step(Step::on(Fetch::new(RLODS, self.map.line(RLODS, number.into()), 1), Act::Fetch));
        steps.step(Step::of(Act::Work { work: RLOD_PLANE, count: 1 }));
        let rlod = &tree.rlods[number as usize];
        let [x, y, z, distance] = rlod.plane.map(f64::from);
        let dot = |v: [f64; 3]| x * v[0] + y * v[1] + z * v[2];
        let along = dot(shot.direction);
        let t = (distance - dot(shot.origin)) / along * STEPS;
        let length = shot.direction.iter().map(|c| c * c).sum::<f64>().sqrt();
        let beyond = self.metric.reach * f64::from(rlod.deviation) * STEPS / length;
        // A ray along the plane meets it nowhere: no number, or none between both.
        if t >= (waiting.enters - beyond).max(0.0) && t <= waiting.leaves + beyond {
            // f64 to u64 casts truncate and saturate, as does the width of t.
            sink.plane(PlaneHit { t: RayT::saturating(t as u64), rlod: number, front: along < 0.0 });
        }
        true
    }

    /// The child that is entered first; the other waits if the ray goes on into it.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "a ray, a split, and who is told")]
    fn children<S: StepSink, H: HitSink>(
        &mut self,
        shot: &Shot<'_>,
        waiting: &Waiting,
        axis: usize,
        at: i32,
        left: u32,
        steps: &mut S,
        sink: &H,
    ) -> Option<Waiting> {
        steps.step(Step::of(Act::Work { work: KD_SPLIT, count: 1 }));
        let apart = f64::from(at) - shot.origin[axis];
        if shot.direction[axis] == 0.0 {
            let child = |side: u32| Waiting { node: left + side, ..*waiting };
            if apart.abs() <= LOST {
                self.stack.push(child(1));
                return Some(child(0));
            }
            return Some(child(u32::from(apart < 0.0)));
        }
        // The side that the ray comes from.
        let near = u32::from(shot.direction[axis] < 0.0);
        let crosses = apart * shot.steps[axis];
        let lost = shot.lost[axis] + LOST_SHARE * crosses.abs();
        let leaves = waiting.leaves.min(end(sink.t_max()));
        let [is_near, is_far] = [waiting.enters <= crosses + lost, leaves >= crosses - lost];
        let first = Waiting { node: left + near, leaves: waiting.leaves.min(crosses + lost), ..*waiting };
        let second = Waiting { node: left + 1 - near, enters: waiting.enters.max(crosses - lost), ..*waiting };
        match [is_near, is_far] {
            [true, true] => {
                self.stack.push(second);
                Some(first)
            }
            [true, false] => Some(first),
            [false, _] => Some(second),
        }
    }

    /// Reads the references of a leaf, then their triangles, and tests them.
    #[inline(always)]
    fn leaf<S: StepSink, H: HitSink>(&self, tree: &Tree, shot: &Shot<'_>, first: u32, count: u32, steps: &mut S, sink: &mut H) {
        if count == 0 {
            return;
        }
        let references = &tree.references[first as usize..][..count as usize];
        let [line, last] = [first, first + count - 1].map(|reference| u64::from(reference) * 4 / 32);
        let mut place = 0;
        let mut ask = |section: SectionId, line: u64, lines: u32, joins: bool| {
            let fetch = Fetch::new(section, self.map.line(section, line), lines).at(place.min(MAX_PLACES - lines));
            place += lines;
            steps.step(Step::on(if joins { fetch.joining() } else { fetch }, Act::Fetch));
        };
        let mut at = line;
        while at <= last {
            let lines = (last - at + 1).min(MAX_FETCH_LINES.into()) as u32; // at most 7
            ask(REFERENCES, at, lines, at > line);
            at += u64::from(lines);
        }
        for (k, &reference) in references.iter().enumerate() {
            // All at once, but not before the references are there.
            ask(TRIANGLES, reference.into(), 1, k > 0);
        }
        let mut run = TriangleRun::default();
        for &reference in references {
            let corners = tree.triangles[reference as usize].map(Point::from_i32);
            let [p0, p1, p2] = corners;
            let start_test::Out { test, below } = match shot.from {
                Some(start) => StartTest::eval(&start_test::In { start: *start, direction: shot.ray.ray.direction, p0, p1, p2 }),
                None => {
                    let input = tri_test::In { origin: shot.ray.ray.origin, direction: shot.ray.ray.direction, p0, p1, p2 };
                    start_test::Out { test: TriTest::eval(&input), below: Below::default() }
                }
            };
            run.add(test.hit, steps);
            if test.hit {
                sink.offer(TriangleId { tree: tree.ids[reference as usize], level: 0, node: 0 }, &corners, &test, &below);
            }
        }
        run.state(steps);
    }
}
