//! Requests to a running recorder to write its ring, through a socket in the system's folder.
//!
//! The socket is `<recorder's process id>.recorder`. Each connection is a request; when the file is complete, the
//! client receives one line, `ok PATH` or `error TEXT`.

use scl_observe::System;
use scl_terminal::Problem;
use std::fs;
use std::io::Read;
use std::os::unix::net::UnixStream as BlockingStream;
use std::path::{Path, PathBuf};
use std::process;
use std::time::Duration;
use tokio::io::AsyncWriteExt;
use tokio::net::{UnixListener, UnixStream};

const SUFFIX: &str = ".recorder";

/// How long a recorder may take to write its ring.
const PATIENCE: Duration = Duration::from_secs(120);

/// The recorder's end; the socket is removed when it is dropped.
pub(crate) struct TriggerListener {
    /// Each connection is a request to write the ring.
    pub(crate) listener: UnixListener,
    path: PathBuf,
}

impl TriggerListener {
    /// Listens in the system's folder. Must be called inside a tokio runtime.
    pub(crate) fn open(system: &System) -> Result<Self, Problem> {
        let path = system.dir().folder().join(format!("{}{SUFFIX}", process::id()));
        // Left by a killed recorder that had the same process id.
        let _removed = fs::remove_file(&path);
        match UnixListener::bind(&path) {
            Ok(listener) => Ok(Self { listener, path }),
            Err(error) => Err(Problem::new(format!("cannot listen at `{}`: {error}", path.display()))),
        }
    }
}

impl Drop for TriggerListener {
    fn drop(&mut self) {
        let _removed = fs::remove_file(&self.path);
    }
}

/// Sends the result of a request to its client.
pub(crate) async fn answer(mut stream: UnixStream, result: &Result<PathBuf, String>) {
    let line = match result {
        Ok(path) => format!("ok {}\n", path.display()),
        Err(text) => format!("error {text}\n"),
    };
    // The client may have disconnected.
    let _written = stream.write_all(line.as_bytes()).await;
}

/// Asks every recorder of this system that has a ring to write it. Returns the files.
///
/// # Errors
/// No such recorder runs, or one could not write its ring.
pub fn trigger(system: &System) -> Result<Vec<PathBuf>, Problem> {
    let entries = fs::read_dir(system.dir().folder()).into_iter().flatten().flatten();
    let sockets = entries.map(|entry| entry.path()).filter(|path| path.to_string_lossy().ends_with(SUFFIX));
    let mut files = Vec::new();
    for socket in sockets {
        if let Some(answer) = ask(&socket) {
            files.push(answer?);
        }
    }
    if files.is_empty() {
        return Err(Problem::new(format!("no recorder with a ring is running for system `{}`", system.name()))
            .help("start one with `scl record --ring 30s`"));
    }
    Ok(files)
}

/// Asks one recorder; `None` if it is gone.
fn ask(socket: &Path) -> Option<Result<PathBuf, Problem>> {
    let mut stream = BlockingStream::connect(socket).ok()?;
    let mut line = String::new();
    if stream.set_read_timeout(Some(PATIENCE)).and_then(|()| stream.read_to_string(&mut line)).is_err() {
        return Some(Err(Problem::new(format!("the recorder at `{}` does not answer", socket.display()))));
    }
    let line = line.trim_end();
    if let Some(path) = line.strip_prefix("ok ") {
        return Some(Ok(PathBuf::from(path)));
    }
    line.strip_prefix("error ").map(|text| Err(Problem::new(text)))
}
