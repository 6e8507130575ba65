//! The socket by which `scl stop`, `scl restart` and others reach a running `scl run`.
//!
//! `<runtime folder>/<system>/run.<pid>.control`, with mode 0600 in a folder with mode 0700. A client writes one
//! [`Request`] as a line of JSON and reads one [`Response`] as a line of JSON, which comes when the request is done. A
//! line may have up to 64 KiB and must arrive within two seconds. Of more than 32 clients that have sent no line yet,
//! the oldest is disconnected.

mod ask;
mod build;
mod client;
mod protocol;
mod silent_clients;

pub use ask::{ControlOptions, Done, ask};
pub use client::{ControlledRun, NoAnswer, find_runs};
pub use protocol::{BuildCommand, Command, ComponentReport, Request, Response, VERSION};

use super::own_file::OwnFile;
use silent_clients::SilentClients;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

const LONGEST_LINE: u64 = 64 * 1024;
const PATIENCE: Duration = Duration::from_secs(2);

/// The control socket of this process. Dropping this value removes it.
pub(crate) struct ControlSocket {
    pub(crate) file: OwnFile,
    accept: Box<dyn Fn(UnixListener) -> io::Result<()> + Send + Sync>,
}

/// A request, and where its response goes.
#[derive(Debug)]
pub(crate) struct ReceivedRequest {
    pub(crate) request: Request,
    client: Arc<UnixStream>,
    named_after: Option<PathBuf>,
}

impl ControlSocket {
    /// Listens in the folder of a system and passes each request to `receive`, on a separate thread per client. Every
    /// response contains `named_after`.
    ///
    /// # Errors
    ///
    /// If the socket cannot be bound.
    pub(crate) fn open(
        folder: &Path,
        named_after: Option<PathBuf>,
        receive: impl Fn(ReceivedRequest) + Clone + Send + Sync + 'static,
    ) -> io::Result<Self> {
        let (file, listener) = OwnFile::bind(folder, "control", |path| UnixListener::bind(path))?;
        let receive =
            move |request, client| receive(ReceivedRequest { request, client, named_after: named_after.clone() });
        let accept = move |listener| {
            let receive = receive.clone();
            thread::Builder::new().spawn(move || accept_clients(&listener, &receive)).map(drop)
        };
        accept(listener)?;
        Ok(Self { file, accept: Box::new(accept) })
    }

    /// Listens again after the folder was removed and created again.
    ///
    /// # Errors
    ///
    /// If the socket cannot be bound.
    pub(crate) fn restore(&self) -> io::Result<()> {
        (self.accept)(self.file.bind_again(|path| UnixListener::bind(path))?)
    }
}

impl ReceivedRequest {
    /// Sends the response without blocking: it fits into the socket's buffer. Errors are ignored: the client may have
    /// disconnected.
    pub(crate) fn answer(self, response: &Response) {
        send(&self.client, &Response { named_after: self.named_after, ..response.clone() });
    }
}

fn accept_clients(listener: &UnixListener, receive: &(impl Fn(Request, Arc<UnixStream>) + Clone + Send + 'static)) {
    let silent = Arc::new(SilentClients::default());
    loop {
        let Ok((client, _)) = listener.accept() else {
            // Probably out of file descriptors; retry later.
            thread::sleep(Duration::from_millis(100));
            continue;
        };
        let client = Arc::new(client);
        silent.add(&client);
        let (receive, all, own) = (receive.clone(), Arc::clone(&silent), Arc::clone(&client));
        let served = thread::Builder::new().spawn(move || {
            let line = read_line(&own);
            all.remove(&own);
            match line.map(|line| Request::parse(&line)) {
                Ok(Ok(request)) => receive(request, own),
                Ok(Err(error)) => send(&own, &Response::error(error)),
                // The client disconnected or did not send a whole line.
                Err(_) => {}
            }
        });
        // If no thread can be started, forget the client, which closes the connection.
        if served.is_err() {
            silent.remove(&client);
        }
    }
}

fn send(mut client: &UnixStream, response: &Response) {
    // Strings and numbers can always be serialized.
    let line = serde_json::to_string(response).unwrap_or_default() + "\n";
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
