//! What the machine gives to this process: memory there is, memory in use. Read from Linux's own files; elsewhere, and
//! where a file is not there, nothing is known and nothing is limited.

pub use frontal::give_back_large_arrays;
use std::path::{Path, PathBuf};

/// Memory in use, in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Usage {
    /// Resident now.
    pub resident: u64,
    /// The most that was resident at one time.
    pub peak: u64,
    /// Address space.
    pub addresses: u64,
}

/// Bytes that the process may hold: the memory of the machine, or less where its control group or a limit of its address
/// space says so; `None` where the system does not tell.
pub fn memory() -> Option<u64> {
    [installed(), control_group(), address_space()].into_iter().flatten().min()
}

/// Bytes of address space that the process may take (`ulimit -v`); `None` where there is no limit.
pub fn address_space() -> Option<u64> {
    let limits = std::fs::read_to_string("/proc/self/limits").ok()?;
    limits.lines().find_map(|line| line.strip_prefix("Max address space"))?.split_whitespace().next()?.parse().ok()
}

/// What the process holds now; `None` where the system does not tell.
pub fn usage() -> Option<Usage> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    Some(Usage {
        resident: kilobytes(&status, "VmRSS:")?,
        peak: kilobytes(&status, "VmHWM:")?,
        addresses: kilobytes(&status, "VmSize:")?,
    })
}

/// What limits the memory of the process, and how much of it is taken, in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Room {
    /// What there is for the process in all.
    pub total: u64,
    /// What it has taken of that already.
    pub taken: u64,
    /// Where the limit comes from: "what `solver.memory` allows".
    pub source: &'static str,
}

impl Room {
    /// What is left.
    pub fn left(&self) -> u64 {
        self.total.saturating_sub(self.taken)
    }
}

/// The tightest of the limits of the machine, of control groups and of the address space, and of `allowed` bytes if given;
/// `None` where nothing limits or the system does not tell.
pub fn room(allowed: Option<u64>) -> Option<Room> {
    let usage = usage()?;
    let resident = |source| move |total| Room { total, taken: usage.resident, source };
    let all = [
        allowed.map(resident("what `solver.memory` allows")),
        installed().map(resident("what this machine has")),
        control_group().map(resident("what the control group of this process allows")),
        address_space().map(|total| Room {
            total,
            taken: usage.addresses,
            source: "the limit of its address space (`ulimit -v`)",
        }),
    ];
    all.into_iter().flatten().min_by_key(Room::left)
}

fn installed() -> Option<u64> {
    kilobytes(&std::fs::read_to_string("/proc/meminfo").ok()?, "MemTotal:")
}

/// The bytes of a line `KEY  1234 kB`.
fn kilobytes(text: &str, key: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(key))?;
    Some(1024 * line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?)
}

/// The least limit of the process' control group and of those that hold it, of either version.
fn control_group() -> Option<u64> {
    let groups = std::fs::read_to_string("/proc/self/cgroup").ok()?;
    groups.lines().filter_map(limit_of).min()
}

/// The limit that a line `NUMBER:CONTROLLERS:PATH` leads to.
fn limit_of(line: &str) -> Option<u64> {
    let (controllers, path) = line.split_once(':')?.1.split_once(':')?;
    let path = path.trim_start_matches('/');
    if controllers.is_empty() {
        least(Path::new("/sys/fs/cgroup"), path, "memory.max")
    } else if controllers.split(',').any(|name| name == "memory") {
        least(Path::new("/sys/fs/cgroup/memory"), path, "memory.limit_in_bytes")
    } else {
        None
    }
}

/// The least number in the files of this name from a folder below `root` up to it; "max" is no number.
fn least(root: &Path, path: &str, name: &str) -> Option<u64> {
    let folder: PathBuf = root.join(path);
    let folders = folder.ancestors().take_while(|folder| folder.starts_with(root));
    folders.filter_map(|folder| std::fs::read_to_string(folder.join(name)).ok()?.trim().parse().ok()).min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_limit_above_holds() {
        let root = tempfile::tempdir().unwrap();
        let inner = root.path().join("slice/unit");
        std::fs::create_dir_all(&inner).unwrap();
        std::fs::write(inner.join("memory.max"), "max\n").unwrap();
        assert_eq!(least(root.path(), "slice/unit", "memory.max"), None);
        std::fs::write(root.path().join("slice/memory.max"), "3000\n").unwrap();
        std::fs::write(root.path().join("memory.max"), "9000\n").unwrap();
        assert_eq!(least(root.path(), "slice/unit", "memory.max"), Some(3000));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn this_process_is_known() {
        let usage = usage().unwrap();
        assert!(usage.resident > 1 << 16 && usage.resident <= usage.peak && usage.peak <= usage.addresses);
        assert!(memory().unwrap() > usage.resident);
        let tight = room(Some(usage.peak + (1 << 16))).unwrap();
        assert!(tight.source.contains("solver.memory") && tight.left() < 1 << 24);
        assert!(room(None).unwrap().left() > tight.left());
    }
}
