//! Path tracing: light where it is known, the same at any number of threads and any way to ask for light, rays as machines get them, and descriptions that are refused.

use assert_cmd::Command;
use lodray::block::{INSTANCE, Operation};
use lodray::format::Scene;
use lodray::machine::Machine;
use lodray::mesh::procedural::{self, Options};
use lodray::method::bvh::{self, NoStore};
use lodray::method::{Departure, Knobs, Landing, Method, SurfaceHit, Tracer, discrete, lod, reference};
use lodray::paths::{Environment, Film, Instance, Light, Material, PathFrame, Paths, Pose, Starts, World, light_count, picture_error};
use lodray::rays::{Camera, ModelSpace, Query, RayFile, RaySource, Sight, View};
use lodray::run::{Compute, Frame, Job, Traced, simulate};
use lodray::step::{Act, LineCounter, MemoryMap, NodeShape, Recorder, Step, StepSink};
use lodray_test_support::models::{Rng, build};
use lodray_test_support::program::write_rays;
use std::collections::HashSet;
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;

const WHITE: [f64; 3] = [1.0; 3];
const EVERYWHERE: Environment = Environment { zenith: WHITE, horizon: WHITE, ground: WHITE, up: [0.0, 1.0, 0.0] };

fn generated(scene: procedural::Scene, levels: u32, base: u32) -> Scene {
    let options = Options { levels: Some(levels), base: Some(base), ..Options::new(scene) };
    build(&procedural::generate(&options).expect("a surface"))
}

fn made(scene: &Scene, method: &'static lodray::method::Registered) -> Box<dyn Method> {
    (method.make)(scene, &Knobs::default(), &NoStore).expect("a method on a scene")
}

fn camera(scene: &Scene, eye: [f64; 3], size: u32) -> Camera {
    let view = View { eye: Some(eye), target: Some([0.0; 3]), fov: 40.0, ..View::default() };
    Camera::new(&view, &ModelSpace::of(scene), size, size).expect("a camera")
}

/// A picture of one model at the origin.
struct Shot<'a> {
    scene: &'a Scene,
    method: &'a dyn Method,
    material: Material,
    pose: Pose,
    camera: Camera,
    delta: f64,
    starts: Starts,
}

impl Shot<'_> {
    fn with<R>(
        &self,
        lights: &[Light],
        environment: Option<Environment>,
        change: impl FnOnce(&mut Paths<'_>),
        then: impl FnOnce(&Paths<'_>) -> R,
    ) -> R {
        let own = Instance::new(self.scene, self.method, self.pose, vec![self.material], &self.camera, self.delta);
        let world = World::new(vec![own], self.starts);
        let cones = Default::default();
        let mut paths =
            Paths { world: &world, camera: self.camera, lights, environment, cones, depth: 3, shadow_rays: true, samples: 16, seed: 1 };
        change(&mut paths);
        then(&paths)
    }

    fn film(&self, lights: &[Light], environment: Option<Environment>, change: impl FnOnce(&mut Paths<'_>)) -> Film {
        self.with(lights, environment, change, |paths| Film::of(paths, &|| ()))
    }
}

fn unturned() -> Pose {
    Pose::new([0.0; 3], 1.0, [0.0; 3])
}

fn mean(film: &Film) -> f32 {
    film.light.iter().map(|c| c.element_sum() / 3.0).sum::<f32>() / film.light.len() as f32
}

/// In light that comes from everywhere a surface that swallows nothing cannot be seen; however it is asked for.
#[test]
fn what_swallows_nothing_is_not_seen_in_even_light() {
    let scene = generated(procedural::Scene::Sphere, 3, 128);
    for method in [&lod::METHOD, &bvh::METHOD, &bvh::METHOD_SIX, &bvh::METHOD_WIDE, &discrete::METHOD] {
        let method = made(&scene, method);
        let shot = Shot {
            scene: &scene,
            method: &*method,
            material: Material::Diffuse { albedo: Some(WHITE) },
            pose: unturned(),
            camera: camera(&scene, [0.0, 0.0, 4.0], 24),
            delta: 1.0,
            starts: Starts::Exact,
        };
        for shadow_rays in [false, true] {
            let film = shot.film(&[], Some(EVERYWHERE), |paths| (paths.depth, paths.shadow_rays) = (24, shadow_rays));
            // What shading normals swallow at edges is all that is missing.
            let found = mean(&film);
            assert!((0.97..1.01).contains(&found), "{shadow_rays}: {found}");
            assert!(film.counts.hits[0] > 24 * 24 * 16 / 4 && film.counts.crowded == 0);
        }
    }
}

fn lights() -> [Light; 3] {
    [
        Light::Area { corner: [-1.0, 2.5, -1.0], along: [2.0, 0.0, 0.0], across: [0.0, 0.0, 2.0], radiance: [3.0, 2.0, 1.0] },
        Light::Sun { direction: [1.0, 1.0, 0.4], half_angle: 8.0, irradiance: [1.0, 2.0, 3.0] },
        Light::Point { position: [0.5, 2.0, 2.0], intensity: [1.0; 3] },
    ]
}

/// Shadow rays and rays that run into lights are two ways to one picture.
#[test]
fn light_is_the_same_whether_it_is_asked_for_or_found() {
    let scene = generated(procedural::Scene::Room, 3, 300);
    let method = made(&scene, &lod::METHOD);
    let glossy = Material::Glossy { reflectance: [0.3; 3], roughness: 0.7, albedo: [0.5; 3] };
    for material in [Material::Diffuse { albedo: None }, glossy] {
        let camera = camera(&scene, [0.0, 0.0, 3.4], 16);
        let shot = Shot { scene: &scene, method: &*method, material, pose: unturned(), camera, delta: 1.0, starts: Starts::Exact };
        // A point is found by no ray.
        let light = |shadow_rays, depth| {
            let film = shot.film(&lights()[..2], Some(EVERYWHERE), |paths| {
                (paths.depth, paths.shadow_rays, paths.samples) = (depth, shadow_rays, 400);
            });
            mean(&film)
        };
        // Without shadow rays the last hit gets no light: it is one bounce less.
        let (asked, ran_into) = (light(true, 2), light(false, 3));
        assert!((asked / ran_into - 1.0).abs() < 0.02, "{material:?}: {asked} {ran_into}");
    }
}

/// A scene turned, scaled and moved with its camera and lights is the same picture, but for roundings.
#[test]
fn a_pose_is_what_it_says() {
    let scene = generated(procedural::Scene::Sphere, 2, 128);
    let method = made(&scene, &lod::METHOD);
    let material = Material::Diffuse { albedo: Some([0.5; 3]) };
    let sun = |direction| [Light::Sun { direction, half_angle: 1.0, irradiance: WHITE }];
    let plain = Shot {
        scene: &scene,
        method: &*method,
        material,
        pose: unturned(),
        camera: camera(&scene, [0.0, 0.0, 4.0], 48),
        delta: f64::INFINITY,
        starts: Starts::Exact,
    };
    let one = plain.film(&sun([0.3, 0.2, 1.0]), None, |paths| paths.depth = 0);
    // By 90 degrees about y, +z becomes +x.
    let view = View { eye: Some([3.0 + 8.0, 5.0, -1.0]), target: Some([3.0, 5.0, -1.0]), fov: 40.0, ..View::default() };
    let camera = Camera::new(&view, &ModelSpace::of(&scene), 48, 48).expect("a camera");
    let turned = Shot { pose: Pose::new([0.0, 90.0, 0.0], 2.0, [3.0, 5.0, -1.0]), camera, ..plain };
    let other = turned.film(&sun([1.0, 0.2, -0.3]), None, |paths| paths.depth = 0);
    assert!(mean(&one) > 0.03 && picture_error(&one, &other) < 1e-3, "{} {}", mean(&one), picture_error(&one, &other));
}

#[test]
fn films_do_not_depend_on_threads_and_do_on_seeds() {
    let scene = generated(procedural::Scene::Terrain, 4, 32);
    let method = made(&scene, &lod::METHOD);
    let material = Material::Diffuse { albedo: None };
    let camera = camera(&scene, [0.6, 0.9, 1.2], 32);
    let shot = Shot { scene: &scene, method: &*method, material, pose: unturned(), camera, delta: 1.0, starts: Starts::Exact };
    let film = |seed, threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| shot.film(&lights(), Some(EVERYWHERE), |paths| paths.seed = seed))
    };
    let one = film(1, 1);
    for threads in [2, 3, 7] {
        let other = film(1, threads);
        assert!(one.light == other.light && one.lit == other.lit && one.counts == other.counts);
    }
    assert!(one.light != film(2, 1).light);
}

/// The rule is what keeps shadows right: each ray deciding for itself puts lit pixels into shadow; a start above the surface trades those for light that leaks.
#[test]
fn decisions_of_the_rays_before_keep_light_where_it_is() {
    let scene = generated(procedural::Scene::Terrain, 6, 128);
    let method = made(&scene, &lod::METHOD);
    let material = Material::Diffuse { albedo: Some([0.5; 3]) };
    let sun = [Light::Sun { direction: [-1.0, 0.35, -0.3], half_angle: 0.5, irradiance: WHITE }];
    let camera = camera(&scene, [0.2, 1.0, 2.2], 96);
    let shot = |starts, delta| {
        let shot = Shot { scene: &scene, method: &*method, material, pose: unturned(), camera, delta, starts };
        shot.film(&sun, None, |paths| (paths.depth, paths.samples) = (0, 4))
    };
    let truth = shot(Starts::Exact, f64::INFINITY);
    let [exact, independent, high] =
        [Starts::Exact, Starts::Independent, Starts::Offset(0.03)].map(|starts| light_count(&shot(starts, 1.0), &truth));
    println!("exact {exact:?}, independent {independent:?}, high {high:?}");
    assert!(exact.pixels > 3_000 && 50 * exact.shadowed < exact.pixels, "{exact:?}");
    assert!(independent.shadowed > 15 * (exact.shadowed + 1), "{independent:?} {exact:?}");
    // What leaks with the rule is what coarser shapes no longer hide.
    assert!(2 * high.leaking > 3 * exact.leaking, "{high:?} {exact:?}");
    // At full resolution there is nothing to decide.
    let same = shot(Starts::Independent, f64::INFINITY);
    assert!(same.light == truth.light);
}

/// A machine gets the rays that a picture has, each behind the one that it waits for.
#[test]
fn frames_have_the_rays_of_pictures() {
    let scene = generated(procedural::Scene::Room, 3, 300);
    for method in [&lod::METHOD, &bvh::METHOD] {
        let method = made(&scene, method);
        let material = Material::Diffuse { albedo: None };
        let camera = camera(&scene, [0.0, 0.0, 3.4], 40);
        let shot = Shot { scene: &scene, method: &*method, material, pose: unturned(), camera, delta: 1.0, starts: Starts::Exact };
        let change = |paths: &mut Paths<'_>| paths.samples = 2;
        let film = shot.film(&lights(), None, change);
        let (mut numbers, mut waiting, mut rays) = (HashSet::new(), 0, 0u64);
        shot.with(&lights(), None, change, |paths| {
            let frame = PathFrame::new(paths).expect("one model");
            frame.produce(&mut |Traced { batches, .. }| {
                for batch in &batches {
                    for ray in 0..batch.rays() {
                        let link = batch.link(ray).expect("a link");
                        assert!(numbers.insert(link.number) && link.number == rays, "numbers go up by one");
                        assert!(link.after.is_none_or(|after| after < link.number && numbers.contains(&after)));
                        waiting += u64::from(link.after.is_some());
                        rays += 1;
                    }
                }
                true
            });
        });
        assert_eq!((rays, rays - waiting), (film.counts.all(), 40 * 40 * 2));
    }
}

/// A method that counts how often its tracers are asked.
struct Counting<'a> {
    method: &'a dyn Method,
    asked: &'a AtomicU64,
}

struct CountingTracer<'a> {
    tracer: Box<dyn Tracer + 'a>,
    asked: &'a AtomicU64,
}

impl Method for Counting<'_> {
    fn map(&self, sight: &Sight) -> MemoryMap {
        self.method.map(sight)
    }

    fn tracer(&self, sight: &Sight) -> Box<dyn Tracer + '_> {
        Box::new(CountingTracer { tracer: self.method.tracer(sight), asked: self.asked })
    }
}

impl Tracer for CountingTracer<'_> {
    fn hit(&mut self, query: &Query) -> Option<SurfaceHit> {
        self.tracer.hit(query)
    }
    fn counted(&mut self, query: &Query, counter: &mut LineCounter<'_>) -> Option<SurfaceHit> {
        self.tracer.counted(query, counter)
    }
    fn recorded(&mut self, query: &Query, recorder: &mut Recorder) -> Option<SurfaceHit> {
        self.tracer.recorded(query, recorder)
    }
    fn heard(&mut self, query: &Query, steps: &mut dyn StepSink) -> Option<SurfaceHit> {
        self.tracer.heard(query, steps)
    }
    fn follow(&mut self, query: &Query, from: Option<&Departure>, recorder: Option<&mut Recorder>) -> Option<Landing> {
        self.asked.fetch_add(1, Relaxed);
        self.tracer.follow(query, from, recorder)
    }
    fn enter(&mut self, query: &Query, from: Option<&Departure>, steps: &mut dyn StepSink) -> Option<Landing> {
        self.asked.fetch_add(1, Relaxed);
        self.tracer.enter(query, from, steps)
    }
    fn all(&mut self, query: &Query, hits: &mut Vec<SurfaceHit>) -> bool {
        self.tracer.all(query, hits)
    }
    fn is_mapped(&self) -> bool {
        self.tracer.is_mapped()
    }
}

/// Two models in sixteen places, side by side: `order` says which stands where in the list.
fn places<'a>(
    scenes: &'a [Scene; 2],
    methods: &'a [Box<dyn Method>; 2],
    camera: &Camera,
    order: impl Fn(usize) -> usize,
) -> Vec<Instance<'a>> {
    let instance = |k: usize| {
        let k = order(k);
        let [x, z] = [k % 4, k / 4].map(|k| 2.5 * k as f64 - 3.75);
        let pose = Pose::new([0.0, 20.0 * k as f64, 0.0], 1.0 + 0.02 * k as f64, [x, 0.0, z]);
        Instance::new(&scenes[k % 2], &*methods[k % 2], pose, vec![Material::Diffuse { albedo: None }], camera, 1.0)
    };
    (0..16).map(instance).collect()
}

/// A machine gets the rays that a picture has of several models too: each goes through the tree over them and on into those whose boxes it enters, and ends once.
#[test]
fn rays_go_through_several_models_on_a_machine() {
    let scenes = [generated(procedural::Scene::Sphere, 3, 128), generated(procedural::Scene::Spikes, 2, 100)];
    let view = View { eye: Some([2.0, 6.0, 14.0]), target: Some([0.0; 3]), fov: 40.0, ..View::default() };
    let camera = Camera::new(&view, &ModelSpace::of(&scenes[0]), 32, 32).expect("a camera");
    let machine = Machine::shipped("haydel2023").expect("a machine");
    for registered in [&lod::METHOD, &bvh::METHOD, &bvh::METHOD_SIX, &discrete::METHOD] {
        let methods = [0, 1].map(|k: usize| made(&scenes[k], registered));
        let world = World::new(places(&scenes, &methods, &camera, |k| k), Starts::Exact);
        let (lights, cones) = (lights(), Default::default());
        let paths =
            Paths { world: &world, camera, lights: &lights, environment: None, cones, depth: 1, shadow_rays: true, samples: 2, seed: 1 };
        let film = Film::of(&paths, &|| ());
        let hits = film.counts.hits.iter().chain(&film.counts.shadowed).sum::<u64>();

        // Two models lie there once each, section by section, and then the tree and the sixteen places.
        let frame = PathFrame::new(&paths).expect("lines that can be numbered");
        let sections: Vec<_> = frame.map().sections().map(|(_, section)| section).collect();
        let [own, tree] = [&sections[..sections.len() - 2], &sections[sections.len() - 2..]];
        assert_eq!(tree.iter().map(|section| (section.name, section.lines)).collect::<Vec<_>>(), [("scene_node", 20), ("instance", 32)]);
        let maps = [0, 1].map(|k: usize| methods[k].map(world.instances()[k].sight()));
        for (k, section) in own.iter().enumerate() {
            let lines: Vec<_> = maps.iter().map(|map| map.sections().nth(k).expect("a section").1).collect();
            assert!(lines.iter().all(|own| own.name == section.name));
            assert_eq!(section.lines, lines.iter().map(|own| own.lines.next_multiple_of(4)).sum::<u64>());
        }

        // Each ray: the tree first, a step into each model, one end; every line is of the section that it says.
        let (mut rays, mut entered) = (0, 0);
        frame.produce(&mut |Traced { batches, .. }| {
            for batch in &batches {
                for ray in 0..batch.rays() {
                    let words = &batch.words()[batch.start(ray) as usize..batch.end(ray) as usize];
                    let steps: Vec<Step> = words.iter().map(|word| word.step()).collect();
                    assert!(matches!(steps[0].act, Act::Children { shape: NodeShape::Wide, .. }), "{:?}", steps[0]);
                    assert_eq!(steps.iter().filter(|step| matches!(step.act, Act::End { .. })).count(), 1);
                    let places = steps.iter().filter(|step| matches!(step.act, Act::Children { shape: NodeShape::Instance, .. }));
                    let transforms = steps.iter().filter(|step| matches!(step.act, Act::Work { work: INSTANCE, count: 1 })).count();
                    assert_eq!(places.clone().count(), transforms);
                    entered += transforms as u64;
                    for fetch in steps.iter().filter_map(|step| step.fetch) {
                        for line in fetch.line..fetch.line + fetch.lines {
                            assert_eq!(frame.map().locate(line.into()).map(|(id, _)| id), Some(fetch.section));
                        }
                    }
                    rays += 1;
                }
            }
            true
        });
        assert_eq!(rays, film.counts.all());
        assert!(entered > rays / 2 && entered < 3 * rays, "{entered} of {rays}");

        // A set-up for each ray, and one for each model that it enters; the same on one thread and on three.
        let job = Job { machine: machine.clone(), compute: Compute::Free, window: None };
        let run = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| simulate(&frame, std::slice::from_ref(&job), &mut |_| ())).remove(0).expect("a run")
        };
        let one = run(1);
        assert_eq!((one.counts.rays, one.counts.hits), (rays, hits));
        assert_eq!((one.operations.get(Operation::RaySetup), one.operations.works()[INSTANCE as usize]), (rays + entered, entered));
        assert_eq!(one, run(3));
        let units = Job { compute: Compute::Units, ..job.clone() };
        let refused = simulate(&frame, &[units], &mut |_| ()).remove(0).expect_err("units hold one model");
        assert!(refused.to_string().starts_with("the scene has 16 models"), "{refused}");
    }
}

/// Rays of a file meet the nearest of what each model alone would show them, and say which.
#[test]
fn cast_names_the_model_that_is_met() {
    let scenes = [generated(procedural::Scene::Sphere, 3, 128), generated(procedural::Scene::Spikes, 2, 100)];
    let methods = [0, 1].map(|k: usize| made(&scenes[k], &lod::METHOD));
    let camera = camera(&scenes[0], [0.0, 0.0, 4.0], 8);
    let all = || places(&scenes, &methods, &camera, |k| k);
    let mut rng = Rng(7);
    let mut point = |of: f64| -> [f64; 3] { std::array::from_fn(|_| of * rng.signed()) };
    let queries: Vec<_> = (0..3000)
        .map(|k| {
            let (from, at) = (point(9.0), point(4.0));
            let direction = std::array::from_fn(|c| at[c] - from[c]);
            Query {
                any: k % 5 == 0,
                ..Query::new(from, direction).with_cone(0.0, 1e-3).between([0.0, 2.0][k % 2], [f64::INFINITY, 9.0][k % 3 % 2])
            }
        })
        .collect();
    let rays = RayFile::new(queries.clone());
    let rows = World::new(all(), Starts::Exact).cast(&rays, &|_| ());
    let alone: Vec<Vec<_>> = all().into_iter().map(|own| World::new(vec![own], Starts::Exact).cast(&rays, &|_| ())).collect();
    let (mut seen, mut hits) = (HashSet::new(), 0);
    for (k, row) in rows.iter().enumerate() {
        let nearest = alone.iter().map(|rows| rows[k].t).fold(f64::INFINITY, f64::min);
        assert_eq!(row.t.is_finite(), nearest.is_finite(), "ray {k}");
        let Ok(instance) = usize::try_from(row.instance) else { continue };
        let own = &alone[instance][k];
        assert!(
            own.instance == 0 && (row.t, row.tree, row.triangle) == (own.t, own.tree, own.triangle) && row.normal == own.normal,
            "ray {k}"
        );
        assert!(queries[k].any || row.t == nearest, "ray {k}: {} {nearest}", row.t);
        assert!(row.t >= queries[k].t_min && row.t <= queries[k].t_max);
        seen.insert(instance);
        hits += 1;
    }
    assert!(hits > 1000 && seen.len() == 16, "{hits}, {}", seen.len());
}

/// One model in one place is what it was without a tree: its own memory and steps.
#[test]
fn a_scene_of_one_model_has_no_tree() {
    let scene = generated(procedural::Scene::Sphere, 3, 128);
    let method = made(&scene, &lod::METHOD);
    let camera = camera(&scene, [0.0, 0.0, 4.0], 16);
    let material = Material::Diffuse { albedo: None };
    let shot = Shot { scene: &scene, method: &*method, material, pose: unturned(), camera, delta: 1.0, starts: Starts::Exact };
    shot.with(
        &[],
        Some(EVERYWHERE),
        |paths| (paths.depth, paths.samples, paths.shadow_rays) = (0, 1, false),
        |paths| {
            let frame = PathFrame::new(paths).expect("few lines");
            let sight = paths.world.instances()[0].sight();
            assert_eq!(*frame.map(), method.map(sight));
            let (mut words, mut tracer) = (Vec::new(), method.tracer(sight));
            frame.produce(&mut |traced| {
                words.extend(traced.batches.iter().flat_map(|batch| batch.words().to_vec()));
                true
            });
            let mut recorder = Recorder::default();
            (0..camera.batches()).for_each(|batch| {
                camera.batch(batch, &mut |_, query| {
                    tracer.recorded(query, &mut recorder);
                })
            });
            assert_eq!(words, recorder.batch().words());
        },
    );
}

/// Sixteen balls side by side: rays ask those whose boxes they enter, and meet what they would meet if they asked all, whatever the order of the models.
#[test]
fn rays_ask_only_models_whose_boxes_they_enter() {
    let scene = generated(procedural::Scene::Sphere, 3, 128);
    let method = made(&scene, &lod::METHOD);
    let asked = AtomicU64::new(0);
    let counting = Counting { method: &*method, asked: &asked };
    let view = View { eye: Some([2.0, 6.0, 14.0]), target: Some([0.0; 3]), fov: 40.0, ..View::default() };
    let camera = Camera::new(&view, &ModelSpace::of(&scene), 64, 64).expect("a camera");
    let film = |order: &dyn Fn(usize) -> usize| {
        let instance = |k: usize| {
            let k = order(k);
            let [x, z] = [k % 4, k / 4].map(|k| 2.5 * k as f64 - 3.75);
            let pose = Pose::new([0.0, 20.0 * k as f64, 0.0], 1.0 + 0.02 * k as f64, [x, 0.0, z]);
            Instance::new(&scene, &counting, pose, vec![Material::Diffuse { albedo: None }], &camera, 1.0)
        };
        let world = World::new((0..16).map(instance).collect(), Starts::Exact);
        let (lights, cones) = (lights(), Default::default());
        let environment = Some(EVERYWHERE);
        Film::of(
            &Paths { world: &world, camera, lights: &lights, environment, cones, depth: 2, shadow_rays: true, samples: 4, seed: 1 },
            &|| (),
        )
    };
    let forward = film(&|k| k);
    let visits = asked.swap(0, Relaxed);
    let backward = film(&|k| 15 - k);
    assert_eq!((visits, &forward.light), (asked.load(Relaxed), &backward.light));
    let rays = forward.counts.all();
    let met: u64 = forward.counts.hits.iter().sum();
    assert!(met > 5_000 && visits > met && visits < 2 * rays, "{met} hits of {rays} rays, which asked {visits} models of {}", 16 * rays);
}

#[test]
fn what_has_no_exact_hits_says_so() {
    let scene = generated(procedural::Scene::Sphere, 1, 8);
    assert!(!made(&scene, &reference::METHOD).leaves() && made(&scene, &lod::METHOD).leaves());
}

fn lodray(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("lodray").expect("the program");
    command.current_dir(folder);
    command
}

const ROOM: &str = r#"
[picture]
width = 24
height = 16
samples = 4
depth = 2
[[camera]]
name = "front"
eye = [0, 0, 3.4]
target = [0, 0, 0]
[[model]]
generate = { scene = "room", levels = 2, base = 100 }
[environment]
zenith = [1, 1, 1]
horizon = [1, 1, 1]
ground = [1, 1, 1]
"#;

#[test]
fn a_description_becomes_pictures_and_figures() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("room.toml"), ROOM).expect("a file");
    let run = |arguments: &[&str]| lodray(folder.path()).arg("paths").args(arguments).assert().success().get_output().stdout.clone();
    run(&["room.toml", "-o", "a", "--compare", "--converged", "8"]);
    let figures: serde_json::Value = serde_json::from_slice(&run(&["room.toml", "-o", "b", "--json"])).expect("JSON");
    assert_eq!((figures["counts"]["rays"][0].as_u64(), figures["depth"].as_u64()), (Some(24 * 16 * 4), Some(2)));
    let read = |name: &str| fs::read(folder.path().join(name)).expect("a file");
    for name in ["paths.png", "paths.exr"] {
        assert_eq!(read(&format!("a/{name}")), read(&format!("b/{name}")), "{name}");
    }
    for name in ["full", "converged"] {
        let png = image::open(folder.path().join(format!("a/{name}.png"))).expect("a picture");
        assert_eq!((png.width(), png.height()), (24, 16));
    }
    assert_ne!(read("a/full.exr"), read("a/converged.exr"));
    let light = exr::prelude::read_first_rgba_layer_from_file(
        folder.path().join("a/paths.exr"),
        |size, _| vec![[0f32; 3]; size.area()],
        |pixels, at, (r, g, b, _): (f32, f32, f32, f32)| pixels[at.y() * 24 + at.x()] = [r, g, b],
    );
    let light = light.expect("light").layer_data.channel_data.pixels;
    assert!(light.iter().flatten().all(|c| c.is_finite() && *c >= 0.0) && light.iter().flatten().any(|c| *c > 0.1));

    let bounces: serde_json::Value =
        serde_json::from_slice(&run(&["room.toml", "-o", "c", "--machine", "haydel2023", "--json"])).expect("JSON");
    let of = |k: usize, key: &str| bounces[k][key].as_f64().expect("a number");
    assert_eq!(bounces.as_array().map(Vec::len), Some(3));
    for k in 1..3 {
        assert!(of(k, "rays") > of(k - 1, "rays") && of(k, "energy") > of(k - 1, "energy"));
        assert!((of(k, "milliseconds") - of(k - 1, "milliseconds") - of(k, "added_milliseconds")).abs() < 1e-12);
    }
    // On units for rays from surfaces, whose blocks are others.
    let results: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path().join("c/result.json")).expect("results")).expect("JSON");
    assert_eq!(results[2]["setup"]["machine"]["description"]["units"]["secondary"], true);
    let operations = &results[2]["operations"];
    assert!(operations["start_test"].as_u64() > Some(0) && operations["tree_deciders"].as_u64() > Some(0), "{operations}");
    assert!(operations["tri_test"].is_null() && results[2]["energy"]["compute"]["operations"]["start_test"].as_f64() > Some(0.0));
}

#[test]
fn bad_descriptions_are_one_line_that_names_file_and_key() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = [
        ("fov = 1", "[picture]", "[picture]\nfov = 1", "unknown field `fov`"),
        ("scale", "[[model]]", "[[model]]\nscale = -2", "a.toml: model[0].scale must be from 1e-12 to 1e12, but is -2"),
        ("levels", "levels = 2", "levels = 12", "a.toml: model[0].generate cannot be: 12 levels are too many"),
        ("eye", "eye = [0, 0, 3.4]", "eye = [0, 0, 0]", "a.toml: camera[0].eye must be another place than target"),
        ("far", "eye = [0, 0, 3.4]", "eye = [1e300, 0, 0]", "a.toml: camera[0].eye[0] must be from -1e12 to 1e12"),
        ("file", "generate = { scene = \"room\", levels = 2, base = 100 }", "file = \"none.lod\"", "none.lod"),
    ];
    for (name, from, to, wanted) in cases {
        assert!(ROOM.contains(from));
        fs::write(folder.path().join("a.toml"), ROOM.replace(from, to)).expect("a file");
        let output = lodray(folder.path()).args(["paths", "a.toml", "-o", "out"]).assert().failure().get_output().clone();
        let text = String::from_utf8(output.stderr).expect("text");
        assert!(text.contains(wanted) && text.contains("a.toml") && text.starts_with("error: "), "{name}: {text}");
        assert!(!folder.path().join("out").exists(), "{name}");
    }
    fs::write(folder.path().join("a.toml"), ROOM).expect("a file");
    for (arguments, wanted) in [
        (["--camera", "side"], "there is no camera 'side'; there are: front"),
        (["--starts", "-1"], "'-1' is not exact, independent, or a number from 0 on"),
        (["--machine", "none"], "there is no machine none"),
        (["--packet", "32"], "--packet: paths are traced one by one"),
    ] {
        let output = lodray(folder.path()).args(["paths", "a.toml", "-o", "out"]).args(arguments).assert().failure().get_output().clone();
        let text = String::from_utf8(output.stderr).expect("text");
        assert!(text.contains(wanted), "{text}");
    }
    let two = format!("{ROOM}\n[[model]]\ngenerate = {{ scene = \"sphere\", levels = 1, base = 8 }}\n");
    fs::write(folder.path().join("a.toml"), two).expect("a file");
    let by = |compute| lodray(folder.path()).args(["paths", "a.toml", "--machine", "haydel2023", "--json", "--compute", compute]).assert();
    let output = by("units").failure().get_output().clone();
    assert!(String::from_utf8(output.stderr).expect("text").contains("the scene has 2 models, and rays of traversal units go through one"));
    by("free").success();
    let result: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path().join("out/paths/result.json")).expect("results")).expect("JSON");
    write_rays(&folder.path().join("rays.npy"), 6, &[0.0, 0.0, 3.4, 0.0, 0.0, -1.0, 0.0, 9.0, 3.4, 0.0, 1.0, 0.0]);
    let cast = ["cast", "a.toml", "rays.npy", "-o", "hits.npy", "--json"];
    let output = lodray(folder.path()).args(cast).assert().success().get_output().clone();
    let figures: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!([&figures["models"], &figures["rays"], &figures["hits"]].map(serde_json::Value::as_u64), [Some(2), Some(2), Some(1)]);
    let of = &result[2]["setup"]["scene"];
    assert_eq!((of["name"].as_str(), of["base_triangles"].as_u64()), (Some("a.toml, 2 models"), Some(116)), "{of}");
    let of = &result[2]["operations"];
    assert!(of["instance_transform"].as_u64() > Some(0) && of["start_setup"].as_u64() > of["instance_transform"].as_u64(), "{of}");
}
