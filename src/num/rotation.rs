//! Frames that a node's boxes can lie in: a small fixed set of rotations, as matrices of small whole numbers.
//!
//! Row i of a matrix M gives axis i of the frame, in steps of 2^-7. The numbers of a row add up to 2^7 at most, signs aside. So a turned vector needs no more bits
//! than the vector itself. Rows differ in length, and are not quite at right angles. Neither matters: M (x + s d) = M x + s M d for any M, so a ray reaches a point at the
//! same s in each frame, and the entry distances of boxes stay comparable.
//!
//! A ray is rounded when it is turned, so boxes are let out by [`LET_OUT`] units: see [`Rotation::ray`].

use super::{Direction, Point};

/// Bits of a rotation's number in a node.
pub const ROTATION_BITS: u32 = 7;

/// A component of 1.
const ONE: i64 = 1 << SHIFT;
const SHIFT: u32 = 7;

/// Units by which turned boxes are let out along each axis.
///
/// Let a ray be at x + s d. Within the model's range s is below 7.1, as |d| is at least 0.99 * 2^30 and distances are below 2^32.8 units; 8 is taken here. The turned ray
/// is off by three roundings. M X rounded down: by less than 1, X being the whole point of x. What x is more than X: by less than 1, as it is less along each axis and the numbers of
/// a row add up to 1 at most. M d rounded to nearest: by 1/2 at most, and s makes less than 4 of it. In all it is less than 6 units off, along each axis and at each s. So what the
/// exact ray meets in a box, the turned one meets at the same s in the box let out.
pub const LET_OUT: i32 = 8;

/// A frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rotation {
    /// Its axes, in steps of 2^-7.
    rows: [[i64; 3]; 3],
}

/// Half the number of steps along an axis of the grid of rotations.
const REACH: i64 = 2;
/// Steps from the middle to where a component of a Rodrigues vector is 1.
const WHOLE: i64 = 6;
/// How many frames there are.
pub const ROTATIONS: usize = {
    let side = 2 * REACH as usize + 1;
    side * side * side
};

/// All frames by number. Number 0 is the identity.
///
/// Boxes look the same when axes are exchanged or turned around. So a frame is one of the turns that no exchange makes smaller. Their Rodrigues vectors (the axis times
/// the tangent of half the angle) lie in a cube of half width tan(22.5 degrees) = 0.414. The set is a grid of 5 x 5 x 5 in it, in steps of 1/6.
/// (Opposite corners of the grid give one frame with its axes exchanged. The other 117 are all different.)
static ALL: [Rotation; ROTATIONS] = {
    let mut all = [Rotation { rows: [[ONE, 0, 0], [0, ONE, 0], [0, 0, ONE]] }; ROTATIONS];
    let mut next = 1;
    let mut at = 0;
    let side = 2 * REACH + 1;
    while at < side * side * side {
        let v = [at % side - REACH, at / side % side - REACH, at / (side * side) - REACH];
        if v[0] != 0 || v[1] != 0 || v[2] != 0 {
            all[next] = Rotation::of(v, WHOLE);
            next += 1;
        }
        at += 1;
    }
    all
};

/// `a / b` to the nearest whole number, halves away from zero.
const fn nearest(a: i64, b: i64) -> i64 {
    let magnitude = (2 * a.abs() + b) / (2 * b);
    if a < 0 { -magnitude } else { magnitude }
}

impl Rotation {
    /// The frame of Rodrigues vector `v / whole`.
    const fn of(v: [i64; 3], whole: i64) -> Self {
        let square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        let same = whole * whole - square;
        let [x, y, z] = v;
        // (1 - v^2) I + 2 v v^T + 2 [v]x, times a number that does not matter: rows get a length of their own.
        let exact = [
            [same + 2 * x * x, 2 * (x * y - whole * z), 2 * (x * z + whole * y)],
            [2 * (y * x + whole * z), same + 2 * y * y, 2 * (y * z - whole * x)],
            [2 * (z * x - whole * y), 2 * (z * y + whole * x), same + 2 * z * z],
        ];
        let mut rows = [[0; 3]; 3];
        let mut row = 0;
        while row < 3 {
            let sum = exact[row][0].abs() + exact[row][1].abs() + exact[row][2].abs();
            let mut column = 0;
            while column < 3 {
                rows[row][column] = nearest(exact[row][column] * (ONE - 1), sum);
                column += 1;
            }
            row += 1;
        }
        Self { rows }
    }

    /// The frame of this number, below [`ROTATIONS`].
    #[inline(always)]
    pub fn numbered(number: u32) -> &'static Self {
        &ALL[number as usize]
    }

    /// What a vector's components are in the frame, in steps of 2^-7.
    #[inline(always)]
    fn turned(&self, v: [i64; 3]) -> [i64; 3] {
        self.rows.map(|[x, y, z]| x * v[0] + y * v[1] + z * v[2])
    }

    /// The least and the most whole coordinates of a point in the frame: rounded down and up. No further from 0 than the point's.
    #[inline(always)]
    pub fn around(&self, point: [i32; 3]) -> [[i32; 3]; 2] {
        let turned = self.turned(point.map(i64::from));
        [turned.map(|c| (c >> SHIFT) as i32), turned.map(|c| ((c + ONE - 1) >> SHIFT) as i32)]
    }

    /// A ray in the frame: its origin rounded down, its direction to nearest, halves up. Both keep to their bits.
    #[inline(always)]
    pub fn ray(&self, origin: Point, direction: Direction) -> (Point, Direction) {
        let [x, y, z] = self.turned(origin.get()).map(|c| c >> SHIFT);
        let [dx, dy, dz] = self.turned(direction.get()).map(|c| (c + ONE / 2) >> SHIFT);
        (Point::new(x, y, z), Direction::new(dx, dy, dz))
    }

    /// What a distance of 1 along each axis is in units of the frame: 0.57 to 1.
    pub fn lengths(&self) -> [f64; 3] {
        self.rows.map(|row| (row.iter().map(|c| c * c).sum::<i64>() as f64).sqrt() / ONE as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::Block;
    use crate::block::box_test::{self, BoxTest};
    use crate::block::ray_setup::{self, RaySetup};
    use crate::num::{Box16, COORD_LIMIT, Random, RayT, box_code_ceil, box_code_floor};

    fn all() -> impl Iterator<Item = &'static Rotation> {
        (0..ROTATIONS as u32).map(Rotation::numbered)
    }

    #[test]
    fn frames_are_nearly_orthogonal_and_all_different() {
        const { assert!(ROTATIONS <= 1 << ROTATION_BITS) };
        assert_eq!(ALL[0].lengths(), [1.0; 3]);
        for (k, one) in all().enumerate() {
            assert!(all().skip(k + 1).all(|other| other != one), "{k}");
            let lengths = one.lengths();
            for (i, row) in one.rows.iter().enumerate() {
                assert!(row.iter().map(|c| c.abs()).sum::<i64>() <= ONE, "{k}: {row:?}");
                // Eight bits with the sign, but for the frame that turns nothing.
                assert!(k == 0 || row.iter().all(|c| c.abs() < ONE), "{k}: {row:?}");
                assert!((0.57..=1.0).contains(&lengths[i]), "{k}: {lengths:?}");
                let j = (i + 1) % 3;
                let dot: i64 = row.iter().zip(&one.rows[j]).map(|(a, b)| a * b).sum();
                let cosine = dot as f64 / (ONE * ONE) as f64 / (lengths[i] * lengths[j]);
                assert!(cosine.abs() < 0.02, "{k}: {cosine}");
            }
        }
    }

    #[test]
    fn every_normal_has_an_axis_near() {
        let axes: Vec<[f64; 3]> = all().flat_map(|frame| frame.rows).map(|row| unit(row.map(|c| c as f64))).collect();
        let mut random = Random::of(1, 1);
        for _ in 0..5_000 {
            let normal = unit([(); 3].map(|()| random.within(1 << 20) as f64 + 0.5));
            let nearest = axes.iter().map(|axis| (0..3).map(|c| axis[c] * normal[c]).sum::<f64>().abs()).fold(0.0, f64::max);
            assert!(nearest > 11f64.to_radians().cos(), "{normal:?}: {} degrees", nearest.acos().to_degrees());
        }
    }

    fn unit(v: [f64; 3]) -> [f64; 3] {
        let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
        v.map(|c| c / length)
    }

    /// Of vectors at the edge of what is legal too.
    fn vector(random: &mut Random, most: u64) -> [i64; 3] {
        [(); 3].map(|()| match random.below(4) {
            0 => most.cast_signed() * (1 - 2 * random.below(2).cast_signed()),
            _ => random.within(most) >> random.below(20),
        })
    }

    /// With the exact numbers: where a turned ray should be at s = t / 2^32, from a start with a fraction, and where it is.
    #[test]
    fn turned_rays_keep_to_their_bits_and_are_less_than_six_units_off() {
        let mut most = 0;
        for number in 0..200_000 {
            let mut random = Random::of(7, number);
            let frame = Rotation::numbered(random.below(ROTATIONS as u64) as u32);
            let (origin, direction) = (vector(&mut random, (1 << 31) - 1), vector(&mut random, (1 << 30) - 1));
            let fraction = [(); 3].map(|()| i128::from(random.below(1 << 31)));
            let t = i128::from(random.below(1 << 35));
            let [x, y, z] = origin;
            let [dx, dy, dz] = direction;
            let (o, d) = frame.ray(Point::new(x, y, z), Direction::new(dx, dy, dz));
            assert!(o.get().iter().all(|c| c.abs() < 1 << 31) && d.get().iter().all(|c| c.abs() < 1 << 30));
            for axis in 0..3 {
                // In steps of 2^-39 units.
                let row = frame.rows[axis].map(i128::from);
                let of = |c: usize| (i128::from(origin[c]) << 32) + (fraction[c] << 1) + i128::from(direction[c]) * t;
                let wanted: i128 = (0..3).map(|c| row[c] * of(c)).sum();
                let found = ((i128::from(o.get()[axis]) << 32) + i128::from(d.get()[axis]) * t) << SHIFT;
                most = most.max((wanted - found).abs());
            }
        }
        assert!((3 << 39..6 << 39).contains(&most), "{}", most >> 39);
    }

    /// A ray through a point meets every box around that point, no later than there.
    #[test]
    fn no_box_around_a_point_is_missed_by_a_turned_ray_to_it() {
        for number in 0..200_000 {
            let mut random = Random::of(8, number);
            let frame = Rotation::numbered(1 + random.below(ROTATIONS as u64 - 1) as u32);
            // Whole points that a ray goes through: x + 2^-k d for d with k zero bits.
            let zeros = random.below(29);
            let direction = vector(&mut random, ((1 << 30) - 1) >> zeros).map(|c| c << zeros);
            let origin = vector(&mut random, COORD_LIMIT as u64);
            let point: [i64; 3] = std::array::from_fn(|c| origin[c] + (direction[c] >> zeros));
            if direction == [0; 3] || point.iter().any(|c| c.abs() > i64::from(COORD_LIMIT)) {
                continue;
            }
            let [x, y, z] = origin;
            let [dx, dy, dz] = direction;
            let (o, d) = frame.ray(Point::new(x, y, z), Direction::new(dx, dy, dz));
            let [lo, hi] = frame.around(point.map(|c| c as i32));
            let bounds = Box16::from_codes(lo.map(|c| box_code_floor(c - LET_OUT)), hi.map(|c| box_code_ceil(c + LET_OUT)));
            let ray = RaySetup::eval(&ray_setup::In { origin: o, direction: d });
            let t = RayT::new(1 << (32 - zeros));
            let test = BoxTest::eval(&box_test::In { ray, t_max: t, bounds });
            assert!(test.hit, "{number}: {frame:?}");
        }
    }
}
