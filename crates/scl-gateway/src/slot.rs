//! A value that several tasks use, and that is replaced only when all of them have dropped it.

use std::ops::Deref;
use std::sync::Arc;
use tokio::sync::{oneshot, watch};

/// Holds a value for the tasks that use it.
#[derive(Debug)]
pub(crate) struct Slot<T> {
    value: watch::Sender<Option<Held<T>>>,
    gone: Option<oneshot::Receiver<()>>,
}

/// A handle of the value, which exists until the last handle is dropped.
pub(crate) type Held<T> = Arc<Inner<T>>;

/// A task's view of the slot.
pub(crate) type View<T> = watch::Receiver<Option<Held<T>>>;

/// Fields are dropped in this order, so the value is gone when that is reported.
#[derive(Debug)]
pub(crate) struct Inner<T> {
    value: T,
    _gone: oneshot::Sender<()>,
}

impl<T> Slot<T> {
    pub(crate) fn new() -> Self {
        Self { value: watch::Sender::new(None), gone: None }
    }

    pub(crate) fn view(&self) -> View<T> {
        self.value.subscribe()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.value.borrow().is_none()
    }

    /// Puts a value into an empty slot.
    pub(crate) fn put(&mut self, value: T) {
        let (sender, receiver) = oneshot::channel();
        self.gone = Some(receiver);
        self.value.send_replace(Some(Arc::new(Inner { value, _gone: sender })));
    }

    /// Empties the slot, and waits until the value is gone.
    pub(crate) async fn clear(&mut self) {
        self.value.send_replace(None);
        if let Some(gone) = &mut self.gone {
            let _closed_without_a_message = gone.await;
            self.gone = None;
        }
    }
}

impl<T> Deref for Inner<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.value
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::future::poll_fn;
    use std::pin::pin;
    use std::task::Poll;

    #[tokio::test]
    async fn a_value_is_replaced_after_its_last_handle_is_dropped() {
        let mut slot = Slot::new();
        let view = slot.view();
        slot.put(1);
        let held = view.borrow().clone().unwrap();
        assert_eq!(**held, 1);
        {
            let mut clearing = pin!(slot.clear());
            poll_fn(|cx| {
                assert!(clearing.as_mut().poll(cx).is_pending(), "a task still has it");
                assert!(view.borrow().is_none(), "others get it no more");
                Poll::Ready(())
            })
            .await;
            drop(held);
            clearing.await;
        }
        slot.clear().await;
        slot.put(2);
        assert_eq!(view.borrow().as_deref().map(Deref::deref), Some(&2));
    }
}
