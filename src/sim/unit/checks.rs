//! What ends a ray early (`docs/traversal-unit.md`, "Rays that end early"): nothing that a line holds can lead a context out of its states, stack and registers.
//!
//! A context objects before it does what it cannot do, and so no block is given anything that it is not made for. Errors of memory and a flush come at any time:
//! they are kept until the context waits for no block.

use super::context::Context;
use super::wires::Cycle;
use crate::format::{BvhNode, L0Record};
use crate::hardware::ports::{MemoryAnswer, SceneConfig};
use crate::hardware::{Fetch, RayError, State};
use crate::num::{COORD_LIMIT, Point, S, U, Vec3, Wire};

/// A kind of child that there is none of.
const NO_KIND: u64 = 3;

/// Some point is where no model has one: beyond the largest coordinate, or not on a grid of so many zero bits.
fn misplaced(points: &[Point; 3], zeros: u64) -> bool {
    let beyond = |c: i64| c.abs() > i64::from(COORD_LIMIT);
    points.iter().flat_map(|point| point.get()).any(|c| beyond(c) || c & !(-1 << zeros) != 0)
}

impl Context {
    /// A point as this hardware keeps it.
    pub fn kept(&self, point: Point) -> Point {
        let [x, y, z] = point.get().map(|c| S::new(c & (-1 << self.coordinate_zeros)));
        Vec3 { x, y, z }
    }

    /// The line that comes in this cycle, if it is waited for: of this ray, and asked for.
    pub fn arrival<'a>(&self, me: usize, cycle: &'a Cycle) -> Option<&'a MemoryAnswer> {
        let waited_for = |place: u64| place < 2 && self.waiting >> place & 1 == 1;
        cycle.fetch.result(me).filter(|answer| answer.epoch == self.epoch && waited_for(answer.tag.get() & 3))
    }

    /// Lines are asked for or waited for.
    fn waits_for_memory(&self) -> bool {
        self.want != 0 || self.waiting != 0
    }

    /// Nothing moved while lines are waited for.
    fn idles(&self, me: usize, cycle: &Cycle) -> bool {
        self.waits_for_memory() && !cycle.fetch.granted(me) && self.arrival(me, cycle).is_none()
    }

    /// Whether the lines that are waited for saw the last tick too.
    pub fn stale_after(&self, me: usize, cycle: &Cycle) -> bool {
        self.idles(me, cycle) && (cycle.tick || self.stale)
    }

    /// What the context cannot do in this cycle.
    pub fn objection(&self, me: usize, scene: &SceneConfig, cycle: &Cycle) -> Option<RayError> {
        let is = |wrong: bool, error| wrong.then_some(error);
        match self.state {
            State::Visit => is(self.visits_left.get() == U::ZERO, RayError::Visits),
            State::Fetch if !self.waits_for_memory() => match self.fetch.get() {
                Fetch::Node => is(self.is_no_node(), RayError::Image),
                Fetch::Record => is(self.is_no_record(scene), RayError::Image),
                Fetch::Split => None,
            },
            State::MorphWait => {
                let out = cycle.morph.result(me)?;
                // Between levels: below the scene's here.
                let zeros = scene.levels.get() - self.level.get().get() - 1 + scene.zeros.get();
                is(misplaced(&[out.g0, out.g1, out.g2], zeros), RayError::Image)
            }
            State::Push => {
                let count = self.count.get().get() as usize; // three bits
                let entry = count.checked_sub(1).map(|place| self.child_entry(place))?;
                if entry.index.get() >> self.index_bits != 0 {
                    Some(RayError::Image)
                } else {
                    is(count > 1 && self.stack.len() == self.room, RayError::Stack)
                }
            }
            _ => None,
        }
    }

    /// Line 0 is no quad-BVH node.
    fn is_no_node(&self) -> bool {
        let BvhNode { kinds, origin, .. } = BvhNode::from_words(&self.lines[0]);
        kinds.iter().any(|kind| kind.get() == NO_KIND) || origin.get().iter().any(|&code| code == S::<16>::MIN.get())
    }

    /// The lines are no L0 record of this scene.
    fn is_no_record(&self, scene: &SceneConfig) -> bool {
        let L0Record { depth, place, .. } = L0Record::from_words(&self.lines[0]);
        let deepest = scene.levels.get().min(self.stored_levels);
        let place_beyond = depth != U::ZERO && place.get() >> self.index_bits != 0;
        let corners = self.record_corners(scene);
        depth.get() > deepest || place_beyond || misplaced(&corners, scene.levels.get() + scene.zeros.get())
    }

    /// The ray ends here: the context cannot go on, or must not and waits for no block.
    pub fn stops(&self, objection: Option<RayError>) -> bool {
        let waits_for_no_block = matches!(self.state, State::Visit | State::Fetch | State::Child | State::Push | State::Pop);
        objection.is_some() || self.error.is_some() && waits_for_no_block
    }

    /// The ray's error behind this cycle; the first one stays.
    pub fn error_after(&self, me: usize, cycle: &Cycle, objection: Option<RayError>) -> Option<RayError> {
        let under_way = !matches!(self.state, State::Idle | State::Done);
        let late = self.idles(me, cycle) && cycle.tick && self.stale;
        match self.error {
            None if under_way && cycle.flush => Some(RayError::Aborted),
            None if under_way && self.arrival(me, cycle).is_some_and(|answer| answer.error) => Some(RayError::Memory),
            None if under_way && late => Some(RayError::Late),
            None => objection,
            known => known,
        }
    }
}
