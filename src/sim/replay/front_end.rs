//! Who asks the memory hierarchy for lines.

use super::counts::Supplier;
use super::event::Happening;
use super::feed::Feed;
use super::group_side::GroupSide;
use super::messages::Grant;
use crate::block::Operations;

/// Who asks the memory hierarchy for lines: the cores or units of a partition's groups.
pub(super) trait FrontEnd {
    /// Of how many waiters at once the way of the last line is kept, and where each one's is.
    fn slots(&self) -> (usize, fn(u32) -> usize);
    /// The rays of its groups.
    fn feed(&mut self) -> &mut Feed;
    /// A group will have a grant.
    fn grant(&mut self, group: u32, grant: Grant) {
        self.feed().comes(group, grant);
    }
    /// A group has rays again, or its first.
    fn granted(&mut self, group: u32, memory: &mut GroupSide);
    /// The cycle it asked for has come, or its held request was taken.
    fn wake(&mut self, id: u32, memory: &mut GroupSide);
    /// `waiter`'s line comes from the L1 in `cycle`.
    fn comes(&mut self, waiter: u32, cycle: u64, memory: &mut GroupSide) {
        memory.answer_at(cycle, waiter, Supplier::L1);
    }
    /// What happens soon to those, far ahead and near, is like `happening`.
    fn prefetch(&self, _happening: Happening, _soon: [Option<u32>; 2]) {}
    /// A line came for `waiter`.
    fn answer(&mut self, waiter: u32, from: Supplier, memory: &mut GroupSide);
    /// Rays taken that have not ended.
    fn under_way(&self) -> u64;
    /// What its rays have had the blocks do so far.
    fn operations(&self) -> Operations;
    /// What it does, for error messages.
    fn describe(&self) -> String;
}
