//! The division of hits of rays from exact starts: the cases of whole numerators, with what is below them.

use crate::draw::Draw;
use crate::hit_divide;
use crate::suite::{Category, Suite};
use lodray::block::hit_divide::HitDivide;
use lodray::block::start_divide::{In, StartDivide};
use lodray::block::{self, Block, Form};
use lodray::num::{START_BITS, U, WU};
use tb::Build;

fn low(draw: &mut Draw) -> U<START_BITS> {
    match draw.below(4) {
        0 => U::MAX,
        1 => U::new(1 << draw.below(31)),
        _ => draw.bits(),
    }
}

fn any(draw: &mut Draw) -> In {
    let block::hit_divide::In { numerator, denominator } = hit_divide::any(draw);
    In { numerator, low: low(draw), denominator }
}

fn whole(draw: &mut Draw) -> In {
    In { low: U::ZERO, ..any(draw) }
}

/// Small numbers: what is below decides about many bits of the quotient.
fn small(draw: &mut Draw) -> In {
    let d = draw.wide(16).max(1);
    In { numerator: WU::new(draw.wide(20) % (8 * d)), low: low(draw), denominator: WU::new(d) }
}

/// Just at an exact quotient: denominators of 2^31 times as much as the numerator's steps, or one of these steps less.
fn around_exact(draw: &mut Draw, less: u64) -> In {
    // q d = (numerator + low / 2^31) 2^32: with d = 2 e the product q e has 31 bits below whole numbers.
    let (e, q) = (draw.wide(60).max(1), 1 + (u128::from(draw.bits::<34>().get())));
    let steps = (q * e) - u128::from(less);
    let (numerator, low) = (steps >> START_BITS, steps & ((1 << START_BITS) - 1));
    In { numerator: WU::new(numerator), low: U::new(low as u64), denominator: WU::new(2 * e) }
}

/// Just below 8: it saturates nowhere below, however much there is beside whole numbers.
fn most(draw: &mut Draw) -> In {
    let d = draw.wide(96).max(1);
    In { numerator: WU::new(8 * d - 1), low: low(draw), denominator: WU::new(d) }
}

fn of_whole(i: &In) -> u64 {
    HitDivide::eval(&block::hit_divide::In { numerator: i.numerator, denominator: i.denominator }).quotient.get()
}

fn exact(i: &In) -> u128 {
    (i.numerator.get() << START_BITS) + u128::from(i.low.get())
}

type Is = Category<StartDivide>;

pub fn suite() -> Suite<StartDivide> {
    Suite::new(
        |i| i.denominator.get() > 0,
        vec![
            Is::any("any", any),
            Is::all("whole numerators", whole, |i, o| o.quotient.get() == of_whole(i)),
            Is::any("small", small),
            Is::all("exact quotient", |d| around_exact(d, 0), |i, o| u128::from(o.quotient.get()) * (i.denominator.get() / 2) == exact(i)),
            Is::all(
                "just below an exact quotient",
                |d| around_exact(d, 1),
                |i, o| {
                    let e = i.denominator.get() / 2;
                    u128::from(o.quotient.get() + 1) * e == exact(i) + 1
                },
            ),
            Is::any("just below 8", most),
        ],
        vec![
            ("the last bit of the quotient by what is below", |i, o| o.quotient.get() == of_whole(i) + 1),
            ("nearly one more by what is below", |i, o| o.quotient.get() > of_whole(i) + (1 << 31)),
            ("a numerator below 1", |i, o| i.numerator.get() == 0 && o.quotient.get() > 0),
            ("saturated", |i, o| o.quotient == U::MAX && i.numerator.get() >= 8 * i.denominator.get()),
        ],
        vec![("whole part", 0..=7, |_, o| o.quotient.get() >> 32)],
    )
}

/// With so many bits a cycle.
fn of_bits(bits: u32) -> Suite<StartDivide> {
    let timing = StartDivide::timing(&Form { divide_bits: bits, ..Form::FULL });
    Suite { build: Build::block::<StartDivide>().parameter("DIVIDE_BITS", bits as usize), timing, ..suite() }
}

crate::suite::modes!(three_bits_per_cycle: suite());
crate::suite::modes!(two_bits_per_cycle: of_bits(2));
crate::suite::modes!(one_bit_per_cycle: of_bits(1));
