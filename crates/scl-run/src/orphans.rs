//! Processes that have lost their parents. This process adopts those of its programs, as the first process of a
//! container adopts those of all. It reaps them, and at its end kills those that can no longer be traced to their
//! program.

use super::family::{kill_all, relatives};
use super::lock::lock;
use super::process_stat::{children, running_processes};
use rustix::process::{Pid, WaitOptions, getpid, set_child_subreaper, waitpid};
use signal_hook::consts::SIGCHLD;
use signal_hook::iterator::Signals;
use std::io;
use std::process::{Child, Command};
use std::sync::Mutex;
use std::thread;
use std::time::Duration;

/// The children that this process has started. They are reaped by [`wait`], not as orphans.
static STARTED: Mutex<Vec<Pid>> = Mutex::new(Vec::new());

/// Pause between two searches for processes to reap: programs may leave many.
const PAUSE: Duration = Duration::from_millis(50);

/// Starts a child that is not taken for an orphan.
///
/// # Errors
///
/// If no process can be started.
pub(crate) fn spawn(command: &mut Command) -> io::Result<Child> {
    // Hold the lock while spawning, so that `adopted` never takes the child for an orphan, even if it ends at once.
    let mut started = lock(&STARTED);
    let child = command.spawn()?;
    started.push(Pid::from_child(&child));
    Ok(child)
}

/// Waits for the end of a child of [`spawn`], and reaps it.
pub(crate) fn wait(child: &mut Child) {
    let _ = child.wait();
    let ended = Pid::from_child(child);
    lock(&STARTED).retain(|child| *child != ended);
}

/// Makes this process adopt the orphans of its descendants, and starts a thread that reaps them.
///
/// # Errors
///
/// If the operating system provides no file descriptors or no thread.
pub(crate) fn adopt() -> io::Result<()> {
    set_child_subreaper(Some(getpid()))?;
    let mut ended = Signals::new([SIGCHLD])?;
    thread::Builder::new().spawn(move || {
        for _ in ended.forever() {
            reap();
            thread::sleep(PAUSE);
        }
    })?;
    Ok(())
}

/// The orphans that this process has at the moment.
pub(crate) fn adopted() -> Vec<Pid> {
    let started = lock(&STARTED);
    children(getpid()).into_iter().filter(|child| !started.contains(child)).collect()
}

/// Kills all orphans with their descendants, except the orphans in `before`.
pub(crate) fn kill_adopted(before: &[Pid]) {
    kill_all(|| {
        let adopted = adopted();
        relatives(running_processes(), |process, _| adopted.contains(&process) && !before.contains(&process))
    });
}

fn reap() {
    for orphan in adopted() {
        // Orphans that are still running are reaped later.
        let _ = waitpid(Some(orphan), WaitOptions::NOHANG);
    }
}
