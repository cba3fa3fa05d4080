//! Positions of vertices alone, in the order of a file: for meshes of which everything else is known.

use super::header::{floats, open_array, shape_and_type};
use super::{Fault, MeshFormat, ReadError, fault, is_device, obj, ply};
use npyz::{DType, Order, TypeChar};
use std::io::Error;
use std::path::Path;

/// Positions of one frame after the other, as many in each.
#[derive(Clone, Debug, PartialEq)]
pub struct PositionFrames {
    /// All of them.
    pub positions: Vec<[f64; 3]>,
    /// How many make a frame.
    pub vertices: usize,
    /// Whether the file counts frames: an array of three dimensions does.
    pub is_sequence: bool,
}

/// Reads them: `.npy`, an array of vertices x 3 or frames x vertices x 3 floats; `.obj`, its `v` lines, which need no faces beside them; `.ply`, its vertices. OBJ and PLY are read as by [`read`](super::read), but nothing is welded and nothing left out.
///
/// # Errors
/// The file cannot be read, or holds something else: it, and line or element, are named.
pub fn read_positions(path: &Path) -> Result<PositionFrames, ReadError> {
    let io = |source| ReadError::Io { path: path.into(), source };
    let content = |Fault { place, what }| ReadError::Content { path: path.into(), place, what };
    let is_array = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("npy"));
    let format = MeshFormat::of(path);
    if !is_array && !matches!(format, Some(MeshFormat::Obj | MeshFormat::Ply)) {
        return fault("name", "positions are read from .npy, .obj or .ply").map_err(content);
    }
    let bytes = if is_device(path) { Err(Error::other("it is a device, not a file")) } else { std::fs::read(path) }.map_err(io)?;
    if is_array {
        return array(&bytes).or_else(|what| fault("array", what)).map_err(content);
    }
    let positions = match format {
        Some(MeshFormat::Obj) => obj::positions(&bytes),
        _ => ply::parse(&bytes, Path::new("")).map(|parts| parts.positions),
    };
    let positions = positions.map_err(content)?;
    Ok(PositionFrames { vertices: positions.len(), positions, is_sequence: false })
}

fn array(bytes: &[u8]) -> Result<PositionFrames, String> {
    let file = open_array(bytes).map_err(|error| error.to_string())?;
    let (shape, order, dtype) = (file.shape().to_vec(), file.order(), file.dtype());
    let size = match &dtype {
        DType::Plain(of) if of.type_char() == TypeChar::Float => of.size_field(),
        _ => 0,
    };
    let (frames, vertices, is_sequence) = match shape[..] {
        [vertices, 3] => (1, vertices, false),
        [frames, vertices, 3] => (frames, vertices, true),
        _ => (0, 0, false),
    };
    if ![4, 8].contains(&size) || frames == 0 || order != Order::C {
        let order = if order == Order::C { "" } else { ", in Fortran's order" };
        return Err(format!(
            "{}{order}, where positions are vertices x 3 or frames x vertices x 3 floats (float32 or float64) in C's order",
            shape_and_type(&file)
        ));
    }
    let values = floats(file, size).map_err(|error| error.to_string())?;
    // As many as the shape says: the reader has seen to it.
    Ok(PositionFrames { positions: values.as_chunks::<3>().0.to_vec(), vertices: vertices as usize, is_sequence })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_of_an_obj_keep_their_order_and_their_doubles() {
        let read = obj::positions(b"o a\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nvn 0 0 1\nv 1 0 0\nf 3 1 2\nv 1e-3 -2 .5\n").unwrap();
        assert_eq!(read, [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1e-3, -2.0, 0.5]]);
        // A mark of the byte order, a weight, a line that goes on.
        assert_eq!(obj::positions("\u{feff}v 2 4 6 2\nv 1 \\\n 2 3\n".as_bytes()).unwrap(), [[1.0, 2.0, 3.0]; 2]);
        let bad =
            [("v 0 0 0\nv 0 0\n", 2), ("v 0 x 0\n", 1), ("v 0 0 \\\n0\nv 1 2 3 junk\n", 3), ("v 0 nan 0\n", 1), ("v 0 0 0\nf 1 1 2\n", 2)];
        for (text, line) in bad {
            assert_eq!(obj::positions(text.as_bytes()).unwrap_err().place, format!("line {line}"), "{text}");
        }
    }
}
