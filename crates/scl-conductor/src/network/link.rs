//! A connection between two programs that the conductor carries.

use crate::random::{Between, Random};
use crate::routes::Route;
use crate::seed::seed_of;
use rustix::event::epoll::{self, EventData, EventFlags};
use rustix::io::{Errno, ioctl_fionbio};
use rustix::net::{
    AddressFamily, RecvFlags, SendFlags, Shutdown, SocketFlags, SocketType, recv, send, shutdown, socketpair,
};
use std::collections::VecDeque;
use std::io;
use std::os::fd::OwnedFd;
use std::time::Duration;

/// How much may be on the way in one direction, in bytes. With more, the sender finds its socket full.
const ROOM: usize = 256 << 10;
const READ: usize = 64 << 10;

#[derive(Debug)]
pub(super) struct Link {
    pub(super) number: u64,
    /// The index of its route.
    pub(super) route: usize,
    /// The component that has connected, and the one that listens.
    ends: [End; 2],
    /// From each of them to the other one.
    ways: [Way; 2],
}

#[derive(Debug)]
struct End {
    socket: OwnedFd,
    is_readable: bool,
    is_writable: bool,
}

/// One direction.
#[derive(Debug)]
struct Way {
    delay: Between,
    random: Random,
    /// What is on the way; the last one may be the end.
    parts: VecDeque<Part>,
    /// The bytes in `parts`.
    length: usize,
    /// Bytes that were taken from the sender.
    taken: u64,
    /// Bytes that were given to the receiver, or were lost because it is gone.
    given: u64,
    /// Whether the sender has sent all.
    has_ended: bool,
    /// Whether nothing is given any more.
    is_over: bool,
}

/// What was taken at once.
#[derive(Debug)]
struct Part {
    due: Duration,
    /// Nothing: the sender has closed the connection.
    bytes: Vec<u8>,
    /// How much of it was given already.
    given: usize,
}

/// What an event of `Link::watch` is about: the link, and one of its ends.
pub(super) fn of_event(data: u64) -> (u64, usize) {
    (data / 2, (data % 2) as usize)
}

impl Link {
    /// Puts a link into a connection; returns the end that the component uses from now on. `nth` numbers those on the
    /// same route.
    pub(super) fn new(
        number: u64,
        index: usize,
        route: &Route,
        seed: u64,
        nth: u64,
        connected: OwnedFd,
    ) -> io::Result<(Self, OwnedFd)> {
        let (near, own) = socketpair(AddressFamily::UNIX, SocketType::STREAM, SocketFlags::CLOEXEC, None)?;
        ioctl_fionbio(&near, true)?;
        ioctl_fionbio(&connected, true)?;
        let name = format!("{} {}", route.component, route.endpoint);
        let way =
            |direction: usize| Way::new(route.delays[direction], seed_of(seed, &name, 2 * nth + direction as u64));
        let ends = [near, connected].map(|socket| End { socket, is_readable: true, is_writable: true });
        Ok((Self { number, route: index, ends, ways: [way(0), way(1)] }, own))
    }

    /// Lets `ready` tell when an end can be read or written again.
    pub(super) fn watch(&self, ready: &OwnedFd) -> io::Result<()> {
        for (index, end) in self.ends.iter().enumerate() {
            let data = EventData::new_u64(2 * self.number + index as u64);
            epoll::add(
                ready,
                &end.socket,
                data,
                EventFlags::IN | EventFlags::OUT | EventFlags::RDHUP | EventFlags::ET,
            )?;
        }
        Ok(())
    }

    pub(super) fn note(&mut self, end: usize, events: EventFlags) {
        let gone = EventFlags::HUP | EventFlags::ERR;
        self.ends[end].is_readable |= events.intersects(EventFlags::IN | EventFlags::RDHUP | gone);
        self.ends[end].is_writable |= events.intersects(EventFlags::OUT | gone);
    }

    pub(super) fn is_over(&self) -> bool {
        self.ways.iter().all(|way| way.is_over)
    }

    pub(super) fn due(&self, cut_until: Duration) -> Option<Duration> {
        let due = |(way, to): (&Way, &End)| Some(way.parts.front().filter(|_| to.is_writable)?.due.max(cut_until));
        self.ways.iter().zip(self.ends.iter().rev()).filter_map(due).min()
    }

    pub(super) fn carry(&mut self, now: Duration, cut_until: Duration) {
        let [first, second] = &mut self.ends;
        let [there, back] = &mut self.ways;
        there.carry(first, second, now, cut_until);
        back.carry(second, first, now, cut_until);
    }
}

impl Way {
    fn new(delay: Between, seed: u64) -> Self {
        let (parts, random) = (VecDeque::new(), Random::new(seed));
        Self { delay, random, parts, length: 0, taken: 0, given: 0, has_ended: false, is_over: false }
    }

    fn carry(&mut self, from: &mut End, to: &mut End, now: Duration, cut_until: Duration) {
        // What is given makes room for more.
        loop {
            self.take(from, now);
            let has_given = now >= cut_until && self.give(to, now);
            debug_assert_eq!(self.taken, self.given + self.length as u64, "each byte is given, lost or on the way");
            if !has_given || !from.is_readable {
                return;
            }
        }
    }

    /// Takes what has been sent.
    fn take(&mut self, from: &mut End, now: Duration) {
        while from.is_readable && self.length < ROOM && !self.has_ended && !self.is_over {
            let mut bytes = vec![0; READ];
            match recv(&from.socket, &mut bytes, RecvFlags::empty()) {
                Ok((count, _)) => bytes.truncate(count),
                Err(Errno::AGAIN) => {
                    from.is_readable = false;
                    return;
                }
                Err(Errno::INTR) => continue,
                // The sender is gone.
                Err(_) => bytes.clear(),
            }
            bytes.shrink_to_fit();
            self.has_ended = bytes.is_empty();
            self.length += bytes.len();
            self.taken += bytes.len() as u64;
            // Nothing overtakes what was sent before.
            let earlier = self.parts.back().map_or(now, |part| part.due);
            let due = earlier.max(now + self.random.between(self.delay));
            self.parts.push_back(Part { due, bytes, given: 0 });
        }
    }

    /// Gives what is due, as much as the receiver takes. Returns true if that was something.
    fn give(&mut self, to: &mut End, now: Duration) -> bool {
        let before = self.given;
        while let Some(part) = self.parts.front_mut().filter(|part| part.due <= now && to.is_writable) {
            if part.bytes.is_empty() {
                // It may be gone already.
                let _gone = shutdown(&to.socket, Shutdown::Write);
                self.end();
                break;
            }
            match send(&to.socket, &part.bytes[part.given..], SendFlags::NOSIGNAL) {
                Ok(count) => {
                    part.given += count;
                    self.length -= count;
                    self.given += count as u64;
                    if part.given == part.bytes.len() {
                        self.parts.pop_front();
                    }
                }
                Err(Errno::AGAIN) => to.is_writable = false,
                Err(Errno::INTR) => {}
                // The receiver is gone.
                Err(_) => self.end(),
            }
        }
        self.given > before
    }

    /// Gives nothing any more; what is on the way is lost.
    fn end(&mut self) {
        self.given += self.length as u64;
        self.length = 0;
        self.parts.clear();
        self.is_over = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Read, Write};
    use std::os::unix::net::UnixStream;

    const MS: Duration = Duration::from_millis(1);

    /// A connection with a link in it: both ends, and the link.
    fn linked(delay: Between) -> (UnixStream, UnixStream, Link) {
        let (listening, connected) = UnixStream::pair().unwrap();
        let route = Route::between("a.out", "b.in", [delay, Between::default()]);
        let (link, own) = Link::new(0, 0, &route, 7, 0, connected.into()).unwrap();
        let own = UnixStream::from(own);
        own.set_nonblocking(true).unwrap();
        listening.set_nonblocking(true).unwrap();
        (own, listening, link)
    }

    fn carry(link: &mut Link, now: Duration, cut_until: Duration) {
        (0..2).for_each(|end| link.note(end, EventFlags::IN | EventFlags::OUT));
        link.carry(now, cut_until);
    }

    fn arrived(stream: &mut UnixStream) -> Option<Vec<u8>> {
        let mut bytes = vec![0; 1 << 20];
        let count = stream.read(&mut bytes).ok()?;
        Some(bytes[..count].to_vec())
    }

    #[test]
    fn what_is_sent_arrives_late_and_in_order_and_back_at_once() {
        let (mut own, mut listening, mut link) = linked(Between { least: 5 * MS, most: 9 * MS });
        own.write_all(b"one").unwrap();
        listening.write_all(b"back").unwrap();
        carry(&mut link, MS, Duration::ZERO);
        assert_eq!(arrived(&mut own).unwrap(), b"back");
        assert_eq!(arrived(&mut listening), None);
        let first = link.due(Duration::ZERO).unwrap();
        assert!((6 * MS..=10 * MS).contains(&first), "{first:?}");
        own.write_all(b"two").unwrap();
        carry(&mut link, 2 * MS, Duration::ZERO);
        assert_eq!(link.due(Duration::ZERO), Some(first));
        carry(&mut link, 20 * MS, Duration::ZERO);
        assert_eq!(arrived(&mut listening).unwrap(), b"onetwo");
        assert_eq!(link.due(Duration::ZERO), None);
    }

    #[test]
    fn a_cut_holds_everything_up_even_the_end() {
        let (mut own, mut listening, mut link) = linked(Between::default());
        own.write_all(b"late").unwrap();
        drop(own);
        carry(&mut link, MS, 30 * MS);
        assert_eq!(link.due(30 * MS), Some(30 * MS));
        assert_eq!(arrived(&mut listening), None);
        carry(&mut link, 30 * MS, 30 * MS);
        assert_eq!(arrived(&mut listening).unwrap(), b"late");
        assert_eq!(arrived(&mut listening).unwrap(), b"", "the end");
        assert!(!link.is_over());
        drop(listening);
        carry(&mut link, 31 * MS, 30 * MS);
        assert!(link.is_over());
    }

    #[test]
    fn a_sender_that_sends_too_much_finds_its_socket_full() {
        let (mut own, mut listening, mut link) = linked(Between::default());
        let all: Vec<u8> = (0..3 << 20).map(|number: u32| number as u8).collect();
        let (mut sent, mut received) = (0, Vec::new());
        while sent < all.len() {
            match own.write(&all[sent..]) {
                Ok(count) => sent += count,
                Err(_) if carry_and_stop(&mut link) => break,
                Err(_) => {}
            }
        }
        assert!((ROOM..all.len()).contains(&sent), "{sent}");
        while received.len() < sent {
            carry(&mut link, MS, Duration::ZERO);
            received.extend(arrived(&mut listening).unwrap_or_default());
        }
        assert!(received == all[..sent]);
    }

    /// Carries while the connection is cut. Returns true if nothing more is taken.
    fn carry_and_stop(link: &mut Link) -> bool {
        let before = link.ways[0].taken;
        carry(link, MS, 30 * MS);
        link.ways[0].taken == before
    }
}
