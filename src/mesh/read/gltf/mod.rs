//! glTF 2.0, as JSON or GLB. `gltf` parses both; its own checks and readers are not used: they panic on some bad files, and refuse good ones
//! whose attributes are quantised or their makers' own. So every reference is looked up here with care, and only what a mesh needs.

mod accessor;
mod buffers;
mod moving;
mod nodes;
mod placed;

use super::super::clean::{is_coordinate, unit};
use super::{Fault, Parts, fault, shown};
use ::gltf::json::mesh::{Mode, Primitive, Semantic};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, Root};
use accessor::{MAX_ZEROS, Reader};
use glam::{DMat3, DVec3};
pub(super) use moving::{MovingParts, parse_moving};
use nodes::Placed;
pub(super) use placed::parse_placed;
use std::path::Path;

const MAGIC: &[u8] = b"glTF";

/// Colour of what has no material, as the format has it.
const NO_MATERIAL: [f32; 3] = [1.0; 3];

/// A small file can place a mesh many times, and give each the colours of all its materials: more vertices, triangles or colours than this are refused.
const MAX_ITEMS: usize = 1 << 28;

pub(super) fn parse(bytes: &[u8], folder: &Path) -> Result<Parts, Fault> {
    if bytes.starts_with(MAGIC) { parse_binary(bytes, folder) } else { build(bytes, None, folder) }
}

pub(super) fn parse_binary(bytes: &[u8], folder: &Path) -> Result<Parts, Fault> {
    in_binary(bytes, |json, bin| build(json, bin, folder))
}

/// Hands the JSON and the binary chunk of a GLB file on.
fn in_binary<T>(bytes: &[u8], then: impl FnOnce(&[u8], Option<&[u8]>) -> Result<T, Fault>) -> Result<T, Fault> {
    if !bytes.starts_with(MAGIC) {
        return fault("header", "this is not a GLB file: it does not begin with 'glTF'");
    }
    // The crate takes the header's 12 bytes from this without a check.
    let length = bytes.get(8..12).and_then(|b| b.first_chunk()).map_or(0, |&b| u32::from_le_bytes(b));
    if length < 12 {
        return fault("header", "the file ends here, or its length in the header is too small");
    }
    match ::gltf::Glb::from_slice(bytes) {
        Ok(glb) => then(&glb.json, glb.bin.as_deref()),
        Err(::gltf::Error::Binary(error)) => fault("header", glb_fault(&error)),
        Err(error) => fault("header", error),
    }
}

/// Names of the files that hold its buffers.
pub(super) fn files(bytes: &[u8]) -> Vec<String> {
    // Its head is checked when it is read.
    let json = if bytes.starts_with(MAGIC) { bytes.get(20..).unwrap_or_default() } else { bytes };
    // What follows the JSON in a GLB file is of no concern.
    let root = serde_json::Deserializer::from_slice(json).into_iter::<Root>().next().and_then(Result::ok);
    let buffers = root.map_or_else(Vec::new, |root| root.buffers);
    buffers.iter().filter_map(|buffer| buffers::file_name(buffer.uri.as_deref()?)).collect()
}

fn glb_fault(error: &::gltf::binary::Error) -> String {
    use ::gltf::binary::{ChunkType, Error};
    let chunk = |ty: &ChunkType| if matches!(ty, ChunkType::Json) { "JSON" } else { "binary" };
    match error {
        Error::Version(version) => format!("version {version} is not known: 2 is"),
        Error::Length { length, length_read } => {
            format!("{length} bytes follow according to it, the file has {length_read}")
        }
        Error::ChunkLength { ty, length, length_read } => {
            format!("the {} chunk has {length} bytes according to its head, the file has {length_read}", chunk(ty))
        }
        Error::ChunkType(ty) => format!("a {} chunk is at the wrong place", chunk(ty)),
        Error::UnknownChunkType(_) => "a chunk is neither JSON nor binary".into(),
        Error::Io(_) => "the file ends within the head of a chunk".into(),
        Error::Magic(_) => "this is not a GLB file".into(),
    }
}

fn build(json: &[u8], bin: Option<&[u8]>, folder: &Path) -> Result<Parts, Fault> {
    let root = root(json)?;
    let reader = Reader::new(&root, bin, folder);
    let mut builder = Builder::new(&root, &reader);
    let mut skins = 0;
    for placed in nodes::placed(&root)? {
        skins += usize::from(placed.has_skin);
        builder.mesh(&placed)?;
    }
    let mut parts = builder.finish();
    parts.warnings.extend(skinned(skins));
    if parts.triangles.is_empty() {
        return fault("scene", "there are no triangles in it");
    }
    Ok(parts)
}

/// The file's JSON, checked as far as anything here needs it.
fn root(json: &[u8]) -> Result<Root, Fault> {
    let root: Root = ::gltf::json::deserialize::from_slice(json).or_else(|error| {
        let text = error.to_string();
        let what = text.rsplit_once(" at line ").map_or(text.as_str(), |(what, _)| what);
        fault(format_args!("JSON, line {}, column {}", error.line(), error.column()), shown(what))
    })?;
    check_asset(&root)?;
    if root.materials.len() >= usize::from(u16::MAX) {
        return fault("materials", format_args!("{} are more than the 65534 that can be kept", root.materials.len()));
    }
    Ok(root)
}

/// A line for nodes whose skins are not applied, if there are any.
fn skinned(skins: usize) -> Option<String> {
    let nodes = if skins == 1 { "a node".into() } else { format!("{skins} nodes") };
    (skins > 0).then(|| format!("{nodes} with joints (skin): they are not applied, the mesh is in its rest pose"))
}

fn check_asset(root: &Root) -> Result<(), Fault> {
    if !root.asset.version.starts_with("2.") {
        return fault("asset", format_args!("version '{}' is not known: 2.0 is", shown(&root.asset.version)));
    }
    for name in &root.extensions_required {
        match name.as_str() {
            // Read, or of no concern to triangles and base colours.
            "KHR_mesh_quantization" | "KHR_lights_punctual" | "KHR_animation_pointer" | "MSFT_texture_dds" => {}
            _ if ["KHR_materials_", "KHR_texture_", "EXT_texture_"].iter().any(|prefix| name.starts_with(prefix)) => {}
            _ => {
                let compressed = if name.contains("compression") { " (the mesh is compressed)" } else { "" };
                let what = format!("the file needs {}, which is not read{compressed}", shown(name));
                return fault("extensionsRequired", what);
            }
        }
    }
    Ok(())
}

/// Builds the meshes of a file, one by one or all as one.
struct Builder<'a> {
    root: &'a Root,
    reader: &'a Reader<'a>,
    /// Vertices, triangles and colours that the file may still have, in all meshes together.
    left: [usize; 3],
    /// What [`Self::finish`] hands out, without colours.
    parts: Parts,
    has_normals: bool,
    has_texture: bool,
    /// Primitives of points and lines.
    others: usize,
}

impl<'a> Builder<'a> {
    /// Nothing yet.
    fn new(root: &'a Root, reader: &'a Reader<'a>) -> Self {
        Self { root, reader, left: [MAX_ITEMS; 3], parts: Parts::default(), has_normals: false, has_texture: false, others: 0 }
    }

    /// Counts vertices, triangles and colours that are to be kept.
    fn take(&mut self, items: [usize; 3], place: &str) -> Result<(), Fault> {
        for (left, items) in self.left.iter_mut().zip(items) {
            let Some(rest) = left.checked_sub(items) else {
                return fault(place, format_args!("with it there are more than {MAX_ITEMS} vertices, triangles or colours"));
            };
            *left = rest;
        }
        Ok(())
    }

    /// Adds a mesh where it is placed.
    fn mesh(&mut self, placed: &Placed) -> Result<(), Fault> {
        let Some(mesh) = self.root.meshes.get(placed.mesh) else {
            return fault(format_args!("node {}", placed.node), format_args!("mesh {} is not there", placed.mesh));
        };
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let place = format!("mesh {}, primitive {i}", placed.mesh);
            self.primitive(primitive, mesh.weights.as_deref(), placed, &place)?;
        }
        Ok(())
    }

    /// What was added since the last time, without what no primitive has.
    fn finish(&mut self) -> Parts {
        let mut parts = std::mem::take(&mut self.parts);
        if !self.root.materials.is_empty() {
            let colour = |factor: [f32; 4]| std::array::from_fn(|k| factor[k].clamp(0.0, 1.0));
            let own = self.root.materials.iter().map(|m| colour(m.pbr_metallic_roughness.base_color_factor.0));
            parts.colours = own.chain([NO_MATERIAL]).collect();
        }
        if !std::mem::take(&mut self.has_normals) {
            parts.normals = Vec::new();
        }
        if !std::mem::take(&mut self.has_texture) {
            parts.texture = Vec::new();
        }
        let others = std::mem::take(&mut self.others);
        if others > 0 {
            parts.warnings.push(format!("{others} of its primitives are points or lines: only triangles are kept"));
        }
        parts
    }

    fn primitive(&mut self, primitive: &Primitive, weights: Option<&[f32]>, placed: &Placed, place: &str) -> Result<(), Fault> {
        if !is_triangles(primitive) {
            self.others += 1;
            return Ok(());
        }
        let Checked::Valid(mode) = primitive.mode else { return fault(place, "its mode is not known") };
        let Some(&positions) = primitive.attributes.get(&Checked::Valid(Semantic::Positions)) else {
            return fault(place, "it has no attribute POSITION");
        };
        let mut positions = self.reader.vectors(positions, MAX_ZEROS, &format!("{place}, POSITION"))?;
        let mut normals = match primitive.attributes.get(&Checked::Valid(Semantic::Normals)) {
            Some(&normals) => Some(self.reader.vectors(normals, positions.len(), &format!("{place}, NORMAL"))?),
            None => None,
        };
        if let Some(n) = normals.as_ref().filter(|n| n.len() != positions.len()) {
            return fault(place, format_args!("it has {} positions and {} normals", positions.len(), n.len()));
        }
        let texture = match primitive.attributes.get(&Checked::Valid(Semantic::TexCoords(0))) {
            Some(&texture) => Some(self.reader.pairs(texture, positions.len(), &format!("{place}, TEXCOORD_0"))?),
            None => None,
        };
        if let Some(t) = texture.as_ref().filter(|t| t.len() != positions.len()) {
            return fault(place, format_args!("it has {} positions and {} texture coordinates", positions.len(), t.len()));
        }
        let weights = placed.weights.as_deref().or(weights);
        self.morph(primitive, weights.unwrap_or_default(), &mut positions, normals.as_deref_mut(), place)?;
        let corners = match primitive.indices {
            Some(indices) => self.reader.indices(indices, positions.len(), &format!("{place}, indices"))?,
            None => (0..positions.len() as u32).collect(),
        };
        let triangles = triangles(mode, &corners).or_else(|what| fault(place, what))?;
        let material = self.material(primitive.material, place)?;
        self.take([positions.len(), triangles.len(), 0], place)?;
        self.append(&positions, normals.as_deref(), texture.as_deref(), &triangles, material, placed).or_else(|what| fault(place, what))
    }

    /// Moves positions and normals as the morph targets of a primitive say, each by its weight.
    fn morph(
        &mut self,
        primitive: &Primitive,
        weights: &[f32],
        positions: &mut [[f64; 3]],
        mut normals: Option<&mut [[f64; 3]]>,
        place: &str,
    ) -> Result<(), Fault> {
        let targets = primitive.targets.as_deref().unwrap_or_default();
        if !weights.is_empty() && weights.len() != targets.len() {
            let lost =
                format!("{place}: {} weights for {} morph targets: those without a partner are ignored", weights.len(), targets.len());
            self.parts.warnings.push(lost);
        }
        for (i, (target, &weight)) in targets.iter().zip(weights).enumerate().filter(|(_, (_, weight))| **weight != 0.0) {
            let add = |index: Option<Index<_>>, to: Option<&mut [[f64; 3]]>, name| {
                let (Some(index), Some(to)) = (index, to) else { return Ok(()) };
                let place = format!("{place}, target {i}, {name}");
                let by = self.reader.vectors(index, to.len(), &place)?;
                if by.len() != to.len() {
                    return fault(place, format_args!("it has {} items for {} vertices", by.len(), to.len()));
                }
                for (to, by) in to.iter_mut().zip(&by) {
                    (0..3).for_each(|d| to[d] += f64::from(weight) * by[d]);
                }
                Ok(())
            };
            add(target.positions, Some(positions), "POSITION")?;
            add(target.normals, normals.as_deref_mut(), "NORMAL")?;
        }
        Ok(())
    }

    fn material(&self, index: Option<Index<::gltf::json::Material>>, place: &str) -> Result<Option<u16>, Fault> {
        let count = self.root.materials.len();
        match index.map(|m| m.value()) {
            Some(m) if m >= count => fault(place, format_args!("material {m} is not there")),
            _ if count == 0 => Ok(None),
            // The last colour is that of no material.
            m => Ok(Some(m.unwrap_or(count) as u16)),
        }
    }

    fn append(
        &mut self,
        positions: &[[f64; 3]],
        normals: Option<&[[f64; 3]]>,
        texture: Option<&[[f64; 2]]>,
        triangles: &[[u32; 3]],
        material: Option<u16>,
        placed: &Placed,
    ) -> Result<(), String> {
        let parts = &mut self.parts;
        let first = parts.positions.len() as u32;
        for (i, &p) in positions.iter().enumerate() {
            let p = placed.transform.transform_point3(DVec3::from_array(p)).to_array();
            if let Some(v) = p.iter().find(|&&v| !is_coordinate(v)) {
                return Err(format!("vertex {i}, where node {} places it, has a coordinate {v:e} that cannot be used", placed.node));
            }
            parts.positions.push(p);
        }
        let (turn, mirrored) = turn_of_normals(DMat3::from_mat4(placed.transform));
        let normals: Option<Vec<[f32; 3]>> = normals.map(|n| n.iter().map(|&n| unit((turn * DVec3::from_array(n)).to_array())).collect());
        self.has_normals |= normals.is_some();
        self.has_texture |= texture.is_some();
        // The format's v leads down.
        let upwards = |[u, v]: [f64; 2]| [u as f32, (1.0 - v) as f32];
        for &triangle in triangles {
            let [a, b, c] = triangle;
            // A mirror image runs the other way around.
            let triangle = if mirrored { [a, c, b] } else { triangle };
            parts.triangles.push(triangle.map(|v| first + v));
            parts.normals.push(normals.as_ref().map_or([[0.0; 3]; 3], |n| triangle.map(|v| n[v as usize])));
            parts.texture.push(texture.map_or([[f32::NAN; 2]; 3], |t| triangle.map(|v| upwards(t[v as usize]))));
            parts.materials.extend(material);
        }
        Ok(())
    }
}

/// What takes normals along with positions, and whether it mirrors: the inverse transposed, but for its length, which a flat transform has too.
fn turn_of_normals(transform: DMat3) -> (DMat3, bool) {
    // Scaled first, so that products stay within the range of numbers.
    let size = transform.to_cols_array().iter().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
    let [a, b, c] = [transform.x_axis / size, transform.y_axis / size, transform.z_axis / size];
    let mirrored = a.dot(b.cross(c)) < 0.0;
    let sign = if mirrored { -1.0 } else { 1.0 };
    (DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b)) * sign, mirrored)
}

/// It has triangles, rather than points or lines.
fn is_triangles(primitive: &Primitive) -> bool {
    !matches!(primitive.mode, Checked::Valid(Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip))
}

fn triangles(mode: Mode, corners: &[u32]) -> Result<Vec<[u32; 3]>, String> {
    match mode {
        Mode::TriangleStrip => {
            let strip = corners.windows(3).enumerate();
            Ok(strip.map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] }).collect())
        }
        Mode::TriangleFan => Ok(corners.get(1..).unwrap_or(&[]).windows(2).map(|w| [corners[0], w[0], w[1]]).collect()),
        _ => match corners.as_chunks() {
            (triangles, []) => Ok(triangles.to_vec()),
            _ => Err(format!("{} corners are not a whole number of triangles", corners.len())),
        },
    }
}
