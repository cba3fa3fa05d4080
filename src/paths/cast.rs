//! Rays of any source through several models.

use super::world::{UNHEARD, World, WorldRay};
use crate::rays::RaySource;
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
                    let met = self.trace(tracers, &WorldRay::of(query), None, UNHEARD);
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
