//! Names of files, from any text.

use std::path::{Component, Path};

/// Letters, digits, points and single dashes.
pub fn plain_name(text: &str) -> String {
    let plain: String = text.chars().map(|c| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' }).collect();
    plain.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
}

/// The plain names of some texts, each another: what comes later has a number behind it where its name is taken.
pub fn plain_names<'a>(texts: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for text in texts {
        let plain = plain_name(text);
        let numbered = (2..).map(|k| format!("{plain}-{k}"));
        names.extend(std::iter::once(plain.clone()).chain(numbered).find(|name| !names.contains(name)));
    }
    names
}

/// Whether a name is that of a file of its folder, on every system: what is read from a file must not lead elsewhere.
pub fn is_file_name(name: &str) -> bool {
    let mut parts = Path::new(name).components();
    let is_one = matches!((parts.next(), parts.next()), (Some(Component::Normal(part)), None) if part == name);
    is_one && !name.contains(['/', '\\', ':', '\0'])
}

#[cfg(test)]
mod tests {
    use super::plain_names;

    #[test]
    fn no_two_texts_have_one_name() {
        assert_eq!(plain_names(["a b", "a-b", "a_b!", "a-b-2", "\u{e4}", "\u{f6}"]), ["a-b", "a-b-2", "a-b-3", "a-b-2-2", "", "-2"]);
    }
}
