//! Rays and boxes for both box tests: boxes in steps of 2^16 units for one, in units for the other.

use crate::draw::{DIRECTION_MAX, Draw, POINT_MAX};
use crate::rays::{direction, point};
use lodray::block::Block;
use lodray::block::ray_setup::{self, Axis, RaySetup};
use lodray::num::{Direction, Point};

/// A ray and a box, in units.
#[derive(Clone, Copy)]
pub struct Meeting {
    pub origin: Point,
    pub direction: Direction,
    pub lo: [i64; 3],
    pub hi: [i64; 3],
}

impl Meeting {
    /// The ray's constants.
    pub fn setup(&self) -> ray_setup::Out {
        RaySetup::eval(&ray_setup::In { origin: self.origin, direction: self.direction })
    }
}

/// Corners of a box with coordinates up to `max` that are multiples of 2^SHIFT; flat in the first `flat` axes from a random one on.
fn corners<const SHIFT: u32>(draw: &mut Draw, max: i64, flat: u64) -> ([i64; 3], [i64; 3]) {
    let mut v = || [0; 3].map(|_| draw.signed(max >> SHIFT) << SHIFT);
    let (a, b) = (v(), v());
    let first = draw.below(3);
    let is_flat = |k: u64| (k + 3 - first) % 3 < flat;
    let lo = [0, 1, 2].map(|k| a[k].min(b[k]));
    (lo, [0, 1, 2].map(|k| if is_flat(k as u64) { lo[k] } else { a[k].max(b[k]) }))
}

/// A corner of a box, or a point on one of its edges or faces, or inside.
fn of_box(draw: &mut Draw, lo: [i64; 3], hi: [i64; 3]) -> [i64; 3] {
    [0, 1, 2].map(|k| match draw.below(4) {
        0 => lo[k],
        1 | 2 => hi[k],
        _ => draw.between(lo[k], hi[k]),
    })
}

/// Anything: rays of every length, boxes of every size.
pub fn random<const SHIFT: u32>(draw: &mut Draw) -> Meeting {
    let flat = draw.below(4).saturating_sub(1);
    let (lo, hi) = corners::<SHIFT>(draw, POINT_MAX, flat);
    let direction = if draw.once_in(2) { draw.components() } else { draw.direction() };
    Meeting { origin: draw.point(POINT_MAX), direction, lo, hi }
}

/// The origin in the box, or on its surface.
pub fn inside<const SHIFT: u32>(draw: &mut Draw) -> Meeting {
    let meeting = random::<SHIFT>(draw);
    Meeting { origin: point(of_box(draw, meeting.lo, meeting.hi)), ..meeting }
}

/// A ray in this direction exactly through a corner, an edge or a face, or from there on.
fn aimed<const SHIFT: u32>(draw: &mut Draw, d: Direction, flat: u64) -> Meeting {
    let (lo, hi) = corners::<SHIFT>(draw, POINT_MAX, flat);
    let target = of_box(draw, lo, hi);
    Meeting { origin: draw.before(target, d), direction: d, lo, hi }
}

/// Through a corner, in any direction.
pub fn corner<const SHIFT: u32>(draw: &mut Draw) -> Meeting {
    let d = draw.direction();
    let (lo, hi) = corners::<SHIFT>(draw, POINT_MAX, 0);
    let target = [0, 1, 2].map(|k| if draw.once_in(2) { lo[k] } else { hi[k] });
    Meeting { origin: draw.before(target, d), direction: d, lo, hi }
}

/// Touching no more than a corner or an edge, exactly.
pub fn grazing<const SHIFT: u32>(draw: &mut Draw) -> Meeting {
    let d = draw.full_direction().get();
    let (lo, hi) = corners::<SHIFT>(draw, POINT_MAX, 0);
    // Past an edge along axis k: the box is on the other side of it in the two other axes.
    let k = draw.below(3) as usize;
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    let mut target = [0; 3];
    target[k] = draw.between(lo[k], hi[k]);
    target[i] = if d[i] >= 0 { hi[i] } else { lo[i] };
    target[j] = if d[j] >= 0 { lo[j] } else { hi[j] };
    Meeting { origin: draw.before(target, direction(d)), direction: direction(d), lo, hi }
}

/// One unit beside what the ray would graze.
pub fn beside<const SHIFT: u32>(draw: &mut Draw) -> Meeting {
    let meeting = if draw.once_in(2) { grazing::<SHIFT>(draw) } else { corner::<SHIFT>(draw) };
    let mut origin = meeting.origin.get();
    let k = draw.below(3) as usize;
    origin[k] = (origin[k] + draw.sign(1)).clamp(-POINT_MAX, POINT_MAX);
    Meeting { origin: point(origin), ..meeting }
}

/// Along an axis.
pub fn axis_parallel<const SHIFT: u32>(draw: &mut Draw) -> Meeting {
    let d = draw.axis_parallel();
    aimed::<SHIFT>(draw, d, 0)
}

/// Within a coordinate plane.
pub fn plane_parallel<const SHIFT: u32>(draw: &mut Draw) -> Meeting {
    let d = draw.plane_parallel();
    aimed::<SHIFT>(draw, d, 0)
}

/// Almost along an axis.
pub fn leaning<const SHIFT: u32>(draw: &mut Draw) -> Meeting {
    let d = draw.leaning();
    aimed::<SHIFT>(draw, d, 0)
}

/// Within a coordinate plane, one unit outside of the box.
pub fn off_a_face<const SHIFT: u32>(draw: &mut Draw) -> Meeting {
    let d = draw.plane_parallel();
    let (lo, hi) = corners::<SHIFT>(draw, POINT_MAX - 1, 0);
    let target = of_box(draw, lo, hi);
    let mut origin = draw.before(target, d).get();
    let k = (0..3).find(|&k| d.get()[k] == 0).unwrap_or(0);
    origin[k] = if draw.once_in(2) { lo[k] - 1 } else { hi[k] + 1 };
    Meeting { origin: point(origin), direction: d, lo, hi }
}

/// A box without thickness, length or extent, met.
pub fn flat<const SHIFT: u32>(draw: &mut Draw) -> Meeting {
    let (d, axes) = (draw.direction(), 1 + draw.below(3));
    aimed::<SHIFT>(draw, d, axes)
}

/// A box ahead, met by a ray as a frame has them, or missed by little.
pub fn ahead<const SHIFT: u32>(draw: &mut Draw) -> Meeting {
    let direction = draw.full_direction();
    let (lo, hi) = corners::<SHIFT>(draw, DIRECTION_MAX, 0);
    let target = of_box(draw, lo, hi);
    Meeting { origin: draw.afar(target, direction), direction, lo, hi }
}

/// A box behind the origin: where the ray goes on some axis, the box ends before.
pub fn behind<const SHIFT: u32>(draw: &mut Draw) -> Meeting {
    let d = draw.direction().get();
    let (lo, hi) = corners::<SHIFT>(draw, DIRECTION_MAX, 0);
    // The last corner that the ray leaves.
    let target = [0, 1, 2].map(|k| if d[k] >= 0 { hi[k] } else { lo[k] });
    Meeting { origin: draw.beyond(target, direction(d)), direction: direction(d), lo, hi }
}

/// So short a direction that every distance saturates.
pub fn short<const SHIFT: u32>(draw: &mut Draw) -> Meeting {
    let d = direction([0; 3].map(|_| draw.between(-3, 3)));
    let d = if d == Direction::default() { Direction::new(1, 0, 0) } else { d };
    aimed::<SHIFT>(draw, d, 0)
}

/// A small box a few steps of 2^16 units ahead.
pub fn near<const SHIFT: u32>(draw: &mut Draw) -> Meeting {
    let target = [0; 3].map(|_| draw.between(-16000, 16000) << 16);
    let (d, distance) = (draw.full_direction(), draw.between(0, 8));
    // (2^30 distance) / 2^14: distance steps.
    let origin = point([0, 1, 2].map(|k| target[k] - ((d.get()[k] * distance) >> 14)));
    let size = 1 << draw.between(0, 2);
    Meeting { origin, direction: d, lo: target, hi: target.map(|v| v + (size << 16)) }
}

/// No direction, or the longest one; the largest box, or one in a corner of the range; origins in corners.
pub fn extreme<const SHIFT: u32>(draw: &mut Draw) -> Meeting {
    let largest = POINT_MAX >> SHIFT << SHIFT;
    let d = if draw.once_in(3) { Direction::default() } else { direction([DIRECTION_MAX; 3].map(|v| draw.sign(v))) };
    let (lo, hi) = match draw.below(3) {
        0 => ([-largest; 3], [largest; 3]),
        1 => ([largest; 3], [largest; 3]),
        _ => ([-largest; 3], [-largest; 3]),
    };
    Meeting { origin: point(draw.corner()), direction: d, lo, hi }
}

/// Number of the octant that the ray goes into.
pub fn octant(ray: &ray_setup::Out) -> u64 {
    u64::from(ray.x.mirror) << 2 | u64::from(ray.y.mirror) << 1 | u64::from(ray.z.mirror)
}

/// Constants that `RaySetup` gives for some legal ray.
pub fn is_setup(ray: &ray_setup::Out) -> bool {
    let axes = [ray.x, ray.y, ray.z];
    let back = |a: &Axis, v: i64| if a.mirror { -v } else { v };
    let [origin, d] = [axes.map(|a| back(&a, a.origin.get())), axes.map(|a| back(&a, a.d.get().cast_signed()))];
    RaySetup::eval(&ray_setup::In { origin: point(origin), direction: direction(d) }) == *ray
}

/// True if the ray meets the box in nothing but a point or a line on its surface: it enters by one axis where it leaves by another.
pub fn grazes(ray: &ray_setup::Out, lo: [i64; 3], hi: [i64; 3]) -> bool {
    let axes = [ray.x, ray.y, ray.z];
    let slab = |k: usize| {
        let (a, x) = (axes[k], axes[k].origin.get());
        if a.mirror { (-hi[k] - x, -lo[k] - x) } else { (lo[k] - x, hi[k] - x) }
    };
    (0..3).flat_map(|i| [(i, (i + 1) % 3), (i, (i + 2) % 3)]).any(|(i, j)| {
        let (di, dj) = (axes[i].d.get(), axes[j].d.get());
        di > 0 && dj > 0 && i128::from(slab(i).0) * i128::from(dj) == i128::from(slab(j).1) * i128::from(di)
    })
}
