//! Round-robin choice among the contexts that ask for a resource (`rtl/arbiter.sv`).

/// The arbiter of one resource; contexts are bits.
#[derive(Clone, Copy, Debug, Default)]
pub struct Arbiter {
    /// Contexts behind the last one taken, up to the top. None of them stands for all of them.
    behind: u64,
}

impl Arbiter {
    /// The first request at or after the place behind the last one taken, cyclically.
    pub fn winner(&self, requests: u64) -> Option<usize> {
        let upper = requests & self.behind;
        let candidates = if upper == 0 { requests } else { upper };
        (candidates != 0).then(|| candidates.trailing_zeros() as usize)
    }

    /// The resource took this winner.
    pub fn took(&mut self, winner: usize) {
        self.behind = u64::MAX.checked_shl(winner as u32 + 1).unwrap_or(0); // below 64 by the number of contexts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_go_round_and_wait_while_nothing_is_taken() {
        let mut arbiter = Arbiter::default();
        let mut turn = |requests| {
            let winner = arbiter.winner(requests);
            winner.inspect(|&w| arbiter.took(w))
        };
        assert_eq!([0b1011, 0b1011, 0b1011, 0b1011].map(&mut turn), [Some(0), Some(1), Some(3), Some(0)]);
        assert_eq!([0b0001, 0, 1 << 63, 0b0110].map(&mut turn), [Some(0), None, Some(63), Some(1)]);
        let waiting = Arbiter::default();
        assert_eq!([waiting.winner(0b110), waiting.winner(0b111)], [Some(1), Some(0)]);
    }
}
