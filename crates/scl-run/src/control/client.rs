//! The other side of the control socket: finds every `scl run` and asks it.

use super::super::own_file::{connect, sockets_in};
use super::protocol::{Request, Response};
use std::fs;
use std::io::{self, BufRead, BufReader, Write};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};

/// A `scl run` that can be asked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ControlledRun {
    /// The system whose components it runs.
    pub system: String,
    socket: PathBuf,
}

/// Every `scl run` whose socket is in a folder of a system below the runtime folder; only those of `system`, if given.
pub fn find_runs(runtime_folder: &Path, system: Option<&str>) -> Vec<ControlledRun> {
    let folders = fs::read_dir(runtime_folder).into_iter().flatten().flatten();
    let names = folders.filter_map(|entry| entry.file_name().into_string().ok());
    let mut names: Vec<String> = names.filter(|name| system.is_none_or(|system| system == name)).collect();
    names.sort();
    let runs = names.iter().flat_map(|name| {
        let sockets = sockets_in(&runtime_folder.join(name), "control");
        sockets.into_iter().map(|socket| ControlledRun { system: name.clone(), socket })
    });
    // A connection without a request is closed by the other side, and nothing else.
    runs.filter(|run| connect(&run.socket).is_ok()).collect()
}

impl ControlledRun {
    /// Sends a request and waits for its response, as long as the `scl run` lives.
    ///
    /// # Errors
    ///
    /// If it cannot be reached, or ends before it answers.
    pub fn ask(&self, request: &Request) -> io::Result<Response> {
        let mut connection: UnixStream = connect(&self.socket)?;
        let line = serde_json::to_string(request).map_err(io::Error::other)?;
        connection.write_all(format!("{line}\n").as_bytes())?;
        let mut answer = String::new();
        BufReader::new(connection).read_line(&mut answer)?;
        if answer.is_empty() {
            return Err(io::Error::new(io::ErrorKind::UnexpectedEof, "it ended before it answered"));
        }
        serde_json::from_str(&answer).map_err(io::Error::other)
    }
}
