//! A scene with fewer levels of its trees.

use super::encode::{group_parts, new_image, sealed, vertex_parts};
use super::sections::FileSection;
use super::{Displacements, Job, Line, Scene, SceneError, layout};
use crate::num::{BoundCode, Wire};

impl Scene {
    /// Bytes of L0 records, sibling groups and vertices of trees of these depths.
    pub fn bytes_of(&self, depths: &[u32]) -> u64 {
        let (_, starts) = layout::places(depths);
        (size_of_val(self.records()) + size_of::<Line>() * (starts.groups() + starts.vertex_lines(self.meta().vertices))) as u64
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
        let form = self.meta().vertices;
        let (trees, starts) = layout::places(&depths);
        let mut meta = self.meta().clone();
        (meta.job, meta.regions) = (job.views, job.regions);
        meta.without_normals |= job.unshaded;
        let normals = if meta.without_normals { &[] } else { self.section(FileSection::Normals) };
        let json = serde_json::to_vec(&meta).map_err(|e| SceneError::Build(format!("META: {e}")))?;
        let lengths = FileSection::ALL.map(|section| match section {
            FileSection::Meta => json.len(),
            FileSection::Bounds => size_of::<Line>() * starts.groups(),
            FileSection::Vertices => size_of::<Line>() * starts.vertex_lines(form),
            FileSection::Normals => normals.len(),
            _ => self.section(section).len(),
        });
        let (mut image, ranges) = new_image(lengths)?;
        for section in FileSection::ALL {
            let out = &mut image[ranges[section.slot()].clone()];
            match section {
                FileSection::Meta => out.copy_from_slice(&json),
                FileSection::Records => {
                    for (tree, (record, &lines)) in bytemuck::cast_slice_mut::<u8, [u64; 8]>(out).iter_mut().zip(&trees).enumerate() {
                        *record = self.records()[tree];
                        let mut second = self.record(tree).of_tree(lines);
                        if lines.depth == 0 {
                            [second.e0, second.e1, second.e2] = [BoundCode::ZERO; 3];
                            second.split = Displacements::default();
                        }
                        second.to_words(&mut record[4..]);
                    }
                }
                FileSection::Bounds | FileSection::Vertices => {
                    let out: &mut [Line] = bytemuck::cast_slice_mut(out);
                    let groups = section == FileSection::Bounds;
                    let (parts, whole) =
                        if groups { (group_parts(out, &trees), self.bounds()) } else { (vertex_parts(form, out, &trees), self.vertices()) };
                    // Compact vertices begin at level 1.
                    let top = u32::from(!groups && form.is_compact());
                    for (tree, parts) in parts.into_iter().enumerate() {
                        for (part, level) in parts.into_iter().zip(top..) {
                            let tree = self.tree_lines(tree);
                            let first = if groups {
                                self.starts.child_group(tree, level, 0)
                            } else {
                                self.starts.vertex_line(form, tree, level, 0)
                            };
                            part.copy_from_slice(&whole[first..][..part.len()]);
                        }
                    }
                }
                FileSection::Normals => out.copy_from_slice(normals),
                _ => out.copy_from_slice(self.section(section)),
            }
        }
        Ok(sealed(image, ranges, meta, starts))
    }
}
