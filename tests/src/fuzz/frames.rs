//! A stranger at each end of the `zeromq` transport, over a real Unix socket, and at the decoder behind it.

use super::end::{ENDPOINT, End, Role, exchange, use_until};
use super::zmtp::stream;
use arbitrary::{Result, Unstructured};
use scl::runtime_dir::internals::bind_ipc;
use scl::runtime_dir::{RuntimeDir, SystemDir};
use scl::transport::zeromq::{TransportKind, ZeroMq, decode_for_fuzzing};
use std::cell::Cell;
use std::rc::Rc;
use tempfile::TempDir;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{UnixListener, UnixStream};
use tokio::task::{LocalSet, spawn_local, yield_now};

/// Lets a stranger send to an end, or, at an end that connects, listen and send; the bytes choose which end, and what
/// is sent. Nothing panics, and afterwards the end and a good peer exchange a message.
///
/// # Panics
/// If an end does. A panic in a background task reaches only the panic hook, and an exchange that fails does not
/// return.
pub fn frames(data: &[u8]) {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
    let stage = Stage::new();
    // Too few bytes describe nothing.
    let _played = runtime.block_on(LocalSet::new().run_until(stage.play(&mut Unstructured::new(data))));
}

/// Lets the decoder of the protocol read what a stranger sends, and noise. It returns an error or items, and reserves
/// no memory for what has not arrived.
///
/// # Panics
/// If it does not.
pub fn decoder(data: &[u8]) {
    let _error = decode_for_fuzzing("SUB", usize::MAX, [data]);
    let bytes = &mut Unstructured::new(data);
    let Ok(role) = bytes.choose(&Role::ALL).copied() else { return };
    let Ok(max_size) = bytes.choose(&[0, 100, 64 << 20, usize::MAX]).copied() else { return };
    if let Ok(pieces) = stream(bytes, role.counterpart().socket_type()) {
        let socket_type = std::str::from_utf8(role.socket_type()).expect("a name in ASCII");
        let _error = decode_for_fuzzing(socket_type, max_size, pieces.iter().map(|piece| &piece[..]));
    }
}

struct Stage {
    _folder: TempDir,
    dir: SystemDir,
    transport: ZeroMq,
}

impl Stage {
    fn new() -> Self {
        let folder = TempDir::with_prefix("scl").expect("a folder");
        let variable = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| folder.path().into());
        let dir = RuntimeDir::locate(&variable).and_then(|dir| dir.system("fuzz")).expect("a system's folder");
        Self { _folder: folder, transport: ZeroMq::new(dir.clone(), TransportKind::Ipc), dir }
    }

    async fn play(&self, bytes: &mut Unstructured<'_>) -> Result<()> {
        let role = *bytes.choose(&Role::ALL)?;
        let (has_peer, stays, newest_only): (bool, bool, bool) = bytes.arbitrary()?;
        let pieces = stream(bytes, role.counterpart().socket_type())?;
        let open = |role| self.open(role, newest_only);
        let mut end = open(role);
        if role.listens() {
            let mut peer = None;
            if has_peer {
                exchange([&mut end, peer.insert(open(role.counterpart()))]).await;
            }
            let stranger = self.send_to(&mut end, pieces).await;
            // One that stays either reads what it is sent, or nothing.
            let _stays = match (stays, has_peer) {
                (true, true) => Some(spawn_local(read_on(stranger))),
                (true, false) => Some(spawn_local(never_read(stranger))),
                (false, _) => None,
            };
            exchange([&mut end, peer.get_or_insert_with(|| open(role.counterpart()))]).await;
        } else {
            self.listen_and_send(&mut end, pieces).await;
            exchange([&mut end, &mut open(role.counterpart())]).await;
        }
        Ok(())
    }

    fn open(&self, role: Role, newest_only: bool) -> End {
        End::open(role, newest_only, &self.transport).unwrap_or_else(|error| panic!("{error}"))
    }

    async fn send_to(&self, end: &mut End, pieces: Vec<Vec<u8>>) -> UnixStream {
        let path = self.dir.path(ENDPOINT).expect("a path");
        let socket = UnixStream::connect(path).await.expect("connected");
        let sending = spawn_local(send(socket, pieces));
        use_until(end, || sending.is_finished()).await;
        sending.await.expect("sent")
    }

    /// Listens until the end has connected, and sends it all pieces; then closes everything it has open.
    async fn listen_and_send(&self, end: &mut End, pieces: Vec<Vec<u8>>) {
        let bound = bind_ipc(&self.dir, ENDPOINT).expect("bound");
        let listener = UnixListener::from_std(bound.listener).expect("a listener");
        let served = Rc::new(Cell::new(0));
        let count = Rc::clone(&served);
        let listening = spawn_local(async move {
            let mut sockets = Vec::new();
            while let Ok((socket, _)) = listener.accept().await {
                sockets.push(send(socket, pieces.clone()).await);
                count.set(count.get() + 1);
            }
        });
        use_until(end, || served.get() > 0).await;
        listening.abort();
        let _aborted = listening.await;
    }
}

/// Sends all pieces, or until it is disconnected.
async fn send(mut socket: UnixStream, pieces: Vec<Vec<u8>>) -> UnixStream {
    for piece in pieces {
        if socket.write_all(&piece).await.is_err() {
            break;
        }
        yield_now().await;
    }
    socket
}

async fn read_on(mut socket: UnixStream) {
    let mut received = [0; 4096];
    while matches!(socket.read(&mut received).await, Ok(1..)) {}
}

async fn never_read(_socket: UnixStream) {
    std::future::pending().await
}
