//! Calls that are ended at the worst moment: after they looked, and before they can be woken.

use super::plan;
use bytes::Bytes;
use scl::transport::{
    Answer, Endpoint, Guarantees, Receiver, Replier, Requester, Sender, Transport, TransportError, memory::Memory,
};
use scl::untyped::{Closer, Component};
use scl::{BlockingError, OpenOptions, RecvError};
use std::pin::pin;
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Waker};

/// Ends all calls when a call polls the end next.
type Trap = Arc<Mutex<Option<Closer>>>;

fn spring(trap: &Trap) {
    if let Some(closer) = trap.lock().unwrap().take() {
        closer.end_calls();
    }
}

/// Memory, but for receiving and requesting ends that never have anything.
struct Trapped {
    memory: Memory,
    trap: Trap,
}

struct Silent(Trap);

impl Receiver for Silent {
    fn poll_recv(&mut self, _cx: &mut Context<'_>) -> Poll<Bytes> {
        spring(&self.0);
        Poll::Pending
    }

    fn peers(&self) -> usize {
        0
    }
}

impl Requester for Silent {
    fn poll_connected(&mut self, _cx: &mut Context<'_>) -> Poll<()> {
        spring(&self.0);
        Poll::Pending
    }

    fn request(&mut self, _cx: &mut Context<'_>, _id: u64, body: Bytes) -> Result<(), Bytes> {
        Err(body)
    }

    fn is_connected(&self) -> bool {
        false
    }

    fn poll_answer(&mut self, _cx: &mut Context<'_>) -> Poll<Answer> {
        Poll::Pending
    }
}

impl Transport for Trapped {
    fn guarantees(&self) -> Guarantees {
        self.memory.guarantees()
    }

    fn publish(&self, endpoint: &Endpoint) -> Result<Box<dyn Sender>, TransportError> {
        self.memory.publish(endpoint)
    }

    fn subscribe(&self, _endpoint: &Endpoint) -> Result<Box<dyn Receiver>, TransportError> {
        Ok(Box::new(Silent(Arc::clone(&self.trap))))
    }

    fn push(&self, endpoint: &Endpoint) -> Result<Box<dyn Sender>, TransportError> {
        self.memory.push(endpoint)
    }

    fn pull(&self, endpoint: &Endpoint) -> Result<Box<dyn Receiver>, TransportError> {
        self.memory.pull(endpoint)
    }

    fn request(&self, _endpoint: &Endpoint) -> Result<Box<dyn Requester>, TransportError> {
        Ok(Box::new(Silent(Arc::clone(&self.trap))))
    }

    fn reply(&self, endpoint: &Endpoint) -> Result<Box<dyn Replier>, TransportError> {
        self.memory.reply(endpoint)
    }
}

/// On the test's own runtime, which polls nothing while the test does not wait.
async fn open() -> (Component, Trap) {
    let trap = Trap::default();
    let options = OpenOptions::new().transport(Trapped { memory: Memory::new(), trap: Arc::clone(&trap) });
    (Component::open_with(&plan("controller"), options).await.unwrap(), trap)
}

#[tokio::test]
async fn a_receiving_call_sees_that_it_was_ended_while_it_looked() {
    let (mut controller, trap) = open().await;
    let mut sub = controller.subscriber("raw").unwrap();
    *trap.lock().unwrap() = Some(controller.closer());
    let polled = pin!(sub.recv()).poll(&mut Context::from_waker(Waker::noop()));
    let closed = matches!(polled, Poll::Ready(Err(RecvError::Blocking { source: BlockingError::Closed, .. })));
    assert!(closed, "{polled:?}");
}

#[tokio::test]
async fn a_request_sees_that_it_was_ended_while_it_looked() {
    let (mut controller, trap) = open().await;
    let mut req = controller.requester("calibrate").unwrap();
    *trap.lock().unwrap() = Some(controller.closer());
    let question = super::bytes("7");
    let polled = pin!(req.call(&question)).poll(&mut Context::from_waker(Waker::noop()));
    let Poll::Ready(Err(scl::CallError::Blocking { source: BlockingError::Closed, .. })) = polled else {
        panic!("{polled:?}");
    };
}
