//! Tests of rays in `f32`, as papers have them: for what a traversal takes of a processor's time alone. Hits are nobody's truth; nothing here is exact.

use crate::num::Ray;

/// A ray in units, its direction of length 1.
#[derive(Clone, Copy, Debug)]
pub struct FloatRay {
    /// Where it starts.
    pub origin: [f32; 3],
    /// Its direction.
    pub direction: [f32; 3],
    inverse: [f32; 3],
}

/// Dot product.
#[inline(always)]
pub fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// a - b.
#[inline(always)]
pub fn less(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

impl FloatRay {
    /// The nearest to an integer ray.
    pub fn new(ray: &Ray) -> Self {
        let (origin, d) = (ray.origin.get().map(|c| c as f32), ray.direction.get().map(|c| c as f64));
        let length = d.iter().map(|c| c * c).sum::<f64>().sqrt();
        let direction = d.map(|c| (c / length) as f32);
        Self { origin, direction, inverse: direction.map(f32::recip) }
    }

    /// Distance to a triangle, if it is met nearer than `most`: Möller and Trumbore (1997), both faces.
    #[inline(always)]
    pub fn triangle(&self, [a, b, c]: [[f32; 3]; 3], most: f32) -> Option<f32> {
        let (e, f) = (less(b, a), less(c, a));
        let p = cross(self.direction, f);
        let det = dot(e, p);
        if det == 0.0 {
            return None;
        }
        let (inverse, s) = (det.recip(), less(self.origin, a));
        let u = dot(s, p) * inverse;
        if !(0.0..=1.0).contains(&u) {
            return None;
        }
        let q = cross(s, e);
        let v = dot(self.direction, q) * inverse;
        if v < 0.0 || u + v > 1.0 {
            return None;
        }
        let t = dot(f, q) * inverse;
        (t > 0.0 && t < most).then_some(t)
    }

    /// Distance to a box, 0 from inside, if it is entered nearer than `most`.
    #[inline(always)]
    pub fn slabs(&self, lo: [f32; 3], hi: [f32; 3], most: f32) -> Option<f32> {
        let (mut near, mut far) = (0.0f32, most);
        for k in 0..3 {
            let (a, b) = ((lo[k] - self.origin[k]) * self.inverse[k], (hi[k] - self.origin[k]) * self.inverse[k]);
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        (near <= far).then_some(near)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::{Cone, Direction, Point};

    #[test]
    fn triangles_and_boxes_are_met_where_they_are() {
        let ray = Ray { origin: Point::new(16, 16, 1 << 20), direction: Direction::new(0, 0, -(1 << 29)), cone: Cone::default() };
        let ray = FloatRay::new(&ray);
        let triangle = [[0.0, 0.0, 0.0], [64.0, 0.0, 0.0], [0.0, 64.0, 0.0]];
        assert_eq!(ray.triangle(triangle, f32::MAX), Some(1_048_576.0));
        assert_eq!(ray.triangle([triangle[0], triangle[2], triangle[1]], f32::MAX), Some(1_048_576.0));
        assert_eq!(ray.triangle(triangle, 100.0), None);
        assert_eq!(ray.triangle(triangle.map(|[x, y, z]| [x + 32.0, y, z]), f32::MAX), None);
        assert_eq!(ray.slabs([0.0; 3], [64.0; 3], f32::MAX), Some(1_048_512.0));
        assert_eq!(ray.slabs([20.0, 0.0, 0.0], [64.0; 3], f32::MAX), None);
        assert_eq!(ray.slabs([0.0; 3], [64.0, 64.0, 2e6], f32::MAX), Some(0.0));
    }
}
