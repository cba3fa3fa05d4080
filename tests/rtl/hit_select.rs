//! The closest hit.

use crate::draw::Draw;
use crate::suite::{Category, Suite};
use lodray::block::hit_select::{HitSelect, In};
use lodray::num::{MAX_LEVELS, U};

/// Bits of the ids that the hardware has: 28 of the tree and two of each level.
fn id_bits(draw: &Draw) -> u64 {
    28 + 2 * draw.levels
}

fn random(draw: &mut Draw) -> In {
    let best_id = draw.bits::<48>().get() & ((1 << id_bits(draw)) - 1);
    let levels = draw.below(draw.levels + 1);
    let level = draw.below(levels + 1);
    let node = if draw.once_in(4) { (1 << (2 * level)) - 1 } else { draw.below(1 << (2 * level)) };
    In {
        levels: U::new(levels),
        known: !draw.once_in(4),
        best_t: draw.bits(),
        best_front: draw.once_in(2),
        best_id: U::new(best_id),
        t: draw.bits(),
        front: draw.once_in(2),
        tree: draw.bits(),
        level: U::new(level),
        node: U::new(node),
    }
}

fn first(draw: &mut Draw) -> In {
    In { known: false, best_t: U::ZERO, best_front: true, best_id: U::ZERO, ..random(draw) }
}

/// A best hit of this t and of the same side, and of the id of the new one plus `by`.
fn near(draw: &mut Draw, t: i64, by: i64) -> In {
    let input = random(draw);
    let (levels, level) = (input.levels.get(), input.level.get());
    let id = input.tree.get() << (2 * levels) | input.node.get() << (2 * (levels - level));
    let best_id = id.saturating_add_signed(by).min((1 << id_bits(draw)) - 1);
    // Away from both ends, so that one more and one less exist.
    let t_new = input.t.get().clamp(1, U::<35>::MAX.get() - 1);
    let best_t = U::new(t_new.saturating_add_signed(t));
    In { known: true, t: U::new(t_new), best_t, best_front: input.front, best_id: U::new(best_id), ..input }
}

/// The same of another side: the new one is on a front face if `front`.
fn across(draw: &mut Draw, front: bool, t: i64, by: i64) -> In {
    In { front, best_front: !front, ..near(draw, t, by) }
}

/// The best hit is on an ancestor or a descendant that begins with the same full-resolution triangle: the same id.
fn relative(draw: &mut Draw) -> In {
    let input = random(draw);
    let (levels, level) = (input.levels.get(), draw.below(input.levels.get() + 1));
    let best_id = U::new(input.tree.get() << (2 * levels));
    In { known: true, best_t: input.t, best_front: input.front, best_id, node: U::ZERO, level: U::new(level), ..input }
}

/// The last triangle of all.
fn last(draw: &mut Draw) -> In {
    let levels = U::new(draw.levels);
    In { levels, level: levels, tree: U::MAX, node: U::new((1 << (2 * draw.levels)) - 1), ..random(draw) }
}

fn legal(i: &In) -> bool {
    i.levels.get() <= 10 && i.level <= i.levels && i.node.get() < 1 << (2 * i.level.get())
}

type Is = Category<HitSelect>;

/// For hardware of so many levels.
pub fn suite(levels: u64) -> Suite<HitSelect> {
    Suite::new(
        legal,
        vec![
            Is::any("random", random),
            Is::all("first hit", first, |_, o| o.closer),
            Is::all("equal t and id", |d| near(d, 0, 0), |i, o| i.best_id == o.id && !o.closer),
            Is::all("equal t, larger id so far", |d| near(d, 0, 1), |i, o| o.closer == (i.best_id > o.id)),
            Is::all("equal t, smaller id so far", |d| near(d, 0, -1), |_, o| !o.closer),
            Is::all("t one step smaller, smaller id so far", |d| near(d, 1, -1), |_, o| o.closer),
            Is::all("t one step larger, larger id so far", |d| near(d, -1, 1), |_, o| !o.closer),
            Is::all("equal t, front after back, larger id so far", |d| across(d, true, 0, 1), |_, o| o.closer),
            Is::all("equal t, front after back, smaller id so far", |d| across(d, true, 0, -1), |_, o| o.closer),
            Is::all("equal t, back after front, larger id so far", |d| across(d, false, 0, 1), |_, o| !o.closer),
            Is::all("equal t, back after front, smaller id so far", |d| across(d, false, 0, -1), |_, o| !o.closer),
            Is::all("back after front, t one step smaller", |d| across(d, false, 1, -1), |_, o| o.closer),
            Is::all("front after back, t one step larger", |d| across(d, true, -1, 1), |_, o| !o.closer),
            Is::all("the largest id", last, |i, o| o.id.get() + 1 == 1 << (28 + 2 * i.levels.get())),
            Is::all("the same triangle on another level", relative, |i, o| i.best_id == o.id && !o.closer),
        ],
        vec![
            ("smaller id at equal t", |i, o| i.known && i.t == i.best_t && i.front == i.best_front && o.closer),
            ("another side at equal t", |i, o| i.known && i.t == i.best_t && o.closer == (i.front && !i.best_front)),
            ("the largest t", |i, o| i.t == U::MAX && !o.closer),
        ],
        vec![
            ("N", 0..=levels, |i, _| i.levels.get()),
            ("level", 0..=levels, |i, _| i.level.get()),
            ("closer", 0..=1, |_, o| o.closer.into()),
        ],
    )
}

crate::suite::modes!(suite(u64::from(MAX_LEVELS)));
