//! The golden traverser of a scene: what a ray meets by the definition, in the words of the hardware and in those of the world.

use crate::format::Scene;
use crate::golden::{Exact, ExactHit};
use crate::method::{Hit, SurfaceHit};
use crate::num::{Bary, Ray, RayT, U};
use crate::rays::{ModelRay, ModelSpace, Query, RaySource};
use crate::run::HitRow;
use rayon::prelude::*;

/// The golden traverser of a scene ([`Exact`]): slow, without any block of the hardware. It keeps the scene's model unpacked: 12 bytes a vertex, and boxes of all nodes.
pub struct Golden {
    scene: Scene,
    space: ModelSpace,
    exact: Exact<'static>,
}

/// What a ray of the world meets by the definition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judged {
    /// In the world: the row that a method's cast gives.
    pub row: HitRow,
    /// The ray as the hardware takes it; none where it misses the model's box.
    pub ray: Option<ModelRay>,
    /// As the hardware gives it, bit for bit.
    pub hit: Option<Hit>,
}

impl Scene {
    /// Its golden traverser. Of a scene that was pruned for a job, hits are right for that job's rays alone.
    pub fn golden(&self) -> Golden {
        Golden { scene: self.clone(), space: ModelSpace::of(self), exact: Exact::owning(self.decode()) }
    }
}

impl Golden {
    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The closest hit of an integer ray among those from the first to the last of these steps of t, as the hardware gives it.
    pub fn closest(&self, ray: &Ray, [first, last]: [RayT; 2]) -> Option<Hit> {
        self.exact.trace_between(ray, [first.get(), last.get()]).map(|hit| record(&hit))
    }

    /// What every ray of `rays` meets at this quality, in their order, by all threads. A ray for which any hit serves gets its closest.
    pub fn cast(&self, rays: &dyn RaySource, delta: f64) -> Vec<Judged> {
        let batches = (0..rays.batches()).into_par_iter().map(|batch| {
            let mut judged = Vec::new();
            rays.batch(batch, &mut |number, query| judged.push((number, self.judge(query, delta))));
            judged
        });
        let nothing = Judged { row: HitRow::NONE, ray: None, hit: None };
        let mut all = vec![nothing; rays.rays() as usize]; // it has as many
        for (number, judged) in batches.collect::<Vec<_>>().into_iter().flatten() {
            all[number as usize] = judged;
        }
        all
    }

    /// What one ray meets.
    pub fn judge(&self, query: &Query, delta: f64) -> Judged {
        let ray = self.space.enter(query, delta);
        let hit = ray.and_then(|ray| self.closest(&ray.ray, ray.range));
        // No picture is made of it, so it needs no plane.
        let row = |(ray, hit)| HitRow::new(&self.scene, query, &SurfaceHit::new(&ray, &hit, SurfaceHit::NO_PLANE));
        let row = ray.zip(hit).map_or(HitRow::NONE, row);
        Judged { row, ray, hit }
    }
}

/// A hit as the hardware's record has it.
fn record(hit: &ExactHit) -> Hit {
    let wide = |v: u32| u64::from(v);
    let ([b0, b1, b2], [full_b0, full_b1, full_b2]) = (hit.bary.map(|b| Bary::new(wide(b))), hit.full_bary.map(|b| Bary::new(wide(b))));
    Hit {
        t: U::new(hit.t),
        front: hit.front,
        tree: U::new(wide(hit.tree)),
        level: U::new(wide(hit.level)),
        node: U::new(wide(hit.node)),
        b0,
        b1,
        b2,
        full_node: U::new(wide(hit.full_node)),
        full_b0,
        full_b1,
        full_b2,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::procedural;
    use crate::rays::{Camera, RayFile, View};

    #[test]
    fn it_meets_what_the_method_meets_in_every_bit_of_every_row() {
        let options = procedural::Options { levels: Some(3), base: Some(32), ..procedural::Options::new(procedural::Scene::Sphere) };
        let scene = Scene::generate(&options).unwrap();
        let camera = Camera::new(&View { distance: Some(2.0), ..View::default() }, &ModelSpace::of(&scene), 24, 24).unwrap();
        let golden = scene.golden();
        let judged = golden.cast(&camera, 1.0);
        let rows: Vec<HitRow> = judged.iter().map(|judged| judged.row).collect();
        let cast = scene.method_with("lod", &[("delta", "1")]).unwrap().cast(&camera);
        // As text, where no number is like any other.
        assert_eq!(format!("{rows:?}"), format!("{cast:?}"));
        let met: Vec<_> = judged.iter().filter_map(|judged| Some((judged.row, judged.hit?))).collect();
        assert!(met.len() > 100 && met.iter().all(|(row, hit)| row.level == hit.level.get() as i32), "{}", met.len());
    }

    #[test]
    fn what_is_nearer_or_farther_than_wanted_does_not_count() {
        let scene = Scene::generate(&procedural::Options::new(procedural::Scene::Sphere)).unwrap();
        let golden = scene.golden();
        let [x, y, z] = ModelSpace::of(&scene).centre();
        let through = |near, far| Query::new([x, y, z + 5.0], [0.0, 0.0, -1.0]).between(near, far);
        let met = |near, far| golden.judge(&through(near, far), f64::INFINITY).row;
        let (first, second) = (met(0.0, 9.0), met(5.0, 9.0));
        assert!(first.front == 1 && second.front == 0 && first.t < 5.0 && second.t > 5.0, "{first:?} {second:?}");
        let file = RayFile::new(vec![through(0.0, 9.0), through(4.9, 5.1)]);
        let both: Vec<f64> = golden.cast(&file, f64::INFINITY).iter().map(|judged| judged.row.t).collect();
        assert_eq!(both, [first.t, f64::INFINITY]);
    }
}
