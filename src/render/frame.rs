//! One ray per pixel through a method.

use super::lines::LineCounter;
use super::{Camera, LineSets};
use crate::bvh::FullBvh;
use crate::golden::reference::Reference;
use crate::step::{MemoryMap, Section, SectionId, Step, StepCounts, StepSink};
use crate::traverse::{BvhTraverser, ClosestHit, Hit, LodImage, LodTraverser, ModelRay, ModelSpace, bvh_map};
use rayon::prelude::*;
use serde::Serialize;

/// How rays find their hits.
#[derive(Clone, Copy)]
#[expect(clippy::large_enum_variant, reason = "there is one")]
pub enum Method<'a> {
    /// Locally adaptive level of detail.
    Lod(LodImage<'a>),
    /// Quad-BVH over the full-resolution mesh.
    Bvh(&'a FullBvh),
    /// `f64`, full resolution.
    Reference(&'a Reference),
}

impl Method<'_> {
    /// Its memory; empty for the reference, which has none in hardware.
    pub fn map(&self) -> MemoryMap {
        match self {
            Self::Lod(image) => image.map,
            Self::Bvh(bvh) => bvh_map(bvh),
            Self::Reference(_) => MemoryMap::new(&[], 1).unwrap_or_else(|error| unreachable!("{error}")),
        }
    }
}

/// What one pixel's ray found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pixel {
    /// Distance from the eye in world units.
    pub distance: f64,
    /// Base triangle.
    pub tree: u32,
    /// Full-resolution triangle within its tree.
    pub full_node: u32,
    /// Barycentrics on the full-resolution triangle.
    pub full_bary: [f32; 3],
    /// Level of the triangle that was met, and its node there.
    pub level: u32,
    /// Node on that level.
    pub node: u32,
}

/// A traced frame, row by row from the top.
pub struct Frame {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// What each pixel found.
    pub pixels: Vec<Option<Pixel>>,
    /// What it took.
    pub stats: FrameStats,
}

/// What a frame took.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FrameStats {
    /// Rays shot.
    pub rays: u64,
    /// Rays that hit.
    pub hits: u64,
    /// Groups of four boxes tested.
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
const TILE_ROWS: usize = 8;

/// Traces one ray per pixel. `row_done` is called once for each finished row, from any thread.
pub fn render(method: &Method<'_>, space: &ModelSpace, camera: &Camera, delta: f64, row_done: &(dyn Fn() + Sync)) -> Frame {
    let map = method.map();
    let sets = LineSets::new(&map);
    let width = camera.width as usize;
    let [columns, window_rows] = camera.window(space);
    let mut pixels = vec![None; width * camera.height as usize];
    let counts = pixels
        .par_chunks_mut(width * TILE_ROWS)
        .enumerate()
        .map_init(
            || Tracer::new(method),
            |tracer, (band, rows)| {
                let mut probe = LineCounter { counts: StepCounts::default(), sets: &sets };
                // Rows and columns are below 2^16.
                let seen = |row: usize| window_rows.contains(&((band * TILE_ROWS + row) as u32));
                for left in columns.clone().step_by(TILE_COLUMNS) {
                    let tile = left..columns.end.min(left + TILE_COLUMNS as u32);
                    for (row, pixels) in rows.chunks_mut(width).enumerate().filter(|(row, _)| seen(*row)) {
                        for x in tile.clone() {
                            let at = [x, (band * TILE_ROWS + row) as u32];
                            pixels[x as usize] = tracer.pixel(space, camera, delta, at, &mut probe);
                        }
                    }
                }
                (0..rows.len() / width).for_each(|_| row_done());
                probe.counts
            },
        )
        .reduce(StepCounts::default, |mut a, b| {
            a.add(&b);
            a
        });
    let stats = FrameStats {
        rays: pixels.len() as u64,
        hits: pixels.iter().flatten().count() as u64,
        nodes: counts.nodes,
        lod_tests: counts.lod_tests,
        triangles: counts.triangles,
        lines: kind_counts(&map, &counts, &sets),
        mean_level: mean(pixels.iter().flatten().map(|p| f64::from(p.level))),
    };
    Frame { width: camera.width, height: camera.height, pixels, stats }
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

/// One thread's traverser.
pub(super) enum Tracer<'a> {
    Lod(Box<LodTraverser<'a>>),
    Bvh(Box<BvhTraverser<'a>>),
    Reference(&'a Reference),
}

impl<'a> Tracer<'a> {
    pub fn new(method: &Method<'a>) -> Self {
        match method {
            Method::Lod(image) => Self::Lod(Box::new(LodTraverser::new(*image))),
            Method::Bvh(bvh) => Self::Bvh(Box::new(BvhTraverser::new(bvh))),
            Method::Reference(reference) => Self::Reference(reference),
        }
    }

    /// What the ray of pixel (x, y) finds.
    pub fn pixel<S: StepSink>(
        &mut self,
        space: &ModelSpace,
        camera: &Camera,
        delta: f64,
        [x, y]: [u32; 2],
        steps: &mut S,
    ) -> Option<Pixel> {
        let world = camera.ray(x, y);
        match self {
            Self::Lod(traverser) => {
                let Some(ray) = space.enter(&world, delta) else {
                    steps.step(Step::end(false, false));
                    return None;
                };
                let mut hit = ClosestHit::new(traverser.levels());
                traverser.trace(&ray.ray, steps, &mut hit);
                hit.record().map(|hit| pixel(&ray, &hit))
            }
            Self::Bvh(traverser) => {
                let Some(ray) = space.enter(&world, delta) else {
                    steps.step(Step::end(false, false));
                    return None;
                };
                let mut hit = ClosestHit::new(traverser.levels());
                traverser.trace(&ray.ray, steps, &mut hit);
                hit.record().map(|hit| pixel(&ray, &hit))
            }
            Self::Reference(reference) => {
                let hit = reference.trace(space.to_units(world.origin), world.direction)?;
                Some(Pixel {
                    distance: hit.t * space.placement.scale,
                    tree: hit.tree,
                    full_node: hit.full_node,
                    full_bary: hit.bary.map(|b| b as f32),
                    level: reference.levels(),
                    node: hit.full_node,
                })
            }
        }
    }
}

fn pixel(ray: &ModelRay, hit: &Hit) -> Pixel {
    let weight = |b: crate::num::Bary| (b.get() as f64 / crate::num::BARY_ONE as f64) as f32;
    // Field widths are below 32 bits.
    let [tree, full_node, level, node] = [hit.tree.get(), hit.full_node.get(), hit.level.get(), hit.node.get()].map(|v| v as u32);
    Pixel {
        distance: ray.distance(hit.t.get()),
        tree,
        full_node,
        full_bary: [weight(hit.full_b0), weight(hit.full_b1), weight(hit.full_b2)],
        level,
        node,
    }
}
