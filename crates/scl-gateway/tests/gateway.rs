//! A running gateway, and what it logs.

use crate::host::Host;
use rustix::process::{Pid, Signal, kill_process};
use scl_tests::wait_until;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Child, ExitStatus, Stdio};

/// A gateway in a process of its own. It is killed when dropped; its log stays.
pub(crate) struct Gateway {
    process: Child,
    log: PathBuf,
}

impl Gateway {
    /// Starts the gateway of a host. Its log is added to a file.
    pub(crate) fn start(host: &Host, name: &str, topology: &Path, launch: &Path, log: &Path) -> Self {
        let file = File::options().create(true).append(true).open(log).unwrap();
        let mut command = host.command(env!("CARGO_BIN_EXE_scl-gateway"));
        command.arg("run").arg("--topology").arg(topology).arg("--launch").arg(launch).args(["--host", name]);
        command.stdin(Stdio::null()).stdout(file.try_clone().unwrap()).stderr(file);
        Self { process: command.spawn().unwrap(), log: log.to_owned() }
    }

    /// Kills it (SIGKILL).
    pub(crate) fn kill(mut self) {
        self.process.kill().unwrap();
        self.process.wait().unwrap();
    }

    /// Stops it in order (SIGTERM).
    pub(crate) fn stop(mut self) -> ExitStatus {
        let id = Pid::from_raw(self.process.id().cast_signed()).unwrap();
        kill_process(id, Signal::TERM).unwrap();
        self.process.wait().unwrap()
    }

    /// Waits until it ends by itself.
    pub(crate) fn wait_for_exit(mut self) -> ExitStatus {
        self.process.wait().unwrap()
    }

    /// The number of its open file descriptors.
    pub(crate) fn descriptors(&self) -> usize {
        std::fs::read_dir(format!("/proc/{}/fd", self.process.id())).unwrap().count()
    }

    #[track_caller]
    pub(crate) fn assert_runs(&mut self) {
        assert_eq!(self.process.try_wait().unwrap(), None, "the gateway has ended:\n{}", self.log());
    }

    /// Waits until it has logged a text.
    #[track_caller]
    pub(crate) fn wait_for_log(&mut self, text: &str) {
        wait_until(&format!("the gateway logs `{text}`"), || self.log().contains(text));
    }

    pub(crate) fn log(&self) -> String {
        std::fs::read_to_string(&self.log).unwrap()
    }
}

impl Drop for Gateway {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ended = self.process.kill();
        let _status = self.process.wait();
    }
}
