//! Arrays of NumPy's whose headers are looked at before their reader sees them: it takes twice as long for each bracket within brackets, multiplies sizes without a check, and quotes what it does not understand whole.

use npyz::NpyFile;
use std::io::{self, Read};
use thiserror::Error;

/// Most bytes of a header: one of an array of rays or positions has a hundred or so.
const MOST_HEADER: u32 = 1 << 16;

/// Most brackets within brackets: an array of floats has two, one of records four.
const MOST_BRACKETS: usize = 8;

/// Most characters of a header that an error shows.
const MOST_SHOWN: usize = 100;

/// Why a file is no array.
#[derive(Debug, Error)]
pub enum ArrayError {
    /// It cannot be read, or its header cannot be understood.
    #[error("{0}")]
    Io(io::Error),
    /// Its header is longer than any of an array of floats.
    #[error("a header of {0} bytes, where arrays of floats have at most 2^16")]
    Header(u32),
    /// Its header has brackets within brackets without end.
    #[error("no array of NumPy's: its header has more than {MOST_BRACKETS} brackets within each other")]
    Brackets,
    /// It ends before its last value.
    #[error("the file ends within its values")]
    Short,
    /// The sizes of its shape have no product.
    #[error("an array of a shape that cannot be")]
    Shape,
}

/// Opens an array; only its header is read.
///
/// # Errors
/// It is none, or its header promises what cannot be.
pub fn open_array<R: Read>(mut bytes: R) -> Result<NpyFile<impl Read>, ArrayError> {
    let mut start = Vec::new();
    bytes.by_ref().take(12).read_to_end(&mut start).map_err(ArrayError::Io)?;
    if start.starts_with(b"\x93NUMPY") && start.len() == 12 {
        let (from, length) = match start[6] {
            0 | 1 => (10, u32::from(u16::from_le_bytes([start[8], start[9]]))),
            _ => (12, u32::from_le_bytes([start[8], start[9], start[10], start[11]])),
        };
        if length > MOST_HEADER {
            return Err(ArrayError::Header(length));
        }
        let missing = (from + u64::from(length)).saturating_sub(12);
        bytes.by_ref().take(missing).read_to_end(&mut start).map_err(ArrayError::Io)?;
        let header = &start[from as usize..];
        if nests_too_deep(header) {
            return Err(ArrayError::Brackets);
        }
        if !is_countable(header) {
            return Err(ArrayError::Shape);
        }
    }
    NpyFile::new(io::Cursor::new(start).chain(bytes)).map_err(|error| {
        let what = error.to_string();
        ArrayError::Io(io::Error::new(error.kind(), format!("no array of NumPy's: {}", shown(what.lines().next().unwrap_or_default()))))
    })
}

/// The values of an array of floats of `size` bytes, 4 or 8, in its order.
///
/// # Errors
/// There are fewer than its shape says, or they cannot be read.
pub fn floats<R: Read>(array: NpyFile<R>, size: u64) -> Result<Vec<f64>, ArrayError> {
    let values = match size {
        4 => array.into_vec::<f32>().map(|values| values.into_iter().map(f64::from).collect()),
        _ => array.into_vec(),
    };
    values.map_err(|error| if error.kind() == io::ErrorKind::UnexpectedEof { ArrayError::Short } else { ArrayError::Io(error) })
}

/// Shape and type of an array, for errors.
pub fn shape_and_type<R: Read>(array: &NpyFile<R>) -> String {
    format!("shape {} and type {}", shown(&format!("{:?}", array.shape())), shown(&array.dtype().descr()))
}

/// Its first characters.
fn shown(text: &str) -> String {
    let mut rest = text.chars();
    let first: String = rest.by_ref().take(MOST_SHOWN).collect();
    if rest.next().is_some() { first + ".." } else { first }
}

fn nests_too_deep(header: &[u8]) -> bool {
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

/// Whether the sizes of a header's shape have a product: the reader of arrays takes that for granted. It is asked of every list of numbers: which of
/// them is the shape is not told by a word, as there may be more than one such key, written in many ways.
fn is_countable(header: &[u8]) -> bool {
    let text = without_strings(&String::from_utf8_lossy(header));
    text.split(['(', ')', '[', ']', '{', '}']).all(|list| {
        let words = list.split([',', ':', ' ', '\t', '\n', '\x0c']).map(|word| word.trim_end_matches('L'));
        let numbers = words.filter(|word| word.starts_with(|c: char| c.is_ascii_digit() || c == '+' || c == '-'));
        // Sums are none that a shape has.
        let mut sizes = numbers.map(|word| word.parse::<u64>().ok().filter(|_| !word.starts_with('+')));
        sizes.try_fold(1u64, |all, size| all.checked_mul(size?.max(1))).is_some()
    })
}

/// A header with a blank in place of each of its strings.
fn without_strings(header: &str) -> String {
    let mut out = String::with_capacity(header.len());
    let mut rest = header.chars();
    while let Some(first) = rest.next() {
        if !matches!(first, '\'' | '"') {
            out.push(first);
            continue;
        }
        out.push(' ');
        while let Some(inner) = rest.next().filter(|&inner| inner != first) {
            // Behind a back-slash a quote ends nothing.
            if inner == '\\' {
                _ = rest.next();
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head(version: u8, length: &[u8], text: &str) -> Vec<u8> {
        [b"\x93NUMPY", &[version, 0][..], length, text.as_bytes()].concat()
    }

    fn why(text: &str) -> String {
        let bytes = head(1, &(text.len() as u16).to_le_bytes(), text);
        open_array(bytes.as_slice()).map(|array| array.shape().to_vec()).unwrap_err().to_string()
    }

    #[test]
    fn headers_that_promise_too_much_are_refused() {
        let long = head(2, &[0xff; 4], "");
        let said = open_array(long.as_slice()).map(|_| ()).unwrap_err().to_string();
        assert_eq!(said, "a header of 4294967295 bytes, where arrays of floats have at most 2^16");
        for shape in ["9223372036854775807, 8", "0, 9223372036854775807, 8", "99999999999999999999, 6"] {
            let said = why(&format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({shape}), }}\n"));
            assert_eq!(said, "an array of a shape that cannot be");
        }
        for [descr, shape] in [
            ["'descr': [('shape(1)', '<f8')]", "'shape': (9223372036854775807, 8)"],
            ["'descr': [('\\'shape\\': (1)', '<f8')]", "'shape': (9223372036854775807, 8)"],
            ["'descr': '<f8', 'shape': (1,)", "'shape': (9223372036854775807, 8)"],
            ["'descr': '<f8'", "\"sh\\x61pe\": [9223372036854775807, 8]"],
            ["'descr': '<f8'", "'shape': (4294967295 +1, 4294967295 + 1)"],
            ["'descr': '<f8'", "'shape': (0x7fffffffffffffff, 8)"],
        ] {
            let said = why(&format!("{{{descr}, 'fortran_order': False, {shape}, }}\n"));
            assert_eq!(said, "an array of a shape that cannot be", "{descr}, {shape}");
        }
    }

    #[test]
    fn numbers_in_strings_and_types_are_no_sizes() {
        let descr = "[('9223372036854775807, 8', '<f4', (4294967295,)), (\"it's (+1\", '<i4', (4294967295, 2))]";
        let text = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': (5, 3), }}\n");
        let bytes = head(1, &(text.len() as u16).to_le_bytes(), &text);
        assert_eq!(open_array(bytes.as_slice()).unwrap().shape(), [5, 3]);
    }

    #[test]
    fn arrays_are_shallow_and_towers_of_brackets_are_not() {
        assert!(!nests_too_deep(b"{'descr': [('x', '<f4'), ('y', '<f4')], 'fortran_order': False, 'shape': (5, 8), }"));
        assert!(nests_too_deep(&[b'['; 9]) && !nests_too_deep(&b"[]".repeat(100)));
        assert!(why(&"[".repeat(9)).contains("more than 8 brackets"));
    }

    #[test]
    fn errors_are_short_however_long_the_header() {
        let said = why(&"\"".repeat(5000));
        assert!(said.starts_with("no array of NumPy's: ") && said.len() < 200 && !said.contains('\n'), "{said}");
        let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}), }}\n", "1, ".repeat(1000));
        let bytes = head(1, &(text.len() as u16).to_le_bytes(), &text);
        let said = shape_and_type(&open_array(bytes.as_slice()).unwrap());
        assert!(said.ends_with(".. and type '<f8'") && said.len() < 200, "{said}");
    }
}
