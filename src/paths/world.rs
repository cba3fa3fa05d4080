//! Models where a scene has them, and what a ray meets among them.

use super::boxes::{Bounds, BoxTree, Walk};
use super::bsdf::{Bsdf, Place};
use super::cone::PathCone;
use super::material::Material;
use super::memory::{AllBefore, WorldMemory};
use super::pose::Pose;
use crate::format::Scene;
use crate::method::leave::side;
use crate::method::{Before, Departure, Landing, Method, Tracer};
use crate::rays::{Camera, Eye, ModelSpace, Query, Sight, ViewCone};
use crate::step::{Link, MapError, NoSteps, Recorder, Step, StepSink};
use glam::DVec3;
use std::cmp::Ordering;
use std::collections::HashMap;
use std::sync::Arc;

/// Base colour of a model without any.
const GREY: DVec3 = DVec3::splat(0.8);

/// How rays start that leave a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Starts {
    /// Exactly where the surface was hit, and level of detail there as the rays before saw it: the rule of paper section 3.8.
    Exact,
    /// Exactly there, but each ray decides for itself.
    Independent,
    /// This far above the surface, in bounding radii of the model, as common renderers do; each ray decides for itself.
    Offset(f64),
}

/// A model in a scene.
pub struct Instance<'a> {
    /// The model, as the triangles have it that rays find ([`Method::surface`]).
    pub scene: &'a Scene,
    /// How rays find it.
    pub method: &'a dyn Method,
    /// Where it is.
    pub pose: Pose,
    /// Materials by the number that the model gives each triangle; the last one for all beyond.
    materials: Vec<(Material, Bsdf)>,
    space: ModelSpace,
    /// The same in all frames of several.
    sight: Arc<Sight>,
}

impl<'a> Instance<'a> {
    /// A model, for rays of `camera` at quality `delta`. It needs a material.
    pub fn new(scene: &'a Scene, method: &'a dyn Method, pose: Pose, materials: Vec<Material>, camera: &Camera, delta: f64) -> Self {
        let own = Self::for_cameras(scene, method, &[(pose, *camera)], delta).remove(0);
        let materials = materials.into_iter().map(|material| (material, Bsdf::of(&material))).collect();
        Self { materials, ..own }
    }

    /// The same model in each frame of several: where it then stands, for the rays of that frame's camera, which are not shaded.
    pub fn for_cameras(scene: &'a Scene, method: &'a dyn Method, seen: &[(Pose, Camera)], delta: f64) -> Vec<Self> {
        let space = ModelSpace::of(scene);
        let eye = |(pose, camera): &(Pose, Camera)| {
            let eye = pose.place(camera.eye).to_array();
            // The thinnest that a cone gets on its way to the model.
            let tan_theta = camera.tan_theta / pose.squeezed();
            let least_radius = tan_theta * space.distance_to(eye) / space.placement.scale;
            let eye = Eye::at(eye, tan_theta);
            // Of a stretched view there is no cone: it looks everywhere.
            let eye = if pose.squeezed() == 1.0 {
                let view = camera.view_cone();
                eye.looking(ViewCone { axis: pose.direction(DVec3::from_array(view.axis)).to_array(), ..view })
            } else {
                eye
            };
            (least_radius, eye.in_units(&space))
        };
        let (radii, eyes): (Vec<f64>, Vec<Eye>) = seen.iter().map(eye).unzip();
        let least_radius = radii.into_iter().fold(f64::INFINITY, f64::min);
        let sight = Arc::new(Sight { delta, least_radius, eyes, frame: None });
        seen.iter().map(|&(pose, _)| Self::seen(scene, method, pose, Arc::clone(&sight))).collect()
    }

    /// A model, for rays that may start anywhere, however thin, and are not shaded.
    pub fn for_any_ray(scene: &'a Scene, method: &'a dyn Method, pose: Pose, delta: f64) -> Self {
        Self::seen(scene, method, pose, Arc::new(Sight { delta, least_radius: 0.0, eyes: vec![Eye::ANYWHERE], frame: None }))
    }

    fn seen(scene: &'a Scene, method: &'a dyn Method, pose: Pose, sight: Arc<Sight>) -> Self {
        Self { scene: method.surface(scene), method, pose, materials: Vec::new(), space: ModelSpace::of(scene), sight }
    }

    /// Its own space.
    pub(super) fn space(&self) -> &ModelSpace {
        &self.space
    }

    /// What its rays see of it.
    pub fn sight(&self) -> &Sight {
        &self.sight
    }

    /// Half the diagonal of its box, in the scene.
    pub fn radius(&self) -> f64 {
        self.space.radius() * self.pose.scale()
    }

    /// Its box, in the scene: outside of it rays do not meet the model.
    fn bounds(&self) -> Bounds {
        let placement = self.space.placement;
        Bounds::around(self.space.enlarged().map(|corner| {
            let own = DVec3::from_array(placement.offset) + DVec3::from_array(corner) * placement.scale;
            self.pose.out(own)
        }))
    }

    /// Centre of its box, in the scene.
    pub fn centre(&self) -> DVec3 {
        self.pose.out(DVec3::from_array(self.space.centre()))
    }
}

/// A ray in the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct WorldRay {
    pub origin: DVec3,
    /// Length 1.
    pub direction: DVec3,
    pub cone: PathCone,
    /// Nothing nearer counts.
    pub t_min: f64,
    /// Nothing farther counts.
    pub t_max: f64,
    /// Any hit serves.
    pub any: bool,
}

/// How far the square of a length may be from 1 by rounding alone.
const ROUNDING: f64 = 1e-15;

impl WorldRay {
    /// The ray of a query; a direction of length 1 stays as it is, bit for bit.
    pub fn of(query: &Query) -> Self {
        let direction = DVec3::from_array(query.direction);
        let is_unit = (direction.length_squared() - 1.0).abs() <= ROUNDING;
        Self {
            origin: DVec3::from_array(query.origin),
            // Scaled first, so that squares neither overflow nor vanish.
            direction: if is_unit { direction } else { (direction / direction.abs().max_element()).normalize() },
            cone: PathCone { radius: query.radius, spread: query.tan_theta },
            t_min: query.t_min,
            t_max: query.t_max,
            any: query.any,
        }
    }
}

/// What a ray met.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    pub instance: usize,
    pub distance: f64,
    pub landing: Landing,
}

/// The surface there, as shading needs it; its normal in the scene, on the side that the ray came from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface<'a> {
    pub place: Place,
    pub bsdf: &'a Bsdf,
    /// Width of its distribution of microfacets.
    pub alpha: f64,
    /// 1 / radius, positive where it bulges towards the ray.
    pub curvature: f64,
}

impl Surface<'_> {
    /// A direction leads through it.
    pub fn goes_through(&self, direction: DVec3) -> bool {
        self.bsdf.is_clear() && self.place.normal.dot(direction) < 0.0
    }
}

/// Hears the steps of a ray, on the lines of all models.
pub(super) struct Heard<'a, S> {
    pub memory: &'a WorldMemory,
    pub steps: &'a mut S,
}

/// Nobody hears a ray.
pub(super) const UNHEARD: Option<Heard<'_, NoSteps>> = None;

/// The steps of rays, kept, and who waits for whom.
pub(super) struct Listener<'a> {
    pub recorder: Recorder,
    /// The next ray's number.
    pub number: u64,
    memory: &'a WorldMemory,
}

impl<'a> Listener<'a> {
    /// Has heard nothing yet.
    pub fn new(memory: &'a WorldMemory) -> Self {
        Self { recorder: Recorder::default(), number: 0, memory }
    }

    /// Hears the next ray, which begins behind ray `after`.
    pub fn ray(&mut self, after: Option<u64>) -> Heard<'_, Recorder> {
        self.recorder.link(Link { number: self.number, after });
        self.number += 1;
        Heard { memory: self.memory, steps: &mut self.recorder }
    }
}

/// All models.
pub struct World<'a> {
    /// They, at least one.
    instances: Vec<Instance<'a>>,
    /// How rays leave them.
    pub starts: Starts,
    boxes: BoxTree,
    /// Instances that have a tracer of their own, and by instance the place of its tracer among these: what is seen alike of one model is traced by one.
    traced: Vec<usize>,
    tracer_of: Vec<usize>,
}

impl<'a> World<'a> {
    /// These models, at least one.
    ///
    /// # Panics
    /// There is none.
    pub fn new(instances: Vec<Instance<'a>>, starts: Starts) -> Self {
        assert!(!instances.is_empty(), "a world needs a model");
        let boxes: Vec<_> = instances.iter().map(Instance::bounds).collect();
        let (mut known, mut traced) = (HashMap::new(), Vec::new());
        let tracer_of = instances.iter().enumerate().map(|(k, own)| {
            let mut new = || {
                traced.push(k);
                traced.len() - 1
            };
            match own.method.alike(&own.sight) {
                Some(seen) => *known.entry((std::ptr::from_ref(own.method).cast::<()>(), seen)).or_insert_with(new),
                None => new(),
            }
        });
        let tracer_of = tracer_of.collect();
        Self { instances, starts, boxes: BoxTree::new(&boxes), traced, tracer_of }
    }

    /// They, in their order.
    pub fn instances(&self) -> &[Instance<'a>] {
        &self.instances
    }

    /// A tracer for each model, and for each way to see it; for one thread.
    pub fn tracers(&self) -> Vec<Box<dyn Tracer + '_>> {
        self.tracers_of(None)
    }

    /// The same for the rays of one frame of several.
    pub(super) fn tracers_of(&self, frame: Option<usize>) -> Vec<Box<dyn Tracer + '_>> {
        let tracer = |&k: &usize| {
            let own = &self.instances[k];
            frame.map_or_else(|| own.method.tracer(&own.sight), |frame| own.method.tracer(&own.sight.of_frame(frame)))
        };
        self.traced.iter().map(tracer).collect()
    }

    /// Work before a frame on the lines of all: the tree over them anew if they stand elsewhere than in the frame before, of which this is the world; then that of the models, one after the
    /// other.
    pub(super) fn before<'b>(&'b self, memory: &WorldMemory, frame: usize, last: Option<&Self>) -> Option<Box<dyn Before + 'b>> {
        let moved = |last: &Self| self.instances.iter().zip(&last.instances).map(|(now, then)| now.pose != then.pose).collect();
        let tree = last.and_then(|last| memory.rebuild(self.nodes(), moved(last))).map(|work| Box::new(work) as Box<dyn Before>);
        let own = self.instances.iter().enumerate().filter_map(|(k, own)| Some(memory.before(k, own.method.before(&own.sight, frame)?)));
        let works: Vec<_> = tree.into_iter().chain(own).collect();
        (!works.is_empty()).then(|| Box::new(AllBefore(works)) as Box<dyn Before>)
    }

    /// The models' memories as one.
    ///
    /// # Errors
    /// They have more lines than can be numbered.
    pub fn memory(&self) -> Result<WorldMemory, MapError> {
        self.memory_with(self.nodes())
    }

    /// The same with room for so many nodes of the tree over them.
    pub(super) fn memory_with(&self, nodes: usize) -> Result<WorldMemory, MapError> {
        let seen: Vec<_> = self.instances.iter().map(|own| (own.method, &*own.sight)).collect();
        WorldMemory::new(&seen, nodes)
    }

    /// Nodes of the tree over them.
    pub(super) fn nodes(&self) -> usize {
        self.boxes.nodes()
    }

    /// What `ray` meets first, or at all: of models that it meets at the same distance the first. Distances are those of the scene, each rounded from the t of its model; within a
    /// model t decides, exactly. It starts at `from`, a hit of that model, if there is one. It comes to those models whose boxes it enters before what it has met, nearest first.
    /// Whoever hears the ray hears all of it, its end too.
    pub(super) fn trace<S: StepSink>(
        &self,
        tracers: &mut [Box<dyn Tracer + '_>],
        ray: &WorldRay,
        from: Option<(usize, &Departure)>,
        mut heard: Option<Heard<'_, S>>,
    ) -> Option<Met> {
        let mut origin = ray.origin;
        if let (Starts::Offset(radii), Some((of, from))) = (self.starts, from) {
            origin += self.instances[of].above(from, ray.direction) * (radii * self.instances[of].radius());
        }
        let mut best: Option<Met> = None;
        let mut enter = |k: usize, heard: &mut Option<Heard<'_, S>>| {
            let (own, tracer) = (&self.instances[k], &mut tracers[self.tracer_of[k]]);
            let mut own_from = from.filter(|&(of, _)| of == k).map(|(_, from)| *from);
            match self.starts {
                Starts::Exact => {}
                Starts::Independent => own_from = own_from.map(|from| Departure { prior: None, ..from }),
                Starts::Offset(_) => own_from = None,
            }
            let farthest = best.map_or(ray.t_max, |best| best.distance);
            let of_scene = Query {
                any: ray.any,
                ..Query::new(origin.to_array(), ray.direction.to_array())
                    .with_cone(ray.cone.radius, ray.cone.spread)
                    // What is as far as the best is rounded once more on its way to steps: a hair farther, and the comparison below decides.
                    .between(ray.t_min, farthest * (1.0 + 1e-12))
            };
            let (query, scale) = own.pose.enter(&of_scene);
            let landing = match heard {
                Some(heard) => tracer.enter(&query, own_from.as_ref(), &mut heard.memory.steps_of(k, heard.steps)),
                None => tracer.follow(&query, own_from.as_ref(), None),
            };
            if let Some(landing) = landing {
                let distance = landing.surface.distance * scale;
                if best.is_none_or(|best| distance < best.distance || distance == best.distance && k < best.instance) {
                    best = Some(Met { instance: k, distance, landing });
                }
            }
            // Whoever takes any has it.
            best.map_or(ray.t_max, |best| if ray.any { f64::NEG_INFINITY } else { best.distance })
        };
        if self.instances.len() == 1 {
            // There is no tree over one model, and its space is the ray's.
            enter(0, &mut heard);
        } else {
            self.boxes.each(origin, ray.direction, ray.t_max, |walk| {
                if let Some(heard) = &mut heard {
                    heard.memory.walk(walk, heard.steps);
                }
                let Walk::Model(k) = walk else { return None };
                Some(enter(k, &mut heard))
            });
        }
        if let Some(heard) = heard {
            heard.steps.step(Step::end(best.is_some(), tracers[0].is_mapped()));
        }
        best
    }

    /// Whether rays along `direction` leave `met` to the side that the ray before came from, or `through` the surface to the other: exact where starts are.
    pub(super) fn leaves(&self, met: &Met, direction: DVec3, through: bool) -> bool {
        let (own, departure) = (&self.instances[met.instance], &met.landing.departure);
        let wanted = if met.landing.surface.front != through { Ordering::Greater } else { Ordering::Less };
        own.space.direction(own.pose.direction(direction).to_array()).is_some_and(|d| side(&departure.corners, d) == wanted)
    }

    /// The surface that a ray along `direction` met.
    pub(super) fn surface(&self, met: &Met, direction: DVec3) -> Surface<'_> {
        let (own, hit) = (&self.instances[met.instance], &met.landing.surface);
        let turn = if hit.front { 1.0 } else { -1.0 };
        let shading = own.pose.normal(hit.normal(own.scene).as_dvec3()) * turn;
        let plane = hit.plane_normal().map_or(shading, |plane| own.pose.normal(plane.as_dvec3()) * turn);
        // Where level of detail shows another side than the full resolution has, the surface that is shown counts.
        let faces = |n: DVec3| n.dot(direction) < 0.0;
        let shading = if shading.dot(plane) < 0.0 { -shading } else { shading };
        let normal = if faces(shading) { shading } else { plane };
        let number = usize::from(own.scene.material(hit.tree as usize));
        let colour = own.scene.colour(number as u16).map_or(GREY, |c| DVec3::from_array(c.map(f64::from)));
        let (material, bsdf) = &own.materials[number.min(own.materials.len() - 1)];
        Surface { place: Place { colour, normal, front: hit.front }, bsdf, alpha: material.alpha(), curvature: own.curvature(met) * turn }
    }
}

impl Instance<'_> {
    /// The side of a triangle that `direction` leads to, as a normal in the scene.
    fn above(&self, from: &Departure, direction: DVec3) -> DVec3 {
        let [a, b, c] = from.corners.map(|p| DVec3::from_array(p.get().map(|c| c as f64)));
        let normal = self.pose.normal((b - a).cross(c - a).normalize_or_zero());
        if normal.dot(direction) < 0.0 { -normal } else { normal }
    }

    /// Curvature of the surface where it was hit, from normals at the corners of the triangle that was met, in the scene; positive where the front bulges.
    fn curvature(&self, met: &Met) -> f64 {
        let (hit, scene) = (&met.landing.surface, self.scene);
        let (tree, level, levels) = (hit.tree as usize, u32::from(hit.level), scene.levels());
        let corners = scene.triangle(tree, level, hit.node as usize).map(|p| self.pose.way(DVec3::from_array(p.map(f64::from))));
        let normals = crate::mesh::lattice::node(levels, level, hit.node)
            .map(|point| self.pose.normal(DVec3::from_array(scene.normal_at(tree, point).map(f64::from))));
        let bend = |i: usize, j: usize| {
            let way = corners[j] - corners[i];
            if way == DVec3::ZERO { 0.0 } else { (normals[j] - normals[i]).dot(way) / way.length_squared() }
        };
        (bend(0, 1) + bend(1, 2) + bend(2, 0)) / (3.0 * self.space.placement.scale * self.pose.scale())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::procedural::{self, Options};
    use crate::method::bvh::NoStore;
    use crate::method::{Knobs, lod};
    use crate::rays::View;

    /// Models at one place, in a tree of boxes with others: every ray meets the one that the scene has first, wherever that stands in the tree.
    #[test]
    fn of_models_at_one_distance_the_first_is_met() {
        let scene = Scene::generate(&Options { levels: Some(2), base: Some(128), ..Options::new(procedural::Scene::Sphere) }).unwrap();
        let method = (lod::METHOD.make)(&scene, &Knobs::default(), &NoStore).unwrap();
        let camera = Camera::new(&View::default(), &ModelSpace::of(&scene), 8, 8).unwrap();
        let pose = Pose::new([10.0, 20.0, 30.0], 0.7, [0.01, 0.02, 0.03]);
        let apart = |x: f64| Pose::new([0.0; 3], 0.5, [x, 4.0, 0.0]);
        let mut met = 0;
        for poses in [vec![pose, pose], vec![pose, apart(2.0), pose], vec![apart(-2.0), pose, pose, apart(2.0), pose]] {
            let first = poses.iter().position(|of| *of == pose).unwrap();
            let instances =
                poses.iter().map(|&of| Instance::new(&scene, &*method, of, vec![Material::Diffuse { albedo: None }], &camera, 1.0));
            let world = World::new(instances.collect(), Starts::Exact);
            let mut tracers = world.tracers();
            for k in 0..400 {
                let [x, y] = [k % 20, k / 20].map(|v| 0.07 * f64::from(v) - 0.65);
                let (origin, direction) = (DVec3::new(3.0, y, x), DVec3::new(-1.0, 0.1 * y, -0.2 * x).normalize());
                let cone = PathCone { radius: 0.0, spread: 1e-3 };
                let ray = WorldRay { origin, direction, cone, t_min: 0.0, t_max: f64::INFINITY, any: false };
                if let Some(hit) = world.trace(&mut tracers, &ray, None, UNHEARD) {
                    assert_eq!(hit.instance, first, "ray {k} of {} models", poses.len());
                    met += 1;
                }
            }
        }
        assert!(met > 500, "{met}");
    }
}
