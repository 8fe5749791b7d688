//! The boundary of every call: status, last error, caught panics, structs of any size read and written.

use selvedge_jobs::JobError;
use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::mem::size_of;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// How a call ended.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelvedgeStatus {
    /// The call succeeded.
    Ok = 0,
    /// A pointer, size, number or name that cannot be used.
    Argument = 1,
    /// A file cannot be read or written, or nothing of it can be drawn.
    File = 2,
    /// There is no usable Vulkan device.
    Device = 3,
    /// The model cannot be drawn so, or the device failed.
    Render = 4,
    /// A defect of the library.
    Internal = 5,
}

/// What a call reports when it fails: its status and a sentence.
pub struct Failure(pub SelvedgeStatus, pub String);

pub type Outcome = Result<(), Failure>;

/// An argument that cannot be used.
pub fn argument(text: impl Into<String>) -> Failure {
    Failure(SelvedgeStatus::Argument, text.into())
}

impl From<JobError> for Failure {
    fn from(error: JobError) -> Self {
        let status = match &error {
            JobError::Import(_) | JobError::Nothing { .. } | JobError::Limit(_) => SelvedgeStatus::File,
            JobError::Device(_) => SelvedgeStatus::Device,
            JobError::Draw(_) | JobError::Boundary { .. } | JobError::Validation(_) | JobError::Closed => {
                SelvedgeStatus::Render
            }
            JobError::Camera(_) | JobError::Pinhole(_) | JobError::Edges(_) | JobError::Snap => {
                SelvedgeStatus::Argument
            }
            _ => SelvedgeStatus::Internal,
        };
        Self(status, error.to_string())
    }
}

thread_local! {
    static LAST: RefCell<CString> = RefCell::default();
}

/// Text for C: it ends at its first zero.
pub fn c_text(text: &str) -> CString {
    CString::new(text.split('\0').next().unwrap_or_default()).unwrap_or_default()
}

/// Runs a call: its error is kept for [`selvedge_last_error`], and so is a panic.
pub fn border(call: impl FnOnce() -> Outcome) -> SelvedgeStatus {
    let ended = catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|_| {
        Err(Failure(SelvedgeStatus::Internal, "internal error: standard error has the message".to_owned()))
    });
    let (status, text) = match ended {
        Ok(()) => (SelvedgeStatus::Ok, String::new()),
        Err(Failure(status, text)) => (status, text),
    };
    LAST.with(|last| last.replace(c_text(&text)));
    status
}

/// One sentence about the last call of this thread that returned a status: it names file and line or entity. Empty after
/// SELVEDGE_STATUS_OK. Valid until the next such call of this thread.
#[unsafe(no_mangle)]
pub extern "C" fn selvedge_last_error() -> *const c_char {
    LAST.with(|last| last.borrow().as_ptr())
}

/// The library's version, as in "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn selvedge_version() -> *const c_char {
    const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(version) => version,
        Err(_) => panic!("a version has no zero"),
    };
    VERSION.as_ptr()
}

/// A struct whose first field is its size.
///
/// # Safety
/// `repr(C)`, begins with a `usize`, and every pattern of bits is a value of it.
pub unsafe trait Sized: Copy {}

/// The caller's struct: fields beyond the size that it states have the values of `usual`; all of them where it is null.
///
/// # Safety
/// `from` is null or points to as many bytes as its first field says, and no fewer than that field has.
pub unsafe fn taken<T: Sized>(from: *const T, usual: T) -> Result<T, Failure> {
    let mut value = usual;
    if from.is_null() {
        return Ok(value);
    }
    // SAFETY: as the caller promises; the struct begins with its size
    let stated = unsafe { from.cast::<usize>().read_unaligned() };
    let size = size_of::<T>();
    if stated < size_of::<usize>() {
        return Err(argument(format!("struct_size is {stated}: set it to the size of the struct")));
    }
    if stated > size {
        // SAFETY: the caller has so many bytes
        let beyond = unsafe { std::slice::from_raw_parts(from.cast::<u8>().add(size), stated - size) };
        if beyond.iter().any(|byte| *byte != 0) {
            return Err(argument(format!("the struct sets fields beyond the {size} bytes that this version knows")));
        }
    }
    // SAFETY: both have so many bytes, and any of them make a value
    unsafe { from.cast::<u8>().copy_to_nonoverlapping((&raw mut value).cast(), stated.min(size)) };
    Ok(value)
}

/// Writes the fields of a struct that the caller knows; its size stays.
///
/// # Safety
/// `to` is null or points to as many bytes as its first field says.
pub unsafe fn given<T: Sized>(to: *mut T, value: T) -> Outcome {
    if to.is_null() {
        return Err(argument("the struct to be filled is a null pointer"));
    }
    // SAFETY: as the caller promises; the struct begins with its size
    let stated = unsafe { to.cast::<usize>().read_unaligned() };
    let first = size_of::<usize>();
    if stated < first {
        return Err(argument(format!("struct_size is {stated}: set it to the size of the struct")));
    }
    let count = stated.min(size_of::<T>()) - first;
    // SAFETY: both have so many bytes after the size
    unsafe { (&raw const value).cast::<u8>().add(first).copy_to_nonoverlapping(to.cast::<u8>().add(first), count) };
    Ok(())
}

/// Text of the caller's; `None` for null.
///
/// # Safety
/// Null, or text that ends with a zero and lives as long as the result.
pub unsafe fn text<'a>(what: &str, from: *const c_char) -> Result<Option<&'a str>, Failure> {
    if from.is_null() {
        return Ok(None);
    }
    // SAFETY: as the caller promises
    let text = unsafe { CStr::from_ptr(from) }.to_str();
    text.map(Some).map_err(|_| argument(format!("{what} is not UTF-8")))
}

/// A handle of the caller's.
///
/// # Safety
/// The pointer is null, or this library made it and it was not freed.
pub unsafe fn handle<'a, T>(what: &str, from: *const T) -> Result<&'a T, Failure> {
    // SAFETY: as the caller promises
    unsafe { from.as_ref() }.ok_or_else(|| argument(format!("the {what} is a null pointer")))
}

/// Where a new handle goes.
///
/// # Safety
/// Null, or a place for a pointer.
pub unsafe fn place<'a, T>(to: *mut *mut T) -> Result<&'a mut *mut T, Failure> {
    // SAFETY: as the caller promises
    let to = unsafe { to.as_mut() }.ok_or_else(|| argument("the place for the result is a null pointer"))?;
    *to = std::ptr::null_mut();
    Ok(to)
}

/// Frees a handle.
///
/// # Safety
/// The pointer is null, or this library made it and it was not freed.
pub unsafe fn free<T>(handle: *mut T) {
    if !handle.is_null() {
        // SAFETY: as the caller promises; a panic while it is freed ends here
        let _ = catch_unwind(AssertUnwindSafe(|| drop(unsafe { Box::from_raw(handle) })));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told() -> String {
        // SAFETY: the text lives until this thread's next call
        unsafe { CStr::from_ptr(selvedge_last_error()) }.to_str().expect("UTF-8").to_owned()
    }

    #[test]
    fn a_panic_is_a_status_and_a_sentence() {
        assert_eq!(border(|| panic!("on purpose")), SelvedgeStatus::Internal);
        assert!(told().starts_with("internal error:"), "{}", told());
        assert_eq!(border(|| Err(argument("the width"))), SelvedgeStatus::Argument);
        assert_eq!(told(), "the width");
        assert_eq!(border(|| Ok(())), SelvedgeStatus::Ok);
        assert_eq!(told(), "");
    }

    #[test]
    fn a_panic_of_a_handle_that_is_freed_ends_there() {
        struct Bad;
        impl Drop for Bad {
            fn drop(&mut self) {
                panic!("on purpose");
            }
        }
        // SAFETY: made here
        unsafe { free(Box::into_raw(Box::new(Bad))) };
    }
}
