//! From what a traversal tells its probe to a ray's steps.

use super::event::{Event, Step};
use crate::traverse::{Kind, Probe, Section};

/// Where a section begins that a method lacks.
const ABSENT: u64 = u64::MAX;

/// First line of each kind of data, the sections one behind the other.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    first: [u64; Kind::ALL.len()],
    lines: u64,
}

impl Layout {
    /// The layout of a method's memory; `None` if its lines have no 32-bit numbers.
    pub fn new(sections: &[Section]) -> Option<Self> {
        let mut layout = Self { first: [ABSENT; Kind::ALL.len()], lines: 0 };
        for section in sections {
            layout.first[section.kind as usize] = layout.lines;
            // Pairs of lines, and the four of a node with wide boxes, begin at multiples of four.
            layout.lines = (layout.lines + section.lines).next_multiple_of(4);
        }
        (layout.lines < 1 << 32).then_some(layout)
    }

    /// Lines of all sections.
    pub fn lines(&self) -> u64 {
        self.lines
    }

    /// What a line holds.
    #[inline]
    pub fn kind(&self, line: u32) -> Kind {
        let from = |kind: Kind| self.first[kind as usize];
        // Sections that a method lacks begin nowhere before the others.
        Kind::ALL.into_iter().filter(|&kind| from(kind) <= u64::from(line)).max_by_key(|&kind| from(kind)).unwrap_or(Kind::BvhNode)
    }

    /// The number of a line of a section.
    #[inline(always)]
    fn line(&self, kind: Kind, line: u64) -> u32 {
        (self.first[kind as usize] + line) as u32 // `new` refuses more
    }
}

/// Lines read whose step is not over.
#[derive(Clone, Copy, Default)]
struct Reading {
    lines: u32,
    first: u32,
}

/// Writes the steps of rays, one after the other.
pub struct Recorder<'a> {
    layout: &'a Layout,
    events: Vec<Event>,
    reading: Reading,
    /// Triangle tests since the last other step, and which were met.
    triangles: u32,
    hits: u32,
}

impl<'a> Recorder<'a> {
    /// Nothing written yet.
    pub fn new(layout: &'a Layout) -> Self {
        Self { layout, events: Vec::new(), reading: Reading::default(), triangles: 0, hits: 0 }
    }

    /// Ends a ray.
    pub fn end(&mut self, found: bool) {
        self.add(Step::End { found });
    }

    /// The steps so far.
    pub fn steps(&self) -> usize {
        self.events.len()
    }

    /// The steps, in as little memory as they take.
    pub fn into_events(self) -> Box<[Event]> {
        self.events.into_boxed_slice()
    }

    #[inline(always)]
    fn add(&mut self, step: Step) {
        if self.triangles > 0 {
            self.events.push(Event::pack(Step::Triangles { count: self.triangles, hits: self.hits }));
            (self.triangles, self.hits) = (0, 0);
        }
        self.events.push(Event::pack(step));
    }
}

impl Probe for Recorder<'_> {
    #[inline(always)]
    fn line(&mut self, kind: Kind, line: u64) {
        let line = self.layout.line(kind, line);
        match kind {
            Kind::VertexData => self.add(Step::Split { line }),
            Kind::Leaf => self.add(Step::Leaf { line }),
            Kind::L0Record if self.reading.lines == 0 => {
                self.add(Step::Tree { line });
                self.reading.lines = 1;
            }
            Kind::L0Record => self.reading.lines = 0,
            Kind::BvhNode | Kind::BoundData => {
                if self.reading.lines == 0 {
                    self.reading.first = line;
                }
                self.reading.lines += 1;
            }
        }
    }

    #[inline(always)]
    fn node(&mut self, met: u32) {
        let Reading { lines, first: line } = std::mem::take(&mut self.reading);
        let after_split = self.triangles == 0 && matches!(self.events.last().map(|event| event.step()), Some(Step::Split { .. }));
        self.add(if after_split { Step::Bounds { line, met } } else { Step::Node { line, met, wide: lines == 4 } });
    }

    #[inline(always)]
    fn lod_test(&mut self, refine: bool) {
        self.add(Step::Lod { refine });
    }

    #[inline(always)]
    fn triangle(&mut self, hit: bool) {
        self.hits |= u32::from(hit) << self.triangles;
        self.triangles += 1;
    }

    #[inline(always)]
    fn pop(&mut self, dropped: bool) {
        self.add(Step::Pop { dropped });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_is_written_as_its_steps() {
        let section = |kind, lines| Section { kind, lines };
        let sections = [section(Kind::BvhNode, 6), section(Kind::L0Record, 4), section(Kind::BoundData, 10), section(Kind::VertexData, 9)];
        let layout = Layout::new(&sections).unwrap();
        assert_eq!(layout.lines(), 8 + 4 + 12 + 12);
        let kinds = [0, 7, 8, 11, 12, 23, 24, 35].map(|line| layout.kind(line) as usize);
        assert_eq!(kinds, [0, 0, 1, 1, 2, 2, 3, 3]);
        let mut ray = Recorder::new(&layout);
        let pair = |ray: &mut Recorder<'_>, kind, line| (ray.line(kind, line), ray.line(kind, line + 1));
        pair(&mut ray, Kind::BvhNode, 2);
        ray.node(2);
        pair(&mut ray, Kind::L0Record, 2);
        ray.lod_test(true);
        ray.line(Kind::VertexData, 5);
        pair(&mut ray, Kind::BoundData, 4);
        ray.node(1);
        ray.lod_test(true);
        ray.line(Kind::VertexData, 6);
        (0..4).for_each(|k| ray.triangle(k == 2));
        ray.pop(false);
        ray.end(true);
        let steps = [
            Step::Node { line: 2, met: 2, wide: false },
            Step::Tree { line: 10 },
            Step::Lod { refine: true },
            Step::Split { line: 29 },
            Step::Bounds { line: 16, met: 1 },
            Step::Lod { refine: true },
            Step::Split { line: 30 },
            Step::Triangles { count: 4, hits: 4 },
            Step::Pop { dropped: false },
            Step::End { found: true },
        ];
        assert_eq!(ray.into_events().iter().map(|event| event.step()).collect::<Vec<_>>(), steps);
    }

    #[test]
    fn wide_nodes_have_four_lines_and_leaves_any_number() {
        let sections = [Section { kind: Kind::BvhNode, lines: 8 }, Section { kind: Kind::Leaf, lines: 3 }];
        let layout = Layout::new(&sections).unwrap();
        let mut ray = Recorder::new(&layout);
        (4..8).for_each(|line| ray.line(Kind::BvhNode, line));
        ray.node(0);
        ray.pop(true);
        (0..3).for_each(|line| ray.line(Kind::Leaf, line));
        ray.triangle(true);
        ray.end(true);
        let lines: Vec<_> = ray.into_events().iter().filter_map(|event| event.step().lines()).collect();
        assert_eq!(lines, [(Kind::BvhNode, 4, 4), (Kind::Leaf, 8, 1), (Kind::Leaf, 9, 1), (Kind::Leaf, 10, 1)]);
    }

    #[test]
    fn more_lines_than_numbers_are_refused() {
        assert!(Layout::new(&[Section { kind: Kind::BvhNode, lines: (1 << 32) - 4 }]).is_some());
        assert!(Layout::new(&[Section { kind: Kind::BvhNode, lines: (1 << 32) - 3 }]).is_none());
    }
}
