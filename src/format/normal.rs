//! Unit vectors in 32 bits: octahedral, two 16-bit signed fractions (x in the low half), 32767 = 1; -32768 is not used.

/// The code of the direction of `v`, or `None` if it has none (not finite, or zero).
pub fn encode_normal(v: [f32; 3]) -> Option<u32> {
    let v = v.map(f64::from);
    let sum = v.iter().map(|c| c.abs()).sum::<f64>();
    if !(sum > 0.0 && sum.is_finite()) {
        return None;
    }
    let [mut x, mut y, z] = v.map(|c| c / sum);
    if z < 0.0 {
        // The lower half is folded over the diagonals.
        (x, y) = ((1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y));
    }
    let half = |c: f64| u32::from(((c * 32_767.0).round() as i16).cast_unsigned()); // |c| <= 1
    Some(half(x) | half(y) << 16)
}

/// The unit vector of a code.
#[inline]
pub fn decode_normal(code: u32) -> [f32; 3] {
    let part = |bits: u32| f32::from((bits as u16).cast_signed()) / 32_767.0; // the low half of `bits`
    let (mut x, mut y) = (part(code), part(code >> 16));
    let z = 1.0 - x.abs() - y.abs();
    if z < 0.0 {
        (x, y) = ((1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y));
    }
    let length = (x * x + y * y + z * z).sqrt();
    [x / length, y / length, z / length]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_has_no_direction_has_no_code() {
        for v in [[0.0; 3], [f32::NAN, 0.0, 1.0], [f32::INFINITY, 0.0, 0.0]] {
            assert_eq!(encode_normal(v), None);
        }
        assert_eq!(decode_normal(encode_normal([0.0, 0.0, 1e-40]).unwrap()), [0.0, 0.0, 1.0]);
        assert_eq!(decode_normal(encode_normal([0.0, -3e38, 0.0]).unwrap()), [0.0, -1.0, 0.0]);
    }

    proptest! {
        #[test]
        fn directions_come_back(v in prop::array::uniform3(-1f32..1.0)) {
            let length = v.iter().map(|c| c * c).sum::<f32>().sqrt();
            prop_assume!(length > 1e-3);
            let back = decode_normal(encode_normal(v).unwrap());
            for k in 0..3 {
                prop_assert!((back[k] - v[k] / length).abs() < 1e-4, "{v:?} {back:?}");
            }
        }
    }
}
