use super::*;
use rcgen::{CertifiedKey, generate_simple_self_signed};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpSocket;
use tokio_rustls::rustls::pki_types::{CertificateDer, PrivateKeyDer, ServerName};
use tokio_rustls::rustls::{ClientConfig, ClientConnection, RootCertStore};
use tokio_rustls::{TlsConnector, client};

struct Stage {
    address: SocketAddr,
    authority: CertificateDer<'static>,
    listener: TlsListener,
}

impl Stage {
    async fn with_limit(limit: Duration) -> Self {
        let CertifiedKey { cert, signing_key } = generate_simple_self_signed(["gateway".to_owned()]).unwrap();
        let key = PrivateKeyDer::try_from(signing_key.serialize_der()).unwrap();
        let config = ServerConfig::builder().with_no_client_auth();
        let config = config.with_single_cert(vec![cert.der().clone()], key).unwrap();
        let socket = TcpSocket::new_v4().unwrap();
        socket.bind("127.0.0.1:0".parse().unwrap()).unwrap();
        // As many as the network library lets wait: these tests connect before anything is accepted.
        let socket = socket.listen(1024).unwrap();
        let address = socket.local_addr().unwrap();
        let listener = builder(Arc::new(config).into()).handshake_timeout(limit).listen(socket);
        Self { address, authority: cert.der().clone(), listener }
    }

    /// A client that shakes hands as a host does.
    async fn client(address: SocketAddr, authority: CertificateDer<'static>) -> client::TlsStream<TcpStream> {
        let mut roots = RootCertStore::empty();
        roots.add(authority).unwrap();
        let config = ClientConfig::builder().with_root_certificates(roots).with_no_client_auth();
        let stream = TcpStream::connect(address).await.unwrap();
        let connector = TlsConnector::from(Arc::new(config));
        connector.connect(ServerName::try_from("gateway").unwrap(), stream).await.unwrap()
    }

    /// Accepts one client, which is the first that is reported.
    async fn accept_one(&mut self) {
        let client = tokio::spawn(Self::client(self.address, self.authority.clone()));
        let (_stream, address) = self.listener.accept().await.unwrap();
        assert_eq!(client.await.unwrap().get_ref().0.local_addr().unwrap(), address);
    }

    /// Lets the listener work until a future is ready.
    async fn until<T>(&mut self, ready: impl Future<Output = T>) -> T {
        tokio::select! {
            accepted = self.listener.accept() => panic!("accepted {:?}", accepted.map(|(_, address)| address)),
            value = ready => value,
        }
    }
}

const LONG: Duration = Duration::from_secs(600);

#[tokio::test]
async fn failed_handshakes_are_not_reported() {
    let mut stage = Stage::with_limit(LONG).await;
    for bytes in [&b""[..], b"GET / HTTP/1.1\r\n\r\n", b"\x16\x03\x01\x40\x00\x01\x01"] {
        for _ in 0..50 {
            let stream = std::net::TcpStream::connect(stage.address).unwrap();
            io::Write::write_all(&mut &stream, bytes).unwrap();
        }
    }
    stage.accept_one().await;
}

#[tokio::test]
async fn silent_connections_are_closed_after_the_limit() {
    let mut stage = Stage::with_limit(Duration::from_millis(1)).await;
    let mut silent = TcpStream::connect(stage.address).await.unwrap();
    let read = stage.until(silent.read_u8()).await;
    assert_eq!(read.unwrap_err().kind(), io::ErrorKind::UnexpectedEof);
}

#[tokio::test]
async fn the_oldest_unfinished_handshakes_of_an_address_make_room() {
    let mut stage = Stage::with_limit(LONG).await;
    let mut silent = Vec::new();
    for _ in 0..3 * MOST_OF_ONE {
        silent.push(TcpStream::connect(stage.address).await.unwrap());
    }
    for oldest in &mut silent[..2 * MOST_OF_ONE] {
        assert!(stage.until(oldest.read_u8()).await.is_err());
    }
    assert_eq!(stage.listener.unfinished.len(), MOST_OF_ONE);
    assert!(silent[2 * MOST_OF_ONE..].iter().all(|kept| kept.try_read(&mut [0]).is_err()));
    stage.accept_one().await;
}

#[tokio::test]
async fn of_many_addresses_the_one_with_most_unfinished_handshakes_makes_room() {
    let mut stage = Stage::with_limit(LONG).await;
    let mut silent = Vec::new();
    // Loopback has 2^24 addresses.
    for last in 1..=250_u8 {
        for _ in 0..=u8::from(last == 250) * 20 {
            let socket = TcpSocket::new_v4().unwrap();
            socket.bind(SocketAddr::from(([127, 0, 1, last], 0))).unwrap();
            silent.push((last, socket.connect(stage.address).await.unwrap()));
        }
    }
    // Two of these are closed for each one that came too late.
    let surplus = silent.len() - MOST;
    for (last, oldest) in silent.iter_mut().filter(|(last, _)| *last == 250).take(surplus) {
        assert!(stage.until(oldest.read_u8()).await.is_err(), "{last}");
    }
    assert!(silent.iter().filter(|(last, _)| *last < 250).all(|(_, kept)| kept.try_read(&mut [0]).is_err()));
    assert_eq!(stage.listener.unfinished.len(), MOST);
    stage.accept_one().await;
}

/// A host whose handshake takes longer than it takes strangers to connect anew.
#[tokio::test]
async fn a_handshake_that_has_begun_outlasts_silent_connections() {
    let mut stage = Stage::with_limit(LONG).await;
    let mut roots = RootCertStore::empty();
    roots.add(stage.authority.clone()).unwrap();
    let config = ClientConfig::builder().with_root_certificates(roots).with_no_client_auth();
    let name = ServerName::try_from("gateway").unwrap();
    let mut hello = Vec::new();
    ClientConnection::new(Arc::new(config), name).unwrap().write_tls(&mut hello).unwrap();
    let mut host = TcpStream::connect(stage.address).await.unwrap();
    host.write_all(&hello).await.unwrap();
    // The gateway answers.
    stage.until(host.read_u8()).await.unwrap();
    let mut silent = Vec::new();
    for _ in 0..3 * MOST_OF_ONE {
        silent.push(TcpStream::connect(stage.address).await.unwrap());
    }
    for oldest in &mut silent[..2 * MOST_OF_ONE + 1] {
        assert!(stage.until(oldest.read_u8()).await.is_err());
    }
    assert!(stage.listener.unfinished.iter().any(|handshake| handshake.has_begun.load(Ordering::Relaxed)));
}
