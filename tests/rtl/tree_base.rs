//! Where a tree's lines begin.

use crate::draw::Draw;
use crate::suite::{Category, Suite};
use lodray::block::tree_base::{In, TreeBase};
use lodray::num::{MAX_LEVELS, U};
use tb::Mode;

const LAST: u64 = U::<36>::MAX.get();

/// (4^levels - 1) / 3.
fn triangles(levels: u64) -> u64 {
    ((1 << (2 * levels)) - 1) / 3
}

/// Lines of vertex data and of bound data before those of the tree.
fn before(i: &In) -> (u64, u64) {
    let groups = i.levels.get().checked_sub(1).map_or(0, triangles);
    let lines = if i.compact { 2 * groups } else { triangles(i.levels.get()) };
    (i.tree.get() * lines, i.tree.get() * groups)
}

/// As many trees as memory holds, or fewer, or one.
fn random(draw: &mut Draw) -> In {
    let levels = draw.below(draw.levels + 1);
    let most = (LAST / triangles(levels).max(1)).min((1 << 28) - 1);
    let tree = match draw.below(4) {
        0 => most,
        1 => draw.bits::<28>().get().min(most),
        _ => draw.below(most + 1),
    };
    let input = In { compact: draw.once_in(2), levels: U::new(levels), tree: U::new(tree), vertices: U::ZERO, bounds: U::ZERO };
    let (vertices, bounds) = before(&input);
    let below = |draw: &mut Draw, used: u64| U::new(draw.bits::<36>().get().min(LAST - used));
    In { vertices: below(draw, vertices), bounds: below(draw, bounds), ..input }
}

/// Both sections as far up as they go.
fn top(draw: &mut Draw) -> In {
    let input = random(draw);
    let (vertices, bounds) = before(&input);
    In { vertices: U::new(LAST - vertices), bounds: U::new(LAST - bounds), ..input }
}

fn first_tree(draw: &mut Draw) -> In {
    In { tree: U::ZERO, ..random(draw) }
}

fn legal(i: &In) -> bool {
    let (vertices, bounds) = before(i);
    i.levels.get() <= 10 && i.vertices.get() + vertices <= LAST && i.bounds.get() + bounds <= LAST
}

type Is = Category<TreeBase>;

/// For hardware of so many levels.
pub fn suite(levels: u64) -> Suite<TreeBase> {
    Suite::new(
        legal,
        vec![
            Is::any("random", random),
            Is::all("top of memory", top, |_, o| o.vertices.get() == LAST && o.bounds.get() == LAST),
            Is::all("first tree", first_tree, |i, o| o.vertices == i.vertices && o.bounds == i.bounds),
        ],
        vec![
            ("N = 0: no lines", |i, o| i.levels.get() == 0 && i.tree.get() > 0 && o.vertices == i.vertices && o.bounds == i.bounds),
            ("N = 1, exact: no bounds", |i, o| i.levels.get() == 1 && i.tree.get() > 0 && o.vertices != i.vertices && o.bounds == i.bounds),
            ("N = 1, compact: no lines", |i, o| {
                i.levels.get() == 1 && i.compact && i.tree.get() > 0 && o.vertices == i.vertices && o.bounds == i.bounds
            }),
            ("the largest tree", |i, _| i.tree == U::MAX),
        ],
        vec![("N, in both forms", 0..=2 * levels + 1, |i, _| 2 * i.levels.get() + u64::from(i.compact))],
    )
}

#[test]
fn free_running() {
    suite(u64::from(MAX_LEVELS)).run(Mode::Free);
}

#[test]
fn stalled() {
    suite(u64::from(MAX_LEVELS)).run(Mode::Stalled);
}
