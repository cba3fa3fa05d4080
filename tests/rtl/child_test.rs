use crate::draw::Draw;
use crate::suite::Suite;
use lodray::block::child_test::{ChildTest, In};
use lodray::num::{Box16, Direction, Point, RayT, TNear};

fn random(draw: &mut Draw) -> In {
    In {
        ray: draw.setup(),
        t_max: draw.t_max(),
        present: [0; 4].map(|_| !draw.once_in(4)),
        bounds: [0; 4].map(|_| draw.box16()),
        widen: draw.once_in(2),
        p0: draw.model_point(),
        p1: draw.model_point(),
        p2: draw.model_point(),
        q0: draw.model_point(),
        q1: draw.model_point(),
        q2: draw.model_point(),
    }
}

/// A point within +-2^24 units around `centre`.
fn near(draw: &mut Draw, centre: [i64; 3]) -> Point {
    let [x, y, z] = centre.map(|c| c + draw.signed(1 << 24));
    Point::new(x, y, z)
}

/// Four small boxes around one place that the ray is aimed at; triangles that reach a little out of them.
fn crowded(draw: &mut Draw) -> In {
    let centre = draw.point(1 << 29).get();
    let bounds = [0; 4].map(|_| {
        let (a, b) = (near(draw, centre).get(), near(draw, centre).get());
        let side = |pick: fn(i64, i64) -> i64| [0, 1, 2].map(|k| (pick(a[k], b[k]) >> 16) as i16);
        Box16::from_codes(side(i64::min), side(i64::max))
    });
    let d = if draw.once_in(3) { draw.axis_parallel().get().map(|v| v >> 1) } else { draw.short_direction().get() };
    let d = Direction::new(d[0], d[1], d[2]);
    let target = near(draw, centre).get();
    let back = 1 + draw.below(2).cast_signed();
    let [x, y, z] = [0, 1, 2].map(|k| target[k] - back * d.get()[k]);
    let [p0, p1, p2, q0, q1, q2] = [0; 6].map(|_| near(draw, centre));
    let ray = draw.setup_of(Point::new(x, y, z), d);
    In { ray, t_max: RayT::MAX, present: [0; 4].map(|_| !draw.once_in(8)), bounds, widen: draw.once_in(2), p0, p1, p2, q0, q1, q2 }
}

/// Four times the same box: equal t_near.
fn same(draw: &mut Draw) -> In {
    let input = crowded(draw);
    In { bounds: [input.bounds[0]; 4], widen: false, ..input }
}

#[test]
fn rtl_equals_rust() {
    Suite::<ChildTest>::new(
        &[("random", random), ("crowded", crowded), ("equal boxes", same)],
        &[
            ("none hit", |_, o| o.count.get() == 0),
            ("all hit", |_, o| o.count.get() == 4),
            ("equal t_near", |_, o| o.count.get() == 4 && o.t_near[0] == o.t_near[3] && o.t_near[0] > TNear::ZERO),
            ("absent children", |i, o| !i.present[0] && o.count.get() > 0),
            ("hits of widened boxes", |i, o| i.widen && o.count.get() > 1),
            ("another order than by number", |_, o| o.count.get() == 4 && o.order[0].get() == 3),
        ],
    )
    .run();
}
