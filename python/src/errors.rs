//! Errors as exceptions, with the program's words.

use lodray::study::one_line;
use pyo3::PyErr;
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use std::error::Error;

create_exception!(
    lodray,
    LodrayError,
    PyValueError,
    "Something that cannot be: the message says what, and names the field, the key or the ray."
);

/// An error of the library as an exception.
pub fn raised(error: impl Error) -> PyErr {
    raised_by(&error)
}

/// The same of an error behind a box.
pub fn raised_by(error: &dyn Error) -> PyErr {
    refused(of_arguments(&one_line(error)))
}

/// The program's words with the names of arguments in place of those of options: `--max-error` is max_error.
pub fn of_arguments(words: &str) -> String {
    let word = |word: &str| {
        let option = word.trim_start_matches('(');
        let before = &word[..word.len() - option.len()];
        option.strip_prefix("--").map_or_else(|| word.to_owned(), |name| format!("{before}{}", name.replace('-', "_")))
    };
    words.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

/// What cannot be, in words.
pub fn refused(why: impl Into<String>) -> PyErr {
    LodrayError::new_err(why.into())
}
