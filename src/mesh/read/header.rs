//! Headers of NumPy's arrays, before their reader sees them: it takes twice as long for each bracket within brackets.

/// Most brackets within brackets: an array of floats has two, one of records four.
const MOST_BRACKETS: usize = 8;

/// Whether the brackets of a header lie too deep within each other for any array.
pub fn nests_too_deep(header: &[u8]) -> bool {
    let (mut most, mut open) = (0, 0usize);
    for byte in header {
        match byte {
            b'[' | b'(' | b'{' => open += 1,
            b']' | b')' | b'}' => open = open.saturating_sub(1),
            _ => (),
        }
        most = most.max(open);
    }
    most > MOST_BRACKETS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_are_shallow_and_towers_of_brackets_are_not() {
        assert!(!nests_too_deep(b"{'descr': [('x', '<f4'), ('y', '<f4')], 'fortran_order': False, 'shape': (5, 8), }"));
        assert!(nests_too_deep(&[b'['; 9]) && !nests_too_deep(&b"[]".repeat(100)));
    }
}
