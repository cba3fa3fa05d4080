//! Triangles per second of the full-resolution quad-BVH, by leaf size.
//!
//! `LODRAY_BENCH_LEVELS` (default 5: 0.5 M triangles) sets the splits of the 512 trees; 7 makes 8.4 M triangles.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use lodray::bvh::{FullBvh, FullOptions, LeafLayout, Options};
use lodray::mesh::{EdgeCodes, Hierarchy, Placement};
use lodray::num::snap;
use std::hint::black_box;

/// Base quads per side.
const QUADS: u32 = 16;

/// Hills with hashed roughness.
fn terrain(levels: u32) -> Hierarchy {
    let m = 1u32 << levels;
    let side = f64::from(QUADS * m);
    let point = |x: u32, y: u32| {
        let hash =
            ((u64::from(x) << 32) | u64::from(y)).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let (u, v) = (f64::from(x) / side, f64::from(y) / side);
        let height = (17.0 * u).sin() * (13.0 * v).cos() * 0.05 + (hash >> 40) as f64 / f64::from(1u32 << 25) / side;
        [u * 1.9 - 0.95, v * 1.9 - 0.95, height].map(|c| snap(c * f64::from(1u32 << 31), levels))
    };
    let mut triangles = Vec::new();
    let mut points = Vec::new();
    for (qy, qx) in (0..QUADS).flat_map(|y| (0..QUADS).map(move |x| (y, x))) {
        let v = |x: u32, y: u32| y * (QUADS + 1) + x;
        triangles.push([v(qx, qy), v(qx + 1, qy), v(qx, qy + 1)]);
        triangles.push([v(qx + 1, qy + 1), v(qx, qy + 1), v(qx + 1, qy)]);
        for turned in [false, true] {
            for (j, i) in (0..=m).flat_map(|j| (0..=m - j).map(move |i| (j, i))) {
                let (i, j) = if turned { (m - i, m - j) } else { (i, j) };
                points.push(point(qx * m + i, qy * m + j));
            }
        }
    }
    let placement = Placement { offset: [0.0; 3], scale: 1.0 };
    Hierarchy { levels, placement, base_vertices: (QUADS + 1) * (QUADS + 1), triangles, points, bounds: EdgeCodes::default() }
}

fn full_resolution(c: &mut Criterion) {
    let levels = std::env::var("LODRAY_BENCH_LEVELS").ok().and_then(|v| v.parse().ok()).unwrap_or(5).min(8);
    let h = terrain(levels);
    let mut group = c.benchmark_group("full_bvh");
    group.sample_size(10).throughput(Throughput::Elements(h.finest_triangles()));
    for max_leaf in [1, 2, 4] {
        for layout in [LeafLayout::Line, LeafLayout::Packed, LeafLayout::Indexed] {
            let options = FullOptions { tree: Options::with_leaf(max_leaf), wide_boxes: false, layout };
            group.bench_with_input(BenchmarkId::new(format!("{layout:?}"), max_leaf), &options, |b, o| {
                b.iter(|| black_box(FullBvh::build(&h, o)));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, full_resolution);
criterion_main!(benches);
