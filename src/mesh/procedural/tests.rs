use super::super::lattice::{self, LatticePoint};
use super::*;
use std::collections::HashMap;

const ALL: [Scene; 9] = Scene::ALL;

fn small(scene: Scene, base: u32, levels: u32) -> Surface {
    generate(&Options { base: Some(base), levels: Some(levels), ..Options::new(scene) }).expect("valid options")
}

/// Bytes of everything a surface holds.
fn bytes(s: &Surface) -> Vec<u8> {
    let parts: [&[u8]; 5] = [
        bytemuck::cast_slice(&s.triangles),
        bytemuck::cast_slice(&s.positions),
        bytemuck::cast_slice(&s.normals),
        bytemuck::cast_slice(&s.materials),
        bytemuck::cast_slice(&s.colours),
    ];
    parts.concat()
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    base::dot(std::array::from_fn(|k| a[k] - b[k]), std::array::from_fn(|k| a[k] - b[k])).sqrt()
}

/// Calls `visit` with the distance of each vertex that split `level` inserts from the middle of its edge, and the edge's length.
fn displacements(s: &Surface, level: u32, mut visit: impl FnMut(f64, f64)) {
    for tree in 0..s.triangles.len() {
        let at = |p: LatticePoint| s.tree(tree)[lattice::index(s.levels, p)];
        for node in 0..1 << (2 * (level - 1)) {
            let p = lattice::node(s.levels, level - 1, node);
            let q = lattice::midpoints(p);
            for (i, q) in q.into_iter().enumerate() {
                let (a, b) = (at(p[(i + 1) % 3]), at(p[(i + 2) % 3]));
                visit(distance(at(q), std::array::from_fn(|k| a[k].midpoint(b[k]))), distance(a, b));
            }
        }
    }
}

/// Checks borders between trees to the bit and answers with (edges of two trees, edges of one tree).
fn check(s: &Surface) -> (usize, usize) {
    let len = lattice::len(s.levels);
    assert_eq!((s.positions.len(), s.normals.len()), (len * s.triangles.len(), len * s.triangles.len()));
    assert!(s.positions.iter().flatten().all(|c| c.is_finite()));
    assert!(s.normals.iter().all(|n| (n.iter().map(|c| c * c).sum::<f32>() - 1.0).abs() < 1e-3));
    if s.materials.is_empty() {
        assert!(s.colours.is_empty());
    } else {
        assert_eq!(s.materials.len(), s.triangles.len());
        assert!(s.materials.iter().all(|&m| usize::from(m) < s.colours.len()));
    }

    let m = 1u32 << s.levels;
    let corners = lattice::root(s.levels);
    let mut vertices: HashMap<u32, [u64; 3]> = HashMap::new();
    let mut edges: HashMap<(u32, u32), Vec<[u64; 3]>> = HashMap::new();
    let mut paired = 0;
    for (tree, t) in s.triangles.iter().enumerate() {
        assert!(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
        let at = |p: LatticePoint| s.tree(tree)[lattice::index(s.levels, p)].map(f64::to_bits);
        for i in 0..3 {
            assert!(t[i] < s.base_vertices);
            let corner = at(corners[i]);
            assert_eq!(*vertices.entry(t[i]).or_insert(corner), corner);
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            let border: Vec<_> = (0..=m).map(|k| at(((a.0 * (m - k) + b.0 * k) / m, (a.1 * (m - k) + b.1 * k) / m))).collect();
            let (from, to) = (t[i], t[(i + 1) % 3]);
            if let Some(mut other) = edges.remove(&(to, from)) {
                // A consistent winding walks a shared edge both ways.
                other.reverse();
                assert_eq!(border, other);
                paired += 1;
            } else {
                assert!(edges.insert((from, to), border).is_none(), "edge ({from}, {to}) twice the same way");
            }
        }
    }
    assert_eq!(vertices.len(), s.base_vertices as usize, "unused base vertices");
    (paired, edges.len())
}

#[test]
fn defaults_have_their_sizes() {
    for (scene, trees, levels, triangles) in [
        (Scene::Terrain, 512, 7, 8_388_608),
        (Scene::Cloth, 2_048, 5, 2_097_152),
        (Scene::Sphere, 512, 5, 524_288),
        (Scene::Spikes, 128, 4, 32_768),
        (Scene::Room, 2_688, 5, 2_752_512),
        (Scene::Wall, 36_400, 4, 9_318_400),
        (Scene::Street, 4_608, 5, 4_718_592),
        (Scene::Pot, 1_088, 5, 1_114_112),
        (Scene::Drape, 2_048, 5, 2_097_152),
    ] {
        let s = generate(&Options::new(scene)).expect("defaults are valid");
        assert_eq!((s.triangles.len(), s.levels, s.finest_triangles()), (trees, levels, triangles));
        check(&s);
    }
}

#[test]
fn trees_meet_to_the_bit_for_any_base_and_levels() {
    for scene in ALL {
        for base in [1, 2, 3, 8, 30, 100] {
            for levels in 0..=3 {
                let s = small(scene, base, levels);
                assert!(s.triangles.len() >= base as usize);
                let (paired, open) = check(&s);
                let closed = matches!(scene, Scene::Sphere | Scene::Spikes | Scene::Wall | Scene::Street | Scene::Pot);
                assert_eq!(open == 0, closed, "{scene:?}");
                assert_eq!(2 * paired + open, 3 * s.triangles.len());
                if closed {
                    // Euler: V - E + F = 2 for each body.
                    let bodies = match scene {
                        Scene::Wall => wall::MODELS as usize,
                        Scene::Street => street::MODELS as usize,
                        Scene::Pot => pot::PARTS.len(),
                        _ => 1,
                    };
                    assert_eq!(s.base_vertices as usize + s.triangles.len(), paired + 2 * bodies);
                }
            }
        }
        check(&small(scene, 1, if scene == Scene::Terrain { MAX_LEVELS } else { 6 }));
    }
}

#[test]
fn the_least_count_at_or_above_is_taken() {
    for scene in ALL {
        for base in 1..3_000 {
            let n = scene.grid(base);
            assert!(scene.trees(n, None) >= u64::from(base) && (n == 1 || scene.trees(n - 1, None) < u64::from(base)));
        }
        assert_eq!(scene.trees(scene.grid(scene.default_base()), None), u64::from(scene.default_base()));
    }
}

#[test]
fn closed_scenes_face_outwards() {
    for scene in [Scene::Sphere, Scene::Spikes] {
        let s = small(scene, 72, 2);
        for tree in 0..s.triangles.len() {
            for node in 0..16 {
                let [a, b, c] = lattice::node(2, 2, node).map(|p| s.tree(tree)[lattice::index(2, p)]);
                // Both are stars around the origin: every triangle is seen from its front.
                assert!(base::dot(a, base::cross(b, c)) > 0.0);
            }
        }
    }
}

#[test]
fn walls_of_a_room_are_as_fine_as_is_said() {
    let room = |walls| Options { levels: Some(1), base: Some(168), walls, ..Options::new(Scene::Room) };
    let count = |walls| generate(&room(walls)).unwrap().triangles.len();
    // A cloth of eight by eight quads, and ten triangles, two on each of five walls, for each quad of a wall.
    assert_eq!([None, Some(1), Some(2), Some(5)].map(count), [128 + 40, 128 + 10, 128 + 40, 128 + 250]);
    let plain = serde_json::to_string(&room(None)).unwrap();
    assert!(!plain.contains("walls"), "{plain}");
    let wrong = |options: Options| options.check().unwrap_err().to_string();
    assert_eq!(wrong(room(Some(0))), "0 quads along a wall of room: 1 to 1024 are possible, of room");
    assert_eq!(
        wrong(Options { walls: Some(3), ..Options::new(Scene::Cloth) }),
        "3 quads along a wall of cloth: 1 to 1024 are possible, of room"
    );
}

#[test]
fn a_terrain_is_as_wide_as_is_said_and_as_high_as_ever() {
    let terrain = |width| Options { levels: Some(2), base: Some(32), width, ..Options::new(Scene::Terrain) };
    let points = |width| {
        let s = generate(&terrain(width)).unwrap();
        (0..s.triangles.len()).flat_map(|t| s.tree(t).to_vec()).collect::<Vec<_>>()
    };
    let wide: Vec<_> = points(None).iter().map(|&[x, y, z]| [32.0 * x, y, 32.0 * z]).collect();
    assert_eq!(points(Some(64.0)), wide);
    assert_eq!(points(Some(2.0)), points(None));
    let wrong = |options: Options| options.check().unwrap_err().to_string();
    assert_eq!(wrong(Options { width: Some(3.0), ..Options::new(Scene::Cloth) }), "a cloth 3 wide: 0.5 to 1024 are possible, of terrain");
    assert!(wrong(terrain(Some(f64::NAN))).starts_with("a terrain NaN wide"));
}

#[test]
fn open_scenes_face_up_or_into_the_room() {
    let facing = |s: &Surface, tree: usize| {
        let [a, b, c] = lattice::root(s.levels).map(|p| s.tree(tree)[lattice::index(s.levels, p)]);
        let along = |p: [f64; 3]| std::array::from_fn(|k| p[k] - a[k]);
        (a, base::cross(along(b), along(c)))
    };
    let s = small(Scene::Terrain, 512, 2);
    assert!((0..s.triangles.len()).all(|t| facing(&s, t).1[1] > 0.0));
    let s = small(Scene::Room, 400, 2);
    let walls: Vec<_> = (0..s.triangles.len()).filter(|&t| s.materials[t] < 3).collect();
    assert!(!walls.is_empty());
    for t in walls {
        let (a, n) = facing(&s, t);
        assert!(base::dot(a, n) < 0.0, "towards the centre");
        let normal = s.normals[t * lattice::len(s.levels)].map(f64::from);
        assert!(base::dot(normal, n) > 0.0);
    }
}

#[test]
fn normals_follow_the_surface() {
    for (scene, base, levels, share) in [
        (Scene::Terrain, 512, 4, 0.8),
        (Scene::Cloth, 512, 4, 0.97),
        (Scene::Sphere, 128, 4, 0.9),
        (Scene::Pot, 512, 5, 0.97),
        (Scene::Drape, 512, 5, 0.97),
    ] {
        let s = small(scene, base, levels);
        let (mut good, mut all) = (0, 0);
        for tree in 0..s.triangles.len() {
            for node in 0..1 << (2 * levels) {
                let ids = lattice::node(levels, levels, node).map(|p| lattice::index(levels, p));
                let [a, b, c] = ids.map(|i| s.tree(tree)[i]);
                let along = |p: [f64; 3]| std::array::from_fn(|k| p[k] - a[k]);
                let face = base::unit(base::cross(along(b), along(c)));
                for i in ids {
                    all += 1;
                    good += u32::from(base::dot(s.normals[tree * s.tree(0).len() + i].map(f64::from), face) > 0.75);
                }
            }
        }
        assert!(f64::from(good) > share * f64::from(all), "{scene:?}: {good} of {all}");
    }
}

#[test]
fn same_seed_same_bytes_on_any_number_of_threads() {
    for scene in ALL {
        let options = Options { base: Some(200), levels: Some(4), seed: 7, ..Options::new(scene) };
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            bytes(&pool.install(|| generate(&options)).expect("valid options"))
        };
        let once = on(1);
        assert!(!once.is_empty());
        assert!(once == on(3));
        let other = |options| bytes(&generate(&options).expect("valid options")) != once;
        assert!(other(Options { seed: 8, ..options }));
        assert!(other(Options { seed: 7 + (1 << 32), ..options }));
        assert!(other(Options { roughness: Some(0.8), ..options }));
    }
}

#[test]
fn shapes_are_those_described() {
    let s = small(Scene::Terrain, 512, 5);
    let (low, high) = s.positions.iter().fold((f64::MAX, f64::MIN), |(l, h), p| (l.min(p[1]), h.max(p[1])));
    assert!((0.3..0.7).contains(&(high - low)), "{low} {high}");
    for k in [0, 2] {
        assert!(s.positions.iter().all(|p| p[k].abs() <= 1.0) && s.positions.iter().any(|p| p[k] == 1.0));
    }
    let s = small(Scene::Sphere, 512, 3);
    assert!(s.positions.iter().all(|&p| (0.5..1.5).contains(&distance(p, [0.0; 3]))));
    let s = small(Scene::Room, 2_688, 2);
    assert!(s.positions.iter().all(|p| p[0].abs() <= 1.0 && p[1].abs() <= 0.7 && p[2].abs() <= 1.0));
    assert!((0..4).all(|m| s.materials.contains(&m)));
    // The cloth is inside whatever its folds.
    for seed in 0..100 {
        let room = Options { seed, base: Some(400), levels: Some(1), ..Options::new(Scene::Room) };
        let s = generate(&room).expect("valid options");
        assert!(s.positions.iter().all(|p| p[0].abs() <= 1.0 && p[1].abs() <= 0.7 && p[2].abs() <= 1.0), "{seed}");
    }
}

#[test]
fn the_pot_faces_outwards_and_stands_on_its_plane() {
    let s = generate(&Options::new(Scene::Pot)).expect("defaults are valid");
    // Volumes by body, signed by the triangles' sides.
    let mut first = 0;
    let mut volumes = Vec::new();
    for part in pot::PARTS {
        let count = part.trees(8) as usize;
        let volume = (first..first + count).flat_map(|tree| (0..1 << 10).map(move |node| (tree, node))).map(|(tree, node)| {
            let [a, b, c] = lattice::node(5, 5, node).map(|p| s.tree(tree)[lattice::index(5, p)]);
            base::dot(a, base::cross(b, c)) / 6.0
        });
        volumes.push(volume.sum::<f64>());
        first += count;
    }
    assert_eq!(first, s.triangles.len());
    // Belly, lid, spout, handle.
    for (volume, range) in volumes.iter().zip([0.05..0.15, 0.003..0.02, 0.001..0.01, 0.001..0.01]) {
        assert!(range.contains(volume), "{volumes:?}");
    }
    let range = |k: usize| s.positions.iter().fold((f64::MAX, f64::MIN), |(l, h), p| (l.min(p[k]), h.max(p[k])));
    let [(left, right), (low, high), (back, front)] = [0, 1, 2].map(range);
    assert!((0.0..1e-3).contains(&low) && (0.5..0.6).contains(&high), "{low} {high}");
    assert!((0.9..1.2).contains(&(right - left)) && (right + left).abs() < 0.1, "{left} {right}");
    assert!((front + back).abs() < 0.01 && (0.6..0.7).contains(&(front - back)), "{back} {front}");
}

#[test]
fn spikes_jump_many_edge_lengths_and_more_on_finer_levels() {
    let s = generate(&Options::new(Scene::Spikes)).expect("defaults are valid");
    let mut most = Vec::new();
    for level in 1..=s.levels {
        let (mut jumps, mut largest) = (0, 0.0f64);
        displacements(&s, level, |d, edge| {
            jumps += u32::from(d > 10.0 * edge);
            largest = largest.max(d / edge);
        });
        most.push(largest);
        assert!(level < s.levels || jumps > 20, "{jumps}");
    }
    assert!(most.is_sorted() && most[most.len() - 1] > 15.0, "{most:?}");
}

#[test]
fn much_of_the_cloth_is_flat_and_some_is_not() {
    let s = generate(&Options::new(Scene::Cloth)).expect("defaults are valid");
    let (mut flat, mut folded, mut all) = (0, 0, 0);
    displacements(&s, 1, |d, edge| {
        all += 1;
        flat += u32::from(d < 0.02 * edge);
        folded += u32::from(d > 0.05 * edge);
    });
    assert!(flat * 2 > all && folded * 50 > all, "{flat} flat, {folded} folded of {all}");
    // The weave is there, and small.
    let mut woven = 0;
    displacements(&s, s.levels, |d, _| woven += u32::from(d > 1e-5));
    assert!(woven > 100_000, "{woven}");
}

#[test]
fn bad_options_are_errors() {
    for scene in ALL {
        let with = |levels, base, roughness| generate(&Options { levels, base, roughness, ..Options::new(scene) }).map(|_| ());
        assert_eq!(with(Some(11), None, None), Err(GenerateError::Levels(11)));
        assert_eq!(with(Some(u32::MAX), Some(1), None), Err(GenerateError::Levels(u32::MAX)));
        assert_eq!(with(None, Some(0), None), Err(GenerateError::Base(0)));
        assert!(matches!(with(Some(0), Some(u32::MAX), None), Err(GenerateError::Base(_))));
        assert!(matches!(with(Some(0), Some((1 << 27) + 1), None), Err(GenerateError::Base(_))));
        assert!(matches!(with(Some(10), Some(5_000), None), Err(GenerateError::Triangles { levels: 10, .. })));
        assert!(matches!(with(Some(5), Some(1 << 27), None), Err(GenerateError::Triangles { .. } | GenerateError::Base(_))));
        for roughness in [0.0, 1.0, -0.5, 2.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(with(Some(1), Some(2), Some(roughness)), Err(GenerateError::Roughness(_))));
        }
        for roughness in [f64::MIN_POSITIVE, 1e-9, 1.0 - 1e-16] {
            let s = generate(&Options { base: Some(2), levels: Some(4), roughness: Some(roughness), ..Options::new(scene) });
            check(&s.expect("valid options"));
        }
    }
}

#[test]
fn any_seed_is_finite() {
    for scene in ALL {
        for seed in [1, 2, 3, u64::MAX, 1 << 63] {
            check(&generate(&Options { seed, base: Some(20), levels: Some(3), ..Options::new(scene) }).expect("valid options"));
        }
    }
}
