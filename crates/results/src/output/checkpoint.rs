//! Checkpoints: one file from which a run continues to the same bits. A head of fixed size, the state as postcard
//! compressed with zstd, and a SHA-256 of both. All numbers are little-endian; reals keep their eight bytes.
//!
//! | bytes | what |
//! | --- | --- |
//! | 8 | `ASPERITY` |
//! | 4 | version of the format |
//! | 32 | hash of deck and mesh |
//! | 8, 8, 8 | step, increment, time |
//! | 8 | length of the compressed state |
//! | .. | the state |
//! | 32 | SHA-256 of everything before |

use super::file::{self, Durability, write_atomic};
use asperity_core::Error;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::io::BufWriter;
use std::path::Path;

const MAGIC: &[u8; 8] = b"ASPERITY";
/// Raised whenever the head or what the state holds changes.
const VERSION: u32 = 22;
const HEAD: usize = 8 + 4 + 32 + 8 + 8 + 8 + 8;
const SUM: usize = 32;

/// Fingerprint of the input of a run: its deck and its mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct InputHash(pub [u8; 32]);

/// Where in its run a checkpoint stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stamp {
    /// Step.
    pub step: u64,
    /// Accepted increments.
    pub increment: u64,
    /// Total time.
    pub time: f64,
}

/// The head of a checkpoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Head {
    /// The input it belongs to.
    pub input: InputHash,
    /// Where it stands.
    pub stamp: Stamp,
}

impl InputHash {
    /// The hash of several texts, in order; where one ends and the next begins matters.
    pub fn of(parts: &[&[u8]]) -> Self {
        let mut hash = Sha256::new();
        for part in parts {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part);
        }
        Self(hash.finalize().into())
    }
}

impl std::fmt::Display for InputHash {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// Writes a checkpoint, replacing the old one in one step and only when the new one is on the disk.
///
/// # Errors
/// [`Error::File`] when it cannot be written; the old one then still stands.
pub fn save<S: Serialize>(path: &Path, head: &Head, state: &S) -> Result<(), Error> {
    let mut bytes = Vec::from(MAGIC);
    bytes.extend_from_slice(&VERSION.to_le_bytes());
    bytes.extend_from_slice(&head.input.0);
    bytes.extend_from_slice(&head.stamp.step.to_le_bytes());
    bytes.extend_from_slice(&head.stamp.increment.to_le_bytes());
    bytes.extend_from_slice(&head.stamp.time.to_le_bytes());
    bytes.extend_from_slice(&[0; 8]);
    // Compressed as it comes: the state is not there twice.
    let mut bytes = compressed(bytes, state).map_err(|error| Error::file(path, error))?;
    let length = (bytes.len() - HEAD) as u64;
    bytes[HEAD - 8..HEAD].copy_from_slice(&length.to_le_bytes());
    let sum = Sha256::digest(&bytes);
    bytes.extend_from_slice(&sum);
    write_atomic(path, &bytes, Durability::Machine)
}

/// Level of the compression: numbers of a matrix hardly become fewer by more work.
const FAST: i32 = 1;

/// These bytes and a compressed state behind them.
fn compressed<S: Serialize>(bytes: Vec<u8>, state: &S) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let encoder = zstd::stream::Encoder::new(bytes, FAST)?;
    let buffer = postcard::to_io(state, BufWriter::with_capacity(1 << 16, encoder))?;
    Ok(buffer.into_inner().map_err(std::io::IntoInnerError::into_error)?.finish()?)
}

/// Reads a checkpoint.
///
/// # Errors
/// [`Error::File`] when it cannot be read, is no checkpoint, is of another version, or is damaged.
pub fn read<S: DeserializeOwned>(path: &Path) -> Result<(Head, S), Error> {
    let bytes = file::read(path)?;
    let (head, body) = open(&bytes).map_err(|reason| Error::file(path, reason))?;
    let unpacked = zstd::stream::decode_all(body).map_err(|error| Error::file(path, error))?;
    let state = postcard::from_bytes(&unpacked).map_err(|error| Error::file(path, error))?;
    Ok((head, state))
}

/// Reads only the head of a checkpoint; the whole file is checked all the same.
///
/// # Errors
/// As [`read`].
pub fn inspect(path: &Path) -> Result<Head, Error> {
    let bytes = file::read(path)?;
    open(&bytes).map(|(head, _)| head).map_err(|reason| Error::file(path, reason))
}

/// The head and the compressed state of sound bytes.
fn open(bytes: &[u8]) -> Result<(Head, &[u8]), String> {
    if bytes.get(..MAGIC.len()) != Some(MAGIC) {
        return Err("this is not a checkpoint of asperity".into());
    }
    let damaged = || "this checkpoint is damaged; take an older one".to_string();
    let version = u32::from_le_bytes(take(bytes, 8).ok_or_else(damaged)?);
    if version != VERSION {
        return Err(format!("this checkpoint is of format {version}; this program reads format {VERSION}"));
    }
    let (sound, sum) = bytes.split_last_chunk::<SUM>().ok_or_else(damaged)?;
    let length = take(bytes, HEAD - 8).map(u64::from_le_bytes).ok_or_else(damaged)?;
    if (sound.len() as u64).checked_sub(HEAD as u64) != Some(length) || Sha256::digest(sound)[..] != sum[..] {
        return Err(damaged());
    }
    Ok((head(bytes).ok_or_else(damaged)?, &sound[HEAD..]))
}

fn head(bytes: &[u8]) -> Option<Head> {
    let stamp = Stamp {
        step: u64::from_le_bytes(take(bytes, 44)?),
        increment: u64::from_le_bytes(take(bytes, 52)?),
        time: f64::from_le_bytes(take(bytes, 60)?),
    };
    Some(Head { input: InputHash(take(bytes, 12)?), stamp })
}

fn take<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..)?.first_chunk().copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_core::system::{Energies, History, State};
    use proptest::prelude::*;

    fn state() -> State {
        let wave = |n: usize| (0..n).map(|i| (i as f64).sin() * 1e-3).collect::<Vec<_>>();
        State {
            step: 1,
            increment: 17,
            time: 0.1 + 0.2,
            u: wave(300),
            internal: vec![f64::MIN_POSITIVE, -0.0, f64::INFINITY],
            energies: vec![Energies {
                stored: 1.0,
                dissipated: 2.0,
                supplied: 3.0,
                residue: 4.0,
                across: 5.0,
                bonds: 6.0,
            }],
            histories: vec![History { starts: vec![0, 2, 5], data: wave(5) }],
            ..State::default()
        }
    }

    fn head() -> Head {
        Head { input: InputHash::of(&[b"deck", b"mesh"]), stamp: Stamp { step: 1, increment: 17, time: 0.3 } }
    }

    fn saved() -> (tempfile::TempDir, std::path::PathBuf) {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("run.checkpoint");
        save(&path, &head(), &state()).unwrap();
        (directory, path)
    }

    #[test]
    fn the_state_comes_back_to_the_bit() {
        let (_directory, path) = saved();
        let (found, back) = read::<State>(&path).unwrap();
        assert_eq!((found, &back), (head(), &state()));
        assert!(back.internal[1].is_sign_negative());
        assert_eq!(inspect(&path).unwrap(), head());
    }

    #[test]
    fn the_hash_tells_where_a_part_ends() {
        assert_ne!(InputHash::of(&[b"ab", b"c"]), InputHash::of(&[b"a", b"bc"]));
        // The first block of SHA-256 over the length 0 as eight bytes, checked with sha256sum.
        let text = InputHash::of(&[b""]).to_string();
        assert_eq!(text, "af5570f5a1810b7af78caf4bc70a660f0df51e42baf91d4de5b2328de0e83dfc");
    }

    /// Each way of being wrong has its own words.
    #[test]
    fn errors_say_what_is_wrong() {
        let (directory, path) = saved();
        let good = std::fs::read(&path).unwrap();
        let told = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            read::<State>(&path).unwrap_err().to_string()
        };
        let mut other_version = good.clone();
        other_version[8] = 1;
        let mut flipped = good.clone();
        flipped[HEAD + 5] ^= 1;
        assert!(told(b"").contains("not a checkpoint"));
        assert!(told(b"# vtk DataFile").contains("not a checkpoint"));
        assert!(told(&other_version).contains("is of format 1;"));
        assert!(told(&flipped).contains("damaged"));
        assert!(told(&good[..good.len() - 1]).contains("damaged"));
        let missing = read::<State>(&directory.path().join("none")).unwrap_err();
        assert!(missing.to_string().contains("none: "));
    }

    #[test]
    fn every_truncation_is_refused() {
        let (_directory, path) = saved();
        let good = std::fs::read(&path).unwrap();
        assert!((0..good.len()).all(|n| open(&good[..n]).is_err()));
        assert!(open(&[&good[..], b"x"].concat()).is_err());
    }

    proptest! {
        #[test]
        fn every_changed_byte_is_noticed(place in 0usize..1 << 20, change in 1u8..) {
            let (_directory, path) = saved();
            let mut bytes = std::fs::read(&path).unwrap();
            let place = place % bytes.len();
            bytes[place] ^= change;
            prop_assert!(open(&bytes).is_err());
        }
    }
}
