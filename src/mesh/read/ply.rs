//! Stanford PLY through `ply-rs-bw`, element by element, so that an error can name the element and its number.

use super::{Fault, Parts, fault, polygon};
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Encoding, Property, PropertyAccess, PropertyAccessResult, PropertyType};
use std::io::BufRead;
use std::path::Path;

/// One element of any kind: the fields that a mesh needs.
#[derive(Default)]
struct Row {
    position: [f64; 3],
    indices: Option<Vec<i64>>,
}

impl PropertyAccess for Row {
    fn new() -> Row {
        Row::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if let Some(axis) = ["x", "y", "z"].iter().position(|&a| a == name) {
            let Some(value) = scalar(&property) else { return PropertyAccessResult::UnsupportedType };
            self.position[axis] = value;
        } else if is_index_list(name) {
            let Some(values) = integers(property) else { return PropertyAccessResult::UnsupportedType };
            self.indices = Some(values);
        } else {
            return PropertyAccessResult::Ignored;
        }
        PropertyAccessResult::Set
    }
}

fn is_index_list(name: &str) -> bool {
    matches!(name, "vertex_indices" | "vertex_index")
}

fn scalar(property: &Property) -> Option<f64> {
    Some(match *property {
        Property::Char(v) => v.into(),
        Property::UChar(v) => v.into(),
        Property::Short(v) => v.into(),
        Property::UShort(v) => v.into(),
        Property::Int(v) => v.into(),
        Property::UInt(v) => v.into(),
        Property::Float(v) => v.into(),
        Property::Double(v) => v,
        _ => return None,
    })
}

fn integers(property: Property) -> Option<Vec<i64>> {
    fn widen<T: Into<i64>>(values: Vec<T>) -> Vec<i64> {
        values.into_iter().map(Into::into).collect()
    }
    Some(match property {
        Property::ListChar(v) => widen(v),
        Property::ListUChar(v) => widen(v),
        Property::ListShort(v) => widen(v),
        Property::ListUShort(v) => widen(v),
        Property::ListInt(v) => widen(v),
        Property::ListUInt(v) => widen(v),
        _ => return None,
    })
}

pub(super) fn parse(bytes: &[u8], _directory: &Path) -> Result<Parts, Fault> {
    let parser = Parser::<Row>::new();
    let mut reader = Reader::new(bytes);
    let header = match parser.read_header(&mut reader) {
        Ok(header) => header,
        Err(error) => return fault("header", first_line(&error)),
    };
    check_header(header.elements.values())?;
    // The reader counts the line that it would read next.
    let line = reader.line().saturating_sub(1);
    let mut payload = Payload { parser, encoding: header.encoding, rest: reader.into_inner(), line };

    let mut parts = Parts::default();
    let mut faces = Vec::new();
    for element in header.elements.values() {
        for i in 0..element.count {
            let row = payload.next(element, i)?;
            match element.name.as_str() {
                "vertex" => {
                    if let Some(axis) = row.position.iter().position(|v| !v.is_finite()) {
                        let what = format_args!("{} is {}, not a finite number", ["x", "y", "z"][axis], row.position[axis]).to_string();
                        return fault(format_args!("element vertex {i}"), what);
                    }
                    parts.positions.push(row.position);
                }
                // Faces may come before the vertices.
                "face" | "tristrips" => faces.push((element, i, row.indices.unwrap_or_default())),
                _ => {}
            }
        }
    }
    if payload.rest.iter().any(|b| !b.is_ascii_whitespace()) {
        let what = format_args!("{} bytes follow the last element that the header counts", payload.rest.len()).to_string();
        return fault("end of file", what);
    }
    for (element, i, indices) in faces {
        let place = format_args!("element {} {i}", element.name).to_string();
        append(&element.name, &indices, &mut parts).or_else(|what| fault(place, what))?;
    }
    if parts.triangles.is_empty() {
        return fault("element face", "there are no faces");
    }
    Ok(parts)
}

fn check_header<'a>(elements: impl Iterator<Item = &'a ElementDef> + Clone) -> Result<(), Fault> {
    if let Some(empty) = elements.clone().find(|e| e.properties.is_empty() && e.count > 0) {
        return fault(format_args!("header: element {}", empty.name), "it has no properties");
    }
    let Some(vertex) = elements.clone().find(|e| e.name == "vertex") else {
        return fault("header", "there is no element vertex");
    };
    for axis in ["x", "y", "z"] {
        if !matches!(vertex.properties.get(axis).map(|p| &p.data_type), Some(PropertyType::Scalar(_))) {
            return fault("header: element vertex", format_args!("there is no number property {axis}"));
        }
    }
    let mut faces = elements.filter(|e| matches!(e.name.as_str(), "face" | "tristrips")).peekable();
    if faces.peek().is_none() {
        return fault("header", "there are no faces: neither an element face nor tristrips");
    }
    for element in faces {
        let list = |p: &ply_rs_bw::ply::PropertyDef| is_index_list(&p.name) && matches!(p.data_type, PropertyType::List(..));
        if !element.properties.values().any(list) {
            return fault(format_args!("header: element {}", element.name), "there is no list property vertex_indices");
        }
    }
    Ok(())
}

/// The part of the file after the header.
struct Payload<'a> {
    parser: Parser<Row>,
    encoding: Encoding,
    rest: &'a [u8],
    /// Line of the file, counted from 1; of use in ASCII files only.
    line: usize,
}

impl<'a> Payload<'a> {
    fn next(&mut self, element: &ElementDef, i: usize) -> Result<Row, Fault> {
        let place = || format!("element {} {i}", element.name);
        let truncated = || format!("the file ends here, the header counts {} of them", element.count);
        let read = match self.encoding {
            Encoding::Ascii => {
                let Some(line) = self.next_line() else { return fault(place(), truncated()) };
                let place = format_args!("line {}, element {} {i}", self.line, element.name).to_string();
                let Ok(text) = std::str::from_utf8(line) else { return fault(place, "this is not text") };
                return self.parser.read_ascii_element(text, element).or_else(|e| fault(place, first_line(&e)));
            }
            Encoding::BinaryLittleEndian => self.parser.read_little_endian_element(&mut self.rest, element),
            Encoding::BinaryBigEndian => self.parser.read_big_endian_element(&mut self.rest, element),
        };
        read.or_else(|e| fault(place(), if self.rest.is_empty() { truncated() } else { first_line(&e) }))
    }

    /// The next line that is not blank.
    fn next_line(&mut self) -> Option<&'a [u8]> {
        loop {
            let (mut tail, before) = (self.rest, self.rest);
            // Reading from memory cannot fail.
            let length = tail.skip_until(b'\n').unwrap_or(0);
            if length == 0 {
                return None;
            }
            self.rest = tail;
            self.line += 1;
            let line = before[..length].trim_ascii();
            if !line.is_empty() && !line.starts_with(b"comment") {
                return Some(line);
            }
        }
    }
}

fn append(element: &str, indices: &[i64], parts: &mut Parts) -> Result<(), String> {
    let count = parts.positions.len();
    let strip = element == "tristrips";
    let bad = |&&i: &&i64| !((0..count as i64).contains(&i) || strip && i == -1);
    if let Some(i) = indices.iter().find(bad) {
        return Err(format!("vertex index {i} is out of range, there are {count} vertices"));
    }
    let vertex = |i: &i64| *i as u32;
    if !strip {
        if indices.len() < 3 {
            return Err(format!("a face needs 3 vertices or more, found {}", indices.len()));
        }
        let corners: Vec<u32> = indices.iter().map(vertex).collect();
        polygon::triangulate(&parts.positions, &corners, &mut parts.triangles);
        return Ok(());
    }
    // -1 ends a strip; every other triangle of a strip is wound the other way.
    for strip in indices.split(|&i| i == -1) {
        for (k, w) in strip.windows(3).enumerate() {
            let [a, b, c] = [vertex(&w[0]), vertex(&w[1]), vertex(&w[2])];
            parts.triangles.push(if k % 2 == 0 { [a, b, c] } else { [b, a, c] });
        }
    }
    Ok(())
}

/// The parser's message on one line.
fn first_line(error: &impl ToString) -> String {
    error.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
