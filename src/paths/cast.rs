//! Rays of any source through several models.

use super::cone::PathCone;
use super::world::{World, WorldRay};
use crate::rays::{Query, RaySource};
use crate::run::HitRow;
use glam::DVec3;
use rayon::prelude::*;

impl World<'_> {
    /// What every ray of `source` meets first among all models, or at all, in their order, whatever the number of threads; each starts at its own origin. Rows name the model
    /// ([`HitRow::instance`]) and its own triangles; points and normals are those of the scene. `done` is told how many batches are done, from any thread.
    pub fn cast(&self, source: &dyn RaySource, done: &(dyn Fn(u64) + Sync)) -> Vec<HitRow> {
        let rows = (0..source.batches()).into_par_iter().map_init(
            || self.tracers(),
            |tracers, batch| {
                let mut rows = Vec::new();
                source.batch(batch, &mut |number, query| {
                    let ray = world_ray(query);
                    let met = self.trace(tracers, &ray, None, None);
                    let row = met.map_or(HitRow::NONE, |met| {
                        let own = &self.instances()[met.instance];
                        let mut surface = met.landing.surface;
                        surface.distance = met.distance;
                        let row = HitRow::new(own.scene, query, &surface);
                        let normal = own.pose.normal(DVec3::from_array(row.normal.map(f64::from)));
                        // Few: a description's.
                        HitRow { instance: met.instance as i32, normal: normal.as_vec3().to_array(), ..row }
                    });
                    rows.push((number, row));
                });
                done(1);
                rows
            },
        );
        let mut hits = vec![HitRow::NONE; source.rays() as usize]; // it has as many
        for (number, row) in rows.collect::<Vec<_>>().into_iter().flatten() {
            hits[number as usize] = row;
        }
        hits
    }
}

fn world_ray(query: &Query) -> WorldRay {
    let direction = DVec3::from_array(query.direction);
    WorldRay {
        origin: DVec3::from_array(query.origin),
        // Scaled first, so that squares neither overflow nor vanish.
        direction: (direction / direction.abs().max_element()).normalize(),
        cone: PathCone { radius: query.radius, spread: query.tan_theta },
        t_min: query.t_min,
        t_max: query.t_max,
        any: query.any,
    }
}
