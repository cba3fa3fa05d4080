use crate::draw::Draw;
use crate::suite::Suite;
use lodray::block::node_address::{In, NodeAddress};
use lodray::num::U;

fn record(draw: &mut Draw) -> In {
    let pair = draw.once_in(2);
    In { base: U::new(draw.bits::<35>().get()), level: U::ZERO, index: draw.bits(), pair, half: pair && draw.once_in(2) }
}

fn node(draw: &mut Draw) -> In {
    let level = draw.below(10);
    let index = if draw.once_in(4) { (1 << (2 * level)) - 1 } else { draw.below(1 << (2 * level)) };
    In { level: U::new(level), index: U::new(index), ..record(draw) }
}

/// The last line there is.
fn top(draw: &mut Draw) -> In {
    let input = record(draw);
    let line = if input.pair { 2 * input.index.get() + u64::from(input.half) } else { input.index.get() };
    In { base: U::new(U::<36>::MAX.get() - line), ..input }
}

#[test]
fn rtl_equals_rust() {
    Suite::<NodeAddress>::new(
        &[("records", record), ("nodes of trees", node), ("top of memory", top)],
        &[
            ("level 9", |i, _| i.level.get() == 9),
            ("second halves", |i, _| i.half),
            ("the last line", |_, o| o.address == U::MAX),
            ("largest index", |i, _| i.index == U::MAX),
        ],
    )
    .run();
}
