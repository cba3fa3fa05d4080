//! Displacement bounds from their codes.

use crate::draw::Draw;
use crate::suite::{Category, Suite};
use lodray::block::bound_decode::{BoundDecode, In};
use lodray::num::{BoundScale, MAX_BOUND_OFFSET, U};

fn random(draw: &mut Draw) -> In {
    In { code: U::new(draw.below(256)), scale: draw.scale() }
}

fn with_offset(draw: &mut Draw, offset: u64) -> In {
    In { code: draw.bits(), scale: BoundScale { offset: U::new(offset) } }
}

fn no_code(draw: &mut Draw) -> In {
    In { code: U::ZERO, ..random(draw) }
}

fn largest_code(draw: &mut Draw) -> In {
    In { code: U::MAX, ..random(draw) }
}

fn small_bounds(draw: &mut Draw) -> In {
    In { code: U::new(draw.below(32)), ..with_offset(draw, 0) }
}

fn largest_bounds(draw: &mut Draw) -> In {
    In { code: U::new(255 - draw.below(4)), ..with_offset(draw, MAX_BOUND_OFFSET) }
}

/// Around a power of two: the last part of an octave or the first of the next.
fn octaves(draw: &mut Draw) -> In {
    let input = random(draw);
    let offset = input.scale.offset.get();
    let k = 16 * (offset / 16 + 1 + draw.below(15));
    In { code: U::new((k - offset - draw.below(2)).max(1)), ..input }
}

/// Code + offset.
fn sum(i: &In) -> u64 {
    i.code.get() + i.scale.offset.get()
}

fn legal(i: &In) -> bool {
    i.scale.offset.get() <= MAX_BOUND_OFFSET
}

type Is = Category<BoundDecode>;

pub fn suite() -> Suite<BoundDecode> {
    Suite::new(
        legal,
        vec![
            Is::any("random", random),
            Is::all("code 0", no_code, |_, o| o.h.get() == 0),
            Is::all("largest code", largest_code, |i, _| i.code.get() == 255),
            Is::all("smallest offset", |d| with_offset(d, 0), |_, o| o.h.get() < 1 << 16),
            Is::often("bounds of a unit or three", small_bounds, |_, o| o.h.get() <= 3),
            Is::all("the largest bounds", largest_bounds, |_, o| o.h.get() > 1 << 32),
            Is::often("whole octaves", octaves, |i, o| o.h.get() == 1 << (sum(i) >> 4)),
        ],
        vec![
            ("a bound of one unit", |_, o| o.h.get() == 1),
            ("the largest bound there is", |_, o| o.h.get() == 491 << 24),
            ("the largest offset, no bound", |i, o| i.scale.offset.get() == MAX_BOUND_OFFSET && o.h.get() == 0),
        ],
        vec![("octave", 0..=32, |i, _| sum(i) >> 4), ("part of an octave", 0..=15, |i, _| sum(i) & 15)],
    )
}

crate::suite::modes!(suite());
