//! The clients of the control socket that have not sent a request yet. A new client is always accepted: if there are
//! too many, the oldest is disconnected, so that idle clients cannot lock others out.

use super::super::lock::lock;
use std::collections::VecDeque;
use std::net::Shutdown;
use std::os::unix::net::UnixStream;
use std::sync::{Arc, Mutex};

/// Maximum number of silent clients. A client usually sends its request as soon as it is connected.
const MOST: usize = 32;

/// The silent clients, oldest first.
#[derive(Debug, Default)]
pub(super) struct SilentClients(Mutex<VecDeque<Arc<UnixStream>>>);

impl SilentClients {
    /// Adds a client. Disconnects the oldest one if there are too many.
    pub(super) fn add(&self, client: &Arc<UnixStream>) {
        let mut silent = lock(&self.0);
        silent.push_back(Arc::clone(client));
        if silent.len() > MOST
            && let Some(oldest) = silent.pop_front()
        {
            // Ends the blocking read in the client's thread.
            let _ = oldest.shutdown(Shutdown::Both);
        }
    }

    /// Removes a client that has sent its request or disconnected.
    pub(super) fn remove(&self, client: &Arc<UnixStream>) {
        lock(&self.0).retain(|other| !Arc::ptr_eq(other, client));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    #[test]
    fn the_oldest_silent_client_is_disconnected_for_a_new_one() {
        let clients = SilentClients::default();
        let mut ends = Vec::new();
        let mut add = || {
            let (near, far) = UnixStream::pair().unwrap();
            far.set_nonblocking(true).unwrap();
            let near = Arc::new(near);
            clients.add(&near);
            ends.push((Arc::clone(&near), far));
            near
        };
        let first = add();
        add();
        clients.remove(&first);
        (2..=MOST).for_each(|_| _ = add());
        assert_eq!(lock(&clients.0).len(), MOST);
        add();
        let is_disconnected = |mut far: &UnixStream| far.read(&mut [0]).is_ok_and(|count| count == 0);
        let disconnected: Vec<usize> = (0..ends.len()).filter(|index| is_disconnected(&ends[*index].1)).collect();
        assert_eq!(disconnected, [1]);
    }
}
