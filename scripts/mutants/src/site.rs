//! A place in a file, and what a mutant has there instead.

use std::ops::Range;

/// One possible mutant. All ranges are bytes of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Site {
    /// The rule that found it.
    pub rule: &'static str,
    /// The expression that is replaced as a whole; or, without length, where a statement is inserted.
    pub place: Range<usize>,
    /// What changes of it.
    pub at: Range<usize>,
    /// What stands there instead.
    pub by: String,
}

impl Site {
    /// A statement is inserted.
    pub fn inserts(&self) -> bool {
        self.place.is_empty()
    }

    /// Its line, counted from 1.
    pub fn line(&self, text: &str) -> usize {
        text[..self.at.start].matches('\n').count() + 1
    }

    /// What is replaced, but nothing for numbers and bodies, which are all alike.
    pub fn alike<'a>(&self, text: &'a str) -> &'a str {
        match self.rule {
            "constant" | "branch" | "body" => "",
            _ => text[self.at.clone()].trim(),
        }
    }

    /// The line as it is, and as mutated; of what changes over several lines only the first is shown.
    pub fn lines(&self, text: &str) -> (String, String) {
        let begin = text[..self.at.start].rfind('\n').map_or(0, |at| at + 1);
        let end = |from: usize| text[from..].find('\n').map_or(text.len(), |at| from + at);
        let before = text[begin..end(self.at.start)].trim().to_owned();
        let after = format!("{}{}{}", &text[begin..self.at.start], self.by, &text[self.at.end..end(self.at.end)]);
        (before, after.trim().to_owned())
    }
}
