//! Filters along rows and columns: weights of a pixel and its neighbours, and sums by them.

use std::ops::{Add, AddAssign, Mul, Sub};

/// `f32` for speed, `f64` where differences of large values matter.
pub(super) trait Number: Copy + Add<Output = Self> + AddAssign + Sub<Output = Self> + Mul<Output = Self> + 'static {
    fn rounded(value: f64) -> Self;
}

impl Number for f32 {
    fn rounded(value: f64) -> Self {
        value as Self
    }
}

impl Number for f64 {
    fn rounded(value: f64) -> Self {
        value
    }
}

/// What weights are multiplied with.
#[derive(Clone, Copy)]
enum Form {
    /// The pixel, and sums of a neighbour ahead and the one behind.
    Average,
    /// Differences of the two.
    Slope,
    /// Their differences from the pixel, added: nothing is left of a flat row, whatever the roundings.
    Bend,
}

/// Weights of a pixel, and of its neighbours on one side; those on the other are the same, or their negatives.
#[derive(Clone)]
pub(super) struct Kernel<T> {
    form: Form,
    /// Of the pixel; 0 unless it is an average.
    middle: T,
    /// From the nearest to the farthest, ahead: to the right, or below.
    ahead: Vec<T>,
}

impl<T: Number> Kernel<T> {
    /// A Gaussian of sum 1 times `share`, its deviation in pixels.
    pub(super) fn bell(radius: usize, deviation: f64, share: f64) -> Self {
        let scale = share / bell_sum(radius, deviation);
        let ahead = neighbours(radius, |x| scale * gauss(x / deviation));
        Self { form: Form::Average, middle: T::rounded(scale), ahead: rounded(&ahead, 1.0) }
    }

    /// Its first derivative: weights ahead of sum 1, behind of sum -1.
    pub(super) fn slope(radius: usize, deviation: f64) -> Self {
        let ahead = neighbours(radius, |x| x * gauss(x / deviation));
        Self { form: Form::Slope, middle: T::rounded(0.0), ahead: rounded(&ahead, ahead.iter().sum()) }
    }

    /// Its second derivative: positive weights of sum 1, and negative ones of sum -1, the pixel's among them.
    pub(super) fn bend(radius: usize, deviation: f64) -> Self {
        let ahead = neighbours(radius, |x| ((x / deviation).powi(2) - 1.0) * gauss(x / deviation));
        let positive = 2.0 * ahead.iter().map(|w| w.max(0.0)).sum::<f64>();
        let negative = 1.0 + 2.0 * ahead.iter().map(|w| (-w).max(0.0)).sum::<f64>();
        let ahead: Vec<f64> = ahead.iter().map(|w| if *w > 0.0 { w / positive } else { w / negative }).collect();
        Self { form: Form::Bend, middle: T::rounded(0.0), ahead: rounded(&ahead, 1.0) }
    }

    /// Farthest neighbour in pixels.
    pub(super) fn radius(&self) -> usize {
        self.ahead.len()
    }

    /// Sets `sums` to the weighted sum of rows: `row(0)` is the farthest behind, `row(2 * radius)` the farthest ahead, each at least as
    /// long as `sums`. The order of the additions is always the same, and so are the bits.
    pub(super) fn weigh<'a>(&self, sums: &mut [T], row: impl Fn(usize) -> &'a [T]) {
        let middle = row(self.radius());
        for (sum, &value) in sums.iter_mut().zip(middle) {
            *sum = self.middle * value;
        }
        for (&weight, distance) in self.ahead.iter().zip(1..) {
            let both = row(self.radius() + distance).iter().zip(row(self.radius() - distance));
            let all = sums.iter_mut().zip(both);
            // A loop of its own for each, so that none asks within.
            match self.form {
                Form::Average => all.for_each(|(sum, (&ahead, &behind))| *sum += weight * (ahead + behind)),
                Form::Slope => all.for_each(|(sum, (&ahead, &behind))| *sum += weight * (ahead - behind)),
                Form::Bend => {
                    all.zip(middle).for_each(|((sum, (&ahead, &behind)), &middle)| *sum += weight * ((ahead - middle) + (behind - middle)))
                }
            }
        }
    }
}

/// Sum of a Gaussian of height 1 over `-radius..=radius` pixels.
pub(super) fn bell_sum(radius: usize, deviation: f64) -> f64 {
    1.0 + 2.0 * neighbours(radius, |x| gauss(x / deviation)).iter().sum::<f64>()
}

/// Weights at 1 to `radius` pixels.
fn neighbours(radius: usize, weight: impl Fn(f64) -> f64) -> Vec<f64> {
    (1..=radius).map(|distance| weight(distance as f64)).collect()
}

fn rounded<T: Number>(weights: &[f64], sum: f64) -> Vec<T> {
    weights.iter().map(|weight| T::rounded(weight / sum)).collect()
}

fn gauss(x: f64) -> f64 {
    (-0.5 * x * x).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a kernel makes of one row, where all its neighbours lie within.
    fn filtered<T: Number>(kernel: &Kernel<T>, row: &[f64]) -> Vec<T> {
        let row: Vec<T> = rounded(row, 1.0);
        let mut sums = vec![T::rounded(f64::NAN); row.len() - 2 * kernel.radius()];
        kernel.weigh(&mut sums, |k| &row[k..]);
        sums
    }

    #[test]
    fn derivatives_find_slope_and_bend_and_nothing_else() {
        assert!((bell_sum(12, 2.0) - (8.0 * std::f64::consts::PI).sqrt()).abs() < 1e-6);
        let of = |kernel: &Kernel<f64>, surface: fn(f64) -> f64| {
            filtered(kernel, &(-14..=14).map(|x| surface(f64::from(x))).collect::<Vec<_>>())
        };
        let (bell, slope, bend) = (Kernel::bell(12, 2.0, 1.0), Kernel::slope(12, 2.0), Kernel::bend(12, 2.0));
        for (x, k) in [-2.0, -1.0, 0.0, 1.0, 2.0].into_iter().zip(0..) {
            assert!((of(&bell, |_| 7.0)[k] - 7.0).abs() < 1e-14 && (of(&bell, |x| x)[k] - x).abs() < 1e-14);
            assert!(of(&slope, |_| 7.0)[k] == 0.0 && (of(&slope, |x| x * x)[k] - 2.0 * x * of(&slope, |x| x)[0]).abs() < 1e-13);
            assert!(of(&bend, |_| 7.0)[k] == 0.0 && of(&bend, |x| x)[k].abs() < 1e-14 && of(&bend, |x| x * x)[k] > 1.0);
        }
    }

    #[test]
    fn nothing_is_left_of_a_flat_row() {
        for value in [0.1, 0.3, 1.0, 255.0] {
            for kernel in [Kernel::<f32>::slope(9, 2.7), Kernel::bend(9, 2.7)] {
                assert_eq!(filtered(&kernel, &[value; 30]), [0.0; 12], "{value}");
            }
        }
    }

    #[test]
    fn a_single_point_shows_the_weights() {
        let point: Vec<f64> = (0..9).map(|x| f64::from(u8::from(x == 4))).collect();
        let expected = [2.0, 1.0, 0.0, 1.0, 2.0].map(|x| 0.25 * gauss(x) / bell_sum(2, 1.0));
        assert!(filtered(&Kernel::bell(2, 1.0, 0.25), &point).iter().zip(expected).all(|(a, b): (&f64, f64)| (a - b).abs() < 1e-15));
        let slope: Vec<f64> = filtered(&Kernel::slope(2, 1.0), &point);
        assert!(slope.iter().zip(slope.iter().rev()).all(|(a, b)| *a == -b) && slope[0] > 0.0, "{slope:?}");
        assert!((slope[0] + slope[1] - 1.0).abs() < 1e-15);
        let bend: Vec<f64> = filtered(&Kernel::bend(2, 0.8), &point);
        assert!(bend.iter().sum::<f64>().abs() < 1e-15 && (bend.iter().map(|w| w.abs()).sum::<f64>() - 2.0).abs() < 1e-15, "{bend:?}");
    }
}
