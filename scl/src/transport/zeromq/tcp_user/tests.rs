use super::*;
use std::net::{Ipv4Addr, TcpListener, TcpStream};

/// Finds sockets of this machine in both ways.
fn owners(socket: Socket) -> [Option<Owner>; 2] {
    let tables = loop {
        match Tables::read() {
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => std::thread::yield_now(),
            read => break read.unwrap(),
        }
    };
    [SockDiag::open().unwrap().find(socket).unwrap(), tables.find(socket)]
}

#[test]
fn both_ways_find_the_same_sockets() {
    let own = rustix::process::geteuid().as_raw();
    let loopback = ["127.0.0.1:0", "[::1]:0"].map(|address| TcpListener::bind(address).unwrap());
    for listener in &loopback {
        let address = listener.local_addr().unwrap();
        let client = TcpStream::connect(address).unwrap();
        let (accepted, peer) = listener.accept().unwrap();
        let sockets = [Socket::listening(address), Socket::connected(peer, address), Socket::connected(address, peer)];
        for socket in sockets {
            let [asked, read] = owners(socket);
            assert_eq!(asked, read, "{socket:?}");
            assert_eq!(asked.map(|owner| owner.user), Some(own), "{socket:?}");
        }
        let mut checks = UserChecks::default();
        checks.check_listener(address).unwrap();
        checks.check_peer(peer, address).unwrap();
        drop((client, accepted));
    }
    let address = loopback[0].local_addr().unwrap();
    drop(loopback);
    assert_eq!(owners(Socket::listening(address)), [None, None]);
    let error = UserChecks::default().check_listener(address).unwrap_err();
    assert_eq!(error.kind(), io::ErrorKind::ConnectionRefused);
}

/// A program with IPv6 sockets alone reaches 127.0.0.1 from such an address.
#[test]
fn a_peer_with_a_mapped_address_is_found() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let _client = TcpStream::connect(format!("[::ffff:127.0.0.1]:{}", address.port())).unwrap();
    let (_accepted, peer) = listener.accept().unwrap();
    let [asked, read] = owners(Socket::connected(peer, address));
    assert!(asked.is_some_and(|owner| owner.inode != 0), "{peer}");
    assert_eq!(asked, read);
}

#[test]
fn a_listener_at_all_addresses_is_not_the_one_at_127_0_0_1() {
    let listener = TcpListener::bind("0.0.0.0:0").unwrap();
    let address = SocketAddr::new(Ipv4Addr::LOCALHOST.into(), listener.local_addr().unwrap().port());
    assert_eq!(owners(Socket::listening(address)), [None, None]);
    // Nor is it the other end of a connection from that port.
    assert_eq!(owners(Socket::connected(address, (Ipv4Addr::LOCALHOST, 1).into())), [None, None]);
}

/// The kernel names root as its owner, so the programs of root would trust it.
#[test]
fn a_socket_that_its_process_has_closed_belongs_to_nobody() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let client = TcpStream::connect(address).unwrap();
    let (_accepted, peer) = listener.accept().unwrap();
    drop(client);
    let error = UserChecks::default().check_peer(peer, address).unwrap_err();
    assert_eq!(error.kind(), io::ErrorKind::ConnectionRefused);
}
