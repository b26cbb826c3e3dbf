//! Calls of what others wrote: they may want to stop, and they may crash.
//!
//! A law that calls `XIT` does not expect to return. [`call`] notes where the stack stands, in a few lines of assembly, and
//! [`stop`] puts it back there, as C's `longjmp` does: the frames between are those of the library, of [`enter`] and of the
//! utility that was called, and none of them has anything to drop. A signal that the law raises, or its end of the whole program,
//! is told in one line that names it, by `write` alone; then the program dies as it would have.

use std::cell::{Cell, RefCell};
use std::ffi::c_void;

/// The call that a thread is in.
struct Current {
    /// What it is called.
    name: *const str,
    /// Where the stack stood.
    stack: usize,
}

thread_local! {
    static CURRENT: Cell<*mut Current> = const { Cell::new(std::ptr::null_mut()) };
    static REASON: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Calls a function that may stop; the error says why it did. What it captures must be without anything to drop.
pub fn call<F: FnMut()>(name: &str, mut function: F) -> Result<(), String> {
    const { assert!(!std::mem::needs_drop::<F>()) };
    let mut current = Current { name, stack: 0 };
    let current = &raw mut current;
    CURRENT.set(current);
    // SAFETY: `enter` gets back the function that it is made for, and `current` lives until the call has ended.
    let stopped = unsafe { guarded(&raw mut (*current).stack, enter::<F>, (&raw mut function).cast()) };
    CURRENT.set(std::ptr::null_mut());
    if stopped == 0 { Ok(()) } else { Err(REASON.take()) }
}

unsafe extern "C-unwind" fn enter<F: FnMut()>(function: *mut c_void) {
    // SAFETY: `call` hands over its function.
    unsafe { (*function.cast::<F>())() }
}

/// Why the call that the thread is in will stop.
pub fn reason(text: String) {
    REASON.with_borrow_mut(|reason| *reason = text);
}

/// Ends the call that the thread is in.
pub fn stop() -> ! {
    let current = CURRENT.get();
    if current.is_null() {
        write(&[b"a library stopped the program outside of its law\n"]);
        std::process::abort();
    }
    // SAFETY: the stack of this thread still holds the frame of `guarded`, which wrote this.
    unsafe { escape((*current).stack) }
}

type Entry = unsafe extern "C-unwind" fn(*mut c_void);

/// Keeps what a function must give back to its caller, notes the stack, and calls; zero if the call returns.
#[cfg(all(target_arch = "x86_64", unix))]
#[unsafe(naked)]
unsafe extern "C-unwind" fn guarded(stack: *mut usize, call: Entry, data: *mut c_void) -> u32 {
    std::arch::naked_asm!(
        "push rbp",
        "push rbx",
        "push r12",
        "push r13",
        "push r14",
        "push r15",
        "sub rsp, 8",
        "mov [rdi], rsp",
        "mov rdi, rdx",
        "call rsi",
        "xor eax, eax",
        "jmp {leave}",
        leave = sym leave,
    )
}

/// The end of `guarded`: what was kept goes back to its caller.
#[cfg(all(target_arch = "x86_64", unix))]
#[unsafe(naked)]
unsafe extern "C-unwind" fn leave() -> ! {
    std::arch::naked_asm!("add rsp, 8", "pop r15", "pop r14", "pop r13", "pop r12", "pop rbx", "pop rbp", "ret",)
}

/// Returns from `guarded` with one, wherever the thread is within its call.
#[cfg(all(target_arch = "x86_64", unix))]
#[unsafe(naked)]
unsafe extern "C-unwind" fn escape(stack: usize) -> ! {
    std::arch::naked_asm!(
        "mov rsp, rdi",
        "mov eax, 1",
        "jmp {leave}",
        leave = sym leave,
    )
}

/// On other machines nothing notes the stack.
#[cfg(not(all(target_arch = "x86_64", unix)))]
unsafe fn guarded(_: *mut usize, call: Entry, data: *mut c_void) -> u32 {
    // SAFETY: as the caller's.
    unsafe { call(data) };
    0
}

/// On other machines what stops the law ends the program.
#[cfg(not(all(target_arch = "x86_64", unix)))]
unsafe fn escape(_: usize) -> ! {
    tell(&[b": ", REASON.take().as_bytes()]);
    // SAFETY: it ends the process.
    unsafe { libc::_exit(1) }
}

/// Writes the name of the call that the thread is in and what happened; whether it is in one.
fn tell(what: &[&[u8]]) -> bool {
    let current = CURRENT.get();
    if current.is_null() {
        return false;
    }
    // SAFETY: while `CURRENT` is set, the frame of `call` lives and with it the name.
    write(&[unsafe { &*(*current).name }.as_bytes()]);
    write(what);
    write(&[b"\n"]);
    true
}

fn write(parts: &[&[u8]]) {
    for part in parts {
        // SAFETY: the address and length are those of the part; nothing can be done where standard error is closed.
        unsafe { libc::write(2, part.as_ptr().cast(), part.len() as _) };
    }
}

/// From now on a crash of a law is told.
pub fn listen() {
    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(|| {
        #[cfg(unix)]
        signals::listen();
        // SAFETY: the function is one of this program and asks for nothing.
        unsafe { libc::atexit(at_exit) };
    });
}

/// A law that ends the program, as Fortran's `STOP` does, must not end it as if all were well.
extern "C" fn at_exit() {
    if tell(&[b": it ended the program (STOP or exit)"]) {
        // SAFETY: it ends the process.
        unsafe { libc::_exit(1) };
    }
}

#[cfg(unix)]
mod signals {
    use super::tell;
    use std::mem::MaybeUninit;
    use std::sync::OnceLock;

    const FATAL: [(i32, &str); 5] = [
        (libc::SIGSEGV, "a forbidden address"),
        (libc::SIGBUS, "a forbidden address (bus error)"),
        (libc::SIGFPE, "a forbidden operation of arithmetic"),
        (libc::SIGILL, "a forbidden instruction"),
        (libc::SIGABRT, "its own abort"),
    ];

    /// What was done with these signals before.
    static BEFORE: OnceLock<[libc::sigaction; 5]> = OnceLock::new();

    /// Puts the handler in front of what was there.
    pub fn listen() {
        let now = FATAL.map(|(signal, _)| current(signal));
        if BEFORE.set(now).is_err() {
            return;
        }
        for ((signal, _), mut action) in FATAL.into_iter().zip(now) {
            action.sa_sigaction = handle as *const () as usize;
            action.sa_flags = libc::SA_ONSTACK | libc::SA_SIGINFO;
            // SAFETY: the handler calls nothing that a handler may not.
            unsafe { libc::sigaction(signal, &raw const action, std::ptr::null_mut()) };
        }
    }

    fn current(signal: i32) -> libc::sigaction {
        let mut action = MaybeUninit::<libc::sigaction>::zeroed();
        // SAFETY: zeros are a valid action, and the call fills it in.
        unsafe {
            libc::sigaction(signal, std::ptr::null(), action.as_mut_ptr());
            action.assume_init()
        }
    }

    /// Tells of a law; then, or where none was called, what was there before has its turn: what failed is done once more, and
    /// what was sent is sent once more.
    extern "C" fn handle(signal: i32, info: *mut libc::siginfo_t, _: *mut libc::c_void) {
        let Some(i) = FATAL.iter().position(|(known, _)| *known == signal) else { return };
        let told = tell(&[b" crashed: ", FATAL[i].1.as_bytes()]);
        // SAFETY: all three calls may stand in a handler, and the system gave `info`.
        unsafe {
            match BEFORE.get().filter(|_| !told) {
                Some(before) => drop(libc::sigaction(signal, &raw const before[i], std::ptr::null_mut())),
                None => drop(libc::signal(signal, libc::SIG_DFL)),
            }
            if (*info).si_code <= 0 {
                libc::raise(signal);
            }
        }
    }
}
