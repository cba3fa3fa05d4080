//! Seeded gradient noise with its analytic gradient, in two and three dimensions.
//!
//! Only integer hashes, additions, multiplications and square roots: no function whose last bit depends on a platform's library. Values
//! lie in about -0.7..=0.7 with mean 0; noise and gradient are continuous.

/// Adding and subtracting this rounds an `f64` below 2^31 to the nearest integer and leaves that integer in the low bits of the sum.
/// It is branch-free where a saturating cast or a library call to `floor` is not.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// Cell of coordinate `x` and the place in it, 0..=1.
///
/// At a multiple of one it may answer with the cell below and 1 instead of 0; noise is continuous, so either will do.
#[inline(always)]
pub(super) fn cell(x: f64) -> (i32, f64) {
    let sum = (x - 0.5) + ROUND;
    // The low 32 bits of the significand are the integer in two's complement.
    (sum.to_bits() as u32 as i32, x - (sum - ROUND))
}

/// Mixes 32 bits; a bijection, each input bit reaches each output bit.
#[inline(always)]
pub(super) fn mix(mut h: u32) -> u32 {
    h ^= h >> 16;
    h = h.wrapping_mul(0x7FEB_352D);
    h ^= h >> 15;
    h = h.wrapping_mul(0x846C_A68B);
    h ^ (h >> 16)
}

/// Hash of an integer point.
#[inline(always)]
pub(super) fn hash(seed: u32, p: [i32; 3]) -> u32 {
    let [x, y, z] = p.map(|v| v as u32);
    mix(mix(x.wrapping_mul(0x9E37_79B1) ^ seed).wrapping_add(y.wrapping_mul(0x85EB_CA77)) ^ z.wrapping_mul(0xC2B2_AE3D))
}

/// Seed of stream `stream` of a scene: unrelated for any two seeds and streams.
pub(super) fn stream(seed: u64, stream: u32) -> u32 {
    mix(mix(mix(seed as u32) ^ (seed >> 32) as u32).wrapping_add(stream.wrapping_mul(0x9E37_79B1)))
}

/// A number in 0..1 from a hash.
#[inline(always)]
pub(super) fn unit(h: u32) -> f64 {
    f64::from(h) * (1.0 / 4_294_967_296.0)
}

/// 6t^5 - 15t^4 + 10t^3 and its derivative: noise gets a continuous second derivative.
#[inline(always)]
fn fade(t: f64) -> (f64, f64) {
    let tt = t * t;
    (tt * t * (t * (t * 6.0 - 15.0) + 10.0), 30.0 * tt * (t * (t - 2.0) + 1.0))
}

/// One cell of two-dimensional noise: n = l0 + u l1 + v l2 + uv l3 with u, v the faded place in the cell and l linear in the place
/// (coefficients of x, of y, and constant). Neighbouring points often share a cell, and the hashes are what costs.
#[derive(Clone, Copy, Default)]
pub(super) struct Cell2 {
    l: [[f64; 3]; 4],
}

impl Cell2 {
    #[inline(always)]
    fn gradient(seed: u32, x: i32, y: i32) -> [f64; 2] {
        let h = mix((x as u32).wrapping_mul(0x9E37_79B1) ^ (y as u32).wrapping_mul(0x85EB_CA77).wrapping_add(seed));
        // Two signed 16-bit numbers, in -1..1 each.
        [f64::from(h as i16) * (1.0 / 32_768.0), f64::from((h >> 16) as i16) * (1.0 / 32_768.0)]
    }

    /// The cell with least corner (x, y).
    #[inline(always)]
    pub(super) fn new(seed: u32, x: i32, y: i32) -> Self {
        let (x1, y1) = (x.wrapping_add(1), y.wrapping_add(1));
        let [a, b, c, d] = [(x, y), (x1, y), (x, y1), (x1, y1)].map(|(x, y)| Self::gradient(seed, x, y));
        let (b0, c0, d0) = (-b[0], -c[1], -d[0] - d[1]);
        Self {
            l: [
                [a[0], a[1], 0.0],
                [b[0] - a[0], b[1] - a[1], b0],
                [c[0] - a[0], c[1] - a[1], c0],
                [a[0] - b[0] - c[0] + d[0], a[1] - b[1] - c[1] + d[1], d0 - b0 - c0],
            ],
        }
    }

    /// Value at place (x, y), 0..=1 each.
    #[inline(always)]
    pub(super) fn value(&self, x: f64, y: f64) -> f64 {
        let [l0, l1, l2, l3] = self.l.map(|l| l[0] * x + l[1] * y + l[2]);
        let (u, v) = (fade(x).0, fade(y).0);
        l0 + u * l1 + v * (l2 + u * l3)
    }

    /// Value and derivatives along x and y at place (x, y), 0..=1 each.
    #[inline(always)]
    pub(super) fn value_gradient(&self, x: f64, y: f64) -> [f64; 3] {
        let [l0, l1, l2, l3] = self.l.map(|l| l[0] * x + l[1] * y + l[2]);
        let ((u, du), (v, dv)) = (fade(x), fade(y));
        let uv = u * v;
        let [l, m, n, o] = &self.l;
        [
            l0 + u * l1 + v * (l2 + u * l3),
            l[0] + u * m[0] + v * n[0] + uv * o[0] + du * (l1 + v * l3),
            l[1] + u * m[1] + v * n[1] + uv * o[1] + dv * (l2 + u * l3),
        ]
    }
}

/// Two-dimensional noise with unit cells.
pub(super) fn noise2(seed: u32, p: [f64; 2]) -> f64 {
    let [(i, x), (j, y)] = p.map(cell);
    Cell2::new(seed, i, j).value(x, y)
}

/// Three-dimensional noise with unit cells: value and gradient.
pub(super) fn noise3(seed: u32, p: [f64; 3]) -> (f64, [f64; 3]) {
    let [(i, x), (j, y), (k, z)] = p.map(cell);
    let [(u, du), (v, dv), (w, dw)] = [x, y, z].map(fade);
    let (mut value, mut gradient) = (0.0, [0.0; 3]);
    for corner in 0..8 {
        let [cx, cy, cz] = [corner & 1, (corner >> 1) & 1, corner >> 2];
        let h = hash(seed, [i.wrapping_add(cx), j.wrapping_add(cy), k.wrapping_add(cz)]);
        // Three signed 10-bit numbers, in -1..1 each.
        let g = [0, 10, 20].map(|s| f64::from(((h >> s) & 1023) as i32 - 512) * (1.0 / 512.0));
        let dot = g[0] * (x - f64::from(cx)) + g[1] * (y - f64::from(cy)) + g[2] * (z - f64::from(cz));
        let side = |c: i32, t: f64, dt: f64| if c == 0 { (1.0 - t, -dt) } else { (t, dt) };
        let ((a, da), (b, db), (c, dc)) = (side(cx, u, du), side(cy, v, dv), side(cz, w, dw));
        value += a * b * c * dot;
        gradient[0] += a * b * c * g[0] + da * b * c * dot;
        gradient[1] += a * b * c * g[1] + a * db * c * dot;
        gradient[2] += a * b * c * g[2] + a * b * dc * dot;
    }
    (value, gradient)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_hold_their_coordinates() {
        for x in [-7.25, -1.0, -0.5, 0.0, 0.25, 0.999, 1.0, 1.5, 2.0, 1e6 + 0.125] {
            let (i, f) = cell(x);
            assert!((0.0..=1.0).contains(&f), "{x}: {f}");
            assert_eq!(f64::from(i) + f, x);
        }
    }

    #[test]
    fn gradients_are_the_derivatives_and_cells_meet() {
        let e = 1e-5;
        for n in 0..200 {
            let p = [0, 1, 2].map(|k| unit(hash(5, [n, k, 0])) * 9.0 - 4.0);
            let (value, gradient) = noise3(3, p);
            assert!(value.abs() < 1.5);
            for k in 0..3 {
                let (mut a, mut b) = (p, p);
                a[k] += e;
                b[k] -= e;
                let slope = (noise3(3, a).0 - noise3(3, b).0) / (2.0 * e);
                assert!((slope - gradient[k]).abs() < 1e-4, "{slope} {}", gradient[k]);
            }
            let at = |x: f64, y: f64| noise2(8, [x, y]);
            let ((i, x), (j, y)) = (cell(p[0]), cell(p[1]));
            let [v, dx, dy] = Cell2::new(8, i, j).value_gradient(x, y);
            assert_eq!(v, at(p[0], p[1]));
            assert!((dx - (at(p[0] + e, p[1]) - at(p[0] - e, p[1])) / (2.0 * e)).abs() < 1e-4);
            assert!((dy - (at(p[0], p[1] + e) - at(p[0], p[1] - e)) / (2.0 * e)).abs() < 1e-4);
            // Both sides of a cell border.
            assert!((Cell2::new(8, i, j).value(1.0, y) - Cell2::new(8, i + 1, j).value(0.0, y)).abs() < 1e-12);
        }
    }
}
