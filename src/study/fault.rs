//! What is wrong with a JSON file, in words for those who do not know its reader.

use serde_json::Error;
use serde_json::error::Category;

/// Most characters of a name that are said.
const LONGEST: usize = 80;

/// What is wrong, without the place.
pub fn fault(error: &Error) -> String {
    let message = error.to_string();
    let field = || {
        let name = message.split('`').nth(1).unwrap_or_default();
        // Whatever a file has there: its beginning tells which.
        name.char_indices().nth(LONGEST).map_or_else(|| name.to_owned(), |(at, _)| format!("{}...", &name[..at]))
    };
    match error.classify() {
        Category::Io => message,
        Category::Eof => "it ends too early".to_owned(),
        Category::Syntax => "it is not JSON".to_owned(),
        Category::Data if message.starts_with("missing field ") => format!("the field {} is missing", field()),
        Category::Data if message.starts_with("unknown field ") => format!("there is no field {}", field()),
        Category::Data if message.starts_with("duplicate field ") => format!("the field {} is there twice", field()),
        Category::Data => "a value is not of the kind or in the range that it should be".to_owned(),
    }
}

/// What is wrong, and where.
pub fn fault_at(error: &Error) -> String {
    format!("line {}, column {}: {}", error.line(), error.column(), fault(error))
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Both {
        _count: u64,
        _name: String,
    }

    #[test]
    fn faults_are_told_in_plain_words() {
        for (text, words) in [
            ("{\"_count\": 1,", "line 1, column 13: it ends too early"),
            ("rubbish", "line 1, column 1: it is not JSON"),
            ("{\"_count\": 1}", "line 1, column 13: the field _name is missing"),
            (&format!("{{\"{}\": 1}}", "x".repeat(2000)), &format!("line 1, column 2003: there is no field {}...", "x".repeat(80))),
            ("{\n\"count\": 1}", "line 2, column 7: there is no field count"),
            ("{\"_count\": -1}", "line 1, column 13: a value is not of the kind or in the range that it should be"),
            ("[\"x\", 1]", "line 1, column 4: a value is not of the kind or in the range that it should be"),
            ("{\"_count\": 1, \"_count\": 1}", "line 1, column 22: the field _count is there twice"),
        ] {
            assert_eq!(super::fault_at(&serde_json::from_str::<Both>(text).unwrap_err()), words, "{text}");
        }
    }
}
