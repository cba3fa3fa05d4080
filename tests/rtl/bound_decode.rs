//! Displacement bounds from their codes.

use crate::draw::Draw;
use crate::suite::{Category, Suite};
use lodray::block::bound_decode::{BoundDecode, In};
use lodray::num::{LARGEST_BOUND, U, bound_scale};
use tb::Mode;

fn random(draw: &mut Draw) -> In {
    In { code: U::new(draw.below(1024)), scale: draw.scale() }
}

fn no_code(draw: &mut Draw) -> In {
    In { code: U::ZERO, ..random(draw) }
}

fn largest_code(draw: &mut Draw) -> In {
    In { code: U::MAX, ..random(draw) }
}

fn no_bounds(draw: &mut Draw) -> In {
    In { scale: bound_scale(0), ..random(draw) }
}

fn small_bounds(draw: &mut Draw) -> In {
    In { code: draw.bits(), scale: bound_scale(1 + draw.below(3)) }
}

fn largest_bounds(draw: &mut Draw) -> In {
    In { code: U::new(1023 - draw.below(4)), scale: bound_scale(LARGEST_BOUND - draw.below(2)) }
}

/// Where a scale takes one bit more: around 1023^2 2^k.
fn scale_steps(draw: &mut Draw) -> In {
    let largest = ((1023u64 * 1023) << draw.below(13)).wrapping_add_signed(draw.beside());
    In { code: draw.bits(), scale: bound_scale(largest.min(LARGEST_BOUND)) }
}

/// What `bound_scale` gives: a mantissa of all its 18 bits unless its own rounding up has just passed a power of two, and no bound of 34 bits.
fn legal(i: &In) -> bool {
    let (mantissa, shift) = (i.scale.mantissa.get(), i.scale.shift.get());
    if mantissa == 0 { shift == 0 } else { mantissa >= 1 << 17 && (1023 * 1023 * mantissa) >> shift < 1 << 33 }
}

type Is = Category<BoundDecode>;

pub fn suite() -> Suite<BoundDecode> {
    Suite::new(
        legal,
        vec![
            Is::any("random", random),
            Is::all("code 0", no_code, |_, o| o.h.get() == 0),
            Is::all("largest code", largest_code, |i, _| i.code.get() == 1023),
            Is::all("zero bounds", no_bounds, |_, o| o.h.get() == 0),
            Is::often("bounds of a unit or three", small_bounds, |_, o| o.h.get() <= 1),
            Is::all("the largest bounds", largest_bounds, |_, o| o.h.get() > 1 << 32),
            Is::any("steps of the scale", scale_steps),
        ],
        vec![
            ("a shift that takes all", |i, o| i.code.get() > 0 && i.scale.mantissa.get() > 0 && o.h.get() == 0),
            ("a bound of one unit", |_, o| o.h.get() == 1),
        ],
        vec![(
            "shift, from the largest bound to one unit",
            5..=37,
            |i, _| if i.scale.mantissa.get() == 0 { 5 } else { i.scale.shift.get() },
        )],
    )
}

#[test]
fn free_running() {
    suite().run(Mode::Free);
}

#[test]
fn stalled() {
    suite().run(Mode::Stalled);
}
