use crate::draw::Draw;
use crate::suite::Suite;
use lodray::block::bound_decode::{BoundDecode, In};
use lodray::num::{LARGEST_BOUND, U, bound_scale};

fn random(draw: &mut Draw) -> In {
    In { code: draw.bits(), scale: bound_scale(draw.bits::<33>().get().min(LARGEST_BOUND)) }
}

/// Scales of the smallest and the largest bounds.
fn extreme(draw: &mut Draw) -> In {
    let largest = [0, 1, 2, (1 << 32) - 1, 1 << 32, LARGEST_BOUND][draw.below(6) as usize];
    In { code: draw.bits(), scale: bound_scale(largest) }
}

/// Where a scale takes one bit more: around 1023^2 2^k.
fn scale_steps(draw: &mut Draw) -> In {
    let largest = (1023u64 * 1023 << draw.below(12)).wrapping_add(draw.below(3)) - 1;
    In { code: U::new(draw.below(1024)), scale: bound_scale(largest.min(LARGEST_BOUND)) }
}

#[test]
fn rtl_equals_rust() {
    Suite::<BoundDecode>::new(
        &[("random", random), ("extreme scales", extreme), ("steps of the scale", scale_steps)],
        &[
            ("code 0", |i, o| i.code.get() == 0 && o.h.get() == 0),
            ("largest code", |i, _| i.code.get() == 1023),
            ("scale 0", |i, o| i.scale.mantissa.get() == 0 && o.h.get() == 0),
            ("a shift that takes all", |i, o| i.code.get() > 0 && i.scale.mantissa.get() > 0 && o.h.get() == 0),
            ("bounds above 2^32", |_, o| o.h.get() > 1 << 32),
        ],
    )
    .run();
}
