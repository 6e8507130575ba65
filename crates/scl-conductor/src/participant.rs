//! The conductor's end of a program: gives it turns, and hears when it waits.

use rustix::event::epoll;
use rustix::io::{Errno, FdFlags, fcntl_setfd};
use rustix::net::{
    AddressFamily, RecvAncillaryBuffer, RecvAncillaryMessage, RecvFlags, SendAncillaryBuffer, SendAncillaryMessage,
    SendFlags, SocketFlags, SocketType, recv, recvmsg, send, sendmsg, socketpair, sockopt,
};
use rustix::process::{Pid, Signal, kill_process};
use scl_run::SEAT_FORMAT;
use scl_text::duration::nanoseconds;
use std::io::{self, IoSlice, IoSliceMut};
use std::mem::MaybeUninit;
use std::os::fd::{AsFd, OwnedFd};
use std::time::Duration;

/// Length of what the program says, in bytes.
const SAID: usize = 24;
/// The kinds of what it says.
const WAITS: u16 = 0;
const CONNECTS: u16 = 1;
/// Length of the path of a socket, in bytes.
const PATH: usize = 108;
/// How long one look at a program that runs takes at most.
const LOOK: Duration = Duration::from_millis(100);
/// What the library says for "as long as nothing happens".
const NEVER: u64 = u64::MAX;

/// A program that takes part.
#[derive(Debug)]
pub(crate) struct Participant {
    /// Its number in the run.
    pub(crate) process: usize,
    /// The component that it runs; `None` for the program that records.
    pub(crate) component: Option<String>,
    pub(crate) connection: OwnedFd,
    /// Ready when something that the program waits for has happened.
    pub(crate) watched: OwnedFd,
    beginning: Beginning,
    /// Its process id, once it has said so.
    pub(crate) pid: Option<u32>,
    /// Whether it is to be killed as soon as its process id is known.
    pub(crate) is_doomed: bool,
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

/// What a program hears with its first turn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Beginning {
    /// The seed of its random numbers.
    pub(crate) seed: u64,
    /// What the wall clock shows at the start of the simulation, since 1970.
    pub(crate) start: Duration,
    /// Whether it is to say to what it connects.
    pub(crate) tells_connections: bool,
}

/// What a program has said.
#[derive(Debug)]
pub(crate) enum Said {
    /// It waits; this is the time up to which it has moved the clock.
    Waits(Duration),
    /// It has connected to the socket of this name, and goes on with an [answer](Participant::answer).
    Connects(String, OwnedFd),
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
    pub(crate) fn new(process: usize, component: Option<&str>, beginning: Beginning) -> io::Result<(Self, Inherited)> {
        let (connection, socket) = socketpair(AddressFamily::UNIX, SocketType::STREAM, SocketFlags::CLOEXEC, None)?;
        sockopt::set_socket_timeout(&connection, sockopt::Timeout::Recv, Some(LOOK))?;
        let watched = epoll::create(epoll::CreateFlags::CLOEXEC)?;
        let inherited = Inherited { socket, watched: watched.try_clone()? };
        // The program that is started next inherits them. No other thread starts programs at the same time.
        fcntl_setfd(&inherited.socket, FdFlags::empty())?;
        fcntl_setfd(&inherited.watched, FdFlags::empty())?;
        let component = component.map(str::to_owned);
        let participant = Self {
            process,
            component,
            connection,
            watched,
            beginning,
            pid: None,
            is_doomed: false,
            due: Some(Duration::ZERO),
            is_ready: false,
            is_signalled: false,
            goes_on: None,
            paused_until: Duration::ZERO,
            turns: 0,
        };
        Ok((participant, inherited))
    }

    /// Its name in messages.
    pub(crate) fn shown(&self) -> String {
        self.component.as_ref().map_or_else(|| "the recorder".to_owned(), |component| format!("`{component}`"))
    }

    /// Whether it runs this component.
    pub(crate) fn is(&self, component: &str) -> bool {
        self.component.as_deref() == Some(component)
    }

    /// Kills its process, as soon as that is known.
    pub(crate) fn kill(&mut self) {
        let process = self.pid.and_then(|pid| Pid::from_raw(pid.cast_signed()));
        self.is_doomed = process.is_none();
        // It may have just ended.
        let _ended = process.map(|process| kill_process(process, Signal::KILL));
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
        let Beginning { seed, start, tells_connections } = self.beginning;
        let (is_signalled, tells_connections) = (u64::from(self.is_signalled), u64::from(tells_connections));
        let numbers = [nanoseconds(now), seed, is_signalled, nanoseconds(start), tells_connections];
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
        let (format, kind, pid) = (head as u16, (head >> 16) as u16, (head >> 32) as u32);
        match kind {
            _ if u32::from(format) != SEAT_FORMAT => Ok(Said::Nonsense),
            WAITS => {
                self.pid = Some(pid);
                self.due = Some(due).filter(|due| *due != NEVER).map(Duration::from_nanos);
                Ok(Said::Waits(Duration::from_nanos(now)))
            }
            CONNECTS => self.hear_connection(),
            _ => Ok(Said::Nonsense),
        }
    }

    /// Hears to what the program has connected: the path, with the socket.
    fn hear_connection(&self) -> io::Result<Said> {
        let mut path = [0_u8; PATH];
        let mut space = [MaybeUninit::uninit(); rustix::cmsg_space!(ScmRights(1))];
        let mut control = RecvAncillaryBuffer::new(&mut space);
        let received = loop {
            match recvmsg(&self.connection, &mut [IoSliceMut::new(&mut path)], &mut control, RecvFlags::CMSG_CLOEXEC) {
                Err(Errno::AGAIN | Errno::INTR) => {}
                other => break other?,
            }
        };
        let mut sockets = control.drain().filter_map(|message| match message {
            RecvAncillaryMessage::ScmRights(sockets) => Some(sockets),
            _ => None,
        });
        let socket = sockets.next().and_then(|mut sockets| sockets.next());
        let Some(socket) = socket.filter(|_| received.bytes == PATH) else { return Ok(Said::Nonsense) };
        let path = String::from_utf8_lossy(path.split(|byte| *byte == 0).next().unwrap_or_default());
        let name = path.rsplit('/').next().unwrap_or_default();
        Ok(Said::Connects(name.to_owned(), socket))
    }

    /// Lets the program go on after it has connected, with another socket if there is one. If it has ended, it is found
    /// when it is listened to.
    pub(crate) fn answer(&self, socket: Option<OwnedFd>) {
        let mut space = [MaybeUninit::uninit(); rustix::cmsg_space!(ScmRights(1))];
        let mut control = SendAncillaryBuffer::new(&mut space);
        let sockets: Vec<_> = socket.iter().map(AsFd::as_fd).collect();
        debug_assert!(sockets.len() <= 1, "there is room for one");
        if !sockets.is_empty() {
            control.push(SendAncillaryMessage::ScmRights(&sockets));
        }
        let _ended = sendmsg(&self.connection, &[IoSlice::new(&[0])], &mut control, SendFlags::NOSIGNAL);
    }
}
