//! Disjoint sets.

/// Disjoint sets of 0..n.
pub(super) struct Sets(Vec<u32>);

impl Sets {
    pub fn new(n: usize) -> Sets {
        Sets((0..n as u32).collect())
    }

    /// The smallest member known of the set of `i`.
    fn root(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            let up = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = up;
            i = up;
        }
        i
    }

    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }

    /// The number of each member's set, counted in order of their smallest members, and how many there are.
    pub fn numbers(mut self) -> (Vec<u32>, usize) {
        let mut count = 0;
        let mut number = vec![0; self.0.len()];
        for i in 0..self.0.len() {
            let root = self.root(i as u32) as usize;
            number[i] = if root == i {
                count += 1;
                count - 1
            } else {
                number[root]
            };
        }
        (number, count as usize)
    }
}
