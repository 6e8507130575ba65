//! The running programs, of components and builds: each in its own process group, each with threads that watch it.

use super::ending::Ending;
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
use std::time::Instant;

/// What the watching threads tell the supervisor.
#[derive(Debug)]
pub(crate) enum Event {
    /// A program ended.
    Ended { program: usize, ending: Ending },
    /// One of the two streams of a program ended.
    StreamClosed { program: usize },
    /// The reader of our output has gone.
    OutputLost,
    /// A signal asks us to stop.
    Asked(Signal),
}

/// What a program is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// It makes the program of a component.
    Build,
    /// It runs a component.
    Component,
}

/// A running program. It is reaped when this value is dropped, so that its process group id is not reused
/// before that.
#[derive(Debug)]
pub(crate) struct Running {
    process: Child,
    group: Pid,
    /// Start time.
    pub(crate) started: Instant,
}

impl Running {
    /// Starts a program and the threads that watch it; `index` is its number in the events and in the output.
    ///
    /// # Errors
    ///
    /// If no process can be started, or the guard has ended.
    pub(crate) fn start(
        index: usize,
        program: &Program,
        role: Role,
        guard: &mut OrphanGuard,
        output: &Arc<Output>,
        events: &Sender<Event>,
    ) -> io::Result<Self> {
        let mut process = bound_command(&program.command)?
            .current_dir(&program.folder)
            .envs(program.environment.iter().map(|(key, value)| (key, value)))
            .process_group(0)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()?;
        let started = Instant::now();
        let group = Pid::from_raw(process.id().cast_signed());
        let (out, err) = (process.stdout.take(), process.stderr.take());
        let running = Self { process, group, started };
        guard.watch(group)?;
        // Standard output has only what the components print.
        let out_stream = if role == Role::Build { Stream::Err } else { Stream::Out };
        watch_stream(index, out_stream, out, output, events);
        watch_stream(index, Stream::Err, err, output, events);
        watch_end(index, group, events.clone());
        Ok(running)
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

fn watch_stream(
    program: usize,
    stream: Stream,
    from: Option<impl Read + Send + 'static>,
    output: &Arc<Output>,
    events: &Sender<Event>,
) {
    let (output, events) = (Arc::clone(output), events.clone());
    thread::spawn(move || {
        let copied = from.map_or(Ok(()), |from| output.copy_lines(program, stream, from));
        // After the supervisor has finished, nothing receives or needs the event.
        let _ = events.send(if copied.is_ok() { Event::StreamClosed { program } } else { Event::OutputLost });
    });
}

fn watch_end(program: usize, process: Pid, events: Sender<Event>) {
    thread::spawn(move || {
        let _ = events.send(Event::Ended { program, ending: wait_for_end(process) });
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
