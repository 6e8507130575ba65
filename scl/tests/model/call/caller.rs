//! A requester and its call in progress, which is polled only after it was woken.

use super::model::Question;
use crate::model::wake_flag::WakeFlag;
use bytes::Bytes;
use scl::{CallError, Req};
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use tokio::sync::Mutex;

type Answer = Result<Bytes, CallError>;

pub(super) struct Caller {
    /// Locked by the call in progress.
    gate: Arc<Mutex<Req<Bytes, Bytes>>>,
    call: Option<Call>,
}

struct Call {
    question: Question,
    answer: Pin<Box<dyn Future<Output = Answer>>>,
    flag: WakeFlag,
}

impl Caller {
    pub(super) fn new(gate: Req<Bytes, Bytes>) -> Self {
        Self { gate: Arc::new(Mutex::new(gate)), call: None }
    }

    /// The question of the call in progress.
    pub(super) fn question(&self) -> Option<Question> {
        self.call.as_ref().map(|call| call.question)
    }

    /// Returns true if the replier is connected, or `None` during a call.
    pub(super) fn is_connected(&self) -> Option<bool> {
        self.gate.try_lock().ok().map(|gate| gate.is_connected())
    }

    /// Starts a call; the next poll is its first.
    pub(super) fn ask(&mut self, question: Question) {
        let gate = Arc::clone(&self.gate);
        let answer = Box::pin(async move { gate.lock().await.call(&question.body()).await });
        self.call = Some(Call { question, answer, flag: WakeFlag::set() });
    }

    pub(super) fn give_up(&mut self) {
        self.call = None;
    }

    pub(super) fn is_woken(&self) -> bool {
        self.call.as_ref().is_some_and(|call| call.flag.is_set())
    }

    /// Polls the call if it was woken. Returns its result if it has ended.
    pub(super) fn poll_if_woken(&mut self) -> Option<(Question, Answer)> {
        let call = self.call.as_mut().filter(|call| call.flag.is_set())?;
        call.flag = WakeFlag::default();
        match call.answer.as_mut().poll(&mut Context::from_waker(&call.flag.waker())) {
            Poll::Ready(answer) => self.call.take().map(|call| (call.question, answer)),
            Poll::Pending => None,
        }
    }

    /// Waits until the call has ended.
    pub(super) async fn end(&mut self) -> Option<(Question, Answer)> {
        let Call { question, answer, .. } = self.call.take()?;
        Some((question, answer.await))
    }
}
