//! The sections of a method's memory, one behind the other: the only place that decides where a line lies.

use std::ops::Range;
use thiserror::Error;

/// Most sections of a method: three bits name one.
pub const MAX_SECTIONS: usize = 8;

/// Sections begin at multiples of this many lines, so that no node straddles what begins with its first line.
pub(super) const ALIGNMENT: u64 = 4;

/// A section, by its place among those of its method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SectionId(u8);

impl SectionId {
    /// The section at `place`, below [`MAX_SECTIONS`].
    ///
    /// # Panics
    /// There is no such place.
    pub const fn new(place: usize) -> Self {
        assert!(place < MAX_SECTIONS, "a method has at most MAX_SECTIONS sections");
        Self(place as u8) // below 8
    }

    /// Its place.
    #[inline(always)]
    pub const fn place(self) -> usize {
        self.0 as usize
    }
}

/// One section of a method's memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Section {
    /// Its name in reports.
    pub name: &'static str,
    /// Its size in 32-byte lines.
    pub lines: u64,
    /// It is of the L0 part: what a method has over the base triangles.
    pub base: bool,
}

impl Section {
    /// A section of `bytes` bytes.
    pub fn of_bytes(name: &'static str, bytes: u64) -> Self {
        Self { name, lines: bytes.div_ceil(crate::num::LINE_BYTES), base: false }
    }

    /// The same of the L0 part.
    #[must_use]
    pub fn of_base(self) -> Self {
        Self { base: true, ..self }
    }
}

/// The nodes that rays begin with, from their root on in memory order: what a core may hold for good.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Nodes {
    /// First line of the root.
    pub first: u32,
    /// Lines of each node.
    pub lines: u32,
    /// How many there are.
    pub count: u32,
}

impl Nodes {
    /// The lines of the first `count` of them.
    pub fn lines_of(&self, count: u32) -> Range<u32> {
        self.first..self.first + self.lines * count.min(self.count)
    }
}

/// A method's memory has lines without a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("a memory of {0} lines: they are numbered with 32 bits")]
pub struct MapError(u64);

/// Where the lines of a method's memory lie: its sections in order, each from a multiple of four lines on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MemoryMap {
    sections: [Section; MAX_SECTIONS],
    first: [u32; MAX_SECTIONS],
    count: usize,
    lines: u64,
    nodes: Nodes,
}

impl MemoryMap {
    /// The memory of these sections, at most [`MAX_SECTIONS`]; rays begin with the first node of a section whose nodes have so many lines each, if there is one.
    ///
    /// # Errors
    /// There are more lines than 32 bits can number.
    pub fn new(sections: &[Section], nodes: Option<(SectionId, u32)>) -> Result<Self, MapError> {
        let mut map =
            Self { sections: Default::default(), first: Default::default(), count: sections.len(), lines: 0, nodes: Nodes::default() };
        for (k, section) in sections.iter().enumerate() {
            map.sections[k] = *section;
            map.first[k] = u32::try_from(map.lines).map_err(|_| MapError(map.lines))?;
            map.lines = map.lines.saturating_add(section.lines).checked_next_multiple_of(ALIGNMENT).ok_or(MapError(u64::MAX))?;
        }
        if map.lines >= 1 << 32 {
            return Err(MapError(map.lines));
        }
        if let Some((section, lines)) = nodes {
            let (first, of_section) = (map.first[section.place()], map.sections[section.place()].lines);
            // Below 2^32 lines.
            map.nodes = Nodes { first, lines, count: of_section as u32 / lines.max(1) };
        }
        Ok(map)
    }

    /// The same memory, for rays that begin with node `root` of the nodes' section, of which `count` follow it.
    #[must_use]
    pub fn from_node(self, root: u32, count: u32) -> Self {
        let Nodes { first, lines, .. } = self.nodes;
        Self { nodes: Nodes { first: first + root * lines, lines, count }, ..self }
    }

    /// The nodes that rays begin with.
    pub fn nodes(&self) -> Nodes {
        self.nodes
    }

    /// The sections with their names in reports.
    pub fn sections(&self) -> impl Iterator<Item = (SectionId, Section)> {
        self.sections.into_iter().take(self.count).enumerate().map(|(k, section)| (SectionId::new(k), section))
    }

    /// The section of this name.
    pub fn section(&self, name: &str) -> Option<SectionId> {
        self.sections().find(|(_, section)| section.name == name).map(|(id, _)| id)
    }

    /// Lines of all sections, and of what lies between them.
    pub fn lines(&self) -> u64 {
        self.lines
    }

    /// Bytes of all sections.
    pub fn bytes(&self) -> u64 {
        self.sections().map(|(_, section)| section.lines * crate::num::LINE_BYTES).sum()
    }

    /// The first line of a section.
    #[inline(always)]
    pub fn first(&self, section: SectionId) -> u32 {
        self.first[section.place()]
    }

    /// Line `line` of a section.
    #[inline(always)]
    pub fn line(&self, section: SectionId, line: u64) -> u32 {
        debug_assert!(line < self.sections[section.place()].lines, "line {line} of {:?}", self.sections[section.place()]);
        self.first[section.place()] + line as u32 // `new` refuses more lines than 32 bits have
    }

    /// Section of a line, and its place there; `None` between sections and behind them.
    pub fn locate(&self, line: u64) -> Option<(SectionId, u64)> {
        self.sections().find_map(|(id, section)| {
            let place = line.checked_sub(u64::from(self.first(id)))?;
            (place < section.lines).then_some((id, place))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn section(name: &'static str, lines: u64) -> Section {
        Section { name, lines, base: false }
    }

    #[test]
    fn sections_lie_one_behind_the_other() {
        let map = MemoryMap::new(&[section("a", 6), section("b", 4), section("c", 9)], Some((SectionId::new(0), 2))).unwrap();
        assert_eq!(map.lines(), 8 + 4 + 12);
        let [a, b, c] = [0, 1, 2].map(SectionId::new);
        assert_eq!([a, b, c].map(|id| map.first(id)), [0, 8, 12]);
        assert_eq!((map.line(c, 8), map.section("b"), map.section("d")), (20, Some(b), None));
        let places = [0, 5, 6, 7, 8, 11, 12, 20, 21, 100].map(|line| map.locate(line));
        let found = [Some((a, 0)), Some((a, 5)), None, None, Some((b, 0)), Some((b, 3)), Some((c, 0)), Some((c, 8)), None, None];
        assert_eq!(places, found);
        assert_eq!((map.bytes(), map.nodes()), (32 * 19, Nodes { first: 0, lines: 2, count: 3 }));
        assert_eq!([0, 2, 9].map(|n| map.nodes().lines_of(n)), [0..0, 0..4, 0..6]);
        assert_eq!(map.from_node(1, 2).nodes().lines_of(1), 2..4);
    }

    #[test]
    fn more_lines_than_numbers_are_refused() {
        let map = |lines| MemoryMap::new(&[section("a", lines), section("b", 1)], Some((SectionId::new(0), 2)));
        assert!(map((1 << 32) - 8).is_ok());
        assert_eq!(map((1 << 32) - 7), Err(MapError(1 << 32)));
        assert!(map(u64::MAX).is_err() && map(u64::MAX - 8).is_err());
    }
}
