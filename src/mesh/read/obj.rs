//! Wavefront OBJ. `tobj` parses; before it every line is checked here, because its errors name no line and it lets some faults pass.

use super::super::clean::{is_coordinate, unit};
use super::{Fault, Parts, beside, fault, polygon, shown};
use std::cell::RefCell;
use std::fmt::Write;
use std::path::Path;

/// Colour of what has no material, if anything else in the file has one.
const NO_MATERIAL: [f32; 3] = [0.8; 3];

/// What a face's corner may name, in the order of its indices.
const KINDS: [&str; 3] = ["vertex", "texture coordinate", "normal"];
/// What is drawn and no face: points, lines, curves and surfaces.
const OTHERS: [&str; 5] = ["p", "l", "curv", "curv2", "surf"];
const VERTEX: usize = 0;
const TEXTURE: usize = 1;
const NORMAL: usize = 2;

pub(super) fn parse(bytes: &[u8], directory: &Path) -> Result<Parts, Fault> {
    let Checked { text, large_faces, lost_normals, others } = Checker::default().check(bytes)?;
    let warnings = RefCell::new(Vec::new());
    let options = tobj::LoadOptions { ignore_points: true, ignore_lines: true, ..Default::default() };
    let library = |name: &Path| {
        let name = name.to_string_lossy();
        let all = beside::LARGEST_LIBRARY + 1;
        let text = match beside::read(&beside::place(directory, &name), all, beside::LARGEST_LIBRARY) {
            Ok(bytes) => material_text(&bytes),
            Err(error) => {
                let lost = format!("mtllib {}: {error}; its colours are missing", shown(&name));
                let mut warnings = warnings.borrow_mut();
                if !warnings.contains(&lost) {
                    warnings.push(lost);
                }
                String::new()
            }
        };
        tobj::load_mtl_buf(&mut text.as_bytes())
    };
    let (models, materials) = match tobj::load_obj_buf(&mut text.as_bytes(), &options, library) {
        Ok(loaded) => loaded,
        Err(tobj::LoadError::FaceVertexOutOfBounds | tobj::LoadError::FaceNormalOutOfBounds) => {
            return fault("faces", "a vertex or normal index is out of range where its object ends: what it names comes later");
        }
        Err(error) => return fault("faces", error),
    };

    let mut parts = Parts { warnings: warnings.take(), ..Parts::default() };
    if lost_normals > 0 {
        parts.warnings.push(format!("{lost_normals} of its normals (vn) are not finite: corners that name them have none"));
    }
    if others > 0 {
        parts.warnings.push(format!("{others} of its lines begin with {}: only faces (f) are kept", OTHERS.join(", ")));
    }
    let materials = materials.unwrap_or_default();
    if materials.len() >= usize::from(u16::MAX) {
        return fault("mtllib", format_args!("{} materials are more than the 65534 that can be kept", materials.len()));
    }
    if !materials.is_empty() {
        let colour = |m: &tobj::Material| m.diffuse.map_or(NO_MATERIAL, |c| c.map(|v| (v as f32).clamp(0.0, 1.0)));
        parts.colours = materials.iter().map(colour).chain([NO_MATERIAL]).collect();
    }
    // `tobj` keeps the faces in their order.
    let mut large_faces = large_faces.into_iter();
    for mesh in models.iter().map(|m| &m.mesh) {
        append(mesh, &mut large_faces, &mut parts)?;
    }
    Ok(parts)
}

/// Positions of its vertices, in the order of their lines. It may have vertices alone; what else it has must be right.
pub(super) fn positions(bytes: &[u8]) -> Result<Vec<[f64; 3]>, Fault> {
    let mut checker = Checker { positions: Some(Vec::new()), ..Checker::default() };
    checker.lines(bytes)?;
    Ok(checker.positions.unwrap_or_default())
}

/// Names of the material libraries.
pub(super) fn libraries(bytes: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(bytes);
    let names =
        text.lines().filter_map(|line| line.trim_start().strip_prefix("mtllib")).filter(|rest| rest.starts_with(char::is_whitespace));
    names.map(|name| name.trim().to_owned()).filter(|name| !name.is_empty()).collect()
}

/// Adds an object; `large_faces` are the lines of those that may be refused.
fn append(mesh: &tobj::Mesh, large_faces: &mut impl Iterator<Item = usize>, parts: &mut Parts) -> Result<(), Fault> {
    let base = parts.positions.len() as u32;
    parts.positions.extend(mesh.positions.chunks_exact(3).map(|p| [p[0], p[1], p[2]]));
    let arities = if mesh.face_arities.is_empty() { &vec![3; mesh.indices.len() / 3] } else { &mesh.face_arities };
    let normal = |corner: usize| {
        let at = mesh.normal_indices.get(corner).map_or(0, |&n| 3 * n as usize);
        mesh.normals.get(at..at + 3).map_or([0.0; 3], |n| unit([n[0], n[1], n[2]]))
    };
    let texture = |corner: usize| {
        let at = mesh.texcoord_indices.get(corner).map_or(0, |&n| 2 * n as usize);
        mesh.texcoords.get(at..at + 2).map_or([f32::NAN; 2], |uv| [uv[0] as f32, uv[1] as f32])
    };
    let mut first = 0;
    for &arity in arities {
        let Some(face) = mesh.indices.get(first..first + arity as usize) else { break };
        let corners: Vec<u32> = face.iter().map(|&i| base + i).collect();
        let line = if corners.len() > polygon::MAX_EARS { large_faces.next() } else { None };
        let cut = parts.polygon(&corners, |parts, tri| {
            if !mesh.normals.is_empty() {
                parts.normals.push(tri.map(|k| normal(first + k)));
            }
            if !mesh.texcoords.is_empty() {
                parts.texture.push(tri.map(|k| texture(first + k)));
            }
        });
        cut.or_else(|what| fault(line.map_or("faces".to_owned(), |line| format!("line {line}")), what))?;
        first += face.len();
    }
    if !parts.colours.is_empty() {
        let none = parts.colours.len() - 1;
        parts.materials.resize(parts.triangles.len(), mesh.material_id.map_or(none, |m| m.min(none)) as u16);
    }
    Ok(())
}

/// Checks all lines and writes out those that a mesh needs in a form that `tobj` reads the same way: indices counted from the beginning and, if the
/// file has normals or texture coordinates at all, one for every corner, the first (zero, or no numbers) where there is none.
#[derive(Default)]
struct Checker {
    out: String,
    /// Where vertices are, if that is all that is asked for: then nothing is written out.
    positions: Option<Vec<[f64; 3]>>,
    has_normals: bool,
    has_texture: bool,
    /// Positions, texture coordinates and normals so far, at their places in [`KINDS`].
    counts: [i64; 3],
    faces: usize,
    /// Lines of faces with more than [`polygon::MAX_EARS`] corners.
    large_faces: Vec<usize>,
    /// Normals that are not finite, and lines of [`OTHERS`].
    lost_normals: usize,
    others: usize,
    /// The largest index ahead of its vertex so far, and its line: legal as long as the vertex comes before the object ends.
    ahead: [(i64, usize); 3],
}

/// The lines that `tobj` reads, and what is lost.
struct Checked {
    text: String,
    large_faces: Vec<usize>,
    lost_normals: usize,
    others: usize,
}

impl Checker {
    /// The lines, and what is lost.
    fn check(mut self, bytes: &[u8]) -> Result<Checked, Fault> {
        let last = self.lines(bytes)?;
        if self.faces == 0 {
            return fault(format_args!("line {last}"), "the file ends without a face (no line begins with f)");
        }
        Ok(Checked { text: self.out, large_faces: self.large_faces, lost_normals: self.lost_normals, others: self.others })
    }

    /// Checks all lines, and says how many there are.
    fn lines(&mut self, bytes: &[u8]) -> Result<usize, Fault> {
        if let Some(at) = bytes.iter().position(|&b| b == 0) {
            let line = 1 + bytes[..at].iter().filter(|&&b| b == b'\n').count();
            return fault(format_args!("line {line}"), "this is not text");
        }
        let text = String::from_utf8_lossy(bytes);
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        self.has_normals = text.lines().any(|line| line.trim_start().starts_with("vn"));
        if self.has_normals {
            self.out.push_str("vn 0 0 0\n");
        }
        self.has_texture = text.lines().any(|line| line.trim_start().starts_with("vt"));
        if self.has_texture {
            self.out.push_str("vt nan nan\n");
        }
        let mut joined = String::new();
        let mut last = 0;
        for (line, number) in text.lines().zip(1usize..) {
            last = number;
            let at = |what| Fault { place: format!("line {number}"), what };
            // A comment ends with its line, whatever it ends in: names of folders do in back-slashes.
            let is_comment = joined.is_empty() && line.trim_start().starts_with('#');
            if let Some(begun) = line.trim_end().strip_suffix('\\').filter(|_| !is_comment) {
                joined.push_str(begun);
                joined.push(' ');
                continue;
            }
            joined.push_str(line);
            self.line(&joined, number).map_err(at)?;
            joined.clear();
            if self.positions.is_some() {
                self.out.clear();
            }
        }
        if !joined.is_empty() {
            return fault(format_args!("line {last}"), "the file ends in the middle of a continued line");
        }
        for (kind, name) in KINDS.iter().enumerate() {
            let (index, line) = self.ahead[kind];
            if index > self.counts[kind] {
                let what = format_args!("{name} index {index} is out of range, the file has {}", self.counts[kind]).to_string();
                return fault(format_args!("line {line}"), what);
            }
        }
        Ok(last)
    }

    fn line(&mut self, line: &str, number: usize) -> Result<(), String> {
        let mut words = line.split_whitespace();
        let key = words.next().unwrap_or("");
        let words: Vec<&str> = words.take_while(|w| !w.starts_with('#')).collect();
        match key {
            "v" => self.position(&words),
            "vn" => self.normal(&words),
            "vt" => {
                self.texture(&words);
                Ok(())
            }
            "f" => self.face(&words, number),
            "o" | "g" | "usemtl" | "mtllib" => {
                // Names may hold spaces, and `tobj` looks for them after exactly one.
                let name = line.trim_start()[key.len()..].trim();
                if !name.is_empty() {
                    _ = writeln!(self.out, "{key} {name}");
                }
                Ok(())
            }
            _ => {
                self.others += usize::from(OTHERS.contains(&key));
                Ok(())
            }
        }
    }

    fn position(&mut self, words: &[&str]) -> Result<(), String> {
        // x y z, x y z w, or x y z with a colour, which is not kept.
        if !matches!(words.len(), 3 | 4 | 6 | 7) {
            return Err(format!("v needs 3 coordinates, found {} numbers", words.len()));
        }
        let kept = if words.len() == 4 { 4 } else { 3 };
        let values: Vec<f64> = words[..kept].iter().map(|w| number("v", w)).collect::<Result<_, _>>()?;
        let weight = if words.len() == 4 { values[3] } else { 1.0 };
        let position = [0, 1, 2].map(|k| values[k] / weight);
        if weight == 0.0 || !position.iter().all(|&v| is_coordinate(v)) {
            return Err(format!("v: {} is not a usable position", shown(&words.join(" "))));
        }
        if let Some(positions) = &mut self.positions {
            positions.push(position);
        }
        _ = writeln!(self.out, "v {}", words[..kept].join(" "));
        self.counts[0] += 1;
        Ok(())
    }

    fn normal(&mut self, words: &[&str]) -> Result<(), String> {
        if words.len() != 3 {
            return Err(format!("vn needs 3 numbers, found {}", words.len()));
        }
        let values: Vec<f64> = words.iter().map(|w| any_number("vn", w)).collect::<Result<_, _>>()?;
        // A normal without a direction is none; `tobj` need not see what it was.
        let usable = values.iter().all(|v| v.is_finite());
        self.lost_normals += usize::from(!usable);
        _ = if usable { writeln!(self.out, "vn {}", words.join(" ")) } else { writeln!(self.out, "vn 0 0 0") };
        self.counts[NORMAL] += 1;
        Ok(())
    }

    /// What is no pair of numbers is none: few read them.
    fn texture(&mut self, words: &[&str]) {
        let [u, v] = [0, 1].map(|k| words.get(k).map_or(Ok(0.0), |word| word.parse::<f32>()).unwrap_or(f32::NAN));
        let usable = !words.is_empty() && u.is_finite() && v.is_finite();
        _ = if usable { writeln!(self.out, "vt {u} {v}") } else { writeln!(self.out, "vt nan nan") };
        self.counts[TEXTURE] += 1;
    }

    fn face(&mut self, words: &[&str], line: usize) -> Result<(), String> {
        if words.len() < 3 {
            return Err(format!("f needs 3 vertices or more, found {}", words.len()));
        }
        self.out.push('f');
        for word in words {
            let mut parts = word.split('/');
            let mut indices = [0; 3];
            for (kind, index) in indices.iter_mut().enumerate() {
                let Some(part) = parts.next() else { break };
                if kind == VERTEX || !part.is_empty() {
                    *index = self.index(kind, part, word, line)?;
                }
            }
            if parts.next().is_some() {
                return Err(format!("f: {} has more than three indices", shown(word)));
            }
            let [vertex, texture, normal] = indices;
            // Behind what comes first and is none.
            let (texture, normal) = (texture + 1, normal + 1);
            _ = match (self.has_texture, self.has_normals) {
                (false, false) => write!(self.out, " {vertex}"),
                (false, true) => write!(self.out, " {vertex}//{normal}"),
                (true, false) => write!(self.out, " {vertex}/{texture}"),
                (true, true) => write!(self.out, " {vertex}/{texture}/{normal}"),
            };
        }
        self.out.push('\n');
        self.faces += 1;
        if words.len() > polygon::MAX_EARS {
            self.large_faces.push(line);
        }
        Ok(())
    }

    /// The index counted from 1.
    fn index(&mut self, kind: usize, part: &str, word: &str, line: usize) -> Result<i64, String> {
        let name = KINDS[kind];
        let Ok(index) = part.parse::<i64>() else {
            return Err(format!("f: {} has no valid {name} index", shown(word)));
        };
        let count = self.counts[kind];
        if kind == TEXTURE {
            // Few need them: one that did not come before is none.
            let index = if index < 0 { count.saturating_add(1).saturating_add(index) } else { index };
            return Ok(if (1..=count).contains(&index) { index } else { 0 });
        }
        if kind == NORMAL && !self.has_normals {
            // What is named in a file without normals does not matter, and may be any number.
            return Ok(0);
        }
        if index == 0 || index < -count || index > i64::from(u32::MAX) {
            return Err(format!("f: {name} index {index} is out of range, {count} came before it"));
        }
        if index > count && index > self.ahead[kind].0 {
            self.ahead[kind] = (index, line);
        }
        Ok(if index < 0 { count + 1 + index } else { index })
    }
}

fn number(key: &str, word: &str) -> Result<f64, String> {
    any_number(key, word).and_then(|v| if v.is_finite() { Ok(v) } else { Err(format!("{key}: {} is not finite", shown(word))) })
}

/// Infinite and NaN are taken, as C libraries write them too: `nan(ind)`, `-1.#IND`, `1.#INF`.
fn any_number(key: &str, word: &str) -> Result<f64, String> {
    let plain = word.trim_start_matches(['-', '+']).to_ascii_lowercase();
    if plain.starts_with("nan(") && plain.ends_with(')') || plain.starts_with("1.#") {
        return Ok(f64::NAN);
    }
    word.parse().map_err(|_| format!("{key}: {} is not a number", shown(word)))
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
