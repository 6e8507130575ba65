//! The running programs, of components and builds: each in its own process group, each with threads that watch it.

use super::conductor::Seat;
use super::ending::Ending;
use super::event::Event;
use super::family::{Family, MARK, with_inherited};
use super::log_file::LogStream;
use super::member::{Member, Role};
use super::notify::{Datagrams, NotifySocket};
use super::orphan_guard::{OrphanGuard, bound_command};
use super::orphans;
use super::output::Output;
use super::plan::COMPONENT;
use super::process_group;
use super::streams::Streams;
use super::terminal::{Loan, Terminal};
use rustix::io::Errno;
use rustix::process::{Pid, Signal, WaitId, WaitIdOptions, kill_process_group, waitid};
use std::io::{self, Read};
use std::os::fd::OwnedFd;
use std::os::unix::process::CommandExt;
use std::process::{Child, Stdio};
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::thread;

/// Parameters of one start of a program.
#[derive(Debug)]
pub(crate) struct Start<'a> {
    /// Its number in events.
    pub(crate) process: usize,
    /// The socket on which the program reports that it is ready and alive.
    pub(crate) notify: Option<&'a NotifySocket>,
    /// The terminal that it may read from.
    pub(crate) terminal: Option<Terminal>,
    /// A variable in place of the program's own, with what is kept of its last process.
    pub(crate) kept: Option<(String, String)>,
    /// What it needs to take part in a simulation.
    pub(crate) seat: Option<Seat>,
}

/// A running program. It is reaped when this value is dropped, so that its process group id is not reused
/// before that.
#[derive(Debug)]
pub(crate) struct Running {
    process: Child,
    /// Its process group, which has the number of its first process.
    pub(crate) group: Pid,
    /// `None` for builds: processes that they leave behind, such as a compiler's server, are not ended.
    family: Option<Arc<Family>>,
    /// The terminal that is lent to it.
    pub(crate) terminal: Option<Terminal>,
    /// Whether its processes have received SIGINT from the terminal.
    pub(crate) is_interrupted: bool,
}

impl Running {
    /// Starts a program and the threads that watch it. With `streams`, its output is read there.
    ///
    /// # Errors
    ///
    /// If no process can be started, or the guard has ended.
    pub(crate) fn start(
        member: &Member<'_>,
        start: Start<'_>,
        guard: &mut OrphanGuard,
        output: &Arc<Output>,
        events: &Sender<Event>,
        streams: Option<&mut Streams>,
    ) -> io::Result<Self> {
        let Member { program, label, role, policy, messages, .. } = member;
        let Start { process: number, notify, terminal, kept, seat } = start;
        let mut command = bound_command(&program.command, &program.placement, seat.as_ref());
        // These variables are meant for this process: they were set by systemd or an outer `scl run`.
        for name in ["NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID", COMPONENT] {
            command.env_remove(name);
        }
        let mark = (*role != Role::Build).then(|| format!("{}{number}", guard.run_mark));
        let command = command
            .current_dir(&program.folder)
            .envs(notify.iter().flat_map(|socket| socket.variables(policy.alive_within)))
            .envs(program.environment.iter().map(|(key, value)| (key, value)))
            .envs(kept)
            .envs(mark.iter().map(|mark| (MARK, with_inherited(mark))))
            .process_group(0)
            .stdin(terminal.as_ref().map_or_else(Stdio::null, |_| Stdio::inherit()))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut process = orphans::spawn(command)?;
        let group = Pid::from_child(&process);
        let (out, err) = (process.stdout.take(), process.stderr.take());
        let family = mark.map(|mark| Arc::new(Family::new(group, mark)));
        let lent = terminal.clone();
        let running = Self { process, group, family: family.clone(), terminal, is_interrupted: false };
        guard.watch(group)?;
        let pressed = events.clone();
        let pressed = move |key| _ = pressed.send(Event::Key { process: number, key });
        let loan = lent.map(|terminal| terminal.lend(group, pressed));
        let loan = loan.transpose().inspect_err(|_| guard.forget(group))?;
        // Builds print to standard error: standard output carries only what the components print.
        let out_stream = if *role == Role::Build { LogStream::Stderr } else { LogStream::Stdout };
        let label = *label;
        if let Some(streams) = streams {
            let pipes = [(out.map(OwnedFd::from), out_stream), (err.map(OwnedFd::from), LogStream::Stderr)];
            let mut pipes = pipes.into_iter().filter_map(|(pipe, kind)| Some((pipe?, kind)));
            pipes.try_for_each(|(pipe, kind)| streams.add(number, label, kind, pipe))?;
        } else {
            let shown = Arc::clone(output);
            match messages.clone() {
                // Ignore read errors: a missing program is reported when it is needed.
                Some(messages) => watch_stream(number, out, events, move |out| _ = messages.read(out)),
                None => watch_stream(number, out, events, move |out| shown.copy_lines(label, out_stream, out)),
            }
            let shown = Arc::clone(output);
            watch_stream(number, err, events, move |err| shown.copy_lines(label, LogStream::Stderr, err));
        }
        let datagrams = notify.map(|notify| notify.datagrams.clone());
        watch_end(number, group, family, loan, datagrams, events.clone());
        Ok(running)
    }

    /// Sends a signal to the program's process group.
    pub(crate) fn signal(&self, signal: Signal) {
        // Ignore errors: the group may contain only the program, which has ended.
        let _ = kill_process_group(self.group, signal);
    }

    /// Suspends `scl run` after Ctrl-Z on the program's terminal. When `scl run` is continued, the program is
    /// continued, too.
    pub(crate) fn suspend(&self) {
        self.terminal.iter().for_each(|terminal| terminal.suspend(self.group));
    }

    /// Asks every process of the group to end and, once the group has ended, the processes that have left it. Returns
    /// the processes of the group that were stopped. They are continued, because a stopped process would not end.
    pub(crate) fn ask_to_end(&self, signal: Signal) -> Vec<Pid> {
        let (group, family) = (self.group, self.family.clone());
        // Remember all processes now: some cannot be found any more once their parents have ended.
        let _remembered = family.as_ref().map(|family| family.look());
        let reached = process_group::programs(group);
        let stopped = process_group::stopped(group);
        // A second SIGINT would end an SCL program at once.
        if !(self.is_interrupted && signal == Signal::INT) {
            self.signal(signal);
        }
        if !stopped.is_empty() {
            // Continue it after the signal: a stopped process handles a pending signal first when it continues.
            self.signal(Signal::CONT);
        }
        thread::spawn(move || {
            process_group::repeat_where_missed(group, signal, reached);
            if let Some(family) = family {
                family.end_rest();
            }
        });
        stopped
    }

    /// Kills every process of the program.
    pub(crate) fn kill(&self) {
        match &self.family {
            Some(family) => family.kill(),
            None => self.signal(Signal::KILL),
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.kill();
        orphans::wait(&mut self.process);
    }
}

fn watch_stream<R: Read + Send + 'static>(
    process: usize,
    from: Option<R>,
    events: &Sender<Event>,
    read: impl FnOnce(R) + Send + 'static,
) {
    let events = events.clone();
    thread::spawn(move || {
        from.map(read);
        // After the supervisor has finished, nothing receives or needs the event.
        let _ = events.send(Event::StreamClosed { process });
    });
}

fn watch_end(
    process: usize,
    group: Pid,
    family: Option<Arc<Family>>,
    loan: Option<Loan>,
    datagrams: Option<Datagrams>,
    events: Sender<Event>,
) {
    thread::spawn(move || {
        let report = |event| {
            // First deliver the program's earlier messages, for example that it is the wrong program.
            let _ = datagrams.as_ref().map(Datagrams::take);
            let _ = events.send(event);
        };
        let ending = wait_for_end(group, |signal| report(Event::StoppedByTerminal { process, signal }));
        if let Some(loan) = loan {
            loan.end();
        }
        if let Some(family) = family.filter(|family| !family.is_empty()) {
            report(Event::LeaderEnded { process, ending });
            family.wait_until_empty();
        }
        report(Event::Ended { process, ending });
    });
}

/// Waits for the end of a process without reaping it. Calls `stopped_by_terminal` whenever SIGTTIN or SIGTTOU stops the
/// process.
fn wait_for_end(process: Pid, stopped_by_terminal: impl Fn(Signal)) -> Ending {
    let changes = WaitIdOptions::EXITED | WaitIdOptions::STOPPED | WaitIdOptions::NOWAIT;
    loop {
        let status = match waitid(WaitId::Pid(process), changes) {
            Ok(Some(status)) => status,
            Ok(None) | Err(Errno::INTR) => continue,
            // Dropping `Running` has killed and reaped it.
            Err(_) => return Ending::Killed(Signal::KILL.as_raw()),
        };
        let ended = status.exit_status().map(Ending::Exited).or(status.terminating_signal().map(Ending::Killed));
        if let Some(ending) = ended {
            return ending;
        }
        if let Some(signal) = status.stopping_signal().and_then(Signal::from_named_raw) {
            // Consume the event, or `waitid` would report it again and again.
            let _ = waitid(WaitId::Pid(process), WaitIdOptions::STOPPED | WaitIdOptions::NOHANG);
            if matches!(signal, Signal::TTIN | Signal::TTOU) {
                stopped_by_terminal(signal);
            }
        }
    }
}
