use crate::draw::{DIRECTION_MAX, Draw, POINT_MAX};
use crate::suite::Suite;
use lodray::block::ray_setup::{In, RaySetup};
use lodray::num::{Direction, Point};

fn random(draw: &mut Draw) -> In {
    In { origin: draw.point(POINT_MAX), direction: draw.direction() }
}

fn axis_parallel(draw: &mut Draw) -> In {
    In { origin: draw.point(POINT_MAX), direction: draw.axis_parallel() }
}

/// Components that are powers of two, or one beside.
fn powers(draw: &mut Draw) -> In {
    let mut component = || {
        let v = ((1i64 << draw.below(30)) + draw.below(3).cast_signed() - 1).min(DIRECTION_MAX);
        if draw.once_in(2) { v } else { -v }
    };
    let direction = Direction::new(component(), component(), component());
    In { origin: draw.point(POINT_MAX), direction }
}

/// Origins on steps of box codes, or one beside.
fn steps(draw: &mut Draw) -> In {
    let [x, y, z] = [0; 3].map(|_| ((draw.signed(32767) << 16) + draw.below(3).cast_signed() - 1).clamp(-POINT_MAX, POINT_MAX));
    In { origin: Point::new(x, y, z), direction: draw.direction() }
}

#[test]
fn rtl_equals_rust() {
    Suite::<RaySetup>::new(
        &[("random", random), ("axis-parallel", axis_parallel), ("powers of two", powers), ("steps of box codes", steps)],
        &[
            ("zero component", |i, o| i.direction.x.get() == 0 && o.x.reciprocal.mantissa.get() == 0),
            ("all components zero", |i, _| i.direction.get() == [0; 3]),
            ("extreme components", |i, _| i.direction.get().contains(&DIRECTION_MAX)),
            ("held reciprocal", |i, o| i.direction.y.get() == 1 && o.y.reciprocal.shift.get() == 0),
            ("largest shift", |_, o| o.z.reciprocal.shift.get() == 17),
            ("mirrored", |_, o| o.x.mirror && o.y.mirror && o.z.mirror),
            ("largest moment", |_, o| o.moment.get().iter().any(|m| m.abs() > 1 << 61)),
        ],
    )
    .run();
}
