//! The conductor's end of a program: gives it turns, and hears when it waits.

use rustix::event::epoll;
use rustix::io::{Errno, FdFlags, fcntl_setfd};
use rustix::net::{AddressFamily, RecvFlags, SendFlags, SocketFlags, SocketType, recv, send, socketpair, sockopt};
use scl_run::SEAT_FORMAT;
use scl_text::duration::nanoseconds;
use std::io;
use std::os::fd::OwnedFd;
use std::time::Duration;

/// Length of what the program says, in bytes.
const SAID: usize = 24;
/// How long one look at a program that runs takes at most.
const LOOK: Duration = Duration::from_millis(100);
/// What the library says for "as long as nothing happens".
const NEVER: u64 = u64::MAX;

/// A program that takes part.
#[derive(Debug)]
pub(crate) struct Participant {
    /// Its number in the run.
    pub(crate) process: usize,
    pub(crate) component: String,
    pub(crate) connection: OwnedFd,
    /// Ready when something that the program waits for has happened.
    pub(crate) watched: OwnedFd,
    pub(crate) seed: u64,
    /// What the wall clock shows at the start, since 1970.
    start: Duration,
    /// Its process id, once it has said so.
    pub(crate) pid: Option<u32>,
    /// When it has to have a turn at the latest; `None` if it waits for something else.
    pub(crate) due: Option<Duration>,
    /// Whether something that it waits for has happened.
    pub(crate) is_ready: bool,
    /// Whether it was sent a signal since its last turn.
    pub(crate) is_signalled: bool,
    /// When it goes on, if that takes a while after something has happened.
    pub(crate) goes_on: Option<Duration>,
    /// Up to when it does not run.
    pub(crate) paused_until: Duration,
    /// Number of its turns since time has last passed.
    pub(crate) turns: u64,
}

/// What a program has said.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Said {
    /// It waits; this is the time up to which it has moved the clock.
    Waits(Duration),
    /// Nothing yet.
    Nothing,
    /// It has ended, or closed the connection.
    Ended,
    /// Something that no library of this release says.
    Nonsense,
}

/// The descriptors that the program inherits.
#[derive(Debug)]
pub(crate) struct Inherited {
    pub(crate) socket: OwnedFd,
    pub(crate) watched: OwnedFd,
}

impl Participant {
    pub(crate) fn new(process: usize, component: &str, seed: u64, start: Duration) -> io::Result<(Self, Inherited)> {
        let (connection, socket) = socketpair(AddressFamily::UNIX, SocketType::STREAM, SocketFlags::CLOEXEC, None)?;
        sockopt::set_socket_timeout(&connection, sockopt::Timeout::Recv, Some(LOOK))?;
        let watched = epoll::create(epoll::CreateFlags::CLOEXEC)?;
        let inherited = Inherited { socket, watched: watched.try_clone()? };
        // The program that is started next inherits them. No other thread starts programs at the same time.
        fcntl_setfd(&inherited.socket, FdFlags::empty())?;
        fcntl_setfd(&inherited.watched, FdFlags::empty())?;
        let component = component.to_owned();
        let participant = Self {
            process,
            component,
            connection,
            watched,
            seed,
            start,
            pid: None,
            due: Some(Duration::ZERO),
            is_ready: false,
            is_signalled: false,
            goes_on: None,
            paused_until: Duration::ZERO,
            turns: 0,
        };
        Ok((participant, inherited))
    }

    /// Returns true if something that it waits for has happened.
    pub(crate) fn is_woken(&self, now: Duration) -> bool {
        self.is_ready || self.is_signalled || self.due.is_some_and(|due| due <= now)
    }

    /// Returns when it has its next turn, if nothing else happens.
    pub(crate) fn next_turn(&self, now: Duration) -> Option<Duration> {
        let woken = if self.is_ready || self.is_signalled { Some(now) } else { self.due };
        woken.map(|woken| woken.max(self.goes_on.unwrap_or(woken)).max(self.paused_until))
    }

    /// Lets the program run from `now` on. If it has ended, it is found when it is listened to.
    pub(crate) fn give_turn(&mut self, now: Duration) {
        let numbers = [nanoseconds(now), self.seed, u64::from(self.is_signalled), nanoseconds(self.start)];
        let message = numbers.map(u64::to_ne_bytes).concat();
        (self.is_ready, self.is_signalled, self.goes_on, self.turns) = (false, false, None, self.turns + 1);
        // A short message always fits into an empty socket.
        let _ended = send(&self.connection, &message, SendFlags::NOSIGNAL);
    }

    /// Waits for a short time until the program waits.
    pub(crate) fn listen(&mut self) -> io::Result<Said> {
        let mut message = [0_u8; SAID];
        let mut length = 0;
        while length < SAID {
            match recv(&self.connection, &mut message[length..], RecvFlags::empty()) {
                Ok((0, _)) | Err(Errno::CONNRESET) => return Ok(Said::Ended),
                Ok((count, _)) => length += count,
                Err(Errno::AGAIN | Errno::INTR) if length == 0 => return Ok(Said::Nothing),
                Err(Errno::AGAIN | Errno::INTR) => {}
                Err(error) => return Err(error.into()),
            }
        }
        let [head, due, now]: [u64; 3] = std::array::from_fn(|index| {
            let mut number = [0; 8];
            number.copy_from_slice(&message[index * 8..][..8]);
            u64::from_ne_bytes(number)
        });
        let (format, pid) = (head as u32, (head >> 32) as u32);
        if format != SEAT_FORMAT {
            return Ok(Said::Nonsense);
        }
        self.pid = Some(pid);
        self.due = Some(due).filter(|due| *due != NEVER).map(Duration::from_nanos);
        Ok(Said::Waits(Duration::from_nanos(now)))
    }
}
