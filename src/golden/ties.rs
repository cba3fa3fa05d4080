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
