//! What a run takes of this machine, from /proc: none where the system has none.

use std::fs;

/// Linux gives times of processes in hundredths of a second, whatever its own clock.
const TICKS_PER_S: f64 = 100.0;

/// Of the numbers in /proc/self/stat behind the name of the process: user and system time, its own and of its children
/// that have ended.
const TIMES: std::ops::Range<usize> = 11..15;

/// Time of the processor that this process and its children took up to now, s.
pub(super) fn processor_s() -> Option<f64> {
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    let (_, numbers) = stat.rsplit_once(')')?;
    let numbers: Vec<_> = numbers.split_whitespace().collect();
    let times = numbers.get(TIMES)?.iter();
    let ticks: f64 = times.filter_map(|time| time.parse::<f64>().ok()).sum();
    Some(ticks / TICKS_PER_S)
}

/// The most memory that this process has had in use, MiB.
pub(super) fn memory_mib() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let peak = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: f64 = peak.trim().strip_suffix(" kB")?.parse().ok()?;
    Some(kib / 1024.0)
}
