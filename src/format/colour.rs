//! Material colours: linear in memory, sRGB-encoded 8-bit in the file.

/// sRGB code of a linear value, clamped to 0..=1; NaN gives 0.
pub fn to_srgb(linear: f32) -> u8 {
    let v = f64::from(linear).clamp(0.0, 1.0);
    let v = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    (v * 255.0).round() as u8 // 0 to 255; NaN becomes 0
}

/// Linear value, 0 to 1, of an sRGB code.
pub fn to_linear(code: u8) -> f32 {
    let v = f32::from(code) / 255.0;
    if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_come_back() {
        for code in 0..=255 {
            assert_eq!(to_srgb(to_linear(code)), code);
        }
        assert_eq!((to_srgb(f32::NAN), to_srgb(-1.0), to_srgb(2.0)), (0, 0, 255));
    }
}
