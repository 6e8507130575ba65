//! The end of a `req` gate, shared by its calls and its background task.

use super::io_waker::IoWaker;
use super::stats::{Activity, GateStats};
use super::watch::Watch;
use crate::error::{BlockingError, Missing};
use crate::figures::{FigureSource, FiguresInWait};
use crate::runtime_dir::{ConnectionFigures, GateFigures};
use crate::spec::GateSpec;
use crate::state::{Changes, ComponentState, WakeCall};
use crate::sync::{AbortOnDrop, lock, try_lock};
use crate::time::Watchdog;
use crate::transport::{Answer, Requester};
use bytes::Bytes;
use std::future::poll_fn;
use std::pin::pin;
use std::sync::{Arc, Mutex, MutexGuard};
use std::task::{Context, Poll, Waker};
use std::time::Duration;
use tokio::time::Instant;

pub(super) struct Exchange {
    end: Arc<Mutex<End>>,
    io: Arc<IoWaker>,
    _task: AbortOnDrop,
}

struct End {
    link: Box<dyn Requester>,
    waker: Waker,
    /// Whether a call is under way, whose reply the task must not take.
    in_call: bool,
    /// Whether the link has just refused the request of the call.
    refused: bool,
    was_connected: bool,
    changes: Changes,
    sent: u64,
    received: u64,
    /// Replies that the codec could not read.
    undecodable: u64,
    activity: Activity,
    in_wait: Arc<FiguresInWait>,
}

/// Why a request got no reply.
pub(super) enum ExchangeError {
    TimedOut,
    Lost,
    /// The gate cannot be used any more.
    Refused(BlockingError),
}

impl Exchange {
    /// Starts to connect. Needs a tokio runtime.
    pub(super) fn new(link: Box<dyn Requester>, state: &ComponentState) -> Self {
        let (io, changes) = (Arc::new(IoWaker::default()), state.changes());
        state.register_calls(Arc::downgrade(&io) as _);
        let waker = Waker::from(Arc::clone(&io));
        let end = Arc::new(Mutex::new(End {
            link,
            waker,
            in_call: false,
            refused: false,
            was_connected: false,
            changes,
            sent: 0,
            received: 0,
            undecodable: 0,
            activity: Activity::default(),
            in_wait: Arc::new(FiguresInWait::new(1)),
        }));
        // Weak, so that the end is gone with the gate, and not only when the runtime drops the task.
        let (driven, task_io) = (Arc::downgrade(&end), Arc::clone(&io));
        let task = tokio::spawn(poll_fn(move |cx| {
            task_io.set_task(cx.waker());
            let Some(end) = driven.upgrade() else { return Poll::Ready(()) };
            lock(&end).drive();
            task_io.wake_call();
            Poll::Pending
        }));
        Self { end, io, _task: AbortOnDrop(task.abort_handle()) }
    }

    /// Sends a request and waits for its reply.
    pub(super) async fn call(
        &self,
        id: u64,
        body: Bytes,
        watchdog: &mut Watchdog,
        deadline: Instant,
        state: &ComponentState,
    ) -> Result<Bytes, ExchangeError> {
        let _in_call = InCall::begin(self);
        let mut unsent = Some(body);
        let mut direct_wait = state.direct_wait();
        poll_fn(|cx| {
            // A stopped program's calls stay pending: what waits for them is dropped.
            if state.is_stopped() {
                return Poll::Pending;
            }
            let polled = self.poll(id, &mut unsent, &mut direct_wait, deadline, cx);
            if polled.is_ready() {
                return polled;
            }
            // After the waker was registered, so that no end of the calls is missed.
            if let Err(refused) = state.check() {
                return Poll::Ready(Err(ExchangeError::Refused(refused)));
            }
            // Without its timer the call could wait forever, so a timer that fails ends it too.
            watchdog.poll_past(cx, deadline).map(|_past| Err(ExchangeError::TimedOut))
        })
        .await
    }

    /// The call of a gate that is connected to nothing.
    pub(super) async fn unconnected(
        watchdog: &mut Watchdog,
        deadline: Instant,
        state: &ComponentState,
    ) -> Result<Bytes, ExchangeError> {
        let changes = state.changes();
        loop {
            let mut changed = pin!(changes.next());
            // Before the check, so that no end of the calls is missed.
            changed.as_mut().enable();
            state.check().map_err(ExchangeError::Refused)?;
            let past = poll_fn(|cx| match watchdog.poll_past(cx, deadline) {
                Poll::Ready(_past) => Poll::Ready(true),
                Poll::Pending => changed.as_mut().poll(cx).map(|()| false),
            });
            if past.await {
                return Err(ExchangeError::TimedOut);
            }
        }
    }

    fn poll(
        &self,
        id: u64,
        unsent: &mut Option<Bytes>,
        direct_wait: &mut Option<Duration>,
        deadline: Instant,
        cx: &mut Context<'_>,
    ) -> Poll<Result<Bytes, ExchangeError>> {
        let mut end = lock(&self.end);
        let mut polled = end.poll_call(id, unsent);
        if unsent.is_none()
            && polled.is_pending()
            && let Some(within) = direct_wait.take()
            && end.wait(within.min(deadline.saturating_duration_since(Instant::now())))
        {
            polled = end.poll_call(id, unsent);
        }
        if polled.is_pending() {
            self.io.wait(cx.waker(), false);
            if std::mem::take(&mut end.refused) {
                // Tried again after others had their turn.
                cx.waker().wake_by_ref();
            }
        }
        polled
    }

    pub(super) fn missing(&self, spec: &'static GateSpec) -> Vec<Missing> {
        self.lock().missing(spec)
    }

    pub(super) fn watch(&self, spec: &'static GateSpec) -> Watch {
        let end = Arc::downgrade(&self.end);
        Watch::new(spec, move || end.upgrade().map(|end| lock(&end).missing(spec)).unwrap_or_default())
    }

    pub(super) fn stats(&self) -> GateStats {
        let end = self.lock();
        let mut stats = GateStats { sent: end.sent, received: end.received, ..GateStats::default() };
        stats.rejected = end.undecodable;
        stats.peers = usize::from(end.link.is_connected());
        end.activity.add_to(&mut stats);
        stats
    }

    pub(super) fn count_undecodable(&self) {
        self.lock().undecodable += 1;
    }

    pub(super) fn figures(&self) -> FigureSource {
        let (end, in_wait) = (Arc::downgrade(&self.end), Arc::clone(&self.lock().in_wait));
        Box::new(move |figures| {
            let Some(end) = end.upgrade() else { return false };
            match try_lock(&end) {
                Some(end) => end.read_figures(figures),
                None => in_wait.copy_to(figures),
            }
            true
        })
    }

    /// Keeps the end from being dropped in a forked child, where that would disturb the parent.
    pub(super) fn leak(&self) {
        std::mem::forget(Arc::clone(&self.end));
    }

    fn lock(&self) -> MutexGuard<'_, End> {
        lock(&self.end)
    }
}

impl End {
    /// Reconnects, and answers heartbeats, while no call does.
    fn drive(&mut self) {
        if !self.in_call {
            let cx = &mut Context::from_waker(&self.waker);
            let _connected = self.link.poll_connected(cx);
        }
        self.report_change();
    }

    fn poll_call(&mut self, id: u64, unsent: &mut Option<Bytes>) -> Poll<Result<Bytes, ExchangeError>> {
        let waker = self.waker.clone();
        let cx = &mut Context::from_waker(&waker);
        if let Some(body) = unsent.take() {
            let connected = self.link.poll_connected(cx);
            self.report_change();
            if connected.is_pending() {
                *unsent = Some(body);
                return Poll::Pending;
            }
            if let Err(body) = self.link.request(cx, id, body) {
                // The connection broke at this very moment; the next poll starts to reconnect.
                *unsent = Some(body);
                self.refused = true;
                return Poll::Pending;
            }
            self.sent += 1;
        }
        loop {
            match self.link.poll_answer(cx) {
                Poll::Ready(Answer::Reply { id: replied, body }) if replied == id => {
                    self.received += 1;
                    self.activity.add(body.len());
                    return Poll::Ready(Ok(body));
                }
                Poll::Ready(Answer::Reply { .. }) => tracing::debug!("discarded the reply to an earlier call"),
                Poll::Ready(Answer::Lost) => return Poll::Ready(Err(ExchangeError::Lost)),
                Poll::Pending => return Poll::Pending,
            }
        }
    }

    /// Waits for the reply on the calling thread.
    fn wait(&mut self, within: Duration) -> bool {
        let in_wait = Arc::clone(&self.in_wait);
        let _waiting = in_wait.begin(|figures| self.read_figures(figures));
        self.link.wait(within)
    }

    fn read_figures(&self, figures: &mut GateFigures) {
        figures.clear();
        (figures.sent, figures.received, figures.rejected) = (self.sent, self.received, self.undecodable);
        figures.waiting = self.in_call.into();
        let connected = self.link.is_connected();
        figures.peers = connected.into();
        self.activity.add_to_figures(figures);
        for connection in &mut figures.connections {
            *connection = ConnectionFigures {
                connected,
                waiting: self.in_call.into(),
                taken: self.received,
                ..ConnectionFigures::default()
            };
        }
    }

    fn missing(&self, spec: &'static GateSpec) -> Vec<Missing> {
        if self.link.is_connected() {
            return Vec::new();
        }
        let required = spec.links.iter().filter(|link| link.required);
        required.map(|link| Missing { link, refusal: self.link.refusal() }).collect()
    }

    fn report_change(&mut self) {
        let is_connected = self.link.is_connected();
        if std::mem::replace(&mut self.was_connected, is_connected) != is_connected {
            self.changes.report();
        }
    }
}

/// Marks a call as under way, and hands the end back to the task when it ends in any way.
struct InCall<'a>(&'a Exchange);

impl<'a> InCall<'a> {
    fn begin(exchange: &'a Exchange) -> Self {
        exchange.lock().in_call = true;
        Self(exchange)
    }
}

impl Drop for InCall<'_> {
    fn drop(&mut self) {
        let mut end = self.0.lock();
        end.in_call = false;
        self.0.io.forget_call();
        // Polled once more, so that an event reported to the call is handled, and the next one wakes the task.
        end.drive();
    }
}
