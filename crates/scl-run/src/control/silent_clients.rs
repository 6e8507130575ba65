//! The clients of the control socket that have not sent a request yet. A new client always gets a place: the oldest of
//! them is disconnected for it, so that clients that say nothing do not keep others out.

use std::collections::VecDeque;
use std::io;
use std::net::Shutdown;
use std::os::unix::net::UnixStream;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// How many there may be. A client usually sends its request as soon as it is connected.
const MOST: usize = 32;

/// The silent clients, oldest first, with their numbers.
#[derive(Debug, Default)]
pub(super) struct SilentClients(Mutex<Clients>);

#[derive(Debug, Default)]
struct Clients {
    next: u64,
    silent: VecDeque<(u64, UnixStream)>,
}

impl SilentClients {
    /// Adds a client and returns its number. Disconnects the oldest one if there are too many.
    ///
    /// # Errors
    ///
    /// If the process is out of file descriptors.
    pub(super) fn add(&self, client: &UnixStream) -> io::Result<u64> {
        let client = client.try_clone()?;
        let mut clients = self.lock();
        let number = clients.next;
        clients.next += 1;
        clients.silent.push_back((number, client));
        if clients.silent.len() > MOST
            && let Some((_, oldest)) = clients.silent.pop_front()
        {
            // Ends the read of its thread.
            let _ = oldest.shutdown(Shutdown::Both);
        }
        Ok(number)
    }

    /// Takes a client out that has sent its request or has gone.
    pub(super) fn remove(&self, number: u64) {
        self.lock().silent.retain(|(other, _)| *other != number);
    }

    fn lock(&self) -> MutexGuard<'_, Clients> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
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
            let number = clients.add(&near).unwrap();
            ends.push((near, far));
            number
        };
        let first = add();
        let second = add();
        clients.remove(first);
        (2..=MOST).for_each(|_| _ = add());
        assert_eq!(clients.lock().silent.len(), MOST);
        add();
        let is_disconnected = |mut far: &UnixStream| far.read(&mut [0]).is_ok_and(|count| count == 0);
        let disconnected: Vec<usize> = (0..ends.len()).filter(|index| is_disconnected(&ends[*index].1)).collect();
        assert_eq!(disconnected, [usize::try_from(second).unwrap()]);
    }
}
