//! Addresses of records.

use crate::draw::Draw;
use crate::suite::{Category, Suite};
use lodray::block::Block;
use lodray::block::node_address::{In, NodeAddress};
use lodray::num::{MAX_LEVELS, U};
use tb::Mode;

/// Line of a record, from its section's first.
fn line(i: &In) -> u64 {
    let record = ((1 << (2 * i.level.get())) - 1) / 3 + i.index.get();
    match (i.pair, i.halves) {
        (true, _) => 2 * record + u64::from(i.half),
        (false, true) => (record - 1) / 2,
        (false, false) => record,
    }
}

/// With a base that leaves room for it.
fn based(draw: &mut Draw, record: In) -> In {
    let most = U::<36>::MAX.get() - record.first.get() - line(&record);
    In { base: U::new(draw.bits::<36>().get().min(most)), ..record }
}

fn record(draw: &mut Draw) -> In {
    let pair = draw.once_in(2);
    let record = In { index: draw.bits(), pair, half: pair && draw.once_in(2), ..In::default() };
    based(draw, record)
}

fn node(draw: &mut Draw) -> In {
    let level = draw.below(draw.levels);
    let index = if draw.once_in(4) { (1 << (2 * level)) - 1 } else { draw.below(1 << (2 * level)) };
    let first = if draw.once_in(4) { U::MAX } else { draw.bits() };
    let node = In { first, level: U::new(level), index: U::new(index), ..record(draw) };
    based(draw, node)
}

/// Below the root a node may have half a line.
fn half_a_line(draw: &mut Draw) -> In {
    let node = loop {
        let node = node(draw);
        if node.level > U::ZERO {
            break node;
        }
    };
    based(draw, In { pair: false, halves: true, half: false, ..node })
}

fn any_level(draw: &mut Draw) -> In {
    let level = draw.below(draw.levels);
    let node = In { first: draw.bits(), level: U::new(level), ..record(draw) };
    let halves = level > 0 && !node.pair && draw.once_in(2);
    based(draw, In { halves, ..node })
}

fn top(draw: &mut Draw) -> In {
    let record = any_level(draw);
    In { base: U::new(U::<36>::MAX.get() - record.first.get() - line(&record)), ..record }
}

fn bottom(draw: &mut Draw) -> In {
    In { base: U::ZERO, ..any_level(draw) }
}

fn legal(i: &In) -> bool {
    i.level.get() <= 9
        && (i.pair || !i.half)
        && (!i.halves || (!i.pair && i.level > U::ZERO))
        && i.base.get() + i.first.get() + line(i) <= U::<36>::MAX.get()
}

type Is = Category<NodeAddress>;

/// For hardware of so many levels.
pub fn suite(levels: u64) -> Suite<NodeAddress> {
    Suite::new(
        legal,
        vec![
            Is::any("records", record),
            Is::any("nodes of trees", node),
            Is::all("two nodes in a line", half_a_line, |i, o| NodeAddress::eval(&In { index: U::new(i.index.get() ^ 1), ..*i }) == *o),
            Is::any("every index on every level", any_level),
            Is::all("top of memory", top, |_, o| o.address == U::MAX),
            Is::all("bottom of memory", bottom, |i, o| o.address.get() == i.first.get() + line(i)),
        ],
        vec![
            ("largest index", |i, _| i.index == U::MAX),
            ("largest tree", |i, _| i.first == U::MAX),
            ("address 0", |_, o| o.address == U::ZERO),
        ],
        vec![
            ("level", 0..=levels - 1, |i, _| i.level.get()),
            (
                "one line, first and second of two, half a line",
                0..=3,
                |i, _| if i.halves { 3 } else { u64::from(i.pair) + u64::from(i.half) },
            ),
        ],
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
