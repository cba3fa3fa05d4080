use crate::draw::{Draw, POINT_MAX};
use crate::suite::Suite;
use lodray::block::Block;
use lodray::block::box_test32::{BoxTest32, In};
use lodray::num::{Direction, Point, RayT, T_NEAR_TO_T_SHIFT, U};

/// Lower and upper corner of a box with |v| <= `max`, often flat.
fn corners(draw: &mut Draw, max: i64) -> (Point, Point) {
    let (a, b) = (draw.point(max).get(), draw.point(max).get());
    let flat = draw.below(6) as usize;
    let [lx, ly, lz] = [0, 1, 2].map(|k| a[k].min(b[k]));
    let [hx, hy, hz] = [0, 1, 2].map(|k| if k == flat { a[k].min(b[k]) } else { a[k].max(b[k]) });
    (Point::new(lx, ly, lz), Point::new(hx, hy, hz))
}

fn random(draw: &mut Draw) -> In {
    let (lo, hi) = corners(draw, POINT_MAX);
    In { ray: draw.setup(), t_max: draw.t_max(), lo, hi }
}

fn aimed(draw: &mut Draw, direction: fn(&mut Draw) -> Direction) -> In {
    let (lo, hi) = corners(draw, 1 << 29);
    let mut target = draw.on_box(lo.get(), hi.get());
    if draw.once_in(2) {
        target[draw.below(3) as usize] += draw.below(3).cast_signed() - 1;
    }
    let d = direction(draw);
    let origin = draw.origin_towards(target, d);
    In { ray: draw.setup_of(origin, d), t_max: RayT::MAX, lo, hi }
}

fn touching(draw: &mut Draw) -> In {
    aimed(draw, Draw::short_direction)
}

fn axis_parallel_touching(draw: &mut Draw) -> In {
    aimed(draw, |draw| {
        let d = draw.axis_parallel().get().map(|v| v >> 2);
        Direction::new(d[0], d[1], d[2])
    })
}

fn t_max_at_entry(draw: &mut Draw) -> In {
    let (lo, hi) = corners(draw, 1 << 29);
    let target = draw.on_box(lo.get(), hi.get());
    let d = draw.axis_parallel().get().map(|v| v / 2 + draw.signed(1 << 28));
    let d = Direction::new(d[0], d[1], d[2]);
    let [x, y, z] = [0, 1, 2].map(|k| (target[k] - 2 * d.get()[k]).clamp(-POINT_MAX, POINT_MAX));
    let open = In { ray: draw.setup_of(Point::new(x, y, z), d), t_max: RayT::MAX, lo, hi };
    let entry = BoxTest32::eval(&open).t_near.get() << T_NEAR_TO_T_SHIFT;
    In { t_max: U::new((entry + draw.below(3)).saturating_sub(1).min(RayT::MAX.get())), ..open }
}

fn extreme(draw: &mut Draw) -> In {
    let direction = if draw.once_in(2) { Direction::default() } else { draw.direction() };
    let origin = Point::new(draw.signed(POINT_MAX), POINT_MAX, -POINT_MAX);
    let (lo, hi) = (Point::new(-POINT_MAX, -POINT_MAX, -POINT_MAX), Point::new(POINT_MAX, POINT_MAX, POINT_MAX));
    In { ray: draw.setup_of(origin, direction), t_max: draw.t_max(), lo, hi }
}

#[test]
fn rtl_equals_rust() {
    Suite::<BoxTest32>::new(
        &[
            ("random", random),
            ("through corners, edges and faces", touching),
            ("axis-parallel along faces", axis_parallel_touching),
            ("t_max at the entry", t_max_at_entry),
            ("extremes", extreme),
        ],
        &[
            ("hit", |_, o| o.hit),
            ("miss", |_, o| !o.hit),
            ("hit of a flat box", |i, o| o.hit && i.lo.x == i.hi.x),
            ("hit at t_max", |i, o| o.hit && o.t_near.get() > 0 && o.t_near.get() << T_NEAR_TO_T_SHIFT == i.t_max.get()),
            ("axis-parallel hit", |i, o| o.hit && i.ray.x.d.get() == 0 && i.ray.y.d.get() == 0),
            ("largest box", |i, _| i.lo.x.get() == -POINT_MAX && i.hi.z.get() == POINT_MAX),
            ("no direction at all", |i, _| i.ray.x.d.get() | i.ray.y.d.get() | i.ray.z.d.get() == 0),
        ],
    )
    .run();
}
