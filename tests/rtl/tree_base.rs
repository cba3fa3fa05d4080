use crate::draw::Draw;
use crate::suite::Suite;
use lodray::block::tree_base::{In, TreeBase};
use lodray::num::U;

/// Lines of a tree's vertex data.
fn lines(levels: u64) -> u64 {
    ((1 << (2 * levels)) - 1) / 3
}

/// As many trees as 2^35 lines hold.
fn random(draw: &mut Draw) -> In {
    let levels = draw.below(11);
    let most = ((1u64 << 35) / lines(levels).max(1)).min((1 << 28) - 1);
    let tree = match draw.below(4) {
        0 => most,
        1 => draw.bits::<28>().get().min(most),
        _ => draw.below(most + 1),
    };
    In { levels: U::new(levels), tree: U::new(tree), vertices: U::new(draw.bits::<34>().get()), bounds: U::new(draw.bits::<34>().get()) }
}

/// Both sections as far up as they go.
fn top(draw: &mut Draw) -> In {
    let input = random(draw);
    let (levels, tree) = (input.levels.get(), input.tree.get());
    let groups = if levels == 0 { 0 } else { lines(levels - 1) };
    let last = U::<36>::MAX.get();
    In { vertices: U::new(last - tree * lines(levels)), bounds: U::new(last - 2 * tree * groups), ..input }
}

#[test]
fn rtl_equals_rust() {
    Suite::<TreeBase>::new(
        &[("random", random), ("top of memory", top)],
        &[
            ("N = 0", |i, o| i.levels.get() == 0 && o.vertices == i.vertices && o.bounds == i.bounds),
            ("N = 1", |i, o| i.levels.get() == 1 && o.bounds == i.bounds),
            ("N = 10", |i, _| i.levels.get() == 10 && i.tree.get() > 0),
            ("largest tree", |i, _| i.tree == U::MAX),
            ("the last line", |_, o| o.vertices == U::MAX && o.bounds == U::MAX),
        ],
    )
    .run();
}
