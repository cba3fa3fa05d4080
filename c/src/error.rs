//! Errors as sentences of the thread in which they happened.

use std::any::Any;
use std::cell::RefCell;
use std::error::Error;
use std::ffi::{CString, c_char, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A function did what it was asked for.
pub const LODRAY_OK: c_int = 0;
/// A function could not do it: `lodray_last_error` says why.
pub const LODRAY_ERROR: c_int = -1;

thread_local! {
    static LAST: RefCell<CString> = RefCell::default();
}

/// What cannot be, in words.
pub(crate) struct Refused(pub String);

impl<E: Error> From<E> for Refused {
    fn from(error: E) -> Self {
        let mut words = error.to_string();
        let mut source = error.source();
        while let Some(cause) = source {
            let cause_words = cause.to_string();
            // Some errors say their cause themselves.
            if !words.contains(&cause_words) {
                words = format!("{words}: {cause_words}");
            }
            source = cause.source();
        }
        Self(words)
    }
}

/// An error in these words.
pub(crate) fn refused<T>(why: impl Into<String>) -> Result<T, Refused> {
    Err(Refused(why.into()))
}

/// Why the last function failed that failed in this thread; an empty text if none did. It is good until the next one fails in this thread.
#[unsafe(no_mangle)]
pub extern "C" fn lodray_last_error() -> *const c_char {
    // A thread that is ending has no words left.
    LAST.try_with(|last| last.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}

/// The version of the library, such as "0.2.0".
#[unsafe(no_mangle)]
pub extern "C" fn lodray_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// What `call` gives; or what stands for a failure, with its words kept. Every function that can fail or panic goes through here: C cannot unwind.
pub(crate) fn guarded<T>(failure: T, call: impl FnOnce() -> Result<T, Refused>) -> T {
    // What a panic leaves half done belongs to one handle, and the words say to end that.
    let why = match catch_unwind(AssertUnwindSafe(call)) {
        Ok(Ok(value)) => return value,
        Ok(Err(Refused(why))) => why,
        Err(panic) => format!("a mistake within lodray, please report it and end what you called: {}", words(&*panic)),
    };
    let text = CString::new(why.replace('\0', " ")).unwrap_or_default();
    let _ = LAST.try_with(|last| last.replace(text));
    failure
}

/// The same of a function that only says whether it failed.
pub(crate) fn done(call: impl FnOnce() -> Result<(), Refused>) -> c_int {
    guarded(LODRAY_ERROR, || call().map(|()| LODRAY_OK))
}

/// What a panic said.
fn words(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no words")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::CStr;

    fn last() -> String {
        // SAFETY: it is a text of this thread, and no call comes in between.
        unsafe { CStr::from_ptr(lodray_last_error()) }.to_string_lossy().into_owned()
    }

    #[test]
    fn errors_and_panics_leave_their_words_and_success_leaves_those_of_before() {
        assert_eq!(last(), "");
        assert_eq!((done(|| refused("no\0such")), last().as_str()), (LODRAY_ERROR, "no such"));
        assert_eq!(
            (done(|| panic!("place {}", 3)), last().as_str()),
            (LODRAY_ERROR, "a mistake within lodray, please report it and end what you called: place 3")
        );
        assert_eq!((guarded(7, || Ok(8)), last().ends_with("place 3")), (8, true));
        assert_eq!(std::thread::spawn(last).join().unwrap_or_default(), "", "another thread has words of its own");
    }
}
