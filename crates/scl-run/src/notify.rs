//! Receives what programs say about themselves: systemd's protocol, `sd_notify(3)`, on one datagram socket.
//!
//! The kernel adds the sender's process id to each datagram. Only processes of a component's own process group count;
//! everything else that arrives is ignored.

use super::event::Event;
use super::lifecycle::Notice;
use super::lock::lock;
use super::own_file::OwnFile;
use rustix::cmsg_space;
use rustix::event::{PollFd, PollFlags, poll};
use rustix::io::Errno;
use rustix::net::{RecvAncillaryBuffer, RecvAncillaryMessage, RecvFlags, ReturnFlags, recvmsg, sockopt};
use rustix::process::getpgid;
use scl_terminal::escape;
use std::io::{self, IoSliceMut};
use std::mem::MaybeUninit;
use std::os::unix::net::UnixDatagram;
use std::path::{Path, PathBuf};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

/// The variable by which programs find the runtime folder.
pub(crate) const RUNTIME_DIR: &str = "SCL_RUNTIME_DIR";

/// Maximum length of a datagram in bytes, far more than any program sends. Longer ones are ignored.
const LONGEST_DATAGRAM: usize = 4096;

/// Maximum length of a status in characters: it is one line on a terminal.
const LONGEST_STATUS: usize = 300;

/// Maximum number of datagrams read at once: more than the kernel keeps for a socket (`net.unix.max_dgram_qlen`).
const MOST_KEPT: usize = 4096;

/// The socket where programs say that they are ready and alive. Dropping this value removes it.
#[derive(Debug)]
pub(crate) struct NotifySocket {
    pub(crate) file: OwnFile,
    runtime_folder: PathBuf,
    pub(crate) datagrams: Datagrams,
}

/// What arrives at the socket, on its way to the supervisor.
#[derive(Debug, Clone)]
pub(crate) struct Datagrams {
    /// Only the last socket has a file. Programs may still be connected to earlier ones, whose file was removed.
    sockets: Arc<Mutex<Vec<Arc<UnixDatagram>>>>,
    events: Sender<Event>,
}

impl NotifySocket {
    /// Listens in a folder that only this user can write to, and sends received notices as events. Programs get
    /// `runtime_folder` in a variable.
    ///
    /// # Errors
    ///
    /// If the socket cannot be bound.
    pub(crate) fn open(folder: &Path, runtime_folder: &Path, events: Sender<Event>) -> io::Result<Self> {
        let (file, socket) = OwnFile::bind(folder, "notify", |path| UnixDatagram::bind(path))?;
        let datagrams = Datagrams { sockets: Arc::default(), events };
        datagrams.read_from(socket)?;
        Ok(Self { file, runtime_folder: runtime_folder.to_owned(), datagrams })
    }

    /// Listens again after the folder was removed and created again.
    ///
    /// # Errors
    ///
    /// If the socket cannot be bound.
    pub(crate) fn restore(&self) -> io::Result<()> {
        self.datagrams.read_from(self.file.bind_again(|path| UnixDatagram::bind(path))?)
    }

    /// Returns the variables by which programs find the socket and the runtime folder, which stays the same for them
    /// even if the default one is removed, as at a logout. `WATCHDOG_PID` is left out, so that the watchdog also
    /// applies to a program behind a shell.
    pub(crate) fn variables(&self, alive_within: Option<Duration>) -> Vec<(&'static str, String)> {
        let path = self.file.path.display().to_string();
        let watchdog = alive_within.map(|limit| ("WATCHDOG_USEC", limit.as_micros().to_string()));
        let folder = self.runtime_folder.to_str().map(|folder| (RUNTIME_DIR, folder.to_owned()));
        [("NOTIFY_SOCKET", path)].into_iter().chain(watchdog).chain(folder).collect()
    }
}

impl Datagrams {
    fn read_from(&self, socket: UnixDatagram) -> io::Result<()> {
        sockopt::set_socket_passcred(&socket, true)?;
        let socket = Arc::new(socket);
        lock(&self.sockets).push(Arc::clone(&socket));
        let datagrams = self.clone();
        thread::Builder::new().spawn(move || while wait(&socket).and_then(|()| datagrams.take()).is_ok() {})?;
        Ok(())
    }

    /// Sends the received datagrams as events. When this returns, everything that programs reported before has been
    /// sent.
    ///
    /// # Errors
    ///
    /// If the socket cannot be read, or the supervisor has ended.
    pub(crate) fn take(&self) -> io::Result<()> {
        // Hold the lock: no thread may return before another one has sent the events of the datagrams that it has read.
        lock(&self.sockets).iter().try_for_each(|socket| self.take_from(socket))
    }

    fn take_from(&self, socket: &UnixDatagram) -> io::Result<()> {
        let mut datagram = [0; LONGEST_DATAGRAM];
        for _ in 0..MOST_KEPT {
            // Leave no room for file descriptors, so that the kernel closes them. `systemd-notify` waits for that.
            let mut space = [MaybeUninit::uninit(); cmsg_space!(ScmCredentials(1))];
            let mut control = RecvAncillaryBuffer::new(&mut space);
            let flags = RecvFlags::CMSG_CLOEXEC | RecvFlags::DONTWAIT;
            let received = match recvmsg(socket, &mut [IoSliceMut::new(&mut datagram)], &mut control, flags) {
                Ok(received) => received,
                Err(Errno::INTR) => continue,
                Err(Errno::AGAIN) => return Ok(()),
                Err(error) => return Err(error.into()),
            };
            let sender = control.drain().find_map(|message| match message {
                RecvAncillaryMessage::ScmCredentials(credentials) => Some(credentials.pid),
                _ => None,
            });
            let group = sender.and_then(|sender| getpgid(Some(sender)).ok());
            let Some(group) = group.filter(|_| !received.flags.contains(ReturnFlags::TRUNC)) else { continue };
            for notice in notices(&datagram[..received.bytes]) {
                self.events.send(Event::Notified { group, notice }).map_err(|_| io::ErrorKind::BrokenPipe)?;
            }
        }
        Ok(())
    }
}

fn wait(socket: &UnixDatagram) -> io::Result<()> {
    match poll(&mut [PollFd::new(socket, PollFlags::IN)], None) {
        Ok(_) | Err(Errno::INTR) => Ok(()),
        Err(error) => Err(error.into()),
    }
}

/// Returns the notices in a datagram; other lines are ignored.
fn notices(datagram: &[u8]) -> Vec<Notice> {
    let text = std::str::from_utf8(datagram).unwrap_or_default();
    text.lines().filter_map(notice).collect()
}

fn notice(line: &str) -> Option<Notice> {
    match line.split_once('=')? {
        ("READY", "1") => Some(Notice::Ready),
        ("STOPPING", "1") => Some(Notice::Stopping),
        ("WATCHDOG", "1") => Some(Notice::Alive),
        ("STATUS", text) => Some(Notice::Status(shown(text))),
        ("X_SCL_OPENS", component) => Some(Notice::Opens(shown(component))),
        _ => None,
    }
}

fn shown(text: &str) -> String {
    escape(&text.chars().take(LONGEST_STATUS).collect::<String>()).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The order in which the supervisor learns that a program is the wrong one, and that it has ended.
    #[test]
    fn what_was_said_before_is_an_event_when_all_is_taken() {
        let folder = tempfile::tempdir().unwrap();
        let (events, received) = std::sync::mpsc::channel();
        let socket = NotifySocket::open(folder.path(), folder.path(), events).unwrap();
        let program = UnixDatagram::unbound().unwrap();
        for number in 0..20_000 {
            let text = number.to_string();
            program.send_to(format!("STATUS={text}").as_bytes(), &socket.file.path).unwrap();
            // The thread of the socket may be the one that reads it.
            thread::yield_now();
            socket.datagrams.take().unwrap();
            let event = received.try_recv();
            let is_expected =
                matches!(&event, Ok(Event::Notified { notice: Notice::Status(status), .. }) if *status == text);
            assert!(is_expected, "{event:?} in place of `{text}`");
        }
    }

    #[test]
    fn known_lines_are_read_and_others_ignored() {
        let status = |text: &str| Notice::Status(text.to_owned());
        let cases: [(&[u8], Vec<Notice>); 8] = [
            (b"READY=1", vec![Notice::Ready]),
            (b"STATUS=waiting for a.b\nREADY=1\n", vec![status("waiting for a.b"), Notice::Ready]),
            (b"WATCHDOG=1\nMAINPID=1\nX\n\n=\nSTOPPING=1", vec![Notice::Alive, Notice::Stopping]),
            (b"READY=0\nready=1\n READY=1\nWATCHDOG=trigger", vec![]),
            (b"X_SCL_OPENS=rover.gps\n", vec![Notice::Opens("rover.gps".to_owned())]),
            (b"STATUS=a=b", vec![status("a=b")]),
            (b"READY=1\xff", vec![]),
            (b"", vec![]),
        ];
        for (datagram, expected) in cases {
            assert_eq!(notices(datagram), expected, "{}", String::from_utf8_lossy(datagram));
        }
    }
}
