//! What `render` found out, as its JSON and its table have it.

use crate::cli::comparison::Against;
use lodray::picture::{FrameStats, KindCount, Shading};
use lodray::study::{Comparison, count, grouped};
use serde::Serialize;
use std::collections::BTreeMap;

/// A picture's figures, as its JSON has them.
#[derive(Serialize)]
pub struct Report {
    pub method: &'static str,
    pub delta: f64,
    /// What the method chose for the frame.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub choices: BTreeMap<&'static str, String>,
    pub shading: Shading,
    /// In each pixel of the picture; `stats` are those of one.
    pub samples: u32,
    pub size: [u32; 2],
    pub eye: [f64; 3],
    /// Distance from the target in bounding radii.
    pub distance: f64,
    /// Whether what the method needs was read from the cache.
    pub cached: bool,
    pub seconds: Seconds,
    pub stats: FrameStats,
    pub per_ray: PerRay,
    /// What it was compared with.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub against: Option<Against>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<Comparison>,
}

/// Times on the host: all of the figures that are not the same in every run.
#[derive(Serialize)]
pub struct Seconds {
    /// Building what the method needs, or reading it from the cache.
    pub building: f64,
    pub tracing: f64,
}

/// Means over all rays of the frame.
#[derive(Serialize)]
pub struct PerRay {
    nodes: f64,
    lod_tests: f64,
    triangles: f64,
    lines_read: f64,
    bytes_read: f64,
    distinct_lines: f64,
    by_kind: Vec<KindPerRay>,
}

/// Means over all rays of the frame, of one kind of data.
#[derive(Serialize)]
struct KindPerRay {
    kind: &'static str,
    lines_read: f64,
    bytes_read: f64,
    distinct_lines: f64,
}

impl From<&FrameStats> for PerRay {
    fn from(stats: &FrameStats) -> Self {
        let mean = |n: u64| n as f64 / stats.rays as f64;
        Self {
            nodes: mean(stats.nodes),
            lod_tests: mean(stats.lod_tests),
            triangles: mean(stats.triangles),
            lines_read: mean(stats.lines_read()),
            bytes_read: 32.0 * mean(stats.lines_read()),
            distinct_lines: mean(stats.distinct_lines()),
            by_kind: stats.lines.iter().map(|k| kind_per_ray(k, stats.rays)).collect(),
        }
    }
}

fn kind_per_ray(k: &KindCount, rays: u64) -> KindPerRay {
    let mean = |n: u64| n as f64 / rays as f64;
    KindPerRay { kind: k.kind, lines_read: mean(k.read), bytes_read: 32.0 * mean(k.read), distinct_lines: mean(k.distinct) }
}

/// The figures as text.
pub fn table(r: &Report) -> String {
    let making = if r.cached { "BVH read from the cache" } else { "building" };
    let (rays, hits, Seconds { building, tracing }) = (count(r.stats.rays, "ray"), grouped(r.stats.hits), &r.seconds);
    let mut text = format!("{rays}, {hits} hit; {making} {building:.2} s, tracing {tracing:.2} s\n");
    // The reference is no hardware, and reads none.
    if !r.stats.lines.is_empty() {
        text += &format!(
            "per ray: {:.2} nodes, {:.2} LOD tests, {:.2} triangles, {:.2} lines read ({:.0} bytes)\nmean level {:.3}\n",
            r.per_ray.nodes, r.per_ray.lod_tests, r.per_ray.triangles, r.per_ray.lines_read, r.per_ray.bytes_read, r.stats.mean_level,
        );
        let mut line = |cells: [&str; 6]| {
            let [kind, cells @ ..] = cells;
            let cells: String = cells.iter().map(|c| format!("{c:>16}")).collect();
            text += &format!("{kind:<14}{cells}\n");
        };
        line(["lines of", "read", "distinct", "read/ray", "bytes/ray", "distinct/ray"]);
        for (k, per) in r.stats.lines.iter().zip(&r.per_ray.by_kind) {
            let means = [per.lines_read, per.bytes_read, per.distinct_lines].map(|v| format!("{v:.3}"));
            line([k.kind, &grouped(k.read), &grouped(k.distinct), &means[0], &means[1], &means[2]]);
        }
        let means = [r.per_ray.lines_read, r.per_ray.bytes_read, r.per_ray.distinct_lines].map(|v| format!("{v:.3}"));
        line(["all", &grouped(r.stats.lines_read()), &grouped(r.stats.distinct_lines()), &means[0], &means[1], &means[2]]);
    }
    if let (Some(against), Some(e)) = (r.against, &r.error) {
        let psnr = e.image.psnr_db.map_or("infinite".to_owned(), |p| format!("{p:.2} dB"));
        let off = e.geometry_pixels.map_or("no pixel sees the surface in both: nothing overlaps".to_owned(), |g| {
            format!("surface off by {:.3} pixels in the mean, 99 of 100 below {:.3}", g.mean, g.percentile_99)
        });
        text += &format!(
            "against {}: RMSE {:.3}, PSNR {psnr}, maximum {}, {:.2} % of pixels differ, {} differ in coverage\n{off}\n",
            against.name(),
            e.image.rmse,
            e.image.maximum,
            100.0 * e.image.differing,
            grouped(e.coverage_differs)
        );
    }
    text.trim_end().to_owned()
}
