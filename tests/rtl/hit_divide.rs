use crate::draw::Draw;
use crate::suite::Suite;
use lodray::block::hit_divide::{HitDivide, In};
use lodray::num::{RayT, WU};

fn of(numerator: u128, denominator: u128) -> In {
    In { numerator: WU::new(numerator), denominator: WU::new(denominator) }
}

fn random(draw: &mut Draw) -> In {
    of(draw.wide(99), draw.wide(96).max(1))
}

/// Quotients of barycentrics: 0 to 1.
fn weights(draw: &mut Draw) -> In {
    let denominator = draw.wide(96).max(1);
    let numerator = match draw.below(4) {
        0 => 0,
        1 => denominator,
        2 => denominator - 1,
        _ => draw.wide(96) % (denominator + 1),
    };
    of(numerator, denominator)
}

/// Around 8, where the quotient no longer fits.
fn saturation(draw: &mut Draw) -> In {
    let denominator = draw.wide(96).max(1);
    of((8 * denominator + draw.wide(2)).saturating_sub(2), denominator)
}

/// Exact quotients, and one unit below and above.
fn exact(draw: &mut Draw) -> In {
    let denominator = draw.wide(64).max(1) << draw.below(32);
    let whole = draw.wide(3);
    of((whole * denominator + draw.wide(1)).saturating_sub(draw.wide(1)), denominator)
}

#[test]
fn rtl_equals_rust() {
    Suite::<HitDivide>::new(
        &[("random", random), ("weights", weights), ("around 8", saturation), ("exact", exact)],
        &[
            ("zero", |i, o| i.numerator.get() == 0 && o.quotient.get() == 0),
            ("saturated", |_, o| o.quotient == RayT::MAX),
            ("the largest that fits", |i, o| o.quotient == RayT::MAX && i.numerator.get() < 8 * i.denominator.get()),
            ("exactly one", |_, o| o.quotient.get() == 1 << 32),
            ("just below one", |_, o| o.quotient.get() == (1 << 32) - 1),
            ("denominator one", |i, _| i.denominator.get() == 1),
            ("largest operands", |i, _| i.denominator == WU::MAX),
        ],
    )
    .run();
}
