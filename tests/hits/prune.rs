//! Scenes that are pruned for a job: the hits of its rays are the same to the bit in every field, by each traverser; the audit takes them; other rays are refused.

use lodray::format::audit::audit;
use lodray::format::{Job, JobRegion, Scene};
use lodray::golden::exact::Exact;
use lodray::hardware::Hardware;
use lodray::mesh::Surface;
use lodray::mesh::procedural::{self, Options, generate};
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::method::{ClosestHit, Hit};
use lodray::num::{Random, Ray, VertexForm};
use lodray::plan::{Measure, Plan, Reach};
use lodray::rays::{Camera, Eye, ModelSpace, Query, RaySource, View};
use lodray::sim::unit::environment::run;
use lodray::sim::unit::{Latency, SceneMemory, Traffic, TraversalUnit};
use lodray::step::NoSteps;
use lodray_test_support::models::build_with;
use lodray_test_support::plain::plain;
use lodray_test_support::program::{Desk, write_rays};
use lodray_test_support::surfaces::{bumps, grid, octahedron, surface};

/// Procedural scenes, and a grid that is flat but for one corner.
fn surfaces() -> Vec<Surface> {
    use procedural::Scene::{Cloth, Room, Sphere, Spikes, Terrain};
    let made = |kind| generate(&Options { levels: Some(4), base: Some(32), ..Options::new(kind) }).expect("a surface");
    let vertices: Vec<[f64; 3]> = (0..25).map(|k| [f64::from(k % 5), f64::from(k / 5), 0.0]).collect();
    let triangles: Vec<[u32; 3]> = (0..16).map(|k| k % 4 + 5 * (k / 4)).flat_map(|k| [[k, k + 1, k + 5], [k + 6, k + 5, k + 1]]).collect();
    let corner = surface(4, &vertices, &triangles, |p| if p[0] < 1.5 && p[1] < 1.5 { bumps(p) } else { p });
    [Terrain, Cloth, Sphere, Spikes, Room].into_iter().map(made).chain([corner, grid(3, 3), octahedron(4)]).collect()
}

fn camera(space: &ModelSpace, distance: f64, side: u32) -> Camera {
    Camera::new(&View { distance: Some(distance), ..View::default() }, space, side, side).expect("a camera")
}

/// The camera's rays that meet the model's box.
fn rays(camera: &Camera, space: &ModelSpace, delta: f64) -> Vec<Ray> {
    let pixels = (0..camera.width * camera.height).map(|i| camera.ray(i % camera.width, i / camera.width));
    pixels.filter_map(|query| Some(space.enter(&query, delta)?.ray)).collect()
}

fn pruned_for(scene: &Scene, views: &[(Camera, f64)]) -> Scene {
    let reach = Reach::of(scene);
    views.iter().for_each(|(camera, delta)| reach.add(camera, *delta));
    let views = views.iter().map(|(camera, delta)| camera.job_view(*delta)).collect();
    scene.pruned(&reach.depths(), Job { views, ..Job::default() }).expect("memory")
}

fn hits(scene: &Scene, rays: &[Ray]) -> Vec<Option<Hit>> {
    let mut traverser = LodTraverser::new(LodImage::of(scene));
    let trace = |ray| {
        let mut hit = ClosestHit::new(scene.levels());
        traverser.trace(ray, &mut NoSteps, &mut hit);
        hit.record()
    };
    rays.iter().map(trace).collect()
}

#[test]
fn hits_are_the_same_by_every_traverser() {
    let (mut less, mut met, mut kinds) = (0, 0, 0);
    for (surface, form) in surfaces().iter().flat_map(|surface| VertexForm::ALL.map(|form| (surface, form))) {
        let scene = build_with(surface, form);
        let space = ModelSpace::of(&scene);
        for (distance, delta) in [(2.5, 0.0), (1.2, 0.5), (2.0, 1.0), (6.0, 1.0), (30.0, 1.0), (3.0, 4.0), (2.5, f64::INFINITY)] {
            let camera = camera(&space, distance, 40);
            let pruned = pruned_for(&scene, &[(camera, delta)]);
            let rays = rays(&camera, &space, delta);
            let what = format!("{} {form:?} from {distance} at {delta}", scene.meta().name);
            let whole = hits(&scene, &rays);
            assert!(hits(&pruned, &rays) == whole, "{what}: functional");
            // Some of them through the slower ones.
            let (some, expected): (Vec<Ray>, Vec<_>) = rays.iter().copied().zip(whole).step_by(7).unzip();
            for of in [&scene, &pruned] {
                let h = of.decode();
                let golden = Exact::new(&h);
                assert!(some.iter().zip(&expected).all(|(ray, hit)| golden.trace(ray) == hit.as_ref().map(plain)), "{what}: golden");
            }
            let memory = SceneMemory::new(LodImage::of(&pruned), 77);
            let (measure, mut plan) = (Measure::of(&pruned), Plan::new(true));
            plan.add("it", &measure.needs());
            plan.add_rays(&measure.rays(&camera, delta));
            let mut unit = TraversalUnit::new(plan.hardware(&Hardware::default()), memory.config());
            let report = run(&mut unit, &memory, &Traffic::smooth(Latency::Fixed(9)), &some).expect("a run");
            let found = report.rays.iter().map(|ray| ray.hit.found.then_some(ray.hit.hit));
            assert!(found.eq(expected.iter().cloned()), "{what}: cycle model");
            let report = audit(&pruned);
            assert!(report.passed(), "{what}: {report}");
            met += expected.iter().flatten().count();
            less += u32::from(pruned.bytes_per_triangle() < scene.bytes_per_triangle());
            kinds += u32::from(pruned.trees_by_depth().iter().filter(|trees| **trees > 0).count() > 2);
            assert!(pruned.depths().iter().zip(scene.depths()).all(|(pruned, stored)| *pruned <= stored));
            assert!(delta > 0.0 || pruned.depths().iter().all(|&depth| depth == 0), "{what}");
        }
    }
    assert!(met > 5_000 && less > 40 && kinds > 10, "{met} hits, {less} smaller, {kinds} of many depths");
}

/// Rays from anywhere in a region, most of them towards the model, with its narrowest cones and wider ones.
fn from_region(region: &JobRegion, space: &ModelSpace, count: usize, seed: u64) -> Vec<(Query, f64)> {
    let (mut random, most) = (Random::new(seed), region.quality().expect("a number"));
    let mut next = |lo: f64, hi: f64| lo + (hi - lo) * 0.5 * (random.signed() + 1.0);
    let mut rays = Vec::new();
    for k in 0..count {
        // Corners of the box are where it is nearest.
        let origin: [f64; 3] =
            std::array::from_fn(
                |a| if k % 3 == 0 { [region.lo, region.hi][(k / (3 << a)) & 1][a] } else { next(region.lo[a], region.hi[a]) },
            );
        let corner = space.to_units([0.0; 3]);
        let at: [f64; 3] = std::array::from_fn(|a| {
            let side = next(f64::from(space.lo[a]), f64::from(space.hi[a]));
            (side - corner[a]) * space.placement.scale
        });
        let (wide, low) = (if k % 4 == 0 { next(1.0, 3.0) } else { 1.0 }, if k % 5 == 0 { next(0.2, 1.0) } else { 1.0 });
        let query = Query::new(origin, std::array::from_fn(|a| at[a] - origin[a]))
            .with_cone(if k % 7 == 0 { 1e-3 } else { 0.0 }, wide * region.cone);
        rays.push((query, if most.is_finite() { low * most } else { most }));
    }
    rays
}

#[test]
fn all_rays_of_a_region_hit_the_same() {
    let (mut less, mut met) = (0, 0);
    for (at, (surface, form)) in surfaces().iter().flat_map(|surface| VertexForm::ALL.map(|form| (surface, form))).enumerate() {
        let scene = build_with(surface, form);
        let space = ModelSpace::of(&scene);
        let (radius, centre) = (space.radius(), space.centre());
        // A box around a place so many radii away, so large; one holds the whole model.
        for (away, half, delta, cone) in [
            (1.5, 0.1, "1", 2e-3),
            (4.0, 1.0, "1", 2e-3),
            (4.0, 0.0, "0.5", 1e-2),
            (30.0, 8.0, "4", 1e-3),
            (0.0, 2.0, "1", 1e-3),
            (9.0, 1.0, "0", 1e-3),
            (9.0, 1.0, "inf", 1e-3),
        ] {
            let place = [0.3, 0.5, 0.81].map(|c| c * away * radius);
            let corner = |side: f64| std::array::from_fn(|k| centre[k] + place[k] + side * half * radius);
            let region = JobRegion { delta: delta.into(), lo: corner(-1.0), hi: corner(1.0), cone };
            let reach = Reach::of(&scene);
            reach.add_region(&region);
            let pruned = reach.pruned(Job { regions: vec![region.clone()], ..Job::default() }).expect("memory");
            let what = format!("{} {form:?} {region:?}", scene.meta().name);
            let asked = from_region(&region, &space, 1500, at as u64);
            assert!(asked.iter().all(|(query, delta)| region.beyond(*delta, query.origin, query.tan_theta).is_none()), "{what}");
            let rays: Vec<Ray> = asked.iter().filter_map(|(query, delta)| Some(space.enter(query, *delta)?.ray)).collect();
            let whole = hits(&scene, &rays);
            assert!(hits(&pruned, &rays) == whole, "{what}");
            // What each of the rays can do is no more than what all can.
            let single = Reach::of(&scene);
            for (query, delta) in asked.iter().step_by(50) {
                single.add(&One(*query), *delta);
            }
            assert!(single.depths().iter().zip(reach.depths()).all(|(one, all)| *one <= all), "{what}");
            let report = audit(&pruned);
            assert!(report.passed(), "{what}: {report}");
            met += whole.iter().flatten().count();
            less += u32::from(pruned.bytes_per_triangle() < scene.bytes_per_triangle());
            assert!(delta != "0" || pruned.depths().iter().all(|&depth| depth == 0), "{what}");
            assert!(delta != "inf" && away > 0.0 || pruned.bytes() == scene.bytes(), "{what}");
        }
    }
    assert!(met > 50_000 && less > 50, "{met} hits, {less} smaller");
}

/// One ray.
struct One(Query);

impl RaySource for One {
    fn rays(&self) -> u64 {
        1
    }
    fn batches(&self) -> usize {
        1
    }
    fn batch(&self, _: usize, each: &mut dyn FnMut(u64, &Query)) {
        each(0, &self.0);
    }
    fn least_radius(&self, _: &ModelSpace) -> f64 {
        0.0
    }
    fn eyes(&self, _: &ModelSpace) -> Vec<Eye> {
        vec![Eye::of(&self.0)]
    }
}

#[test]
fn only_levels_are_taken_away() {
    let scene = build_with(&octahedron(4), VertexForm::Compact);
    let space = ModelSpace::of(&scene);
    let whole = scene.pruned(&scene.depths(), Job::default()).expect("memory");
    assert!(whole.bytes() == scene.bytes());
    let view = camera(&space, 20.0, 32);
    let pruned = pruned_for(&scene, &[(view, 1.0)]);
    assert_eq!(
        (pruned.normals(), pruned.triangles(), pruned.colours(), pruned.nodes()),
        (scene.normals(), scene.triangles(), scene.colours(), scene.nodes())
    );
    assert_eq!((pruned.meta().lo, pruned.meta().hi, pruned.levels()), (scene.meta().lo, scene.meta().hi, 4));
    for tree in 0..scene.trees() {
        assert_eq!(pruned.corners(tree), scene.corners(tree));
        let depth = pruned.tree_lines(tree).depth;
        for level in 0..4 {
            for node in 0..1 << (2 * level) {
                let codes = if level < depth { scene.node_codes(tree, level, node) } else { [0; 3] };
                assert_eq!(pruned.node_codes(tree, level, node), codes);
            }
            assert!(level > depth || pruned.triangle(tree, level, 0) == scene.triangle(tree, level, 0));
        }
    }
    // More views, deeper trees.
    let both = pruned_for(&scene, &[(view, 1.0), (camera(&space, 3.0, 32), 1.0)]);
    assert!(both.depths().iter().zip(pruned.depths()).all(|(both, one)| *both >= one) && both.bytes().len() > pruned.bytes().len());
    assert_eq!(both.meta().job.len(), 2);
    // It opens as it was saved.
    let folder = tempfile::tempdir().unwrap();
    both.save(&folder.path().join("a.lod")).unwrap();
    let opened = Scene::open(&folder.path().join("a.lod")).unwrap();
    assert!(opened.bytes() == both.bytes() && opened.meta() == both.meta());
}

#[test]
fn the_papers_lines_are_those_of_whole_trees() {
    use lodray::method::lod::LineLayout;
    let scene = build_with(&grid(4, 2), VertexForm::Compact);
    let pruned = pruned_for(&scene, &[(camera(&ModelSpace::of(&scene), 6.0, 32), 1.0)]);
    assert!(pruned.bytes().len() < scene.bytes().len());
    let map = |scene| LodImage::with(scene, LineLayout::Paper).map;
    assert_eq!(map(&scene), map(&pruned));
}

const LIST: &str =
    "size = \"48x48\"\nmethods = [\"lod\"]\ndistances = [3, 20]\n[[scene]]\nfile = \"ball.lod\"\n[[machine]]\nname = \"haydel2023\"\n";

#[test]
fn a_pruned_scene_serves_its_job_and_refuses_all_else() {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.run("generate sphere --levels 4 --base 32 -o ball.lod");
    desk.write("jobs.toml", LIST);
    desk.run("plan --job jobs.toml -o plan.toml");
    assert!(desk.text("plan.toml").contains("[[views.sphere]]"), "{}", desk.text("plan.toml"));
    let shown = desk.run("prune ball.lod --plan plan.toml -o small.lod");
    assert!(shown.contains("2 views") && shown.contains("trees of 4 levels"), "{shown}");
    assert!(desk.bytes("small.lod").len() < desk.bytes("ball.lod").len());
    assert!(desk.run("verify small.lod").contains("passed"));
    let info = desk.run("info small.lod");
    assert!(info.contains("pruned for") && info.contains("tree depths"), "{info}");
    assert!(!desk.run("info ball.lod").contains("tree depths"));
    assert_eq!(desk.json("info small.lod")["job"].as_array().map(Vec::len), Some(2));

    // Its rays: the same pictures, the same figures of what was hit.
    for distance in [3, 20] {
        let render =
            |scene: &str, out: &str| desk.run(&format!("render {scene} --size 48x48 --distance {distance} --shading full -o {out}"));
        render("ball.lod", "whole");
        render("small.lod", "part");
        for picture in ["image.png", "levels.png", "normals.png"] {
            assert!(pixels(&desk, &format!("whole/{picture}")) == pixels(&desk, &format!("part/{picture}")), "{picture} from {distance}");
        }
    }
    let of_job = "--size 48x48 --distance 3";
    desk.run(&format!("simulate small.lod --machine haydel2023 {of_job} --method lod"));
    desk.run(&format!("trace small.lod {of_job} --pixel 20,20 --text"));

    // Others, each with the field that differs.
    let refused = |args: &str, words: &[&str]| desk.refused(args, 1, &[&["pruned for"], words].concat());
    refused(&format!("render small.lod {of_job} --shading full --delta 2 -o no"), &["delta is 2"]);
    refused("render small.lod --size 48x47 --distance 3 --shading full -o no", &["size is 48x47"]);
    refused("render small.lod --size 48x48 --distance 4 --shading full -o no", &["eye is"]);
    refused(&format!("render small.lod {of_job} --shading full --samples 4 -o no"), &["size is 96x96"]);
    refused(&format!("render small.lod {of_job} --shading full --method bvh -o no"), &["method: bvh"]);
    refused(&format!("render small.lod {of_job} --shading full --compare -o no"), &["method: reference"]);
    refused(&format!("render small.lod {of_job} -o no"), &["--shading facets"]);
    refused(&format!("trace small.lod {of_job} --pixel 20,20 --delta 0.5 --text"), &["delta is 0.5"]);
    refused(&format!("simulate small.lod --machine haydel2023 {of_job} --method bvh"), &["method: bvh"]);
    refused("simulate small.lod --machine haydel2023 --size 8x8 --distance 3 --method lod", &["size is 8x8"]);
    for any in ["lines small.lod", "crack small.lod", "export small.lod --level 1 -o no.obj", "prune small.lod --plan plan.toml -o no.lod"]
    {
        refused(any, &["job"]);
    }
    desk.write("sweep.toml", &LIST.replace("ball", "small"));
    assert!(desk.run("sweep sweep.toml -o swept").contains("0 failed"));
    desk.write("sweep.toml", &LIST.replace("ball", "small").replace("[3, 20]", "[3, 21]"));
    let (code, said) = desk.hear("sweep sweep.toml -o swept2");
    assert!(code == 1 && said.contains("pruned for a job, which has no such view: eye is"), "{said}");

    // Plans without what is needed.
    desk.run("plan ball.lod -o any.toml");
    desk.refused("prune ball.lod --plan any.toml -o no.lod", 1, &["views", "of no job"]);
    desk.run("generate cloth --levels 2 --base 32 -o cloth.lod");
    desk.refused("prune cloth.lod --plan plan.toml -o no.lod", 1, &["called cloth", "sphere"]);
    desk.write("bad.toml", &desk.text("plan.toml").replace("delta = \"1\"", "delta = \"one\""));
    desk.refused("prune ball.lod --plan bad.toml -o no.lod", 1, &["bad.toml: views.sphere[0].delta must be a number from 0 on, or inf"]);
    assert!(!desk.path("no.lod").exists() && !desk.path("no").exists());
}

#[test]
fn normals_are_left_out_where_nothing_is_shaded() {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.run("generate sphere --levels 4 --base 32 -o ball.lod");
    desk.write("jobs.toml", LIST);
    desk.run("plan --job jobs.toml -o plan.toml");
    desk.run("prune ball.lod --plan plan.toml -o with.lod");
    let shown = desk.run("prune ball.lod --plan plan.toml --no-normals -o without.lod");
    // 153 places in a tree of 4 splits, 4 bytes each.
    let trees = desk.json("info ball.lod")["base_triangles"].as_u64().expect("a number");
    let less = desk.bytes("with.lod").len() as u64 - desk.bytes("without.lod").len() as u64;
    // Up to what META has more.
    assert!(shown.contains("no normals: ") && less.abs_diff(trees * 153 * 4) <= 64, "{shown} {less}");
    assert!(desk.run("verify without.lod").contains("passed"));
    assert!(desk.run("info without.lod").contains("normals     left out"), "{}", desk.run("info without.lod"));
    // The same frame, to the cycle and the picojoule.
    let frame = |scene: &str| {
        let mut frame = desk.json(&format!("simulate {scene} --machine haydel2023 --size 48x48 --distance 3 --method lod"));
        (frame["cycles"].take(), frame["hits"].take(), frame["energy"].take())
    };
    assert_eq!(frame("with.lod"), frame("without.lod"));
    desk.run("trace without.lod --size 48x48 --distance 3 --pixel 20,20 --text");
    desk.write("sweep.toml", &LIST.replace("ball", "without"));
    assert!(desk.run("sweep sweep.toml -o swept").contains("0 failed"));
    // What is shaded is refused, also where nothing but the normals could be taken.
    desk.write("all.toml", &LIST.replace("methods", "deltas = [\"inf\"]\nmethods"));
    desk.run("plan --job all.toml -o all-plan.toml");
    desk.run("prune ball.lod --plan all-plan.toml --no-normals -o bare.lod");
    assert!(!desk.run("info bare.lod").contains("pruned for"));
    let refused = |args: &str| desk.refused(args, 1, &["without its normals"]);
    write_rays(&desk.path("in.npy"), 6, &[5.0, 0.0, 8.0, -5.0, 0.1, -8.0]);
    refused("render without.lod --size 48x48 --distance 3 --shading full -o no");
    for needs in ["render bare.lod -o no", "cast bare.lod in.npy -o no.npy", "export bare.lod --level 1 -o no.obj", "lines bare.lod"] {
        refused(needs);
    }
    desk.write("sweep.toml", &format!("error = true\n{}", LIST.replace("ball", "bare")));
    let (code, said) = desk.hear("sweep sweep.toml -o swept2");
    assert!(code == 1 && said.contains("without its normals"), "{said}");
    let (code, said) = desk.hear("error-time bare.lod -o measured --quick --size 8x8 --distances 3");
    assert!(code == 1 && said.contains("without its normals"), "{said}");
    desk.run("plan --job jobs.toml --within 0.05 -o grids.toml");
    desk.refused("prune ball.lod --plan grids.toml --no-normals -o no.lod", 1, &["--no-normals"]);
    assert!(!desk.path("no.lod").exists() && !desk.path("no").exists() && !desk.path("no.npy").exists());
}

/// The same for a box that cameras stay in, in place of views.
#[test]
fn a_scene_pruned_for_a_region_serves_all_rays_from_there() {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.run("generate sphere --levels 4 --base 32 -o ball.lod");
    let list = |regions: &str| LIST.replace("distances = [3, 20]\n", "").replace("[[machine]]", &format!("{regions}\n[[machine]]"));
    desk.write("jobs.toml", &list("regions = [{ from = [6, -2, 9], to = [4, 2, 7] }]"));
    desk.run("plan --job jobs.toml -o plan.toml");
    assert!(desk.text("plan.toml").contains("[[regions.sphere]]"), "{}", desk.text("plan.toml"));
    let shown = desk.run("prune ball.lod --plan plan.toml -o small.lod");
    assert!(shown.contains("0 views, 1 region;") && shown.contains("trees of 4 levels"), "{shown}");
    assert!(desk.bytes("small.lod").len() < desk.bytes("ball.lod").len());
    assert!(desk.run("verify small.lod").contains("passed"));
    assert!(
        desk.run("info small.lod").contains("rays that start between (4, -2, 7) and (6, 2, 9), at most delta 1"),
        "{}",
        desk.run("info small.lod")
    );
    // The whole scene and the pruned one fit the plan, on units of it.
    desk.run("plan --job jobs.toml --check plan.toml");
    let inside = "--size 48x48 --eye 5,1,8 --target 0.2,0,0";
    for scene in ["ball.lod", "small.lod"] {
        desk.run(&format!("simulate {scene} --machine haydel2023 {inside} --method lod --plan plan.toml"));
        desk.run(&format!("render {scene} {inside} --shading full -o {}", scene.replace(".lod", "")));
    }
    for picture in ["image.png", "levels.png", "normals.png"] {
        assert!(pixels(&desk, &format!("ball/{picture}")) == pixels(&desk, &format!("small/{picture}")), "{picture}");
    }
    // Rays of a file.
    let rays = |name: &str, x: f64, tan: f64| write_rays(&desk.path(name), 8, &[x, 0.0, 8.0, -x, 0.1, -8.0, 0.0, tan]);
    rays("in.npy", 5.0, 0.02);
    rays("out.npy", 6.1, 0.02);
    rays("thin.npy", 5.0, 1e-4);
    let cast = |scene: &str| desk.run(&format!("cast {scene}.lod in.npy -o {scene}.npy"));
    assert!(["ball", "small"].iter().all(|scene| cast(scene).contains("1 ray, 1 hit")));
    assert!(desk.bytes("ball.npy") == desk.bytes("small.npy"));
    desk.run("simulate small.lod --machine haydel2023 --rays in.npy --method lod");
    let refused = |args: &str, words: &[&str]| desk.refused(args, 1, &[&["pruned for rays from a region"], words].concat());
    refused("cast small.lod out.npy -o no.npy", &["ray 0: origin is [6.1"]);
    refused("simulate small.lod --machine haydel2023 --rays thin.npy --method lod", &["ray 0: cone is 0.0001"]);
    refused(&format!("render small.lod {inside} --shading full --delta 2 -o no"), &["delta is 2"]);
    refused("render small.lod --size 48x48 --eye 5,3,8 --shading full -o no", &["origin is [5.0, 3.0, 8.0]"]);
    refused("render small.lod --size 96x96 --eye 5,1,8 --shading full -o no", &["cone is"]);
    desk.refused("sweep jobs.toml -o no", 1, &["jobs.toml", "scene ball", "regions are for lodray plan"]);
    // Nothing that cannot be.
    for (regions, words) in [
        ("regions = []", ["line 5", "regions must not be empty"]),
        ("regions = [{ from = [0, 0, 0], to = [inf, 1, 1] }]", ["line 5", "regions: from and to must be finite"]),
        ("regions = [{ from = [nan, 0, 0], to = [1, 1, 1] }]", ["line 5", "regions: from and to must be finite"]),
        ("regions = [{ from = [0, 0, 0] }]", ["line 5", "missing field `to`"]),
    ] {
        desk.write("wrong.toml", &list(regions));
        desk.refused("plan --job wrong.toml", 1, &words);
    }
    desk.write("bad.toml", &desk.text("plan.toml").replace("delta = \"1\"", "delta = \"one\""));
    desk.refused("prune ball.lod --plan bad.toml -o no.lod", 1, &["regions.sphere[0].delta must be"]);
    assert!(!desk.path("no.lod").exists() && !desk.path("no").exists());
}

/// The pixels of a picture; its notes may differ.
fn pixels(desk: &Desk, name: &str) -> Vec<u8> {
    image::load_from_memory(&desk.bytes(name)).expect("a picture").to_rgba8().into_raw()
}
