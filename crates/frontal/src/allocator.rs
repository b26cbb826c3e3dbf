//! What the allocator does with large arrays that are free again.
#![allow(unsafe_code)]

/// Bytes of an array from which on it is given back.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const LARGE: libc::c_int = 1 << 22;

/// Has arrays of 4 MB and more given back to the system once they are free, in the whole process. The C library would otherwise
/// keep the memory of any below 32 MB: what an analysis needed for a moment would be held through the run.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
pub fn give_back_large_arrays() {
    // SAFETY: a setting of the allocator, which it may be given at any time.
    unsafe { libc::mallopt(libc::M_MMAP_THRESHOLD, LARGE) };
}

/// Elsewhere allocators do as they do.
#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
pub fn give_back_large_arrays() {}
