//! Hit mapping down the levels.

use crate::draw::Draw;
use crate::suite::{Category, Suite};
use lodray::block::Block;
use lodray::block::bary_map::{BaryMap, In, Out};
use lodray::num::{BARY_ONE, MAX_LEVELS, U};

const HALF: u64 = BARY_ONE / 2;

/// A hit with these weights in any order, on any node of any level, any levels above the last.
fn at(draw: &mut Draw, b: [u64; 3]) -> In {
    let levels = draw.below(draw.levels + 1);
    let mut b = b.map(U::new);
    b.rotate_left(draw.below(3) as usize);
    if draw.once_in(2) {
        b.swap(0, 1);
    }
    let [b0, b1, b2] = b;
    let nodes = 1 << (2 * (draw.levels - levels));
    let node = match draw.below(4) {
        0 => nodes - 1,
        1 => 0,
        _ => draw.below(nodes),
    };
    In { levels: U::new(levels), node: U::new(node), b0, b1, b2 }
}

fn random(draw: &mut Draw) -> In {
    let (x, y) = (draw.below(BARY_ONE + 1), draw.below(BARY_ONE + 1));
    let (low, high) = (x.min(y), x.max(y));
    at(draw, [BARY_ONE - high, high - low, low])
}

/// One weight exactly one half, or one step beside.
fn around_half(draw: &mut Draw, by: i64) -> In {
    let first = HALF.wrapping_add_signed(by);
    let second = if draw.once_in(2) { BARY_ONE - first } else { draw.below(BARY_ONE - first + 1) };
    at(draw, [first, second, BARY_ONE - first - second])
}

fn corner(draw: &mut Draw) -> In {
    at(draw, [BARY_ONE, 0, 0])
}

fn beside_corner(draw: &mut Draw) -> In {
    at(draw, [BARY_ONE - 1, 1, 0])
}

fn edge(draw: &mut Draw) -> In {
    let along = draw.below(BARY_ONE + 1);
    at(draw, [0, along, BARY_ONE - along])
}

fn centre(draw: &mut Draw) -> In {
    let third = BARY_ONE / 3;
    at(draw, [third, third, BARY_ONE - 2 * third])
}

/// A vertex of one of the next eleven levels: on the way down some weight is one half.
fn lattice(draw: &mut Draw) -> In {
    let step = BARY_ONE >> draw.between(1, 11);
    let (x, y) = (draw.below(BARY_ONE / step + 1), draw.below(BARY_ONE / step + 1));
    let (low, high) = (x.min(y) * step, x.max(y) * step);
    at(draw, [BARY_ONE - high, high - low, low])
}

fn weights(i: &In) -> [u64; 3] {
    [i.b0, i.b1, i.b2].map(U::get)
}

/// Some weight is one half on some level on the way down.
fn meets_half(i: &In) -> bool {
    (0..i.levels.get()).any(|levels| {
        let Out { b0, b1, b2, .. } = BaryMap::eval(&In { levels: U::new(levels), ..*i });
        [b0, b1, b2].map(U::get).contains(&HALF)
    })
}

fn legal(i: &In) -> bool {
    let levels = i.levels.get();
    levels <= 10 && i.node.get() < 1 << (2 * (10 - levels)) && weights(i).iter().sum::<u64>() == BARY_ONE
}

type Is = Category<BaryMap>;

/// For hardware of so many levels.
pub fn suite(levels: u64) -> Suite<BaryMap> {
    Suite::new(
        legal,
        vec![
            Is::any("random", random),
            Is::all("exactly one half", |d| around_half(d, 0), |i, _| weights(i).contains(&HALF)),
            Is::all("just above one half", |d| around_half(d, 1), |i, _| weights(i).contains(&(HALF + 1))),
            Is::all("just below one half", |d| around_half(d, -1), |i, _| weights(i).contains(&(HALF - 1))),
            Is::all("at a corner", corner, |_, o| [o.b0, o.b1, o.b2].map(U::get).contains(&BARY_ONE)),
            Is::any("a step beside a corner", beside_corner),
            Is::all("on an edge", edge, |_, o| [o.b0, o.b1, o.b2].contains(&U::ZERO)),
            Is::any("in the centre", centre),
            Is::some("one half on the way down", lattice, |i, _| meets_half(i)),
        ],
        vec![
            ("the last node of all levels", |i, o| (i.node.get() + 1) << (2 * i.levels.get()) == o.node.get() + 1 && i.levels.get() > 0),
            ("one half on a level below the first", |i, _| !weights(i).contains(&HALF) && i.levels.get() > 1 && meets_half(i)),
        ],
        vec![("N - n", 0..=levels, |i, _| i.levels.get()), ("last child", 0..=3, |_, o| o.node.get() & 3)],
    )
}

crate::suite::modes!(suite(u64::from(MAX_LEVELS)));
