//! What is wrong with a mesh file, and where.

use std::fmt::Display;

/// What is wrong and where, before the file's name is put in front.
#[derive(Debug)]
pub(super) struct Fault {
    pub place: String,
    pub what: String,
}

/// What a file has at some place, for a message: its beginning, on one line; a file of another kind may hold anything.
pub(super) fn shown(text: &str) -> String {
    let (begin, more) = text.trim().char_indices().nth(80).map_or((text.trim(), ""), |(at, _)| (&text.trim()[..at], "..."));
    format!("{}{more}", begin.escape_debug())
}

pub(super) fn fault<T>(place: impl Display, what: impl Display) -> Result<T, Fault> {
    Err(Fault { place: place.to_string(), what: what.to_string() })
}
