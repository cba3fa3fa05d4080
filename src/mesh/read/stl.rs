//! STL, ASCII and binary, read here: both forms are short, and the crates there are stop at the first solid of a file, take binary files that
//! begin with "solid" for text, or name no line.

use super::super::clean::is_coordinate;
use super::{Fault, Parts, fault, shown};
use std::path::Path;

/// The lines of a facet, and which word of each is the first number.
const FACET: [(&str, usize); 7] =
    [("facet normal", 2), ("outer loop", 2), ("vertex", 1), ("vertex", 1), ("vertex", 1), ("endloop", 1), ("endfacet", 1)];

/// Bytes before the triangles of a binary file, and bytes of each of them.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

pub(super) fn parse(bytes: &[u8], _directory: &Path) -> Result<Parts, Fault> {
    if is_text(bytes) { text(bytes) } else { binary(bytes) }
}

/// Binary files may begin with "solid" as well: a length that fits their count, or a zero byte, tells them apart.
fn is_text(bytes: &[u8]) -> bool {
    let word: Vec<u8> = bytes.trim_ascii_start().iter().take(5).map(u8::to_ascii_lowercase).collect();
    word == b"solid" && counted(bytes).is_none_or(|n| n != (bytes.len() - HEADER) as u64) && !bytes.iter().take(1024).any(|&b| b == 0)
}

/// Bytes of the triangles that the header of a binary file counts.
fn counted(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(..HEADER)?.last_chunk()?;
    Some(u64::from(u32::from_le_bytes(*count)) * TRIANGLE as u64)
}

fn binary(bytes: &[u8]) -> Result<Parts, Fault> {
    let Some(wanted) = counted(bytes) else {
        return fault("header", "this is no STL file: it neither begins with 'solid' nor has the 84 bytes of a binary header");
    };
    let body = &bytes[HEADER..];
    if body.len() as u64 != wanted {
        let (count, found) = (wanted / TRIANGLE as u64, body.len() / TRIANGLE);
        return fault(
            "header",
            format_args!("it counts {count} triangles ({wanted} bytes), the file has {} bytes: {found} of them", body.len()),
        );
    }
    let mut parts = Parts::default();
    for (i, triangle) in body.chunks_exact(TRIANGLE).enumerate() {
        // The facet's normal comes first.
        let corners: Vec<f64> = triangle[12..48].as_chunks().0.iter().map(|&b| f32::from_le_bytes(b).into()).collect();
        if let Some(bad) = corners.iter().find(|v| !v.is_finite()) {
            return fault(format_args!("triangle {i}"), format_args!("a coordinate is {bad}, not a finite number"));
        }
        push(&corners, &mut parts);
    }
    not_empty(parts)
}

fn text(bytes: &[u8]) -> Result<Parts, Fault> {
    let text = String::from_utf8_lossy(bytes);
    let mut parts = Parts::default();
    // The line of a facet that comes next, 0 between facets, and the facet's coordinates so far.
    let (mut step, mut corners) = (0, Vec::with_capacity(9));
    let (mut inside, mut last) = (false, 0);
    for (line, number) in text.lines().zip(1usize..) {
        let place = || format!("line {number}");
        let words: Vec<String> = line.split_whitespace().map(str::to_lowercase).collect();
        let Some(first) = words.first() else { continue };
        last = number;
        if step == 0 && (first == "solid" && !inside || first == "endsolid" && inside) {
            inside = !inside;
            continue;
        }
        let (expected, numbers) = FACET[step];
        if !inside || words.len() < numbers || words[..numbers].join(" ") != expected {
            let expected = if inside { expected } else { "solid" };
            let or_end = if inside && step == 0 { " or 'endsolid'" } else { "" };
            return fault(place(), format_args!("expected '{expected}'{or_end}, found '{}'", shown(line)));
        }
        if expected == "vertex" {
            corners.extend(vertex(&words[numbers..]).or_else(|what| fault(place(), what))?);
        }
        step = (step + 1) % FACET.len();
        if step == 0 {
            push(&corners, &mut parts);
            corners.clear();
        }
    }
    if inside {
        let what = if step == 0 { "without 'endsolid'" } else { "in the middle of a facet" };
        return fault(format_args!("line {last}"), format_args!("the file ends {what}"));
    }
    not_empty(parts)
}

fn vertex(words: &[String]) -> Result<Vec<f64>, String> {
    if words.len() != 3 {
        return Err(format!("vertex needs 3 coordinates, found {}", words.len()));
    }
    let number = |w: &String| match w.parse::<f64>() {
        Ok(v) if is_coordinate(v) => Ok(v),
        Ok(v) => Err(format!("vertex: {} is {}", shown(w), if v.is_finite() { "too large" } else { "not finite" })),
        Err(_) => Err(format!("vertex: '{}' is not a number", shown(w))),
    };
    words.iter().map(number).collect()
}

/// The nine coordinates of a triangle; cleaning welds the vertices.
fn push(corners: &[f64], parts: &mut Parts) {
    let first = parts.positions.len() as u32;
    parts.positions.extend_from_slice(corners.as_chunks().0);
    parts.triangles.push([first, first + 1, first + 2]);
}

fn not_empty(parts: Parts) -> Result<Parts, Fault> {
    if parts.triangles.is_empty() { fault("end of file", "there are no triangles") } else { Ok(parts) }
}
