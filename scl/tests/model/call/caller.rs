//! A requester with its call in progress, which is polled only when it was woken.

use super::model::Question;
use crate::raised::Raised;
use bytes::Bytes;
use scl::{CallError, Req};
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use tokio::sync::Mutex;

type Answer = Result<Bytes, CallError>;

pub(super) struct Caller {
    /// Locked by the call in progress; one that is given up lets go of it.
    gate: Arc<Mutex<Req<Bytes, Bytes>>>,
    call: Option<Call>,
}

struct Call {
    question: Question,
    answer: Pin<Box<dyn Future<Output = Answer>>>,
    raised: Raised,
}

impl Caller {
    pub(super) fn new(gate: Req<Bytes, Bytes>) -> Self {
        Self { gate: Arc::new(Mutex::new(gate)), call: None }
    }

    /// What is being asked.
    pub(super) fn asks(&self) -> Option<Question> {
        self.call.as_ref().map(|call| call.question)
    }

    /// Whether the replier is known to be there; `None` while that cannot be asked.
    pub(super) fn is_connected(&self) -> Option<bool> {
        self.gate.try_lock().ok().map(|gate| gate.connected())
    }

    /// Starts a call; the next poll is its first.
    pub(super) fn ask(&mut self, question: Question) {
        let gate = Arc::clone(&self.gate);
        let answer = Box::pin(async move { gate.lock().await.call(&question.body()).await });
        self.call = Some(Call { question, answer, raised: Raised::up() });
    }

    pub(super) fn give_up(&mut self) {
        self.call = None;
    }

    pub(super) fn is_woken(&self) -> bool {
        self.call.as_ref().is_some_and(|call| call.raised.is_raised())
    }

    /// How the call has ended, if it has; not looked at unless it was woken.
    pub(super) fn poll_if_woken(&mut self) -> Option<(Question, Answer)> {
        let call = self.call.as_mut().filter(|call| call.raised.is_raised())?;
        call.raised = Raised::default();
        match call.answer.as_mut().poll(&mut Context::from_waker(&call.raised.waker())) {
            Poll::Ready(answer) => self.call.take().map(|call| (call.question, answer)),
            Poll::Pending => None,
        }
    }

    /// Waits for the end of the call.
    pub(super) async fn end(&mut self) -> Option<(Question, Answer)> {
        let Call { question, answer, .. } = self.call.take()?;
        Some((question, answer.await))
    }
}
