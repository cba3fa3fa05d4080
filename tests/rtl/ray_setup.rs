//! Constants of rays, with three bits of each reciprocal per cycle, two and one.

use crate::draw::{DIRECTION_MAX, Draw, POINT_MAX};
use crate::rays::{direction, has_components, is_point, point};
use crate::suite::{Category, Suite};
use lodray::block::ray_setup::{In, RaySetup};
use lodray::block::{Block, Form};
use lodray::num::Direction;
use tb::Build;

fn with(draw: &mut Draw, direction: Direction) -> In {
    In { origin: draw.point(POINT_MAX), direction }
}

fn random(draw: &mut Draw) -> In {
    let d = draw.components();
    with(draw, d)
}

fn of_a_frame(draw: &mut Draw) -> In {
    let d = draw.full_direction();
    with(draw, d)
}

fn axis_parallel(draw: &mut Draw) -> In {
    let d = draw.axis_parallel();
    with(draw, d)
}

fn plane_parallel(draw: &mut Draw) -> In {
    let d = draw.plane_parallel();
    with(draw, d)
}

fn none(draw: &mut Draw) -> In {
    with(draw, Direction::default())
}

/// Components of every number of bits: powers of two plus `by`, of both signs.
fn powers(draw: &mut Draw, by: i64) -> In {
    let d = [0; 3].map(|_| {
        let power = 1i64 << draw.below(30);
        draw.sign((power + by).min(DIRECTION_MAX))
    });
    with(draw, direction(d))
}

/// Where the quotient just takes 18 bits or just does not: 2^(30+k) / 2^18, and the components around it.
fn quotient_steps(draw: &mut Draw) -> In {
    let d = [0; 3].map(|_| {
        let mantissa = draw.between((1 << 17) - 2, (1 << 18) - 1);
        let v = (1i64 << (30 + draw.below(18))) / mantissa + draw.beside();
        draw.sign(v.clamp(0, DIRECTION_MAX))
    });
    with(draw, direction(d))
}

/// Origins on steps of box codes, plus `by`.
pub fn steps(draw: &mut Draw, by: i64) -> In {
    let origin = point([0; 3].map(|_| ((draw.signed(32767) << 16) + by).clamp(-POINT_MAX, POINT_MAX)));
    In { origin, direction: draw.components() }
}

pub fn extreme(draw: &mut Draw) -> In {
    In { origin: point(draw.corner()), direction: direction([DIRECTION_MAX; 3].map(|v| draw.sign(v))) }
}

/// A ray of any of the cases.
pub fn any(draw: &mut Draw) -> In {
    match draw.below(12) {
        0 => random(draw),
        1 => of_a_frame(draw),
        2 => axis_parallel(draw),
        3 => plane_parallel(draw),
        4 => none(draw),
        5 => powers(draw, 0),
        6 => powers(draw, 1),
        7 => powers(draw, -1),
        8 => quotient_steps(draw),
        9 => steps(draw, 0),
        10 => steps(draw, 1),
        _ => extreme(draw),
    }
}

pub fn legal(i: &In) -> bool {
    is_point(i.origin) && has_components(i.direction)
}

type Is = Category<RaySetup>;

pub fn suite() -> Suite<RaySetup> {
    Suite::new(
        legal,
        vec![
            Is::any("random", random),
            Is::any("rays of a frame", of_a_frame),
            Is::all("axis-parallel", axis_parallel, |i, _| i.direction.get().iter().filter(|v| **v == 0).count() == 2),
            Is::all("parallel to a plane", plane_parallel, |i, _| i.direction.get().contains(&0)),
            Is::all("no direction", none, |_, o| {
                [o.x, o.y, o.z].iter().all(|a| a.reciprocal.mantissa.get() == 0) && o.moment.get() == [0; 3]
            }),
            Is::any("powers of two", |d| powers(d, 0)),
            Is::any("just above powers of two", |d| powers(d, 1)),
            Is::any("just below powers of two", |d| powers(d, -1)),
            Is::any("steps of the reciprocal", quotient_steps),
            Is::any("origins on steps of box codes", |d| steps(d, 0)),
            Is::any("just above steps", |d| steps(d, 1)),
            Is::any("just below steps", |d| steps(d, -1)),
            Is::all("extremes", extreme, |_, o| o.moment.get().iter().all(|m| *m == 0 || m.abs() > 1 << 61)),
        ],
        vec![
            ("zero component", |i, o| i.direction.x.get() == 0 && i.direction.y.get() != 0 && o.x.reciprocal.mantissa.get() == 0),
            ("held reciprocal", |i, o| i.direction.y.get() == 1 && o.y.reciprocal.shift.get() == 0),
            ("largest moment", |_, o| o.moment.get().iter().any(|m| m.abs() > 1 << 61)),
        ],
        vec![
            ("octant", 0..=7, |_, o| u64::from(o.x.mirror) << 2 | u64::from(o.y.mirror) << 1 | u64::from(o.z.mirror)),
            ("shift of x", 0..=17, |_, o| o.x.reciprocal.shift.get()),
            ("shift of z", 0..=17, |_, o| o.z.reciprocal.shift.get()),
        ],
    )
}

/// With so many bits a cycle.
fn of_bits(bits: u32) -> Suite<RaySetup> {
    let timing = RaySetup::timing(&Form { setup_bits: bits, ..Form::FULL });
    Suite { build: Build::block::<RaySetup>().parameter("SETUP_BITS", bits as usize), timing, ..suite() }
}

crate::suite::modes!(three_bits_per_cycle: suite());
crate::suite::modes!(two_bits_per_cycle: of_bits(2));
crate::suite::modes!(one_bit_per_cycle: of_bits(1));
