//! Refitted scenes: what building anew from the same positions gives, byte for byte, and what the audit passes.

use lodray::bvh::{over_trees, refit_over_trees};
use lodray::format::audit::audit;
use lodray::format::{Grid, RefitError, RefitOptions, Scene, Shading, TreeBvh, build, decode_normal, encode, export_level, tree_boxes};
use lodray::mesh::{BoundKind, Surface, lattice, quantise};
use lodray::num::VertexForm;
use lodray::num::random::Random;
use lodray_test_support::surfaces::{fan, grid, info, octahedron, surface};

const KEEP: RefitOptions = RefitOptions { shading: Shading::Keep, grid: Grid::New };

fn surfaces() -> Vec<(&'static str, Surface)> {
    let twice = surface(3, &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2], [2, 1, 0]], lodray_test_support::surfaces::bumps);
    vec![("octahedron", octahedron(4)), ("grid", grid(3, 5)), ("fan", fan(2)), ("no splits", grid(0, 6)), ("twice", twice)]
}

fn scene_of(surface: &Surface, kind: BoundKind, form: VertexForm) -> Scene {
    build(surface, lodray::format::SceneInfo { bounds: kind, vertices: form, ..info("moving") }, over_trees).unwrap()
}

/// The surface with other positions.
fn moved(surface: &Surface, to: impl Fn([f64; 3]) -> [f64; 3]) -> Surface {
    Surface { positions: surface.positions.iter().map(|&p| to(p)).collect(), ..surface.clone() }
}

/// Positions of a scene's vertices from those of the surface that it is of.
fn positions(scene: &Scene, surface: &Surface) -> Vec<[f64; 3]> {
    let refit = scene.refitting().unwrap();
    let len = lattice::len(scene.levels());
    let mut positions = vec![[f64::NAN; 3]; refit.vertices()];
    for (at, &number) in refit.numbers().iter().enumerate() {
        positions[number as usize] = surface.tree(scene.source(at / len) as usize)[at % len];
    }
    positions
}

/// The scene of a surface with the trees in the order of another scene of it, and the tree of that one's quad-BVH.
fn built_anew(like: &Scene, surface: &Surface, kind: BoundKind, form: VertexForm) -> Scene {
    let h = quantise(surface, kind, form, 0).unwrap();
    let order: Vec<u32> = (0..like.trees()).map(|tree| like.source(tree)).collect();
    let own = tree_boxes(&h);
    let boxes: Vec<_> = order.iter().map(|&tree| own[tree as usize]).collect();
    let nodes = refit_over_trees(like.nodes(), &boxes);
    let info = lodray::format::SceneInfo { bounds: kind, vertices: form, ..info("moving") };
    encode(&h, surface, info, &TreeBvh { nodes, order }).unwrap()
}

fn forms() -> impl Iterator<Item = (BoundKind, VertexForm)> {
    BoundKind::ALL.into_iter().flat_map(|kind| VertexForm::ALL.map(|form| (kind, form)))
}

#[test]
fn vertices_are_in_the_order_of_an_export() {
    for (name, surface) in surfaces() {
        let scene = scene_of(&surface, BoundKind::Total, VertexForm::Compact);
        let mut text = Vec::new();
        export_level(&scene, scene.levels(), &mut text).unwrap();
        let text = String::from_utf8(text).unwrap();
        let exported = text.lines().filter_map(|line| line.strip_prefix("v ")).map(|line| {
            let mut words = line.split(' ').map(|word| word.parse::<f64>().unwrap());
            [0; 3].map(|_| words.next().unwrap())
        });
        assert!(exported.eq(scene.refitting().unwrap().positions()), "{name}");
    }
}

#[test]
fn the_positions_that_it_was_built_from_give_the_same_bytes() {
    for ((name, surface), (kind, form)) in surfaces().iter().flat_map(|s| forms().map(move |f| (s, f))) {
        let scene = scene_of(surface, kind, form);
        let again = scene.refit(&positions(&scene, surface), KEEP).unwrap();
        assert!(again.bytes() == scene.bytes(), "{name}, {kind:?}, {form:?}");
    }
}

#[test]
fn other_positions_give_the_bytes_of_a_scene_built_of_them() {
    let bend = |[x, y, z]: [f64; 3]| [x + 0.3 * (3.0 * y).sin(), 1.7 * y - 40.0, z * (1.0 + x * x) + 0.02 * (31.0 * x).cos()];
    for ((name, before), (kind, form)) in surfaces().iter().flat_map(|s| forms().map(move |f| (s, f))) {
        let scene = scene_of(before, kind, form);
        let mut after = moved(before, bend);
        let to = positions(&scene, &after);
        let kept = scene.refit(&to, KEEP).unwrap();
        assert!(kept.bytes() == built_anew(&scene, &after, kind, form).bytes(), "{name}, {kind:?}, {form:?}");
        assert!(kept.bytes() != scene.bytes() && audit(&kept).passed(), "{name}: {}", audit(&kept));

        // Normals are those that it made itself; everything else is as before.
        let smooth = scene.refit(&to, RefitOptions::default()).unwrap();
        let len = lattice::len(scene.levels());
        for (at, &code) in smooth.normals().iter().enumerate() {
            after.normals[scene.source(at / len) as usize * len + at % len] = decode_normal(code);
        }
        assert!(smooth.bytes() == built_anew(&scene, &after, kind, form).bytes(), "{name}, smooth");
    }
}

/// Refits that nobody would want: to a plane, to a line, to a point, a million times as large and far away, a millionth of the size, noise, inside out.
fn jumps(rest: &[[f64; 3]]) -> Vec<(&'static str, Vec<[f64; 3]>)> {
    let all = |to: &dyn Fn([f64; 3]) -> [f64; 3]| rest.iter().map(|&p| to(p)).collect();
    let mut random = Random::new(7);
    let mut noise = || random.next() as f64 / 2f64.powi(63) - 1.0;
    vec![
        ("plane", all(&|[x, y, _]| [x, y, 0.25])),
        ("line", all(&|[x, _, _]| [x, 2.0 * x, 0.0])),
        ("point", all(&|_| [3.0, -2.0, 1e3])),
        ("large", all(&|p| p.map(|c| 1e6 * c + 1e7))),
        ("small", all(&|p| p.map(|c| 1e-6 * c))),
        ("noise", rest.iter().map(|p| p.map(|c| c + noise())).collect()),
        ("inside out", all(&|p| p.map(|c| -c))),
    ]
}

#[test]
fn every_form_passes_the_audit_after_jumps_one_after_the_other() {
    for (name, surface) in surfaces() {
        for (kind, form) in forms() {
            let scene = scene_of(&surface, kind, form);
            let rest = positions(&scene, &surface);
            let mut refit = scene.refitting().unwrap();
            for (jump, to) in jumps(&rest) {
                for shading in Shading::ALL {
                    let options = RefitOptions { shading, ..KEEP };
                    // In place, whatever was there before, or anew: the same.
                    let once = scene.refit(&to, options).unwrap();
                    let in_turn = refit.move_to(&to, options).unwrap();
                    let report = audit(in_turn);
                    assert!(report.passed(), "{name}, {form:?}, {jump}: {report}");
                    let parts =
                        [lodray::format::FileSection::Splits, lodray::format::FileSection::Vertices, lodray::format::FileSection::Records];
                    assert!(parts.into_iter().all(|part| in_turn.section(part) == once.section(part)), "{name}, {form:?}, {jump}");
                    assert!(shading == Shading::Keep || in_turn.bytes() == once.bytes(), "{name}, {form:?}, {jump}");
                }
            }
            let back = refit.move_to(&rest, RefitOptions { shading: Shading::Smooth, ..KEEP }).unwrap().bytes().to_vec();
            assert!(back == scene.refit(&rest, RefitOptions::default()).unwrap().bytes());
        }
    }
}

#[test]
fn what_is_flat_now_is_no_longer_stored_and_comes_back() {
    let surface = grid(4, 3);
    let scene = scene_of(&surface, BoundKind::Total, VertexForm::Compact);
    let rest = positions(&scene, &surface);
    // Evenly spaced in a plane.
    let flat = positions(&scene, &lodray_test_support::surfaces::surface(4, &corners(3), &surface.triangles, |p| p));
    let mut refit = scene.refitting().unwrap();
    assert!(refit.move_to(&flat, KEEP).unwrap().splits().is_empty());
    assert!(refit.move_to(&rest, KEEP).unwrap().bytes() == scene.bytes());
}

fn corners(side: u32) -> Vec<[f64; 3]> {
    let n = side + 1;
    (0..n * n).map(|v| [f64::from(v % n), f64::from(v / n), 0.0]).collect()
}

#[test]
fn a_clone_keeps_its_vertices_and_threads_make_no_difference() {
    let surface = octahedron(4);
    let scene = scene_of(&surface, BoundKind::Total, VertexForm::Short);
    let rest = positions(&scene, &surface);
    let to: Vec<[f64; 3]> = rest.iter().map(|&[x, y, z]| [x, y, z + 0.2 * (5.0 * x).sin()]).collect();
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| scene.refit(&to, RefitOptions::default()).unwrap().bytes().to_vec())
    };
    assert!(on(1) == on(3));

    let mut refit = scene.refitting().unwrap();
    let first = refit.move_to(&to, KEEP).unwrap().clone();
    let bytes = first.bytes().to_vec();
    refit.move_to(&rest, KEEP).unwrap();
    assert!(first.bytes() == bytes && refit.scene().bytes() == scene.bytes());
}

#[test]
fn a_kept_grid_keeps_what_does_not_move_and_is_left_where_it_does_not_reach() {
    let surface = grid(3, 4);
    let scene = scene_of(&surface, BoundKind::Total, VertexForm::Exact);
    let refit = scene.refitting().unwrap();
    let stored = refit.positions();
    let keep = RefitOptions { shading: Shading::Keep, grid: Grid::Keep };
    // Positions as they are stored: every bit but what says how far they were moved when they were first stored.
    let again = scene.refit(&stored, keep).unwrap();
    assert_eq!(again.meta().placement, scene.meta().placement);
    assert!(again.splits() == scene.splits() && again.vertices() == scene.vertices() && again.records() == scene.records());

    let at = stored.iter().position(|p| (0.9..1.1).contains(&p[0]) && (1.4..1.6).contains(&p[1])).unwrap();
    let mut nudged = stored.clone();
    nudged[at][2] += 0.01;
    let moved = scene.refit(&nudged, keep).unwrap();
    let (before, after) = (scene.decode(), moved.decode());
    let differ = refit.numbers().iter().enumerate().filter(|&(point, _)| before.points[point] != after.points[point]);
    assert!(differ.map(|(_, &number)| number as usize).all(|number| number == at) && before.points != after.points);

    nudged[at][2] += 100.0;
    let outside = scene.refit(&nudged, keep).unwrap();
    assert!(outside.meta().placement.scale > 10.0 * scene.meta().placement.scale && audit(&outside).passed());
}

#[test]
fn smooth_normals_are_those_of_facets_and_creases_between_trees_stay() {
    // Two trees that meet along the y axis, each shaded as flat as it is.
    let v = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.5, 0.0], [-1.0, 0.5, 0.5]];
    let mut sharp = surface(2, &v, &[[0, 2, 1], [0, 1, 3]], |p| p);
    let len = lattice::len(2);
    let up = [[0.0, 0.0, 1.0], [0.447, 0.0, 0.894]];
    (0..2 * len).for_each(|at| sharp.normals[at] = up[at / len]);
    let mut round = sharp.clone();
    round.normals.fill([0.0, 0.0, 1.0]);
    let bent = |[x, y, z]: [f64; 3]| [x, y, z + x.abs()];
    let normals = |before: &Surface| {
        let scene = scene_of(before, BoundKind::Total, VertexForm::Exact);
        let after = scene.refit(&positions(&scene, &moved(before, bent)), RefitOptions::default()).unwrap();
        let of = |source| (0..2).find(|&tree| after.source(tree) == source).unwrap();
        // The middle of the common edge in both trees.
        [after.normal_at(of(0), (0, 2)), after.normal_at(of(1), (2, 0))]
    };
    let near = |a: [f32; 3], b: [f32; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-3);
    let [first, second] = normals(&sharp);
    // z = x and z = -x / 2 - x.
    let unit = |v: [f32; 3]| v.map(|c| c / v.iter().map(|c| c * c).sum::<f32>().sqrt());
    assert!(near(first, unit([-1.0, 0.0, 1.0])) && near(second, unit([1.5, 0.0, 1.0])), "{first:?} {second:?}");
    let [first, second] = normals(&round);
    assert!(first == second && first[2] > 0.9, "{first:?} {second:?}");
}

#[test]
fn what_does_not_fit_is_refused_and_changes_nothing() {
    let surface = grid(2, 2);
    let scene = scene_of(&surface, BoundKind::Total, VertexForm::Compact);
    let mut refit = scene.refitting().unwrap();
    let good = positions(&scene, &surface);
    let before = refit.move_to(&good, KEEP).unwrap().bytes().to_vec();
    let short = &good[1..];
    assert!(matches!(refit.move_to(short, KEEP), Err(RefitError::Count { found, expected }) if found + 1 == expected));
    let mut bad = good.clone();
    bad[5][1] = f64::NAN;
    let error = refit.move_to(&bad, KEEP).unwrap_err();
    assert!(matches!(error, RefitError::NotFinite { vertex: 5, .. }) && error.to_string().contains("position 5 is"), "{error}");
    let wide: Vec<[f64; 3]> = good.iter().map(|p| p.map(|c| c * 1.7e308)).collect();
    assert!(refit.move_to(&wide, KEEP).is_err());
    assert!(refit.scene().bytes() == before);
}
