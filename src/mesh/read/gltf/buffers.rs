//! The bytes of a glTF file's buffers: within it or in files beside it, read when first asked for.

use super::super::{beside, shown};
use ::gltf::json::Root;
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;
use std::cell::OnceCell;
use std::path::Path;

/// What a URI begins with that holds the bytes themselves.
const DATA: &str = "data:";

pub(super) struct Buffers<'a> {
    root: &'a Root,
    bin: Option<&'a [u8]>,
    folder: &'a Path,
    loaded: Vec<OnceCell<Vec<u8>>>,
}

impl<'a> Buffers<'a> {
    /// `bin` is the binary chunk of a GLB file.
    pub(super) fn new(root: &'a Root, bin: Option<&'a [u8]>, folder: &'a Path) -> Self {
        Buffers { root, bin, folder, loaded: vec![OnceCell::new(); root.buffers.len()] }
    }

    /// All that the buffer is said to have.
    pub(super) fn get(&self, number: usize) -> Result<&[u8], String> {
        let Some(cell) = self.loaded.get(number) else { return Err(format!("buffer {number} is not there")) };
        if cell.get().is_none() {
            _ = cell.set(self.load(number).map_err(|what| format!("buffer {number}: {what}"))?);
        }
        Ok(cell.get().map_or(&[], Vec::as_slice))
    }

    fn load(&self, number: usize) -> Result<Vec<u8>, String> {
        let buffer = &self.root.buffers[number];
        let promised = buffer.byte_length.0;
        let mut bytes = match buffer.uri.as_deref() {
            None if number == 0 && self.bin.is_some() => self.bin.unwrap_or_default().to_vec(),
            None => return Err("it has no data: neither a URI nor the binary chunk of a GLB file".into()),
            Some(uri) if uri.starts_with(DATA) => embedded(&uri[DATA.len()..])?,
            Some(uri) => match file_name(uri) {
                Some(name) => self.beside(uri, &name, promised)?,
                None => return Err(format!("its URI '{}' is neither data nor a file beside the model", shown(uri))),
            },
        };
        if (bytes.len() as u64) < promised {
            return Err(format!("it has {} bytes, {promised} are promised", bytes.len()));
        }
        bytes.truncate(promised as usize);
        Ok(bytes)
    }

    fn beside(&self, uri: &str, name: &str, promised: u64) -> Result<Vec<u8>, String> {
        let path = beside::place(self.folder, name);
        beside::read(&path, promised, beside::LARGEST_BUFFER).map_err(|error| format!("its file '{}': {error}", shown(uri)))
    }
}

/// The file that a URI names, if it is one beside the model.
pub(super) fn file_name(uri: &str) -> Option<String> {
    (!uri.contains(':')).then(|| percent_decode_str(uri).decode_utf8_lossy().into_owned())
}

/// What follows `data:`.
fn embedded(text: &str) -> Result<Vec<u8>, String> {
    let Some((kind, data)) = text.split_once(',') else { return Err("its data URI has no comma".into()) };
    let bytes = percent_decode_str(data);
    if !kind.ends_with(";base64") {
        return Ok(bytes.collect());
    }
    let config = GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent).with_decode_allow_trailing_bits(true);
    let bytes: Vec<u8> = bytes.collect();
    GeneralPurpose::new(&STANDARD, config).decode(bytes).map_err(|_| "its data URI is not valid base64".into())
}
