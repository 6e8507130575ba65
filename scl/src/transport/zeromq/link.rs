//! The sending side of a connection, of a publisher to one subscriber or of a pusher to its puller.

mod reading;
mod state;

use super::burst::{Burst, GATHERED};
use super::credit::SendCredit;
use super::session::{Closed, Session};
use super::shared_memory::Sharing;
use super::topics::Topics;
use super::waiting_report::WaitingReport;
use super::zmtp::{FLUSH, Header, PeerReady, latched, sent};
use crate::runtime_dir::SystemDir;
use crate::time::stamp_of;
use crate::transport::link_count::LinkAlive;
use crate::transport::{Disconnected, Driven, Frame, Link, Loan, Resumed, Sent};
use bytes::{BufMut, BytesMut};
use scl_plan::memory::limits::BATCH;
use scl_text::duration::nanoseconds;
use state::State;
use std::collections::VecDeque;
use std::task::Context;
use std::time::{Duration, Instant};

/// Minimum interval between direct reads of the socket while messages are refused. A program that never waits in its
/// runtime would otherwise never see an acknowledgement.
const RAW_INTERVAL: Duration = Duration::from_micros(100);
/// Maximum number of reads in one call without a runtime, where nothing else ends the loop while a peer keeps sending.
const RAW_READS: usize = 64;

pub(super) struct SendLink {
    session: Session,
    /// What a subscriber has subscribed to. A puller gets everything.
    topics: Option<Topics>,
    credit: Option<SendCredit>,
    /// Long messages in shared memory.
    sharing: Sharing,
    state: State,
    /// Whether calls no longer have a runtime. Then messages are sent without regard to credit.
    detached: bool,
    burst: Burst,
    waiting_report: WaitingReport,
    /// Number of messages sent when the peer was last asked to acknowledge.
    flush_requested: u64,
    /// Memory for messages that are written together.
    batch: BytesMut,
    raw_read: Option<Instant>,
    resumed: Option<Resumed>,
    /// When the next message was sent, to be told before it.
    next_sent: Option<Instant>,
    _alive: LinkAlive,
}

impl SendLink {
    pub(super) fn new(dir: &SystemDir, session: Session, peer: &PeerReady, alive: LinkAlive) -> Self {
        let scl = peer.scl.unwrap_or_default();
        Self {
            session,
            topics: None,
            credit: scl.window.map(SendCredit::new),
            sharing: Sharing::new(dir, peer),
            state: State::Open,
            detached: false,
            burst: Burst::new(),
            waiting_report: WaitingReport::new(scl.newest_only),
            flush_requested: 0,
            batch: BytesMut::new(),
            raw_read: None,
            resumed: None,
            next_sent: None,
            _alive: alive,
        }
    }

    /// Makes this a link to a subscriber: only messages that match its `topics` are sent, and `resumed` is what it has
    /// reported about itself.
    pub(super) fn subscribed(self, topics: Topics, resumed: Option<Resumed>) -> Self {
        Self { topics: Some(topics), resumed, ..self }
    }

    /// Returns true if the peer can take a message.
    fn has_room(&self) -> bool {
        self.session.is_written() && self.window_is_open()
    }

    /// Returns true if a message is to be gathered with others. Never true for a peer to which only the newest message
    /// matters.
    fn is_gathered(&self, message: &[u8]) -> bool {
        !self.waiting_report.is_wanted() && !self.detached && self.burst.gathers(message.len())
    }

    fn window_is_open(&self) -> bool {
        self.window_is_open_after(0, 0)
    }

    fn window_is_open_after(&self, messages: usize, bytes: usize) -> bool {
        let is_open = |credit: &SendCredit| credit.is_open_after(messages, bytes);
        let has_credit = || self.sharing.has_room() && self.credit.as_ref().is_none_or(is_open);
        self.state == State::Open && (self.detached || has_credit())
    }

    fn wants_everything(&self) -> bool {
        self.topics.as_ref().is_none_or(Topics::match_everything)
    }

    /// Returns true if the peer can take a message, if necessary after reading the socket without the runtime.
    #[inline]
    fn find_room(&mut self, cx: &mut Context<'_>) -> bool {
        self.has_room() || self.make_room(cx)
    }

    /// Reads the socket without the runtime, unless that was done a moment ago. Returns true if the peer can now take
    /// a message.
    #[inline(never)]
    fn make_room(&mut self, cx: &mut Context<'_>) -> bool {
        let now = Instant::now();
        if self.state == State::Broken || self.raw_read.is_some_and(|before| now - before < RAW_INTERVAL) {
            return false;
        }
        self.raw_read = Some(now);
        if let Err(error) = self.try_drive_raw(cx) {
            self.fail(cx, &error);
        }
        self.has_room()
    }

    fn fail(&mut self, cx: &mut Context<'_>, error: &Closed) {
        tracing::debug!(%error, "a receiving peer is gone");
        self.state = State::Broken;
        cx.waker().wake_by_ref();
    }

    /// Marks the link as broken and returns the message of the call that failed.
    fn gone(&mut self, cx: &mut Context<'_>, error: &Closed, message: Frame) -> Sent {
        self.fail(cx, error);
        Sent::Gone(message)
    }

    /// Returns a message that the peer cannot take.
    fn refused(&self, message: Frame) -> Sent {
        if self.state == State::Broken { Sent::Gone(message) } else { Sent::Full(message) }
    }

    /// Sends a message to a peer that can take it.
    fn send_one(&mut self, cx: &mut Context<'_>, message: &mut Frame) -> Result<(), Closed> {
        let time = self.next_sent.take();
        if !self.wants(message.as_slice()) {
            return Ok(());
        }
        // A plain ZeroMQ program gets the message without its time.
        if let Some(time) = time.filter(|_| self.credit.is_some()) {
            self.session.write(&sent(stamp_of(time)))?;
        }
        if self.send_sample(cx, message) {
            return Ok(());
        }
        let message = message.make_bytes();
        self.session.write_message(&[], Header::new(0, message.len()).as_bytes(), message)?;
        self.session.flush(cx)?;
        // Count only now: a message that is handed back was not sent.
        if let Some(credit) = &mut self.credit {
            credit.count_sent(message.len());
        }
        Ok(())
    }

    /// Sends a message in shared memory if it is long. Returns false if it is to be sent through the socket.
    fn send_sample(&mut self, cx: &mut Context<'_>, message: &mut Frame) -> bool {
        let Some(credit) = &mut self.credit else { return false };
        let written = match self.sharing.send(message, credit.sent() + 1) {
            Ok(None) => return false,
            Ok(Some(command)) => self.session.write(&command).and_then(|()| self.session.flush(cx)),
            Err(error) => Err(error),
        };
        // Count it even if writing failed: the sample is gone, so the message counts as sent, and is lost with the
        // connection. Its bytes are in shared memory and do not count.
        credit.count_sent(0);
        if let Err(error) = written {
            self.fail(cx, &error.into());
        }
        true
    }

    /// Sends several messages from the front of a queue in one piece. Returns their number, which is 0 if the first
    /// messages cannot be sent together.
    fn send_batch(&mut self, cx: &mut Context<'_>, queue: &VecDeque<Frame>) -> Result<usize, Closed> {
        let fits = |message: &Frame| 9 + message.len() <= BATCH / 2 && !self.sharing.is_for(message.len());
        if !self.wants_everything() || !queue.iter().take(2).all(fits) {
            return Ok(0);
        }
        self.batch.reserve(BATCH);
        let (mut count, mut bytes) = (0, 0);
        for message in queue {
            let header = Header::new(0, message.len());
            let length = self.batch.len() + header.as_bytes().len() + message.len();
            let is_sample = self.sharing.is_for(message.len());
            if length > BATCH || is_sample || !self.window_is_open_after(count, bytes) {
                break;
            }
            self.batch.put_slice(header.as_bytes());
            self.batch.put_slice(message.as_slice());
            count += 1;
            bytes += message.len();
        }
        self.session.write_shared(self.batch.split().freeze())?;
        self.session.flush(cx)?;
        // Count only now: messages that stay in the queue were not sent.
        if let Some(credit) = &mut self.credit {
            queue.iter().take(count).for_each(|message| credit.count_sent(message.len()));
        }
        Ok(count)
    }

    // Inlined, so that it costs connections without times nothing that others have.
    #[inline(always)]
    fn try_send_all(
        &mut self,
        cx: &mut Context<'_>,
        driven: bool,
        queue: &mut VecDeque<Frame>,
        mut times: Option<&mut VecDeque<Instant>>,
        sent: &mut dyn FnMut(usize),
    ) -> Result<(), Closed> {
        let waits = |message: &Frame| !driven && queue.len() < GATHERED && self.is_gathered(message.as_slice());
        if queue.front().is_some_and(waits) {
            return Ok(());
        }
        let before = queue.len();
        while !queue.is_empty() {
            if !self.find_room(cx) {
                if self.window_is_open() || self.state == State::Broken {
                    break;
                }
                // Poll the session; otherwise an acknowledgement does not wake the task.
                self.try_drive(cx)?;
                if !self.has_room() {
                    break;
                }
            }
            // Each message is told its time, so these are not written together.
            let batched = if queue.len() > 1 && times.is_none() { self.send_batch(cx, queue)? } else { 0 };
            if batched > 0 {
                queue.drain(..batched).for_each(|message| sent(message.len()));
            } else if let Some(message) = queue.front_mut() {
                let length = message.len();
                self.next_sent = times.as_ref().and_then(|times| times.front().copied());
                self.send_one(cx, message)?;
                queue.pop_front();
                times.as_mut().map(|times| times.pop_front());
                sent(length);
            }
        }
        if driven && before - queue.len() >= GATHERED / 4 {
            self.burst.expect_more();
        }
        Ok(self.waiting_report.write(&mut self.session, !queue.is_empty())?)
    }
}

impl Link for SendLink {
    fn drive(&mut self, cx: &mut Context<'_>) -> Result<Driven, Disconnected> {
        self.burst.end();
        if self.state == State::Broken {
            return Err(Disconnected);
        }
        self.try_drive(cx).map(|()| Driven::default()).map_err(|error| {
            tracing::debug!(%error, "a receiving peer is gone");
            self.state = State::Broken;
            Disconnected
        })
    }

    fn send(&mut self, cx: &mut Context<'_>, mut message: Frame) -> Sent {
        if self.is_gathered(message.as_slice()) {
            return Sent::Deferred(message);
        }
        if !self.find_room(cx) {
            return match self.waiting_report.write(&mut self.session, true) {
                Ok(()) => self.refused(message),
                Err(error) => self.gone(cx, &error.into(), message),
            };
        }
        match self.send_one(cx, &mut message) {
            Ok(()) => {
                self.burst.count_one(cx);
                Sent::Sent
            }
            Err(error) => self.gone(cx, &error, message),
        }
    }

    fn send_latched(&mut self, cx: &mut Context<'_>, mut message: Frame, age: Duration) -> Sent {
        if !self.find_room(cx) {
            return self.refused(message);
        }
        let age = nanoseconds(age);
        // A plain ZeroMQ program gets the message without its age.
        let told = if self.credit.is_some() { self.session.write(&latched(age)) } else { Ok(()) };
        match told.map_err(Closed::from).and_then(|()| self.send_one(cx, &mut message)) {
            Ok(()) => Sent::Sent,
            Err(error) => self.gone(cx, &error, message),
        }
    }

    fn wants(&self, message: &[u8]) -> bool {
        self.topics.as_ref().is_none_or(|topics| topics.matches(message))
    }

    fn resumed(&self) -> Option<Resumed> {
        self.resumed
    }

    fn send_all(
        &mut self,
        cx: &mut Context<'_>,
        driven: Option<Driven>,
        queue: &mut VecDeque<Frame>,
        sent: &mut dyn FnMut(usize),
    ) {
        if let Err(error) = self.try_send_all(cx, driven.is_some(), queue, None, sent) {
            self.fail(cx, &error);
        }
    }

    fn send_timed(&mut self, cx: &mut Context<'_>, message: Frame, sent: Instant) -> Sent {
        self.next_sent = Some(sent);
        let result = self.send(cx, message);
        // A message that was returned is told its time when it is sent.
        self.next_sent = None;
        result
    }

    fn send_all_timed(
        &mut self,
        cx: &mut Context<'_>,
        driven: Option<Driven>,
        queue: &mut VecDeque<Frame>,
        times: &mut VecDeque<Instant>,
        sent: &mut dyn FnMut(usize),
    ) {
        debug_assert_eq!(queue.len(), times.len(), "each message has its time");
        if let Err(error) = self.try_send_all(cx, driven.is_some(), queue, Some(times), sent) {
            self.fail(cx, &error);
        }
    }

    fn loan(&mut self, length: usize) -> Option<Loan> {
        self.sharing.loan(length)
    }

    fn is_written(&self) -> bool {
        self.session.is_written()
    }

    fn unacknowledged(&self) -> u64 {
        self.credit.as_ref().map_or(0, SendCredit::unacknowledged)
    }

    fn not_received(&self) -> u64 {
        self.credit.as_ref().map_or(0, SendCredit::not_received)
    }

    /// Needed because a new link may replace this one before the task polls it again, and because a failed write is
    /// noticed before the last acknowledgements are read.
    fn read_last(&mut self) {
        for _ in 0..RAW_READS {
            while let Ok(Some(item)) = self.session.buffered_item() {
                let _of_no_use_any_more = self.handle(item);
            }
            if !matches!(self.session.fill_raw(), Ok(true)) {
                return;
            }
        }
    }

    fn request_acknowledgement(&mut self, cx: &mut Context<'_>) {
        let Some(credit) = &self.credit else { return };
        if credit.not_received() == 0 || self.flush_requested == credit.sent() || self.state == State::Broken {
            return;
        }
        self.flush_requested = credit.sent();
        let requested = self.session.write(FLUSH).and_then(|()| self.session.flush(cx));
        if let Err(error) = requested {
            self.fail(cx, &error.into());
        }
    }

    fn detach(&mut self) {
        self.detached = true;
        self.session.detach();
    }
}
