//! A scene with fewer levels of its trees.

use super::encode::{new_image, sealed, split_parts, vertex_parts};
use super::sections::FileSection;
use super::{Displacements, Job, Line, Meta, Scene, SceneError, SplitRecord, has_split, layout};
use crate::num::{BoundCode, U, VertexForm, Wire};

impl Scene {
    /// The form of vertices with so many levels of each tree. Where a tree loses levels, vertices that were in splits are in last splits, where short ones have no room.
    fn form_at(&self, depths: &[u32]) -> VertexForm {
        match self.meta().vertices {
            VertexForm::Short if self.depths() != depths => VertexForm::Compact,
            form => form,
        }
    }

    /// Bytes of L0 records, splits and vertices of trees of these depths.
    pub fn bytes_of(&self, depths: &[u32]) -> u64 {
        let (_, starts) = layout::places(self.form_at(depths), depths);
        (size_of_val(self.records()) + size_of::<Line>() * (starts.splits() + starts.vertex_lines())) as u64
    }

    /// The same scene with at most so many levels of each tree, for these rays alone: none of them goes deeper.
    ///
    /// # Errors
    /// Memory cannot be had.
    ///
    /// # Panics
    /// There is not one depth for each tree.
    pub fn pruned(&self, depths: &[u32], job: Job) -> Result<Self, SceneError> {
        assert_eq!(depths.len(), self.trees());
        let depths: Vec<u32> = self.depths().into_iter().zip(depths).map(|(stored, &depth)| stored.min(depth)).collect();
        let form = self.form_at(&depths);
        let (trees, starts) = layout::places(form, &depths);
        let mut meta = Meta { vertices: form, ..self.meta().clone() };
        (meta.job, meta.regions) = (job.views, job.regions);
        meta.without_normals |= job.unshaded;
        let normals = if meta.without_normals { &[] } else { self.section(FileSection::Normals) };
        let json = serde_json::to_vec(&meta).map_err(|e| SceneError::Build(format!("META: {e}")))?;
        let lengths = FileSection::ALL.map(|section| match section {
            FileSection::Meta => json.len(),
            FileSection::Splits => size_of::<Line>() * starts.splits(),
            FileSection::Vertices => size_of::<Line>() * starts.vertex_lines(),
            FileSection::Normals => normals.len(),
            _ => self.section(section).len(),
        });
        let (mut image, ranges) = new_image(lengths)?;
        for section in FileSection::ALL {
            let out = &mut image[ranges[section.slot()].clone()];
            match section {
                FileSection::Meta => out.copy_from_slice(&json),
                FileSection::Records => {
                    out.copy_from_slice(self.section(section));
                    let records = bytemuck::cast_slice_mut::<u8, Line>(out).chunks_exact_mut(form.record_lines());
                    for (tree, (record, &lines)) in records.zip(&trees).enumerate() {
                        let mut own = self.record(tree).of_tree(lines);
                        if lines.depth == 0 {
                            [own.e0, own.e1, own.e2] = [BoundCode::ZERO; 3];
                        }
                        own.to_words(&mut record[0]);
                    }
                }
                FileSection::Splits => {
                    for (tree, (parts, own)) in split_parts(bytemuck::cast_slice_mut(out), &trees).into_iter().zip(&trees).enumerate() {
                        for (part, level) in parts.into_iter().zip(0..) {
                            let first = self.starts.split(self.tree_lines(tree), level, 0);
                            part.copy_from_slice(&self.splits()[first..][..part.len()]);
                            // A root that splits into triangles alone has no more than its vertices there.
                            if own.depth == 1 {
                                let SplitRecord { v0, v1, v2, .. } = SplitRecord::from_words(&part[0]);
                                SplitRecord { v0, v1, v2, ..SplitRecord::default() }.to_words(&mut part[0]);
                            }
                        }
                    }
                }
                FileSection::Vertices => {
                    for (tree, (parts, own)) in
                        vertex_parts(form, bytemuck::cast_slice_mut(out), &trees).into_iter().zip(&trees).enumerate()
                    {
                        let levels = (0..).filter(|&level| layout::has_vertices(form, own.depth, level));
                        for (part, level) in parts.into_iter().zip(levels) {
                            self.copy_vertices(form, tree, level, part);
                        }
                    }
                }
                FileSection::Normals => out.copy_from_slice(normals),
                _ => out.copy_from_slice(self.section(section)),
            }
        }
        Ok(sealed(image, ranges, meta, starts))
    }

    /// Fills the vertex lines of a level of a tree, which in this scene may lie in its splits.
    fn copy_vertices(&self, form: VertexForm, tree: usize, level: u32, out: &mut [Line]) {
        let (stored, lines) = (self.meta().vertices, self.tree_lines(tree));
        if form == VertexForm::Compact && stored == VertexForm::Short && !has_split(lines.depth, level) {
            for (node, half) in out.as_flattened_mut().chunks_exact_mut(2).enumerate() {
                let steps = self.displacements(tree, level, node).map(|v| v.get().map(|c| c as i32)); // 13 bits
                Displacements::from_steps(steps).to_words(half);
            }
        } else if form == VertexForm::Compact && has_split(lines.depth, level) {
            for (half, split) in out.as_flattened_mut().chunks_exact_mut(2).zip(&self.splits()[self.starts.split(lines, level, 0)..]) {
                let SplitRecord { v0, v1, v2, .. } = SplitRecord::from_words(split);
                Displacements { reserved: U::ZERO, v0, v1, v2 }.to_words(half);
            }
        } else {
            out.copy_from_slice(&self.vertices()[self.starts.vertex_line(form, lines, level, 0)..][..out.len()]);
        }
    }
}
