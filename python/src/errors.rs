//! Errors as exceptions, with the program's words.

use lodray::study::one_line;
use pyo3::PyErr;
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::import_exception;
use std::error::Error;
use std::io::{self, ErrorKind};
use std::iter::successors;

create_exception!(
    lodray,
    LodrayError,
    PyValueError,
    "Something that cannot be: the message says what, and names the field, the key or the ray."
);

// Classes with two bases each, which `lodray/__init__.py` makes: they are looked up when one is raised.
import_exception!(lodray, LodrayFileError);
import_exception!(lodray, LodrayFileNotFoundError);

/// An error of the library as an exception.
pub fn raised(error: impl Error + 'static) -> PyErr {
    raised_by(&error)
}

/// The same of an error behind a box. It is an error of a file if the system's is among its causes.
pub fn raised_by(error: &(dyn Error + 'static)) -> PyErr {
    let why = of_arguments(&one_line(error));
    let system = successors(Some(error), |&error| error.source()).find_map(|error| error.downcast_ref::<io::Error>());
    match system {
        Some(system) => of_file(why, system),
        None => refused(why),
    }
}

/// What the system refuses to do with a file, in words.
pub fn of_file(why: impl Into<String>, system: &io::Error) -> PyErr {
    match system.kind() {
        ErrorKind::NotFound => LodrayFileNotFoundError::new_err(why.into()),
        _ => LodrayFileError::new_err(why.into()),
    }
}

/// The program's words with the names of arguments in place of those of options: `--max-error` is max_error, and `--vertices` vertex_form.
pub fn of_arguments(words: &str) -> String {
    let word = |word: &str| {
        let option = word.trim_start_matches('(');
        let before = &word[..word.len() - option.len()];
        match option.strip_prefix("--") {
            Some("vertices") => format!("{before}vertex_form"),
            Some(name) => format!("{before}{}", name.replace('-', "_")),
            None => word.to_owned(),
        }
    };
    words.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

/// What cannot be, in words.
pub fn refused(why: impl Into<String>) -> PyErr {
    LodrayError::new_err(why.into())
}
