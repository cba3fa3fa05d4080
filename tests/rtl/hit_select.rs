use crate::draw::Draw;
use crate::suite::Suite;
use lodray::block::hit_select::{HitSelect, In};
use lodray::num::U;

fn node(draw: &mut Draw) -> In {
    let levels = draw.below(11);
    let level = draw.below(levels + 1);
    let node = if draw.once_in(4) { (1 << (2 * level)) - 1 } else { draw.below(1 << (2 * level)) };
    In {
        levels: U::new(levels),
        known: !draw.once_in(4),
        best_t: draw.bits(),
        best_id: draw.bits(),
        t: draw.bits(),
        tree: draw.bits(),
        level: U::new(level),
        node: U::new(node),
    }
}

fn equal_t(draw: &mut Draw) -> In {
    let input = node(draw);
    In { best_t: input.t, ..input }
}

/// The same triangle, and its neighbours by number.
fn equal_id(draw: &mut Draw) -> In {
    let input = equal_t(draw);
    let (levels, level) = (input.levels.get(), input.level.get());
    let id = input.tree.get() << (2 * levels) | input.node.get() << (2 * (levels - level));
    In { best_id: U::new((id + draw.below(3)).saturating_sub(1).min(U::<48>::MAX.get())), ..input }
}

fn one_apart(draw: &mut Draw) -> In {
    let input = equal_id(draw);
    In { best_t: U::new((input.t.get() + draw.below(3)).saturating_sub(1).min(U::<35>::MAX.get())), ..input }
}

#[test]
fn rtl_equals_rust() {
    Suite::<HitSelect>::new(
        &[("random", node), ("equal t", equal_t), ("equal t and id", equal_id), ("t one apart", one_apart)],
        &[
            ("first hit", |i, o| !i.known && o.closer),
            ("same triangle again", |i, o| i.known && i.t == i.best_t && o.id == i.best_id && !o.closer),
            ("smaller id at equal t", |i, o| i.known && i.t == i.best_t && o.closer),
            ("N = 0", |i, _| i.levels.get() == 0),
            ("N = 10 at level 10", |i, _| i.level.get() == 10),
            ("N = 10 at level 0", |i, _| i.levels.get() == 10 && i.level.get() == 0),
        ],
    )
    .run();
}
