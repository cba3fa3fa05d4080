//! What tools said of texts, kept in `rtl/verdicts.txt` under a digest of all that it depends on: where nothing changed, no tool is asked again.
//!
//! Environment: `LODRAY_VERDICTS=ask` takes nothing from the file (`scripts/nightly`); `LODRAY_VERDICTS=keep` writes the file anew, with what this run asked (`scripts/verdicts`).

use crate::Error;
use crate::sources::{self, Sources};
use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;
use std::sync::{LazyLock, Mutex, PoisonError};
use xxhash_rust::xxh3::Xxh3;

const HEAD: &str = "# What tools said of the RTL, with the digest of what each verdict depends on: scripts/verdicts writes this.\n";

/// A question to a tool, with all that the answer depends on: the tool, the way it is asked, and the texts it reads.
pub struct Question {
    what: String,
    hash: Xxh3,
}

impl Question {
    /// A question, in one line for who reads the file.
    pub fn new(what: impl Into<String>) -> Self {
        Self { what: what.into(), hash: Xxh3::new() }
    }

    /// The answer depends on this text.
    pub fn on(mut self, text: impl AsRef<[u8]>) -> Self {
        let text = text.as_ref();
        self.hash.update(&text.len().to_le_bytes());
        self.hash.update(text);
        self
    }

    /// The answer depends on these files.
    pub(crate) fn on_files(self, files: &Sources) -> Self {
        files.contents().fold(self, |question, (path, content)| question.on(path.as_os_str().as_encoded_bytes()).on(content))
    }

    /// The answer depends on a top of `rtl/` and all that it names.
    pub fn on_top(self, top: &str) -> Result<Self, Error> {
        Ok(self.on_files(&Sources::with(&[], top)?))
    }

    /// The answer that is kept, or the one that asking gives. What a tool refuses is never kept.
    pub fn answer(self, ask: impl FnOnce() -> Result<String, Error>) -> Result<String, Error> {
        let digest = format!("{:032x}", self.hash.digest128());
        let way = *WAY;
        let known = if way == Way::Ask { None } else { KEPT.get(&digest) };
        let answer = known.map_or_else(ask, |answer| Ok(answer.clone()))?;
        if way == Way::Keep {
            keep(self.what, digest, answer.trim())?;
        }
        Ok(answer)
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    /// Only what is not there.
    Look,
    Ask,
    Keep,
}

static WAY: LazyLock<Way> = LazyLock::new(|| match std::env::var("LODRAY_VERDICTS").as_deref() {
    Err(_) => Way::Look,
    Ok("ask") => Way::Ask,
    Ok("keep") => Way::Keep,
    Ok(other) => panic!("LODRAY_VERDICTS={other}: neither ask nor keep"),
});

fn path() -> PathBuf {
    sources::rtl().join("verdicts.txt")
}

/// Answers by digest, as the file has them. Without the file there are none.
static KEPT: LazyLock<HashMap<String, String>> = LazyLock::new(|| {
    let text = std::fs::read_to_string(path()).unwrap_or_default();
    let said = text.lines().filter_map(|line| line.split_once(": ")).map(|(_, said)| said.split_once(' ').unwrap_or((said, "")));
    said.map(|(digest, answer)| (digest.to_owned(), answer.to_owned())).collect()
});

/// Writes all that this run asked so far.
fn keep(what: String, digest: String, answer: &str) -> Result<(), Error> {
    static ASKED: Mutex<BTreeMap<String, String>> = Mutex::new(BTreeMap::new());
    let mut asked = ASKED.lock().unwrap_or_else(PoisonError::into_inner);
    let before = asked.insert(what.clone(), format!("{digest} {answer}"));
    // Two questions of one name would lose an answer at each run.
    assert!(before.is_none_or(|before| before.starts_with(&digest)), "two questions are called {what}");
    let path = path();
    let lines: String = asked.iter().map(|(what, said)| format!("{what}: {}\n", said.trim_end())).collect();
    let part = path.with_extension("part");
    std::fs::write(&part, format!("{HEAD}{lines}")).map_err(Error::file(&part))?;
    std::fs::rename(&part, &path).map_err(Error::file(&path))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn digest(question: Question) -> u128 {
        question.hash.digest128()
    }

    #[test]
    fn every_text_counts_and_where_it_ends() {
        let ask = |texts: &[&str]| digest(texts.iter().fold(Question::new("it"), |question, text| question.on(text)));
        assert_eq!(ask(&["tool", "text"]), ask(&["tool", "text"]));
        for other in [&["tool", "texts"][..], &["too", "ltext"], &["tooltext"], &["text", "tool"], &["tool", "text", ""]] {
            assert_ne!(ask(&["tool", "text"]), ask(other), "{other:?}");
        }
    }

    #[test]
    fn what_is_refused_is_asked_again() {
        let refused = || Error::Nothing("it".to_owned());
        for _ in 0..2 {
            let mut asked = false;
            let answer = Question::new("a text that no tool takes").on("no digest of the file").answer(|| {
                asked = true;
                Err(refused())
            });
            assert!(answer.is_err() && asked);
        }
    }
}
