//! Scene files: what is written comes back, and what is broken is refused.

use lodray::format::audit::reading;
use lodray::format::{Scene, export_level, level_mesh};
use lodray::mesh::{BoundKind, Hierarchy, edge_index, edges_of_tree, lattice, quantise};
use lodray::num::VertexForm;
use lodray_test_support::models::build_with;
use lodray_test_support::surfaces::{fan, grid, octahedron, scene, scene_with};

#[test]
fn a_saved_scene_opens_with_the_same_bytes() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a.lod");
    for levels in [0, 1, 2, 5] {
        for surface in [grid(levels, 3), octahedron(levels), fan(levels)] {
            for form in VertexForm::ALL {
                let built = scene_with(&surface, BoundKind::Largest, form);
                built.save(&path).unwrap();
                let opened = Scene::open(&path).unwrap();
                assert_eq!(opened.meta(), built.meta());
                assert!(opened.bytes() == built.bytes());
            }
        }
    }
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1, "temporary files stay behind");
}

#[test]
fn images_decode_to_the_hierarchy_that_they_were_made_from() {
    for levels in [0, 1, 2, 5] {
        for surface in [grid(levels, 3), octahedron(levels), fan(levels)] {
            for form in VertexForm::ALL {
                // Once with leaves in the order of the trees, once in an order that a quad-BVH makes.
                let hierarchy = quantise(&surface, BoundKind::Largest, form, 0).unwrap();
                for scene in [scene_with(&surface, BoundKind::Largest, form), build_with(&surface, form)] {
                    assert_eq!(scene.meta().vertices, form);
                    is_decoded(&scene, &hierarchy);
                    let back = scene.decode();
                    for tree in 0..scene.trees() {
                        let source = scene.source(tree) as usize;
                        assert_eq!(usize::from(scene.material(tree)), source % 2);
                        for i in 0..1usize << (2 * levels) {
                            let places = lattice::node(levels, levels, i as u32);
                            let expected = places.map(|p| back.tree(tree)[lattice::index(levels, p)]);
                            assert_eq!(scene.full_resolution_triangle(tree, i), expected);
                            let given = surface.normals[source * lattice::len(levels) + lattice::index(levels, places[0])];
                            let length = given.iter().map(|c| c * c).sum::<f32>().sqrt();
                            let normal = scene.normal_at(tree, places[0]);
                            assert!((0..3).all(|k| (normal[k] - given[k] / length).abs() < 1e-4));
                        }
                    }
                    // What META says of how far vertices were moved: nothing was moved farther, and something so far.
                    let size = surface.positions.iter().flatten().fold(0f64, |a, b| a.max(b.abs()));
                    let most = hierarchy.points.iter().zip(&surface.positions).fold(0f64, |most, (point, position)| {
                        let world = hierarchy.to_world(*point);
                        most.max((0..3).map(|k| (world[k] - position[k]).powi(2)).sum::<f64>().sqrt())
                    });
                    let moved = scene.meta().moved;
                    assert!((moved - most).abs() <= 1e-12 * size, "{form:?}: {moved}, {most}");
                    let most = match form {
                        VertexForm::Exact => 1e-6,
                        VertexForm::Compact => 1e-3,
                        VertexForm::Short => 1e-2,
                    };
                    assert!(moved < most * size, "{form:?}: {moved} of {size}");
                }
            }
        }
    }
}

/// The scene decodes to this hierarchy but for the order of its trees.
fn is_decoded(scene: &Scene, hierarchy: &Hierarchy) {
    let back = scene.decode();
    assert_eq!((back.levels, back.base_vertices, back.placement), (hierarchy.levels, hierarchy.base_vertices, hierarchy.placement));
    assert_eq!((back.vertices, back.bounds.kind, back.bounds.scale), (hierarchy.vertices, hierarchy.bounds.kind, hierarchy.bounds.scale));
    let mut seen = vec![false; scene.trees()];
    for tree in 0..scene.trees() {
        let source = scene.source(tree) as usize;
        assert!(!std::mem::replace(&mut seen[source], true));
        assert_eq!(back.triangles[tree], hierarchy.triangles[source]);
        assert!(back.tree(tree) == hierarchy.tree(source) && back.codes(tree) == hierarchy.codes(source), "tree {tree}");
    }
    assert_eq!(seen.len(), hierarchy.triangles.len());
}

#[test]
fn what_the_audit_reads_is_what_is_decoded() {
    let mut vertices = 0;
    for levels in [0, 1, 2, 5] {
        for surface in [grid(levels, 3), octahedron(levels), fan(levels)] {
            for form in VertexForm::ALL {
                let scene = build_with(&surface, form);
                let (back, read) = (scene.decode(), reading(&scene));
                assert!(read.points == back.points, "{form:?}, N = {levels}");
                let mut codes = vec![None; read.codes.len()];
                for tree in 0..scene.trees() {
                    for level in 0..levels {
                        for node in 0..1 << (2 * level) {
                            let p = lattice::node(levels, level, node);
                            for (q, [a, b]) in lattice::midpoints(p).into_iter().zip([[p[1], p[2]], [p[2], p[0]], [p[0], p[1]]]) {
                                let code = back.bounds.codes[tree * edges_of_tree(levels) + edge_index(levels, level, a, b)];
                                codes[tree * lattice::len(levels) + lattice::index(levels, q)] = Some(code);
                            }
                        }
                    }
                }
                assert!(read.codes == codes, "{form:?}, N = {levels}");
                vertices += read.points.len();
            }
        }
    }
    assert!(vertices > 10_000, "{vertices}");
}

#[test]
fn trees_are_as_deep_as_their_codes() {
    use lodray::mesh::procedural::{Options, Scene as Kind, generate};
    let made = |kind| generate(&Options { levels: Some(4), base: Some(48), ..Options::new(kind) }).unwrap();
    // Flat but for a bump: trees of every depth.
    let bump = |at: [f64; 3]| if (at[0] - 1.3).abs() + (at[1] - 1.7).abs() < 0.4 { [at[0], at[1], 0.1] } else { at };
    let vertices: Vec<[f64; 3]> = (0..16).map(|k| [f64::from(k % 4), f64::from(k / 4), 0.0]).collect();
    let square = |k: u32| [[k, k + 1, k + 4], [k + 5, k + 4, k + 1]];
    let triangles: Vec<[u32; 3]> = [0, 1, 2, 4, 5, 6, 8, 9, 10].into_iter().flat_map(square).collect();
    let flat = lodray_test_support::surfaces::surface(4, &vertices, &triangles, bump);
    let mut seen = [0; 5];
    for surface in [flat, made(Kind::Room), made(Kind::Terrain), octahedron(4), fan(0)] {
        for (form, kind) in VertexForm::ALL.into_iter().flat_map(|form| BoundKind::ALL.map(|kind| (form, kind))) {
            let (h, scene) = (quantise(&surface, kind, form, 0).unwrap(), scene_with(&surface, kind, form));
            let (mut splits, mut lines) = (0, 0);
            let mut depths = Vec::new();
            for tree in 0..scene.trees() {
                let source = scene.source(tree) as usize;
                let zero = |level: u32| {
                    (0..1u32 << (2 * level)).all(|node| h.node_codes(source, level, lattice::node(h.levels, level, node)) == [0; 3])
                };
                let depth = (0..=h.levels).find(|&level| (level..h.levels).all(zero)).unwrap();
                let inner: usize = (0..depth).map(|level| 1 << (2 * level)).sum();
                // All nodes that split but those of the last level, which has half lines where vertices are compact, quarters where they are short; a root always.
                let last = if depth < 2 { 0 } else { 1usize << (2 * (depth - 1)) };
                splits += inner - last;
                lines += match form {
                    VertexForm::Exact => inner,
                    VertexForm::Compact => last / 2,
                    VertexForm::Short => last / 4,
                };
                seen[depth as usize] += 1;
                depths.push(depth);
            }
            for (tree, &depth) in depths.iter().enumerate() {
                // Behind all deeper ones, and those as deep before it.
                let place = depths.iter().enumerate().filter(|&(other, of)| *of > depth || *of == depth && other < tree).count();
                let stored = scene.tree_lines(tree);
                assert_eq!((stored.depth, stored.place), (depth, place), "tree {tree}");
            }
            assert_eq!((scene.splits().len(), scene.vertices().len()), (splits, lines));
        }
    }
    assert!(seen.iter().all(|&trees| trees > 0), "{seen:?}");
}

/// Bits `high` to `low` of record `at` of so many bytes, as docs/scene-format.md numbers them.
fn bits(bytes: &[u8], size: usize, at: usize, [high, low]: [usize; 2]) -> u64 {
    let bit = |k: usize| u64::from(bytes[size * at + k / 8] >> (k % 8) & 1);
    (low..=high).rev().fold(0, |v, k| v << 1 | bit(k))
}

/// The same of a signed field.
fn signed(bytes: &[u8], size: usize, at: usize, field: [usize; 2]) -> i64 {
    let (v, width) = (bits(bytes, size, at, field), field[0] - field[1] + 1);
    (v << (64 - width)).cast_signed() >> (64 - width)
}

/// Full-resolution triangles by the words of docs/scene-format.md and nothing else.
struct Words<'a> {
    sections: [&'a [u8]; 9],
    levels: usize,
    compact: bool,
    short: bool,
    offset: u64,
}

impl Words<'_> {
    /// Bytes of an L0 record, and how many there are.
    fn records(&self) -> [usize; 2] {
        let size = if self.compact { 32 } else { 64 };
        [size, self.sections[2].len() / size]
    }

    fn corners(&self, tree: usize) -> [[i64; 3]; 3] {
        let [size, _] = self.records();
        std::array::from_fn(|v| {
            std::array::from_fn(|c| match self.compact {
                true => 1024 * signed(self.sections[2], size, tree, [197 - 66 * v - 22 * c, 176 - 66 * v - 22 * c]),
                false => 16 * signed(self.sections[2], size, tree, [507 - 84 * v - 28 * c, 480 - 84 * v - 28 * c]),
            })
        })
    }

    /// How many levels of the tree are stored, and its place.
    fn stored(&self, tree: usize) -> [usize; 2] {
        [[255, 252], [251, 224]].map(|field| bits(self.sections[2], self.records()[0], tree, field) as usize)
    }

    /// The trees that are deeper than that.
    fn deeper(&self, than: usize) -> usize {
        (0..self.records()[1]).filter(|&tree| self.stored(tree)[0] > than).count()
    }

    /// A node's split.
    fn split(&self, tree: usize, level: usize, node: usize) -> usize {
        let first: usize = (0..level).map(|m| 4usize.pow(m as u32) * self.deeper(if m == 0 { 0 } else { m + 1 })).sum();
        first + 4usize.pow(level as u32) * self.stored(tree)[1] + node
    }

    /// Codes of e0, e1, e2.
    fn codes(&self, tree: usize, level: usize, node: usize) -> [u64; 3] {
        let [depth, _] = self.stored(tree);
        if level >= depth {
            return [0; 3];
        }
        if level == 0 {
            return [223, 215, 207].map(|high| bits(self.sections[2], self.records()[0], tree, [high, high - 7]));
        }
        let split = self.split(tree, level - 1, node / 4);
        let places = [[0, 1, 2], [3, 4, 5], [6, 7, 8], [0, 4, 8]][node % 4];
        places.map(|place| bits(self.sections[3], 32, split, [74 + 8 * place, 67 + 8 * place]))
    }

    fn inserted(&self, tree: usize, level: usize, node: usize, p: [[i64; 3]; 3]) -> [[i64; 3]; 3] {
        let [depth, place] = self.stored(tree);
        if level >= depth {
            return std::array::from_fn(|v| std::array::from_fn(|c| (p[(v + 1) % 3][c] + p[(v + 2) % 3][c]) / 2));
        }
        let four = |level: usize| 4usize.pow(level as u32);
        if !self.compact {
            let line = (0..level).map(|m| four(m) * self.deeper(m)).sum::<usize>() + four(level) * place + node;
            let field = |v: usize, c: usize| signed(self.sections[4], 32, line, [251 - 84 * v - 28 * c, 224 - 84 * v - 28 * c]);
            return std::array::from_fn(|v| std::array::from_fn(|c| 16 * field(v, c)));
        }
        let codes = self.codes(tree, level, node);
        let half = || {
            let of_level = |m: usize| self.deeper(m) - self.deeper(m + 1);
            (1..level).map(|m| four(m) * of_level(m)).sum::<usize>() + four(level) * (place - self.deeper(level + 1)) + node
        };
        std::array::from_fn(|v| {
            let exponent = (self.levels - level + 3).max((((codes[v] + self.offset) / 16) as usize).saturating_sub(11));
            std::array::from_fn(|c| {
                let at = |highest: usize| [highest - 39 * v - 13 * c, highest - 12 - 39 * v - 13 * c];
                let d = if level == 0 || level + 1 < depth {
                    signed(self.sections[3], 32, self.split(tree, level, node), at(255))
                } else if self.short {
                    let low = 63 * (node % 4) + 56 - 21 * v - 7 * c;
                    64 * signed(self.sections[4], 32, half() / 4, [low + 6, low])
                } else {
                    signed(self.sections[4], 16, half(), at(116))
                };
                (p[(v + 1) % 3][c] + p[(v + 2) % 3][c]) / 2 + d * (1 << exponent)
            })
        })
    }

    /// Calls `visit` with level, node, corners and codes of every node, on level N without codes.
    fn each(
        &self,
        tree: usize,
        level: usize,
        node: usize,
        p: [[i64; 3]; 3],
        visit: &mut impl FnMut(usize, usize, [[i64; 3]; 3], [u64; 3]),
    ) {
        if level == self.levels {
            return visit(level, node, p, [0; 3]);
        }
        visit(level, node, p, self.codes(tree, level, node));
        let q = self.inserted(tree, level, node, p);
        for (k, child) in [[p[0], q[2], q[1]], [q[2], p[1], q[0]], [q[1], q[0], p[2]], q].into_iter().enumerate() {
            self.each(tree, level + 1, 4 * node + k, child, visit);
        }
    }
}

#[test]
fn the_words_of_the_document_are_enough_to_read_a_scene() {
    for levels in [0, 1, 2, 4] {
        for surface in [grid(levels, 2), octahedron(levels)] {
            for form in VertexForm::ALL {
                let scene = build_with(&surface, form);
                let bytes = scene.bytes();
                let sections: [&[u8]; 9] = std::array::from_fn(|k| {
                    let (offset, length) = lodray_test_support::surfaces::section(bytes, k + 1);
                    &bytes[offset..offset + length]
                });
                let meta: serde_json::Value = serde_json::from_slice(sections[0]).unwrap();
                let words = Words {
                    sections,
                    levels: meta["levels"].as_u64().unwrap() as usize,
                    compact: meta["vertices"] != "exact",
                    short: meta["vertices"] == "short",
                    offset: meta["bound_offset"].as_u64().unwrap(),
                };
                let mut nodes = 0;
                for tree in 0..meta["trees"].as_u64().unwrap() as usize {
                    let source = |field| bits(words.sections[7], 8, tree, field);
                    assert_eq!([source([31, 0]), source([63, 32])], [u64::from(scene.source(tree)), u64::from(scene.material(tree))]);
                    words.each(tree, 0, 0, words.corners(tree), &mut |level, node, p, codes| {
                        nodes += 1;
                        assert_eq!(scene.triangle(tree, level as u32, node).map(|p| p.map(i64::from)), p);
                        if level < words.levels {
                            assert_eq!(scene.node_codes(tree, level as u32, node).map(u64::from), codes);
                        }
                    });
                }
                assert_eq!(nodes, scene.trees() * (4usize.pow(levels + 1) - 1) / 3);
            }
        }
    }
}

#[test]
fn bytes_do_not_depend_on_the_number_of_threads() {
    let surface = grid(5, 4);
    for form in VertexForm::ALL {
        let with = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| build_with(&surface, form));
        assert!(with(1).bytes() == with(3).bytes());
    }
}

/// What opening these bytes says.
fn open(bytes: &[u8]) -> Result<Scene, String> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("broken.lod");
    std::fs::write(&path, bytes).unwrap();
    Scene::open(&path).map_err(|e| {
        let message = e.to_string();
        assert!(message.contains("broken.lod"), "{message} does not name the file");
        message
    })
}

#[test]
fn every_flipped_bit_is_noticed() {
    let good = scene(&octahedron(2)).bytes().to_vec();
    assert!(open(&good).is_ok());
    for at in 0..good.len() {
        let mut bytes = good.clone();
        bytes[at] ^= 1 << (at % 8);
        assert!(open(&bytes).is_err(), "byte {at}");
    }
    for (kind, name) in
        ["META", "NODES", "RECORDS", "SPLITS", "VERTICES", "NORMALS", "TRIANGLES", "SOURCES", "COLOURS"].into_iter().enumerate()
    {
        let (offset, length) = lodray_test_support::surfaces::section(&good, kind + 1);
        let mut bytes = good.clone();
        bytes[offset + length / 2] ^= 0x10;
        let message = open(&bytes).unwrap_err();
        assert!(message.contains(name) && message.contains("checksum"), "{message}");
    }
}

#[test]
fn truncated_long_foreign_and_newer_files_are_refused() {
    let good = scene(&octahedron(1)).bytes().to_vec();
    for length in 0..good.len() {
        assert!(open(&good[..length]).is_err(), "{length} bytes");
    }
    assert!(open(&good[..good.len() - 1]).unwrap_err().contains("truncated"));
    assert!(open(&[&good[..], &[0]].concat()).unwrap_err().contains("too long"));
    assert!(open(b"").unwrap_err().contains("magic"));
    assert!(open(b"solid ascii\nfacet normal 0 0 1").unwrap_err().contains("magic"));
    let mut newer = good.clone();
    newer[8] = 6;
    lodray_test_support::surfaces::reseal(&mut newer);
    assert!(open(&newer).unwrap_err().contains("newer"));
    for version in [1, 2, 3, 4] {
        let mut older = good.clone();
        older[8] = version;
        lodray_test_support::surfaces::reseal(&mut older);
        assert!(open(&older).unwrap_err().contains("make the scene again with build or generate"));
    }
    assert!(Scene::open(std::path::Path::new("/nonexistent/x.lod")).unwrap_err().to_string().contains("x.lod"));
    assert!(Scene::open(&std::env::temp_dir()).is_err());
}

/// Replaces text in META (of the same length) and opens the resealed file.
fn with_meta(good: &[u8], from: &str, to: &str) -> Result<Scene, String> {
    let (offset, length) = lodray_test_support::surfaces::section(good, 1);
    let at = good[offset..offset + length].windows(from.len()).position(|w| w == from.as_bytes()).expect("META holds the text");
    let mut bytes = good.to_vec();
    bytes[offset + at..][..to.len()].copy_from_slice(to.as_bytes());
    lodray_test_support::surfaces::reseal(&mut bytes);
    open(&bytes)
}

#[test]
fn resealed_nonsense_is_refused_with_section_and_field() {
    let good = scene(&octahedron(2)).bytes().to_vec();
    let word = |bytes: &mut [u8], at: usize, v: u64| bytes[at..at + 8].copy_from_slice(&v.to_le_bytes());
    let broken = |f: &dyn Fn(&mut [u8])| {
        let mut bytes = good.clone();
        f(&mut bytes);
        let sum_header_only = |bytes: &mut [u8]| {
            bytes[24..32].fill(0);
            let sum = xxhash_rust::xxh3::xxh3_64(&bytes[..352]);
            bytes[24..32].copy_from_slice(&sum.to_le_bytes());
        };
        sum_header_only(&mut bytes);
        open(&bytes).unwrap_err()
    };
    let (vertices, _) = lodray_test_support::surfaces::section(&good, 5);
    let entry = 64 + 32 * 4;
    for (message, parts) in [
        (broken(&|b| word(b, entry + 8, vertices as u64 + 4)), ["VERTICES", "misaligned"]),
        (broken(&|b| word(b, entry + 8, vertices as u64 - 64)), ["VERTICES", "offset"]),
        (broken(&|b| word(b, entry + 16, u64::MAX)), ["VERTICES", "past the end"]),
        (broken(&|b| word(b, entry, 10)), ["section table", "kind 10"]),
        (with_meta(&good, "\"levels\":2", "\"levels\":3").unwrap_err(), ["NORMALS", "3 splits"]),
        (with_meta(&good, "\"trees\":8", "\"trees\":7").unwrap_err(), ["RECORDS", "length"]),
        (with_meta(&good, "\"base_vertices\":6", "\"base_vertices\":5").unwrap_err(), ["TRIANGLES", "below 5"]),
        (with_meta(&good, "\"levels\":2", "\"levels\":x").unwrap_err(), ["META", "line"]),
        (with_meta(&good, "\"exact\"", "\"round\"").unwrap_err(), ["META", "round"]),
        (with_meta(&good, "\"moved\":", "\"moved\":-").unwrap_err(), ["META", "moved"]),
        (with_meta(&good, "\"scale\":", "\"scale\":-").map(|_| ()).unwrap_err(), ["META", ""]),
    ] {
        assert!(parts.iter().any(|p| message.contains(p)), "{message}");
    }
    // Base triangles that are named twice, or that there are none of.
    let (sources, _) = lodray_test_support::surfaces::section(&good, 8);
    for (source, words) in [
        (u32::from_le_bytes(good[sources + 8..][..4].try_into().unwrap()), "is named twice"),
        (8, "there is no base triangle 8, which tree 0 names"),
    ] {
        let mut bytes = good.clone();
        bytes[sources..][..4].copy_from_slice(&source.to_le_bytes());
        lodray_test_support::surfaces::reseal(&mut bytes);
        let message = open(&bytes).unwrap_err();
        assert!(message.contains("section SOURCES: ") && message.contains(words), "{message}");
    }
    // A quad-BVH that leads in a circle or nowhere: the root's first inner child, node 1's first leaf, kinds and counts.
    let (nodes, _) = lodray_test_support::surfaces::section(&good, 2);
    for (node, [high, low], value) in [
        (0, [238, 211], 0),
        (0, [238, 211], 999),
        (1, [210, 183], 8),
        (1, [210, 183], (1 << 28) - 1),
        (1, [240, 239], 3),
        (0, [248, 247], 3),
        (1, [248, 247], 1),
    ] {
        let mut bytes = good.clone();
        for k in low..=high {
            let byte = &mut bytes[nodes + 32 * node + k / 8];
            *byte = *byte & !(1 << (k % 8)) | ((value >> (k - low) & 1) as u8) << (k % 8);
        }
        lodray_test_support::surfaces::reseal(&mut bytes);
        let message = open(&bytes).unwrap_err();
        assert!(message.contains("NODES"), "{message}");
    }
}

#[test]
fn writing_where_nothing_can_be_written_is_an_error() {
    let scene = scene(&octahedron(1));
    for path in ["/nonexistent/a.lod", "/proc/a.lod"] {
        assert!(scene.save(std::path::Path::new(path)).unwrap_err().to_string().contains(path));
    }
}

#[test]
fn exported_levels_are_welded_by_topology() {
    for level in 0..=3u64 {
        let k = 1 << level;
        for (surface, vertices) in [(octahedron(3), 4 * k * k + 2), (fan(3), 5 + 7 * (k - 1) + 3 * (k - 1) * (k.max(2) - 2) / 2)] {
            let scene = scene(&surface);
            let mut obj = Vec::new();
            let counts = export_level(&scene, level as u32, &mut obj).unwrap();
            assert_eq!(counts.vertices, vertices);
            assert_eq!(counts.faces, scene.trees() as u64 * k * k);
            let options = tobj::LoadOptions::default();
            let (models, _) = tobj::load_obj_buf(&mut &obj[..], &options, |_| Err(tobj::LoadError::GenericFailure)).unwrap();
            assert_eq!(models[0].mesh.positions.len() as u64, 3 * vertices);
            assert_eq!(models[0].mesh.indices.len() as u64, 3 * counts.faces);
            // In memory it is the same; the reader numbers vertices as faces come to them.
            let mesh = level_mesh(&scene, level as u32).unwrap();
            assert_eq!([mesh.vertices.len() as u64, mesh.faces.len() as u64], [vertices, counts.faces]);
            for (&ours, &read) in mesh.faces.as_flattened().iter().zip(&models[0].mesh.indices) {
                assert_eq!(mesh.vertices[ours as usize], models[0].mesh.positions[3 * read as usize..][..3]);
            }
            // Faces stand in node order with their own corners.
            let node = k as usize * k as usize - 1;
            for (index, corner) in models[0].mesh.indices[3 * node..][..3].iter().zip(scene.triangle(0, level as u32, node)) {
                let world = scene.decode().to_world(corner);
                let found = &models[0].mesh.positions[3 * *index as usize..][..3];
                assert!((0..3).all(|c| (found[c] - world[c]).abs() < 1e-5));
            }
        }
    }
    assert!(export_level(&scene(&fan(1)), 2, Vec::new()).is_err() && level_mesh(&scene(&fan(1)), 2).is_err());
}
