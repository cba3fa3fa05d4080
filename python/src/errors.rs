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
    refused(one_line(&error))
}

/// The same of an error behind a box.
pub fn raised_by(error: &dyn Error) -> PyErr {
    refused(one_line(error))
}

/// What cannot be, in words.
pub fn refused(why: impl Into<String>) -> PyErr {
    LodrayError::new_err(why.into())
}
