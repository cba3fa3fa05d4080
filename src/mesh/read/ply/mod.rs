//! Stanford PLY through `ply-rs-bw`, element by element, so that an error can name the element and its number, and in an ASCII file the line.

mod header;

use super::super::clean::unit;
use super::{Fault, Parts, fault, shown};
use header::{is_index_list, is_scalar};
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{ElementDef, Encoding, Property, PropertyAccess, PropertyAccessResult, PropertyType, ScalarType};
use std::io::{BufRead, ErrorKind};
use std::path::Path;
use std::str::SplitWhitespace;

/// Names that a vertex's texture coordinates have.
const TEXTURE: [[&str; 2]; 3] = [["s", "t"], ["u", "v"], ["texture_u", "texture_v"]];

/// One element of any kind: the fields that a mesh needs.
#[derive(Default)]
struct Row {
    position: [f64; 3],
    normal: [f64; 3],
    texture: [f64; 2],
    indices: Option<Vec<i64>>,
}

impl Row {
    fn set_number(&mut self, name: &str, value: f64) {
        match name {
            "x" => self.position[0] = value,
            "y" => self.position[1] = value,
            "z" => self.position[2] = value,
            "nx" => self.normal[0] = value,
            "ny" => self.normal[1] = value,
            "nz" => self.normal[2] = value,
            "s" | "u" | "texture_u" => self.texture[0] = value,
            "t" | "v" | "texture_v" => self.texture[1] = value,
            _ => {}
        }
    }

    /// An element of an ASCII file, or what is wrong with its line.
    fn from_text(text: &str, element: &ElementDef) -> Result<Row, String> {
        let mut row = Row::default();
        let mut words = text.split_whitespace();
        for (name, property) in &element.properties {
            let word = words.next().ok_or_else(|| format!("{name}: the line ends before it"))?;
            match &property.data_type {
                PropertyType::Scalar(kind) => row.set_number(name, number(name, word, kind)?),
                PropertyType::List(..) => {
                    let count = word.parse().map_err(|_| format!("{name}: its length '{}' is not a whole number", shown(word)))?;
                    let values = list(name, &mut words, count)?;
                    if is_index_list(name) {
                        row.indices = Some(whole(name, &values)?);
                    }
                }
            }
        }
        match words.count() {
            0 => Ok(row),
            more => Err(format!("the line goes on after the element's last value: {more} more")),
        }
    }
}

/// What the file's type can hold: a float is rounded to single precision.
fn number(name: &str, word: &str, kind: &ScalarType) -> Result<f64, String> {
    let value = if matches!(kind, ScalarType::Float) { word.parse::<f32>().map(f64::from) } else { word.parse() };
    value.map_err(|_| format!("{name}: '{}' is not a number", shown(word)))
}

fn list<'a>(name: &str, words: &mut SplitWhitespace<'a>, count: usize) -> Result<Vec<&'a str>, String> {
    let values: Vec<&str> = words.by_ref().take(count).collect();
    if values.len() < count {
        return Err(format!("{name}: its length is {count}, but the line has {}", values.len()));
    }
    Ok(values)
}

fn whole(name: &str, words: &[&str]) -> Result<Vec<i64>, String> {
    words.iter().map(|w| w.parse().map_err(|_| format!("{name}: '{}' is not a whole number", shown(w)))).collect()
}

impl PropertyAccess for Row {
    fn new() -> Row {
        Row::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if let Some(value) = scalar(&property) {
            self.set_number(name, value);
        } else if is_index_list(name) {
            self.indices = integers(property);
        }
        PropertyAccessResult::Set
    }
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
    let (header, rest, line) = header::parse(bytes)?;
    let mut payload = Payload { parser: Parser::new(), encoding: header.encoding, rest, line };
    let has_normals = header.elements.get("vertex").is_some_and(|e| ["nx", "ny", "nz"].iter().all(|n| is_scalar(e, n)));

    let has_texture = header.elements.get("vertex").is_some_and(|e| TEXTURE.iter().any(|pair| pair.iter().all(|n| is_scalar(e, n))));

    let mut parts = Parts::default();
    let (mut normals, mut texture, mut faces) = (Vec::new(), Vec::new(), Vec::new());
    for element in header.elements.values() {
        for i in 0..element.count {
            let row = payload.next(element, i)?;
            match element.name.as_str() {
                "vertex" => {
                    if let Some(axis) = row.position.iter().position(|v| !v.is_finite()) {
                        let what = format_args!("{} is {}, not a finite number", ["x", "y", "z"][axis], row.position[axis]).to_string();
                        return fault(payload.place(element, i, payload.line), what);
                    }
                    parts.positions.push(row.position);
                    if has_normals {
                        normals.push(unit(row.normal));
                    }
                    if has_texture {
                        texture.push(row.texture.map(|c| c as f32));
                    }
                }
                // Faces may come before the vertices.
                "face" | "tristrips" => faces.push((element, i, payload.line, row.indices.unwrap_or_default())),
                _ => {}
            }
        }
    }
    if payload.rest.iter().any(|b| !b.is_ascii_whitespace()) {
        let what = format_args!("{} bytes follow the last element that the header counts", payload.rest.len()).to_string();
        let place = if payload.is_text() { format!("after line {}", payload.line) } else { "end of file".to_owned() };
        return fault(place, what);
    }
    for (element, i, line, indices) in faces {
        append(&element.name, &indices, &mut parts).or_else(|what| fault(payload.place(element, i, line), what))?;
    }
    if parts.triangles.is_empty() {
        return fault("element face", "there are no faces");
    }
    let others = header.elements.values().filter(|e| !matches!(e.name.as_str(), "vertex" | "face" | "tristrips") && e.count > 0);
    parts.warnings.extend(others.map(|e| format!("its element {} is not kept", shown(&e.name))));
    if has_normals {
        parts.normals = parts.triangles.iter().map(|t| t.map(|v| normals[v as usize])).collect();
    }
    if has_texture {
        parts.texture = parts.triangles.iter().map(|t| t.map(|v| texture[v as usize])).collect();
    }
    Ok(parts)
}

/// The part of the file after the header.
struct Payload<'a> {
    parser: Parser<Row>,
    encoding: Encoding,
    rest: &'a [u8],
    /// Line of the file that was read last, counted from 1; of use in ASCII files only.
    line: usize,
}

impl<'a> Payload<'a> {
    fn next(&mut self, element: &ElementDef, i: usize) -> Result<Row, Fault> {
        let truncated = || format!("the file ends here, the header counts {} of them", element.count);
        let read = match self.encoding {
            Encoding::Ascii => {
                let line = self.next_line();
                let place = || self.place(element, i, self.line);
                let Some(line) = line else { return fault(place(), truncated()) };
                let Ok(text) = std::str::from_utf8(line) else { return fault(place(), "this is not text") };
                return Row::from_text(text, element).or_else(|what| fault(place(), what));
            }
            Encoding::BinaryLittleEndian => self.parser.read_little_endian_element(&mut self.rest, element),
            Encoding::BinaryBigEndian => self.parser.read_big_endian_element(&mut self.rest, element),
        };
        let place = || self.place(element, i, self.line);
        read.or_else(|error| match error.kind() {
            ErrorKind::UnexpectedEof => fault(place(), truncated()),
            _ => fault(place(), "the length of a list is negative"),
        })
    }

    fn is_text(&self) -> bool {
        matches!(self.encoding, Encoding::Ascii)
    }

    /// Where an element stands, for a message: it is on that line of an ASCII file.
    fn place(&self, element: &ElementDef, i: usize, line: usize) -> String {
        let line = if self.is_text() { format!("line {line}, ") } else { String::new() };
        format!("{line}element {} {i}", element.name)
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
        return parts.polygon(&corners, |_, _| {});
    }
    // -1 ends a strip; every other triangle of a strip is wound the other way.
    for strip in indices.split(|&i| i == -1) {
        for (k, w) in strip.windows(3).enumerate() {
            let [a, b, c] = [vertex(&w[0]), vertex(&w[1]), vertex(&w[2])];
            parts.polygon(&if k % 2 == 0 { [a, b, c] } else { [b, a, c] }, |_, _| {})?;
        }
    }
    Ok(())
}
