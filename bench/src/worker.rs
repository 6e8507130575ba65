//! Worker processes: this program, started again to run the other side of a benchmark.

use crate::cores::on_worker_core;
use rustix::process::{Pid, Signal, WaitId, WaitIdOptions, kill_process, waitid};
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use tokio::sync::mpsc::error::TryRecvError;
use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};

/// The first argument of a worker process.
pub const WORKER_COMMAND: &str = "bench-worker";

/// A child process that reports in lines on its standard output; killed when dropped.
pub(crate) struct Worker {
    child: Child,
    /// Closing it ends the worker.
    input: Option<ChildStdin>,
    lines: UnboundedReceiver<String>,
}

impl Worker {
    /// Starts this program as a worker, on the core of the workers.
    pub(crate) fn start(arguments: &[&str]) -> scl::Result<Self> {
        Self::start_with(&[], arguments)
    }

    /// Like [`start`](Self::start), but through a program that starts another one (`chrt -f 80`).
    pub(crate) fn start_with(launcher: &[&str], arguments: &[&str]) -> scl::Result<Self> {
        let program = std::env::current_exe()?;
        let mut command = match launcher {
            [first, rest @ ..] => {
                let mut command = Command::new(first);
                command.args(rest).arg(program);
                command
            }
            [] => Command::new(program),
        };
        command.arg(WORKER_COMMAND).args(arguments);
        on_worker_core(|| Self::spawn(command))?
    }

    /// Like [`start`](Self::start), and waits until the worker reports that it is open.
    pub(crate) async fn start_open(arguments: &[&str]) -> scl::Result<Self> {
        let mut worker = Self::start(arguments)?;
        let _open = worker.next_line().await?;
        Ok(worker)
    }

    /// Starts any program, on the core of the calling thread.
    pub(crate) fn spawn(mut command: Command) -> scl::Result<Self> {
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()?;
        let (sender, lines) = unbounded_channel();
        if let Some(output) = child.stdout.take() {
            std::thread::spawn(move || {
                // Sending fails if the benchmark has dropped the worker.
                BufReader::new(output).lines().map_while(Result::ok).all(|line| sender.send(line).is_ok())
            });
        }
        Ok(Self { input: child.stdin.take(), child, lines })
    }

    /// The process id.
    #[cfg(feature = "gateway")]
    pub(crate) fn id(&self) -> u32 {
        self.child.id()
    }

    /// Waits for the worker's next line.
    pub(crate) async fn next_line(&mut self) -> scl::Result<String> {
        self.lines.recv().await.ok_or_else(ended_early)
    }

    /// Returns the worker's next line if it has been written already.
    pub(crate) fn try_next_line(&mut self) -> scl::Result<Option<String>> {
        match self.lines.try_recv() {
            Ok(line) => Ok(Some(line)),
            Err(TryRecvError::Empty) => Ok(None),
            Err(TryRecvError::Disconnected) => Err(ended_early()),
        }
    }

    /// Writes an empty line to the worker's standard input.
    #[cfg(feature = "libzmq")]
    pub(crate) fn trigger(&mut self) -> scl::Result<()> {
        let Some(input) = &mut self.input else { return Err(ended_early()) };
        Ok(input.write_all(b"\n")?)
    }

    /// Stops the process with SIGSTOP and waits until it has stopped.
    pub(crate) fn stop(&self) -> scl::Result<()> {
        let process = Pid::from_child(&self.child);
        kill_process(process, Signal::STOP)?;
        // If the process has exited instead, the next attempt to read a line reports it.
        waitid(WaitId::Pid(process), WaitIdOptions::STOPPED | WaitIdOptions::EXITED | WaitIdOptions::NOWAIT)?;
        Ok(())
    }

    /// Continues the process after [`stop`](Self::stop).
    pub(crate) fn resume(&self) -> scl::Result<()> {
        Ok(kill_process(Pid::from_child(&self.child), Signal::CONT)?)
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        drop(self.input.take());
        // Fails if the process has exited already.
        let _exited = self.child.kill();
        let _status = self.child.wait();
    }
}

fn ended_early() -> scl::Error {
    scl::Error::message("a worker process exited early; its error is printed above")
}

/// Reports a line to the process that started this worker.
pub(crate) fn print_line(line: &str) -> scl::Result<()> {
    let mut output = std::io::stdout().lock();
    writeln!(output, "{line}")?;
    Ok(output.flush()?)
}

/// Exits as soon as the process that started this worker is gone.
pub(crate) fn exit_when_input_closes() {
    std::thread::spawn(|| {
        for line in std::io::stdin().lines() {
            if line.is_err() {
                break;
            }
        }
        std::process::exit(0);
    });
}

/// The error of a worker that does not know its arguments. Users see it only if they start a worker themselves.
pub(crate) fn unknown_arguments(arguments: &[&str]) -> scl::Error {
    let arguments = arguments.join(" ");
    scl::Error::message(format!("`{WORKER_COMMAND} {arguments}` is used internally by `scl bench`"))
}
