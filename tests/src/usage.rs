//! What a running program uses: memory, processor time, descriptors, threads.

use crate::{Process, wait_until};
use std::fs;
use std::thread;
use std::time::{Duration, Instant};

/// Long enough to tell a program that spins from one that retries a connection every 20 ms.
const OBSERVATION: Duration = Duration::from_millis(150);

impl Process {
    /// A line of `/proc/PID/status`, without its name.
    pub fn status(&self, name: &str) -> String {
        let status = fs::read_to_string(format!("/proc/{}/status", self.id())).expect("a running process");
        let line = status.lines().find_map(|line| line.strip_prefix(name)).expect("a known line");
        line.trim_start_matches(':').trim().to_owned()
    }

    /// The scheduling policy: 0 is the usual one, 1 is first in, first out.
    pub fn scheduling_policy(&self) -> String {
        self.stat()[38].clone()
    }

    /// The real-time priority; 0 is none.
    pub fn realtime_priority(&self) -> String {
        self.stat()[37].clone()
    }

    /// Memory in use, in KiB.
    pub fn memory(&self) -> u64 {
        self.kib("VmRSS")
    }

    /// The most memory used so far, in KiB.
    pub fn peak_memory(&self) -> u64 {
        self.kib("VmHWM")
    }

    fn kib(&self, name: &str) -> u64 {
        self.status(name).trim_end_matches(" kB").parse().expect("a number")
    }

    /// Number of open descriptors.
    pub fn descriptors(&self) -> usize {
        fs::read_dir(format!("/proc/{}/fd", self.id())).expect("a running process").count()
    }

    /// Number of bytes read from files so far; what sockets receive does not count.
    pub fn bytes_read(&self) -> u64 {
        let counts = fs::read_to_string(format!("/proc/{}/io", self.id())).expect("a running process");
        let read = counts.lines().find_map(|line| line.strip_prefix("rchar: "));
        read.and_then(|bytes| bytes.parse().ok()).expect("a number")
    }

    /// Number of threads.
    pub fn threads(&self) -> usize {
        self.thread_folders().count()
    }

    /// The share of time during which the program's threads ran or were ready to run; 1.0 is one processor.
    ///
    /// Time spent ready counts because on a busy machine a thread that spins runs only some of the time. The program is
    /// observed for a while, which is the subject of the measurement and no waiting for an event.
    pub fn busy_share(&self) -> f64 {
        let (before, started) = (self.busy_time(), Instant::now());
        thread::sleep(OBSERVATION);
        self.busy_time().saturating_sub(before).as_secs_f64() / started.elapsed().as_secs_f64()
    }

    /// Asserts that the program does not spin.
    ///
    /// It may still be working off what the test sent, so this waits until it is idle: one that spins never is.
    #[track_caller]
    pub fn assert_idle(&self) {
        wait_until("the program is idle", || self.busy_share() < 0.5);
    }

    fn busy_time(&self) -> Duration {
        let of_thread = |folder: fs::DirEntry| {
            // A thread may end between the listing and here.
            let text = fs::read_to_string(folder.path().join("schedstat")).unwrap_or_default();
            text.split_whitespace().take(2).filter_map(|nanoseconds| nanoseconds.parse::<u64>().ok()).sum::<u64>()
        };
        Duration::from_nanos(self.thread_folders().map(of_thread).sum())
    }

    fn thread_folders(&self) -> impl Iterator<Item = fs::DirEntry> {
        fs::read_dir(format!("/proc/{}/task", self.id())).expect("a running process").flatten()
    }
}
