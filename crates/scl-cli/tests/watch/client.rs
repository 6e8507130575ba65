//! A browser of few words: HTTP/1.1 and server-sent events over a socket.

use crate::system::{ChildGuard, SpawnGuarded};
use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Command, Stdio};

/// A running `scl watch`.
pub(crate) struct Watch {
    _process: ChildGuard,
    pub(crate) address: String,
    pub(crate) token: String,
}

pub(crate) struct Response {
    pub(crate) status: u16,
    pub(crate) headers: Vec<String>,
    reader: BufReader<TcpStream>,
}

/// The events of a page.
pub(crate) struct Events {
    response: Response,
    received: Vec<u8>,
}

/// Starts a command that serves, and reads the address that it prints: `http://<address>/<path>`.
pub(crate) fn start_server(mut command: Command) -> (ChildGuard, String, String) {
    let mut process = command.stdout(Stdio::piped()).spawn_guarded();
    let mut line = String::new();
    BufReader::new(process.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let (address, path) = line.trim().strip_prefix("http://").unwrap().split_once('/').unwrap();
    (process, address.to_owned(), path.to_owned())
}

/// Sends a request with this header `Host`.
pub(crate) fn request(address: &str, method: &str, target: &str, host: &str, body: &str) -> Response {
    let mut stream = TcpStream::connect(address).unwrap();
    let length = body.len();
    let head =
        format!("{method} {target} HTTP/1.1\r\nHost: {host}\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n");
    // What is refused early is not read to its end.
    _ = stream.write_all((head + body).as_bytes());
    let mut reader = BufReader::new(stream);
    let mut line = || {
        let mut line = String::new();
        reader.read_line(&mut line).unwrap();
        line.trim_end().to_owned()
    };
    let status = line().split(' ').nth(1).unwrap().parse().unwrap();
    let headers = std::iter::from_fn(|| Some(line()).filter(|line| !line.is_empty()));
    let headers = headers.map(|line| line.to_lowercase()).collect();
    Response { status, headers, reader }
}

impl Watch {
    /// Starts a `scl watch`.
    pub(crate) fn start(command: Command) -> Self {
        let (process, address, path) = start_server(command);
        let token = path.strip_prefix("?token=").unwrap().to_owned();
        Self { address, token, _process: process }
    }

    /// Gets a path, with the token.
    pub(crate) fn get(&self, path: &str) -> Response {
        let separator = if path.contains('?') { '&' } else { '?' };
        request(&self.address, "GET", &format!("{path}{separator}token={}", self.token), &self.address, "")
    }

    /// Posts a body, with the token.
    pub(crate) fn post(&self, path: &str, body: &str) -> Response {
        request(&self.address, "POST", &format!("{path}?token={}", self.token), &self.address, body)
    }

    /// Opens the events of a page.
    pub(crate) fn events(&self, query: &str) -> Events {
        let response = self.get(&format!("/events?{query}"));
        assert_eq!(response.status, 200);
        Events { response, received: Vec::new() }
    }
}

impl Response {
    /// The whole body, which has a length.
    pub(crate) fn text(mut self) -> String {
        let mut text = String::new();
        self.reader.read_to_string(&mut text).unwrap();
        text
    }

    fn line(&mut self) -> String {
        let mut line = String::new();
        self.reader.read_line(&mut line).unwrap();
        line.trim_end().to_owned()
    }

    /// The next part of a body without a length.
    fn chunk(&mut self) -> Vec<u8> {
        let length = usize::from_str_radix(&self.line(), 16).unwrap();
        let mut chunk = vec![0; length];
        self.reader.read_exact(&mut chunk).unwrap();
        assert_eq!(self.line(), "");
        chunk
    }
}

impl Events {
    /// The next event with this name.
    pub(crate) fn next(&mut self, wanted: &str) -> Value {
        loop {
            while let Some(end) = self.received.windows(2).position(|pair| pair == b"\n\n") {
                let event: Vec<u8> = self.received.drain(..end + 2).collect();
                let event = String::from_utf8(event).unwrap();
                let Some(event) = event.strip_prefix("event: ") else { continue };
                let (name, data) = event.split_once("\ndata: ").unwrap();
                if name == wanted {
                    return serde_json::from_str(data).unwrap();
                }
            }
            let chunk = self.response.chunk();
            assert!(!chunk.is_empty(), "the stream has ended");
            self.received.extend(chunk);
        }
    }
}
