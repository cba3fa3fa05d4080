//! Which bits of a line number choose channel, rank, bank group, bank, row and column.
//!
//! Written from the most significant part to the least, `:` between them: `row:rank:bank:column:group:channel`. A part may
//! be split: with a number it takes that many bits, without one those that no number takes: `row:rank:bank:column:group:column1:channel`.
//! The rightmost piece of a part has its lowest bits. A piece that ends in `^` is hashed: its bits are the exclusive or with the row's lowest bits, as memory
//! controllers do so that rows that a power of two parts lie in different banks: `row:rank:group^:bank^:channel^:column`. Of several the rightmost takes the row's
//! lowest bits, the next those above, and so on; bits that the row does not have are 0. Lines beyond the capacity wrap around.

use super::device::Organisation;
use super::error::{DramError, invalid};

/// The default. Neighbouring lines lie in one row, and neighbouring rows in different channels, then in different bank groups, then banks: what traversal
/// reads together, the lines of a node or of a leaf, opens one row. docs/claims.md has the search that it comes from.
pub const DEFAULT_MAPPING: &str = "row:rank:bank:group:channel:column";

/// One for streams. Neighbouring lines lie in different channels, then in different bank groups (so that a stream is paced by nCCD_S), then in
/// the same row of all those; banks and rows change last, so that a stream opens few rows.
#[cfg(test)]
pub const STREAM_MAPPING: &str = "row:rank:bank:column:group:channel";

/// The parts by name.
const PARTS: [&str; 6] = ["channel", "rank", "group", "bank", "row", "column"];

const CHANNEL: usize = 0;
const ROW: usize = 4;
const COLUMN: usize = 5;

/// Where a line is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Channel.
    pub channel: u32,
    /// Rank within the channel.
    pub rank: u32,
    /// Bank group within the rank.
    pub group: u32,
    /// Bank within the bank group.
    pub bank: u32,
    /// Row within the bank.
    pub row: u32,
    /// Column within the row.
    pub column: u32,
}

/// Some bits of a line number that are bits of a part.
#[derive(Clone, Debug)]
struct Piece {
    part: usize,
    from: u32,
    mask: u64,
    to: u32,
    /// Which bits of the line's number, the row's, are added without carry; none where the piece is not hashed.
    hash: Vec<RowBit>,
}

/// A bit of the row that is added to a bit of another part.
#[derive(Clone, Copy, Debug)]
struct RowBit {
    /// In the line's number.
    from: u32,
    /// In the part.
    to: u32,
}

impl Piece {
    /// These bits of a line number, in their place within the part.
    fn bits_of(&self, line: u64) -> u32 {
        let bits = ((line >> self.from & self.mask) as u32) << self.to; // at most 24 bits
        self.hash.iter().fold(bits, |bits, row| bits ^ ((line >> row.from & 1) as u32) << row.to)
    }
}

/// A mapping of lines to places, one to one up to [`Mapping::lines`].
#[derive(Clone, Debug)]
pub struct Mapping {
    /// Those of the channel first.
    pieces: Vec<Piece>,
    channel_pieces: usize,
    bits: u32,
}

impl Mapping {
    /// The mapping `text` (see the module) for `channels` channels of an organisation.
    ///
    /// # Errors
    /// Channels are not a power of two, or a part is unknown, missing, or stands with more or fewer bits than it has.
    pub fn new(text: &str, channels: u32, organisation: &Organisation) -> Result<Self, DramError> {
        if !channels.is_power_of_two() || channels > 1 << 10 {
            return Err(invalid("channels", "must be a power of two up to 1024", channels));
        }
        let sizes =
            [channels, organisation.ranks, organisation.bank_groups, organisation.banks_per_group, organisation.rows, organisation.columns];
        let wrong = |what: String| DramError::Mapping { mapping: text.to_owned(), what };
        // Part and bits of each token, the least significant first; no bits where the token has no number.
        let mut tokens = Vec::new();
        let mut rest = sizes.map(|size| Some(size.ilog2())); // of each part, what no number takes; none once a token took it
        for token in text.rsplit(':') {
            let (token, hashed) = token.strip_suffix('^').map_or((token, false), |token| (token, true));
            let name = token.trim_end_matches(|c: char| c.is_ascii_digit());
            let part = PARTS.iter().position(|&part| part == name).ok_or_else(|| wrong(format!("{token:?} is no part")))?;
            let number = &token[name.len()..];
            let bits =
                if number.is_empty() { None } else { Some(number.parse::<u32>().map_err(|_| wrong(format!("{token:?}: too many bits")))?) };
            if hashed && (part == ROW || part == COLUMN) {
                return Err(wrong(format!("{} cannot be hashed with bits of the row", PARTS[part])));
            }
            tokens.push((part, bits, hashed));
        }
        for &(part, bits, _) in &tokens {
            let (Some(left), Some(bits)) = (rest[part].as_mut(), bits) else { continue };
            *left = left.checked_sub(bits).ok_or_else(|| wrong(format!("{} has only {} bits", PARTS[part], sizes[part].ilog2())))?;
        }
        let mut used = [0u32; PARTS.len()];
        let mut pieces = Vec::new();
        let mut from = 0;
        let mut hashed = Vec::new();
        for (part, bits, is_hashed) in tokens {
            let bits = match bits {
                Some(bits) => bits,
                None => rest[part].take().ok_or_else(|| wrong(format!("{} stands twice without a number", PARTS[part])))?,
            };
            if is_hashed {
                hashed.push(pieces.len());
            }
            pieces.push(Piece { part, from, mask: (1 << bits) - 1, to: used[part], hash: Vec::new() });
            used[part] += bits;
            from += bits;
        }
        for (part, name) in PARTS.iter().enumerate() {
            let all = sizes[part].ilog2();
            if used[part] != all {
                return Err(wrong(format!("{} of {all} bits of {name} stand", used[part])));
            }
        }
        // The row's bits in the line's number, the lowest first.
        let mut rows: Vec<&Piece> = pieces.iter().filter(|piece| piece.part == ROW).collect();
        rows.sort_by_key(|piece| piece.to);
        let mut rows =
            rows.iter().flat_map(|piece| (0..piece.mask.count_ones()).map(|bit| piece.from + bit)).collect::<Vec<_>>().into_iter();
        for at in hashed {
            let piece = &mut pieces[at];
            let bits = piece.to..piece.to + piece.mask.count_ones();
            piece.hash = bits.zip(&mut rows).map(|(to, from)| RowBit { from, to }).collect();
        }
        pieces.retain(|piece| piece.mask != 0);
        pieces.sort_by_key(|piece| piece.part != CHANNEL);
        let channel_pieces = pieces.iter().filter(|piece| piece.part == CHANNEL).count();
        Ok(Self { pieces, channel_pieces, bits: from })
    }

    /// Lines of all channels.
    pub fn lines(&self) -> u64 {
        1 << self.bits
    }

    /// The channel of a line.
    pub fn channel(&self, line: u64) -> u32 {
        self.pieces[..self.channel_pieces].iter().fold(0, |channel, piece| channel | piece.bits_of(line))
    }

    /// Where a line is.
    pub fn place(&self, line: u64) -> Place {
        let mut parts = [0u32; PARTS.len()];
        for piece in &self.pieces {
            parts[piece.part] |= piece.bits_of(line);
        }
        let [channel, rank, group, bank, row, column] = parts;
        Place { channel, rank, group, bank, row, column }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    const SMALL: Organisation = Organisation { ranks: 2, bank_groups: 2, banks_per_group: 4, rows: 8, columns: 16, devices_per_rank: 1 };

    fn error(text: &str) -> String {
        Mapping::new(text, 4, &SMALL).unwrap_err().to_string()
    }

    #[test]
    fn default_keeps_neighbours_in_a_row_and_spreads_rows_over_channels() {
        let mapping = Mapping::new(DEFAULT_MAPPING, 4, &SMALL).unwrap();
        assert_eq!(mapping.lines(), 4 * 2 * 2 * 4 * 8 * 16);
        let place = |line| mapping.place(line);
        let zero = Place { channel: 0, rank: 0, group: 0, bank: 0, row: 0, column: 0 };
        assert_eq!(place(0), zero);
        assert_eq!(place(15), Place { column: 15, ..zero });
        assert_eq!(place(16), Place { channel: 1, ..zero });
        assert_eq!(place(16 * 4), Place { group: 1, ..zero });
        assert_eq!(place(16 * 8), Place { bank: 1, ..zero });
        assert_eq!(place(16 * 8 * 4), Place { rank: 1, ..zero });
        assert_eq!(place(16 * 8 * 8), Place { row: 1, ..zero });
        assert_eq!(place(mapping.lines()), zero, "wraps");
    }

    #[test]
    fn a_stream_may_go_over_channels_then_groups_then_columns() {
        let mapping = Mapping::new(STREAM_MAPPING, 4, &SMALL).unwrap();
        assert_eq!(mapping.lines(), 4 * 2 * 2 * 4 * 8 * 16);
        let place = |line| mapping.place(line);
        let zero = Place { channel: 0, rank: 0, group: 0, bank: 0, row: 0, column: 0 };
        assert_eq!(place(0), zero);
        assert_eq!(place(3), Place { channel: 3, ..zero });
        assert_eq!(place(4), Place { group: 1, ..zero });
        assert_eq!(place(8), Place { column: 1, ..zero });
        assert_eq!(place(8 * 16), Place { bank: 1, ..zero });
        assert_eq!(place(8 * 16 * 4), Place { rank: 1, ..zero });
        assert_eq!(place(8 * 16 * 8), Place { row: 1, ..zero });
        assert_eq!(place(mapping.lines()), zero, "wraps");
    }

    #[test]
    fn every_mapping_is_one_to_one() {
        for text in [
            DEFAULT_MAPPING,
            STREAM_MAPPING,
            "row:bank:column:channel:rank:group",
            "row:column2:rank:bank:column:group:channel1:column1:channel",
            "row:rank:group^:bank^:channel^:column",
            "rank^:row2:bank^:column:row:channel^:group",
        ] {
            let mapping = Mapping::new(text, 4, &SMALL).unwrap();
            let places: HashSet<_> = (0..mapping.lines()).map(|line| format!("{:?}", mapping.place(line))).collect();
            assert_eq!(places.len() as u64, mapping.lines(), "{text}");
            assert!((0..mapping.lines()).all(|line| mapping.channel(line) == mapping.place(line).channel), "{text}");
        }
    }

    #[test]
    fn split_parts_take_their_bits_from_the_right() {
        let mapping = Mapping::new("row:rank:bank:column:group:column1:channel", 4, &SMALL).unwrap();
        assert_eq!(mapping.place(4).column, 1);
        assert_eq!(mapping.place(8).group, 1);
        assert_eq!(mapping.place(16).column, 2);
    }

    #[test]
    fn hashed_parts_take_row_bits_from_the_right() {
        let mapping = Mapping::new("row:rank:group^:bank^:channel^:column", 4, &SMALL).unwrap();
        // Columns have four bits, channels two, banks two, groups and ranks one: the row begins at bit 10. It has three bits: two for the channel, one for the bank.
        let zero = Place { channel: 0, rank: 0, group: 0, bank: 0, row: 0, column: 0 };
        assert_eq!(mapping.place(1 << 10), Place { row: 1, channel: 1, ..zero });
        assert_eq!(mapping.place(1 << 10 | 1 << 4), Place { row: 1, ..zero });
        assert_eq!(mapping.place(2 << 10), Place { row: 2, channel: 2, ..zero });
        assert_eq!(mapping.place(4 << 10), Place { row: 4, bank: 1, ..zero });
    }

    #[test]
    fn errors_say_what_is_wrong() {
        assert!(error("row:rank:bank:column:group").contains("0 of 2 bits of channel stand"));
        assert!(error("row:rank:bank:colum:group:channel").contains("\"colum\" is no part"));
        assert!(error("row:rank:bank:column:group:channel3").contains("channel has only 2 bits"));
        assert!(error("row:row:rank:bank:column:group:channel").contains("row stands twice without a number"));
        assert!(error("row^:rank:bank:column:group:channel").contains("row cannot be hashed"));
        assert!(error("row:rank:bank:column^:group:channel").contains("column cannot be hashed"));
        assert!(error("row:rank:bank:column3:group:channel").contains("3 of 4 bits of column stand"));
        assert!(error("").contains("is no part"));
        assert!(Mapping::new(DEFAULT_MAPPING, 3, &SMALL).unwrap_err().to_string().contains("channels must be a power of two"));
    }
}
