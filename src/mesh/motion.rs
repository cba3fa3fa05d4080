//! Motions for trying things out: where vertices are at a time, from where they rest. Each comes back after a time of 1.

use rayon::prelude::*;
use std::f64::consts::TAU;

/// A motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Two waves run along the longest side of the box, along its shortest: a twentieth of its diagonal high.
    Wave,
    /// The ends of the longest side turn around it, an eighth of a turn to either side.
    Twist,
    /// All grows and shrinks around the middle of the box by a tenth.
    Breathe,
}

impl Motion {
    /// All.
    pub const ALL: [Self; 3] = [Self::Wave, Self::Twist, Self::Breathe];

    /// Its name in options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Wave => "wave",
            Self::Twist => "twist",
            Self::Breathe => "breathe",
        }
    }

    /// Where vertices are that rest at these positions, of which there is at least one.
    pub fn at(self, rest: &[[f64; 3]], time: f64) -> Vec<[f64; 3]> {
        let lo = rest.iter().fold([f64::INFINITY; 3], |lo, p| std::array::from_fn(|k| lo[k].min(p[k])));
        let hi = rest.iter().fold([f64::NEG_INFINITY; 3], |hi, p| std::array::from_fn(|k| hi[k].max(p[k])));
        let size: [f64; 3] = std::array::from_fn(|k| hi[k] - lo[k]);
        // Of equal sides the first.
        let long = (1..3).fold(0, |best, k| if size[k] > size[best] { k } else { best });
        let short = (0..3).rev().fold((long + 1) % 3, |best, k| if k != long && size[k] <= size[best] { k } else { best });
        let third = 3 - long - short;
        let diagonal = size.iter().map(|s| s * s).sum::<f64>().sqrt();
        let middle: [f64; 3] = std::array::from_fn(|k| lo[k] + size[k] / 2.0);
        let along = |p: [f64; 3]| if size[long] > 0.0 { (p[long] - lo[long]) / size[long] } else { 0.0 };
        let place = |&p: &[f64; 3]| {
            let mut q = p;
            match self {
                Self::Wave => q[short] += 0.05 * diagonal * (TAU * (2.0 * along(p) + time)).sin(),
                Self::Twist => {
                    let (s, c) = (0.25 * TAU * (along(p) - 0.5) * (TAU * time).sin()).sin_cos();
                    let (u, v) = (p[short] - middle[short], p[third] - middle[third]);
                    (q[short], q[third]) = (middle[short] + c * u - s * v, middle[third] + s * u + c * v);
                }
                Self::Breathe => {
                    let scale = 1.0 + 0.1 * (TAU * time).sin();
                    q = std::array::from_fn(|k| middle[k] + scale * (p[k] - middle[k]));
                }
            }
            q
        };
        rest.par_iter().map(place).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REST: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [4.0, 1.0, 0.0], [4.0, 0.0, 2.0], [1.0, 1.0, 2.0]];

    fn far(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
        a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn each_comes_back_and_moves_meanwhile() {
        for motion in Motion::ALL {
            let [start, between, end] = [0.0, 0.2, 1.0].map(|time| motion.at(&REST, time));
            assert!(far(&start, &end) < 1e-12 && far(&start, &between) > 0.01, "{motion:?}");
        }
        assert!(far(&Motion::Twist.at(&REST, 0.0), &REST) < 1e-12 && far(&Motion::Breathe.at(&REST, 0.0), &REST) < 1e-12);
    }

    #[test]
    fn by_hand() {
        // The shortest side is y, the longest x.
        let wave = Motion::Wave.at(&REST, 0.25);
        assert!((wave[0][1] - 0.05 * 21f64.sqrt()).abs() < 1e-12 && wave[0][0] == 0.0 && wave[0][2] == 0.0);
        // At the far end an eighth of a turn; lengths across stay.
        let twist = Motion::Twist.at(&REST, 0.25);
        let across = |p: [f64; 3]| (p[1] - 0.5).hypot(p[2] - 1.0);
        assert!(REST.iter().zip(&twist).all(|(p, q)| (across(*p) - across(*q)).abs() < 1e-12 && p[0] == q[0]));
        assert!(far(&Motion::Breathe.at(&REST, 0.25)[..1], &[[-0.2, -0.05, -0.1]]) < 1e-12);
        // A point stays a point.
        assert!(Motion::ALL.iter().all(|motion| motion.at(&[[1.0; 3]], 0.3) == [[1.0; 3]]));
    }
}
