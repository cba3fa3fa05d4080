//! Hierarchy to memory images, in parallel, straight into the image of the file.

use super::layout::{self, LevelStarts};
use super::scene::Image;
use super::sections::{COUNT, FileSection, HEADER, checksum, place, write_header};
use super::{
    Box16, Displacements, L0Record, Line, Meta, Scene, SceneError, ShortDisplacements, ShortLine, SplitRecord, TreeLines, VertexData,
    child_corners, colour, has_split, normal,
};
use crate::mesh::compact::{inserted_zero_bits, steps_of};
use crate::mesh::lattice::{self, LatticePoint};
use crate::mesh::{BoundKind, Hierarchy, Surface, SurfaceError, edge_index, quantise};
use crate::num::{BoxStep, COORD_LIMIT, U, VertexForm, Wire, box_code_ceil, box_code_floor, displaced, displacement_shift};
use memmap2::MmapMut;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// What a scene says about itself.
#[derive(Clone, Debug, Default)]
pub struct SceneInfo {
    /// Name of the model.
    pub name: String,
    /// How it was made: generator options, distances of a remesh; null if there is nothing to say.
    pub origin: serde_json::Value,
    /// What its displacement bounds cover.
    pub bounds: BoundKind,
    /// How its inserted vertices are stored.
    pub vertices: VertexForm,
    /// Zero bits at the bottom of every coordinate.
    pub coordinate_zeros: u32,
    /// Zero bits at the bottom of the components of its rays' directions.
    pub direction_zeros: u32,
    /// How far the surface's points had been moved before at most, in world units.
    pub moved: f64,
}

/// The quad-BVH over a scene's trees.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TreeBvh {
    /// Its nodes, the root first; a leaf is a place in `order`.
    pub nodes: Vec<Line>,
    /// The trees in the order in which the scene has them.
    pub order: Vec<u32>,
}

/// The scene of a surface. `build_l0` makes the quad-BVH over the trees' boxes, and with it their order.
///
/// # Errors
/// The surface is not fit, or `build_l0` failed or returned no nodes.
pub fn build<E: std::fmt::Display>(
    surface: &Surface,
    info: SceneInfo,
    build_l0: impl FnOnce(&[Box16]) -> Result<TreeBvh, E>,
) -> Result<Scene, SceneError> {
    let hierarchy = quantise(surface, info.bounds, info.vertices, info.coordinate_zeros)?;
    let bvh = build_l0(&tree_boxes(&hierarchy)).map_err(|e| SceneError::Build(format!("quad-BVH: {e}")))?;
    encode(&hierarchy, surface, info, &bvh)
}

/// Every point keeps to the limit and to its level's grid: what the formats store and the blocks take for granted.
fn check_points(h: &Hierarchy) -> Result<(), SceneError> {
    let m = 1u32 << h.levels;
    let places: Vec<LatticePoint> = (0..=m).flat_map(|j| (0..=m - j).map(move |i| (i, j))).collect();
    let zero_bits = |place| h.vertices.zero_bits(h.levels, lattice::level_of(h.levels, place), h.zeros);
    let masks: Vec<i32> = places.iter().map(|&place| (1 << zero_bits(place)) - 1).collect();
    let fits = |p: &[i32; 3], mask: i32| p.iter().all(|c| c & mask == 0 && c.unsigned_abs() <= COORD_LIMIT.unsigned_abs());
    let bad = |points: &[[i32; 3]]| points.iter().zip(&masks).any(|(p, &mask)| !fits(p, mask));
    match h.points.par_chunks(places.len()).position_first(bad) {
        Some(tree) => Err(SceneError::Build(format!("tree {tree} has a point off its grid or beyond +-{COORD_LIMIT}"))),
        None => Ok(()),
    }
}

/// Box of each tree's full-resolution triangles.
pub fn tree_boxes(hierarchy: &Hierarchy) -> Vec<Box16> {
    hierarchy.points.par_chunks(lattice::len(hierarchy.levels)).map(Box16::of_points).collect()
}

/// The scene of a hierarchy made from `surface` (for its normals and materials) with this quad-BVH.
///
/// # Errors
/// The hierarchy is not of this surface, vertices are not what their form can hold, a normal has no direction, there are no nodes or not each tree once, or
/// memory cannot be had.
pub fn encode(hierarchy: &Hierarchy, surface: &Surface, info: SceneInfo, bvh: &TreeBvh) -> Result<Scene, SceneError> {
    let TreeBvh { nodes, order } = bvh;
    let trees = hierarchy.triangles.len();
    if (surface.levels, &surface.triangles, surface.normals.len()) != (hierarchy.levels, &hierarchy.triangles, hierarchy.points.len()) {
        return Err(SceneError::Build("hierarchy and surface differ in levels, triangles or normals".into()));
    }
    check_points(hierarchy)?;
    if nodes.is_empty() {
        return Err(SceneError::Build("quad-BVH has no nodes".into()));
    }
    let mut seen = vec![false; trees];
    let once = |&tree: &u32| seen.get_mut(tree as usize).is_some_and(|seen| !std::mem::replace(seen, true));
    if order.len() != trees || !order.iter().all(once) {
        return Err(SceneError::Build("quad-BVH does not hold every tree once".into()));
    }
    let (trees_lines, starts) = places(hierarchy, order)?;
    let meta = meta(hierarchy, surface, info);
    let json = serde_json::to_vec(&meta).map_err(|e| SceneError::Build(format!("META: {e}")))?;
    let lengths = FileSection::ALL.map(|section| match section {
        FileSection::Meta => json.len(),
        FileSection::Nodes => size_of_val(nodes.as_slice()),
        FileSection::Splits => size_of::<Line>() * starts.splits(),
        FileSection::Vertices => size_of::<Line>() * starts.vertex_lines(),
        FileSection::Colours => 4 * surface.colours.len(),
        _ => Scene::section_lengths(&meta, section).unwrap_or(usize::MAX / 16), // too large to be had
    });
    let (mut image, ranges) = new_image(lengths)?;

    let [meta_out, nodes_out, records, splits, vertices, normals, triangles, sources, colours] = slices(&mut image, &ranges);
    meta_out.copy_from_slice(&json);
    nodes_out.copy_from_slice(bytemuck::cast_slice(nodes));
    let triangles: &mut [[u32; 3]] = bytemuck::cast_slice_mut(triangles);
    triangles.iter_mut().zip(order).for_each(|(out, &tree)| *out = hierarchy.triangles[tree as usize]);
    let material = |tree: u32| surface.materials.get(tree as usize).copied().unwrap_or(0);
    let sources: &mut [[u32; 2]] = bytemuck::cast_slice_mut(sources);
    sources.iter_mut().zip(order).for_each(|(out, &tree)| *out = [tree, material(tree).into()]);
    for (out, colour) in bytemuck::cast_slice_mut::<u8, [u8; 4]>(colours).iter_mut().zip(&surface.colours) {
        let [r, g, b] = colour.map(colour::to_srgb);
        *out = [r, g, b, 255];
    }
    write_normals(surface, order, bytemuck::cast_slice_mut(normals))?;
    let images = Images {
        records: bytemuck::cast_slice_mut(records),
        splits: bytemuck::cast_slice_mut(splits),
        vertices: bytemuck::cast_slice_mut(vertices),
    };
    images.write(hierarchy, order, &trees_lines)?;

    debug_assert_eq!(trees, meta.trees as usize);
    Ok(sealed(image, ranges, meta, starts))
}

/// What of each tree is stored, of trees in this order, and where the levels begin.
pub(super) fn places(h: &Hierarchy, order: &[u32]) -> Result<(Vec<TreeLines>, LevelStarts), SceneError> {
    let depths: Vec<u32> = order.par_iter().map(|&tree| h.depth(tree as usize)).collect();
    let (lines, starts) = layout::places(h.vertices, &depths);
    if starts.are_numbered(h.vertices) {
        return Ok((lines, starts));
    }
    let (splits, lines) = (starts.splits(), starts.vertex_lines());
    Err(SceneError::Build(format!("{splits} splits and {lines} lines of vertices, more than 2^28: fewer levels or trees are needed")))
}

/// The sections of an image.
pub(super) fn slices<'a>(image: &'a mut [u8], ranges: &[Range<usize>; COUNT]) -> [&'a mut [u8]; COUNT] {
    let (mut rest, mut taken) = (image, 0);
    ranges.clone().map(|range| {
        let (head, tail) = std::mem::take(&mut rest).split_at_mut(range.end - taken);
        let section = &mut head[range.start - taken..];
        (rest, taken) = (tail, range.end);
        section
    })
}

/// An image of sections of these lengths, all zero, and where they are.
pub(super) fn new_image(lengths: [usize; COUNT]) -> Result<(MmapMut, [Range<usize>; COUNT]), SceneError> {
    let (ranges, total) = place(lengths);
    // Anonymous pages come zeroed and are first touched by the thread that fills them.
    let image = MmapMut::map_anon(total).map_err(|e| SceneError::Build(format!("{total} bytes for the images: {e}")))?;
    Ok((image, ranges))
}

/// The scene of an image whose sections are filled: checksums and header are written.
pub(super) fn sealed(mut image: MmapMut, ranges: [Range<usize>; COUNT], meta: Meta, starts: LevelStarts) -> Scene {
    seal(&mut image, &ranges);
    Scene { image: Arc::new(Image::Owned(image)), ranges, meta, starts, input: None }
}

/// Writes checksums and header.
pub(super) fn seal(image: &mut [u8], ranges: &[Range<usize>; COUNT]) {
    let mut sums = [0; COUNT];
    sums.par_iter_mut().zip(ranges).for_each(|(sum, range)| *sum = checksum(&image[range.clone()]));
    let total = image.len();
    write_header(&mut image[..HEADER], total, ranges, &sums);
}

fn meta(h: &Hierarchy, surface: &Surface, info: SceneInfo) -> Meta {
    let len = lattice::len(h.levels);
    let ([lo, hi], moved) = extent(h, |tree, point| surface.positions.get(tree * len + point).copied());
    Meta {
        name: info.name,
        program: env!("CARGO_PKG_VERSION").into(),
        levels: h.levels,
        trees: h.triangles.len() as u32, // quantise keeps it below 2^28
        base_vertices: h.base_vertices,
        placement: h.placement,
        bounds: h.bounds.kind,
        bound_offset: h.bounds.scale.offset.get() as u32, // 9 bits
        vertices: h.vertices,
        coordinate_zeros: h.zeros,
        direction_zeros: info.direction_zeros,
        moved: info.moved + moved,
        lo,
        hi,
        job: Vec::new(),
        regions: Vec::new(),
        without_normals: false,
        origin: info.origin,
    }
}

/// The box of all points, and how far one is at most from its place, in world units; `place` says where a point of a tree was, if anybody knows.
pub(super) fn extent(h: &Hierarchy, place: impl Fn(usize, usize) -> Option<[f64; 3]> + Sync) -> (Span, f64) {
    let none = ([[i32::MAX; 3], [i32::MIN; 3]], 0.0);
    let both = |(a, far): (Span, f64), (b, other): (Span, f64)| (join(a, b), far.max(other));
    let of_tree = |(tree, points): (usize, &[[i32; 3]])| {
        points.iter().enumerate().fold(none, |all, (at, &p)| {
            let world = h.to_world(p);
            let squared = place(tree, at).map_or(0.0, |place| (0..3).map(|k| (world[k] - place[k]).powi(2)).sum::<f64>());
            both(all, ([p, p], squared))
        })
    };
    let (span, squared) = h.points.par_chunks(lattice::len(h.levels)).enumerate().map(of_tree).reduce(|| none, both);
    // The root of the largest is the largest root.
    (span, squared.sqrt())
}

#[inline]
fn join([a, b]: [[i32; 3]; 2], [c, d]: [[i32; 3]; 2]) -> [[i32; 3]; 2] {
    [std::array::from_fn(|k| a[k].min(c[k])), std::array::from_fn(|k| b[k].max(d[k]))]
}

/// The normals of all trees, in this order.
fn write_normals(surface: &Surface, order: &[u32], out: &mut [u32]) -> Result<(), SceneError> {
    let len = lattice::len(surface.levels);
    let bad = out.par_chunks_mut(len).zip(order).find_map_first(|(out, &tree)| {
        let first = tree as usize * len;
        let own = surface.normals[first..][..len].iter().enumerate();
        out.iter_mut().zip(own).find_map(|(out, (k, &n))| match normal::encode_normal(n) {
            Some(code) => {
                *out = code;
                None
            }
            None => Some(first + k),
        })
    });
    bad.map_or(Ok(()), |index| {
        let (tree, value) = (index / len, surface.normals[index].map(f64::from));
        Err(SurfaceError::BadVector { field: "normals", index, tree, value }.into())
    })
}

/// The parts of a section that belong to each tree, one for each of its levels: `lines(level)` of them, level by level in the order of the trees' places; of trees with
/// a level where `has(depth, level)`.
fn parts<'a>(
    mut section: &'a mut [Line],
    stored: &[TreeLines],
    has: impl Fn(u32, u32) -> bool,
    lines: impl Fn(u32) -> usize,
) -> Vec<Vec<&'a mut [Line]>> {
    let mut by_place: Vec<usize> = (0..stored.len()).collect();
    by_place.sort_unstable_by_key(|&tree| stored[tree].place);
    let mut parts: Vec<Vec<&mut [Line]>> = stored.iter().map(|tree| Vec::with_capacity(tree.depth as usize)).collect();
    for level in 0..layout::SPLIT_LEVELS as u32 {
        for &tree in by_place.iter().filter(|&&tree| has(stored[tree].depth, level)) {
            let (part, rest) = std::mem::take(&mut section).split_at_mut(lines(level));
            parts[tree].push(part);
            section = rest;
        }
    }
    parts
}

/// The splits of each tree by level.
pub(super) fn split_parts<'a>(section: &'a mut [Line], stored: &[TreeLines]) -> Vec<Vec<&'a mut [Line]>> {
    parts(section, stored, has_split, |level| 1 << (2 * level))
}

/// The vertex lines of each tree by level; compact ones are of one level.
pub(super) fn vertex_parts<'a>(form: VertexForm, section: &'a mut [Line], stored: &[TreeLines]) -> Vec<Vec<&'a mut [Line]>> {
    parts(section, stored, |depth, level| layout::has_vertices(form, depth, level), |level| layout::vertex_lines_of_level(form, level))
}

/// The images of all trees.
pub(super) struct Images<'a> {
    pub records: &'a mut [Line],
    pub splits: &'a mut [Line],
    pub vertices: &'a mut [Line],
}

impl Images<'_> {
    /// Fills the record, splits and vertices of every tree, of which so much is stored; the first is tree `order[0]` of the hierarchy.
    pub fn write(self, h: &Hierarchy, order: &[u32], stored: &[TreeLines]) -> Result<(), SceneError> {
        let splits = split_parts(self.splits, stored);
        let lines = vertex_parts(h.vertices, self.vertices, stored);
        let records = self.records.par_chunks_mut(h.vertices.record_lines());
        let trees = records.zip(order).zip(stored).zip(splits.into_par_iter().zip(lines));
        let bad = trees.find_map_first(|(((record, &tree), &stored), (splits, lines))| {
            let index = tree as usize;
            let mut writer = TreeWriter { h, points: h.tree(index), codes: h.codes(index), depth: stored.depth, splits, lines, fits: true };
            writer.record(L0Record::default().of_tree(stored), record);
            (!writer.fits).then(|| SceneError::Build(format!("tree {tree} has a vertex that its compact form cannot hold")))
        });
        bad.map_or(Ok(()), Err)
    }
}

/// Writes one tree, depth first.
struct TreeWriter<'a> {
    h: &'a Hierarchy,
    points: &'a [[i32; 3]],
    codes: &'a [u8],
    /// Levels that are stored.
    depth: u32,
    /// By level.
    splits: Vec<&'a mut [Line]>,
    /// By level; compact ones of the last level alone.
    lines: Vec<&'a mut [Line]>,
    /// Compact vertices are what the hierarchy has.
    fits: bool,
}

/// The box of full-resolution triangles: lower and upper corner in units.
type Span = [[i32; 3]; 2];

fn span(points: [[i32; 3]; 3]) -> Span {
    points.iter().fold([points[0]; 2], |b, &p| join(b, [p, p]))
}

/// A node on the way: places and points of its corners, and the codes of its edges (0 where there are none).
#[derive(Clone, Copy)]
struct At {
    places: [LatticePoint; 3],
    points: [[i32; 3]; 3],
    codes: [u8; 3],
}

impl TreeWriter<'_> {
    fn record(&mut self, mut record: L0Record, out: &mut [Line]) {
        let places = lattice::root(self.h.levels);
        let points = places.map(|c| self.at(c));
        match out {
            [_, line] => VertexData::from_points(points).to_words(line),
            _ => record = record.with_corners(points),
        }
        let codes = if self.depth > 0 { self.codes_of(0, places) } else { [0; 3] };
        [record.e0, record.e1, record.e2] = codes.map(|c| U::new(u64::from(c)));
        record.to_words(&mut out[0]);
        self.node(0, 0, At { places, points, codes });
    }

    fn at(&self, p: LatticePoint) -> [i32; 3] {
        self.points[lattice::index(self.h.levels, p)]
    }

    /// Codes of edges e0, e1, e2 of a node of `level` with these corners.
    fn codes_of(&self, level: u32, p: [LatticePoint; 3]) -> [u8; 3] {
        [[p[1], p[2]], [p[2], p[0]], [p[0], p[1]]].map(|[a, b]| self.codes[edge_index(self.h.levels, level, a, b)])
    }

    /// Writes everything below node (`level`, `node`) and gives the box of its full-resolution triangles: where nothing more is stored, they lie in its own.
    fn node(&mut self, level: u32, node: usize, own: At) -> Span {
        if level == self.depth {
            return span(own.points);
        }
        let places = lattice::midpoints(own.places);
        let q = places.map(|c| self.at(c));
        let mut split = SplitRecord::default();
        match self.h.vertices {
            VertexForm::Exact => VertexData::from_points(q).to_words(&mut self.lines[level as usize][node]),
            VertexForm::Compact | VertexForm::Short => {
                let displacements = self.displacements(level, &own, q);
                match has_split(self.depth, level) {
                    true => split = split.with_displacements(displacements),
                    false if self.h.vertices == VertexForm::Short => self.short(&displacements, node),
                    false => displacements.to_words(&mut self.lines[0][node / 2][2 * (node & 1)..][..2]),
                }
            }
        }
        let span = if level + 1 == self.depth {
            join(span(own.points), span(q))
        } else {
            let children: [At; 4] = std::array::from_fn(|k| {
                let places = lattice::child(own.places, k as u32); // k < 4
                At { places, points: child_corners(own.points, q, k), codes: self.codes_of(level + 1, places) }
            });
            let spans: [Span; 4] = std::array::from_fn(|k| self.node(level + 1, 4 * node + k, children[k]));
            split = with_children(split, &children, &spans);
            spans.into_iter().fold(spans[0], join)
        };
        if has_split(self.depth, level) {
            split.to_words(&mut self.splits[level as usize][node]);
        }
        span
    }

    /// Writes the displacements of a last split to the line that it shares with its siblings.
    fn short(&mut self, displacements: &Displacements, node: usize) {
        let short = ShortDisplacements::of(displacements);
        let Displacements { v0, v1, v2, .. } = displacements;
        self.fits &= [v0, v1, v2].into_iter().zip(short.steps()).all(|(own, kept)| own.get() == kept.get());
        let line = &mut self.lines[0][node / 4];
        let mut all = ShortLine::from_words(&line[..]);
        all.siblings[node & 3] = short;
        all.to_words(line);
    }

    /// The inserted vertices `q` of a node of `level` as displacements.
    fn displacements(&mut self, level: u32, own: &At, q: [[i32; 3]; 3]) -> Displacements {
        let zero_bits = inserted_zero_bits(self.h.levels, level, self.h.zeros);
        let steps = std::array::from_fn(|k| {
            let (a, b) = (own.points[(k + 1) % 3], own.points[(k + 2) % 3]);
            let shift = displacement_shift(self.h.bounds.scale, own.codes[k], zero_bits);
            let steps = steps_of(q[k], a, b, shift);
            self.fits &= (0..3).all(|c| (-4096..4096).contains(&steps[c]) && displaced(a[c], b[c], steps[c], shift) == q[k][c]);
            steps.map(|c| c.clamp(-4096, 4095))
        });
        Displacements::from_steps(steps)
    }
}

/// The split with these children, the boxes of whose full-resolution triangles are `spans`.
fn with_children(mut split: SplitRecord, children: &[At; 4], spans: &[Span; 4]) -> SplitRecord {
    let excess: [[u32; 6]; 4] = std::array::from_fn(|k| {
        let codes = |[lo, hi]: Span| (lo.map(box_code_floor).map(i32::from), hi.map(box_code_ceil).map(i32::from));
        let ((lo, hi), (all_lo, all_hi)) = (codes(span(children[k].points)), codes(spans[k]));
        // The triangle's corners are among the vertices below it.
        std::array::from_fn(|j| (if j < 3 { lo[j] - all_lo[j] } else { all_hi[j - 3] - hi[j - 3] }).unsigned_abs())
    });
    for axis in 0..3 {
        let most = excess.iter().map(|child| child[axis].max(child[axis + 3])).max().unwrap_or(0);
        let step = BoxStep::reaching(most, SplitRecord::MOST);
        (split.halves[axis], split.exponents[axis]) = (step.half, U::new(u64::from(step.exponent)));
        // The fewest steps that reach: as many as there are too few.
        let reached = std::array::from_fn::<u32, { SplitRecord::MOST as usize }, _>(|steps| step.codes(steps as u32));
        for (k, child) in excess.iter().enumerate() {
            for j in [axis, axis + 3] {
                split.planes[6 * k + j] = U::new(reached.iter().filter(|&&codes| codes < child[j]).count() as u64);
            }
        }
    }
    for (k, child) in children.iter().enumerate() {
        for (place, code) in SplitRecord::places_of(k).into_iter().zip(child.codes) {
            split.codes[place] = U::new(u64::from(code));
        }
    }
    split
}
