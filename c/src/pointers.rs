//! What C gives: pointers, which may be null, and counts.

use crate::error::{Refused, refused};
use std::ffi::{CStr, c_char};
use std::mem::MaybeUninit;

/// What a pointer is to; `name` is its argument's.
///
/// # Safety
/// It is null, or good and not written to as long as what is returned is used.
pub unsafe fn shared<'a, T>(name: &str, pointer: *const T) -> Result<&'a T, Refused> {
    check(name, pointer)?;
    // SAFETY: it is not null and has the type's alignment; the rest is the caller's promise.
    Ok(unsafe { &*pointer })
}

/// The same of what the call changes.
///
/// # Safety
/// It is null, or good and used by nobody else as long as what is returned is used.
pub unsafe fn exclusive<'a, T>(name: &str, pointer: *mut T) -> Result<&'a mut T, Refused> {
    check(name, pointer)?;
    // SAFETY: as above.
    Ok(unsafe { &mut *pointer })
}

/// An array of `count` values; with none of them the pointer may be null.
///
/// # Safety
/// As of [`shared`], for all of them.
pub unsafe fn array<'a, T>(name: &str, pointer: *const T, count: u64) -> Result<&'a [T], Refused> {
    let Some(count) = length(name, pointer, count)? else { return Ok(&[]) };
    // SAFETY: as above; the array's bytes fit an isize.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// Room for `count` values, which need not be anything yet.
///
/// # Safety
/// As of [`exclusive`], for all of them.
pub unsafe fn room<'a, T>(name: &str, pointer: *mut T, count: u64) -> Result<&'a mut [MaybeUninit<T>], Refused> {
    let Some(count) = length(name, pointer, count)? else { return Ok(&mut []) };
    // SAFETY: as above; what is not written yet may be anything.
    Ok(unsafe { std::slice::from_raw_parts_mut(pointer.cast(), count) })
}

/// Room for one value.
///
/// # Safety
/// As of [`exclusive`].
pub unsafe fn place<'a, T>(name: &str, pointer: *mut T) -> Result<&'a mut MaybeUninit<T>, Refused> {
    // SAFETY: the caller's promise; what is not written yet may be anything.
    unsafe { exclusive(name, pointer.cast()) }
}

/// A text.
///
/// # Safety
/// It is null, or a text that ends with a zero byte and is not written to as long as what is returned is used.
pub unsafe fn text<'a>(name: &str, pointer: *const c_char) -> Result<&'a str, Refused> {
    check(name, pointer)?;
    // SAFETY: it is not null; the rest is the caller's promise.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().or_else(|_| refused(format!("{name}: not UTF-8: {}", text.to_string_lossy())))
}

/// A handle out of its box, for the caller to keep.
pub fn handle<T>(of: T) -> *mut T {
    Box::into_raw(Box::new(of))
}

/// Ends a handle; null is none.
///
/// # Safety
/// It is null, or of [`handle`], and nobody uses it from now on.
pub unsafe fn end<T>(handle: *mut T) {
    if !handle.is_null() {
        // SAFETY: it came out of a box, and the caller gives it back.
        drop(unsafe { Box::from_raw(handle) });
    }
}

fn check<T>(name: &str, pointer: *const T) -> Result<(), Refused> {
    match () {
        () if pointer.is_null() => refused(format!("{name}: a null pointer")),
        () if !pointer.is_aligned() => refused(format!("{name}: not at a multiple of {} bytes", align_of::<T>())),
        () => Ok(()),
    }
}

/// How many values there are, if any.
fn length<T>(name: &str, pointer: *const T, count: u64) -> Result<Option<usize>, Refused> {
    if count == 0 {
        return Ok(None);
    }
    check(name, pointer)?;
    let most = isize::MAX as usize / size_of::<T>();
    match usize::try_from(count) {
        Ok(count) if count <= most => Ok(Some(count)),
        _ => refused(format!("{name}: {count} values, at most {most} fit the memory")),
    }
}
