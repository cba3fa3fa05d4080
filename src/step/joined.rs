//! The memories of several models as one.

use super::section::ALIGNMENT;
use super::{Fetch, MAX_SECTIONS, MapError, MemoryMap, Section, SectionId, Step};

/// How far the lines of a memory are moved in one that holds several, section by section.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Moved([u32; MAX_SECTIONS]);

impl Moved {
    /// A step on the moved lines.
    #[inline(always)]
    #[must_use]
    pub fn step(&self, step: Step) -> Step {
        let fetch = |fetch: Fetch| Fetch { line: fetch.line + self.0[fetch.section.place()], ..fetch };
        Step { fetch: step.fetch.map(fetch), ..step }
    }
}

/// One memory for those of several models, of one method: each section holds the parts of all in their order, and `more` sections follow. Rays begin with the first node of a
/// section whose nodes have so many lines each. With it how far each model's lines are moved.
///
/// # Errors
/// There are more lines than 32 bits can number.
///
/// # Panics
/// The memories have different sections, or with `more` there are more than [`MAX_SECTIONS`].
pub fn joined(maps: &[MemoryMap], more: &[Section], nodes: (SectionId, u32)) -> Result<(MemoryMap, Vec<Moved>), MapError> {
    let names = |map: &MemoryMap| map.sections().map(|(_, section)| section.name).collect::<Vec<_>>();
    assert!(maps.windows(2).all(|two| names(&two[0]) == names(&two[1])), "memories of one method");
    let mut sections: Vec<Section> = maps.first().map_or_else(Vec::new, |map| map.sections().map(|(_, section)| section).collect());
    sections.iter_mut().for_each(|section| section.lines = 0);
    let mut before = vec![[0; MAX_SECTIONS]; maps.len()];
    for (map, before) in maps.iter().zip(&mut before) {
        for ((id, own), section) in map.sections().zip(&mut sections) {
            before[id.place()] = section.lines;
            section.lines = (section.lines + own.lines).next_multiple_of(ALIGNMENT);
        }
    }
    sections.extend(more);
    let all = MemoryMap::new(&sections, Some(nodes))?;
    let moved = |(map, before): (&MemoryMap, &[u64; MAX_SECTIONS])| {
        let mut by = [0; MAX_SECTIONS];
        for (id, _) in map.sections() {
            // What is joined lies no earlier than it did, and below 2^32.
            by[id.place()] = all.first(id) + before[id.place()] as u32 - map.first(id);
        }
        Moved(by)
    };
    Ok((all, maps.iter().zip(&before).map(moved).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::{Act, Nodes};

    const fn section(name: &'static str, lines: u64) -> Section {
        Section { name, lines, base: false }
    }

    #[test]
    fn memories_of_models_are_joined_section_by_section() {
        let own = |a, b| MemoryMap::new(&[section("a", a), section("b", b)], Some((SectionId::new(0), 2))).unwrap();
        let maps = [own(6, 4), own(3, 9), own(0, 1)];
        let (all, moved) = joined(&maps, &[section("top", 5)], (SectionId::new(2), 4)).unwrap();
        assert_eq!(all.sections().map(|(_, s)| (s.name, s.lines)).collect::<Vec<_>>(), [("a", 12), ("b", 20), ("top", 5)]);
        assert_eq!(all.nodes(), Nodes { first: 32, lines: 4, count: 1 });
        // Every line of every model has its own place, in its own section.
        let mut seen = std::collections::HashSet::new();
        for (map, moved) in maps.iter().zip(&moved) {
            for (id, section) in map.sections() {
                for line in 0..section.lines {
                    let step = moved.step(Step::on(Fetch::new(id, map.line(id, line), 1), Act::Fetch));
                    let at = step.fetch.unwrap().line;
                    assert!(seen.insert(at) && all.locate(at.into()).unwrap().0 == id);
                }
            }
        }
        assert_eq!(seen.len(), 6 + 4 + 3 + 9 + 1);
        assert_eq!(moved[0].step(Step::end(true, false)), Step::end(true, false));
        let refused = joined(&[own(1, 1 << 31), own(1, 1 << 31)], &[], (SectionId::new(0), 1)).unwrap_err();
        assert_eq!(refused.to_string(), "a memory of 4294967304 lines: they are numbered with 32 bits");
    }
}
