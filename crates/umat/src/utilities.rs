//! What laws of others may call, under the names that Fortran gives.

use crate::guard;
use asperity_core::tensor::{Tensor2, principal};
use std::ffi::c_void;

/// The names, for the linker of a program that exports them.
pub const SYMBOLS: [&str; 8] =
    ["xit_", "stdb_abqerr_", "getoutdir_", "getjobname_", "rotsig_", "sinv_", "sprinc_", "sprind_"];

/// Keeps the linker from dropping what only libraries call.
pub fn keep() {
    let all: [*const c_void; 8] = [
        xit_ as *const c_void,
        stdb_abqerr_ as *const c_void,
        getoutdir_ as *const c_void,
        getjobname_ as *const c_void,
        rotsig_ as *const c_void,
        sinv_ as *const c_void,
        sprinc_ as *const c_void,
        sprind_ as *const c_void,
    ];
    std::hint::black_box(all);
}

/// The law gives up.
#[unsafe(no_mangle)]
extern "C-unwind" fn xit_() -> ! {
    guard::reason("it calls XIT".into());
    guard::stop()
}

/// A message: a note for 1, a warning for -1, an error for -2, for -3 one that stops. `%I`, `%R` and `%S` stand for the next of
/// the whole numbers, reals and words of eight letters.
///
/// # Safety
/// The addresses must be those of as many values as the text asks for.
#[unsafe(no_mangle)]
unsafe extern "C-unwind" fn stdb_abqerr_(
    kind: *const i32,
    text: *const u8,
    whole: *const i32,
    real: *const f64,
    words: *const u8,
    length: usize,
    _: usize,
) {
    // SAFETY: as the caller's.
    if unsafe { told(*kind, text, length, (whole, real, words)) } {
        guard::stop();
    }
}

/// Says a message; whether the law is to stop.
unsafe fn told(kind: i32, text: *const u8, length: usize, values: (*const i32, *const f64, *const u8)) -> bool {
    // SAFETY: as the caller's.
    let message = unsafe { filled(std::slice::from_raw_parts(text, length), values) };
    if kind == -3 {
        guard::reason(message);
        return true;
    }
    let word = match kind {
        -1 => "warning",
        -2 => "error",
        _ => "note",
    };
    eprintln!("{word}: a law of a library says: {message}");
    false
}

/// A text with its values in their places.
unsafe fn filled(text: &[u8], (whole, real, words): (*const i32, *const f64, *const u8)) -> String {
    let (mut filled, mut rest, mut next) = (Vec::new(), text.trim_ascii(), [0; 3]);
    while let [first, tail @ ..] = rest {
        let kind = tail.first().map(u8::to_ascii_uppercase).filter(|_| *first == b'%');
        let place = kind.and_then(|kind| b"IRS".iter().position(|known| *known == kind));
        rest = if place.is_some() { &tail[1..] } else { tail };
        // SAFETY: the text asks for one value more.
        unsafe {
            match place {
                Some(0) => filled.extend((*whole.add(next[0])).to_string().bytes()),
                Some(1) => filled.extend((*real.add(next[1])).to_string().bytes()),
                Some(_) => filled.extend(std::slice::from_raw_parts(words.add(8 * next[2]), 8).trim_ascii()),
                None => filled.push(*first),
            }
        }
        place.into_iter().for_each(|place| next[place] += 1);
    }
    String::from_utf8_lossy(&filled).into_owned()
}

/// The folder in which the program runs.
///
/// # Safety
/// The addresses must be those of a text of `room` letters and of a number.
#[unsafe(no_mangle)]
unsafe extern "C-unwind" fn getoutdir_(text: *mut u8, length: *mut i32, room: usize) {
    let folder = std::env::current_dir().map(|folder| folder.display().to_string()).unwrap_or_default();
    // SAFETY: as the caller's.
    unsafe { give(&folder, text, length, room) }
}

/// What the run is called.
///
/// # Safety
/// As [`getoutdir_`].
#[unsafe(no_mangle)]
unsafe extern "C-unwind" fn getjobname_(text: *mut u8, length: *mut i32, room: usize) {
    // SAFETY: as the caller's.
    unsafe { give("asperity", text, length, room) }
}

unsafe fn give(what: &str, text: *mut u8, length: *mut i32, room: usize) {
    // SAFETY: as the caller's.
    unsafe {
        let text = std::slice::from_raw_parts_mut(text, room);
        text.fill(b' ');
        text.iter_mut().zip(what.bytes()).for_each(|(place, byte)| *place = byte);
        *length = what.len().min(room) as i32;
    }
}

/// Places of the components 11, 22, 33, 12, 13, 23.
const PLACES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// The place of the component `i` where `direct` are normal.
fn place(i: usize, direct: usize) -> (usize, usize) {
    PLACES[if i < direct { i } else { i - direct + 3 }]
}

/// What a shear component is divided by: strains (2) have shears of engineers.
fn shear(kind: i32) -> f64 {
    if kind == 2 { 2.0 } else { 1.0 }
}

/// A symmetric tensor from its components.
///
/// # Safety
/// The addresses must be those of the interface.
unsafe fn read(s: *const f64, kind: i32, direct: usize, shears: usize) -> Tensor2 {
    let mut t = Tensor2::zero();
    for i in 0..direct + shears {
        let (row, column) = place(i, direct);
        // SAFETY: as the caller's.
        let value = unsafe { *s.add(i) } / if row == column { 1.0 } else { shear(kind) };
        (t[(row, column)], t[(column, row)]) = (value, value);
    }
    t
}

/// Numbers of normal and shear components, within what there can be.
unsafe fn counts(direct: *const i32, shears: *const i32) -> [usize; 2] {
    // SAFETY: as the caller's.
    unsafe { [(*direct).clamp(0, 3) as usize, (*shears).clamp(0, 3) as usize] }
}

/// `R S R^T`.
///
/// # Safety
/// The addresses must be those of the interface: components, nine of the rotation, components.
#[unsafe(no_mangle)]
unsafe extern "C-unwind" fn rotsig_(
    s: *const f64,
    r: *const f64,
    turned: *mut f64,
    kind: *const i32,
    direct: *const i32,
    shears: *const i32,
) {
    // SAFETY: as the caller's.
    unsafe {
        let [direct, shears] = counts(direct, shears);
        let q = Tensor2::from_fn(|i, j| *r.add(i + 3 * j));
        let t = q * read(s, *kind, direct, shears) * q.transpose();
        for i in 0..direct + shears {
            let (row, column) = place(i, direct);
            *turned.add(i) = t[(row, column)] * if row == column { 1.0 } else { shear(*kind) };
        }
    }
}

/// Mean of the normal stresses and equivalent stress of von Mises.
///
/// # Safety
/// The addresses must be those of the interface.
#[unsafe(no_mangle)]
unsafe extern "C-unwind" fn sinv_(
    s: *const f64,
    mean: *mut f64,
    mises: *mut f64,
    direct: *const i32,
    shears: *const i32,
) {
    // SAFETY: as the caller's.
    unsafe {
        let [direct, shears] = counts(direct, shears);
        let t = read(s, 1, direct, shears);
        let deviator = t.deviator();
        *mean = t.trace() / 3.0;
        *mises = (1.5 * deviator.contract(deviator)).sqrt();
    }
}

/// Principal values.
///
/// # Safety
/// The addresses must be those of the interface.
#[unsafe(no_mangle)]
unsafe extern "C-unwind" fn sprinc_(
    s: *const f64,
    values: *mut f64,
    kind: *const i32,
    direct: *const i32,
    shears: *const i32,
) {
    // SAFETY: as the caller's.
    unsafe {
        let [direct, shears] = counts(direct, shears);
        let (principal, _) = principal(&read(s, *kind, direct, shears));
        (0..3).for_each(|i| *values.add(i) = principal[i]);
    }
}

/// Principal values and, row by row of `AN(3,3)`, their directions.
///
/// # Safety
/// The addresses must be those of the interface.
#[unsafe(no_mangle)]
unsafe extern "C-unwind" fn sprind_(
    s: *const f64,
    values: *mut f64,
    axes: *mut f64,
    kind: *const i32,
    direct: *const i32,
    shears: *const i32,
) {
    // SAFETY: as the caller's.
    unsafe {
        let [direct, shears] = counts(direct, shears);
        let (principal, directions) = principal(&read(s, *kind, direct, shears));
        for i in 0..3 {
            *values.add(i) = principal[i];
            (0..3).for_each(|j| *axes.add(i + 3 * j) = directions[(j, i)]);
        }
    }
}
