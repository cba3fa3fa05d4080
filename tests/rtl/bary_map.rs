use crate::draw::Draw;
use crate::suite::Suite;
use lodray::block::bary_map::{BaryMap, In};
use lodray::num::{BARY_ONE, U};

const HALF: u64 = BARY_ONE / 2;

fn at(draw: &mut Draw, b: [u64; 3]) -> In {
    let levels = draw.below(11);
    let [b0, b1, b2] = b.map(U::new);
    let last = (1 << (2 * (10 - levels))) - 1;
    let node = if draw.once_in(4) { last } else { draw.below(last + 1) };
    In { levels: U::new(levels), node: U::new(node), b0, b1, b2 }
}

fn random(draw: &mut Draw) -> In {
    let (x, y) = (draw.below(BARY_ONE + 1), draw.below(BARY_ONE + 1));
    let (low, high) = (x.min(y), x.max(y));
    at(draw, [BARY_ONE - high, high - low, low])
}

/// Around the border between corner and centre triangles.
fn half(draw: &mut Draw) -> In {
    let first = HALF - 1 + draw.below(3);
    let second = if draw.once_in(2) { BARY_ONE - first } else { draw.below(BARY_ONE - first + 1) };
    let mut b = [first, second, BARY_ONE - first - second];
    b.rotate_left(draw.below(3) as usize);
    at(draw, b)
}

fn corner(draw: &mut Draw) -> In {
    let mut b = [BARY_ONE, 0, 0];
    b.rotate_left(draw.below(3) as usize);
    at(draw, b)
}

/// On an edge, and next to it.
fn edge(draw: &mut Draw) -> In {
    let (near, along) = (draw.below(2), draw.below(BARY_ONE));
    let mut b = [near, along, BARY_ONE - near - along];
    b.rotate_left(draw.below(3) as usize);
    at(draw, b)
}

#[test]
fn rtl_equals_rust() {
    Suite::<BaryMap>::new(
        &[("random", random), ("around one half", half), ("at a corner", corner), ("on an edge", edge)],
        &[
            ("N - n = 0", |i, o| i.levels.get() == 0 && o.b0 == i.b0),
            ("ten levels", |i, _| i.levels.get() == 10),
            ("exactly one half", |i, _| [i.b0, i.b1, i.b2].iter().any(|b| b.get() == HALF)),
            ("just above one half", |i, _| [i.b0, i.b1, i.b2].iter().any(|b| b.get() == HALF + 1)),
            ("the last node", |i, _| i.levels.get() == 0 && i.node == U::MAX),
        ],
    )
    .run();
}
