//! The scene file's frame: header, section table, checksums (`docs/scene-format.md`).

use std::ops::Range;
use xxhash_rust::xxh3::xxh3_64;

/// First bytes of every scene file; the line ends show a transfer as text.
pub const MAGIC: [u8; 8] = *b"LODRAY\r\n";
/// Version that this program writes, and the only one that it reads.
pub const VERSION: u32 = 5;
/// Alignment of sections in bytes.
pub const ALIGN: usize = 64;

/// The sections, in file order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum FileSection {
    /// JSON: [`super::Meta`].
    Meta = 1,
    /// L0 quad-BVH nodes, a line each.
    Nodes = 2,
    /// L0 records, a line or two per tree.
    Records = 3,
    /// Splits, a line each.
    Splits = 4,
    /// Inserted vertices: lines of all splits, or halves of lines of last splits.
    Vertices = 5,
    /// Octahedral normals, 4 bytes per lattice point.
    Normals = 6,
    /// Base vertex indices, 12 bytes per tree.
    Triangles = 7,
    /// Number of the base triangle in its mesh, and its material, 8 bytes per tree.
    Sources = 8,
    /// Material colours, 4 bytes each.
    Colours = 9,
}

impl FileSection {
    /// All sections in file order.
    pub const ALL: [Self; 9] = [
        Self::Meta,
        Self::Nodes,
        Self::Records,
        Self::Splits,
        Self::Vertices,
        Self::Normals,
        Self::Triangles,
        Self::Sources,
        Self::Colours,
    ];

    /// Name for messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Meta => "META",
            Self::Nodes => "NODES",
            Self::Records => "RECORDS",
            Self::Splits => "SPLITS",
            Self::Vertices => "VERTICES",
            Self::Normals => "NORMALS",
            Self::Triangles => "TRIANGLES",
            Self::Sources => "SOURCES",
            Self::Colours => "COLOURS",
        }
    }

    /// Place in the section table.
    pub(super) fn slot(self) -> usize {
        self as usize - 1
    }
}

/// Number of sections.
pub(super) const COUNT: usize = FileSection::ALL.len();
/// Bytes before the section table.
const TABLE: usize = 64;
/// Bytes of a table entry.
const ENTRY: usize = 32;
/// Bytes of header and table.
pub(super) const HEADER: usize = TABLE + COUNT * ENTRY;
/// Where the header's own checksum stands.
const HEADER_SUM: Range<usize> = 24..32;

/// Byte ranges of all sections of these lengths, in file order, and the length of the file.
pub(super) fn place(lengths: [usize; COUNT]) -> ([Range<usize>; COUNT], usize) {
    let mut end = HEADER;
    let ranges = lengths.map(|length| {
        let start = end.next_multiple_of(ALIGN);
        end = start + length;
        start..end
    });
    (ranges, end)
}

/// Checksum of a section.
pub(super) fn checksum(bytes: &[u8]) -> u64 {
    xxh3_64(bytes)
}

/// Writes header and table over the first [`HEADER`] bytes.
pub(super) fn write_header(header: &mut [u8], file_length: usize, ranges: &[Range<usize>; COUNT], sums: &[u64; COUNT]) {
    header.fill(0);
    header[..8].copy_from_slice(&MAGIC);
    header[8..12].copy_from_slice(&VERSION.to_le_bytes());
    header[12..16].copy_from_slice(&(COUNT as u32).to_le_bytes()); // 9
    header[16..24].copy_from_slice(&(file_length as u64).to_le_bytes());
    for ((section, range), (entry, sum)) in
        FileSection::ALL.iter().zip(ranges).zip(header[TABLE..].as_chunks_mut::<ENTRY>().0.iter_mut().zip(sums))
    {
        entry[..4].copy_from_slice(&(*section as u32).to_le_bytes());
        entry[8..16].copy_from_slice(&(range.start as u64).to_le_bytes());
        entry[16..24].copy_from_slice(&(range.len() as u64).to_le_bytes());
        entry[24..].copy_from_slice(&sum.to_le_bytes());
    }
    let sum = header_sum(header);
    header[HEADER_SUM].copy_from_slice(&sum.to_le_bytes());
}

/// Checksum of header and table with the checksum itself read as zero.
fn header_sum(header: &[u8]) -> u64 {
    let mut copy = [0; HEADER];
    copy.copy_from_slice(&header[..HEADER]);
    copy[HEADER_SUM].fill(0);
    checksum(&copy)
}

fn word(bytes: &[u8], at: usize) -> u64 {
    let mut word = [0; 8];
    word.copy_from_slice(&bytes[at..at + 8]);
    u64::from_le_bytes(word)
}

/// Section ranges and checksums of a file image; everything about the frame is checked but the sections' own checksums.
///
/// # Errors
/// What is wrong, naming the field.
pub(super) fn read_header(bytes: &[u8]) -> Result<([Range<usize>; COUNT], [u64; COUNT]), String> {
    if bytes.len() < 8 || bytes[..8] != MAGIC {
        return Err("magic: not a lodray scene file".into());
    }
    if bytes.len() < TABLE {
        return Err(format!("header: file is truncated at {} bytes", bytes.len()));
    }
    let [version, count] = [word(bytes, 8) as u32, (word(bytes, 8) >> 32) as u32]; // the two halves
    if version > VERSION {
        return Err(format!("version: {version} is newer than {VERSION}, the newest that this program reads"));
    }
    if version != 0 && version < VERSION {
        let remedy = "make the scene again with build or generate";
        return Err(format!("version: {version} is older than {VERSION}, the only one that this program reads; {remedy}"));
    }
    if version == 0 || count as usize != COUNT {
        return Err(format!("header: version {version} with {count} sections; version {VERSION} has {COUNT}"));
    }
    let length = word(bytes, 16);
    if length != bytes.len() as u64 {
        let what = if length > bytes.len() as u64 { "truncated" } else { "too long" };
        return Err(format!("file length: file is {what}: {} bytes, the header says {length}", bytes.len()));
    }
    if bytes.len() < HEADER || word(bytes, HEADER_SUM.start) != header_sum(bytes) {
        return Err("header checksum: header or section table is corrupt".into());
    }
    if bytes[HEADER_SUM.end..TABLE].iter().any(|&b| b != 0) {
        return Err("header: reserved bytes are not zero".into());
    }
    let (mut ranges, mut sums) = ([const { 0..0 }; COUNT], [0; COUNT]);
    let mut end = HEADER;
    for (k, section) in FileSection::ALL.into_iter().enumerate() {
        let entry = TABLE + k * ENTRY;
        let (name, kind) = (section.name(), word(bytes, entry));
        if kind != section as u64 {
            return Err(format!("section table: entry {k} is of kind {kind}, not {name}"));
        }
        let (offset, length) = (word(bytes, entry + 8), word(bytes, entry + 16));
        let start = end.next_multiple_of(ALIGN);
        if offset != start as u64 {
            let why = if offset % ALIGN as u64 != 0 { "misaligned" } else { "not directly behind the section before it" };
            return Err(format!("section {name}: offset {offset} is {why}"));
        }
        if start > bytes.len() || length > (bytes.len() - start) as u64 {
            return Err(format!("section {name}: {length} bytes at {offset} reach past the end of the file"));
        }
        // Checked: the range lies in the file, so it fits usize.
        if bytes[end..start].iter().any(|&b| b != 0) {
            return Err(format!("section {name}: padding before it is not zero"));
        }
        end = start + length as usize;
        ranges[k] = start..end;
        sums[k] = word(bytes, entry + 24);
    }
    if end != bytes.len() {
        return Err(format!("file length: {} bytes behind the last section", bytes.len() - end));
    }
    Ok((ranges, sums))
}
