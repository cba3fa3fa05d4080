//! A scene's sections as the unit's memory, from some address on.

use crate::format::{FileSection, LevelStarts, Scene};
use crate::hardware::ports::{AnswerLimit, SceneConfig};
use crate::method::lod::{LodImage, NODES, RECORDS, SPLITS, VERTICES};
use crate::num::{BoundScale, LINE_BYTES, LineAddress, U, VertexForm};
use crate::step::{MemoryMap, SectionId};

/// Words of a line.
const WORDS: u64 = 4;

/// The lines of a model, as its [`MemoryMap`] has them.
#[derive(Clone, Copy, Debug)]
pub struct SceneMemory<'a> {
    levels: u32,
    zeros: u32,
    form: VertexForm,
    scale: BoundScale,
    /// Words of each section, by its place.
    sections: [&'a [u64]; 4],
    starts: LevelStarts,
    map: MemoryMap,
    /// Address of the map's first line.
    first: u64,
}

impl<'a> SceneMemory<'a> {
    /// The memory of `image`, its first line at address `first`.
    ///
    /// # Panics
    /// The last line would not have an address.
    pub fn new(image: LodImage<'a>, first: u64) -> Self {
        let mut sections: [&[u64]; 4] = [&[]; 4];
        sections[NODES.place()] = image.nodes.as_flattened();
        sections[RECORDS.place()] = image.records.as_flattened();
        sections[SPLITS.place()] = image.splits.as_flattened();
        sections[VERTICES.place()] = image.vertices.as_flattened();
        assert!(first + image.map.lines() <= LineAddress::MAX.get(), "the model does not fit the address space");
        Self {
            levels: image.levels,
            zeros: image.zeros,
            form: image.form,
            scale: image.scale,
            sections,
            starts: image.starts,
            map: image.map,
            first,
        }
    }

    /// What the unit is told of the model.
    pub fn config(&self) -> SceneConfig {
        let [nodes, records, splits, vertices] = [NODES, RECORDS, SPLITS, VERTICES].map(|section| self.address(self.map.first(section)));
        let (levels, zeros) = (U::new(u64::from(self.levels)), U::new(u64::from(self.zeros)));
        SceneConfig {
            levels,
            zeros,
            compact: self.form.is_compact(),
            short_splits: self.form == VertexForm::Short,
            scale: self.scale,
            nodes,
            records,
            splits,
            vertices,
            split_starts: std::array::from_fn(|k| U::new(self.starts.split_level(k + 1) as u64)),
            vertex_starts: std::array::from_fn(|k| U::wrapping(self.starts.vertex_level(k + 1) as u64)),
            visits: U::new(self.visits()),
            answer_limit: AnswerLimit::MAX,
        }
    }

    /// The most entries that a ray can visit: each node of the quad-BVH, each tree and each node of a tree has one parent and is visited once.
    fn visits(&self) -> u64 {
        let lines = |section: SectionId| self.sections[section.place()].len() as u64 / WORDS;
        let trees = lines(RECORDS) / self.form.record_lines() as u64;
        lines(NODES) + trees + 4 * lines(SPLITS)
    }

    /// Section and line within it of an address; `None` outside of all.
    pub fn locate(&self, address: LineAddress) -> Option<(SectionId, u64)> {
        self.map.locate(address.get().checked_sub(self.first)?)
    }

    /// The name of a section.
    pub fn name(&self, section: SectionId) -> &'static str {
        self.map.sections().find(|(id, _)| *id == section).map_or("", |(_, section)| section.name)
    }

    /// The address of a line of the map.
    pub fn address(&self, line: u32) -> LineAddress {
        U::new(self.first + u64::from(line))
    }

    /// The line at an address; `None` outside of all sections.
    pub fn line(&self, address: LineAddress) -> Option<[U<64>; 4]> {
        let (section, line) = self.locate(address)?;
        let words = self.sections[section.place()];
        let at = 4 * line as usize; // within a slice
        Some(std::array::from_fn(|k| U::new(words[at + k])))
    }
}

/// What the unit is told of a scene whose file lies in memory as it is, from line 0 on: sections begin at multiples of two lines.
pub fn file_config(scene: &Scene) -> SceneConfig {
    let first = |section| U::new(scene.range(section).start as u64 / LINE_BYTES);
    SceneConfig {
        nodes: first(FileSection::Nodes),
        records: first(FileSection::Records),
        splits: first(FileSection::Splits),
        vertices: first(FileSection::Vertices),
        ..SceneMemory::new(LodImage::of(scene), 0).config()
    }
}
