//! Small surfaces and a plain quad-BVH for tests and benchmarks.

use lodray::format::{Box16, BvhChild, ChildRef, SceneInfo};
use lodray::mesh::{BoundKind, Surface, lattice};
use lodray::num::Wire;

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
pub fn quad_tree(boxes: &[Box16]) -> Vec<[u64; 8]> {
    let mut nodes = vec![[0; 8]];
    fill(&mut nodes, 0, boxes, 0);
    nodes
}

fn fill(nodes: &mut Vec<[u64; 8]>, node: usize, boxes: &[Box16], first: usize) -> Box16 {
    let mut all: Option<Box16> = None;
    for slot in 0..4 {
        let (from, to) = (boxes.len() * slot / 4, boxes.len() * (slot + 1) / 4);
        let (child, bounds) = match to - from {
            0 => continue,
            1 => (ChildRef::leaf((first + from) as u32, 1), boxes[from]),
            _ => {
                let index = nodes.len();
                nodes.push([0; 8]);
                (ChildRef::inner(index as u32), fill(nodes, index, &boxes[from..to], first + from))
            }
        };
        BvhChild { child, bounds }.to_words(&mut nodes[node][2 * slot..2 * slot + 2]);
        all = Some(all.map_or(bounds, |a| union(a, bounds)));
    }
    all.unwrap_or_default()
}

fn union(a: Box16, b: Box16) -> Box16 {
    let pick = |f: fn(i64, i64) -> i64, a: [i64; 3], b: [i64; 3]| std::array::from_fn(|k| f(a[k], b[k]) as i16);
    Box16::from_codes(pick(i64::min, a.lo.get(), b.lo.get()), pick(i64::max, a.hi.get(), b.hi.get()))
}

pub fn info(name: &str) -> SceneInfo {
    SceneInfo { name: name.into(), origin: serde_json::json!({ "made": "test" }), bounds: BoundKind::Largest }
}

/// The scene of a surface with a plain quad-BVH and the paper's bounds.
pub fn scene(surface: &Surface) -> lodray::format::Scene {
    scene_with(surface, BoundKind::Largest)
}

/// The scene of a surface with a plain quad-BVH.
pub fn scene_with(surface: &Surface, bounds: BoundKind) -> lodray::format::Scene {
    lodray::format::build(surface, SceneInfo { bounds, ..info("test") }, |boxes| Ok::<_, String>(quad_tree(boxes)))
        .expect("a valid surface")
}

/// Offset and length of section `kind` (1 to 8) in a scene file, as `docs/scene-format.md` says.
pub fn section(bytes: &[u8], kind: usize) -> (usize, usize) {
    let entry = 64 + 32 * (kind - 1);
    let word = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
    (word(entry + 8), word(entry + 16))
}

/// Makes all checksums right again.
pub fn reseal(bytes: &mut [u8]) {
    for kind in 1..=8 {
        let (offset, length) = section(bytes, kind);
        let sum = xxhash_rust::xxh3::xxh3_64(&bytes[offset..offset + length]);
        bytes[64 + 32 * (kind - 1) + 24..][..8].copy_from_slice(&sum.to_le_bytes());
    }
    bytes[24..32].fill(0);
    let sum = xxhash_rust::xxh3::xxh3_64(&bytes[..64 + 32 * 8]);
    bytes[24..32].copy_from_slice(&sum.to_le_bytes());
}
