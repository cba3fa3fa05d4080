//! Blocks of hardware that leaves out low bits which are 0: inputs of all their categories without these bits.

use crate::suite::{Coarsen, Suite};
use crate::{box_test, child_test, lod_test, tri_test};
use lodray::block::ray_setup::{self, Axis};
use lodray::block::{self, Block};
use lodray::num::{Direction, Point, U, Vec3};
use lodray_test_support::hardware::NARROWS;
use std::fmt::Debug;
use tb::Mode;

const TRANSACTIONS: u64 = 200_000;

fn play<B: Block>(suite: impl Fn() -> Suite<B>, coarsen: Coarsen<B>)
where
    B::In: Debug,
    B::Out: Debug,
{
    for hardware in NARROWS {
        let suite = suite().of(hardware).coarsened(coarsen);
        suite.run_some(Mode::Free, TRANSACTIONS);
        suite.run_some(Mode::Stalled, TRANSACTIONS);
    }
}

fn cut(v: i64, zeros: u32) -> i64 {
    v >> zeros << zeros
}

fn point(p: Point, zeros: [u32; 2]) -> Point {
    let [x, y, z] = p.get().map(|v| cut(v, zeros[0]));
    Point::new(x, y, z)
}

fn direction(d: Direction, zeros: [u32; 2]) -> Direction {
    // Towards zero: -2^30 is no component.
    let [x, y, z] = d.get().map(|v| v.signum() * cut(v.abs(), zeros[1]));
    Direction::new(x, y, z)
}

fn setup(ray: ray_setup::Out, zeros: [u32; 2]) -> ray_setup::Out {
    let axis = |a: Axis| Axis { d: U::new(a.d.get() >> zeros[1] << zeros[1]), ..a };
    let [x, y, z] = ray.moment.get().map(|v| cut(v, zeros[0] + zeros[1]));
    ray_setup::Out { x: axis(ray.x), y: axis(ray.y), z: axis(ray.z), moment: Vec3::new(x, y, z) }
}

#[test]
fn triangles() {
    play(tri_test::suite, |i, zeros| block::tri_test::In {
        origin: point(i.origin, zeros),
        direction: direction(i.direction, zeros),
        p0: point(i.p0, zeros),
        p1: point(i.p1, zeros),
        p2: point(i.p2, zeros),
    });
}

#[test]
fn levels_of_detail() {
    play(lod_test::suite, |mut i, zeros| {
        (i.ray.origin, i.ray.direction) = (point(i.ray.origin, zeros), direction(i.ray.direction, zeros));
        [i.p0, i.p1, i.p2] = [i.p0, i.p1, i.p2].map(|p| point(p, zeros));
        i
    });
}

#[test]
fn boxes() {
    play(box_test::suite, |i, zeros| block::box_test::In { ray: setup(i.ray, zeros), ..i });
    play(child_test::suite, |i, zeros| block::child_test::In { ray: setup(i.ray, zeros), ..i });
}
