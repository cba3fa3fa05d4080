//! Constants of rays from exact starts: the cases of whole points, with fractions of every kind.

use crate::draw::Draw;
use crate::ray_setup;
use crate::suite::{Category, Suite};
use lodray::block::ray_setup::RaySetup;
use lodray::block::start_setup::{In, StartSetup};
use lodray::block::{self, Block, Form};
use lodray::num::{START_BITS, Start, U};
use tb::Build;

/// 31 bits of each coordinate: none, the least, the most, any.
pub fn fraction(draw: &mut Draw) -> [U<START_BITS>; 3] {
    [0; 3].map(|_| match draw.below(8) {
        0 => U::ZERO,
        1 => U::new(1),
        2 => U::MAX,
        _ => draw.bits(),
    })
}

fn of(draw: &mut Draw, block::ray_setup::In { origin, direction }: block::ray_setup::In) -> In {
    In { start: Start { point: origin, fraction: fraction(draw) }, direction }
}

fn any(draw: &mut Draw) -> In {
    let case = ray_setup::any(draw);
    of(draw, case)
}

fn whole(draw: &mut Draw) -> In {
    let i = any(draw);
    In { start: Start { fraction: [U::ZERO; 3], ..i.start }, ..i }
}

/// On steps of box codes, where the fraction decides about ceilings.
fn steps(draw: &mut Draw) -> In {
    let by = draw.beside();
    let case = ray_setup::steps(draw, by);
    of(draw, case)
}

fn extreme(draw: &mut Draw) -> In {
    let case = ray_setup::extreme(draw);
    let start = Start { point: case.origin, fraction: [0; 3].map(|_| if draw.once_in(4) { U::ZERO } else { U::MAX }) };
    In { start, direction: case.direction }
}

fn of_whole(i: &In) -> block::ray_setup::Out {
    RaySetup::eval(&block::ray_setup::In { origin: i.start.point, direction: i.direction })
}

type Is = Category<StartSetup>;

pub fn suite() -> Suite<StartSetup> {
    Suite::new(
        |i| ray_setup::legal(&block::ray_setup::In { origin: i.start.point, direction: i.direction }),
        vec![
            Is::any("any", any),
            Is::all("whole points", whole, |i, o| of_whole(i) == *o),
            Is::any("around steps of box codes", steps),
            Is::any("extremes", extreme),
        ],
        vec![
            ("a ceiling more", |i, o| o.y.ceil.get() == of_whole(i).y.ceil.get() + 1),
            ("the same ceiling though there is a fraction", |i, o| i.start.fraction[2] != U::ZERO && o.z.ceil == of_whole(i).z.ceil),
            ("mirrored on a step", |i, o| {
                o.x.mirror && i.start.fraction[0] != U::ZERO && i.start.point.x.get() & 0xFFFF == 0 && o.x.ceil == of_whole(i).x.ceil
            }),
            ("the most that a fraction adds", |i, o| {
                let whole = of_whole(i).moment.get();
                (0..3).any(|k| (o.moment.get()[k] - whole[k]).abs() > 1 << 29)
            }),
            ("one less by a fraction of a unit", |i, o| o.moment.x.get() == of_whole(i).moment.x.get() - 1),
        ],
        vec![("octant", 0..=7, |_, o| u64::from(o.x.mirror) << 2 | u64::from(o.y.mirror) << 1 | u64::from(o.z.mirror))],
    )
}

/// With so many bits a cycle.
fn of_bits(bits: u32) -> Suite<StartSetup> {
    let timing = StartSetup::timing(&Form { setup_bits: bits, ..Form::FULL });
    Suite { build: Build::block::<StartSetup>().parameter("SETUP_BITS", bits as usize), timing, ..suite() }
}

crate::suite::modes!(three_bits_per_cycle: suite());
crate::suite::modes!(one_bit_per_cycle: of_bits(1));
