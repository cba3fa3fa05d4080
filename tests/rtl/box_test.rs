use crate::draw::{Draw, POINT_MAX};
use crate::suite::Suite;
use lodray::block::Block;
use lodray::block::box_test::{BoxTest, In};
use lodray::num::{Box16, RayT, T_NEAR_TO_T_SHIFT, U};

fn random(draw: &mut Draw) -> In {
    In { ray: draw.setup(), t_max: draw.t_max(), bounds: draw.box16() }
}

/// Rays exactly through corners, edges and faces of a box, or from there on.
fn touching(draw: &mut Draw) -> In {
    aimed(draw, Draw::short_direction)
}

fn axis_parallel_touching(draw: &mut Draw) -> In {
    aimed(draw, |draw| {
        let d = draw.axis_parallel().get().map(|v| v >> 2);
        lodray::num::Direction::new(d[0], d[1], d[2])
    })
}

fn plane_parallel_touching(draw: &mut Draw) -> In {
    aimed(draw, |draw| {
        let d = draw.plane_parallel().get().map(|v| v >> 2);
        lodray::num::Direction::new(d[0], d[1], d[2])
    })
}

fn aimed(draw: &mut Draw, direction: fn(&mut Draw) -> lodray::num::Direction) -> In {
    let bounds = small_box(draw);
    let units = |v: [i64; 3]| v.map(|c| c << 16);
    let mut target = draw.on_box(units(bounds.lo.get()), units(bounds.hi.get()));
    // Some pass a unit beside.
    if draw.once_in(2) {
        target[draw.below(3) as usize] += draw.below(3).cast_signed() - 1;
    }
    let d = direction(draw);
    let origin = draw.origin_towards(target, d);
    In { ray: draw.setup_of(origin, d), t_max: RayT::MAX, bounds }
}

/// A box within +-2^29 units.
fn small_box(draw: &mut Draw) -> Box16 {
    let corner = |draw: &mut Draw| [0; 3].map(|_| draw.signed(8191) as i16);
    let (a, b) = (corner(draw), corner(draw));
    Box16::from_codes([0, 1, 2].map(|k| a[k].min(b[k])), [0, 1, 2].map(|k| a[k].max(b[k])))
}

/// Rays of full length that hit, and end exactly at the box, or a step before or behind.
fn t_max_at_entry(draw: &mut Draw) -> In {
    let bounds = small_box(draw);
    let centre = [0, 1, 2].map(|k| (bounds.lo.get()[k] + bounds.hi.get()[k]) << 15);
    let d = draw.axis_parallel().get().map(|v| v / 2 + draw.signed(1 << 28));
    let d = lodray::num::Direction::new(d[0], d[1], d[2]);
    let back = draw.below(3).cast_signed();
    let [x, y, z] = [0, 1, 2].map(|k| (centre[k] - back * d.get()[k]).clamp(-POINT_MAX, POINT_MAX));
    let ray = draw.setup_of(lodray::num::Point::new(x, y, z), d);
    let open = In { ray, t_max: RayT::MAX, bounds };
    let entry = BoxTest::eval(&open).t_near.get() << T_NEAR_TO_T_SHIFT;
    In { t_max: U::new((entry + draw.below(3)).saturating_sub(1).min(RayT::MAX.get())), ..open }
}

/// Nothing and everything: empty direction, the largest box, the farthest origins.
fn extreme(draw: &mut Draw) -> In {
    let direction = if draw.once_in(2) { lodray::num::Direction::default() } else { draw.axis_parallel() };
    let origin = lodray::num::Point::new(draw.signed(POINT_MAX), POINT_MAX, -POINT_MAX);
    let bounds = if draw.once_in(2) { Box16::from_codes([-32767; 3], [32767; 3]) } else { draw.box16() };
    In { ray: draw.setup_of(origin, direction), t_max: draw.t_max(), bounds }
}

#[test]
fn rtl_equals_rust() {
    Suite::<BoxTest>::new(
        &[
            ("random", random),
            ("through corners, edges and faces", touching),
            ("axis-parallel along faces", axis_parallel_touching),
            ("parallel to a plane", plane_parallel_touching),
            ("t_max at the entry", t_max_at_entry),
            ("extremes", extreme),
        ],
        &[
            ("hit", |_, o| o.hit),
            ("miss", |_, o| !o.hit),
            ("hit of a flat box", |i, o| o.hit && i.bounds.lo.x == i.bounds.hi.x),
            ("hit at t_max", |i, o| o.hit && o.t_near.get() > 0 && o.t_near.get() << T_NEAR_TO_T_SHIFT == i.t_max.get()),
            ("culled one step before t_max", |i, o| {
                let open = BoxTest::eval(&In { t_max: RayT::MAX, ..*i });
                !o.hit && open.hit && open.t_near.get() << T_NEAR_TO_T_SHIFT == i.t_max.get() + 1
            }),
            ("axis-parallel hit", |i, o| o.hit && i.ray.x.d.get() == 0 && i.ray.y.d.get() == 0),
            ("moment cut off by rounding", |i, o| o.hit && i.ray.moment.get().iter().any(|m| m & 0xffff != 0)),
            ("no direction at all", |i, _| i.ray.x.d.get() | i.ray.y.d.get() | i.ray.z.d.get() == 0),
        ],
    )
    .run();
}
