//! How long things have been where they are: misses in registers, requests in queues.

/// Things that are there, each since some time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Standing {
    count: u64,
    /// The sum of the times since when.
    since: u64,
}

impl Standing {
    /// One comes at time `since`.
    #[inline(always)]
    pub fn comes(&mut self, since: u64) {
        self.count += 1;
        self.since += since;
    }

    /// One that came at time `since` goes.
    #[inline(always)]
    pub fn goes(&mut self, since: u64) {
        self.count -= 1;
        self.since -= since;
    }

    /// How many there are.
    pub fn count(self) -> u64 {
        self.count
    }

    /// How long all of them together have been there by `time`; those who come later count as nothing if they are all there are.
    pub fn time(self, time: u64) -> u64 {
        (self.count * time).saturating_sub(self.since)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_add_up() {
        let mut standing = Standing::default();
        [3, 5, 5].into_iter().for_each(|since| standing.comes(since));
        assert_eq!((standing.count(), standing.time(10)), (3, 7 + 5 + 5));
        standing.goes(5);
        assert_eq!((standing.count(), standing.time(10)), (2, 12));
        [3, 5].into_iter().for_each(|since| standing.goes(since));
        assert_eq!(standing, Standing::default());
        assert_eq!(standing.time(10), 0);
    }
}
