//! Which of many futures were woken, so that one event does not cost a poll of all of them.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Wake, Waker};

/// The futures that were woken and not polled since, each once, in the order of their wake-ups.
#[derive(Debug, Default)]
pub(crate) struct Woken {
    state: Arc<Mutex<State>>,
}

#[derive(Debug, Default)]
struct State {
    queue: VecDeque<usize>,
    queued: Vec<bool>,
    task: Option<Waker>,
}

struct Member {
    index: usize,
    state: Arc<Mutex<State>>,
}

impl Woken {
    /// Returns the waker of the future with this number, and marks the future as woken.
    pub(crate) fn add(&self, index: usize) -> Waker {
        push(&self.state, index);
        Arc::new(Member { index, state: Arc::clone(&self.state) }).into()
    }

    /// Takes the next woken future.
    pub(crate) fn take(&self) -> Option<usize> {
        let mut state = lock(&self.state);
        let next = state.queue.pop_front()?;
        state.queued[next] = false;
        Some(next)
    }

    /// Wakes `task` when a future is woken, or now if one is.
    pub(crate) fn wake_when_any(&self, task: &Waker) {
        let mut state = lock(&self.state);
        if !state.queue.is_empty() {
            task.wake_by_ref();
        } else if !state.task.as_ref().is_some_and(|known| known.will_wake(task)) {
            state.task = Some(task.clone());
        }
    }

    /// Number of woken futures now.
    pub(crate) fn len(&self) -> usize {
        lock(&self.state).queue.len()
    }

    /// Puts a future that is not done yet at the end of the queue.
    pub(crate) fn put_back(&self, index: usize) {
        push(&self.state, index);
    }
}

fn push(state: &Mutex<State>, index: usize) {
    let mut state = lock(state);
    if state.queued.len() <= index {
        state.queued.resize(index + 1, false);
    }
    if std::mem::replace(&mut state.queued[index], true) {
        return;
    }
    state.queue.push_back(index);
    let task = state.task.take();
    drop(state);
    if let Some(task) = task {
        task.wake();
    }
}

fn lock(state: &Mutex<State>) -> MutexGuard<'_, State> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Wake for Member {
    fn wake(self: Arc<Self>) {
        push(&self.state, self.index);
    }

    fn wake_by_ref(self: &Arc<Self>) {
        push(&self.state, self.index);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[derive(Default)]
    struct Counted(AtomicUsize);

    impl Wake for Counted {
        fn wake(self: Arc<Self>) {
            self.0.fetch_add(1, Ordering::Relaxed);
        }
    }

    #[test]
    fn each_woken_future_is_taken_once_and_in_order() {
        let (woken, counted) = (Woken::default(), Arc::new(Counted::default()));
        let task = Waker::from(Arc::clone(&counted));
        let wakers = [woken.add(0), woken.add(1), woken.add(2)];
        let taken = || std::iter::from_fn(|| woken.take()).collect::<Vec<_>>();
        assert_eq!(taken(), [0, 1, 2], "each is polled at first");
        assert_eq!(taken(), Vec::<usize>::new());
        woken.wake_when_any(&task);
        for index in [2, 0, 2, 2] {
            wakers[index].wake_by_ref();
        }
        assert_eq!(taken(), [2, 0]);
        assert_eq!(counted.0.load(Ordering::Relaxed), 1, "the task is woken once for all that follow");
        woken.put_back(1);
        woken.wake_when_any(&task);
        assert_eq!(counted.0.load(Ordering::Relaxed), 2, "at once, because one is woken");
        assert_eq!(taken(), [1]);
    }
}
