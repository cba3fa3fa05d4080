//! Numbers in sentences.

/// 12345678 as "12,345,678".
pub fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(c);
    }
    out
}

/// `1 view`, `2 views`, `12,345 rays`: a number of things of which several end in s.
pub fn count(n: impl TryInto<u64>, one: &str) -> String {
    // No number of things is negative, or above 64 bits.
    let n = n.try_into().unwrap_or(u64::MAX);
    format!("{} {one}{}", grouped(n), if n == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    #[test]
    fn one_thing_has_no_s() {
        assert_eq!([0_u64, 1, 2, 12_345].map(|n| super::count(n, "ray")), ["0 rays", "1 ray", "2 rays", "12,345 rays"]);
    }

    #[test]
    fn digits_are_grouped() {
        assert_eq!([0, 999, 1000, 8_388_608].map(super::grouped), ["0", "999", "1,000", "8,388,608"]);
    }
}
