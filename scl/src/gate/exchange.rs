//! The end of a `req` gate, shared by its calls and its background task.
//!
//! ```text
//! a call: waits for a permit ──▶ unsent ──▶ sent ──▶ replied, refused or lost ──▶ returned
//!                                  │          └── timed out, or dropped: the reply is discarded
//!                                  └── timed out, or dropped: nothing was sent
//! ```

mod in_call;

use super::call_wakers::CallWakers;
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
use in_call::InCall;
use scl_fork::ProcessOwned;
use std::future::poll_fn;
use std::pin::pin;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::task::{Context, Poll, Waker};
use std::time::Duration;
use tokio::runtime::Handle;
use tokio::sync::Semaphore;
use tokio::time::Instant;

pub(super) struct Exchange {
    end: ProcessOwned<Arc<Mutex<End>>>,
    calls: Arc<CallWakers>,
    /// One for each call that may be in progress.
    permits: Semaphore,
    last_id: AtomicU64,
    _task: AbortOnDrop,
}

struct End {
    link: Box<dyn Requester>,
    waker: Waker,
    /// The calls whose request was sent.
    sent_calls: Vec<SentCall>,
    /// Whether the link has just refused the request of a call.
    refused: bool,
    was_connected: bool,
    changes: Changes,
    sent: u64,
    received: u64,
    /// Replies that the codec could not read.
    undecodable: u64,
    activity: Activity,
    in_wait: Arc<FiguresInWait>,
    calls: Arc<CallWakers>,
}

struct SentCall {
    id: u64,
    /// The answer, until the call takes it.
    result: Option<Result<Bytes, ExchangeError>>,
}

/// Why a request got no reply.
pub(super) enum ExchangeError {
    TimedOut,
    Lost,
    /// The replier has refused the request.
    Refused,
    /// The gate cannot be used any more.
    Unusable(BlockingError),
}

impl Exchange {
    /// Starts to connect. As many calls can be in progress as there are watchdogs. Needs a tokio runtime.
    pub(super) fn new(link: Box<dyn Requester>, watchdogs: Vec<Watchdog>, state: &ComponentState) -> Self {
        let permits = Semaphore::new(watchdogs.len());
        let (calls, changes) = (Arc::new(CallWakers::new(watchdogs)), state.changes());
        state.register_calls(Arc::downgrade(&calls) as _);
        let waker = Waker::from(Arc::clone(&calls));
        let end = Arc::new(Mutex::new(End {
            link,
            waker,
            sent_calls: Vec::new(),
            refused: false,
            was_connected: false,
            changes,
            sent: 0,
            received: 0,
            undecodable: 0,
            activity: Activity::default(),
            in_wait: Arc::new(FiguresInWait::new(1)),
            calls: Arc::clone(&calls),
        }));
        let task_calls = Arc::clone(&calls);
        let task = AbortOnDrop::drive(&Handle::current(), &end, move |end, cx| {
            task_calls.set_task(cx.waker());
            if lock(end).drive() {
                task_calls.wake_call();
            }
        });
        Self { end: ProcessOwned::new(end), calls, permits, last_id: AtomicU64::new(0), _task: task }
    }

    /// Sends a request and waits for its reply.
    pub(super) async fn call(
        &self,
        body: Bytes,
        deadline: Instant,
        state: &ComponentState,
    ) -> Result<Bytes, ExchangeError> {
        let _permit = match self.permits.try_acquire() {
            Ok(permit) => permit,
            Err(_) => {
                // Boxed, because few calls need this future, and it would make every call larger.
                let permit = Box::pin(until(self.permits.acquire(), deadline, state)).await?;
                permit.unwrap_or_else(|_| unreachable!("the semaphore is never closed"))
            }
        };
        let id = self.last_id.fetch_add(1, Ordering::Relaxed) + 1;
        let mut in_call = InCall::begin(self, id);
        let mut unsent = Some(body);
        let mut direct_wait = state.direct_wait();
        poll_fn(|cx| {
            // After a stop request, calls stay pending until the futures that await them are dropped.
            if state.is_stopped() {
                return Poll::Pending;
            }
            let polled = self.poll(id, &mut unsent, &mut direct_wait, deadline, cx);
            if polled.is_ready() {
                return polled;
            }
            // Check after the waker was registered, so that `end_calls` is not missed.
            if let Err(unusable) = state.check() {
                return Poll::Ready(Err(ExchangeError::Unusable(unusable)));
            }
            in_call.poll_past(cx, deadline).map(|()| Err(ExchangeError::TimedOut))
        })
        .await
    }

    /// Waits until the deadline: the call of a gate without a connection.
    pub(super) async fn unconnected(deadline: Instant, state: &ComponentState) -> Result<Bytes, ExchangeError> {
        until(std::future::pending(), deadline, state).await
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
            // Only if there is no other call: the wait holds the lock on the end, which others would need.
            && self.calls.in_progress() == 1
            && end.wait(within.min(deadline.saturating_duration_since(Instant::now())))
        {
            polled = end.poll_call(id, unsent);
        }
        if polled.is_pending() {
            self.calls.wait(id, cx.waker());
            if std::mem::take(&mut end.refused) {
                // Retry after other tasks have run.
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
        GateStats { waiting: 0, ..GateStats::of(|figures| self.lock().read_figures(figures)) }
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

    fn lock(&self) -> MutexGuard<'_, End> {
        lock(&self.end)
    }
}

impl End {
    /// Reconnects, answers heartbeats, and hands replies to their calls. Returns true if a call that waits to be sent
    /// should look at the connection.
    fn drive(&mut self) -> bool {
        if self.sent_calls.is_empty() && self.calls.in_progress() == 0 {
            let _connected = self.link.poll_connected(&mut Context::from_waker(&self.waker));
        } else {
            self.take_answers(None);
        }
        self.report_change();
        self.sent_calls.len() < self.calls.in_progress()
    }

    fn poll_call(&mut self, id: u64, unsent: &mut Option<Bytes>) -> Poll<Result<Bytes, ExchangeError>> {
        if let Some(body) = unsent.take() {
            *unsent = self.request(id, body);
        }
        self.take_answers(Some(id));
        let Some(index) = self.sent_calls.iter().position(|call| call.id == id) else { return Poll::Pending };
        match self.sent_calls[index].result.take() {
            Some(result) => {
                self.sent_calls.swap_remove(index);
                Poll::Ready(result)
            }
            None => Poll::Pending,
        }
    }

    /// Sends a request, or returns it if that is not possible now.
    fn request(&mut self, id: u64, body: Bytes) -> Option<Bytes> {
        // `poll_connected` discards replies, so call it only while none is awaited. Otherwise use the connection as it
        // is.
        if self.sent_calls.iter().all(|call| call.result.is_some()) {
            let connected = self.link.poll_connected(&mut Context::from_waker(&self.waker));
            self.report_change();
            if connected.is_pending() {
                return Some(body);
            }
        }
        match self.link.request(&mut Context::from_waker(&self.waker), id, body) {
            Ok(()) => {
                self.sent += 1;
                debug_assert!(self.sent_calls.iter().all(|call| call.id != id), "request {id} is sent a second time");
                self.sent_calls.push(SentCall { id, result: None });
                None
            }
            Err(body) => {
                // The connection has just broken, and the next poll starts to reconnect; or the link has no room.
                self.refused = true;
                Some(body)
            }
        }
    }

    /// Hands each reply that has arrived to its call, and wakes that call unless it is `caller`. A broken connection
    /// ends its calls with [`ExchangeError::Lost`].
    fn take_answers(&mut self, caller: Option<u64>) {
        while self.sent_calls.iter().any(|call| call.result.is_none()) {
            let (id, result) = match self.link.poll_answer(&mut Context::from_waker(&self.waker)) {
                Poll::Ready(Answer::Reply { id, body }) => (id, Ok(body)),
                Poll::Ready(Answer::Refused { id }) => (id, Err(ExchangeError::Refused)),
                Poll::Ready(Answer::Lost) => {
                    let lost: Vec<u64> = self.sent_calls.iter().map(|call| call.id).collect();
                    lost.into_iter().for_each(|id| self.finish(id, Err(ExchangeError::Lost), caller));
                    continue;
                }
                Poll::Pending => return,
            };
            self.finish(id, result, caller);
        }
    }

    fn finish(&mut self, id: u64, result: Result<Bytes, ExchangeError>, caller: Option<u64>) {
        let Some(call) = self.sent_calls.iter_mut().find(|call| call.id == id && call.result.is_none()) else {
            return tracing::debug!("discarded the reply to an earlier call");
        };
        if let Ok(body) = &result {
            debug_assert!(self.received < self.sent, "more replies than requests");
            self.received += 1;
            self.activity.add(body.len());
        }
        call.result = Some(result);
        if caller != Some(id) {
            self.calls.wake_one(id);
        }
    }

    /// Waits on the calling thread, at most `within`. Returns true if something has arrived.
    fn wait(&mut self, within: Duration) -> bool {
        let in_wait = Arc::clone(&self.in_wait);
        let _waiting = in_wait.begin(|figures| self.read_figures(figures));
        self.link.wait(within)
    }

    fn read_figures(&self, figures: &mut GateFigures) {
        let waiting = self.calls.in_progress() as u64;
        let connected = self.link.is_connected();
        figures.set(GateFigures {
            sent: self.sent,
            received: self.received,
            rejected: self.undecodable,
            undecodable: self.undecodable,
            waiting,
            peers: connected.into(),
            ..GateFigures::default()
        });
        self.activity.add_to(figures);
        for connection in &mut figures.connections {
            *connection =
                ConnectionFigures { connected, waiting, taken: self.received, ..ConnectionFigures::default() };
        }
    }

    fn missing(&self, spec: &'static GateSpec) -> Vec<Missing> {
        if self.link.is_connected() {
            return Vec::new();
        }
        let required = spec.connections.iter().filter(|link| link.required);
        required.map(|connection| Missing { connection, refusal: self.link.refusal() }).collect()
    }

    fn report_change(&mut self) {
        let is_connected = self.link.is_connected();
        if std::mem::replace(&mut self.was_connected, is_connected) != is_connected {
            self.changes.report();
        }
    }
}

/// Waits for a future until the deadline, or until the gate cannot be used any more.
async fn until<F: Future>(future: F, deadline: Instant, state: &ComponentState) -> Result<F::Output, ExchangeError> {
    // Without a timer this could wait forever.
    let mut watchdog = Watchdog::new().map_err(|_no_timer| ExchangeError::TimedOut)?;
    let mut future = pin!(future);
    let changes = state.changes();
    loop {
        let mut changed = pin!(changes.next());
        // Subscribe before checking, so that `end_calls` is not missed.
        changed.as_mut().enable();
        state.check().map_err(ExchangeError::Unusable)?;
        let ended = poll_fn(|cx| match future.as_mut().poll(cx) {
            Poll::Ready(output) => Poll::Ready(Some(Ok(output))),
            Poll::Pending => match watchdog.poll_past(cx, deadline) {
                Poll::Ready(_past) => Poll::Ready(Some(Err(ExchangeError::TimedOut))),
                Poll::Pending => changed.as_mut().poll(cx).map(|()| None),
            },
        });
        if let Some(ended) = ended.await {
            return ended;
        }
    }
}
