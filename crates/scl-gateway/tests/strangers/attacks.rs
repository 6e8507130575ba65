//! What strangers do. Each attack goes on until standard input ends, and fails if it succeeds.

use super::{AUTHORITY, GATEWAY};
use rustls::pki_types::pem::PemObject;
use rustls::pki_types::{CertificateDer, ServerName};
use rustls::{ClientConfig, ClientConnection, RootCertStore, StreamOwned};
use std::collections::VecDeque;
use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

/// How many connections the silent attack holds. The network library shakes hands with 64 at a time; with more than that, only
/// a firewall helps those that come later. Connections that are there already do not suffer.
const SILENT: usize = 40;
/// Between two looks at silent connections.
const PAUSE: Duration = Duration::from_millis(1);

pub(super) fn run(name: &str) {
    let ended = Arc::new(AtomicBool::new(false));
    let until = Arc::clone(&ended);
    thread::spawn(move || {
        let _until_it_ends = io::stdin().read_to_end(&mut Vec::new());
        until.store(true, Ordering::Relaxed);
    });
    let (mut round, mut held) = (0_u64, VecDeque::new());
    while !ended.load(Ordering::Relaxed) {
        match name {
            "garbage" => garbage(round),
            "no-certificate" => without_certificate(),
            "silence" => stay_silent(&mut held),
            _ => panic!("{name}"),
        }
        if round == 2 * SILENT as u64 {
            println!("\n= begun");
        }
        round += 1;
    }
}

/// The gateway may be gone for a moment; the attack goes on.
fn connect() -> Option<TcpStream> {
    let stream = TcpStream::connect(std::env::var(GATEWAY).unwrap());
    if stream.is_err() {
        thread::yield_now();
    }
    stream.ok()
}

/// Sends bytes that mean nothing, of different length, and waits until the gateway hangs up.
fn garbage(round: u64) {
    let Some(mut stream) = connect() else { return };
    let byte = |index: u64| (index.wrapping_mul(round + 77) >> 3) as u8;
    let bytes: Vec<u8> = match round % 3 {
        0 => (0..1 + round * 61 % 5000).map(byte).collect(),
        // The start of a record of TLS that announces more than will come.
        1 => [&[0x16, 0x03, 0x01, 0x40, 0x00][..], &[0x01; 100]].concat(),
        // A frame of the network library without TLS.
        _ => [&[0x05, 0x00, 0x41, 0x09][..], &[0xff; 30]].concat(),
    };
    let _refused = stream.write_all(&bytes);
    let _half_closed = stream.shutdown(std::net::Shutdown::Write);
    let mut answer = Vec::new();
    let _refused = stream.read_to_end(&mut answer);
    // An alert of TLS at most.
    assert!(answer.len() < 100, "the gateway answers garbage with {} bytes", answer.len());
}

/// Knows the authority's certificate, as everybody may, but has none that it signed.
fn without_certificate() {
    let Some(stream) = connect() else { return };
    let mut roots = RootCertStore::empty();
    roots.add(CertificateDer::from_pem_file(std::env::var(AUTHORITY).unwrap()).unwrap()).unwrap();
    let config = ClientConfig::builder().with_root_certificates(roots).with_no_client_auth();
    let address = std::env::var(GATEWAY).unwrap();
    let name = ServerName::try_from(address.split(':').next().unwrap().to_owned()).unwrap();
    let connection = ClientConnection::new(Arc::new(config), name).unwrap();
    let mut stream = StreamOwned::new(connection, stream);
    // The first message of the network library; the client's handshake is done before the server's.
    let _not_known_yet = stream.write_all(&[0x05, 0x00, 0x41, 0x09, 0x0f, 1, 2, 3]);
    let mut answer = [0];
    let read = stream.read(&mut answer);
    assert!(!matches!(read, Ok(1..)), "the gateway talks with a client without a certificate");
}

/// Holds many connections, and says nothing. Those that the gateway closes are opened again.
fn stay_silent(held: &mut VecDeque<TcpStream>) {
    if held.len() < SILENT {
        held.extend(connect());
        return;
    }
    let Some(oldest) = held.pop_front() else { return };
    oldest.set_nonblocking(true).unwrap();
    match (&oldest).read(&mut [0]) {
        Err(error) if error.kind() == io::ErrorKind::WouldBlock => held.push_back(oldest),
        _closed => {}
    }
    // There is nothing to do until the gateway has had enough of one of them.
    thread::sleep(PAUSE);
}
