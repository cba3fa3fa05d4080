//! Arrays of numbers in a glTF file's buffers. Offsets, strides and counts are the file's word: none is believed before it fits the bytes.

use super::super::{Fault, fault};
use super::buffers::Buffers;
use ::gltf::json::accessor::{Accessor, ComponentType, Type};
use ::gltf::json::buffer::View;
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, Root};
use std::path::Path;

/// Most positions or indices of an accessor that has no bytes for them: all but a few are zero, so that few words can ask for much memory.
pub(super) const MAX_ZEROS: usize = 1 << 16;

pub(super) struct Reader<'a> {
    root: &'a Root,
    buffers: Buffers<'a>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(root: &'a Root, bin: Option<&'a [u8]>, folder: &'a Path) -> Self {
        Reader { root, buffers: Buffers::new(root, bin, folder) }
    }

    /// Positions or normals; at most `zeros` if the accessor has no bytes for them.
    pub(super) fn vectors(&self, index: Index<Accessor>, zeros: usize, place: &str) -> Result<Vec<[f64; 3]>, Fault> {
        self.rows(index, (Type::Vec3, "VEC3"), zeros, place)
    }

    /// Texture coordinates; at most `zeros` if the accessor has no bytes for them.
    pub(super) fn pairs(&self, index: Index<Accessor>, zeros: usize, place: &str) -> Result<Vec<[f64; 2]>, Fault> {
        self.rows(index, (Type::Vec2, "VEC2"), zeros, place)
    }

    /// Rows of four, such as rotations and weights of joints; at most `zeros` if the accessor has no bytes for them.
    pub(super) fn fours(&self, index: Index<Accessor>, zeros: usize, place: &str) -> Result<Vec<[f64; 4]>, Fault> {
        self.rows(index, (Type::Vec4, "VEC4"), zeros, place)
    }

    /// Joints of vertices, four for each; at most `zeros` if the accessor has no bytes for them.
    pub(super) fn joints(&self, index: Index<Accessor>, zeros: usize, place: &str) -> Result<Vec<[u32; 4]>, Fault> {
        let rows = self.whole(index, (Type::Vec4, "VEC4"), zeros);
        rows.or_else(|what| fault(place, format_args!("accessor {}: {what}", index.value())))
    }

    /// Matrices, column by column; at most `zeros` if the accessor has no bytes for them.
    pub(super) fn matrices(&self, index: Index<Accessor>, zeros: usize, place: &str) -> Result<Vec<[f64; 16]>, Fault> {
        self.rows(index, (Type::Mat4, "MAT4"), zeros, place)
    }

    /// Numbers; at most `zeros` if the accessor has no bytes for them.
    pub(super) fn scalars(&self, index: Index<Accessor>, zeros: usize, place: &str) -> Result<Vec<f64>, Fault> {
        Ok(self.rows::<1>(index, (Type::Scalar, "SCALAR"), zeros, place)?.into_flattened())
    }

    /// Rows of N numbers, which is what the type says.
    fn rows<const N: usize>(
        &self,
        index: Index<Accessor>,
        (kind, name): (Type, &str),
        zeros: usize,
        place: &str,
    ) -> Result<Vec<[f64; N]>, Fault> {
        let read = || {
            let accessor = self.accessor(index)?;
            if accessor.type_ != Checked::Valid(kind) {
                return Err(format!("it is not of type {name}"));
            }
            self.items::<N>(accessor, component(accessor)?, zeros)
        };
        read().or_else(|what: String| fault(place, format_args!("accessor {}: {what}", index.value())))
    }

    /// Indices of vertices below `count`.
    pub(super) fn indices(&self, index: Index<Accessor>, count: usize, place: &str) -> Result<Vec<u32>, Fault> {
        let read = || {
            let indices = self.whole::<1>(index, (Type::Scalar, "SCALAR"), MAX_ZEROS)?.into_flattened();
            if let Some((i, v)) = indices.iter().enumerate().find(|(_, v)| **v as usize >= count) {
                return Err(format!("item {i}: vertex index {v} is out of range, there are {count} vertices"));
            }
            Ok(indices)
        };
        read().or_else(|what: String| fault(place, format_args!("accessor {}: {what}", index.value())))
    }

    /// Rows of N numbers that say which: any but whole ones without a sign would be cut to others.
    fn whole<const N: usize>(&self, index: Index<Accessor>, (kind, name): (Type, &str), zeros: usize) -> Result<Vec<[u32; N]>, String> {
        let accessor = self.accessor(index)?;
        let of = component(accessor)?;
        let is_unsigned = matches!(of, ComponentType::U8 | ComponentType::U16 | ComponentType::U32);
        if accessor.type_ != Checked::Valid(kind) || !is_unsigned || accessor.normalized {
            return Err(format!("it must be {name}, of 8, 16 or 32 bits without a sign and not normalized"));
        }
        let rows = self.items::<N>(accessor, of, zeros)?;
        Ok(rows.into_iter().map(|row| row.map(|v| v as u32)).collect())
    }

    fn accessor(&self, index: Index<Accessor>) -> Result<&'a Accessor, String> {
        self.root.accessors.get(index.value()).ok_or_else(|| "it is not there".into())
    }

    fn items<const N: usize>(&self, accessor: &Accessor, kind: ComponentType, zeros: usize) -> Result<Vec<[f64; N]>, String> {
        let count = accessor.count.0;
        let decode = |bytes: &[u8]| -> [f64; N] { std::array::from_fn(|k| number(kind, accessor.normalized, &bytes[k * kind.size()..])) };
        let mut items: Vec<[f64; N]> = match accessor.buffer_view {
            Some(view) => self.bytes(view, accessor.byte_offset.map_or(0, |o| o.0), count, N * kind.size())?.map(decode).collect(),
            None if accessor.sparse.is_none() => return Err("it has no bytes (no buffer view)".into()),
            None if count > zeros as u64 => return Err(format!("it has no bytes for its {count} items")),
            None => vec![[0.0; N]; count as usize],
        };
        if let Some(sparse) = &accessor.sparse {
            let Checked::Valid(index_kind) = sparse.indices.component_type else {
                return Err("its sparse indices have a component type that is not known".into());
            };
            let places = self.bytes(sparse.indices.buffer_view, sparse.indices.byte_offset.0, sparse.count.0, index_kind.0.size())?;
            let values = self.bytes(sparse.values.buffer_view, sparse.values.byte_offset.0, sparse.count.0, N * kind.size())?;
            for (place, value) in places.zip(values) {
                let place = number(index_kind.0, false, place) as usize;
                let Some(item) = items.get_mut(place) else {
                    return Err(format!("sparse index {place} is out of range, there are {count} items"));
                };
                *item = decode(value);
            }
        }
        Ok(items)
    }

    /// The bytes of each of `count` items of `size` bytes.
    fn bytes(&self, view: Index<View>, offset: u64, count: u64, size: usize) -> Result<impl Iterator<Item = &[u8]>, String> {
        let number = view.value();
        let Some(view) = self.root.buffer_views.get(number) else { return Err(format!("buffer view {number} is not there")) };
        let buffer = self.buffers.get(view.buffer.value())?;
        let outside = |what, of| format!("{what} of {of} {number} is outside of its buffer, which has {} bytes", buffer.len());
        let (begin, length) = (view.byte_offset.map_or(0, |o| o.0), view.byte_length.0);
        let end = begin.checked_add(length).filter(|&end| end <= buffer.len() as u64).ok_or_else(|| outside("the end", "buffer view"))?;
        // 0 stands for none.
        let stride = view.byte_stride.map_or(size, |s| if s.0 == 0 { size } else { s.0 });
        if stride < size {
            return Err(format!("buffer view {number}: a stride of {stride} bytes is too short for items of {size}"));
        }
        let Some(last) = count.checked_sub(1) else { return Err("it has no items".into()) };
        let used = last.checked_mul(stride as u64).and_then(|n| n.checked_add(offset)?.checked_add(size as u64));
        if used.is_none_or(|n| n > length) {
            return Err(format!("{count} items from byte {offset} on are more than the {length} bytes of buffer view {number}"));
        }
        let items = &buffer[(begin + offset) as usize..end as usize];
        Ok(items.chunks(stride).take(count as usize).map(move |item| &item[..size]))
    }
}

fn component(accessor: &Accessor) -> Result<ComponentType, String> {
    match accessor.component_type {
        Checked::Valid(kind) => Ok(kind.0),
        Checked::Invalid => Err("its component type is not known".into()),
    }
}

/// The first number of `bytes`, which has enough for one.
fn number(kind: ComponentType, normalized: bool, bytes: &[u8]) -> f64 {
    let (value, most) = match kind {
        ComponentType::I8 => (f64::from(bytes[0] as i8), f64::from(i8::MAX)),
        ComponentType::U8 => (f64::from(bytes[0]), f64::from(u8::MAX)),
        ComponentType::I16 => (f64::from(i16::from_le_bytes([bytes[0], bytes[1]])), f64::from(i16::MAX)),
        ComponentType::U16 => (f64::from(u16::from_le_bytes([bytes[0], bytes[1]])), f64::from(u16::MAX)),
        ComponentType::U32 => (f64::from(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])), f64::from(u32::MAX)),
        ComponentType::F32 => return f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]).into(),
    };
    // The least of a signed type lies a little below -1.
    if normalized { (value / most).max(-1.0) } else { value }
}
