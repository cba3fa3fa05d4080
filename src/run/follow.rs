//! Hits of rays that start where earlier ones hit: exactly there, and on the surface that those saw (docs/exactness.md, L14 and L15).

use super::cast::HitRow;
use crate::format::Scene;
use crate::method::{Departure, Method, Tracer};
use crate::rays::{ModelSpace, Query, RayFile, Sight};
use rayon::prelude::*;
use thiserror::Error;

/// Rays that one thread takes at a time.
const CHUNK: usize = 64;

/// How far an origin may lie from the hit, as a share of the coordinates and distances that it was found from: 16 roundings of float32, where origin + t * direction
/// in float32 takes at most four in each coordinate.
const SHARE: f64 = 1.0 / 1_048_576.0;

/// The same in steps of the model's coordinates: what rounding an integer ray moves a hit off the ray of the world.
const STEPS: f64 = 16.0;

/// Why rays cannot follow others.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum FollowError {
    /// The method [`leaves`](Method::leaves) no surface.
    #[error("its hits are not exact, so no ray can start at one")]
    NoStarts,
    /// The earlier ray met nothing.
    #[error("ray {ray}: it starts at the hit of ray {after}, which meets nothing")]
    Missed {
        /// The ray.
        ray: u64,
        /// The earlier one.
        after: u64,
    },
    /// The origin is another point.
    #[error(
        "ray {ray}: its origin is {distance:.3e} away from the hit of ray {after} where it starts; at most {tolerance:.3e} is rounding"
    )]
    Elsewhere {
        /// The ray.
        ray: u64,
        /// The earlier one.
        after: u64,
        /// In world units.
        distance: f64,
        /// The largest distance that rounding explains.
        tolerance: f64,
    },
}

/// What rays met.
#[derive(Clone, Debug, PartialEq)]
pub struct Followed {
    /// A row for each ray. Distances of a ray that follows another are from where it starts, the exact point.
    pub hits: Vec<HitRow>,
    /// Rays that followed others.
    pub followed: u64,
    /// Those of them whose level of detail a third ray had decided too, and lost ([`Departure::crowded`]): they may meet the surface beside their start.
    pub crowded: u64,
}

/// What every ray of `rays` meets, in their order, whatever the number of threads; one that names an earlier ray starts exactly at that one's hit, with the rule of prior
/// rays, whatever the number of rays before that. `done` is told how many rays are done, from any thread.
///
/// # Errors
/// The method has no exact hits, a ray follows one that met nothing, or its origin is not where that one's hit is: the first such row of those with the fewest rays before them.
pub fn cast_following(
    method: &dyn Method,
    scene: &Scene,
    rays: &RayFile,
    sight: &Sight,
    done: &(dyn Fn(u64) + Sync),
) -> Result<Followed, FollowError> {
    if !method.leaves() {
        return Err(FollowError::NoStarts);
    }
    let queries = rays.queries();
    let mut all = Follow {
        scene: method.surface(scene),
        space: ModelSpace::of(scene),
        queries,
        hits: vec![HitRow::NONE; queries.len()],
        places: vec![0; queries.len()],
    };
    let mut is_followed = vec![false; queries.len()];
    queries.iter().filter_map(|query| query.after).for_each(|after| is_followed[after as usize] = true);
    let (mut followed, mut crowded, mut ends) = (0, 0, Vec::new());
    let mut own = method.tracer(sight);
    for generation in generations(queries) {
        let trace = |tracer: &mut dyn Tracer, chunk: &[u32]| -> Result<Vec<_>, FollowError> {
            let met = chunk.iter().map(|&ray| all.trace(tracer, ray, &ends)).collect();
            done(chunk.len() as u64);
            met
        };
        // In their order, so that the first error is the same with any number of threads.
        let chunks: Vec<_> = if generation.len() <= CHUNK {
            vec![trace(&mut *own, &generation)]
        } else {
            let chunks = generation.par_chunks(CHUNK);
            chunks.map_init(|| method.tracer(sight), |tracer, chunk| trace(&mut **tracer, chunk)).collect()
        };
        let mut next = Vec::new();
        for (&ray, met) in generation.iter().zip(chunks.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten()) {
            let ray = ray as usize;
            if let Some(after) = queries[ray].after {
                followed += 1;
                crowded += u64::from(all.end(after, &ends).is_some_and(|from| from.crowded));
            }
            let Some((row, departure)) = met else { continue };
            all.hits[ray] = row;
            if is_followed[ray] {
                next.push(departure);
                all.places[ray] = next.len() as u32; // at most as many as rays
            }
        }
        ends = next;
    }
    Ok(Followed { hits: all.hits, followed, crowded })
}

/// The rays by how many come before them: first those that follow none, in the order of their rows.
fn generations(queries: &[Query]) -> Vec<Vec<u32>> {
    let mut before = vec![0u32; queries.len()];
    let mut generations: Vec<Vec<u32>> = Vec::new();
    for (ray, query) in queries.iter().enumerate() {
        // An earlier row.
        before[ray] = query.after.map_or(0, |after| before[after as usize] + 1);
        let at = before[ray] as usize;
        if at == generations.len() {
            generations.push(Vec::new());
        }
        generations[at].push(ray as u32); // a file has at most 2^28
    }
    generations
}

/// Rays under way.
struct Follow<'a> {
    scene: &'a Scene,
    space: ModelSpace,
    queries: &'a [Query],
    hits: Vec<HitRow>,
    /// By ray, 1 + the place of its end among those of its generation; 0 without one.
    places: Vec<u32>,
}

impl Follow<'_> {
    /// Where rays start that follow ray `after`, of the generation with these ends.
    fn end<'b>(&self, after: u64, ends: &'b [Departure]) -> Option<&'b Departure> {
        ends.get((self.places[after as usize] as usize).checked_sub(1)?)
    }

    /// What a ray meets, and where others leave that.
    fn trace(&self, tracer: &mut dyn Tracer, ray: u32, ends: &[Departure]) -> Result<Option<(HitRow, Departure)>, FollowError> {
        let mut query = self.queries[ray as usize];
        let mut from = None;
        if let Some(after) = query.after {
            let end = self.end(after, ends).ok_or(FollowError::Missed { ray: ray.into(), after })?;
            let start = self.space.start(&end.start);
            self.check(ray, after, start)?;
            query.origin = start;
            from = Some(end);
        }
        let landing = tracer.follow(&query, from, None);
        Ok(landing.map(|landing| (HitRow::new(self.scene, &query, &landing.surface), landing.departure)))
    }

    /// The ray's origin is where it starts, but for roundings of float32 and of the integer ray.
    fn check(&self, ray: u32, after: u64, start: [f64; 3]) -> Result<(), FollowError> {
        let (own, before) = (self.queries[ray as usize].origin, self.queries[after as usize].origin);
        let distance = (0..3).map(|k| (own[k] - start[k]).powi(2)).sum::<f64>().sqrt();
        let largest = start.iter().chain(&before).fold(0.0f64, |most, v| most.max(v.abs()));
        let tolerance = SHARE * (largest + self.hits[after as usize].t) + STEPS * self.space.step();
        // Not a number fails too.
        if distance <= tolerance { Ok(()) } else { Err(FollowError::Elsewhere { ray: ray.into(), after, distance, tolerance }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn generations_are_by_the_rays_before_in_the_order_of_rows() {
        let query = |after| Query { after, ..Query::new([0.0; 3], [1.0, 0.0, 0.0]) };
        let queries = [None, Some(0), None, Some(1), Some(2), Some(0)].map(query);
        assert_eq!(generations(&queries), [vec![0, 2], vec![1, 4, 5], vec![3]]);
        assert!(generations(&[]).is_empty());
    }
}
