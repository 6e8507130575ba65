//! A stranger at each end of the `zeromq` transport, over a real Unix socket.

use super::end::{ENDPOINT, End, Role, exchange, use_until};
use super::zmtp::speech;
use arbitrary::{Result, Unstructured};
use scl::place::{RuntimeDir, SystemDir, bind_ipc};
use scl::transport::zeromq::{Medium, ZeroMq};
use std::cell::Cell;
use std::rc::Rc;
use tempfile::TempDir;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{UnixListener, UnixStream};
use tokio::task::{LocalSet, spawn_local, yield_now};

/// Lets a stranger speak to an end, whichever the bytes choose, and says what they say. Nothing panics, and afterwards a
/// good peer and the end exchange a message.
///
/// # Panics
/// If an end does. A panic in a task of the library's is told to the panic hook alone, and an exchange that fails does
/// not return.
pub fn frames(data: &[u8]) {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
    let stage = Stage::new();
    // Too few bytes are no scene.
    let _scene = runtime.block_on(LocalSet::new().run_until(stage.play(&mut Unstructured::new(data))));
}

struct Stage {
    _folder: TempDir,
    place: SystemDir,
    transport: ZeroMq,
}

impl Stage {
    fn new() -> Self {
        let folder = TempDir::with_prefix("scl").expect("a folder");
        let variable = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| folder.path().into());
        let place = RuntimeDir::locate(&variable).and_then(|dir| dir.system("fuzz")).expect("a place");
        Self { _folder: folder, transport: ZeroMq::new(place.clone(), Medium::Ipc), place }
    }

    async fn play(&self, bytes: &mut Unstructured<'_>) -> Result<()> {
        let role = *bytes.choose(&Role::ALL)?;
        let (peer_is_there, stays): (bool, bool) = bytes.arbitrary()?;
        let words = speech(bytes, role.counterpart().kind())?;
        let mut end = self.open(role);
        if role.listens() {
            let mut peer = None;
            if peer_is_there {
                exchange([&mut end, peer.insert(self.open(role.counterpart()))]).await;
            }
            let stranger = self.speak_to(&mut end, words).await;
            // One that stays reads what it is sent; one that does not makes a publisher wait, as it may.
            let _reader = stays.then(|| spawn_local(read_on(stranger)));
            exchange([&mut end, peer.get_or_insert_with(|| self.open(role.counterpart()))]).await;
        } else {
            self.listen_as_a_stranger(&mut end, words).await;
            exchange([&mut end, &mut self.open(role.counterpart())]).await;
        }
        Ok(())
    }

    fn open(&self, role: Role) -> End {
        End::open(role, &self.transport).unwrap_or_else(|error| panic!("{error}"))
    }

    async fn speak_to(&self, end: &mut End, words: Vec<Vec<u8>>) -> UnixStream {
        let path = self.place.path(ENDPOINT).expect("a path");
        let stream = UnixStream::connect(path).await.expect("connected");
        let speaking = spawn_local(speak(stream, words));
        use_until(end, || speaking.is_finished()).await;
        speaking.await.expect("spoken")
    }

    /// Says the words to whoever connects, until two have heard them all: an end looks whether somebody listens before it
    /// connects in earnest. Then everything that the stranger had open is closed.
    async fn listen_as_a_stranger(&self, end: &mut End, words: Vec<Vec<u8>>) {
        let bound = bind_ipc(&self.place, ENDPOINT).expect("bound");
        let listener = UnixListener::from_std(bound.listener).expect("a listener");
        let heard = Rc::new(Cell::new(0));
        let count = Rc::clone(&heard);
        let listening = spawn_local(async move {
            let mut streams = Vec::new();
            while let Ok((stream, _)) = listener.accept().await {
                streams.push(speak(stream, words.clone()).await);
                count.set(count.get() + 1);
            }
        });
        use_until(end, || heard.get() >= 2).await;
        listening.abort();
        let _aborted = listening.await;
    }
}

/// Says all words, unless it is thrown out before.
async fn speak(mut stream: UnixStream, words: Vec<Vec<u8>>) -> UnixStream {
    for piece in words {
        if stream.write_all(&piece).await.is_err() {
            break;
        }
        yield_now().await;
    }
    stream
}

async fn read_on(mut stream: UnixStream) {
    let mut heard = [0; 4096];
    while matches!(stream.read(&mut heard).await, Ok(1..)) {}
}
