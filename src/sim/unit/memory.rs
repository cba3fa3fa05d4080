//! A scene's sections as one memory of 32-byte lines.

use crate::hardware::ports::SceneConfig;
use crate::num::{BoundScale, LineAddress, U};
use crate::traverse::{Kind, LodImage};

/// The sections of a model, one behind the other.
#[derive(Clone, Copy, Debug)]
pub struct SceneMemory<'a> {
    levels: u32,
    scale: BoundScale,
    /// Quad-BVH nodes, L0 records, bound data and vertex data: words and first line.
    sections: [(Kind, &'a [u64], u64); 4],
}

impl<'a> SceneMemory<'a> {
    /// The memory of `image`, its first line at address `first`.
    ///
    /// # Panics
    /// The last line would not have an address.
    pub fn new(image: LodImage<'a>, first: u64) -> Self {
        let words = [
            (Kind::BvhNode, image.nodes.as_flattened()),
            (Kind::L0Record, image.records.as_flattened()),
            (Kind::BoundData, image.bounds.as_flattened()),
            (Kind::VertexData, image.vertices.as_flattened()),
        ];
        let mut end = first;
        let sections = words.map(|(kind, words)| {
            let start = end;
            end += words.len() as u64 / 4;
            (kind, words, start)
        });
        assert!(end <= LineAddress::MAX.get(), "the model does not fit the address space");
        Self { levels: image.levels, scale: image.scale, sections }
    }

    /// What the unit is told of the model.
    pub fn config(&self) -> SceneConfig {
        let [nodes, records, bounds, vertices] = self.sections.map(|(_, _, start)| U::new(start));
        SceneConfig { levels: U::new(u64::from(self.levels)), scale: self.scale, nodes, records, bounds, vertices }
    }

    /// Section and line within it of an address; `None` outside of all.
    pub fn locate(&self, address: LineAddress) -> Option<(Kind, u64)> {
        let place = |&(kind, words, start): &(Kind, &[u64], u64)| {
            let line = address.get().checked_sub(start)?;
            (line < words.len() as u64 / 4).then_some((kind, line))
        };
        self.sections.iter().find_map(place)
    }

    /// The address of a line of a section.
    pub fn address(&self, kind: Kind, line: u64) -> LineAddress {
        let start = self.sections.iter().find(|section| section.0 == kind).map_or(0, |section| section.2);
        U::new(start + line)
    }

    /// The line at an address; `None` outside of all sections.
    pub fn line(&self, address: LineAddress) -> Option<[U<64>; 4]> {
        let (kind, line) = self.locate(address)?;
        let words = self.sections.iter().find(|section| section.0 == kind)?.1;
        let at = 4 * line as usize; // within a slice
        Some(std::array::from_fn(|k| U::new(words[at + k])))
    }
}
