//! The end of memory: where the system gives none to one rank, all end, with one message and one code.

use crate::petsc::{DECIDE, Owned, Result, checked, ffi};
use crate::ranks::Ranks;
use std::alloc::{GlobalAlloc, Layout, System};
use std::ptr;
use std::sync::atomic::{AtomicBool, AtomicPtr, Ordering};
use std::time::Duration;

/// What is held back for the message and the end.
const RESERVE: Layout = Layout::new::<[u8; 1 << 23]>();
/// How long threads that find none either wait for the end.
const END: Duration = Duration::from_secs(10);

/// The system's allocator, which ends all ranks where there is nothing more.
struct Memory {
    reserve: AtomicPtr<u8>,
    ended: AtomicBool,
}

#[global_allocator]
static MEMORY: Memory = Memory { reserve: AtomicPtr::new(ptr::null_mut()), ended: AtomicBool::new(false) };

/// Address space that a BLAS may take for itself: OpenBLAS 128 MiB.
const BLAS: Layout = Layout::new::<[u8; 3 << 26]>();

/// Holds back what the end takes, and lets BLAS take what it keeps: OpenBLAS asks for it without end where it is refused.
pub fn reserve() -> Result<()> {
    // SAFETY: both have a size, nobody writes to them, and one goes back; the matrix is ours and holds the one of this rank.
    unsafe {
        MEMORY.reserve.store(System.alloc(RESERVE), Ordering::Release);
        // A compiler may leave out what nobody looks at.
        let room = std::hint::black_box(System.alloc(BLAS));
        if room.is_null() {
            return Err("the limit of the address space (`ulimit -v`) leaves no memory for BLAS".into());
        }
        System.dealloc(room, BLAS);
        let (all, mut own) = (ffi::PETSC_COMM_WORLD, ptr::null_mut());
        let ones = |raw| ffi::MatCreateDense(all, 1, DECIDE, DECIDE, 1, ptr::null_mut(), raw);
        let ones = Owned::made(ones, ffi::MatDestroy)?;
        checked(ffi::MatDenseGetLocalMatrix(ones.raw, &mut own))?;
        checked(ffi::MatShift(own, 1.0))?;
        checked(ffi::MatLUFactor(own, ptr::null_mut(), ptr::null_mut(), ptr::null()))
    }
}

impl Memory {
    /// What the system gave, or the end of all ranks where that is nothing and they have begun.
    fn given(&self, memory: *mut u8, bytes: usize) -> *mut u8 {
        if memory.is_null()
            && let Some(ranks) = Ranks::begun()
        {
            if self.ended.swap(true, Ordering::AcqRel) {
                std::thread::sleep(END);
                return memory;
            }
            let reserve = self.reserve.swap(ptr::null_mut(), Ordering::AcqRel);
            if !reserve.is_null() {
                // SAFETY: it came from this allocator with this layout.
                unsafe { System.dealloc(reserve, RESERVE) };
            }
            ranks.end_without_memory(bytes);
        }
        memory
    }
}

// SAFETY: all memory is the system's.
unsafe impl GlobalAlloc for Memory {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller says.
        self.given(unsafe { System.alloc(layout) }, layout.size())
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller says.
        self.given(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }
    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as the caller says.
        self.given(unsafe { System.realloc(memory, layout, size) }, size)
    }
    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as the caller says.
        unsafe { System.dealloc(memory, layout) };
    }
}
