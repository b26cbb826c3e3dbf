//! Large arrays in huge pages, where the system gives them to who asks: a first touch of a gigabyte in pages of 4 kB takes as long as
//! many flops.
#![allow(unsafe_code)]

/// Asks for huge pages for the memory of large arrays; nothing of what is in it changes, and nothing is lost where there are none.
#[cfg(target_os = "linux")]
pub fn ask<T>(numbers: &[T]) {
    let range = numbers.as_ptr_range();
    let (begin, end) = ((range.start as usize).next_multiple_of(PAGE), range.end as usize / PAGE * PAGE);
    if end > begin {
        // SAFETY: the range lies within an array that is borrowed; the advice changes no byte of it.
        unsafe { libc::madvise(begin as *mut libc::c_void, end - begin, libc::MADV_HUGEPAGE) };
    }
}

/// Bytes of a huge page.
#[cfg(target_os = "linux")]
const PAGE: usize = 1 << 21;

/// Elsewhere nothing is asked for.
#[cfg(not(target_os = "linux"))]
pub fn ask<T>(_: &[T]) {}
