//! What the rays of a job need, measured on each of them.

use super::needs::{ALL_ZEROS, bits, needs, signed_bits};
use super::scene::Met;
use crate::block::Block;
use crate::block::lod_test::{self, LodTest};
use crate::format::{JobRegion, Scene};
use crate::num::{BoundCode, BoundScale, Cone, Direction, Point, Ray, U, Wire};
use crate::rays::{ModelSpace, RaySource};
use rayon::prelude::*;

needs! {
    /// What the rays of a job need on a scene, each number the least that serves them.
    pub struct RayNeeds {
        most {
            /// The finest level that a ray can go down to.
            deepest_level: u32,
            /// Levels of detail are chosen: some quality is neither 0, the base mesh, nor infinite, full detail.
            lod_test: bool,
            /// Some hit can be on a triangle above the finest level, and has to be mapped to it.
            hit_mapping: bool,
            /// Some cone has a radius where its ray starts.
            start_radius: bool,
            /// Bits of a coordinate of an origin, with its sign.
            origin_bits: u32,
            /// Bits of a component of a direction, with its sign.
            direction_bits: u32,
            /// Bits of the offset of a cone.
            cone_offset_bits: u32,
            /// Bits of the slope of a cone.
            cone_slope_bits: u32,
            /// Largest shift of a cone.
            cone_shift: u32,
        }
        least {
            /// Zero bits at the bottom of every component of every direction.
            direction_zeros,
        }
    }
}

/// Whether a cone tolerates a displacement at all, and whether any that there is.
fn extremes(cone: &Cone) -> [bool; 2] {
    let flat = cone.slope == U::ZERO;
    // As `rays::cone` has it for infinite and for zero quality: more than the largest bound, whatever the distance.
    [flat && cone.offset == U::ZERO, flat && cone.offset == U::MAX && cone.shift == U::ZERO]
}

/// Whether a ray goes below a level whose largest code is `code`, where all triangles, morphed or not, lie in a box: at its corner that is nearest along the ray it
/// tolerates least.
pub(super) fn refines(ray: &Ray, [lo, hi]: [[i32; 3]; 2], scale: BoundScale, code: u8) -> bool {
    let d = ray.direction.get();
    let nearest = Point::from_i32(std::array::from_fn(|k| if d[k] < 0 { hi[k] } else { lo[k] }));
    let e0 = BoundCode::new(code.into());
    LodTest::eval(&lod_test::In { ray: *ray, p0: nearest, p1: nearest, p2: nearest, e0, scale, ..lod_test::In::default() }).refine
}

/// A scene as rays need it: where its vertices lie, and its largest code of an edge of each level.
struct Below<'a> {
    scene: &'a Scene,
    met: &'a Met,
}

impl Below<'_> {
    /// The finest level that a ray can go down to.
    fn deepest(&self, ray: &Ray) -> u32 {
        let meta = self.scene.meta();
        let refines = |code: u8| refines(ray, [meta.lo, meta.hi], meta.bound_scale(), code);
        // Nodes of a level are reached only through those above it.
        (0..).zip(&self.met.codes[..meta.levels as usize]).find(|(_, code)| !refines(**code)).map_or(meta.levels, |(level, _)| level)
    }
}

impl RayNeeds {
    /// Of the rays of `source` at quality `delta`; those that miss the model's box need nothing.
    pub(super) fn of(scene: &Scene, met: &Met, source: &dyn RaySource, delta: f64) -> Self {
        let (space, below) = (ModelSpace::of(scene), Below { scene, met });
        let levels = scene.levels();
        let batch = |batch: usize| {
            let mut needs = Self::default();
            source.batch(batch, &mut |_, query| {
                let Some(entered) = space.enter(query, delta) else { return };
                let Ray { origin, direction, cone } = entered.ray;
                let [full, none] = extremes(&cone);
                let deepest_level = below.deepest(&entered.ray);
                let (widest, ones) = (
                    |of: [i64; 3]| of.map(|c| signed_bits(c.min(0), c.max(0))).into_iter().max().unwrap_or(0),
                    |of: [i64; 3]| of.into_iter().fold(0, |ones, c| ones | c),
                );
                needs = needs.with(&Self {
                    deepest_level,
                    lod_test: levels > 0 && !full && !none,
                    hit_mapping: levels > 0 && (!full || met.stops_early || deepest_level < levels),
                    start_radius: levels > 0 && !none && cone.offset != U::ZERO,
                    origin_bits: widest(origin.get()),
                    direction_bits: widest(direction.get()),
                    cone_offset_bits: bits(cone.offset.get()),
                    cone_slope_bits: bits(cone.slope.get()),
                    cone_shift: cone.shift.get() as u32, // 6 bits
                    direction_zeros: ones(direction.get()).trailing_zeros().min(ALL_ZEROS),
                });
            });
            needs
        };
        (0..source.batches()).into_par_iter().map(batch).reduce(Self::default, |a, b| a.with(&b))
    }

    /// Of all rays of a region, none of which goes below `deepest_level`: any numbers that a ray can have.
    pub(super) fn of_region(scene: &Scene, region: &JobRegion, deepest_level: u32) -> Self {
        let levels = scene.levels();
        let none = region.quality() == Some(0.0);
        let [origin_bits, direction_bits] = [Point::WIDTH, Direction::WIDTH].map(|three| three / 3);
        Self {
            deepest_level,
            // Its rays can have any lower quality.
            lod_test: levels > 0 && !none,
            hit_mapping: levels > 0,
            start_radius: levels > 0 && !none,
            origin_bits,
            direction_bits,
            cone_offset_bits: U::<53>::WIDTH,
            cone_slope_bits: U::<18>::WIDTH,
            cone_shift: 63,
            direction_zeros: 0,
        }
    }
}
