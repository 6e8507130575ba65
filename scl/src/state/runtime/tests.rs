//! Which calls drive the runtime of a component without async.

use super::*;
use std::sync::Barrier;

#[test]
fn calls_that_wait_for_nothing_give_the_runtime_its_turns() {
    let owned = OwnedRuntime::start("sensor").unwrap();
    // As if the idle thread never got around to it.
    let _held = lock(&owned.shared.rest);
    let ran = Arc::new(AtomicBool::new(false));
    let task = Arc::clone(&ran);
    owned.shared.runtime().spawn(async move {
        tokio::task::yield_now().await;
        task.store(true, Ordering::SeqCst);
    });
    let call_until_it_ran = || {
        (0..10_000_000).any(|_| {
            owned.take_turn();
            ran.load(Ordering::SeqCst)
        })
    };
    assert!(call_until_it_ran());
}

#[test]
fn it_can_be_started_inside_another_runtime() {
    let outer = Builder::new_current_thread().build().unwrap();
    assert!(outer.block_on(async { OwnedRuntime::start("sensor").is_ok() }));
}

#[test]
fn only_a_call_that_drives_the_runtime_gives_it_a_turn() {
    let owned = OwnedRuntime::start("sensor").unwrap();
    // The idle thread drives the runtime never or until the first call.
    let _held = lock(&owned.shared.rest);
    let make_due = || {
        owned.shared.last_turn.set(Duration::ZERO);
        while !owned.shared.is_turn_due() {
            std::hint::spin_loop();
        }
    };
    let (stands, released) = (Barrier::new(2), Barrier::new(2));
    thread::scope(|threads| {
        // As a call does that waits for its own socket.
        threads.spawn(|| {
            owned.block_on(poll_fn(|cx| {
                if !owned.shared.is_driven_with(cx) {
                    cx.waker().wake_by_ref();
                    return Poll::Pending;
                }
                stands.wait();
                Poll::Ready(released.wait())
            }))
        });
        stands.wait();
        make_due();
        owned.take_turn();
        owned.block_on(tokio::task::yield_now()).unwrap();
        let is_due = owned.shared.is_turn_due();
        released.wait();
        assert!(is_due, "another thread holds the runtime");
    });
    let gave_a_turn = |call: &dyn Fn()| {
        make_due();
        let before = owned.shared.last_turn.get();
        call();
        owned.shared.last_turn.get() > before
    };
    assert!(gave_a_turn(&|| owned.take_turn()));
    assert!(gave_a_turn(&|| owned.block_on(tokio::task::yield_now()).unwrap()));
}

#[test]
fn several_threads_wait_at_the_same_time() {
    let owned = OwnedRuntime::start("sensor").unwrap();
    let (first, second) = (Notify::new(), Notify::new());
    thread::scope(|threads| {
        threads.spawn(|| {
            owned.block_on(first.notified()).unwrap();
            second.notify_one();
        });
        threads.spawn(|| owned.block_on(second.notified()).unwrap());
        owned.block_on(async { first.notify_one() }).unwrap();
    });
}
