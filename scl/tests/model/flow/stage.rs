//! The real gates, and how a step is done to them.

use super::check::check_taken_in;
use super::gates::{Receiver, Sender};
use super::layout::{layout, open_receiver, open_sender};
use super::ledger::{Book, Ledger};
use super::message::Message;
use super::model::Model;
use super::step::{Case, Step};
use super::way::Promise;
use crate::raised::Raised;
use crate::trial::Outcome;
use scl::OpenOptions;
use scl::transport::Transport;
use std::future::poll_fn;
use std::pin::pin;
use std::task::{Context, Poll};
use std::time::{Duration, Instant};

/// How often the tasks of the connections may run in one step: often enough for all that each can do without news.
const TURNS: usize = 10;
/// Over sockets, how long tasks may run until the ends have found each other; whoever has not goes on later.
const DIALLING: Duration = Duration::from_millis(50);
/// How often a call is asked again that gave way although it has nothing to wait for.
const PATIENCE: usize = 100;

pub(super) struct Stage {
    pub(super) index: usize,
    pub(super) promise: Promise,
    pub(super) book: Book,
    options: OpenOptions,
    pub(super) sender: Option<Sender>,
    pub(super) readers: Vec<Option<Receiver>>,
    /// How many senders there were, and how many messages the present one has sent.
    pub(super) count: Message,
    /// Raised when the sender, which waits for room, is woken.
    pub(super) room: Option<Raised>,
    /// Raised when a reader that waits is woken.
    pub(super) news: Vec<Option<Raised>>,
}

impl Stage {
    pub(super) fn new(index: usize, transport: impl Transport, promise: Promise) -> Self {
        let layout = layout(index);
        let (book, readers) = (Book::new(Model::new(&layout, promise)), layout.readers().len());
        Self {
            index,
            promise,
            options: OpenOptions::new().transport(Ledger { transport, book: book.clone() }),
            book,
            sender: None,
            readers: (0..readers).map(|_| None).collect(),
            count: Message { sender: 0, number: 0 },
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
        self.verdict(ended).map_err(|reason| format!("after the last step: {reason}"))
    }

    /// What the model says went wrong first; the rest may follow from that.
    fn verdict(&self, done: Outcome) -> Outcome {
        self.book.model().verdict().and(done)
    }

    async fn step(&mut self, step: Step) -> Outcome {
        let readers = self.readers.len();
        let of = |reader: usize| reader % readers;
        match step {
            Step::SenderAppears => self.sender_appears().await,
            Step::SenderVanishes => self.sender_vanishes(false),
            Step::SenderFinishes => self.sender_finishes().await,
            Step::Send(count) => self.send(count).await,
            Step::TrySend(count) => (0..count).try_for_each(|_| self.try_send()),
            Step::WaitForRoom => self.wait_for_room(),
            Step::ReaderAppears(reader) => self.reader_appears(of(reader)).await,
            Step::ReaderVanishes(reader) => self.reader_vanishes(of(reader)),
            Step::Recv(reader, count) => self.recv(of(reader), count),
            Step::TryRecv(reader, count) => (0..count).try_for_each(|_| self.try_recv(of(reader))),
            Step::Latest(reader) => self.latest(of(reader)),
            Step::TasksRun => self.tasks_run().await,
        }
    }

    pub(super) async fn sender_appears(&mut self) -> Outcome {
        if self.sender.is_none() {
            self.count = Message { sender: self.count.sender + 1, number: 0 };
            self.sender = Some(open_sender(self.index, self.options.clone()).await.map_err(|error| error.to_string())?);
        }
        Ok(())
    }

    fn sender_vanishes(&mut self, flushed: bool) -> Outcome {
        let Some(sender) = self.sender.take() else { return Ok(()) };
        drop(sender);
        self.room = None;
        let mut model = self.book.model();
        let kept = model.connections.iter().position(|one| self.promise.is_exact() && one.could_take_more());
        model.sender_goes(flushed);
        kept.map_or(Ok(()), |place| Err(format!("the sender went without handing over what reader {place} could take")))
    }

    async fn sender_finishes(&mut self) -> Outcome {
        let Some(sender) = &mut self.sender else { return Ok(()) };
        let mut flushed = false;
        for _ in 0..TURNS {
            flushed = poll_fn(|cx| Poll::Ready(sender.poll_flush(cx))).await;
            if flushed {
                break;
            }
            tokio::task::yield_now().await;
        }
        self.sender_vanishes(flushed)
    }

    async fn send(&mut self, count: usize) -> Outcome {
        for _ in 0..count {
            let message = self.next_message();
            let Some(sender) = &mut self.sender else { return Ok(()) };
            self.room = None;
            self.book.model().begins(message);
            if !completed(sender, message, &self.book).await? {
                self.book.model().is_called_off();
                return self.wait_for_room();
            }
            self.book.model().ends();
        }
        Ok(())
    }

    pub(super) fn try_send(&mut self) -> Outcome {
        let message = self.next_message();
        let Some(sender) = &mut self.sender else { return Ok(()) };
        self.room = None;
        let full = self.book.model().makes_wait();
        self.book.model().begins(message);
        let sent = sender.try_send(message);
        match (&sent, full) {
            (Ok(()), _) => self.book.model().ends(),
            (Err(_), true) => self.book.model().is_called_off(),
            (Err(error), false) => return Err(format!("there is room, and the answer was: {error}")),
        }
        Ok(())
    }

    fn next_message(&mut self) -> Message {
        self.count.number += 1;
        self.count
    }

    fn wait_for_room(&mut self) -> Outcome {
        let Some(sender) = &mut self.sender else { return Ok(()) };
        let raised = Raised::default();
        let room = sender.poll_room(&mut Context::from_waker(&raised.waker()));
        self.room = (!room).then_some(raised);
        let expected = !self.book.model().makes_wait();
        if room == expected { Ok(()) } else { Err(format!("room: {room}, instead of {expected}")) }
    }

    pub(super) async fn reader_appears(&mut self, reader: usize) -> Outcome {
        if self.readers[reader].is_none() {
            let opened = open_receiver(self.index, reader, self.options.clone()).await;
            self.readers[reader] = Some(opened.map_err(|error| error.to_string())?);
            self.book.model().connections[reader].way.reader_comes();
        }
        Ok(())
    }

    fn reader_vanishes(&mut self, reader: usize) -> Outcome {
        if let Some(receiver) = self.readers[reader].take() {
            drop(receiver);
            self.news[reader] = None;
            self.book.model().reader_goes(reader);
        }
        Ok(())
    }

    fn recv(&mut self, reader: usize, count: usize) -> Outcome {
        for _ in 0..count {
            let raised = Raised::default();
            let polled = self.poll_recv(reader, &mut Context::from_waker(&raised.waker()))?;
            if polled.is_none() {
                self.news[reader] = self.readers[reader].is_some().then_some(raised);
                return Ok(());
            }
        }
        Ok(())
    }

    pub(super) fn poll_recv(&mut self, reader: usize, cx: &mut Context<'_>) -> Result<Option<Message>, String> {
        let Some(receiver) = &mut self.readers[reader] else { return Ok(None) };
        self.news[reader] = None;
        let given = receiver.poll_recv(cx)?;
        let connection = &mut self.book.model().connections[reader];
        connection.inbox.gives(given)?;
        let newest = given.is_none() || (connection.inbox.holds_one() && !connection.inbox.waits());
        check_taken_in(self.promise, newest, connection)?;
        Ok(given)
    }

    fn try_recv(&mut self, reader: usize) -> Outcome {
        let Some(receiver) = &mut self.readers[reader] else { return Ok(()) };
        self.news[reader] = None;
        let given = receiver.try_recv()?;
        let connection = &mut self.book.model().connections[reader];
        connection.inbox.gives(given)?;
        check_taken_in(self.promise, given.is_none() || !connection.inbox.waits(), connection)
    }

    fn latest(&mut self, reader: usize) -> Outcome {
        let Some(receiver) = &mut self.readers[reader] else { return Ok(()) };
        self.news[reader] = None;
        self.book.model().connections[reader].inbox.passes_over();
        let given = receiver.latest()?;
        let connection = &mut self.book.model().connections[reader];
        connection.inbox.gives_newest(given)?;
        check_taken_in(self.promise, true, connection)
    }

    pub(super) async fn tasks_run(&mut self) -> Outcome {
        let started = Instant::now();
        while !self.promise.is_exact() && !self.is_known() && started.elapsed() < DIALLING {
            tokio::task::yield_now().await;
        }
        for _ in 0..TURNS {
            tokio::task::yield_now().await;
        }
        if self.promise.is_exact() { self.check_moved() } else { Ok(()) }
    }

    /// Whether the sender, if there is one, knows which readers are there.
    fn is_known(&self) -> bool {
        let known = self.book.model().connections.iter().all(|one| one.held.present == one.way.has_reader());
        known || self.sender.is_none()
    }
}

/// Sends, as far as it goes without news: false when the message would have to wait.
async fn completed(sender: &mut Sender, message: Message, book: &Book) -> Result<bool, String> {
    let mut sent = pin!(sender.send(message));
    for _ in 0..PATIENCE {
        match poll_fn(|cx| Poll::Ready(sent.as_mut().poll(cx))).await {
            Poll::Ready(sent) => return sent.map(|()| true),
            Poll::Pending if book.model().makes_wait() => return Ok(false),
            // It let others run.
            Poll::Pending => tokio::task::yield_now().await,
        }
    }
    Err(format!("there is room, and {message:?} waits"))
}
