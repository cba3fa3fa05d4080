//! Small surfaces and a plain quad-BVH for tests and benchmarks.

use lodray::bvh::{Box32, Child, QuadNode, QuadTree, encode_line};
use lodray::format::{Box16, SceneInfo, TreeBvh};
use lodray::mesh::{BoundKind, Surface, lattice};
use lodray::num::VertexForm;

/// A surface over a base mesh: each lattice point is the weighted mean of the base vertices (summed in the order of their indices, so that
/// trees agree bit for bit on shared edges), then moved by `displace`.
pub fn surface(levels: u32, vertices: &[[f64; 3]], triangles: &[[u32; 3]], displace: impl Fn([f64; 3]) -> [f64; 3]) -> Surface {
    let m = 1u32 << levels;
    let mut positions = Vec::with_capacity(triangles.len() * lattice::len(levels));
    for t in triangles {
        for j in 0..=m {
            for i in 0..=m - j {
                let mut parts = [(t[0], m - i - j), (t[1], i), (t[2], j)];
                parts.sort_unstable();
                let mut p = [0.0; 3];
                for (v, w) in parts {
                    for k in 0..3 {
                        p[k] += vertices[v as usize][k] * f64::from(w) / f64::from(m);
                    }
                }
                positions.push(displace(p));
            }
        }
    }
    let normals = positions.iter().map(|p| [p[0] as f32 * 0.1, p[1] as f32 * 0.1, 1.0]).collect();
    Surface {
        levels,
        base_vertices: vertices.len() as u32,
        triangles: triangles.to_vec(),
        positions,
        normals,
        materials: triangles.iter().zip(0..).map(|(_, t)| t % 2).collect(),
        colours: vec![[0.2, 0.4, 0.8], [1.0, 0.5, 0.0]],
    }
}

/// Bumps of three sizes.
pub fn bumps(p: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = p;
    let h = 0.2 * (1.7 * x).sin() * (2.1 * y + z).cos() + 0.02 * (13.0 * x + 7.0 * y).sin() + 0.003 * (91.0 * y - 83.0 * x + 5.0 * z).sin();
    [x + 0.1 * h * z, y, z + h]
}

/// `side` x `side` quads of two triangles, with mixed diagonals.
pub fn grid(levels: u32, side: u32) -> Surface {
    let n = side + 1;
    let vertices: Vec<_> = (0..n * n).map(|v| [f64::from(v % n), f64::from(v / n), 0.0]).collect();
    let mut triangles = Vec::new();
    for y in 0..side {
        for x in 0..side {
            let [a, b, c, d] = [y * n + x, y * n + x + 1, (y + 1) * n + x, (y + 1) * n + x + 1];
            triangles.extend(if (x + y) % 2 == 0 { [[a, b, d], [d, c, a]] } else { [[b, d, c], [a, b, c]] });
        }
    }
    surface(levels, &vertices, &triangles, bumps)
}

/// A closed surface of eight trees.
pub fn octahedron(levels: u32) -> Surface {
    let v = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    let t = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    surface(levels, &v, &t, |p| {
        let r = p.iter().map(|c| c * c).sum::<f64>().sqrt();
        p.map(|c| c / r * (1.0 + 0.05 * (9.0 * p[0]).sin() * (8.0 * p[1] + 5.0 * p[2]).cos()))
    })
}

/// Three trees on one edge (two run along it one way, one the other), borders open, corners turned so that the edge is another side of each.
pub fn fan(levels: u32) -> Surface {
    let v = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.1, 0.5], [-1.0, 0.3, 0.4], [0.1, 1.0, 0.6]];
    surface(levels, &v, &[[0, 1, 2], [3, 1, 0], [1, 4, 0]], bumps)
}

/// A quad-BVH over boxes in their order, one per leaf slot.
pub fn quad_tree(boxes: &[Box16]) -> TreeBvh {
    // Codes have 16 bits, so code << 16 fits 32.
    let wide = |b: &Box16| Box32 { lo: b.lo.get().map(|c| (c << 16) as i32), hi: b.hi.get().map(|c| (c << 16) as i32) };
    let boxes: Vec<Box32> = boxes.iter().map(wide).collect();
    let mut tree = QuadTree { nodes: vec![QuadNode::default()], order: (0..boxes.len() as u32).collect() };
    fill(&mut tree.nodes, 0, &boxes, 0);
    let tree = tree.side_by_side();
    TreeBvh { nodes: tree.nodes.iter().map(encode_line).collect(), order: tree.order }
}

/// Splits `boxes`, the first of which is number `first`, below node `at`.
fn fill(nodes: &mut Vec<QuadNode>, at: usize, boxes: &[Box32], first: usize) {
    let parts = (0..4).map(|slot| boxes.len() * slot / 4..boxes.len() * (slot + 1) / 4).filter(|part| !part.is_empty());
    let mut below = Vec::new();
    for (slot, part) in parts.enumerate() {
        let own = &boxes[part.clone()];
        nodes[at].boxes[slot] = own[1..].iter().fold(own[0], |all, b| all.union(b));
        nodes[at].children[slot] = if own.len() == 1 {
            Child::Leaf { first: (first + part.start) as u32, count: 1 }
        } else {
            // Siblings stand side by side, before all that is below them.
            nodes.push(QuadNode::default());
            below.push((nodes.len() - 1, part));
            Child::Inner((nodes.len() - 1) as u32)
        };
    }
    for (index, part) in below {
        fill(nodes, index, &boxes[part.clone()], first + part.start);
    }
}

/// What a test's scene says about itself: the paper's bounds, exact vertices.
pub fn info(name: &str) -> SceneInfo {
    SceneInfo {
        name: name.into(),
        origin: serde_json::json!({ "made": "test" }),
        bounds: BoundKind::Largest,
        vertices: VertexForm::Exact,
        ..SceneInfo::default()
    }
}

/// The scene of a surface with a plain quad-BVH, the paper's bounds and exact vertices.
pub fn scene(surface: &Surface) -> lodray::format::Scene {
    scene_with(surface, BoundKind::Largest, VertexForm::Exact)
}

/// The scene of a surface with a plain quad-BVH.
pub fn scene_with(surface: &Surface, bounds: BoundKind, vertices: VertexForm) -> lodray::format::Scene {
    lodray::format::build(surface, SceneInfo { bounds, vertices, ..info("test") }, |boxes| Ok::<_, String>(quad_tree(boxes)))
        .expect("a valid surface")
}

/// Offset and length of section `kind` (1 to 9) in a scene file, as `docs/scene-format.md` says.
pub fn section(bytes: &[u8], kind: usize) -> (usize, usize) {
    let entry = 64 + 32 * (kind - 1);
    let word = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
    (word(entry + 8), word(entry + 16))
}

/// Makes all checksums right again.
pub fn reseal(bytes: &mut [u8]) {
    for kind in 1..=9 {
        let (offset, length) = section(bytes, kind);
        let sum = xxhash_rust::xxh3::xxh3_64(&bytes[offset..offset + length]);
        bytes[64 + 32 * (kind - 1) + 24..][..8].copy_from_slice(&sum.to_le_bytes());
    }
    bytes[24..32].fill(0);
    let sum = xxhash_rust::xxh3::xxh3_64(&bytes[..64 + 32 * 9]);
    bytes[24..32].copy_from_slice(&sum.to_le_bytes());
}
