//! What is called of PETSc: errors in words, and its objects, which are given back when they are dropped.

use std::ffi::{CStr, CString, c_char};
use std::ptr;

/// The generated bindings.
#[allow(non_camel_case_types, non_snake_case, non_upper_case_globals, missing_docs, unused, clippy::all)]
pub mod ffi {
    include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
}

pub use ffi::{KSP, Mat, PetscInt, Vec as Vector};

/// What PETSc calls an error, in words.
pub type Result<T> = std::result::Result<T, String>;

/// Says in words what a call was refused for.
#[allow(clippy::unnecessary_cast)] // An integer here, an enumeration there.
pub fn checked(code: ffi::PetscErrorCode) -> Result<()> {
    if code as i32 == 0 {
        return Ok(());
    }
    let (mut general, mut specific): (*const c_char, *mut c_char) = (ptr::null(), ptr::null_mut());
    // SAFETY: both are texts of PETSc or nothing.
    let words = unsafe {
        ffi::PetscErrorMessage(code, &mut general, &mut specific);
        [general, specific.cast_const()]
            .map(|text| if text.is_null() { "".into() } else { CStr::from_ptr(text).to_string_lossy() })
    };
    let lines = words.iter().flat_map(|text| text.lines()).map(str::trim).filter(|line| !line.is_empty());
    // A number that is none of its errors is the line at which it was given no memory.
    let why = if general.is_null() { ", most likely for want of memory" } else { "" };
    Err(format!("PETSc: {} (its error {}{why})", lines.collect::<Vec<_>>().join(": "), code as i32))
}

/// PETSc's PETSC_DECIDE.
pub const DECIDE: PetscInt = -1;

/// A text as C has it.
pub fn text(words: &str) -> CString {
    CString::new(words.replace('\0', " ")).expect("no zero is left")
}

/// A number of rows or entries.
pub fn int(number: usize) -> Result<PetscInt> {
    PetscInt::try_from(number).map_err(|_| format!("{number} is more than the integers of this PETSc count to"))
}

/// An object of PETSc that is ours.
pub struct Owned<T> {
    /// The object.
    pub raw: *mut T,
    give_back: unsafe extern "C" fn(*mut *mut T) -> ffi::PetscErrorCode,
}

impl<T> Owned<T> {
    /// What a call makes.
    pub fn made(
        make: impl FnOnce(*mut *mut T) -> ffi::PetscErrorCode,
        give_back: unsafe extern "C" fn(*mut *mut T) -> ffi::PetscErrorCode,
    ) -> Result<Self> {
        let mut raw = ptr::null_mut();
        checked(make(&mut raw))?;
        Ok(Self { raw, give_back })
    }
}

impl<T> Drop for Owned<T> {
    fn drop(&mut self) {
        // All ranks give back together; one that ends alone would wait for the others.
        if !crate::ranks::has_arrived() {
            // SAFETY: it is ours and given back once.
            unsafe { (self.give_back)(&mut self.raw) };
        }
    }
}
