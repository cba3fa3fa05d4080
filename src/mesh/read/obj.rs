//! Wavefront OBJ. `tobj` parses; before it every line is checked here, because its errors name no line and it lets some faults pass.

use super::super::clean::is_coordinate;
use super::{Fault, Parts, fault, polygon};
use std::fmt::Write;
use std::path::Path;

/// Colour of what has no material, if anything else in the file has one.
const NO_MATERIAL: [f32; 3] = [0.8; 3];

pub(super) fn parse(bytes: &[u8], directory: &Path) -> Result<Parts, Fault> {
    let text = Checker::default().check(bytes)?;
    let options = tobj::LoadOptions { ignore_points: true, ignore_lines: true, ..Default::default() };
    let library = |name: &Path| {
        let text = std::fs::read(directory.join(name)).map(|bytes| material_text(&bytes)).unwrap_or_default();
        tobj::load_mtl_buf(&mut text.as_bytes())
    };
    let (models, materials) = match tobj::load_obj_buf(&mut text.as_bytes(), &options, library) {
        Ok(loaded) => loaded,
        Err(error) => return fault("faces", error),
    };

    let mut parts = Parts::default();
    let materials = materials.unwrap_or_default();
    if materials.len() >= usize::from(u16::MAX) {
        return fault("mtllib", format_args!("{} materials are more than the 65534 that can be kept", materials.len()));
    }
    if !materials.is_empty() {
        let colour = |m: &tobj::Material| m.diffuse.map_or(NO_MATERIAL, |c| c.map(|v| (v as f32).clamp(0.0, 1.0)));
        parts.colours = materials.iter().map(colour).chain([NO_MATERIAL]).collect();
    }
    for mesh in models.iter().map(|m| &m.mesh) {
        append(mesh, &mut parts);
    }
    Ok(parts)
}

fn append(mesh: &tobj::Mesh, parts: &mut Parts) {
    let base = parts.positions.len() as u32;
    parts.positions.extend(mesh.positions.chunks_exact(3).map(|p| [p[0], p[1], p[2]]));
    let arities = if mesh.face_arities.is_empty() { &vec![3; mesh.indices.len() / 3] } else { &mesh.face_arities };
    let mut rest = &mesh.indices[..];
    for &arity in arities {
        let Some((face, tail)) = rest.split_at_checked(arity as usize) else { break };
        let corners: Vec<u32> = face.iter().map(|&i| base + i).collect();
        polygon::triangulate(&parts.positions, &corners, &mut parts.triangles);
        rest = tail;
    }
    if !parts.colours.is_empty() {
        let none = parts.colours.len() - 1;
        parts.materials.resize(parts.triangles.len(), mesh.material_id.map_or(none, |m| m.min(none)) as u16);
    }
}

/// Checks all lines and writes out those that a mesh needs, one for one, in a form that `tobj` reads the same way.
#[derive(Default)]
struct Checker {
    out: String,
    /// Positions, texture coordinates and normals so far.
    counts: [i64; 3],
    faces: usize,
    /// The largest index ahead of its vertex so far, and its line: legal as long as the vertex comes before the object ends.
    ahead: [(i64, usize); 3],
}

impl Checker {
    fn check(mut self, bytes: &[u8]) -> Result<String, Fault> {
        if let Some(at) = bytes.iter().position(|&b| b == 0) {
            let line = 1 + bytes[..at].iter().filter(|&&b| b == b'\n').count();
            return fault(format_args!("line {line}"), "this is not text");
        }
        let text = String::from_utf8_lossy(bytes);
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let mut joined = String::new();
        let mut last = 0;
        for (line, number) in text.lines().zip(1usize..) {
            last = number;
            let at = |what| Fault { place: format!("line {number}"), what };
            if let Some(begun) = line.trim_end().strip_suffix('\\') {
                joined.push_str(begun);
                joined.push(' ');
                continue;
            }
            joined.push_str(line);
            self.line(&joined, number).map_err(at)?;
            joined.clear();
        }
        if !joined.is_empty() {
            return fault(format_args!("line {last}"), "the file ends in the middle of a continued line");
        }
        if self.faces == 0 {
            return fault(format_args!("line {last}"), "the file ends without a face (no line begins with f)");
        }
        for (kind, name) in ["vertex", "texture coordinate", "normal"].iter().enumerate() {
            let (index, line) = self.ahead[kind];
            if index > self.counts[kind] {
                let what = format_args!("{name} index {index} is out of range, the file has {}", self.counts[kind]).to_string();
                return fault(format_args!("line {line}"), what);
            }
        }
        Ok(self.out)
    }

    fn line(&mut self, line: &str, number: usize) -> Result<(), String> {
        let mut words = line.split_whitespace();
        let key = words.next().unwrap_or("");
        let words: Vec<&str> = words.take_while(|w| !w.starts_with('#')).collect();
        match key {
            "v" => self.position(&words),
            "vt" => self.numbers(1, key, &words, 1..=3),
            "vn" => self.numbers(2, key, &words, 3..=3),
            "f" => self.face(&words, number),
            "o" | "g" | "usemtl" | "mtllib" => {
                // Names may hold spaces, and `tobj` looks for them after exactly one.
                let name = line.trim_start()[key.len()..].trim();
                if !name.is_empty() {
                    _ = writeln!(self.out, "{key} {name}");
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn position(&mut self, words: &[&str]) -> Result<(), String> {
        // x y z, x y z w, or x y z with a colour, which is not kept.
        if !matches!(words.len(), 3 | 4 | 6 | 7) {
            return Err(format!("v needs 3 coordinates, found {} numbers", words.len()));
        }
        let values: Vec<f64> = words.iter().map(|w| number("v", w)).collect::<Result<_, _>>()?;
        let weight = if words.len() == 4 { values[3] } else { 1.0 };
        if weight == 0.0 || !values[..3].iter().all(|v| is_coordinate(v / weight)) {
            return Err(format!("v: {} is not a usable position", words.join(" ")));
        }
        let kept = if words.len() == 4 { 4 } else { 3 };
        _ = writeln!(self.out, "v {}", words[..kept].join(" "));
        self.counts[0] += 1;
        Ok(())
    }

    fn numbers(&mut self, kind: usize, key: &str, words: &[&str], range: std::ops::RangeInclusive<usize>) -> Result<(), String> {
        if !range.contains(&words.len()) {
            return Err(format!("{key} needs {} numbers, found {}", range.start(), words.len()));
        }
        words.iter().try_for_each(|w| number(key, w).map(|_| ()))?;
        // `tobj` wants two texture coordinates where the format allows one.
        let padding = if words.len() == 1 { " 0" } else { "" };
        _ = writeln!(self.out, "{key} {}{padding}", words.join(" "));
        self.counts[kind] += 1;
        Ok(())
    }

    fn face(&mut self, words: &[&str], line: usize) -> Result<(), String> {
        if words.len() < 3 {
            return Err(format!("f needs 3 vertices or more, found {}", words.len()));
        }
        self.out.push('f');
        for word in words {
            let mut parts = word.split('/');
            for kind in 0..3 {
                let Some(part) = parts.next() else { break };
                if kind == 0 || !part.is_empty() {
                    self.index(kind, part, word, line)?;
                }
            }
            if parts.next().is_some() {
                return Err(format!("f: {word} has more than three indices"));
            }
            _ = write!(self.out, " {word}");
        }
        self.out.push('\n');
        self.faces += 1;
        Ok(())
    }

    fn index(&mut self, kind: usize, part: &str, word: &str, line: usize) -> Result<(), String> {
        let name = ["vertex", "texture coordinate", "normal"][kind];
        let Ok(index) = part.parse::<i64>() else {
            return Err(format!("f: {word} has no valid {name} index"));
        };
        let count = self.counts[kind];
        if index == 0 || index < -count || index > i64::from(u32::MAX) {
            return Err(format!("f: {name} index {index} is out of range, {count} came before it"));
        }
        if index > count && index > self.ahead[kind].0 {
            self.ahead[kind] = (index, line);
        }
        Ok(())
    }
}

fn number(key: &str, word: &str) -> Result<f64, String> {
    match word.parse::<f64>() {
        Ok(v) if v.is_finite() => Ok(v),
        Ok(_) => Err(format!("{key}: {word} is not finite")),
        Err(_) => Err(format!("{key}: {word} is not a number")),
    }
}

/// Names and diffuse colours of a material library; what else it holds, right or wrong, is of no use here.
fn material_text(bytes: &[u8]) -> String {
    let mut out = String::new();
    for line in String::from_utf8_lossy(bytes).lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("newmtl") => {
                let name = line.trim_start()["newmtl".len()..].trim();
                if !name.is_empty() {
                    _ = writeln!(out, "newmtl {name}");
                }
            }
            Some("Kd") => {
                let values: Vec<f64> = words.map_while(|w| number("Kd", w).ok()).take(3).collect();
                // One value stands for all three.
                if let [r, g, b] | [r, g, b, ..] = values[..] {
                    _ = writeln!(out, "Kd {r} {g} {b}");
                } else if let [grey] = values[..] {
                    _ = writeln!(out, "Kd {grey} {grey} {grey}");
                }
            }
            _ => {}
        }
    }
    out
}
