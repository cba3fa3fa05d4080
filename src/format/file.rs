//! Scene files: written under a temporary name and renamed, mapped when read, everything checked before it is used.

use super::scene::Image;
use super::sections::{FileSection, checksum, read_header};
use super::{BoundData, Box16, BvhChild, ChildRef, L0Record, Meta, Scene, SceneError, VertexData, write_and_rename};
use crate::num::{COORD_LIMIT, MAX_BVH_DEPTH, MAX_LEVELS, PADDING_BITS, Wire, bound_decode};
use memmap2::Mmap;
use rayon::prelude::*;
use std::fs::File;
use std::path::Path;

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
        let file = File::open(path).map_err(io("cannot open"))?;
        let kind = file.metadata().map_err(io("cannot read its size"))?;
        let invalid = |problem: String| SceneError::Invalid { path: path.to_path_buf(), problem };
        if !kind.is_file() || kind.len() == 0 {
            return Err(invalid("magic: not a lodray scene file (empty, or not a file)".into()));
        }
        // SAFETY: the map is read-only, and scene files are replaced by renaming, never changed in place; a program that does change one while it
        // is mapped breaks this assumption, as with every mapped file.
        let map = unsafe { Mmap::map(&file) }.map_err(io("cannot map"))?;
        Self::from_image(Image::Mapped(map)).map_err(invalid)
    }

    /// Checks a file image. The error names section and field.
    fn from_image(image: Image) -> Result<Self, String> {
        let bytes: &[u8] = match &image {
            Image::Owned(m) => m,
            Image::Mapped(m) => m,
        };
        let (ranges, sums) = read_header(bytes)?;
        let bad =
            FileSection::ALL.par_iter().zip(&ranges).zip(&sums).find_first(|((_, range), sum)| checksum(&bytes[(*range).clone()]) != **sum);
        if let Some(((section, _), _)) = bad {
            return Err(format!("section {}: checksum does not match, the data are corrupt", section.name()));
        }
        let meta: Meta =
            serde_json::from_slice(&bytes[ranges[FileSection::Meta.slot()].clone()]).map_err(|e| format!("section META: {e}"))?;
        check_meta(&meta)?;
        for section in [FileSection::Records, FileSection::Bounds, FileSection::Vertices, FileSection::Normals, FileSection::Triangles] {
            let found = ranges[section.slot()].len();
            if Self::section_lengths(&meta, section) != Some(found) {
                let (name, trees, levels) = (section.name(), meta.trees, meta.levels);
                return Err(format!("section {name}: length {found} does not fit {trees} trees of {levels} splits"));
            }
        }
        for (section, size) in [(FileSection::Nodes, 64), (FileSection::Colours, 4)] {
            let length = ranges[section.slot()].len();
            if length % size != 0 {
                return Err(format!("section {}: length {length} is not a multiple of {size}", section.name()));
            }
        }
        let scene = Self { image, ranges, meta };
        scene.check_indices()?;
        scene.check_values()?;
        Ok(scene)
    }

    /// Coordinates and box codes are what the blocks take for granted, so that no width overflows.
    fn check_values(&self) -> Result<(), String> {
        let limit = i64::from(COORD_LIMIT >> PADDING_BITS);
        let beyond = |line: &[u64]| {
            let VertexData { v0, v1, v2, .. } = VertexData::from_words(line);
            [v0, v1, v2].iter().any(|v| v.get().iter().any(|c| c.abs() > limit))
        };
        if let Some(line) = self.vertices().par_iter().position_first(|line| beyond(line)) {
            return Err(format!("section VERTICES: line {line} has a coordinate beyond +-{COORD_LIMIT}"));
        }
        let inverted = |b: Box16| (0..3).any(|k| b.lo.get()[k] > b.hi.get()[k] || b.lo.get()[k] < -32_767);
        let bad = |r: &[u64; 8]| beyond(&r[..4]) || inverted(L0Record::from_words(&r[4..]).root.bounds);
        if let Some(tree) = self.records().par_iter().position_first(bad) {
            return Err(format!("section RECORDS: tree {tree} has a coordinate beyond +-{COORD_LIMIT} or a box inside out"));
        }
        let bad = |group: &[u64; 8]| group.as_chunks::<2>().0.iter().any(|words| inverted(BoundData::from_words(words).bounds));
        if let Some(group) = self.bounds().par_iter().position_first(bad) {
            return Err(format!("section BOUNDS: group {group} has a box inside out"));
        }
        let bad = |node: &[u64; 8]| node.as_chunks::<2>().0.iter().any(|words| inverted(BvhChild::from_words(words).bounds));
        match self.nodes().par_iter().position_first(bad) {
            Some(node) => Err(format!("section NODES: node {node} has a box inside out")),
            None => Ok(()),
        }
    }

    /// Every index that traversal or shading follows leads somewhere, and the quad-BVH is a tree.
    fn check_indices(&self) -> Result<(), String> {
        let vertices = self.meta.base_vertices;
        let bad = |t: &[u32; 3]| t.iter().any(|&v| v >= vertices) || t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
        if let Some(tree) = self.triangles().par_iter().position_first(bad) {
            return Err(format!("section TRIANGLES: tree {tree} needs three different vertices below {vertices}"));
        }
        let materials = self.colours().len().max(1); // without colours all are material 0
        let bad = |r: &[u64; 8]| L0Record::from_words(&r[4..]).material.get() >= materials as u64;
        if let Some(tree) = self.records().par_iter().position_first(bad) {
            return Err(format!("section RECORDS: material of tree {tree} has no colour"));
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
            for words in nodes[index].as_chunks::<2>().0 {
                let child = BvhChild::from_words(words).child;
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
    if meta.bound_mantissa >= 1 << 18 || meta.bound_shift >= 1 << 6 {
        return fail("bound_mantissa, bound_shift", format!("{}, {} exceed 18 and 6 bits", meta.bound_mantissa, meta.bound_shift));
    }
    if bound_decode(meta.bound_scale(), 1023) >= 1 << 33 {
        return fail("bound_mantissa, bound_shift", "the largest bound exceeds 33 bits".into());
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
