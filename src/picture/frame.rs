//! One ray per pixel through a method.

use crate::method::{Method, SurfaceHit, Tracer, trace_together};
use crate::rays::{Camera, ModelSpace, Query, RaySource, Sight, TILE};
use crate::step::{LineCounter, LineSets, MemoryMap, Section, SectionId, StepCounts, StepSink};
use rayon::prelude::*;
use serde::Serialize;

/// A traced frame, row by row from the top.
#[derive(Clone)]
pub struct Frame {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// What each pixel found.
    pub pixels: Vec<Option<SurfaceHit>>,
}

/// What a frame took.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FrameStats {
    /// Rays shot.
    pub rays: u64,
    /// Rays that hit.
    pub hits: u64,
    /// Groups of child boxes tested: four, of `bvh6` six; of several models also those of the tree over them, and entries into models.
    pub nodes: u64,
    /// LOD tests.
    pub lod_tests: u64,
    /// Triangle tests.
    pub triangles: u64,
    /// Lines read, by kind of data.
    pub lines: Vec<KindCount>,
    /// Mean level of the triangles hit.
    pub mean_level: f64,
}

/// Lines of one kind of data.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KindCount {
    /// What they hold.
    pub kind: &'static str,
    /// Lines read, counted each time.
    pub read: u64,
    /// Distinct 32-byte lines touched in the frame.
    pub distinct: u64,
}

impl FrameStats {
    /// Those of pixels, by the counts of their rays' steps and the lines that these touched, in the memory `map`.
    pub fn new(pixels: &[Option<SurfaceHit>], counts: &StepCounts, map: &MemoryMap, sets: &LineSets) -> Self {
        Self {
            rays: pixels.len() as u64,
            hits: pixels.iter().flatten().count() as u64,
            nodes: counts.nodes,
            lod_tests: counts.lod_tests,
            triangles: counts.triangles,
            lines: kind_counts(map, counts, sets),
            mean_level: mean(pixels.iter().flatten().map(|p| f64::from(p.level))),
        }
    }

    /// Distinct 32-byte lines touched.
    pub fn distinct_lines(&self) -> u64 {
        self.lines.iter().map(|k| k.distinct).sum()
    }

    /// Lines read, counted each time.
    pub fn lines_read(&self) -> u64 {
        self.lines.iter().map(|k| k.read).sum()
    }
}

/// Rays are traced in small tiles, so that what one reads is still in the cache for the next; a band of tiles is one unit of work.
const TILE_COLUMNS: usize = 32;
const TILE_ROWS: usize = TILE as usize;

/// Traces one ray per pixel at quality `delta`; the frame, and what it took. `row_done` is called once for each finished row, from any thread.
pub fn render(method: &dyn Method, space: &ModelSpace, camera: &Camera, delta: f64, row_done: &(dyn Fn() + Sync)) -> (Frame, FrameStats) {
    let sight = Sight::new(camera, space, delta);
    let map = method.map(&sight);
    let sets = LineSets::new(&map);
    let width = camera.width as usize;
    let [columns, window_rows] = camera.window(space);
    let mut pixels = vec![None; width * camera.height as usize];
    let counts = pixels
        .par_chunks_mut(width * TILE_ROWS)
        .enumerate()
        .map_init(
            || method.tracer(&sight),
            |tracer, (band, rows)| {
                let mut counter = LineCounter { counts: StepCounts::default(), sets: &sets };
                if tracer.lanes() > 1 {
                    packets(&mut **tracer, camera, band, &mut counter, &mut |at, _, hit| rows[at] = hit);
                    (0..rows.len() / width).for_each(|_| row_done());
                    return counter.counts;
                }
                // Rows and columns are below 2^16.
                let seen = |row: usize| window_rows.contains(&((band * TILE_ROWS + row) as u32));
                for left in columns.clone().step_by(TILE_COLUMNS) {
                    let tile = left..columns.end.min(left + TILE_COLUMNS as u32);
                    for (row, pixels) in rows.chunks_mut(width).enumerate().filter(|(row, _)| seen(*row)) {
                        for x in tile.clone() {
                            let at = [x, (band * TILE_ROWS + row) as u32];
                            pixels[x as usize] = tracer.counted(&camera.ray(at[0], at[1]), &mut counter);
                        }
                    }
                }
                (0..rows.len() / width).for_each(|_| row_done());
                counter.counts
            },
        )
        .reduce(StepCounts::default, |mut a, b| {
            a.add(&b);
            a
        });
    let stats = FrameStats::new(&pixels, &counts, &map, &sets);
    (Frame { width: camera.width, height: camera.height, pixels }, stats)
}

/// Traces the rays of a band of tiles in packets, those of the [tiles](RaySource::batch) that the simulator takes; `each` is told of every ray: its place in the band, row by row, its query, and its hit.
pub(super) fn packets(
    tracer: &mut dyn Tracer,
    camera: &Camera,
    band: usize,
    steps: &mut dyn StepSink,
    each: &mut dyn FnMut(usize, &Query, Option<SurfaceHit>),
) {
    let columns = camera.width.div_ceil(TILE) as usize;
    let first = band * camera.width as usize * TILE as usize;
    let (mut places, mut queries) = (Vec::new(), Vec::new());
    for tile in band * columns..(band + 1) * columns {
        places.clear();
        queries.clear();
        camera.batch(tile, &mut |number, query| {
            places.push(number as usize - first);
            queries.push(*query);
        });
        let hits = trace_together(tracer, &queries, steps);
        places.iter().zip(&queries).zip(hits).for_each(|((&at, query), hit)| each(at, query, hit));
    }
}

fn kind_counts(map: &MemoryMap, counts: &StepCounts, sets: &LineSets) -> Vec<KindCount> {
    let distinct = sets.counts();
    let count = |(id, section): (SectionId, Section)| (section.name, counts.lines[id.place()], distinct[id.place()]);
    let all = map.sections().map(count).map(|(kind, read, distinct)| KindCount { kind, read, distinct });
    all.filter(|k| k.read > 0).collect()
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0u64), |(s, n), v| (s + v, n + 1));
    if count == 0 { 0.0 } else { sum / count as f64 }
}
