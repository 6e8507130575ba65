//! The sending side of a connection, of a publisher to one subscriber or of a pusher to its puller.

use super::credit::SendCredit;
use super::link_count::LinkAlive;
use super::session::{Closed, Session};
use super::shared_memory::{Sent, Sharing};
use super::topics::Topics;
use super::zmtp::{BEHIND, Command, FINISHED, FLUSH, Header, Item, PeerReady, ProtocolError, caught_up, latched};
use crate::transport::{Disconnected, Frame, Link, Loan, Resumed};
use bytes::{BufMut, BytesMut};
use rustix::time::{ClockId, Timespec, clock_gettime};
use std::collections::VecDeque;
use std::io;
use std::task::Context;
use std::time::{Duration, Instant};

/// How many bytes of messages are written together at most; a longer message is written by itself.
const BATCH: usize = 64 << 10;
/// How many messages are written one by one, each by the call that sends it, while the link is not driven. More within one
/// tick of the coarse clock (1 to 4 ms) are a burst: they are gathered until the link is driven, until there are
/// [`GATHERED`], or until something is sent after that tick.
const ONE_BY_ONE: u32 = 64;
/// How many messages of a burst are written together if the link is not driven meanwhile.
const GATHERED: usize = 128;
/// Longer messages gain nothing from being written together.
const SHORT: usize = 4 << 10;
/// How often the socket is asked directly while messages are refused. A program that never waits in its runtime would
/// otherwise never see an acknowledgement.
const RAW_INTERVAL: Duration = Duration::from_micros(100);
/// How many reads one call makes at most without a runtime, which would interrupt a peer that never stops sending.
const RAW_READS: usize = 64;

pub(super) struct SendLink {
    session: Session,
    /// What a subscriber has subscribed to. A puller gets everything.
    topics: Option<Topics>,
    credit: Option<SendCredit>,
    /// Long messages in shared memory.
    sharing: Sharing,
    /// Whether the peer wants to be told when messages wait for its acknowledgement, and has been.
    reports_waiting: bool,
    reported_waiting: bool,
    /// Number of the peer's last question whether newer messages wait, and of the last that was answered.
    question: u64,
    answered: u64,
    /// Number of messages sent when the peer was last asked to acknowledge.
    flush_requested: u64,
    /// Memory for messages that are written together.
    batch: BytesMut,
    /// Number of messages written one by one since the link was driven, and the tick in which that was.
    one_by_one: u32,
    tick: Timespec,
    /// Whether the link was driven since messages were last sent from the queue.
    driven: bool,
    broken: bool,
    /// Whether the peer wants nothing more over this connection, and whether it has been told that nothing follows.
    finishing: bool,
    finished: bool,
    detached: bool,
    raw_read: Option<Instant>,
    resumed: Option<Resumed>,
    _alive: LinkAlive,
}

impl SendLink {
    pub(super) fn new(
        session: Session,
        peer: &PeerReady,
        topics: Option<Topics>,
        sharing: Sharing,
        alive: LinkAlive,
    ) -> Self {
        let scl = peer.scl.unwrap_or_default();
        Self {
            session,
            topics,
            credit: scl.window.map(SendCredit::new),
            sharing,
            reports_waiting: scl.newest_only,
            reported_waiting: false,
            question: 0,
            answered: 0,
            flush_requested: 0,
            batch: BytesMut::new(),
            one_by_one: 0,
            tick: tick(),
            driven: false,
            broken: false,
            finishing: false,
            finished: false,
            detached: false,
            raw_read: None,
            resumed: None,
            _alive: alive,
        }
    }

    /// Sets what the peer has said about itself.
    pub(super) fn of_resumed(self, resumed: Option<Resumed>) -> Self {
        Self { resumed, ..self }
    }

    fn is_open(&self) -> bool {
        self.session.is_written() && self.window_is_open() && !self.broken
    }

    /// Returns true if a message is to be gathered with others. One of which only the newest matters never is.
    fn is_gathered(&self, message: &[u8]) -> bool {
        let may_be_burst = self.one_by_one >= ONE_BY_ONE && message.len() <= SHORT;
        may_be_burst && !self.reports_waiting && !self.detached && self.tick == tick()
    }

    /// Counts a message that was written by itself. The task ends a burst that begins with it.
    fn count_one(&mut self, cx: &Context<'_>) {
        let now = tick();
        if std::mem::replace(&mut self.tick, now) != now {
            self.one_by_one = 0;
        }
        self.one_by_one += 1;
        if self.one_by_one == ONE_BY_ONE {
            cx.waker().wake_by_ref();
        }
    }

    fn window_is_open(&self) -> bool {
        self.window_is_open_after(0, 0)
    }

    fn window_is_open_after(&self, messages: usize, bytes: usize) -> bool {
        let is_open = |credit: &SendCredit| credit.is_open_after(messages, bytes);
        let has_credit = || self.sharing.has_room() && self.credit.as_ref().is_none_or(is_open);
        !self.finishing && (self.detached || has_credit())
    }

    fn wants_everything(&self) -> bool {
        self.topics.as_ref().is_none_or(Topics::match_everything)
    }

    fn handle(&mut self, item: Item) -> Result<(), ProtocolError> {
        match item {
            Item::Command(Command::Acknowledged { taken, received }) => {
                if let Some(credit) = &mut self.credit {
                    credit.acknowledge(taken, received)?;
                    self.sharing.acknowledge(taken);
                }
            }
            Item::Command(Command::ShmOpen) => self.sharing.open(),
            Item::Command(Command::CatchUp(number)) => self.question = number,
            Item::Command(Command::Finish) => self.finishing = true,
            // Anything else that a peer sends here has no meaning.
            item => {
                if let (Some(topics), Some(subscription)) = (&mut self.topics, item.into_subscription()) {
                    topics.handle(subscription)?;
                }
            }
        }
        Ok(())
    }

    fn try_drive(&mut self, cx: &mut Context<'_>) -> Result<(), Closed> {
        // Without a runtime nothing interrupts a peer that never stops sending.
        let mut reads = if self.detached { RAW_READS } else { usize::MAX };
        loop {
            while let Some(item) = self.session.buffered_item()? {
                self.handle(item)?;
            }
            if reads == 0 || self.session.poll_fill(cx)?.is_pending() {
                break;
            }
            reads -= 1;
        }
        if self.finishing && !std::mem::replace(&mut self.finished, true) {
            // Behind everything that was sent.
            self.session.write(FINISHED)?;
        }
        Ok(self.session.flush(cx)?)
    }

    /// Looks past what the runtime knows.
    fn try_drive_raw(&mut self, cx: &Context<'_>) -> Result<(), Closed> {
        let mut reads = RAW_READS;
        while reads > 0 && self.session.fill_raw()? {
            while let Some(item) = self.session.buffered_item()? {
                self.handle(item)?;
            }
            reads -= 1;
            // The runtime does not report what was read without it, and the task may wait for an acknowledgement.
            cx.waker().wake_by_ref();
        }
        Ok(self.session.flush_raw()?)
    }

    /// Returns true if the peer can take a message after all.
    fn reopen(&mut self, cx: &mut Context<'_>) -> bool {
        let now = Instant::now();
        if self.broken || self.raw_read.is_some_and(|before| now - before < RAW_INTERVAL) {
            return false;
        }
        self.raw_read = Some(now);
        if let Err(error) = self.try_drive_raw(cx) {
            self.fail(cx, &error);
        }
        self.is_open()
    }

    fn fail(&mut self, cx: &mut Context<'_>, error: &Closed) {
        tracing::debug!(%error, "a receiving peer is gone");
        self.broken = true;
        cx.waker().wake_by_ref();
    }

    /// Sends a message to a peer that can take it.
    fn send_one(&mut self, cx: &mut Context<'_>, message: &mut Frame) -> Result<(), Closed> {
        if !self.wants(message.as_slice()) {
            return Ok(());
        }
        if self.send_sample(cx, message) {
            return Ok(());
        }
        let message = message.make_bytes();
        self.session.write_message(&[], Header::new(0, message.len()).as_bytes(), message)?;
        self.session.flush(cx)?;
        // Not earlier: a message that is handed back is not on its way.
        if let Some(credit) = &mut self.credit {
            credit.count_sent(message.len());
        }
        Ok(())
    }

    /// Sends a message in shared memory if it is long. Returns false if it is to be sent through the socket.
    fn send_sample(&mut self, cx: &mut Context<'_>, message: &mut Frame) -> bool {
        let Some(credit) = &mut self.credit else { return false };
        let written = match self.sharing.send(message, credit.sent() + 1) {
            Sent::Inline => return false,
            Sent::Announce(command) => self.session.write(&command).and_then(|()| self.session.flush(cx)),
            Sent::Lost(reason) => Err(io::Error::other(reason)),
        };
        // Also if that failed: the sample is gone, so the message is on its way, and lost with the connection. Its bytes
        // are not the socket's.
        credit.count_sent(0);
        if let Err(error) = written {
            self.fail(cx, &error.into());
        }
        true
    }

    /// Sends several messages from the front of a queue in one piece. Returns how many: 0 if there are none to be sent
    /// together.
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
        // Not earlier: messages that stay in the queue are not on their way.
        if let Some(credit) = &mut self.credit {
            queue.iter().take(count).for_each(|message| credit.count_sent(message.len()));
        }
        Ok(count)
    }

    fn try_send_all(
        &mut self,
        cx: &mut Context<'_>,
        queue: &mut VecDeque<Frame>,
        sent: &mut dyn FnMut(usize),
    ) -> Result<(), Closed> {
        let driven = std::mem::take(&mut self.driven);
        let waits = |message: &Frame| !driven && queue.len() < GATHERED && self.is_gathered(message.as_slice());
        if queue.front().is_some_and(waits) {
            return Ok(());
        }
        let before = queue.len();
        while !queue.is_empty() {
            if !self.is_open() && !self.reopen(cx) {
                if self.window_is_open() {
                    break;
                }
                // Only what has been polled wakes the task when an acknowledgement arrives.
                self.try_drive(cx)?;
                if !self.is_open() {
                    break;
                }
            }
            let batched = if queue.len() > 1 { self.send_batch(cx, queue)? } else { 0 };
            if batched > 0 {
                queue.drain(..batched).for_each(|message| sent(message.len()));
            } else if let Some(message) = queue.front_mut() {
                let length = message.len();
                self.send_one(cx, message)?;
                queue.pop_front();
                sent(length);
            }
        }
        if driven && before - queue.len() >= GATHERED / 4 {
            // The burst goes on, most likely: one more message is enough to see that.
            (self.one_by_one, self.tick) = (ONE_BY_ONE - 1, tick());
        }
        Ok(self.report_waiting(!queue.is_empty())?)
    }

    /// Tells a peer to which only the newest message matters whether newer ones wait for its acknowledgement.
    fn report_waiting(&mut self, waiting: bool) -> io::Result<()> {
        if self.reports_waiting && waiting && !self.reported_waiting {
            self.reported_waiting = true;
            self.session.write(BEHIND)?;
        }
        if !waiting && (self.reported_waiting || self.answered != self.question) {
            self.reported_waiting = false;
            self.answered = self.question;
            self.session.write(&caught_up(self.answered))?;
        }
        Ok(())
    }
}

impl Link for SendLink {
    fn drive(&mut self, cx: &mut Context<'_>) -> Result<(), Disconnected> {
        (self.one_by_one, self.driven) = (0, true);
        if !self.broken {
            match self.try_drive(cx) {
                Ok(()) => return Ok(()),
                Err(error) => tracing::debug!(%error, "a receiving peer is gone"),
            }
            self.broken = true;
        }
        Err(Disconnected)
    }

    fn send(&mut self, cx: &mut Context<'_>, mut message: Frame) -> Result<(), Frame> {
        if self.is_gathered(message.as_slice()) {
            return Err(message);
        }
        if !self.is_open() && !self.reopen(cx) {
            if let Err(error) = self.report_waiting(true) {
                self.fail(cx, &error.into());
            }
            return Err(message);
        }
        match self.send_one(cx, &mut message) {
            Ok(()) => {
                self.count_one(cx);
                Ok(())
            }
            Err(error) => {
                self.fail(cx, &error);
                Err(message)
            }
        }
    }

    fn send_latched(&mut self, cx: &mut Context<'_>, mut message: Frame, age: Duration) -> Result<(), Frame> {
        if !self.is_open() && !self.reopen(cx) {
            return Err(message);
        }
        let age = u64::try_from(age.as_nanos()).unwrap_or(u64::MAX);
        // A plain ZeroMQ program gets the message alone.
        let told = if self.credit.is_some() { self.session.write(&latched(age)) } else { Ok(()) };
        match told.map_err(Closed::from).and_then(|()| self.send_one(cx, &mut message)) {
            Ok(()) => Ok(()),
            Err(error) => {
                self.fail(cx, &error);
                Err(message)
            }
        }
    }

    fn wants(&self, message: &[u8]) -> bool {
        self.topics.as_ref().is_none_or(|topics| topics.matches(message))
    }

    fn resumed(&self) -> Option<Resumed> {
        self.resumed
    }

    fn send_all(&mut self, cx: &mut Context<'_>, queue: &mut VecDeque<Frame>, sent: &mut dyn FnMut(usize)) {
        if let Err(error) = self.try_send_all(cx, queue, sent) {
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

    /// A new link may replace this one before the task has looked at it, and a failed write is noticed earlier than the last
    /// acknowledgements.
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
        if credit.not_received() == 0 || self.flush_requested == credit.sent() || self.broken {
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

/// The time of the coarse clock, which costs a fraction of an exact one and moves every 1 to 4 ms.
fn tick() -> Timespec {
    clock_gettime(ClockId::MonotonicCoarse)
}
