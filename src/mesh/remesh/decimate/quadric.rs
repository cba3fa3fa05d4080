//! Quadric errors (Garland and Heckbert, Surface Simplification Using Quadric Error Metrics, 1997), and costs in order.

use super::super::super::distance::Vec3;

/// Sum of squared distances from planes, weighed by area: x'Ax + 2b'x + c.
#[derive(Clone, Copy, Default)]
pub(super) struct Quadric {
    a: [f64; 6],
    b: Vec3,
    c: f64,
}

impl Quadric {
    /// The plane through `p` with the unit normal `n`.
    pub fn plane(p: Vec3, n: Vec3, weight: f64) -> Quadric {
        let d = -n.dot(p);
        let a = [n.x * n.x, n.x * n.y, n.x * n.z, n.y * n.y, n.y * n.z, n.z * n.z].map(|v| v * weight);
        Quadric { a, b: n * (d * weight), c: d * d * weight }
    }

    pub fn add(&mut self, other: &Quadric) {
        self.a.iter_mut().zip(other.a).for_each(|(a, b)| *a += b);
        self.b += other.b;
        self.c += other.c;
    }

    pub fn at(&self, p: Vec3) -> f64 {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        let linear = Vec3::new(xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z, xz * p.x + yz * p.y + zz * p.z);
        (linear.dot(p) + 2.0 * self.b.dot(p) + self.c).max(0.0)
    }
}

/// Costs in order; none is NaN.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Cost(pub f64);

impl Eq for Cost {}

impl PartialOrd for Cost {
    fn partial_cmp(&self, other: &Cost) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Cost {
    fn cmp(&self, other: &Cost) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}
