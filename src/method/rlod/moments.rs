//! Where triangles lie on average and how they spread, as sums that a node has from its children (paper section 4.4), and the plane that is fitted to them.
//!
//! The paper adds up V_i, V_i V_j and n. The same sums are kept around their mean here, so that a small node far from the origin loses nothing (Chan, Golub and LeVeque 1979). Two words of the
//! paper cannot be meant: the covariance has 1/n where its equation 3 has 1/n^2, and the normal is the eigenvector of the smallest eigenvalue, not the largest.

use super::clip::Polygon;
use glam::DVec3;

/// Sums over the corners of triangles, each weighted by its triangle's area.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// Sum of weights.
    pub weight: f64,
    /// Mean place, in units.
    pub mean: DVec3,
    /// Sums of products of coordinates around the mean: xx, xy, xz, yy, yz, zz.
    pub spread: [f64; 6],
    /// Sum of areas times normals.
    pub normal: DVec3,
    /// Sum of colours, each weighted by its triangle's area.
    pub colour: DVec3,
    /// Box of all corners; empty before there are any.
    pub bounds: Option<[DVec3; 2]>,
}

/// A plane through the mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Its normal, of length 1, on the side of the mean normal.
    pub normal: DVec3,
    /// How far triangles lie from it: the root of the mean of squares, in units.
    pub deviation: f64,
}

/// Products of coordinates in the order of [`Moments::spread`].
fn products(v: DVec3) -> [f64; 6] {
    [v.x * v.x, v.x * v.y, v.x * v.z, v.y * v.y, v.y * v.z, v.z * v.z]
}

impl Moments {
    /// What is left of a triangle of this colour.
    pub fn of(polygon: &Polygon, colour: DVec3) -> Self {
        let normal = DVec3::from_array(polygon.area());
        let area = normal.length();
        let count = polygon.corners().count();
        if area == 0.0 {
            return Self::default();
        }
        let corners = || polygon.corners().map(DVec3::from_array);
        let mean = corners().sum::<DVec3>() / count as f64;
        let mut spread = [0.0; 6];
        for corner in corners() {
            for (sum, product) in spread.iter_mut().zip(products(corner - mean)) {
                *sum += product * area / count as f64;
            }
        }
        let bounds = corners().fold([mean; 2], |[lo, hi], p| [lo.min(p), hi.max(p)]);
        Self { weight: area, mean, spread, normal, colour: colour * area, bounds: Some(bounds) }
    }

    /// Both together.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        if self.weight == 0.0 || other.weight == 0.0 {
            return if self.weight == 0.0 { *other } else { *self };
        }
        let weight = self.weight + other.weight;
        let apart = other.mean - self.mean;
        let between = products(apart).map(|product| product * self.weight * other.weight / weight);
        let both = |[a, b]: [DVec3; 2], [c, d]: [DVec3; 2]| [a.min(c), b.max(d)];
        Self {
            weight,
            mean: self.mean + apart * (other.weight / weight),
            spread: std::array::from_fn(|k| self.spread[k] + other.spread[k] + between[k]),
            normal: self.normal + other.normal,
            colour: self.colour + other.colour,
            bounds: self.bounds.zip(other.bounds).map(|(a, b)| both(a, b)).or(self.bounds).or(other.bounds),
        }
    }

    /// The plane that is nearest to all; none if there is no area.
    pub fn plane(&self) -> Option<Plane> {
        if self.weight == 0.0 {
            return None;
        }
        let (values, vectors) = eigen(self.spread.map(|sum| sum / self.weight));
        let least = (0..3).min_by(|&a, &b| values[a].total_cmp(&values[b]))?;
        let normal = vectors[least];
        let normal = if normal.dot(self.normal) < 0.0 { -normal } else { normal };
        Some(Plane { normal, deviation: values[least].max(0.0).sqrt() })
    }
}

/// Eigenvalues and eigenvectors of length 1 of a symmetric matrix, its entries in the order of [`Moments::spread`]: Jacobi's rotations, until nothing is left beside the diagonal.
fn eigen([xx, xy, xz, yy, yz, zz]: [f64; 6]) -> ([f64; 3], [DVec3; 3]) {
    let mut m = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let mut vectors = [DVec3::X, DVec3::Y, DVec3::Z];
    // Each sweep squares what is left: six are more than enough for double precision.
    for _ in 0..12 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if m[p][q] == 0.0 {
                continue;
            }
            let theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
            let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
            if !t.is_finite() {
                continue;
            }
            let c = 1.0 / t.hypot(1.0);
            let s = t * c;
            let r = 3 - p - q;
            let (pq, rp, rq) = (m[p][q], m[r][p], m[r][q]);
            m[p][p] -= t * pq;
            m[q][q] += t * pq;
            (m[p][q], m[q][p]) = (0.0, 0.0);
            (m[r][p], m[r][q]) = (c * rp - s * rq, s * rp + c * rq);
            (m[p][r], m[q][r]) = (m[r][p], m[r][q]);
            (vectors[p], vectors[q]) = (vectors[p] * c - vectors[q] * s, vectors[p] * s + vectors[q] * c);
        }
    }
    ([m[0][0], m[1][1], m[2][2]], vectors)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::Box32;
    use crate::num::Random;
    use nalgebra::{Matrix3, SymmetricEigen};

    const EVERYWHERE: Box32 = Box32 { lo: [-i32::MAX; 3], hi: [i32::MAX; 3] };

    fn triangles(random: &mut Random, far: i32, size: u64, flat: u64) -> Vec<[[i32; 3]; 3]> {
        let mut corner = || {
            let mut below = |side: u64| (random.next() % side) as i32;
            [far + below(size), below(size), far / 3 + below(flat)]
        };
        (0..40).map(|_| [corner(), corner(), corner()]).collect()
    }

    fn sum(of: &[[[i32; 3]; 3]]) -> Moments {
        let each = of.iter().map(|triangle| Moments::of(&Polygon::within(triangle, &EVERYWHERE), DVec3::ONE));
        each.fold(Moments::default(), |sum, own| sum.with(&own))
    }

    /// The same from the corners, all at once.
    fn covariance(of: &[[[i32; 3]; 3]]) -> Matrix3<f64> {
        let area = |t: &[[i32; 3]; 3]| {
            let [a, b, c] = t.map(|p| DVec3::from_array(p.map(f64::from)));
            (b - a).cross(c - a).length() / 2.0
        };
        let all = || of.iter().flat_map(|t| t.map(|p| (DVec3::from_array(p.map(f64::from)), area(t) / 3.0)));
        let weight: f64 = all().map(|(_, w)| w).sum();
        let mean = all().map(|(p, w)| p * w).sum::<DVec3>() / weight;
        let mut m = Matrix3::zeros();
        for (p, w) in all() {
            let d = (p - mean).to_array();
            for i in 0..3 {
                for j in 0..3 {
                    m[(i, j)] += w * d[i] * d[j] / weight;
                }
            }
        }
        m
    }

    #[test]
    fn planes_are_those_of_an_eigen_solver() {
        let mut random = Random::new(3);
        for (far, size, flat) in [(0, 1000, 1000), (0, 1 << 20, 50), (1 << 30, 4000, 300), (-(1 << 30), 1 << 24, 1 << 10), (77, 64, 1)] {
            for _ in 0..50 {
                let of = triangles(&mut random, far, size, flat);
                let plane = sum(&of).plane().unwrap();
                let solved = SymmetricEigen::new(covariance(&of));
                let least = solved.eigenvalues.imin();
                let normal = DVec3::from_slice(solved.eigenvectors.column(least).as_slice());
                let scale = solved.eigenvalues.max();
                assert!((plane.normal.length() - 1.0).abs() < 1e-12);
                assert!((plane.deviation.powi(2) - solved.eigenvalues[least].max(0.0)).abs() < 1e-9 * scale);
                // Two that are almost alike leave it open which of them it is.
                let mut values = solved.eigenvalues.as_slice().to_vec();
                values.sort_by(f64::total_cmp);
                if values[1] - values[0] > 1e-3 * scale {
                    assert!(plane.normal.dot(normal).abs() > 1.0 - 1e-9, "{plane:?} {normal:?}");
                }
            }
        }
    }

    #[test]
    fn sums_of_children_are_those_of_all() {
        let mut random = Random::new(5);
        let of = triangles(&mut random, 1 << 29, 5000, 700);
        let (whole, parts) = (sum(&of), sum(&of[..13]).with(&sum(&of[13..])));
        assert!((whole.mean - parts.mean).length() < 1e-6);
        assert!((0..6).all(|k| (whole.spread[k] - parts.spread[k]).abs() < 1e-9 * whole.spread[0]));
        assert_eq!(Moments::default().with(&whole), whole);
        assert!(Moments::default().plane().is_none());
        // Normals decide the side, and flat triangles have no deviation.
        let flat = [[[0, 0, 7], [64, 0, 7], [0, 64, 7]], [[64, 0, 7], [64, 64, 7], [0, 64, 7]]];
        let plane = sum(&flat).plane().unwrap();
        assert!((plane.normal - DVec3::Z).length() < 1e-12 && plane.deviation < 1e-9);
        let turned = flat.map(|[a, b, c]| [a, c, b]);
        assert!((sum(&turned).plane().unwrap().normal + DVec3::Z).length() < 1e-12);
    }
}
