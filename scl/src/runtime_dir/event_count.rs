//! Notifies the ends of connections of events in the folder: that it was created again, so that listening ends bind
//! their sockets there, and that files have arrived, so that connecting ends look for their peers.

#![cfg_attr(not(feature = "zeromq"), allow(dead_code, reason = "only that transport has sockets"))]

use crate::sync::lock;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, Weak};
use std::task::{Context, Poll, Waker};

/// Counts how often an event has happened, and wakes the tasks that wait for the next one.
#[derive(Debug, Default)]
pub(super) struct EventCount {
    count: AtomicU64,
    waiting: Mutex<Vec<Weak<Slot>>>,
}

/// The events that one waiter has seen so far; a new waiter has seen none.
#[derive(Debug, Default)]
pub(crate) struct Seen {
    count: u64,
    /// The waker that was put into the slot: comparing with it avoids locking the slot in every poll.
    registered: Option<Waker>,
    slot: Option<Arc<Slot>>,
}

#[derive(Debug, Default)]
struct Slot {
    /// Whether there is a waker.
    armed: AtomicBool,
    waker: Mutex<Option<Waker>>,
}

impl EventCount {
    pub(super) fn poll(&self, seen: &mut Seen, cx: &mut Context<'_>) -> Poll<()> {
        if self.is_news(seen) {
            return Poll::Ready(());
        }
        let slot = seen.slot.get_or_insert_with(|| self.new_slot());
        let is_registered = seen.registered.as_ref().is_some_and(|known| known.will_wake(cx.waker()));
        // Check the slot, too: `mark` may have taken the registered waker for an event that was already seen.
        if is_registered && slot.armed.load(Ordering::SeqCst) {
            return Poll::Pending;
        }
        slot.put(cx.waker());
        seen.registered = Some(cx.waker().clone());
        // Check again: the event may have happened before the waker was in its slot.
        if self.is_news(seen) { Poll::Ready(()) } else { Poll::Pending }
    }

    pub(super) fn mark(&self) {
        self.count.fetch_add(1, Ordering::SeqCst);
        let slots: Vec<_> = lock(&self.waiting).iter().filter_map(Weak::upgrade).collect();
        slots.iter().filter_map(|slot| slot.take()).for_each(Waker::wake);
    }

    fn is_news(&self, seen: &mut Seen) -> bool {
        let count = self.count.load(Ordering::SeqCst);
        let is_news = count != seen.count;
        if is_news {
            seen.count = count;
        }
        is_news
    }

    fn new_slot(&self) -> Arc<Slot> {
        let slot = Arc::default();
        let mut waiting = lock(&self.waiting);
        waiting.retain(|slot| slot.strong_count() > 0);
        waiting.push(Arc::downgrade(&slot));
        slot
    }
}

impl Slot {
    fn put(&self, waker: &Waker) {
        let mut slot = lock(&self.waker);
        *slot = Some(waker.clone());
        self.armed.store(true, Ordering::SeqCst);
    }

    fn take(&self) -> Option<Waker> {
        let mut slot = lock(&self.waker);
        self.armed.store(false, Ordering::SeqCst);
        slot.take()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicUsize;
    use std::task::Wake;

    #[derive(Default)]
    struct Count(AtomicUsize);

    impl Wake for Count {
        fn wake(self: Arc<Self>) {
            self.0.fetch_add(1, Ordering::SeqCst);
        }
    }

    struct Waiter {
        seen: Seen,
        wakes: Arc<Count>,
    }

    impl Waiter {
        fn new() -> Self {
            Self { seen: Seen::default(), wakes: Arc::default() }
        }

        fn is_told(&mut self, events: &EventCount) -> bool {
            let waker = Arc::clone(&self.wakes).into();
            events.poll(&mut self.seen, &mut Context::from_waker(&waker)).is_ready()
        }

        fn wakes(&self) -> usize {
            self.wakes.0.load(Ordering::SeqCst)
        }
    }

    #[test]
    fn every_waiter_is_woken_and_told_once_each_time() {
        let events = EventCount::default();
        let mut waiters = [Waiter::new(), Waiter::new(), Waiter::new()];
        for round in 0..3 {
            for waiter in &mut waiters {
                assert!(!waiter.is_told(&events) && !waiter.is_told(&events));
                assert_eq!(waiter.wakes(), round);
            }
            events.mark();
            for waiter in &mut waiters {
                assert_eq!(waiter.wakes(), round + 1);
                assert!(waiter.is_told(&events) && !waiter.is_told(&events));
            }
        }
    }

    #[test]
    fn a_late_waiter_is_told_at_once() {
        let events = EventCount::default();
        events.mark();
        events.mark();
        let mut waiter = Waiter::new();
        assert!(waiter.is_told(&events) && !waiter.is_told(&events));
    }

    #[test]
    fn a_waiter_that_moves_to_another_task_is_woken_there() {
        let events = EventCount::default();
        let mut waiter = Waiter::new();
        assert!(!waiter.is_told(&events));
        let first = std::mem::take(&mut waiter.wakes);
        assert!(!waiter.is_told(&events));
        events.mark();
        assert_eq!((first.0.load(Ordering::SeqCst), waiter.wakes()), (0, 1));
    }

    #[test]
    fn no_event_is_missed_by_a_waiter_in_another_thread() {
        const ROUNDS: usize = 2000;
        struct Unpark(std::thread::Thread);
        impl Wake for Unpark {
            fn wake(self: Arc<Self>) {
                self.0.unpark();
            }
        }
        let (events, told) = (Arc::new(EventCount::default()), Arc::new(AtomicUsize::new(0)));
        let (waited_for, reported) = (Arc::clone(&events), Arc::clone(&told));
        let waiting = std::thread::spawn(move || {
            let mut seen = Seen::default();
            while seen.count < ROUNDS as u64 {
                // A new task each time, so that it registers while the other thread marks an event.
                let waker = Arc::new(Unpark(std::thread::current())).into();
                while waited_for.poll(&mut seen, &mut Context::from_waker(&waker)).is_pending() {
                    std::thread::park();
                }
                reported.store(seen.count as usize, Ordering::SeqCst);
            }
        });
        for round in 1..=ROUNDS {
            events.mark();
            while told.load(Ordering::SeqCst) < round {
                std::thread::yield_now();
            }
        }
        waiting.join().unwrap();
    }

    #[test]
    fn dropped_waiters_are_forgotten() {
        let events = EventCount::default();
        for _ in 0..1000 {
            assert!(!Waiter::new().is_told(&events));
        }
        assert_eq!(lock(&events.waiting).len(), 1);
    }
}
