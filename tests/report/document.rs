//! A small document of error against cost, made of a tiny scene: every figure but FLIP, SSIM and the converged picture is measured, and these stand in for the sake of the page.

use lodray::format::Scene;
use lodray::machine::Machine;
use lodray::method::bvh::NoStore;
use lodray::method::{Knobs, Method, Registered, SurfaceHit, find};
use lodray::picture::{Frame, compare, error_map, geometric_error, level_map, render, save_png, shaded, view_cosine};
use lodray::rays::{Camera, ModelSpace, Sight, View};
use lodray::report::error_time::*;
use lodray::report::inspect::{self, Subject};
use lodray::report::result::{MachineFacts, MethodFacts, SceneFacts, Setup, SimResult, ViewFacts};
use lodray::report::results_version;
use lodray::run::{Compute, FrameRays, Job, simulate};
use std::path::Path;

/// Method, and each value of its knob.
const METHODS: [(&str, &str, &[&str]); 4] =
    [("lod", "delta", &["0.25", "1", "4"]), ("bvh", "", &[""]), ("bvh32", "", &[""]), ("discrete", "level", &["1", "2", "3"])];
const GRID: [u32; 2] = [6, 5];

fn spread(mean: f64, percentile_99: f64, maximum: f64) -> ErrorSpread {
    ErrorSpread { mean, median: mean, percentile_99, maximum }
}

/// FLIP and SSIM stand in: they grow with the difference.
fn picture_error(a: &image::RgbImage, b: &image::RgbImage) -> PictureError {
    let error = compare(a, b);
    let flip = error.rmse / 255.0;
    PictureError {
        rmse: error.rmse,
        psnr_db: error.psnr_db,
        ssim: Some(1.0 - flip),
        flip: spread(flip, 2.0 * flip, 3.0 * flip),
        off: error.differing,
    }
}

struct Workshop<'a> {
    scene: &'a Scene,
    space: ModelSpace,
    machines: Vec<MachineFacts>,
}

impl Workshop<'_> {
    fn costs(&self, registered: &Registered, method: &dyn Method, knobs: &Knobs, camera: &Camera) -> Vec<Costs> {
        let sight = Sight::new(camera, &self.space, knobs.delta());
        let map = method.map(&sight);
        let jobs: Vec<_> = [Compute::Free, Compute::Units]
            .map(|compute| Job { machine: self.machines[0].description.clone(), compute, window: None })
            .into();
        let runs = simulate(&FrameRays { method, rays: camera, sight: &sight }, &jobs, &|_| ());
        let costs = runs.into_iter().zip(&jobs).map(|(run, job)| {
            let setup = Setup {
                scene: SceneFacts::from(self.scene),
                method: MethodFacts::new(registered, knobs, &method.choices(&sight), map.bytes()),
                view: Some(ViewFacts::new(camera)),
                rays: None,
                compute: job.compute,
                machine: self.machines[0].clone(),
            };
            let r = SimResult::new(setup, registered, &map, &run.unwrap()).unwrap();
            let e = &r.energy;
            let energy = Energy {
                unit: e.unit.clone(),
                total: e.total,
                l1: e.l1.total,
                l2: e.l2.total,
                dram: e.dram.total,
                compute: e.compute.total,
                leakage: e.leakage.total,
            };
            Costs {
                machine: 0,
                compute: job.compute.name().to_owned(),
                cycles: r.cycles,
                milliseconds: r.milliseconds,
                energy,
                dram_lines: r.dram.reads + r.dram.writes,
                dram_bytes: r.dram.bytes,
                l1_requests_per_ray: r.accesses_per_ray,
            }
        });
        costs.collect()
    }
}

/// The document of the scene in `folder/file`, its pictures in `folder/pictures`.
pub fn of(folder: &Path, file: &str, distances: &[f64], side: u32) -> ErrorTime {
    let scene = Scene::open(&folder.join(file)).unwrap();
    let description = Machine::shipped("haydel2023").unwrap();
    let machines = vec![MachineFacts { label: "haydel2023".to_owned(), set: Vec::new(), description }];
    let shop = Workshop { scene: &scene, space: ModelSpace::of(&scene), machines };
    let facts = SceneFacts::from(&scene);
    std::fs::create_dir_all(folder.join("pictures")).unwrap();
    let (mut views, mut points, mut pictures, mut traces, mut equal_error) = (Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (view, &distance) in distances.iter().enumerate() {
        let camera = Camera::new(&View { distance: Some(distance), ..View::default() }, &shop.space, side, side).unwrap();
        let truth = find("reference").unwrap();
        let truth = (truth.make)(&scene, &Knobs::default(), &NoStore).unwrap();
        let truth = render(&*truth, &shop.space, &camera, 1.0, &|| ());
        let full = shaded(&truth, &scene, &camera);
        let mut add = |method: &str, setting: &str, kind: &str, picture: &image::RgbImage| {
            let name = format!("pictures/{view}-{method}-{}-{kind}.png", setting.replace(' ', "-"));
            save_png(picture, &[], &folder.join(&name)).unwrap();
            let [method, setting, kind] = [method, setting, kind].map(str::to_owned);
            pictures.push(PictureEntry { view, method, setting, samples: 1, kind, file: name });
        };
        add("full", "full resolution", "image", &full);
        let shifted = image::imageops::resize(
            &image::imageops::resize(&full, side / 2, side / 2, image::imageops::Triangle),
            side,
            side,
            image::imageops::Triangle,
        );
        let eye = camera.eye.to_array();
        let shift = vec![Shift { samples: 1, picture: picture_error(&shifted, &full) }];
        views.push(ViewEntry {
            scene: 0,
            distance,
            eye,
            size: [side, side],
            converged: Some(Converged { samples: 64, standard_error: 0.5 }),
            shift,
        });
        for (name, knob, values) in METHODS {
            for value in values {
                let registered = find(name).unwrap();
                let mut knobs = Knobs::default();
                if let Some(knob) = registered.knobs.iter().find(|own| own.name == knob) {
                    knobs.set(knob, value).unwrap();
                }
                let method = (registered.make)(&scene, &knobs, &NoStore).unwrap();
                let frame = render(&*method, &shop.space, &camera, knobs.delta(), &|| ());
                let image = shaded(&frame, &scene, &camera);
                let setting = if knob.is_empty() { "full resolution".to_owned() } else { format!("{knob} {value}") };
                if *value == values[values.len() / 2] {
                    add(name, &setting, "image", &image);
                    add(name, &setting, "error", &error_map(&image, &full));
                    add(name, &setting, "levels", &level_map(&frame));
                    let subject = Subject { scene: &scene, file, registered, method: &*method, delta: knobs.delta(), camera: &camera };
                    traces.push(TraceGrid { view, setting: setting.clone(), ..inspect::rays(&subject, GRID) });
                }
                let sight = Sight::new(&camera, &shop.space, knobs.delta());
                let bytes = method.map(&sight).bytes();
                points.push(Point {
                    view,
                    method: name.to_owned(),
                    setting,
                    knobs: if knob.is_empty() { Default::default() } else { [(knob.to_owned(), (*value).to_owned())].into() },
                    choices: method.choices(&sight).into_iter().map(|(name, value)| (name.to_owned(), value)).collect(),
                    samples: 1,
                    bytes,
                    bytes_per_triangle: bytes as f64 / facts.finest_triangles as f64,
                    geometry: geometry(&frame, &truth, &scene, &camera),
                    picture: picture_error(&image, &full),
                    viewed: Some(picture_error(&image, &shifted)),
                    costs: shop.costs(registered, &*method, &knobs, &camera),
                });
            }
        }
        let time = |name: &str| points.iter().find(|p| p.view == view && p.method == name).unwrap().costs[0].milliseconds;
        let (ours, bvh) = (time("lod"), time("bvh"));
        let why = |method: &str, why: &str| EqualCost { method: method.to_owned(), cost: None, ratio: None, why: Some(why.to_owned()) };
        let methods = vec![
            EqualCost { method: "bvh".to_owned(), cost: Some(bvh), ratio: Some(bvh / ours), why: None },
            why("discrete", "not reached"),
        ];
        let (error, cost, compute) = ("surface_percentile_99".to_owned(), "milliseconds".to_owned(), "free".to_owned());
        equal_error.push(EqualError { view, samples: 1, error, level: 0.5, cost, machine: 0, compute, ours: Some(ours), methods });
    }
    let entry = SceneEntry {
        name: facts.name,
        file: file.to_owned(),
        hash: "0123456789abcdef".to_owned(),
        levels: facts.levels,
        base_triangles: facts.base_triangles,
        finest_triangles: facts.finest_triangles,
        bounds: "largest".to_owned(),
    };
    let method = |(name, knob, _): &(&str, &str, &[&str])| MethodEntry {
        name: (*name).to_owned(),
        knob: (!knob.is_empty()).then(|| (*knob).to_owned()),
        help: find(name).unwrap().help.to_owned(),
    };
    ErrorTime {
        kind: KIND.to_owned(),
        version: VERSION,
        program: format!("lodray {}", results_version()),
        options: Options { size: [side, side], samples: vec![1], shading: "full".to_owned(), pixels_per_degree: 67.02, nearest_stride: 1 },
        scenes: vec![entry],
        machines: shop.machines,
        methods: METHODS.iter().map(method).collect(),
        views,
        points,
        equal_error,
        pictures,
        traces,
    }
}

fn geometry(frame: &Frame, truth: &Frame, scene: &Scene, camera: &Camera) -> GeometryErrors {
    let cosine = |index, pixel: &SurfaceHit| f64::from(view_cosine(scene, camera, index, pixel));
    let error = geometric_error(frame, truth, camera, cosine).map(|e| spread(e.mean, e.percentile_99, e.maximum));
    let alone = frame.pixels.iter().zip(&truth.pixels).filter(|(a, b)| a.is_some() != b.is_some()).count() as u64;
    let silhouette = Silhouette { pixels: alone, share: alone as f64 / frame.pixels.len() as f64 };
    GeometryErrors { hit: error, surface: error, normal_degrees: None, silhouette }
}

/// The same of `scenes` scenes at `distances` distances, with pictures of `side` that are hard to compress: for the weight of a large page.
pub fn enlarged(one: &ErrorTime, folder: &Path, scenes: usize, distances: usize, side: u32) -> ErrorTime {
    let mut noise = 1u32;
    for k in 0..4 {
        let mut draw = |_, y: u32| {
            noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let v = ((noise >> 27) + y * 200 / side) as u8;
            image::Rgb([v, v, v.wrapping_add(9)])
        };
        save_png(&image::RgbImage::from_fn(side, side, &mut draw), &[], &folder.join(format!("pictures/noise-{k}.png"))).unwrap();
    }
    let mut all = ErrorTime {
        views: Vec::new(),
        points: Vec::new(),
        pictures: Vec::new(),
        traces: Vec::new(),
        equal_error: Vec::new(),
        scenes: Vec::new(),
        ..one.clone()
    };
    for scene in 0..scenes {
        all.scenes.push(SceneEntry { name: format!("scene {scene}"), ..one.scenes[0].clone() });
        for k in 0..distances {
            let view = all.views.len();
            all.views.push(ViewEntry { scene, distance: 0.5 * 2f64.powi(k as i32), size: [side, side], ..one.views[0].clone() });
            all.points.extend(one.points.iter().filter(|p| p.view == 0).map(|p| Point { view, ..p.clone() }));
            all.traces.extend(one.traces.iter().filter(|t| t.view == 0).map(|t| TraceGrid { view, size: [side, side], ..t.clone() }));
            all.equal_error.extend(one.equal_error.iter().filter(|e| e.view == 0).map(|e| EqualError { view, ..e.clone() }));
            let picture =
                |(k, p): (usize, &PictureEntry)| PictureEntry { view, file: format!("pictures/noise-{}.png", k % 4), ..p.clone() };
            all.pictures.extend(one.pictures.iter().filter(|p| p.view == 0).enumerate().map(picture));
        }
    }
    all
}
