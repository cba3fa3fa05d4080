//! The 16-bit box test.

use crate::boxes::{self, Meeting, grazes, is_setup, octant};
use crate::draw::Draw;
use crate::suite::{Category, Suite};
use lodray::block::Block;
use lodray::block::box_test::{BoxTest, In};
use lodray::num::{Box16, RayT, T_NEAR_TO_T_SHIFT, TNear, U};

const SHIFT: u32 = 16;

fn open(m: Meeting) -> In {
    let codes = |v: [i64; 3]| v.map(|c| (c >> SHIFT) as i16); // of 32 bits
    In { ray: m.setup(), t_max: RayT::MAX, bounds: Box16::from_codes(codes(m.lo), codes(m.hi)) }
}

fn units(i: &In) -> ([i64; 3], [i64; 3]) {
    let units = |v: [i64; 3]| v.map(|c| c << SHIFT);
    (units(i.bounds.lo.get()), units(i.bounds.hi.get()))
}

fn random(draw: &mut Draw) -> In {
    In { t_max: draw.t_max(), ..open(boxes::random::<SHIFT>(draw)) }
}

fn inside(draw: &mut Draw) -> In {
    In { t_max: draw.t_max(), ..open(boxes::inside::<SHIFT>(draw)) }
}

/// The ray ends where the box begins, plus `by` steps.
fn ends(draw: &mut Draw, by: i64) -> In {
    let input = open(boxes::ahead::<SHIFT>(draw));
    let entry = (BoxTest::eval(&input).t_near.get() << T_NEAR_TO_T_SHIFT).cast_signed();
    In { t_max: U::new((entry + by).max(0).cast_unsigned()), ..input }
}

fn legal(i: &In) -> bool {
    let (lo, hi) = (i.bounds.lo.get(), i.bounds.hi.get());
    is_setup(&i.ray) && (0..3).all(|k| lo[k] <= hi[k] && lo[k] >= -32767 && hi[k] <= 32767)
}

type Is = Category<BoxTest>;

pub fn suite() -> Suite<BoxTest> {
    Suite::new(
        legal,
        vec![
            Is::any("random", random),
            Is::all("origin in the box", inside, |_, o| o.hit && o.t_near == TNear::ZERO),
            Is::all("through a corner", |d| open(boxes::corner::<SHIFT>(d)), |_, o| o.hit),
            Is::all(
                "grazing an edge",
                |d| open(boxes::grazing::<SHIFT>(d)),
                |i, o| {
                    let (lo, hi) = units(i);
                    o.hit && (grazes(&i.ray, lo, hi) || [i.ray.x, i.ray.y, i.ray.z].iter().any(|a| a.d.get() == 0))
                },
            ),
            Is::some("one unit beside that", |d| open(boxes::beside::<SHIFT>(d)), |_, o| !o.hit),
            Is::all("axis-parallel", |d| open(boxes::axis_parallel::<SHIFT>(d)), |_, o| o.hit),
            Is::all("parallel to a plane", |d| open(boxes::plane_parallel::<SHIFT>(d)), |_, o| o.hit),
            Is::all("almost axis-parallel", |d| open(boxes::leaning::<SHIFT>(d)), |_, o| o.hit),
            Is::all("one unit off a face", |d| open(boxes::off_a_face::<SHIFT>(d)), |_, o| !o.hit),
            Is::all("flat boxes", |d| open(boxes::flat::<SHIFT>(d)), |_, o| o.hit),
            Is::all("box behind", |d| open(boxes::behind::<SHIFT>(d)), |_, o| !o.hit),
            Is::often("t_max at the entry", |d| ends(d, 0), |i, o| o.hit && o.t_near.get() << T_NEAR_TO_T_SHIFT == i.t_max.get()),
            Is::often("t_max one step before the entry", |d| ends(d, -1), |_, o| !o.hit),
            Is::often("saturated distance", |d| open(boxes::short::<SHIFT>(d)), |_, o| o.hit && o.t_near == TNear::MAX),
            Is::often("a few steps ahead", |d| open(boxes::near::<SHIFT>(d)), |_, o| o.hit && (1..9).contains(&o.t_near.get())),
            Is::any("extremes", |d| open(boxes::extreme::<SHIFT>(d))),
        ],
        vec![
            ("a distance of one step", |_, o| o.t_near.get() == 1),
            ("no direction, hit", |i, o| o.hit && i.ray.x.d.get() | i.ray.y.d.get() | i.ray.z.d.get() == 0),
            ("no direction, miss", |i, o| !o.hit && i.ray.x.d.get() | i.ray.y.d.get() | i.ray.z.d.get() == 0),
            ("a point of a box, met", |i, o| o.hit && i.bounds.lo == i.bounds.hi),
            ("moment cut off by rounding", |i, o| o.hit && i.ray.moment.get().iter().any(|m| m & 0xffff != 0)),
        ],
        vec![("octant", 0..=7, |i, _| octant(&i.ray)), ("hit", 0..=1, |_, o| o.hit.into())],
    )
}

crate::suite::modes!(suite());
