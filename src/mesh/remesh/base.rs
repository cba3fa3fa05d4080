//! The base mesh: quadric edge collapse by `meshopt`.

use super::super::clean::TriangleMesh;
use super::source::Source;
use meshopt::{SimplifyOptions, VertexDataAdapter};
use std::collections::HashSet;

/// The original, cut where it bends by more than `crease` (radians), and a base mesh of about `wanted` triangles, each as three wedges of
/// the original; and how many collapsed triangles were dropped because they were degenerate or there twice.
pub(super) fn simplify(mesh: &TriangleMesh, wanted: usize, crease: f64) -> (Source, Vec<[u32; 3]>, usize) {
    let source = Source::new(mesh, crease);
    let (base, dropped) = collapse(&source, wanted);
    (source, base, dropped)
}

fn collapse(source: &Source, wanted: usize) -> (Vec<[u32; 3]>, usize) {
    if wanted >= source.wedges.len() {
        return (source.wedges.clone(), 0);
    }
    // One vertex for each wedge: feature lines become seams, which only collapse along themselves.
    let positions: Vec<[f32; 3]> = source.wedge_vertex.iter().map(|&v| source.positions[v as usize].to_array().map(|x| x as f32)).collect();
    let Ok(adapter) = VertexDataAdapter::new(bytemuck::cast_slice(&positions), size_of::<[f32; 3]>(), 0) else {
        return (source.wedges.clone(), 0);
    };
    let target = 3 * wanted;
    let mut indices = meshopt::simplify(source.wedges.as_flattened(), &adapter, target, 1.0, SimplifyOptions::RegularizeLight, None);
    // What stops early may go on from where it stopped.
    while indices.len() > target {
        let next = meshopt::simplify(&indices, &adapter, target, 1.0, SimplifyOptions::RegularizeLight, None);
        if next.len() >= indices.len() {
            break;
        }
        indices = next;
    }
    let mut seen = HashSet::new();
    let distinct = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|w| source.wedge_vertex[w as usize]);
        // A pair that faces both ways is a closed surface; the same triangle twice is not.
        let first = a.min(b).min(c);
        let key = if first == a {
            [a, b, c]
        } else if first == b {
            [b, c, a]
        } else {
            [c, a, b]
        };
        a != b && b != c && c != a && seen.insert(key)
    };
    let kept: Vec<[u32; 3]> = indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).filter(distinct).collect();
    let dropped = indices.len() / 3 - kept.len();
    if kept.is_empty() { (source.wedges.clone(), 0) } else { (kept, dropped) }
}
