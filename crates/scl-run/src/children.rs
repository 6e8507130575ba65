//! The running programs, of components and builds: each in its own process group, each with threads that watch it.

use super::control::Asked;
use super::ending::Ending;
use super::lifecycle::Notice;
use super::notify::Notified;
use super::orphan_guard::{OrphanGuard, bound_command};
use super::output::{Output, Stream};
use super::program::Program;
use nix::errno::Errno;
use nix::sys::signal::{Signal, killpg};
use nix::sys::wait::{Id, WaitPidFlag, waitid};
use nix::unistd::Pid;
use std::io::{self, Read};
use std::os::unix::process::CommandExt;
use std::process::{Child, Stdio};
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::thread;
use std::time::{Duration, Instant};

/// How long a killed process may need to end.
const LAST_BREATH: Duration = Duration::from_millis(200);

/// What the other threads tell the supervisor.
#[derive(Debug)]
pub(crate) enum Event {
    /// A program ended.
    Ended { process: usize, ending: Ending },
    /// One of the two streams of a program ended.
    StreamClosed { process: usize },
    /// A process of this group said something about itself.
    Notified { group: Pid, notice: Notice },
    /// The reader of our output has gone.
    OutputLost,
    /// A signal asks us to stop.
    Signalled(Signal),
    /// Another `scl` asks for something.
    Asked(Asked),
}

/// What a program is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// It makes the program of a component.
    Build,
    /// It runs a component.
    Component,
    /// It connects the components to those of other hosts.
    Gateway,
}

/// How a program is started, besides what it is.
#[derive(Debug)]
pub(crate) struct Start<'a> {
    /// Its number in events.
    pub(crate) process: usize,
    /// Its number in the output.
    pub(crate) label: usize,
    pub(crate) role: Role,
    /// Where it says that it is ready and alive.
    pub(crate) notify: Option<Notified<'a>>,
}

/// A running program. It is reaped when this value is dropped, so that its process group id is not reused
/// before that.
#[derive(Debug)]
pub(crate) struct Running {
    process: Child,
    group: Pid,
}

impl Running {
    /// Starts a program and the threads that watch it.
    ///
    /// # Errors
    ///
    /// If no process can be started, or the guard has ended.
    pub(crate) fn start(
        program: &Program,
        start: &Start<'_>,
        guard: &mut OrphanGuard,
        output: &Arc<Output>,
        events: &Sender<Event>,
    ) -> io::Result<Self> {
        let mut command = bound_command(&program.command, &program.placement)?;
        // What is set for us, by systemd, is not for our children.
        for name in ["NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"] {
            command.env_remove(name);
        }
        let mut process = command
            .current_dir(&program.folder)
            .envs(start.notify.iter().flat_map(Notified::variables))
            .envs(program.environment.iter().map(|(key, value)| (key, value)))
            .process_group(0)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()?;
        let group = Pid::from_raw(process.id().cast_signed());
        let (out, err) = (process.stdout.take(), process.stderr.take());
        let running = Self { process, group };
        guard.watch(group)?;
        // Standard output has only what the components print.
        let out_stream = if start.role == Role::Build { Stream::Err } else { Stream::Out };
        watch_stream(start, out_stream, out, output, events);
        watch_stream(start, Stream::Err, err, output, events);
        watch_end(start.process, group, events.clone());
        Ok(running)
    }

    /// Its process group, which has the number of its first process.
    pub(crate) fn group(&self) -> Pid {
        self.group
    }

    /// Sends a signal to the program's process group.
    pub(crate) fn signal(&self, signal: Signal) {
        // The group may hold nothing but the ended program, which is not an error.
        let _ = killpg(self.group, signal);
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.signal(Signal::SIGKILL);
        let _ = self.process.wait();
    }
}

/// Waits until the last process of a killed group has gone, so that what they held (a component's lock, a port) is free.
/// Not for long: processes that nobody reaps stay.
pub(crate) fn wait_for_group(group: Pid) {
    let until = Instant::now() + LAST_BREATH;
    while killpg(group, None).is_ok() && Instant::now() < until {
        thread::sleep(Duration::from_millis(1));
    }
}

fn watch_stream(
    start: &Start<'_>,
    stream: Stream,
    from: Option<impl Read + Send + 'static>,
    output: &Arc<Output>,
    events: &Sender<Event>,
) {
    let (output, events) = (Arc::clone(output), events.clone());
    let (process, label) = (start.process, start.label);
    thread::spawn(move || {
        let copied = from.map_or(Ok(()), |from| output.copy_lines(label, stream, from));
        // After the supervisor has finished, nothing receives or needs the event.
        let _ = events.send(if copied.is_ok() { Event::StreamClosed { process } } else { Event::OutputLost });
    });
}

fn watch_end(process: usize, group: Pid, events: Sender<Event>) {
    thread::spawn(move || {
        let _ = events.send(Event::Ended { process, ending: wait_for_end(group) });
    });
}

/// Waits without reaping.
fn wait_for_end(process: Pid) -> Ending {
    loop {
        match waitid(Id::Pid(process), WaitPidFlag::WEXITED | WaitPidFlag::WNOWAIT) {
            Ok(status) => {
                if let Some(ending) = Ending::from_wait(status) {
                    return ending;
                }
            }
            Err(Errno::EINTR) => {}
            // The program was ended by a signal that the library does not know.
            Err(_) => return Ending::KilledByUnnamedSignal,
        }
    }
}
