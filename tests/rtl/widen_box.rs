use crate::draw::Draw;
use crate::suite::Suite;
use lodray::block::widen_box::{In, WidenBox};
use lodray::num::{COORD_LIMIT, Point};

fn random(draw: &mut Draw) -> In {
    In { bounds: draw.box16(), p0: draw.model_point(), p1: draw.model_point(), p2: draw.model_point() }
}

/// Corners on, just below and just above steps of box codes.
fn steps(draw: &mut Draw) -> In {
    let limit = i64::from(COORD_LIMIT);
    let mut corner = || {
        let [x, y, z] = [0; 3].map(|_| ((draw.signed(32766) << 16) + draw.below(3).cast_signed() - 1).clamp(-limit, limit));
        Point::new(x, y, z)
    };
    let (p0, p1, p2) = (corner(), corner(), corner());
    In { bounds: draw.box16(), p0, p1, p2 }
}

/// A triangle inside its box.
fn inside(draw: &mut Draw) -> In {
    let bounds = draw.box16();
    let (lo, hi) = (bounds.lo.get(), bounds.hi.get());
    let mut corner = || {
        let [x, y, z] = [0, 1, 2].map(|k| (lo[k] << 16) + draw.below((((hi[k] - lo[k]) << 16) + 1).cast_unsigned()).cast_signed());
        Point::new(x, y, z)
    };
    In { bounds, p0: corner(), p1: corner(), p2: corner() }
}

#[test]
fn rtl_equals_rust() {
    Suite::<WidenBox>::new(
        &[("random", random), ("steps of box codes", steps), ("inside", inside)],
        &[
            ("nothing widened", |i, o| o.bounds == i.bounds),
            ("all six sides widened", |i, o| {
                let (a, b) = (i.bounds, o.bounds);
                (0..3).all(|k| b.lo.get()[k] < a.lo.get()[k] && b.hi.get()[k] > a.hi.get()[k])
            }),
            ("a corner at the limit", |i, _| i.p0.get().contains(&i64::from(COORD_LIMIT))),
        ],
    )
    .run();
}
