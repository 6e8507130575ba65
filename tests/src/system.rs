//! The folder in which the programs of one test meet.

use crate::runtime_folder::RuntimeFolder;
use crate::{Address, NEVER, Process};
use scl::{OpenOptions, TransportKind};
use std::ffi::OsStr;
use std::fs::DirBuilder;
use std::os::unix::fs::DirBuilderExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A runtime folder for one test, with a path short enough for any socket.
pub struct System {
    folder: Arc<RuntimeFolder>,
    kind: TransportKind,
}

/// Runs a test with listening gates on Unix sockets, then on TCP.
pub fn on_each_transport(test: impl Fn(System)) {
    for kind in [TransportKind::Ipc, TransportKind::Tcp] {
        test(System::over(kind));
    }
}

impl System {
    /// A fresh folder; gates listen on Unix sockets.
    pub fn new() -> Self {
        Self::over(TransportKind::Ipc)
    }

    /// A fresh folder; gates listen on a transport.
    pub fn over(kind: TransportKind) -> Self {
        Self { folder: Arc::new(RuntimeFolder::new()), kind }
    }

    /// The runtime folder.
    pub fn runtime_dir(&self) -> &Path {
        self.folder.path()
    }

    /// What the gates listen on.
    pub fn transport_kind(&self) -> TransportKind {
        self.kind
    }

    /// For components that the test opens itself.
    pub fn options(&self) -> OpenOptions {
        OpenOptions::new().runtime_dir(self.folder.path()).transport_kind(self.kind)
    }

    /// The files in shared memory that belong to one of this folder's systems.
    pub fn shared_files(&self, system: &str) -> Vec<PathBuf> {
        self.folder.shared_files(system)
    }

    /// What the names of these files begin with.
    pub fn shared_prefix(&self, system: &str) -> String {
        self.folder.shared_prefix(system)
    }

    /// Starts a program in this runtime folder.
    pub fn start(&self, program: &str, arguments: &[&str]) -> Process {
        self.start_with(program, arguments, &[])
    }

    /// Starts a program in this runtime folder with more environment variables.
    pub fn start_with(&self, program: &str, arguments: &[&str], more: &[(&str, &str)]) -> Process {
        let mut environment = vec![
            ("SCL_RUNTIME_DIR", self.folder.path().as_os_str()),
            ("SCL_TRANSPORT", OsStr::new(self.kind.word())),
            ("SCL_STOP_WITHIN", OsStr::new(NEVER)),
        ];
        environment.extend(more.iter().map(|(name, value)| (*name, OsStr::new(value))));
        Process::start(program, arguments, &environment).keeping(Arc::clone(&self.folder))
    }

    /// Starts a program from a shell after some preparation, for example `ulimit -n 40`.
    pub fn start_after(&self, preparation: &str, program: &str, arguments: &[&str]) -> Process {
        let script = format!("{preparation} && exec {program} {}", arguments.join(" "));
        self.start("sh", &["-c", &script])
    }

    /// Where an endpoint of a system listens: `sink.jobs.` and a contract of 8 characters, or a whole name.
    #[track_caller]
    pub fn address(&self, system: &str, endpoint: &str) -> Address {
        let path = self.entry(system, endpoint);
        if path.extension().is_none_or(|extension| extension != "tcp") {
            return Address::Unix(path);
        }
        let text = std::fs::read_to_string(&path).expect("the address of the endpoint");
        Address::Tcp(text.trim().parse().unwrap_or_else(|error| panic!("{text:?}: {error}")))
    }

    /// The path of an endpoint, for listening in place of an SCL program.
    pub fn path(&self, system: &str, endpoint: &str) -> PathBuf {
        let folder = self.folder.path().join(system);
        DirBuilder::new().recursive(true).mode(0o700).create(&folder).expect("the system's folder");
        folder.join(endpoint)
    }

    #[track_caller]
    fn entry(&self, system: &str, endpoint: &str) -> PathBuf {
        let folder = self.folder.path().join(system);
        let entries = std::fs::read_dir(&folder).expect("the system's folder");
        let mut paths = entries.flatten().map(|entry| entry.path());
        let matches = |path: &PathBuf| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let contract = name.strip_prefix(endpoint).map(|rest| rest.strip_suffix(".tcp").unwrap_or(rest));
            contract.is_some_and(|contract| contract.is_empty() || contract.len() == 8)
        };
        paths.find(matches).unwrap_or_else(|| panic!("no endpoint `{endpoint}` in {}", folder.display()))
    }
}

impl Default for System {
    fn default() -> Self {
        Self::new()
    }
}
