//! Processor time and memory of this process, as the Linux kernel counts them.
#![allow(dead_code)]

use std::fs::{read_dir, read_to_string};

/// What some work took.
#[derive(Debug, Clone, Copy)]
pub struct Time {
    /// User and system time of all threads, in seconds.
    pub processor: f64,
    /// Time on the wall, in seconds.
    pub wall: f64,
}

/// Does some work and says what it took.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, Time) {
    let (processor, start) = (processor_time(), std::time::Instant::now());
    let result = work();
    let wall = start.elapsed().as_secs_f64();
    (result, Time { processor: processor_time() - processor, wall })
}

/// Seconds that all living threads have run for.
fn processor_time() -> f64 {
    let tasks = read_dir("/proc/self/task").into_iter().flatten().flatten();
    let nanoseconds = tasks.filter_map(|task| {
        let text = read_to_string(task.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse::<f64>().ok()
    });
    nanoseconds.sum::<f64>() * 1e-9
}

/// Largest resident size so far, in kB; zero where the kernel does not say.
pub fn peak() -> usize {
    let status = read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(0)
}
