//! Files made from good ones: bytes changed, parts cut, doubled and moved, numbers at their limits, deep nesting.

use proptest::prelude::*;
use proptest::sample::{Index, select};
use std::ops::Range;
use std::path::Path;
use std::{fmt, fs};

/// Longest file that is made.
const LONGEST: usize = 1 << 17;

/// A file of a corpus.
#[derive(Clone)]
pub struct File {
    /// What to call it.
    pub name: String,
    /// What is in it.
    pub bytes: Vec<u8>,
}

impl File {
    pub fn new(name: &str, bytes: impl Into<Vec<u8>>) -> Self {
        Self { name: name.to_owned(), bytes: bytes.into() }
    }

    /// The files of a folder of `tests/fuzz/corpus` with this ending.
    pub fn all(folder: &str, ending: &str) -> Vec<Self> {
        Self::of(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/corpus").join(folder), ending)
    }

    /// The files of a folder with this ending, by name.
    pub fn of(folder: &Path, ending: &str) -> Vec<Self> {
        let entries = fs::read_dir(folder).unwrap_or_else(|why| panic!("{}: {why}", folder.display()));
        let mut paths: Vec<_> =
            entries.map(|entry| entry.unwrap().path()).filter(|path| path.extension().is_some_and(|own| own == ending)).collect();
        paths.sort();
        paths.iter().map(|path| Self::new(&path.display().to_string(), fs::read(path).unwrap())).collect()
    }
}

/// A damaged file; shown by its beginning.
#[derive(Clone)]
pub struct Damaged(pub Vec<u8>);

impl fmt::Debug for Damaged {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shown = &self.0[..self.0.len().min(400)];
        write!(f, "{} bytes, {:?}", self.0.len(), String::from_utf8_lossy(shown))
    }
}

/// What is done to a file. Places are where they are in any file.
#[derive(Clone, Debug)]
enum Edit {
    /// A byte is another.
    Set(Index, u8),
    /// A bit is another.
    Flip(Index, u8),
    /// Bytes are put in.
    Insert(Index, Vec<u8>),
    /// Bytes are taken out.
    Remove(Index, usize),
    /// The file ends early.
    Truncate(Index),
    /// A part is there again, elsewhere.
    Copy { from: Index, length: usize, to: Index },
    /// Part of another file of the corpus.
    Splice { file: Index, from: Index, length: usize, to: Index },
    /// A line, or two that change places.
    Lines(Index, Index, LineEdit),
    /// A number in a text is another.
    Number(Index, &'static str),
    /// A word in a text is another of the corpus'.
    Word { at: Index, file: Index, word: Index },
    /// A binary number of 1, 2, 4 or 8 bytes is another.
    Binary { at: Index, bytes: usize, value: u64, big: bool },
    /// A text in the file, many times.
    Deep(Index, &'static str, usize),
}

/// What is done to lines.
#[derive(Clone, Copy, Debug)]
enum LineEdit {
    Remove,
    Double,
    Swap,
}

/// Numbers at the limits of what programs take for numbers.
const NUMBERS: [&str; 38] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "0.5",
    "3",
    "7",
    "16",
    "255",
    "256",
    "1024",
    "65535",
    "65536",
    "16777217",
    "268435456",
    "2147483647",
    "-2147483648",
    "2147483648",
    "4294967295",
    "4294967296",
    "9007199254740993",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551615",
    "18446744073709551616",
    "1e-320",
    "1e-45",
    "-1e-7",
    "1e9",
    "1e19",
    "3.4e38",
    "1e39",
    "1.7e308",
    "1e309",
    "nan",
    "inf",
    "-inf",
];

/// What files nest, and what a repetition of is long.
const DEEP: [&str; 16] = ["1,", "[1,1,1],", "[", "{", "(", "{\"a\":", "[[", "\"", "a.", "[a.", "a={", "1 ", "/", "-", " ", "9"];

/// Binary numbers at the limits of what programs take for numbers.
const VALUES: [u64; 22] = [
    0,
    1,
    2,
    3,
    0x7f,
    0x80,
    0xff,
    0x100,
    0x7fff,
    0xffff,
    0x1_0000,
    0x0fff_ffff,
    0x1000_0000,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    0x1_0000_0000,
    0x7f80_0000,
    0x7fc0_0000,
    0x7ff0_0000_0000_0000,
    0x7fff_ffff_ffff_ffff,
    u64::MAX,
];

fn edit() -> impl Strategy<Value = Edit> {
    let at = any::<Index>;
    let typed = || prop_oneof![any::<u8>(), select(b"0123456789-+.eE/ \n\t\"[]{},:=#vf_".to_vec())];
    let length = || prop_oneof![1..8usize, 1..64usize, 1..4096usize];
    prop_oneof![
        2 => (at(), typed()).prop_map(|(at, byte)| Edit::Set(at, byte)),
        2 => (at(), 0..8u8).prop_map(|(at, bit)| Edit::Flip(at, bit)),
        2 => (at(), prop::collection::vec(typed(), 1..6)).prop_map(|(at, bytes)| Edit::Insert(at, bytes)),
        2 => (at(), length()).prop_map(|(at, length)| Edit::Remove(at, length)),
        1 => at().prop_map(Edit::Truncate),
        1 => (at(), length(), at()).prop_map(|(from, length, to)| Edit::Copy { from, length, to }),
        1 => (at(), at(), length(), at()).prop_map(|(file, from, length, to)| Edit::Splice { file, from, length, to }),
        3 => (at(), at(), select(vec![LineEdit::Remove, LineEdit::Double, LineEdit::Swap])).prop_map(|(a, b, what)| Edit::Lines(a, b, what)),
        5 => (at(), select(NUMBERS.to_vec())).prop_map(|(at, number)| Edit::Number(at, number)),
        3 => (at(), at(), at()).prop_map(|(at, file, word)| Edit::Word { at, file, word }),
        3 => (at(), select(vec![1usize, 2, 4, 8]), prop_oneof![select(VALUES.to_vec()), any::<u64>()], any::<bool>())
            .prop_map(|(at, bytes, value, big)| Edit::Binary { at, bytes, value, big }),
        1 => (at(), select(DEEP.to_vec()), prop_oneof![1..200usize, 1..20_000usize]).prop_map(|(at, what, times)| Edit::Deep(at, what, times)),
    ]
}

/// Where the digits and signs of numbers stand, or whole words.
fn runs(bytes: &[u8], of: impl Fn(u8) -> bool) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    for (at, _) in bytes.iter().enumerate().filter(|(_, byte)| of(**byte)) {
        match found.last_mut() {
            Some(last) if last.end == at => last.end = at + 1,
            _ => found.push(at..at + 1),
        }
    }
    found
}

fn is_number(byte: u8) -> bool {
    byte.is_ascii_digit() || matches!(byte, b'-' | b'+' | b'.')
}

fn is_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b'-' | b'_' | b'.' | b'"')
}

/// A part of a file, from some place on.
fn part(bytes: &[u8], from: Index, length: usize) -> Vec<u8> {
    if bytes.is_empty() {
        return Vec::new();
    }
    let from = from.index(bytes.len());
    bytes[from..bytes.len().min(from + length)].to_vec()
}

fn put(bytes: &mut Vec<u8>, at: Index, new: impl IntoIterator<Item = u8>) {
    let at = at.index(bytes.len() + 1);
    bytes.splice(at..at, new);
}

impl Edit {
    fn apply(&self, corpus: &[File], bytes: &mut Vec<u8>) {
        let length = bytes.len();
        match self {
            _ if length == 0 => {}
            Self::Set(at, byte) => bytes[at.index(length)] = *byte,
            Self::Flip(at, bit) => bytes[at.index(length)] ^= 1u8 << *bit,
            Self::Insert(at, new) => put(bytes, *at, new.iter().copied()),
            Self::Remove(at, count) => {
                let from = at.index(length);
                bytes.drain(from..length.min(from + count));
            }
            Self::Truncate(at) => bytes.truncate(at.index(length)),
            Self::Copy { from, length, to } => {
                let copied = part(bytes, *from, *length);
                put(bytes, *to, copied);
            }
            Self::Splice { file, from, length, to } => put(bytes, *to, part(&file.get(corpus).bytes, *from, *length)),
            Self::Lines(a, b, what) => {
                let mut lines: Vec<&[u8]> = bytes.split_inclusive(|&byte| byte == b'\n').collect();
                let [a, b] = [a, b].map(|at| at.index(lines.len()));
                match what {
                    LineEdit::Remove => _ = lines.remove(a),
                    LineEdit::Double => lines.insert(b, lines[a]),
                    LineEdit::Swap => lines.swap(a, b),
                }
                *bytes = lines.concat();
            }
            Self::Number(at, number) => {
                let found = runs(bytes, is_number);
                if !found.is_empty() {
                    bytes.splice(at.get(&found).clone(), number.bytes());
                }
            }
            Self::Word { at, file, word } => {
                let other = &file.get(corpus).bytes;
                let (own, others) = (runs(bytes, is_word), runs(other, is_word));
                if !own.is_empty() && !others.is_empty() {
                    let new = other[word.get(&others).clone()].to_vec();
                    bytes.splice(at.get(&own).clone(), new);
                }
            }
            Self::Binary { at, bytes: count, value, big } => {
                let from = at.index(length);
                let all = if *big { value.to_be_bytes() } else { value.to_le_bytes() };
                let own = if *big { &all[8 - count..] } else { &all[..*count] };
                for (to, from) in bytes[from..].iter_mut().zip(own) {
                    *to = *from;
                }
            }
            Self::Deep(at, what, times) => put(bytes, *at, what.repeat(*times).into_bytes()),
        }
        bytes.truncate(LONGEST);
    }
}

/// Files of a corpus, damaged at up to six places.
pub fn damaged(corpus: &[File]) -> impl Strategy<Value = Damaged> + use<> {
    assert!(!corpus.is_empty());
    let corpus = corpus.to_vec();
    // Most have one fault: others hide behind the first.
    let edits = prop_oneof![2 => prop::collection::vec(edit(), 1), 1 => prop::collection::vec(edit(), 2..7)];
    (any::<Index>(), edits).prop_map(move |(which, edits)| {
        let mut bytes = which.get(&corpus).bytes.clone();
        edits.iter().for_each(|edit| edit.apply(&corpus, &mut bytes));
        Damaged(bytes)
    })
}
