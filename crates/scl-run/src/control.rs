//! The socket by which `scl stop`, `scl restart` and others reach a running `scl run`.
//!
//! `<runtime folder>/<system>/run.<pid>.control`, with mode 0600 in a folder with mode 0700. A client writes one
//! [`Request`] as a line of JSON and reads one [`Response`] as a line of JSON, which comes when the request is done. A
//! line may have up to 64 KiB and must arrive within two seconds.

mod ask;
mod client;
mod protocol;

pub use ask::{Wish, ask};
pub use client::{ControlledRun, find_runs};
pub use protocol::{Command, ComponentReport, Request, Response, VERSION};

use super::children::Event;
use super::own_file::OwnFile;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::thread;
use std::time::{Duration, Instant};

const LONGEST_LINE: u64 = 64 * 1024;
const PATIENCE: Duration = Duration::from_secs(2);
const MOST_CLIENTS: usize = 32;

/// The control socket of this process. Dropping this value removes it.
#[derive(Debug)]
pub(crate) struct ControlSocket {
    _file: OwnFile,
}

/// A request, and where its response goes.
#[derive(Debug)]
pub(crate) struct Asked {
    pub(crate) request: Request,
    client: UnixStream,
}

impl ControlSocket {
    /// Listens in the folder of a system, and sends requests as events.
    ///
    /// # Errors
    ///
    /// If the socket cannot be bound.
    pub(crate) fn open(folder: &Path, events: Sender<Event>) -> io::Result<Self> {
        let (file, listener) = OwnFile::bind(folder, "control", |path| UnixListener::bind(path))?;
        thread::Builder::new().spawn(move || accept_clients(&listener, &events))?;
        Ok(Self { _file: file })
    }
}

impl Asked {
    /// Sends the response without waiting: it fits into the socket's buffer. A client that has gone gets none.
    pub(crate) fn answer(self, response: &Response) {
        send(&self.client, response);
    }
}

fn accept_clients(listener: &UnixListener, events: &Sender<Event>) {
    let clients = Arc::new(());
    loop {
        let Ok((client, _)) = listener.accept() else {
            // Out of file descriptors, which passes.
            thread::sleep(Duration::from_millis(100));
            continue;
        };
        if Arc::strong_count(&clients) > MOST_CLIENTS {
            continue;
        }
        let (events, slot) = (events.clone(), Arc::clone(&clients));
        // Without a thread for it, the client sees the end of the connection.
        let _ = thread::Builder::new().spawn(move || {
            serve(client, &events);
            drop(slot);
        });
    }
}

fn serve(client: UnixStream, events: &Sender<Event>) {
    let Ok(line) = read_line(&client) else { return };
    match Request::parse(&line) {
        Ok(request) => {
            // After the supervisor has finished, the client sees the end of the connection.
            let _ = events.send(Event::Asked(Asked { request, client }));
        }
        Err(error) => send(&client, &Response::error(error)),
    }
}

fn send(mut client: &UnixStream, response: &Response) {
    let line = format!("{}\n", response.to_json());
    let _ = client.set_nonblocking(true).and_then(|()| client.write_all(line.as_bytes()));
}

/// Reads a line within [`PATIENCE`], however slowly its bytes arrive.
fn read_line(client: &UnixStream) -> io::Result<String> {
    let mut line = Vec::new();
    let limited = WithDeadline { client, until: Instant::now() + PATIENCE }.take(LONGEST_LINE);
    BufReader::new(limited).read_until(b'\n', &mut line)?;
    if line.pop() != Some(b'\n') {
        return Err(io::ErrorKind::InvalidData.into());
    }
    String::from_utf8(line).map_err(|_| io::ErrorKind::InvalidData.into())
}

struct WithDeadline<'a> {
    client: &'a UnixStream,
    until: Instant,
}

impl Read for WithDeadline<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = self.until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(io::ErrorKind::TimedOut.into());
        }
        self.client.set_read_timeout(Some(left))?;
        self.client.read(buffer)
    }
}
