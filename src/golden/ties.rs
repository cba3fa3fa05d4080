//! How near a ray comes to the places where a decision would go the other way: what a hunt for counterexamples climbs on.

use super::predicates::Fractions;
use num_bigint::BigInt;
use num_traits::ToPrimitive;

/// The closest of each kind on one ray's way; `None` where nothing of the kind happened.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ties {
    /// Least |edge function| of a triangle whose other two agree in sign, not 0: an integer, the next smaller is an exact tie.
    pub edge: Option<u128>,
    /// Edge functions of such triangles that are exactly 0.
    pub edge_zeros: u32,
    /// Least distance of an LOD decision (h against D, h against 2D) from its border, in steps of 2^-shift units; 0 is the border itself.
    pub lod: Option<u128>,
    /// Least difference in t of two hits, in steps of 2^-32, before rounding.
    pub t_gap: Option<f64>,
    /// Least distance of t or a weight of a hit from the next integer step, in steps: 0 divides without remainder, at most 0.5.
    pub remainder: Option<f64>,
}

/// The lesser, where there is one.
fn least<T: PartialOrd>(a: Option<T>, b: Option<T>) -> Option<T> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b < a { b } else { a }),
        (a, b) => a.or(b),
    }
}

impl Ties {
    pub(super) fn note_edge(&mut self, value: Option<u128>) {
        match value {
            Some(0) => self.edge_zeros += 1,
            value => self.edge = least(self.edge, value),
        }
    }

    pub(super) fn note_lod(&mut self, value: Option<u128>) {
        self.lod = least(self.lod, value);
    }

    /// Adds what the hits say: gaps between their distances, remainders of their divisions.
    pub(super) fn with_hits(mut self, hits: &[Fractions]) -> Self {
        for (k, a) in hits.iter().enumerate() {
            for (numerator, bits) in [(a.t_num, 32), (a.weights[1], 31), (a.weights[2], 31)] {
                let rest: BigInt = (BigInt::from(numerator) << bits) % a.det;
                let rest = rest.clone().min(a.det - rest);
                self.remainder = least(self.remainder, ratio(&rest, &a.det.into()));
            }
            for b in &hits[..k] {
                let cross: BigInt = BigInt::from(a.t_num) * b.det - BigInt::from(b.t_num) * a.det;
                let cross = BigInt::from(cross.magnitude().clone()) << 32;
                self.t_gap = least(self.t_gap, ratio(&cross, &(BigInt::from(a.det) * b.det)));
            }
        }
        self
    }
}

/// a / b in `f64`, each rounded first.
fn ratio(a: &BigInt, b: &BigInt) -> Option<f64> {
    Some(a.to_f64()? / b.to_f64()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hit(t_num: i128, [v, w]: [i128; 2], det: i128) -> Fractions {
        Fractions { t_num, weights: [det - v - w, v, w], det }
    }

    #[test]
    fn the_closest_of_each_kind_is_kept() {
        let mut ties = Ties::default();
        for value in [None, Some(5), Some(0), Some(3), Some(4), Some(0)] {
            ties.note_edge(value);
            ties.note_lod(value);
        }
        assert_eq!(ties, Ties { edge: Some(3), edge_zeros: 2, lod: Some(0), ..Ties::default() });
    }

    #[test]
    fn remainders_and_gaps_by_hand() {
        let of = |hits: &[Fractions]| Ties::default().with_hits(hits);
        // 2^31 and 2^32 leave 2 and 4 of 7: in sevenths t, v and w come to 1, 2, 2; to 3, 2, 3; to 3, 3, 2.
        let sevenths = [(2, [1, 1], 1.0), (1, [1, 5], 2.0), (1, [5, 1], 2.0)];
        for (t_num, weights, wanted) in sevenths {
            assert_eq!(of(&[hit(t_num, weights, 7)]), Ties { remainder: Some(wanted / 7.0), ..Ties::default() });
        }
        // 2 / 7 and 1 / 3 are 1 / 21 apart, and 1 / 3 and 1 / 5 are 2 / 15.
        let hits = [hit(2, [1, 1], 7), hit(1, [1, 1], 3), hit(1, [1, 1], 5)];
        assert_eq!(of(&hits[..2]).t_gap, Some(4_294_967_296.0 / 21.0));
        assert_eq!(of(&hits[1..]).t_gap, Some(8_589_934_592.0 / 15.0));
        assert_eq!(of(&hits).t_gap, of(&hits[..2]).t_gap);
    }
}
