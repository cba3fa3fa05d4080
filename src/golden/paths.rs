//! Paths: whose level of detail counts for a ray that leaves the surface, by the rule itself, back through all rays before it (paper section 3.8).
//!
//! About an edge decides, for ray i: if it lies in the base triangle that ray i - 1 hit, who decided about it for ray i - 1; if it lies on a base edge that is one of that
//! triangle's too, with the same two points for ends, likewise; else ray i.

use super::fine::Fine;
use super::lod::Viewer;
use super::predicates::Vector;
use crate::num::{Point, START_BITS, Start, U};

/// A ray of a path with its hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    pub(super) viewer: Viewer,
    pub(super) tree: u32,
    /// Corners of the base triangle that was hit.
    pub(super) base: [Vector; 3],
    /// Corners of the triangle that was hit.
    pub(super) corners: [Vector; 3],
    /// Where the next ray starts.
    pub(super) start: Fine,
}

impl Leg {
    /// Where the next ray starts.
    pub fn start(&self) -> Start {
        let one = 1i64 << START_BITS;
        let [x, y, z] = self.start.map(|c| c.div_euclid(one));
        Start { point: Point::new(x, y, z), fraction: self.start.map(|c| U::new(c.rem_euclid(one).cast_unsigned())) }
    }

    /// Corners of the triangle that was hit, in units.
    pub fn corners(&self) -> [Vector; 3] {
        self.corners
    }
}

/// Who decides about an edge of base triangle `tree` with corners `base`: one that lies on its base edge `on`, or an inner one.
pub(super) fn decider<'a>(before: &'a [Leg], own: &'a Viewer, tree: u32, base: [Vector; 3], on: Option<usize>) -> &'a Viewer {
    let Some((last, earlier)) = before.split_last() else { return own };
    if last.tree == tree {
        return decider(earlier, &last.viewer, tree, base, on);
    }
    let ends = |corners: [Vector; 3], k: usize| {
        let mut ends = [corners[(k + 1) % 3], corners[(k + 2) % 3]];
        ends.sort_unstable();
        ends
    };
    match on.and_then(|k| (0..3).find(|&i| ends(last.base, i) == ends(base, k))) {
        Some(i) => decider(earlier, &last.viewer, last.tree, last.base, Some(i)),
        None => own,
    }
}
