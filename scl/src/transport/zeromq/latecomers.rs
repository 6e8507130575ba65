//! Closing the connections of a listening socket for good.
//!
//! The library runs a writer task for each connection of a PULL or ROUTER socket, which keeps the connection open until
//! the process ends unless the socket is shut down. And a peer whose handshake ends after that is taken in all the same,
//! by a socket that nobody reads any more. So the socket is shut down again until no handshake is under way.

use std::sync::Weak;
use std::time::Duration;
use tokio::runtime::Handle;
use zeromq::{MultiPeerBackend, Socket};

/// The first pause; each is twice as long as the one before, up to [`LONGEST_PAUSE`], for peers that stay silent.
const FIRST_PAUSE: Duration = Duration::from_millis(1);
const LONGEST_PAUSE: Duration = Duration::from_secs(1);

/// Closes all connections when it is dropped, and those that come too late.
pub(super) struct ClosesLatecomers {
    backend: Weak<dyn MultiPeerBackend>,
    runtime: Option<Handle>,
}

impl ClosesLatecomers {
    pub(super) fn of(socket: &impl Socket) -> Self {
        Self { backend: std::sync::Arc::downgrade(&socket.backend()), runtime: Handle::try_current().ok() }
    }
}

impl Drop for ClosesLatecomers {
    fn drop(&mut self) {
        // What keeps the backend alive after its socket are handshakes and writers only.
        if shut_down(&self.backend)
            && let Some(runtime) = &self.runtime
        {
            runtime.spawn(shut_down_until_gone(self.backend.clone()));
        }
    }
}

async fn shut_down_until_gone(backend: Weak<dyn MultiPeerBackend>) {
    let mut pause = FIRST_PAUSE;
    while shut_down(&backend) {
        tokio::time::sleep(pause).await;
        pause = LONGEST_PAUSE.min(pause * 2);
    }
}

/// Whether anything was left to shut down.
fn shut_down(backend: &Weak<dyn MultiPeerBackend>) -> bool {
    let backend = backend.upgrade();
    if let Some(backend) = &backend {
        backend.shutdown();
    }
    backend.is_some()
}
