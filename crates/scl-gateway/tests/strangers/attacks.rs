//! What strangers do. Each attack goes on until standard input ends, and fails if it succeeds.

use super::{AUTHORITY, GATEWAY};
use rcgen::{CertifiedKey, generate_simple_self_signed};
use rustix::net::{AddressFamily, SocketFlags, SocketType, socket_with};
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use rustls::client::WantsClientCert;
use rustls::pki_types::pem::PemObject;
use rustls::pki_types::{CertificateDer, PrivateKeyDer, ServerName};
use rustls::{ClientConfig, ClientConnection, ConfigBuilder, RootCertStore, StreamOwned};
use std::collections::VecDeque;
use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

/// How many connections are held that never finish their handshake: more than a process may have file descriptors by
/// default.
const HELD: usize = 1200;
/// Addresses from which connections are made, of the last part of 10.77.0.0/24.
const ADDRESSES: u64 = 100;
/// The start of a ClientHello that announces more than will come.
const HALF_HELLO: &[u8] = &[0x16, 0x03, 0x01, 0x01, 0x00, 0x01, 0x00, 0x00, 0xfc, 0x03, 0x03];
/// Between two looks at silent connections.
const PAUSE: Duration = Duration::from_millis(1);

pub(super) fn run(name: &str) {
    let limit = getrlimit(Resource::Nofile);
    setrlimit(Resource::Nofile, Rlimit { current: limit.maximum, ..limit }).unwrap();
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
            "untrusted-certificate" => with_certificate_of_its_own(),
            "break-off" => drop(connect_from(round)),
            "silence" => hold(&mut held, &[]),
            "half-hello" => hold(&mut held, HALF_HELLO),
            "byte-by-byte" => drip(&mut held),
            _ => panic!("{name}"),
        }
        let begun = if name.contains("certificate") || name == "garbage" { 80 } else { 2 * HELD as u64 };
        if round == begun {
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
    shake_hands(|builder| builder.with_no_client_auth());
}

/// Has a certificate that it has signed itself.
fn with_certificate_of_its_own() {
    let CertifiedKey { cert, signing_key } = generate_simple_self_signed(["board".to_owned()]).unwrap();
    let key = PrivateKeyDer::try_from(signing_key.serialize_der()).unwrap();
    shake_hands(|builder| builder.with_client_auth_cert(vec![cert.der().clone()], key).unwrap());
}

fn shake_hands(config: impl FnOnce(ConfigBuilder<ClientConfig, WantsClientCert>) -> ClientConfig) {
    let Some(stream) = connect() else { return };
    let mut roots = RootCertStore::empty();
    roots.add(CertificateDer::from_pem_file(std::env::var(AUTHORITY).unwrap()).unwrap()).unwrap();
    let config = config(ClientConfig::builder().with_root_certificates(roots));
    let address: SocketAddr = std::env::var(GATEWAY).unwrap().parse().unwrap();
    let connection = ClientConnection::new(Arc::new(config), ServerName::from(address.ip())).unwrap();
    let mut stream = StreamOwned::new(connection, stream);
    // The first message of the network library; the client's handshake is done before the server's.
    let _not_known_yet = stream.write_all(&[0x05, 0x00, 0x41, 0x09, 0x0f, 1, 2, 3]);
    let mut answer = [0];
    let read = stream.read(&mut answer);
    assert!(!matches!(read, Ok(1..)), "the gateway talks with a client without a certificate");
}

/// Connects from one of many addresses.
fn connect_from(round: u64) -> Option<TcpStream> {
    let address: SocketAddr = std::env::var(GATEWAY).unwrap().parse().unwrap();
    let socket = socket_with(AddressFamily::INET, SocketType::STREAM, SocketFlags::CLOEXEC, None).unwrap();
    let own = SocketAddr::from(([10, 77, 0, 128 + (round % ADDRESSES) as u8], 0));
    rustix::net::bind(&socket, &own).unwrap();
    rustix::net::connect(&socket, &address).ok()?;
    Some(socket.into())
}

/// Holds many connections on which a handshake begins at most. Those that the gateway closes are opened again.
fn hold(held: &mut VecDeque<TcpStream>, begin: &[u8]) {
    if held.len() < HELD {
        held.extend(connect_from(held.len() as u64).filter(|mut stream| stream.write_all(begin).is_ok()));
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

/// Sends the next byte on each connection in turn, so that each gets one now and then.
fn drip(held: &mut VecDeque<TcpStream>) {
    hold(held, &HALF_HELLO[..1]);
    if let Some(mut oldest) = held.pop_front()
        && oldest.write_all(&[0]).is_ok()
    {
        held.push_back(oldest);
    }
}
