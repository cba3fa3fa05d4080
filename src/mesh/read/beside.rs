//! Files that a mesh file names: read only if they are regular files of a size that makes sense, so that no device or pipe is waited for.

use std::fs::File;
use std::io::{Error, Read};
use std::path::{Path, PathBuf};

/// Largest material library that is read, in bytes: 64 MiB.
pub(super) const LARGEST_LIBRARY: u64 = 1 << 26;
/// Largest buffer of a glTF file that is read, in bytes: 4 GiB.
pub(super) const LARGEST_BUFFER: u64 = 1 << 32;

/// Where the file `name` beside a mesh in `folder` is: as it stands, or with the back-slashes that some programs write between folders.
pub(super) fn place(folder: &Path, name: &str) -> PathBuf {
    let as_named = folder.join(name);
    if as_named.exists() || !name.contains('\\') { as_named } else { folder.join(name.replace('\\', "/")) }
}

/// The first `wanted` bytes of a regular file, or all if it has fewer.
///
/// # Errors
/// If it cannot be read, is no regular file or is larger than `largest`. Its kind is asked before it is opened: to open a pipe may wait for ever.
pub(super) fn read(path: &Path, wanted: u64, largest: u64) -> std::io::Result<Vec<u8>> {
    let about = std::fs::metadata(path)?;
    if !about.is_file() {
        return Err(Error::other("it is not an ordinary file"));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(wanted.min(largest + 1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > largest || about.len().min(wanted) > largest {
        return Err(Error::other(format!("it is larger than {} MiB", largest >> 20)));
    }
    Ok(bytes)
}
