//! The real gates, and what a step does to them.

use super::check::check_taken_in;
use super::gates::{Receiver, Sender};
use super::inbox::Call;
use super::layout::{Source, layout, open_receiver, open_source};
use super::message::Message;
use super::model::{Connection, Model};
use super::observed::{ObservedTransport, SharedModel};
use super::step::{Case, Step};
use super::transit::Promise;
use crate::model::runner::Outcome;
use crate::model::wake_flag::WakeFlag;
use scl::OpenOptions;
use scl::transport::Transport;
use std::future::poll_fn;
use std::pin::pin;
use std::task::{Context, Poll};
use std::time::{Duration, Instant};

/// How often the gates' tasks may run in one step: often enough for all that they can do without new events.
const TURNS: usize = 20;
/// Over sockets, how long tasks may run until the ends have found each other. Those that have not continue later.
const CONNECTING: Duration = Duration::from_millis(50);
/// How often a call is polled that yields although it has nothing to wait for.
const YIELDS: usize = 100;

pub(super) struct Stage {
    pub(super) layout: usize,
    pub(super) promise: Promise,
    pub(super) model: SharedModel,
    options: OpenOptions,
    pub(super) source: Option<Box<dyn Source>>,
    pub(super) readers: Vec<Option<Receiver>>,
    /// Number of senders so far, and of messages of the present one.
    pub(super) last: Message,
    /// Set when the sender, which waits for room, is woken.
    pub(super) room: Option<WakeFlag>,
    /// Set when a reader that waits is woken.
    pub(super) news: Vec<Option<WakeFlag>>,
}

impl Stage {
    pub(super) fn new(index: usize, transport: impl Transport, promise: Promise) -> Self {
        let layout = layout(index);
        let (model, readers) = (SharedModel::new(Model::new(&layout, promise)), layout.readers().len());
        Self {
            layout: index,
            promise,
            options: OpenOptions::new().transport(ObservedTransport { transport, model: model.clone() }),
            model,
            source: None,
            readers: (0..readers).map(|_| None).collect(),
            last: Message { sender: 0, number: 0 },
            room: None,
            news: (0..readers).map(|_| None).collect(),
        }
    }

    pub(super) async fn play(mut self, case: &Case) -> Outcome {
        for (step, number) in case.steps.iter().zip(1..) {
            let done = self.step(*step).await.and_then(|()| self.check());
            self.verdict(done).map_err(|reason| format!("step {number}, {step:?}: {reason}"))?;
        }
        let ended = self.end().await;
        self.verdict(ended).map_err(|reason| format!("after the last step: {reason}"))?;
        self.close().await
    }

    /// The model's first contradiction, because everything else may follow from it.
    fn verdict(&self, done: Outcome) -> Outcome {
        self.model.lock().verdict().and(done)
    }

    async fn step(&mut self, step: Step) -> Outcome {
        let readers = self.readers.len();
        let of = |reader: usize| reader % readers;
        match step {
            Step::SenderAppears => self.sender_appears().await,
            Step::SenderVanishes => self.sender_vanishes(false).await,
            Step::SenderFinishes => self.sender_finishes().await,
            Step::Send(count) => self.send(count).await,
            Step::TrySend(count) => (0..count).try_for_each(|_| self.try_send()),
            Step::WaitForRoom => self.wait_for_room(),
            Step::ReaderAppears(reader) => self.reader_appears(of(reader)).await,
            Step::ReaderVanishes(reader) => self.reader_vanishes(of(reader)),
            Step::Recv(reader, count) => self.recv(of(reader), count),
            Step::TryRecv(reader, count) => self.try_recv(of(reader), count),
            Step::Latest(reader) => self.latest(of(reader)),
            Step::TasksRun => self.tasks_run().await,
        }
    }

    pub(super) async fn sender_appears(&mut self) -> Outcome {
        if self.source.is_none() {
            self.last = Message { sender: self.last.sender + 1, number: 0 };
            self.model.lock().sender_appears(self.last.sender);
            let opened = open_source(self.layout, self.options.clone()).await;
            self.source = Some(opened.map_err(|error| format!("{:?}", scl::Error::from(error)))?);
        }
        Ok(())
    }

    /// The sender is dropped if it can hand over at once what waits in its queues, and else closed without that.
    async fn sender_vanishes(&mut self, flushed: bool) -> Outcome {
        let Some(source) = self.source.take() else { return Ok(()) };
        self.room = None;
        let can_hand_over = |one: &Connection| !one.transit.has_reader() || one.has_room_for_all();
        let exact = self.promise.is_exact();
        let hands_over = exact && self.model.lock().connections.iter().all(can_hand_over);
        if hands_over || (flushed && !exact) {
            drop(source);
        } else {
            source.close_now().await;
        }
        let mut model = self.model.lock();
        let kept = model
            .connections
            .iter()
            .position(|one| hands_over && one.outbox.is_connected() && !one.outbox.waiting.is_empty());
        model.sender_vanishes(flushed);
        kept.map_or(Ok(()), |reader| {
            Err(format!("the sender was dropped with messages that reader {reader} could take"))
        })
    }

    async fn sender_finishes(&mut self) -> Outcome {
        let Some(source) = &mut self.source else { return Ok(()) };
        let mut flushed = false;
        for _ in 0..TURNS {
            flushed = poll_fn(|cx| Poll::Ready(source.gate().poll_flush(cx))).await;
            if flushed {
                break;
            }
            tokio::task::yield_now().await;
        }
        self.sender_vanishes(flushed).await
    }

    async fn send(&mut self, count: usize) -> Outcome {
        for _ in 0..count {
            let message = self.next_message();
            let Some(source) = &mut self.source else { return Ok(()) };
            self.room = None;
            self.model.lock().begins(message);
            if !is_sent(source.gate(), message, &self.model).await? {
                self.model.lock().is_cancelled();
                return self.wait_for_room();
            }
            self.model.lock().ends();
        }
        Ok(())
    }

    pub(super) fn try_send(&mut self) -> Outcome {
        let message = self.next_message();
        let Some(source) = &mut self.source else { return Ok(()) };
        self.room = None;
        self.model.lock().begins(message);
        let sent = source.gate().try_send(message);
        let mut model = self.model.lock();
        match sent {
            Ok(()) => model.ends(),
            Err(_) if model.would_wait() => model.is_cancelled(),
            Err(error) => return Err(format!("there is room, and `try_send` failed: {error}")),
        }
        Ok(())
    }

    fn next_message(&mut self) -> Message {
        self.last.number += 1;
        self.last
    }

    fn wait_for_room(&mut self) -> Outcome {
        let Some(source) = &mut self.source else { return Ok(()) };
        let flag = WakeFlag::default();
        let room = source.gate().poll_room(&mut Context::from_waker(&flag.waker()));
        self.room = (!room).then_some(flag);
        let expected = !self.model.lock().would_wait();
        if room == expected { Ok(()) } else { Err(format!("room: {room}, instead of {expected}")) }
    }

    pub(super) async fn reader_appears(&mut self, reader: usize) -> Outcome {
        if self.readers[reader].is_none() {
            self.model.lock().reader_appears(reader);
            let opened = open_receiver(self.layout, reader, self.options.clone()).await;
            self.readers[reader] = Some(opened.map_err(|error| format!("{:?}", scl::Error::from(error)))?);
        }
        Ok(())
    }

    fn reader_vanishes(&mut self, reader: usize) -> Outcome {
        if let Some(receiver) = self.readers[reader].take() {
            drop(receiver);
            self.news[reader] = None;
            self.model.lock().reader_vanishes(reader);
        }
        Ok(())
    }

    fn recv(&mut self, reader: usize, count: usize) -> Outcome {
        for _ in 0..count {
            let flag = WakeFlag::default();
            let polled = self.poll_recv(reader, &mut Context::from_waker(&flag.waker()))?;
            if polled.is_none() {
                self.news[reader] = self.readers[reader].is_some().then_some(flag);
                return Ok(());
            }
        }
        Ok(())
    }

    pub(super) fn poll_recv(&mut self, reader: usize, cx: &mut Context<'_>) -> Result<Option<Message>, String> {
        self.receive(reader, Call::Next, |gate| gate.poll_recv(cx))
    }

    fn try_recv(&mut self, reader: usize, count: usize) -> Outcome {
        for _ in 0..count {
            if self.receive(reader, Call::TryNext, Receiver::try_recv)?.is_none() {
                break;
            }
        }
        Ok(())
    }

    fn latest(&mut self, reader: usize) -> Outcome {
        self.receive(reader, Call::Newest, Receiver::latest).map(drop)
    }

    fn receive(
        &mut self,
        reader: usize,
        call: Call,
        receive: impl FnOnce(&mut Receiver) -> Result<Option<Message>, String>,
    ) -> Result<Option<Message>, String> {
        let Some(gate) = &mut self.readers[reader] else { return Ok(None) };
        self.news[reader] = None;
        let had_some = !self.model.lock().connections[reader].inbox.waiting.is_empty();
        self.model.lock().call_begins(reader, call);
        let given = receive(gate)?;
        let connection = &mut self.model.lock().connections[reader];
        connection.call_ends(given)?;
        let inbox = &connection.inbox;
        let takes_in_all = match call {
            Call::TryNext => given.is_none() || (!inbox.waits() && (!had_some || inbox.is_newest_only())),
            Call::Newest => true,
            _ => given.is_none() || !inbox.waits(),
        };
        if takes_in_all {
            check_taken_in(self.promise, connection)?;
        }
        Ok(given)
    }

    pub(super) async fn tasks_run(&mut self) -> Outcome {
        let started = Instant::now();
        while !self.promise.is_exact() && !self.is_known() && started.elapsed() < CONNECTING {
            tokio::task::yield_now().await;
        }
        for _ in 0..TURNS {
            tokio::task::yield_now().await;
        }
        if self.promise.is_exact() { self.check_progress() } else { Ok(()) }
    }

    /// Returns true if the sender, if there is one, knows which readers are there.
    fn is_known(&self) -> bool {
        let known =
            self.model.lock().connections.iter().all(|one| one.outbox.is_connected() == one.transit.has_reader());
        known || self.source.is_none()
    }

    /// Without waiting: the readers are gone before the sender could wait for them.
    async fn close(mut self) -> Outcome {
        self.readers.clear();
        if let Some(source) = self.source.take() {
            source.close_now().await;
        }
        Ok(())
    }
}

/// Sends, as far as that goes without new events. Returns false if the message has to wait.
async fn is_sent(gate: &mut Sender, message: Message, model: &SharedModel) -> Result<bool, String> {
    let mut sent = pin!(gate.send(message));
    for _ in 0..YIELDS {
        match poll_fn(|cx| Poll::Ready(sent.as_mut().poll(cx))).await {
            Poll::Ready(sent) => return sent.map(|()| true),
            Poll::Pending if model.lock().would_wait() => return Ok(false),
            // It let other tasks run.
            Poll::Pending => tokio::task::yield_now().await,
        }
    }
    Err(format!("there is room, and {message:?} waits"))
}
