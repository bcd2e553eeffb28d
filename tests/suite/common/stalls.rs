//! Waits for other processes, on a machine that may have much else to do and may stall single processes for seconds.

use std::path::PathBuf;
use std::process::Child;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{JoinHandle, sleep, spawn};
use std::time::{Duration, Instant};

/// After which a test that waits is taken to hang.
pub const PATIENCE: Duration = Duration::from_secs(180);

/// How often a process is looked at.
const SAMPLE_TIME: Duration = Duration::from_millis(10);

/// How often a scenario is run at most.
const RUNS: u32 = 12;

/// Waits until `found` is some.
///
/// # Panics
/// Where that takes longer than [`PATIENCE`].
pub fn wait_for<T>(what: &str, mut found: impl FnMut() -> Option<T>) -> T {
    let begun = Instant::now();
    loop {
        if let Some(value) = found() {
            return value;
        }
        assert!(begun.elapsed() < PATIENCE, "it does not come: {what}");
        sleep(SAMPLE_TIME);
    }
}

/// Watches for how long a process does nothing at all: a command that waits for its leg wakes every 50 ms at least.
pub struct StallWatch {
    ended: Arc<AtomicBool>,
    thread: JoinHandle<Duration>,
}

impl StallWatch {
    /// Watches a process from now on.
    pub fn begin(process: &Child) -> Self {
        let status = PathBuf::from(format!("/proc/{}/status", process.id()));
        let ended = Arc::new(AtomicBool::new(false));
        let seen = Arc::clone(&ended);
        let thread = spawn(move || {
            let (mut before, mut changed, mut longest) = (None, Instant::now(), Duration::ZERO);
            while !seen.load(Ordering::Relaxed) {
                let text = std::fs::read_to_string(&status).unwrap_or_default();
                let waits = waits(&text).map(str::to_owned);
                longest = longest.max(changed.elapsed());
                if waits.is_none() {
                    // It has ended.
                    break;
                }
                if waits != before {
                    (before, changed) = (waits, Instant::now());
                }
                sleep(SAMPLE_TIME);
            }
            longest
        });
        Self { ended, thread }
    }

    /// The longest time in which it did nothing.
    fn longest(self) -> Duration {
        self.ended.store(true, Ordering::Relaxed);
        self.thread.join().unwrap_or_default()
    }
}

/// The longest time in which one of several processes did nothing.
pub fn longest_stall(watches: impl IntoIterator<Item = StallWatch>) -> Duration {
    let stalls = watches.into_iter().map(StallWatch::longest);
    stalls.max().unwrap_or_default()
}

/// How often a process has waited for something; none where it has ended.
fn waits(status: &str) -> Option<&str> {
    let value = |key| status.lines().find_map(|line| line.strip_prefix(key));
    let runs = value("State:").is_some_and(|state| !state.trim().starts_with('Z'));
    value("voluntary_ctxt_switches:").filter(|_| runs)
}

/// Runs a scenario that says what is wrong, if anything, and for how long a process of it was stalled at most. Where both
/// something is wrong and it was stalled for longer than is `tolerated`, which shows nothing, it is run again.
///
/// # Panics
/// Where something is wrong without a stall, or always.
pub fn unless_stalled(
    tolerated: Duration,
    mut scenario: impl FnMut() -> (Result<(), String>, Duration),
) {
    for _ in 0..RUNS {
        match scenario() {
            (Ok(()), _) => return,
            (Err(wrong), stall) => {
                assert!(stall > tolerated, "{wrong} (stalled for {stall:?} at most)");
                eprintln!("again, as it was stalled for {stall:?}: {wrong}");
            }
        }
    }
    panic!("it was stalled in each of {RUNS} runs");
}

#[cfg(test)]
mod tests {
    use super::StallWatch;
    use std::process::{Command, Stdio};
    use std::thread::sleep;
    use std::time::Duration;

    /// A process that waits every few milliseconds is told from one that waits once for long.
    #[test]
    fn a_stall_is_seen() -> std::io::Result<()> {
        let stalls = |script: &str| {
            let mut shell = Command::new("sh");
            let mut shell = shell.args(["-c", script]).stdin(Stdio::piped()).spawn()?;
            let watch = StallWatch::begin(&shell);
            sleep(Duration::from_secs(1));
            shell.kill()?;
            shell.wait()?;
            std::io::Result::Ok(watch.longest())
        };
        let still = stalls("read nothing")?;
        assert!(still > Duration::from_millis(900), "{still:?}");
        // It may be stalled itself.
        for _ in 0..20 {
            if stalls("while :; do /bin/true; done")? < still / 2 {
                return Ok(());
            }
        }
        panic!("a process that goes on is taken for one that is stalled");
    }
}
