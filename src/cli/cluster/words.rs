//! Words for a shell.

/// A word as a shell takes it for one.
pub fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "_-./=:,@%+".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn words_stay_words() {
        assert_eq!(
            ["a.toml", "--size=8x8", "my jobs.toml", "it's", "", "$HOME"].map(quoted),
            ["a.toml", "--size=8x8", "'my jobs.toml'", "'it'\\''s'", "''", "'$HOME'"]
        );
    }
}
