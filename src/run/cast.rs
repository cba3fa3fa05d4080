//! Hits of rays, as they are, for programs outside.

use crate::format::Scene;
use crate::method::{Crossings, Method, SurfaceHit, Tracer, trace_together};
use crate::rays::{Query, RaySource, Sight};
use crate::step::NoSteps;
use glam::DVec3;
use npyz::WriterBuilder;
use rayon::prelude::*;
use std::io::{self, Write};
use thiserror::Error;

/// Where one ray met the surface: a row of [`write_hits`].
#[derive(Clone, Copy, Debug, PartialEq, npyz::Serialize, npyz::AutoSerialize, npyz::Deserialize)]
pub struct HitRow {
    /// Distance from the origin in world units; infinite if nothing was met. What follows is then -1, or no number.
    pub t: f64,
    /// Base triangle.
    pub tree: i32,
    /// Level of the triangle that was met.
    pub level: i32,
    /// Its node on that level: face `tree * 4^level + node` of `export --level`, counted from 0.
    pub node: i32,
    /// Finest triangle there: face `triangle` of `export`, counted from 0.
    pub triangle: i64,
    /// Barycentrics on the triangle that was met, weights of its corners.
    pub barycentrics: [f32; 3],
    /// Barycentrics on the finest triangle.
    pub finest_barycentrics: [f32; 3],
    /// Point in world space: origin + t * direction of length 1.
    pub point: [f64; 3],
    /// Shading normal, interpolated at full resolution, of length 1.
    pub normal: [f32; 3],
    /// 1 if the front face was met, 0 if the back.
    pub front: i32,
    /// The model that was met, in a scene of several: its place among them, counted from 0.
    pub instance: i32,
}

impl HitRow {
    /// Nothing was met.
    pub const NONE: Self = Self {
        t: f64::INFINITY,
        tree: -1,
        level: -1,
        node: -1,
        triangle: -1,
        barycentrics: [f32::NAN; 3],
        finest_barycentrics: [f32::NAN; 3],
        point: [f64::NAN; 3],
        normal: [f32::NAN; 3],
        front: -1,
        instance: -1,
    };

    /// The row of a hit of `query` in `scene`.
    pub fn new(scene: &Scene, query: &Query, hit: &SurfaceHit) -> Self {
        let direction = DVec3::from_array(query.direction);
        // Scaled first, so that squares neither overflow nor vanish.
        let direction = (direction / direction.abs().max_element()).normalize();
        let point = DVec3::from_array(query.origin) + hit.distance * direction;
        // Widths are below 31 bits.
        let [tree, level, node] = [hit.tree, u32::from(hit.level), hit.node].map(u32::cast_signed);
        Self {
            t: hit.distance,
            tree,
            level,
            node,
            triangle: (i64::from(hit.tree) << (2 * scene.levels())) + i64::from(hit.full_node),
            barycentrics: hit.bary,
            finest_barycentrics: hit.full_bary,
            point: point.to_array(),
            normal: hit.normal(scene).to_array(),
            front: i32::from(hit.front),
            instance: 0,
        }
    }
}

/// What every ray of `source` meets, in their order, whatever the number of threads, each from its own origin, whichever ray it names
/// ([`cast_following`](super::cast_following) starts it there). `done` is told how many batches are done, from any thread.
pub fn cast(method: &dyn Method, scene: &Scene, source: &dyn RaySource, sight: &Sight, done: &(dyn Fn(u64) + Sync)) -> Vec<HitRow> {
    let scene = method.surface(scene);
    let row = |query: &Query, hit: Option<SurfaceHit>| hit.map_or(HitRow::NONE, |hit| HitRow::new(scene, query, &hit));
    let rows =
        |tracer: &mut dyn Tracer, queries: &[Query]| queries.iter().zip(met(tracer, queries)).map(|(query, hit)| row(query, hit)).collect();
    each_batch(method, source, sight, done, HitRow::NONE, rows)
}

/// Whether every ray of `source` meets anything, in the same order.
pub fn cast_any(method: &dyn Method, source: &dyn RaySource, sight: &Sight, done: &(dyn Fn(u64) + Sync)) -> Vec<bool> {
    each_batch(method, source, sight, done, false, |tracer, queries| {
        let any: Vec<_> = queries.iter().map(|query| Query { any: true, ..*query }).collect();
        met(tracer, &any).iter().map(Option::is_some).collect()
    })
}

/// What each ray meets; in packets where the tracer takes them, but for rays that start where others end.
fn met(tracer: &mut dyn Tracer, queries: &[Query]) -> Vec<Option<SurfaceHit>> {
    match tracer.lanes() {
        1 => queries.iter().map(|query| tracer.hit(query)).collect(),
        _ if queries.iter().any(|query| query.after.is_some()) => queries.iter().map(|query| tracer.hit(query)).collect(),
        _ => trace_together(tracer, queries, &mut NoSteps),
    }
}

/// A method that does not find all hits of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("its hits are not exact: it finds the closest of a ray alone")]
pub struct ClosestOnly;

/// Every hit of every ray of `source`, nearest first, whether any would serve a ray or not.
///
/// # Errors
/// The method finds but the closest.
pub fn cast_all(
    method: &dyn Method,
    scene: &Scene,
    source: &dyn RaySource,
    sight: &Sight,
    done: &(dyn Fn(u64) + Sync),
) -> Result<Vec<Vec<HitRow>>, ClosestOnly> {
    let scene = method.surface(scene);
    all_of_each(method, source, sight, done, Vec::new(), |query, hits| hits.iter().map(|hit| HitRow::new(scene, query, hit)).collect())
}

/// How many fronts and backs every ray of `source` meets.
///
/// # Errors
/// The method finds but the closest.
pub fn cast_counting(
    method: &dyn Method,
    source: &dyn RaySource,
    sight: &Sight,
    done: &(dyn Fn(u64) + Sync),
) -> Result<Vec<Crossings>, ClosestOnly> {
    all_of_each(method, source, sight, done, Crossings::default(), |_, hits| {
        let front = hits.iter().filter(|hit| hit.front).count() as u32; // at most as many as triangles
        Crossings { front, back: hits.len() as u32 - front }
    })
}

/// What `of` makes of all hits of every ray.
fn all_of_each<T: Clone + Send + Sync>(
    method: &dyn Method,
    source: &dyn RaySource,
    sight: &Sight,
    done: &(dyn Fn(u64) + Sync),
    none: T,
    of: impl Fn(&Query, &[SurfaceHit]) -> T + Sync,
) -> Result<Vec<T>, ClosestOnly> {
    let one = |tracer: &mut dyn Tracer, query: &Query| {
        let mut hits = Vec::new();
        tracer.all(query, &mut hits).then(|| of(query, &hits))
    };
    let all = |tracer: &mut dyn Tracer, queries: &[Query]| queries.iter().map(|query| one(tracer, query)).collect();
    let each = each_batch(method, source, sight, done, Some(none), all);
    each.into_iter().collect::<Option<Vec<_>>>().ok_or(ClosestOnly)
}

/// What `of` makes of the rays of a source, batch by batch, in their order; `none` stands where there is no ray.
fn each_batch<T: Clone + Send + Sync>(
    method: &dyn Method,
    source: &dyn RaySource,
    sight: &Sight,
    done: &(dyn Fn(u64) + Sync),
    none: T,
    of: impl Fn(&mut dyn Tracer, &[Query]) -> Vec<T> + Sync,
) -> Vec<T> {
    let rows = (0..source.batches()).into_par_iter().map_init(
        || method.tracer(sight),
        |tracer, batch| {
            let (mut numbers, mut queries) = (Vec::new(), Vec::new());
            source.batch(batch, &mut |number, query| {
                numbers.push(number);
                queries.push(*query);
            });
            let rows: Vec<_> = numbers.into_iter().zip(of(&mut **tracer, &queries)).collect();
            done(1);
            rows
        },
    );
    let mut all = vec![none; source.rays() as usize]; // it has as many
    for (number, row) in rows.collect::<Vec<_>>().into_iter().flatten() {
        all[number as usize] = row;
    }
    all
}

/// Writes hits as a structured array of NumPy's (`.npy`), with the fields of [`HitRow`].
///
/// # Errors
/// What `out` says.
pub fn write_hits(hits: &[HitRow], out: &mut dyn Write) -> io::Result<()> {
    let mut writer = npyz::WriteOptions::<HitRow>::new().default_dtype().shape(&[hits.len() as u64]).writer(out).begin_nd()?;
    writer.extend(hits.iter().copied())?;
    writer.finish()
}
