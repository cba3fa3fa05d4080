//! How full a unit's parts were, stretch by stretch: a mean over a frame hides that a part is full in one phase of it and idle in the next.

use crate::hardware::Resource;

/// Cycles of a stretch, the last of a run but for what is left.
pub const STRETCH: u64 = 1024;

/// Loads of a part are told in so many equal steps from 0 to 1.
pub const STEPS: usize = 10;

/// Resources, and the comparison of hits.
pub(super) const PARTS: usize = Resource::COUNT + 1;

/// How full each part of a unit was.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Phases {
    /// All cycles.
    pub cycles: u64,
    /// By part's name.
    pub parts: Vec<(&'static str, PartPhases)>,
}

/// How full one part was. A stretch's load is the share of its cycles in which the part could take nothing, as it had taken something a moment before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PartPhases {
    /// Cycles in which it could take nothing.
    pub loaded: u64,
    /// Cycles of stretches, by load: from each tenth up to the next.
    pub by_load: [u64; STEPS],
    /// Cycles of the stretches with a load of nine tenths or more in which no part before it in the list had a larger one.
    pub fullest: u64,
}

/// Looks at the parts of a unit at the end of each stretch.
#[derive(Clone, Debug, Default)]
pub(super) struct Watch {
    /// Where the stretch began that has not ended.
    pub since: u64,
    /// By part.
    pub parts: [PartPhases; PARTS],
}

impl Watch {
    /// The cycle in which a stretch ends.
    pub fn end(&self) -> u64 {
        self.since + STRETCH
    }

    /// A stretch ended in cycle `end`, up to which each part was loaded for so many cycles.
    pub fn close(&mut self, end: u64, loaded: [u64; PARTS]) {
        let length = end - self.since;
        let mut fullest = None;
        for (k, part) in self.parts.iter_mut().enumerate() {
            let load = loaded[k] - part.loaded;
            part.loaded = loaded[k];
            let step = ((STEPS as u64 * load / length) as usize).min(STEPS - 1);
            part.by_load[step] += length;
            if step == STEPS - 1 && fullest.is_none_or(|(_, most)| load > most) {
                fullest = Some((k, load));
            }
        }
        if let Some((k, _)) = fullest {
            self.parts[k].fullest += length;
        }
        self.since = end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::Timing;
    use crate::sim::timing::station::Station;

    #[test]
    fn a_part_is_full_in_the_stretches_in_which_it_was() {
        let mut watch = Watch::default();
        let mut loaded = [0; PARTS];
        // The first is full, then the second; the third is half full in both.
        (loaded[0], loaded[2]) = (STRETCH, STRETCH / 2);
        watch.close(STRETCH, loaded);
        (loaded[1], loaded[2]) = (STRETCH * 19 / 20, STRETCH);
        watch.close(2 * STRETCH, loaded);
        // What is left is half a stretch, in which the fourth was as full as can be, and so was the fifth.
        (loaded[3], loaded[4]) = (STRETCH / 2, STRETCH / 2);
        watch.close(2 * STRETCH + STRETCH / 2, loaded);
        let fullest = watch.parts.map(|part| part.fullest);
        assert_eq!(fullest[..5], [STRETCH, STRETCH, 0, STRETCH / 2, 0]);
        let by_load = |part: usize, step: usize| watch.parts[part].by_load[step];
        assert_eq!([by_load(0, 9), by_load(0, 0)], [STRETCH, STRETCH + STRETCH / 2]);
        assert_eq!([by_load(2, 5), by_load(2, 0)], [2 * STRETCH, STRETCH / 2]);
        assert_eq!([by_load(3, 9), by_load(4, 9)], [STRETCH / 2; 2]);
        assert!(watch.parts.iter().all(|part| part.by_load.iter().sum::<u64>() == 2 * STRETCH + STRETCH / 2));
    }

    #[test]
    fn what_is_taken_near_an_end_loads_the_stretch_behind_it_too() {
        let mut station = Station::new(Timing { latency: 20, interval: 10 });
        station.take(5, 5);
        assert_eq!([8, 15, 100].map(|end| station.loaded(end)), [3, 10, 10]);
        station.take(1020, 1020);
        assert_eq!([1024, 1030, 2048].map(|end| station.loaded(end)), [14, 20, 20]);
    }
}
