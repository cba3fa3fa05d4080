//! The header of a PLY file. `ply-rs-bw` parses; before it every line is checked here, so that an error says in plain words what is wrong.

use super::super::{Fault, fault, shown};
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{DefaultElement, ElementDef, Header, PropertyDef, PropertyType, ScalarType};
use std::collections::HashSet;

const WHOLE: [&str; 12] = ["char", "uchar", "short", "ushort", "int", "uint", "int8", "uint8", "int16", "uint16", "int32", "uint32"];
const FLOAT: [&str; 4] = ["float", "double", "float32", "float64"];

/// The header, what follows it, and the number of its lines.
pub(super) fn parse(bytes: &[u8]) -> Result<(Header, &[u8], usize), Fault> {
    let mut checker = Checker::default();
    let mut rest = bytes;
    for number in 1.. {
        let place = format!("header, line {number}");
        if rest.is_empty() {
            return fault(place, "the file ends here, before end_header");
        }
        let length = rest.iter().position(|&b| b == b'\n').map_or(rest.len(), |at| at + 1);
        let (line, tail) = rest.split_at(length);
        rest = tail;
        let end = checker.line(&String::from_utf8_lossy(line), number).or_else(|what| fault(place, what))?;
        if end {
            let header = match Parser::<DefaultElement>::new().read_header(&mut Reader::new(checker.out.as_bytes())) {
                Ok(header) => header,
                Err(_) => return fault("header", "a line or a name in it has a form that is not known"),
            };
            check(header.elements.values())?;
            return Ok((header, rest, number));
        }
    }
    fault("header", "it does not end")
}

/// True for the name of the list of a face's corners.
pub(super) fn is_index_list(name: &str) -> bool {
    matches!(name, "vertex_indices" | "vertex_index")
}

/// Checks the lines one by one and writes out those that matter.
#[derive(Default)]
struct Checker {
    out: String,
    has_format: bool,
    elements: HashSet<String>,
    /// Of the last element.
    properties: HashSet<String>,
}

impl Checker {
    /// True at the end of the header.
    fn line(&mut self, line: &str, number: usize) -> Result<bool, String> {
        let words: Vec<&str> = line.split_whitespace().collect();
        if number == 1 && words != ["ply"] {
            return Err("this is not a PLY file: its first line must be 'ply'".into());
        }
        match words[..] {
            [] | ["comment" | "obj_info", ..] => return Ok(false),
            ["ply"] if number == 1 => {}
            ["format", ref format @ ..] => self.format(format)?,
            ["element", ref element @ ..] => self.element(element)?,
            ["property", ref property @ ..] => self.property(property)?,
            ["end_header"] if !self.has_format => return Err("the header ends without a line 'format'".into()),
            ["end_header"] => {}
            [word, ..] => return Err(format!("'{}' is not a word that a header line begins with", shown(word))),
        }
        self.out.push_str(&words.join(" "));
        self.out.push('\n');
        Ok(words == ["end_header"])
    }

    fn format(&mut self, words: &[&str]) -> Result<(), String> {
        let &[kind, version] = words else { return Err("'format' needs a kind and a version".into()) };
        if !["ascii", "binary_little_endian", "binary_big_endian"].contains(&kind) {
            return Err(format!("format '{}' is not known: ascii, binary_little_endian and binary_big_endian are", shown(kind)));
        }
        if version != "1.0" {
            return Err(format!("version '{}' is not known: 1.0 is", shown(version)));
        }
        if std::mem::replace(&mut self.has_format, true) {
            return Err("there is a second line 'format'".into());
        }
        Ok(())
    }

    fn element(&mut self, words: &[&str]) -> Result<(), String> {
        let &[name, count] = words else { return Err("'element' needs a name and a count".into()) };
        if count.parse::<usize>().is_err() || !count.bytes().all(|b| b.is_ascii_digit()) {
            return Err(format!("element {}: its count '{}' is not a whole number", shown(name), shown(count)));
        }
        if !self.elements.insert(name.to_owned()) {
            return Err(format!("there is a second element {}", shown(name)));
        }
        self.properties.clear();
        Ok(())
    }

    fn property(&mut self, words: &[&str]) -> Result<(), String> {
        let (types, name) = match *words {
            ["list", count, item, name] if !FLOAT.contains(&count) => ([count, item], name),
            ["list", count, _, name] => return Err(format!("property {}: its length cannot be of type {count}", shown(name))),
            ["list", ..] => return Err("'property list' needs a type for its length, a type and a name".into()),
            [item, name] => ([item, item], name),
            _ => return Err("'property' needs a type and a name".into()),
        };
        if self.elements.is_empty() {
            return Err(format!("property {} comes before any element", shown(name)));
        }
        if let Some(word) = types.iter().find(|t| !WHOLE.contains(t) && !FLOAT.contains(t)) {
            return Err(format!("property {}: type '{}' is not known", shown(name), shown(word)));
        }
        if !self.properties.insert(name.to_owned()) {
            return Err(format!("there is a second property {} of this element", shown(name)));
        }
        Ok(())
    }
}

/// Refuses a header whose elements do not make a mesh.
fn check<'a>(elements: impl Iterator<Item = &'a ElementDef> + Clone) -> Result<(), Fault> {
    if let Some(empty) = elements.clone().find(|e| e.properties.is_empty() && e.count > 0) {
        return fault(format_args!("header: element {}", empty.name), "it has no properties");
    }
    let Some(vertex) = elements.clone().find(|e| e.name == "vertex") else {
        return fault("header", "there is no element vertex");
    };
    if let Some(axis) = ["x", "y", "z"].iter().find(|axis| !is_scalar(vertex, axis)) {
        return fault("header: element vertex", format_args!("there is no number property {axis}"));
    }
    let mut faces = elements.filter(|e| matches!(e.name.as_str(), "face" | "tristrips")).peekable();
    if faces.peek().is_none() {
        return fault("header", "there are no faces: neither an element face nor tristrips");
    }
    for element in faces {
        let list = |p: &PropertyDef| is_index_list(&p.name) && matches!(p.data_type, PropertyType::List(..));
        if !element.properties.values().any(list) {
            return fault(format_args!("header: element {}", element.name), "there is no list property vertex_indices");
        }
        let float = |p: &PropertyDef| matches!(p.data_type, PropertyType::List(_, ScalarType::Float | ScalarType::Double));
        if let Some(list) = element.properties.values().find(|p| is_index_list(&p.name) && float(p)) {
            return fault(format_args!("header: element {}", element.name), format_args!("{} must be whole numbers", list.name));
        }
    }
    Ok(())
}

/// True if the element has a property of this name that is one number.
pub(super) fn is_scalar(element: &ElementDef, name: &str) -> bool {
    matches!(element.properties.get(name).map(|p| &p.data_type), Some(PropertyType::Scalar(_)))
}
