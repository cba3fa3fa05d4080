//! The division of hits, with three bits of a quotient per cycle, two and one.

use crate::draw::Draw;
use crate::suite::{Category, Suite};
use crate::tri_test;
use lodray::block::hit_divide::{HitDivide, In};
use lodray::block::tri_test::TriTest;
use lodray::block::{Block, Form};
use lodray::num::{RayT, U, WU};
use tb::Build;

const ONE: u64 = 1 << 32;

fn of(numerator: u128, denominator: u128) -> In {
    In { numerator: WU::new(numerator), denominator: WU::new(denominator) }
}

fn denominator(draw: &mut Draw) -> u128 {
    draw.wide(96).max(1)
}

fn random(draw: &mut Draw) -> In {
    of(draw.wide(99), denominator(draw))
}

/// Anything that fits: below 8.
fn fitting(draw: &mut Draw) -> In {
    let d = denominator(draw);
    of(draw.wide(99) % (8 * d), d)
}

/// What triangles give: t, and two of the weights.
fn of_triangles(draw: &mut Draw) -> In {
    let o = TriTest::eval(&tri_test::inside(draw));
    let numerator = draw.one_of(&[o.t_num, WU::new(o.v.get()), WU::new(o.w.get())]);
    if o.hit { In { numerator, denominator: o.det } } else { of(0, 1) }
}

/// `whole` times the denominator, plus `by`.
fn multiple(draw: &mut Draw, whole: u128, by: i128) -> In {
    let d = denominator(draw);
    of((whole * d).saturating_add_signed(by), d)
}

/// Numerators around those of exact quotients, which the last bit of the quotient decides.
fn around_exact(draw: &mut Draw, by: i128) -> In {
    let d = draw.wide(64).max(1) << 32;
    let quotient = 1 + (u128::from(draw.bits::<35>().get()) >> 1);
    of(((d >> 32) * quotient).saturating_add_signed(by), d)
}

fn none(draw: &mut Draw) -> In {
    of(0, denominator(draw))
}

fn by_one(draw: &mut Draw) -> In {
    of(u128::from(draw.bits::<4>().get()), 1)
}

fn largest(draw: &mut Draw) -> In {
    let most = WU::<96>::MAX.get();
    of(draw.one_of(&[WU::<99>::MAX.get(), 8 * most, 8 * most - 1, most, most - 1, 1]), most - draw.wide(1))
}

/// The quotient of `around_exact` before its `by`, or one less.
fn is_around(i: &In, q: RayT, by: i128) -> bool {
    let exact = u128::from(q.get() + u64::from(by < 0));
    exact * (i.denominator.get() >> 32) == i.numerator.get().saturating_add_signed(-by)
}

/// Operands of any of the cases.
pub fn any(draw: &mut Draw) -> In {
    match draw.below(10) {
        0 => random(draw),
        1 => fitting(draw),
        2 => of_triangles(draw),
        3 => multiple(draw, 8, -1),
        4 => multiple(draw, 8, 1),
        5 => multiple(draw, 1, 0),
        6 => around_exact(draw, 0),
        7 => around_exact(draw, -1),
        8 => by_one(draw),
        _ => largest(draw),
    }
}

type Is = Category<HitDivide>;

pub fn suite() -> Suite<HitDivide> {
    Suite::new(
        |i| i.denominator.get() > 0,
        vec![
            Is::any("random", random),
            Is::all("below 8", fitting, |i, _| i.numerator.get() < 8 * i.denominator.get()),
            Is::often("of triangles", of_triangles, |_, o| o.quotient.get() > 0),
            Is::all("exactly 8: saturated", |d| multiple(d, 8, 0), |_, o| o.quotient == U::MAX),
            Is::all("just below 8", |d| multiple(d, 8, -1), |i, o| o.quotient == U::MAX || i.denominator.get() < 1 << 32),
            Is::all("just above 8", |d| multiple(d, 8, 1), |_, o| o.quotient == U::MAX),
            Is::all("exactly one", |d| multiple(d, 1, 0), |_, o| o.quotient.get() == ONE),
            Is::all("just below one", |d| multiple(d, 1, -1), |_, o| o.quotient.get() < ONE),
            Is::all("just above one", |d| multiple(d, 1, 1), |_, o| o.quotient.get() >= ONE),
            Is::all("exact quotient", |d| around_exact(d, 0), |i, o| is_around(i, o.quotient, 0)),
            Is::all("just below an exact quotient", |d| around_exact(d, -1), |i, o| is_around(i, o.quotient, -1)),
            Is::any("just above an exact quotient", |d| around_exact(d, 1)),
            Is::all("zero", none, |_, o| o.quotient.get() == 0),
            Is::any("denominator one", by_one),
            Is::any("the largest operands", largest),
        ],
        vec![
            ("the largest quotient that fits", |i, o| o.quotient == U::MAX && i.numerator.get() < 8 * i.denominator.get()),
            ("one less than one", |_, o| o.quotient.get() == ONE - 1),
            ("one step", |_, o| o.quotient.get() == 1),
            ("all bits of both", |i, _| i.numerator == WU::MAX && i.denominator == WU::MAX),
        ],
        vec![("whole part", 0..=7, |_, o| o.quotient.get() >> 32)],
    )
}

/// With so many bits a cycle.
fn of_bits(bits: u32) -> Suite<HitDivide> {
    let timing = HitDivide::timing(&Form { divide_bits: bits, ..Form::FULL });
    Suite { build: Build::block::<HitDivide>().parameter("DIVIDE_BITS", bits as usize), timing, ..suite() }
}

crate::suite::modes!(three_bits_per_cycle: suite());
crate::suite::modes!(two_bits_per_cycle: of_bits(2));
crate::suite::modes!(one_bit_per_cycle: of_bits(1));
