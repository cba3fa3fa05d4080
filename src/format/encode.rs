//! Hierarchy to memory images, in parallel, straight into the image of the file.

use super::scene::Image;
use super::sections::{COUNT, FileSection, HEADER, checksum, place, write_header};
use super::{BoundData, Box16, L0Record, Meta, Scene, SceneError, VertexData, colour, layout, normal};
use crate::mesh::lattice::{self, LatticePoint};
use crate::mesh::{BoundKind, Hierarchy, Surface, SurfaceError, quantise};
use crate::num::{COORD_LIMIT, PADDING_BITS, U, Wire, box_code_ceil, box_code_floor};
use memmap2::MmapMut;
use rayon::prelude::*;

/// What a scene says about itself.
#[derive(Clone, Debug, Default)]
pub struct SceneInfo {
    /// Name of the model.
    pub name: String,
    /// How it was made: generator options, distances of a remesh; null if there is nothing to say.
    pub origin: serde_json::Value,
    /// What its displacement bounds cover.
    pub bounds: BoundKind,
}

/// The scene of a surface. `build_l0` makes the quad-BVH nodes, the root first, over the trees' boxes (leaf index = tree).
///
/// # Errors
/// The surface is not fit, or `build_l0` failed or returned no nodes.
pub fn build<E: std::fmt::Display>(
    surface: &Surface,
    info: SceneInfo,
    build_l0: impl FnOnce(&[Box16]) -> Result<Vec<[u64; 8]>, E>,
) -> Result<Scene, SceneError> {
    let hierarchy = quantise(surface, info.bounds)?;
    let nodes = build_l0(&tree_boxes(&hierarchy)).map_err(|e| SceneError::Build(format!("quad-BVH: {e}")))?;
    encode(&hierarchy, surface, info, &nodes)
}

/// Every point keeps to the limit and to its level's grid: what the formats store and the blocks take for granted.
fn check_points(h: &Hierarchy) -> Result<(), SceneError> {
    let m = 1u32 << h.levels;
    let places: Vec<LatticePoint> = (0..=m).flat_map(|j| (0..=m - j).map(move |i| (i, j))).collect();
    let zero_bits = |place| (h.levels - lattice::level_of(h.levels, place)).max(PADDING_BITS);
    let masks: Vec<i32> = places.iter().map(|&place| (1 << zero_bits(place)) - 1).collect();
    let fits = |p: &[i32; 3], mask: i32| p.iter().all(|c| c & mask == 0 && c.unsigned_abs() <= COORD_LIMIT.unsigned_abs());
    let bad = |points: &[[i32; 3]]| points.iter().zip(&masks).any(|(p, &mask)| !fits(p, mask));
    match h.points.par_chunks(places.len()).position_first(bad) {
        Some(tree) => Err(SceneError::Build(format!("tree {tree} has a point off its grid or beyond +-{COORD_LIMIT}"))),
        None => Ok(()),
    }
}

/// Box of each tree's full-resolution triangles, as in its L0 record.
pub fn tree_boxes(hierarchy: &Hierarchy) -> Vec<Box16> {
    hierarchy.points.par_chunks(lattice::len(hierarchy.levels)).map(Box16::of_points).collect()
}

/// The scene of a hierarchy made from `surface` (for its normals and materials) with these quad-BVH nodes.
///
/// # Errors
/// The hierarchy is not of this surface, a normal has no direction, there are no nodes, or memory cannot be had.
pub fn encode(hierarchy: &Hierarchy, surface: &Surface, info: SceneInfo, nodes: &[[u64; 8]]) -> Result<Scene, SceneError> {
    let trees = hierarchy.triangles.len();
    if (surface.levels, &surface.triangles, surface.normals.len()) != (hierarchy.levels, &hierarchy.triangles, hierarchy.points.len()) {
        return Err(SceneError::Build("hierarchy and surface differ in levels, triangles or normals".into()));
    }
    check_points(hierarchy)?;
    if nodes.is_empty() {
        return Err(SceneError::Build("quad-BVH has no nodes".into()));
    }
    let meta = meta(hierarchy, info);
    let json = serde_json::to_vec(&meta).map_err(|e| SceneError::Build(format!("META: {e}")))?;
    let lengths = FileSection::ALL.map(|section| match section {
        FileSection::Meta => json.len(),
        FileSection::Nodes => size_of_val(nodes),
        FileSection::Colours => 4 * surface.colours.len(),
        _ => Scene::section_lengths(&meta, section).unwrap_or(usize::MAX / 16), // too large to be had
    });
    let (ranges, total) = place(lengths);
    // Anonymous pages come zeroed and are first touched by the thread that fills them.
    let mut image = MmapMut::map_anon(total).map_err(|e| SceneError::Build(format!("{total} bytes for the images: {e}")))?;

    let mut rest = &mut image[..];
    let mut taken = 0;
    let slices: [&mut [u8]; COUNT] = ranges.clone().map(|range| {
        let (head, tail) = std::mem::take(&mut rest).split_at_mut(range.end - taken);
        let section = &mut head[range.start - taken..];
        (rest, taken) = (tail, range.end);
        section
    });
    let [meta_out, nodes_out, records, bounds, vertices, normals, triangles, colours] = slices;
    meta_out.copy_from_slice(&json);
    nodes_out.copy_from_slice(bytemuck::cast_slice(nodes));
    triangles.copy_from_slice(bytemuck::cast_slice(&hierarchy.triangles));
    for (out, colour) in bytemuck::cast_slice_mut::<u8, [u8; 4]>(colours).iter_mut().zip(&surface.colours) {
        let [r, g, b] = colour.map(colour::to_srgb);
        *out = [r, g, b, 255];
    }
    write_normals(surface, bytemuck::cast_slice_mut(normals))?;
    write_trees(
        hierarchy,
        &surface.materials,
        bytemuck::cast_slice_mut(records),
        bytemuck::cast_slice_mut(bounds),
        bytemuck::cast_slice_mut(vertices),
    );

    let mut sums = [0; COUNT];
    sums.par_iter_mut().zip(&ranges).for_each(|(sum, range)| *sum = checksum(&image[range.clone()]));
    write_header(&mut image[..HEADER], total, &ranges, &sums);
    debug_assert_eq!(trees, meta.trees as usize);
    Ok(Scene { image: Image::Owned(image), ranges, meta })
}

fn meta(h: &Hierarchy, info: SceneInfo) -> Meta {
    type Corners = [[i32; 3]; 2];
    let none: Corners = [[i32::MAX; 3], [i32::MIN; 3]];
    let [lo, hi] = h.points.par_iter().fold(|| none, |b, &p| join(b, [p, p])).reduce(|| none, join);
    Meta {
        name: info.name,
        program: env!("CARGO_PKG_VERSION").into(),
        levels: h.levels,
        trees: h.triangles.len() as u32, // quantise keeps it below 2^28
        base_vertices: h.base_vertices,
        placement: h.placement,
        bounds: h.bounds.kind,
        bound_mantissa: h.bounds.scale.mantissa.get() as u32, // 18 bits
        bound_shift: h.bounds.scale.shift.get() as u32,       // 6 bits
        lo,
        hi,
        origin: info.origin,
    }
}

#[inline]
fn join([a, b]: [[i32; 3]; 2], [c, d]: [[i32; 3]; 2]) -> [[i32; 3]; 2] {
    [std::array::from_fn(|k| a[k].min(c[k])), std::array::from_fn(|k| b[k].max(d[k]))]
}

fn write_normals(surface: &Surface, out: &mut [u32]) -> Result<(), SceneError> {
    let bad = out.par_iter_mut().zip(&surface.normals).position_first(|(out, &n)| match normal::encode_normal(n) {
        Some(code) => {
            *out = code;
            false
        }
        None => true,
    });
    bad.map_or(Ok(()), |index| {
        let (tree, value) = (index / lattice::len(surface.levels), surface.normals[index].map(f64::from));
        Err(SurfaceError::BadVector { field: "normals", index, tree, value }.into())
    })
}

/// Fills the record, sibling groups and vertex lines of every tree.
fn write_trees(h: &Hierarchy, materials: &[u16], records: &mut [[u64; 8]], bounds: &mut [[u64; 8]], vertices: &mut [[u64; 4]]) {
    let (groups, lines) = (layout::sibling_groups(h.levels), layout::vertex_lines(h.levels));
    let write = |tree: usize, record: &mut [u64; 8], groups: &mut [[u64; 8]], lines: &mut [[u64; 4]]| {
        let material = materials.get(tree).copied().unwrap_or(0);
        TreeWriter { h, points: h.tree(tree), tree, groups, lines }.record(material, record);
    };
    let records = records.par_iter_mut().enumerate();
    match (groups, lines) {
        (0, 0) => records.for_each(|(t, r)| write(t, r, &mut [], &mut [])),
        (0, _) => records.zip(vertices.par_chunks_mut(lines)).for_each(|((t, r), v)| write(t, r, &mut [], v)),
        _ => records.zip(bounds.par_chunks_mut(groups)).zip(vertices.par_chunks_mut(lines)).for_each(|(((t, r), b), v)| write(t, r, b, v)),
    }
}

/// Writes one tree, depth first.
struct TreeWriter<'a> {
    h: &'a Hierarchy,
    points: &'a [[i32; 3]],
    tree: usize,
    groups: &'a mut [[u64; 8]],
    lines: &'a mut [[u64; 4]],
}

impl TreeWriter<'_> {
    fn record(&mut self, material: u16, out: &mut [u64; 8]) {
        let p = lattice::root(self.h.levels);
        let corners = self.node(0, 0, p);
        let root = self.bound_data(0, p, corners);
        VertexData::from_points(p.map(|c| self.at(c))).to_words(&mut out[..4]);
        let record = L0Record { reserved_high: U::ZERO, reserved: U::ZERO, material: U::new(u64::from(material)), root };
        record.to_words(&mut out[4..]);
    }

    fn at(&self, p: LatticePoint) -> [i32; 3] {
        self.points[lattice::index(self.h.levels, p)]
    }

    /// Writes everything below node (`level`, `node`) with corners `p` and gives the box of its full-resolution triangles.
    fn node(&mut self, level: u32, node: usize, p: [LatticePoint; 3]) -> [[i32; 3]; 2] {
        let levels = self.h.levels;
        let span = |v: [[i32; 3]; 3]| v.iter().fold([v[0], v[0]], |b, &c| join(b, [c, c]));
        if level == levels {
            return span(p.map(|c| self.at(c)));
        }
        let q = lattice::midpoints(p).map(|c| self.at(c));
        VertexData::from_points(q).to_words(&mut self.lines[layout::level_start(level) + node]);
        if level + 1 == levels {
            return join(span(p.map(|c| self.at(c))), span(q));
        }
        let mut all = [[i32::MAX; 3], [i32::MIN; 3]];
        for k in 0..4 {
            let child = lattice::child(p, k as u32); // k < 4
            let corners = self.node(level + 1, 4 * node + k, child);
            let data = self.bound_data(level + 1, child, corners);
            data.to_words(&mut self.groups[layout::level_start(level) + node][2 * k..2 * k + 2]);
            all = join(all, corners);
        }
        all
    }

    fn bound_data(&self, level: u32, p: [LatticePoint; 3], [lo, hi]: [[i32; 3]; 2]) -> BoundData {
        // N = 0: the base triangle has no edges to bound.
        let codes = if level < self.h.levels { self.h.node_codes(self.tree, level, p) } else { [0; 3] };
        let [e0, e1, e2] = codes.map(|c| U::new(u64::from(c)));
        let bounds = Box16::from_codes(lo.map(box_code_floor), hi.map(box_code_ceil));
        BoundData { reserved: U::ZERO, e0, e1, e2, bounds }
    }
}
