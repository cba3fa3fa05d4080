//! Scene files: written under a temporary name and renamed, mapped when read, everything checked before it is used.

use super::scene::Image;
use super::sections::{FileSection, checksum, read_header};
use super::{BvhNode, ChildRef, LevelStarts, Meta, Scene, SceneError, VertexData, layout, write_and_rename};
use crate::mesh::most_zeros;
use crate::num::{
    COORD_LIMIT, LINE_BYTES, MAX_BOUND_OFFSET, MAX_BVH_DEPTH, MAX_LEVELS, MOST_DIRECTION_ZEROS, PADDING_BITS, VertexForm, Wire,
};
use memmap2::Mmap;
use rayon::prelude::*;
use std::fs::File;
use std::path::Path;
use std::sync::Arc;

impl Scene {
    /// Writes the scene to `path`: under a temporary name in the same directory, then renamed, so that no half-written file is ever found there.
    ///
    /// # Errors
    /// Whatever the operating system refuses.
    pub fn save(&self, path: &Path) -> Result<(), SceneError> {
        write_and_rename(path, |out| out.write_all(self.bytes())).map_err(|source| SceneError::Io {
            path: path.to_path_buf(),
            action: "cannot write",
            source,
        })
    }

    /// Maps a scene file and checks it: frame, all checksums, counts, and every index that traversal follows.
    ///
    /// # Errors
    /// The file cannot be read, or it is not a valid scene: the error names file, section and field.
    pub fn open(path: &Path) -> Result<Self, SceneError> {
        let io = |action| move |source| SceneError::Io { path: path.to_path_buf(), action, source };
        let invalid = |problem: String| SceneError::Invalid { path: path.to_path_buf(), problem };
        // Asked before it is opened: to open a pipe may wait for ever.
        let kind = std::fs::metadata(path).map_err(io("cannot open"))?;
        if !kind.is_file() || kind.len() == 0 {
            return Err(invalid("magic: not a lodray scene file (empty, or not a file)".into()));
        }
        let file = File::open(path).map_err(io("cannot open"))?;
        // SAFETY: the map is read-only, and scene files are replaced by renaming, never changed in place; a program that does change one while it
        // is mapped breaks this assumption, as with every mapped file.
        let map = unsafe { Mmap::map(&file) }.map_err(io("cannot map"))?;
        Self::from_image(Image::Mapped(map)).map_err(invalid)
    }

    /// Checks a file image. The error names section and field.
    fn from_image(image: Image) -> Result<Self, String> {
        let bytes = image.bytes();
        let (ranges, sums) = read_header(bytes)?;
        let bad =
            FileSection::ALL.par_iter().zip(&ranges).zip(&sums).find_first(|((_, range), sum)| checksum(&bytes[(*range).clone()]) != **sum);
        if let Some(((section, _), _)) = bad {
            return Err(format!("section {}: checksum does not match, the data are corrupt", section.name()));
        }
        let meta: Meta =
            serde_json::from_slice(&bytes[ranges[FileSection::Meta.slot()].clone()]).map_err(|e| format!("section META: {e}"))?;
        check_meta(&meta)?;
        for section in [FileSection::Records, FileSection::Normals, FileSection::Triangles, FileSection::Sources] {
            let found = ranges[section.slot()].len();
            if Self::section_lengths(&meta, section) != Some(found) {
                let (name, trees, levels) = (section.name(), meta.trees, meta.levels);
                return Err(format!("section {name}: length {found} does not fit {trees} trees of {levels} splits"));
            }
        }
        let line = LINE_BYTES as usize;
        for (section, size) in
            [(FileSection::Nodes, line), (FileSection::Splits, line), (FileSection::Vertices, line), (FileSection::Colours, 4)]
        {
            let length = ranges[section.slot()].len();
            if length % size != 0 {
                return Err(format!("section {}: length {length} is not a multiple of {size}", section.name()));
            }
        }
        let mut scene = Self { image: Arc::new(image), ranges, meta, starts: LevelStarts::default(), input: None };
        scene.starts = scene.check_trees()?;
        scene.check_indices()?;
        scene.check_values()?;
        Ok(scene)
    }

    /// Trees have their places, and as many splits and vertices as their depths say; gives where levels begin.
    fn check_trees(&self) -> Result<LevelStarts, String> {
        let (levels, form) = (self.levels(), self.meta.vertices);
        let depths = self.depths();
        if let Some(tree) = depths.iter().position(|&depth| depth > levels) {
            return Err(format!("section RECORDS: depth of tree {tree} is {}, above {levels} splits", depths[tree]));
        }
        let (trees, starts) = layout::places(form, &depths);
        if let Some((tree, own)) = trees.iter().enumerate().find(|&(tree, own)| *own != self.tree_lines(tree)) {
            return Err(format!(
                "section RECORDS: place of tree {tree} is {}, by the depths of all it is {}",
                self.tree_lines(tree).place,
                own.place
            ));
        }
        for (name, found, expected) in
            [("SPLITS", self.splits().len(), starts.splits()), ("VERTICES", self.vertices().len(), starts.vertex_lines())]
        {
            if found != expected {
                return Err(format!("section {name}: {found} lines, but the trees have {expected}"));
            }
        }
        if !starts.are_numbered(form) {
            return Err(format!(
                "section SPLITS: {} splits and {} lines of vertices, more than 2^28",
                starts.splits(),
                starts.vertex_lines()
            ));
        }
        Ok(starts)
    }

    /// Coordinates and frames are what the blocks take for granted, so that no width overflows.
    fn check_values(&self) -> Result<(), String> {
        let limit = i64::from(COORD_LIMIT >> PADDING_BITS);
        let beyond = |line: &[u64]| {
            let VertexData { v0, v1, v2, .. } = VertexData::from_words(line);
            [v0, v1, v2].iter().any(|v| v.get().iter().any(|c| c.abs() > limit))
        };
        let outside = |tree: &usize| self.corners(*tree).iter().flatten().any(|c| c.unsigned_abs() > COORD_LIMIT.unsigned_abs());
        if let Some(tree) = (0..self.trees()).into_par_iter().find_first(outside) {
            return Err(format!("section RECORDS: tree {tree} has a coordinate beyond +-{COORD_LIMIT}"));
        }
        match self.meta.vertices {
            VertexForm::Exact => {
                if let Some(line) = self.vertices().par_iter().position_first(|line| beyond(line)) {
                    return Err(format!("section VERTICES: line {line} has a coordinate beyond +-{COORD_LIMIT}"));
                }
            }
            VertexForm::Compact | VertexForm::Short => {
                let bad = (0..self.trees()).into_par_iter().find_map_first(|tree| self.beyond_limit(tree).map(|at| (tree, at)));
                if let Some((tree, (level, node))) = bad {
                    return Err(format!(
                        "tree {tree}: a displacement of node {node} of level {level} leads beyond +-{COORD_LIMIT} or off the grid"
                    ));
                }
            }
        }
        let bad = |line: &[u64; 4]| {
            let node = BvhNode::from_words(line);
            let origin = node.origin.get().into_iter().any(|c| c < -32_767);
            let inverted = |k: usize| {
                let bounds = node.bounds(k);
                (0..3).any(|c| bounds.lo.get()[c] > bounds.hi.get()[c])
            };
            origin || (0..4).any(inverted)
        };
        match self.nodes().par_iter().position_first(bad) {
            Some(node) => Err(format!("section NODES: node {node} has a box inside out, or a frame that begins below -32767")),
            None => Ok(()),
        }
    }

    /// The first node of a tree with compact vertices whose inserted vertices exceed the limit. Base corners that are not on their grid make midpoints that are no
    /// integers: those count too, as the root's.
    fn beyond_limit(&self, tree: usize) -> Option<(u32, usize)> {
        let mask = (1 << VertexForm::Compact.zero_bits(self.levels(), 0, self.meta.coordinate_zeros)) - 1;
        let mut found = self.corners(tree).iter().flatten().any(|c| c & mask != 0).then_some((0, 0));
        // A tree whose vertices wrap at one node is not read any further below by anyone: the first is reported.
        // Middles of edges keep the limit.
        self.each_node(tree, self.tree_lines(tree).depth, &mut |at, _, q| {
            if found.is_none() && q.iter().flatten().any(|c| c.unsigned_abs() > COORD_LIMIT.unsigned_abs()) {
                found = Some(at);
            }
        });
        found
    }

    /// Every index that traversal or shading follows leads somewhere, and the quad-BVH is a tree.
    fn check_indices(&self) -> Result<(), String> {
        let vertices = self.meta.base_vertices;
        let bad = |t: &[u32; 3]| t.iter().any(|&v| v >= vertices) || t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
        if let Some(tree) = self.triangles().par_iter().position_first(bad) {
            return Err(format!("section TRIANGLES: tree {tree} needs three different vertices below {vertices}"));
        }
        let materials = self.colours().len().max(1); // without colours all are material 0
        if let Some(tree) = self.sources().par_iter().position_first(|&[_, material]| material as usize >= materials) {
            return Err(format!("section SOURCES: material of tree {tree} has no colour"));
        }
        if self.colours().len() > 1 << 16 {
            return Err(format!("section COLOURS: {} colours, more than the 65536 that trees can name", self.colours().len()));
        }
        let mut named = vec![false; self.trees()];
        for (tree, &[source, _]) in self.sources().iter().enumerate() {
            match named.get_mut(source as usize) {
                Some(named) if !*named => *named = true,
                Some(_) => return Err(format!("section SOURCES: base triangle {source} is named twice, last by tree {tree}")),
                None => return Err(format!("section SOURCES: there is no base triangle {source}, which tree {tree} names")),
            }
        }
        let nodes = self.nodes();
        let mut seen = vec![false; nodes.len()];
        let mut open = vec![(0, 1)];
        while let Some((index, depth)) = open.pop() {
            if depth > MAX_BVH_DEPTH {
                return Err(format!("section NODES: node {index} lies deeper than {MAX_BVH_DEPTH} nodes"));
            }
            match seen.get_mut(index) {
                Some(seen) if !*seen => *seen = true,
                Some(_) => return Err(format!("section NODES: node {index} is referred to twice")),
                None => return Err(format!("section NODES: there is no node {index} of {}", nodes.len())),
            }
            let node = BvhNode::from_words(&nodes[index]);
            for child in (0..4).map(|k| node.child(k)) {
                let at = child.index.get() as usize; // 28 bits
                match child.kind.get() {
                    ChildRef::EMPTY => {}
                    ChildRef::INNER => open.push((at, depth + 1)),
                    ChildRef::LEAF if at >= self.trees() || child.count.get() != 0 => {
                        return Err(format!(
                            "section NODES: node {index} refers to tree {at} and {} more of {}, not to one",
                            child.count,
                            self.trees()
                        ));
                    }
                    ChildRef::LEAF => {}
                    kind => return Err(format!("section NODES: node {index} has a child of kind {kind}")),
                }
            }
        }
        Ok(())
    }
}

/// Numbers in META lie in their ranges.
fn check_meta(meta: &Meta) -> Result<(), String> {
    let fail = |field: &str, why: String| Err(format!("section META: {field}: {why}"));
    if meta.levels > MAX_LEVELS {
        return fail("levels", format!("{} is above {MAX_LEVELS}", meta.levels));
    }
    if meta.trees == 0 || meta.trees >= 1 << 28 {
        return fail("trees", format!("{} is not in 1 to 2^28 - 1", meta.trees));
    }
    if u64::from(meta.bound_offset) > MAX_BOUND_OFFSET {
        return fail("bound_offset", format!("{} is above {MAX_BOUND_OFFSET}", meta.bound_offset));
    }
    if meta.coordinate_zeros > most_zeros(meta.levels) {
        return fail(
            "coordinate_zeros",
            format!("{} is above {} with {} splits", meta.coordinate_zeros, most_zeros(meta.levels), meta.levels),
        );
    }
    if meta.direction_zeros > MOST_DIRECTION_ZEROS {
        return fail("direction_zeros", format!("{} is above {MOST_DIRECTION_ZEROS}", meta.direction_zeros));
    }
    if !(meta.moved.is_finite() && meta.moved >= 0.0) {
        return fail("moved", format!("{} is no distance", meta.moved));
    }
    let placement = meta.placement;
    if !(placement.scale.is_normal() && placement.scale > 0.0 && placement.offset.iter().all(|c| c.is_finite())) {
        return fail("placement", format!("{placement:?} is not finite with a positive scale"));
    }
    let corner = |k: usize| meta.lo[k] <= meta.hi[k] && meta.lo[k] >= -COORD_LIMIT && meta.hi[k] <= COORD_LIMIT;
    if !(0..3).all(corner) {
        return fail("lo, hi", format!("{:?} to {:?} is no box within +-{COORD_LIMIT}", meta.lo, meta.hi));
    }
    Ok(())
}
