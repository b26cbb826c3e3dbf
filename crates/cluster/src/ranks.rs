//! The ranks of a run: how they begin, agree and end together.

use crate::petsc::{checked, ffi, text};
use asperity_core::system::{Communicator, said};
use std::ffi::{CStr, c_char, c_int};
use std::io::{Cursor, Write};
use std::mem::{MaybeUninit, size_of};
use std::ptr;
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// How long a rank that is in trouble waits for the others to come to the same end.
const PATIENCE: Duration = Duration::from_secs(10);
const LOOK_AGAIN: Duration = Duration::from_millis(5);

/// The code with which a run ends that does not fit into memory.
const NO_MEMORY: c_int = 2;

/// Variables that launchers set, those of one process before those of a whole job: how many processes there are, and which
/// one this is.
const LAUNCHERS: [[&str; 2]; 3] =
    [["OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"], ["PMI_SIZE", "PMI_RANK"], ["SLURM_NTASKS", "SLURM_PROCID"]];

/// What ranks must come to together.
#[derive(Clone, Copy)]
pub(crate) enum Rendezvous {
    Question = 1,
    Pattern,
    Matrix,
    Forces,
    Loads,
    Trial,
    Pieces,
}

/// Bits of a number with which ranks come to what they must come to together.
const BITS: u32 = 28;

/// The ranks that run together.
pub struct Ranks {
    rank: usize,
    size: usize,
    /// A communicator for `arrival` alone: a rank in trouble may come to it while the others are elsewhere.
    own: ffi::MPI_Comm,
    /// Has come to its end; all have once this is done.
    arrival: Mutex<Option<ffi::MPI_Request>>,
    /// Why the last attempt failed here, until the others are known to be where this rank is.
    failure: Mutex<String>,
    /// Why the ranks do not go on, once they have come apart.
    apart: OnceLock<String>,
}

// SAFETY: handles of MPI may be used by any thread, one at a time, for which it is initialised.
unsafe impl Send for Ranks {}
unsafe impl Sync for Ranks {}

static RANKS: OnceLock<Ranks> = OnceLock::new();

/// How many processes the launcher started, and which of them this is, if there is one.
pub fn launched() -> Option<(usize, usize)> {
    let number = |name: &str| std::env::var(name).ok()?.parse::<usize>().ok();
    LAUNCHERS.iter().find_map(|[size, rank]| Some((number(size)?, number(rank).unwrap_or(0))))
}

/// Begins MPI and PETSc, once.
///
/// # Errors
/// What is wrong with the launcher or the libraries, in words.
pub fn start() -> Result<&'static Ranks, String> {
    if let Some(ranks) = RANKS.get() {
        return Ok(ranks);
    }
    let begun = Ranks::begin()?;
    crate::memory::reserve()?;
    Ok(RANKS.get_or_init(|| begun))
}

/// Whether this rank has come to its end: what all must do together it can do no more.
pub(crate) fn has_arrived() -> bool {
    RANKS.get().is_some_and(|ranks| ranks.arrival.lock().is_ok_and(|arrival| arrival.is_some()))
}

impl Ranks {
    /// The ranks, once they have begun.
    pub(crate) fn begun() -> Option<&'static Self> {
        RANKS.get()
    }

    fn begin() -> Result<Self, String> {
        let (mut given, mut rank, mut size, mut own) = (0, 0, 0, MaybeUninit::uninit());
        let serialised = ffi::MPI_THREAD_SERIALIZED as c_int;
        // SAFETY: what is called before PETSc begins may be; errors of MPI end the process.
        unsafe {
            ffi::MPI_Init_thread(ptr::null_mut(), ptr::null_mut(), serialised, &mut given);
            // What a law of a library does wrong is told by who calls it.
            checked(ffi::PetscOptionsSetValue(ptr::null_mut(), text("-no_signal_handler").as_ptr(), ptr::null()))?;
            checked(ffi::PetscInitializeNoArguments())?;
            checked(ffi::PetscPushErrorHandler(Some(ffi::PetscReturnErrorHandler), ptr::null_mut()))?;
            ffi::MPI_Comm_rank(ffi::PETSC_COMM_WORLD, &mut rank);
            ffi::MPI_Comm_size(ffi::PETSC_COMM_WORLD, &mut size);
            ffi::MPI_Comm_dup(ffi::PETSC_COMM_WORLD, own.as_mut_ptr());
        }
        // SAFETY: the call above wrote it.
        let own = unsafe { own.assume_init() };
        let (arrival, failure, apart) = (Mutex::new(None), Mutex::default(), OnceLock::new());
        let ranks = Self { rank: rank as usize, size: size as usize, own, arrival, failure, apart };
        let fault = ranks.alone().or_else(|| (given < serialised).then(|| "this MPI serves no threads".into()));
        fault.map_or_else(other_library, Err).map(|()| ranks)
    }

    /// Why this process is alone where more were wanted; the first alone says so.
    fn alone(&self) -> Option<String> {
        let (wanted, which) = launched().filter(|(wanted, _)| self.size == 1 && *wanted > 1)?;
        if which > 0 {
            std::process::exit(2);
        }
        Some(format!(
            "{wanted} processes are wanted and each is alone: start them by the `mpirun` of the MPI that this program was built \
             with, {}, as `mpirun -n {wanted} asperity run DECK`, or by an `srun` that knows it; one alone by `mpirun -n 1`",
            library()
        ))
    }

    /// Number of this rank, from zero.
    pub fn rank(&self) -> usize {
        self.rank
    }
    /// How many there are.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Smallest and largest of numbers that the ranks come with; all must come to the same, and with the same number where they
    /// do not ask. Those that have come apart once do so for good.
    fn meet(&self, on: Rendezvous, number: u32) -> Result<[u32; 2], String> {
        if let Some(why) = self.apart.get() {
            return Err(why.clone());
        }
        let (mut mine, mut all) = ([((on as u32) << BITS | number) as ffi::PetscInt; 2], [0; 2]);
        // SAFETY: both are pairs.
        checked(unsafe { ffi::PetscGlobalMinMaxInt(ffi::PETSC_COMM_WORLD, mine.as_mut_ptr(), all.as_mut_ptr()) })?;
        let [least, most] = all.map(|number| number as u32);
        let mut failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
        if least == most || matches!(on, Rendezvous::Question) && least >> BITS == most >> BITS {
            failure.clear();
            return Ok([least, most]);
        }
        let why = self.all_failures(&failure)?.unwrap_or_else(|| {
            "a law failed on some of them only, or their processors, libraries or files are not the same".into()
        });
        Err(self.apart.get_or_init(|| format!("the ranks have come to different equations: {why}")).clone())
    }

    /// What failed on some ranks and not on all alike, with their numbers.
    fn all_failures(&self, mine: &str) -> Result<Option<String>, String> {
        let mut lengths = vec![0.0; self.size];
        self.gather(&[mine.len() as f64], &vec![1; self.size], &mut lengths)?;
        let lengths: Vec<c_int> = lengths.iter().map(|length| *length as c_int).collect();
        let (piece, starts) = (mine.bytes().map(f64::from).collect::<Vec<_>>(), starts(&lengths));
        let mut whole = vec![0.0; starts[self.size]];
        self.gather(&piece, &lengths, &mut whole)?;
        let text = |ends: &[usize]| whole[ends[0]..ends[1]].iter().map(|byte| *byte as u8).collect::<Vec<_>>();
        let texts: Vec<String> =
            starts.windows(2).map(|ends| String::from_utf8_lossy(&text(ends)).into_owned()).collect();
        if texts.iter().all(|text| *text == texts[0]) {
            return Ok(None);
        }
        let failed = texts.iter().enumerate().filter(|(_, text)| !text.is_empty());
        Ok(Some(failed.map(|(rank, text)| said(text, rank, self.size)).collect::<Vec<_>>().join("; ")))
    }

    /// Whether any rank says yes; all must ask. Those that have come apart learn why where they meet next.
    pub fn any(&self, yes: bool) -> bool {
        self.meet(Rendezvous::Question, u32::from(yes)).is_ok_and(|[_, most]| most & 1 == 1)
    }

    /// Sees to it that all ranks come here with the same numbers.
    pub(crate) fn agree(&self, on: Rendezvous, numbers: &[f64]) -> Result<(), String> {
        let mix = |hash: u32, x: &f64| {
            let bits = x.to_bits();
            (hash ^ bits as u32 ^ (bits >> 32) as u32).wrapping_mul(0x0100_0193).rotate_left(5)
        };
        let hash = numbers.iter().fold(on as u32, mix) >> (u32::BITS - BITS);
        self.meet(on, hash).map(drop)
    }

    /// Puts together the pieces that the ranks hold of a vector, of these lengths.
    pub(crate) fn gather(&self, piece: &[f64], lengths: &[c_int], whole: &mut [f64]) -> Result<(), String> {
        let starts: Vec<c_int> = starts(lengths).iter().map(|start| *start as c_int).collect();
        let (kind, to) = (doubles()?, whole.as_mut_ptr().cast());
        // SAFETY: the lengths are those of the pieces, and their sum that of the whole.
        unsafe {
            let (mine, all) = (lengths[self.rank], lengths.as_ptr());
            ffi::MPI_Allgatherv(
                piece.as_ptr().cast(),
                mine,
                kind,
                to,
                all,
                starts.as_ptr(),
                kind,
                ffi::PETSC_COMM_WORLD,
            );
        }
        Ok(())
    }

    /// How long the pieces of all ranks are, of which all are to come together.
    fn lengths(&self, piece: &[f64]) -> Result<Vec<c_int>, String> {
        self.agree(Rendezvous::Pieces, &[])?;
        let mut lengths = vec![0.0; self.size];
        self.gather(&[piece.len() as f64], &vec![1; self.size], &mut lengths)?;
        if lengths.iter().sum::<f64>() > f64::from(c_int::MAX) {
            return Err("the ranks have more to tell each other than this MPI counts".into());
        }
        Ok(lengths.iter().map(|length| *length as c_int).collect())
    }

    /// Lets the others know that this rank has come to its end, whatever that is.
    pub fn arrive(&self) {
        let mut arrival = self.arrival.lock().unwrap_or_else(PoisonError::into_inner);
        arrival.get_or_insert_with(|| {
            let mut request = MaybeUninit::uninit();
            // SAFETY: the call writes the request.
            unsafe {
                ffi::MPI_Ibarrier(self.own, request.as_mut_ptr());
                request.assume_init()
            }
        });
    }

    /// Whether all have.
    fn all_arrived(&self) -> bool {
        let mut arrival = self.arrival.lock().unwrap_or_else(PoisonError::into_inner);
        let (mut done, mut status) = (0, MaybeUninit::uninit());
        // SAFETY: the request is that of `arrive`; one that is done is so for good.
        arrival.as_mut().is_some_and(|request| unsafe {
            ffi::MPI_Test(request, &mut done, status.as_mut_ptr());
            done != 0
        })
    }

    /// Ends all ranks, since this one is given no more memory. Takes none itself.
    pub(crate) fn end_without_memory(&self, bytes: usize) {
        extern "C" fn end(_: c_int) {
            // SAFETY: it ends this process.
            unsafe { ffi::_exit(NO_MEMORY) }
        }
        let (rank, size, mut words) = (self.rank, self.size, Cursor::new([0; 512]));
        let _ = writeln!(
            words,
            "error: rank {rank} of {size} is refused {bytes} bytes more of memory: more ranks on more machines, or an iterative \
             `solver.petsc`"
        );
        let length = words.position() as usize;
        // At once, so that no other process writes between.
        let _ = std::io::stderr().write_all(&words.get_ref()[..length]);
        // SAFETY: this ends the process; what MPI lacks of memory for that must not give it another code.
        unsafe {
            ffi::signal(ffi::SIGSEGV as c_int, Some(end));
            ffi::signal(ffi::SIGABRT as c_int, Some(end));
            ffi::MPI_Abort(self.own, NO_MEMORY);
        }
    }

    /// Ends this rank with a code, all together where they come to the same end. Where this one is in trouble alone it says
    /// why, in `words` that were not said yet, and ends all.
    pub fn part(&self, code: u8, words: Option<&str>) {
        self.arrive();
        let begun = Instant::now();
        while !self.all_arrived() {
            if code != 0 && begun.elapsed() > PATIENCE {
                if let Some(words) = words {
                    eprintln!("error: rank {} of {}: {words}", self.rank, self.size);
                }
                // SAFETY: it ends this process.
                unsafe { ffi::MPI_Abort(self.own, c_int::from(code)) };
            }
            std::thread::sleep(LOOK_AGAIN);
        }
        // SAFETY: nothing of either is asked for after.
        unsafe {
            ffi::PetscFinalize();
            ffi::MPI_Finalize();
        }
    }
}

impl Communicator for Ranks {
    fn rank(&self) -> usize {
        self.rank
    }
    fn size(&self) -> usize {
        self.size
    }
    fn agree(&self, numbers: &[f64]) -> Result<(), String> {
        Self::agree(self, Rendezvous::Trial, numbers)
    }
    fn failed(&self, why: &str) {
        why.clone_into(&mut self.failure.lock().unwrap_or_else(PoisonError::into_inner));
    }
    fn gather(&self, piece: &[f64]) -> Result<(Vec<f64>, Vec<usize>), String> {
        let lengths = self.lengths(piece)?;
        let starts = starts(&lengths);
        let mut whole = vec![0.0; starts[self.size]];
        Self::gather(self, piece, &lengths, &mut whole)?;
        Ok((whole, starts))
    }
    fn collect(&self, piece: &[f64]) -> Result<Vec<f64>, String> {
        let lengths = self.lengths(piece)?;
        let (starts, first) = (starts(&lengths), self.rank == 0);
        let mut whole = vec![0.0; if first { starts[self.size] } else { 0 }];
        let starts: Vec<c_int> = starts.iter().map(|start| *start as c_int).collect();
        // SAFETY: the lengths are those of the pieces, and on the first rank their sum is that of the whole.
        unsafe {
            let (kind, from, to) = (doubles()?, piece.as_ptr().cast(), whole.as_mut_ptr().cast());
            let (mine, all, starts) = (lengths[self.rank], lengths.as_ptr(), starts.as_ptr());
            ffi::MPI_Gatherv(from, mine, kind, to, all, starts, kind, 0, ffi::PETSC_COMM_WORLD);
        }
        Ok(whole)
    }
}

/// Where pieces of these lengths begin, one behind the other, and the last ends.
fn starts(lengths: &[c_int]) -> Vec<usize> {
    let ends = lengths.iter().scan(0, |end, length| {
        *end += *length as usize;
        Some(*end)
    });
    std::iter::once(0).chain(ends).collect()
}

/// What MPI calls a number of double precision.
fn doubles() -> Result<ffi::MPI_Datatype, String> {
    let mut kind = MaybeUninit::uninit();
    // SAFETY: the call writes it.
    unsafe {
        checked(ffi::PetscDataTypeToMPIDataType(ffi::PetscDataType_PETSC_DOUBLE, kind.as_mut_ptr()))?;
        Ok(kind.assume_init())
    }
}

/// The name of the MPI, on one line.
fn library() -> String {
    let mut words = [0 as c_char; ffi::MPI_MAX_LIBRARY_VERSION_STRING as usize];
    // SAFETY: it ends with a zero and is no longer than that.
    let words = unsafe {
        ffi::MPI_Get_library_version(words.as_mut_ptr(), &mut 0);
        CStr::from_ptr(words.as_ptr()).to_string_lossy().into_owned()
    };
    words.split([',', '\n']).next().unwrap_or_default().trim().to_owned()
}

/// Whether the library that runs is the one whose headers were read.
fn other_library() -> Result<(), String> {
    let (mut version, mut int) = ([0; 2], 0);
    // SAFETY: the calls write numbers.
    unsafe {
        let [major, minor] = &mut version;
        checked(ffi::PetscGetVersionNumber(major, minor, ptr::null_mut(), ptr::null_mut()))?;
        checked(ffi::PetscDataTypeGetSize(ffi::PetscDataType_PETSC_INT, &mut int))?;
    }
    let built = [ffi::PETSC_VERSION_MAJOR as ffi::PetscInt, ffi::PETSC_VERSION_MINOR as ffi::PetscInt];
    if (version, int) == (built, size_of::<ffi::PetscInt>()) {
        return Ok(());
    }
    let ([major, minor], [other_major, other_minor]) = (built, version);
    Err(format!(
        "this program was built with PETSc {major}.{minor} of integers of {} bytes, and meets PETSc {other_major}.{other_minor} of \
         integers of {int}: load the library that it was built with, or build it again",
        size_of::<ffi::PetscInt>(),
    ))
}
