//! Addresses of records.

use crate::draw::Draw;
use crate::suite::{Category, Suite};
use lodray::block::node_address::{In, NodeAddress};
use lodray::num::{MAX_LEVELS, U};

/// Line of a record, from its section's first record.
fn line(i: &In) -> u64 {
    let record = (i.start.get() + 4u64.pow(i.level.get() as u32) * i.place.get() + i.index.get()) % (1 << 28);
    2u64.pow(i.scale.get() as u32) * record + i.low.get()
}

/// With a base that leaves room for it.
fn based(draw: &mut Draw, record: In) -> In {
    let most = U::<36>::MAX.get() - line(&record);
    In { base: U::new(draw.bits::<36>().get().min(most)), ..record }
}

fn record(draw: &mut Draw) -> In {
    let scale = draw.below(2);
    let record = In { index: draw.bits(), scale: U::new(scale), low: U::new(draw.below(1 << scale)), ..In::default() };
    based(draw, record)
}

/// Of a level that can have nodes that split.
fn node(draw: &mut Draw) -> In {
    let level = draw.below(draw.levels);
    let index = if draw.once_in(4) { (1 << (2 * level)) - 1 } else { draw.below(1 << (2 * level)) };
    let place = draw.below((1 << 28) >> (2 * level));
    let room = (1 << 28) - (place << (2 * level)) - index;
    let node = In { start: U::new(draw.below(room)), place: U::new(place), level: U::new(level), index: U::new(index), ..record(draw) };
    based(draw, node)
}

/// What no scene has: sums wrap.
fn anything(draw: &mut Draw) -> In {
    let level = draw.below(draw.levels);
    let index = U::new(draw.below(1 << (2 * level)));
    let record = In { start: draw.bits(), place: draw.bits(), level: U::new(level), index, ..record(draw) };
    based(draw, record)
}

fn top(draw: &mut Draw) -> In {
    let record = anything(draw);
    In { base: U::new(U::<36>::MAX.get() - line(&record)), ..record }
}

fn bottom(draw: &mut Draw) -> In {
    In { base: U::ZERO, ..anything(draw) }
}

fn legal(i: &In) -> bool {
    i.level.get() <= 9
        && (i.place == U::ZERO || i.index.get() < 4u64.pow(i.level.get() as u32))
        && i.low.get() < 1 << i.scale.get()
        && i.base.get() + line(i) <= U::<36>::MAX.get()
}

type Is = Category<NodeAddress>;

/// For hardware of so many levels.
pub fn suite(levels: u64) -> Suite<NodeAddress> {
    Suite::new(
        legal,
        vec![
            Is::any("records", record),
            Is::any("nodes of trees", node),
            Is::any("records beyond all scenes", anything),
            Is::all("top of memory", top, |_, o| o.address == U::MAX),
            Is::all("bottom of memory", bottom, |i, o| o.address.get() == line(i)),
        ],
        vec![
            ("largest index", |i, _| i.index == U::MAX),
            ("largest place", |i, _| i.place == U::MAX),
            ("address 0", |_, o| o.address == U::ZERO),
        ],
        vec![("level", 0..=levels - 1, |i, _| i.level.get()), ("line of one or two", 0..=2, |i, _| (1 << i.scale.get()) - 1 + i.low.get())],
    )
}

crate::suite::modes!(suite(u64::from(MAX_LEVELS)));
