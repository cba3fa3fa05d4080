//! Positions of vertices alone, in the order of a file: for meshes of which everything else is known.

use super::header::{floats, open_array, shape_and_type};
use super::{MeshFormat, ReadError, is_device, ply};
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

/// Reads them: `.npy`, an array of vertices x 3 or frames x vertices x 3 floats; `.obj`, its `v` lines; `.ply`, its vertices. Nothing is welded and nothing left out.
///
/// # Errors
/// The file cannot be read, or holds something else: it, and line or element, are named.
pub fn read_positions(path: &Path) -> Result<PositionFrames, ReadError> {
    let io = |source| ReadError::Io { path: path.into(), source };
    let content = |place: String, what: String| ReadError::Content { path: path.into(), place, what };
    let is_array = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("npy"));
    let format = MeshFormat::of(path);
    if !is_array && !matches!(format, Some(MeshFormat::Obj | MeshFormat::Ply)) {
        return Err(content("name".into(), "positions are read from .npy, .obj or .ply".into()));
    }
    let bytes = if is_device(path) { Err(Error::other("it is a device, not a file")) } else { std::fs::read(path) }.map_err(io)?;
    if is_array {
        return array(&bytes).map_err(|what| content("array".into(), what));
    }
    let positions = match format {
        Some(MeshFormat::Obj) => lines(&bytes).map_err(|(line, what)| content(format!("line {line}"), what))?,
        _ => ply::parse(&bytes, Path::new("")).map_err(|fault| content(fault.place, fault.what))?.positions,
    };
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

/// The `v` lines of an OBJ; the error has the line's number.
fn lines(bytes: &[u8]) -> Result<Vec<[f64; 3]>, (usize, String)> {
    let text = String::from_utf8_lossy(bytes);
    let vertices = text.lines().zip(1..).filter_map(|(line, number)| {
        let mut words = line.split_whitespace();
        (words.next() == Some("v")).then(|| {
            let mut next = || words.next().and_then(|word| word.parse().ok());
            match (next(), next(), next()) {
                (Some(x), Some(y), Some(z)) => Ok([x, y, z]),
                _ => Err((number, "a vertex needs three numbers".to_owned())),
            }
        })
    });
    vertices.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_of_an_obj_keep_their_order_and_their_doubles() {
        let read = lines(b"o a\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nvn 0 0 1\nv 1 0 0\nf 3 1 2\nv 1e-3 -2 .5\n");
        assert_eq!(read, Ok(vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1e-3, -2.0, 0.5]]));
        assert_eq!(lines(b"v 0 0 0\nv 0 0\n").unwrap_err().0, 2);
        assert_eq!(lines(b"v 0 x 0\n").unwrap_err().0, 1);
    }
}
