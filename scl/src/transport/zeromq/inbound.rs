//! The receiving side of a connection, of a subscriber or of a puller.

use super::catch_up::CatchUp;
use super::credit::ReceiveCredit;
use super::session::{Closed, Session};
use super::shared_memory::Arriving;
use super::zmtp::{self, Command, FINISH, Item, Message, PeerReady, SHM_OPEN, acknowledgement};
use crate::runtime_dir::SystemDir;
use crate::time::time_of;
use crate::transport::Endpoint;
use bytes::Bytes;
use std::collections::VecDeque;
use std::pin::pin;
use std::task::{Context, Poll, ready};
use std::time::{Duration, Instant};
use tokio::task::coop;

/// How many bytes are read ahead of the caller without a runtime. A single longer message is read to its end.
const READ_AHEAD: usize = 256 << 10;
/// Number of messages read ahead after which no more are fetched.
const MOST_AHEAD: usize = 4096;

pub(super) struct Inbound {
    session: Session,
    credit: Option<ReceiveCredit>,
    /// Long messages in shared memory.
    arriving: Arriving,
    newest_only: bool,
    /// Whether the sender waits instead of dropping messages. Then older messages matter, too.
    lossless: bool,
    /// Whether the sender keeps its last message for subscribers that join.
    is_latched: bool,
    /// Number of the last message on this connection that was published before the connection existed, and when that
    /// was.
    latched: Option<(u64, Instant)>,
    /// When messages were sent, by their numbers, as far as the sender has told and they were not returned yet.
    sent: VecDeque<(u64, Instant)>,
    /// Messages read while looking for the newest.
    ahead: VecDeque<Bytes>,
    /// Why no messages follow those read ahead, if the connection is closed.
    closed: Option<Closed>,
    malformed: u64,
    /// Whether the sender has requested an acknowledgement from a caller that acknowledges messages itself.
    acknowledgement_requested: bool,
    /// Whether the sender was asked to send nothing more, and whether it has answered that nothing follows.
    finishing: bool,
    finished: bool,
    /// Whether `poll_next` has just found the socket empty.
    emptied: bool,
    catch_up: CatchUp,
}

impl Inbound {
    pub(super) fn new(mut session: Session, peer: &PeerReady, endpoint: &Endpoint, dir: &SystemDir) -> Self {
        let arriving = Arriving::open(dir, peer, endpoint);
        if arriving.is_open() {
            let _reported_by_reading = session.write(SHM_OPEN);
        }
        let lossless = peer.scl.is_some_and(|scl| scl.lossless);
        Self {
            session,
            credit: peer.scl.map(|_| ReceiveCredit::new(endpoint)),
            arriving,
            newest_only: endpoint.newest_only && !lossless,
            lossless,
            is_latched: peer.scl.is_some_and(|scl| scl.latched),
            latched: None,
            sent: VecDeque::new(),
            ahead: VecDeque::new(),
            closed: None,
            malformed: 0,
            acknowledgement_requested: false,
            finishing: false,
            finished: false,
            emptied: false,
            catch_up: CatchUp::default(),
        }
    }

    pub(super) fn is_lossless(&self) -> bool {
        self.lossless
    }

    pub(super) fn is_latched(&self) -> bool {
        self.is_latched
    }

    /// Returns when the message returned last was published, if that was before this connection existed.
    pub(super) fn take_latched(&mut self) -> Option<Instant> {
        let returned = self.returned();
        self.latched.take_if(|(number, _)| *number == returned).map(|(_, sent)| sent)
    }

    /// Returns when the message returned last was sent, if the sender has told.
    pub(super) fn take_sent(&mut self) -> Option<Instant> {
        while let Some(&(number, sent)) = self.sent.front() {
            let returned = self.returned();
            if number > returned {
                return None;
            }
            self.sent.pop_front();
            if number == returned {
                return Some(sent);
            }
        }
        None
    }

    /// Notes when the next message was sent. Keeps one time for each message that is read ahead, whatever the sender
    /// tells and whether it is asked for.
    fn note_sent(&mut self, sent: Instant) {
        let (next, returned) = (self.taken() + 1, self.returned());
        while self.sent.pop_front_if(|(number, _)| *number <= returned).is_some() {}
        let _replaced = self.sent.pop_back_if(|(number, _)| *number == next);
        self.sent.push_back((next, sent));
        debug_assert!(self.sent.len() <= self.ahead.len() + 1, "one time for each message");
    }

    /// Number of messages returned so far, 0 if the messages of this peer are not counted.
    fn returned(&self) -> u64 {
        self.credit.as_ref().map_or(0, |credit| credit.taken() - self.ahead.len() as u64)
    }

    /// Number of messages taken so far.
    pub(super) fn taken(&self) -> u64 {
        self.credit.as_ref().map_or(0, ReceiveCredit::taken)
    }

    /// Returns the number of malformed messages since the last call.
    pub(super) fn take_malformed(&mut self) -> u64 {
        std::mem::take(&mut self.malformed)
    }

    pub(super) fn poll_next(&mut self, cx: &mut Context<'_>) -> Poll<Result<Bytes, Closed>> {
        if let Some(message) = self.ahead.pop_front() {
            return Poll::Ready(Ok(message));
        }
        loop {
            if let Some(message) = self.next_buffered()? {
                return Poll::Ready(Ok(message));
            }
            if let Some(closed) = self.closed.take() {
                return Poll::Ready(Err(closed));
            }
            if self.session.poll_fill(cx)?.is_pending() {
                break;
            }
        }
        if !self.session.is_written() {
            // A peer that no longer reads acknowledgements may still have sent messages.
            let _reported_by_reading = self.session.flush(cx);
        }
        self.emptied = self.session.take_emptied();
        Poll::Pending
    }

    /// Returns the next message that has been read, and handles the commands before it.
    #[inline]
    fn next_buffered(&mut self) -> Result<Option<Bytes>, Closed> {
        while let Some(item) = self.session.buffered_item()? {
            match item {
                Item::Message(Message { envelope, body }) => {
                    self.count_taken(body.len());
                    if envelope.is_empty() {
                        return Ok(Some(body));
                    }
                    self.malformed += 1;
                    let numbers = self.credit.as_mut().and_then(ReceiveCredit::skip_last);
                    self.write_acknowledgement(numbers);
                }
                Item::Command(Command::Sample { sequence, length }) => {
                    return self.take_sample(sequence, length).map(Some);
                }
                Item::Command(Command::Behind) => self.catch_up.note_behind(),
                Item::Command(Command::CaughtUp(number)) => self.catch_up.note_caught_up(number),
                Item::Command(Command::Flush) => self.handle_flush(),
                Item::Command(Command::Finished) => self.finished = true,
                Item::Command(Command::Latched(age)) => {
                    let sent = Instant::now().checked_sub(Duration::from_nanos(age));
                    self.latched = sent.map(|sent| (self.taken() + 1, sent));
                }
                Item::Command(Command::Sent(stamp)) if self.credit.is_some() => self.note_sent(time_of(stamp)),
                Item::Command(_) | Item::Ready(_) => {}
            }
        }
        Ok(None)
    }

    fn take_sample(&mut self, sequence: u64, length: u64) -> Result<Bytes, Closed> {
        let (message, waits) = self.arriving.receive(sequence, length)?;
        // The message is in shared memory, so its bytes do not count towards the window.
        self.count_taken(0);
        if waits && !self.credit.as_ref().is_some_and(ReceiveCredit::is_deferred) {
            self.acknowledge();
        }
        Ok(message)
    }

    fn count_taken(&mut self, length: usize) {
        if let Some(credit) = &mut self.credit
            && credit.count_taken(length)
        {
            self.acknowledge();
        }
    }

    fn handle_flush(&mut self) {
        match &self.credit {
            Some(credit) if credit.is_deferred() => self.acknowledgement_requested = true,
            _ => {
                self.acknowledge();
                self.credit.iter_mut().for_each(ReceiveCredit::await_received);
            }
        }
    }

    fn acknowledge(&mut self) {
        self.arriving.acknowledged();
        let numbers = self.credit.as_mut().map(ReceiveCredit::acknowledge);
        self.write_acknowledgement(numbers);
    }

    /// Notes how many of the returned messages wait in the gate, and notifies the sender if it waits for that. Returns
    /// true if the sender still waits.
    pub(super) fn note_waiting(&mut self, cx: &mut Context<'_>, waiting: u64) -> bool {
        let Some(credit) = &mut self.credit else { return false };
        let is_due = credit.note_waiting(waiting + self.ahead.len() as u64);
        let is_awaited = credit.is_awaited();
        if is_due {
            self.acknowledge();
            // Flush now: this connection may have no other event until the sender has read the acknowledgement.
            let _reported_by_reading = self.session.flush(cx);
        }
        is_awaited
    }

    /// Acknowledges what the gate has taken and its program has received, before the connection is closed.
    pub(super) fn acknowledge_last(&mut self) {
        if self.credit.as_ref().is_some_and(|credit| !credit.is_deferred()) {
            self.acknowledge();
        }
    }

    /// Acknowledges the oldest `count` messages that were returned, if the caller acknowledges messages itself.
    pub(super) fn acknowledge_deferred(&mut self, count: u64) {
        let numbers = self.credit.as_mut().and_then(|credit| credit.acknowledge_deferred(count));
        self.write_acknowledgement(numbers);
    }

    /// Asks the sender to send nothing more.
    pub(super) fn finish(&mut self) {
        if !std::mem::replace(&mut self.finishing, true) {
            let _reported_by_reading = self.session.write(FINISH);
        }
    }

    /// Returns true if nothing more will follow, or if the sender is a plain ZeroMQ program, which cannot report that.
    pub(super) fn is_finished(&self) -> bool {
        self.finished || self.credit.is_none()
    }

    pub(super) fn take_acknowledgement_request(&mut self) -> bool {
        std::mem::take(&mut self.acknowledgement_requested)
    }

    fn write_acknowledgement(&mut self, numbers: Option<(u64, u64)>) {
        if let Some((taken, received)) = numbers {
            // A peer that no longer reads acknowledgements may still have sent messages.
            let _reported_by_reading = self.session.write(&acknowledgement(taken, received));
        }
    }

    /// Marks the start of a call, which does not rely on earlier answers.
    pub(super) fn forget_answer(&mut self) {
        self.catch_up.forget_answer();
    }

    /// Ready when the sender has nothing newer than what `poll_next` has returned or will return at once, and from then
    /// on until [`forget_answer`](Self::forget_answer).
    pub(super) fn poll_caught_up(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        if !self.newest_only {
            return Poll::Ready(());
        }
        // Read directly, because the runtime may not have polled the socket for a while. Yield to the runtime even if
        // there is always more to read.
        if !std::mem::take(&mut self.emptied) && self.fill_raw() {
            ready!(pin!(coop::consume_budget()).poll(cx));
        }
        if self.catch_up.is_forgotten() {
            self.await_answer();
            self.ask();
        }
        loop {
            self.read_ahead();
            if !self.may_be_behind() || self.catch_up.gave_up() {
                break;
            }
            self.acknowledge_all();
            match self.session.poll_fill(cx) {
                Poll::Ready(Ok(())) => {}
                Poll::Ready(Err(closed)) => self.closed = Some(closed),
                Poll::Pending => ready!(self.catch_up.poll_silence(cx)),
            }
        }
        self.catch_up.end_wait();
        if !self.ahead.is_empty() || self.closed.is_some() {
            // tokio does not see raw reads, so wake the task explicitly.
            cx.waker().wake_by_ref();
        }
        Poll::Ready(())
    }

    /// Without the runtime, fetches what has arrived. If only the newest message matters, waits up to `within` for what
    /// the sender holds back.
    pub(super) fn catch_up(&mut self, within: Duration) {
        let deadline = Instant::now() + within;
        self.fill_raw();
        if !self.newest_only {
            return;
        }
        // The answer to an open question may have been sent before this call, so ask again.
        let is_answered = self.catch_up.is_fresh();
        self.await_answer();
        if !is_answered {
            self.ask();
        }
        while self.may_be_behind() && !self.catch_up.gave_up() {
            self.acknowledge_all();
            let left = deadline.saturating_duration_since(Instant::now());
            if !self.session.wait_readable(left) {
                return self.catch_up.note_silence(within);
            }
            self.fill_raw();
            self.read_ahead();
        }
    }

    fn await_answer(&mut self) {
        // Read everything first: an answer that has already arrived does not tell what the sender holds now.
        self.read_ahead();
        self.catch_up.await_answer();
    }

    /// Asks the sender whether newer messages wait, if that cannot be known without asking.
    fn ask(&mut self) {
        if self.credit.is_none() || self.session.is_immediate() || self.catch_up.gave_up() {
            return;
        }
        let question = self.catch_up.next_question();
        let _reported_by_reading = self.session.write(&zmtp::catch_up(question));
    }

    /// Waits on the calling thread until something has arrived.
    pub(super) fn wait(&mut self, within: Duration) -> bool {
        self.session.wait(within)
    }

    /// Whether the sender may hold messages that are newer than those read.
    fn may_be_behind(&self) -> bool {
        // A peer without credit cannot be asked; one that ignores the window is not worth waiting for.
        let can_catch_up = self.credit.is_some() && self.closed.is_none() && self.ahead.len() < MOST_AHEAD;
        can_catch_up && self.catch_up.may_be_behind(self.session.decoder.buffered() > 0)
    }

    fn acknowledge_all(&mut self) {
        if self.credit.as_ref().is_some_and(|credit| credit.unacknowledged() > 0) {
            self.acknowledge();
        }
    }

    /// Reads without the runtime. Returns true if something had arrived.
    fn fill_raw(&mut self) -> bool {
        let before = self.session.decoder.buffered();
        while self.closed.is_none()
            && self.ahead.len() < MOST_AHEAD
            && (self.session.decoder.buffered() < READ_AHEAD || self.session.decoder.is_in_frame())
        {
            match self.session.fill_raw() {
                Ok(true) => {}
                Ok(false) => break,
                Err(closed) => self.closed = Some(closed),
            }
        }
        self.session.decoder.buffered() > before
    }

    /// Decodes what has been read, so that what the sender says about newer messages is known.
    fn read_ahead(&mut self) {
        loop {
            match self.next_buffered() {
                Ok(Some(message)) => self.ahead.push_back(message),
                Ok(None) => return,
                Err(closed) => return self.closed = Some(closed),
            }
        }
    }
}
