//! Calls that wait in other threads end when the component is to be closed.

use super::{LONG, bytes, on_each_transport, plan};
use scl::untyped::Component;
use scl::{BlockingError, OpenOptions, ReceivingGate};
use std::error::Error;
use std::pin::pin;
use std::sync::Arc;
use std::task::{Context, Poll, Wake, Waker};
use std::thread::{self, JoinHandle};
use std::time::Duration;

type Ended = Box<dyn Error + Send + Sync>;

fn open(component: &str, options: &OpenOptions) -> Component {
    Component::open_blocking_with(&plan(component), options.clone()).unwrap()
}

fn waiting(call: impl FnOnce() -> Ended + Send + 'static) -> JoinHandle<Ended> {
    thread::spawn(call)
}

#[track_caller]
fn assert_closed(error: &(dyn Error + 'static)) {
    let mut cause = Some(error);
    while let Some(error) = cause {
        if error.downcast_ref::<BlockingError>() == Some(&BlockingError::Closed) {
            return;
        }
        cause = error.source();
    }
    panic!("{error:?}");
}

/// Every call that can wait, each in a thread of its own, at gates whose peers never come.
fn every_call(controller: &mut Component, sensor: &mut Component) -> Vec<JoinHandle<Ended>> {
    let mut sub = controller.subscriber("sensor").unwrap();
    let mut raw = controller.subscriber("raw").unwrap();
    let mut pull = controller.puller("work").unwrap();
    let mut req = controller.requester("calibrate").unwrap();
    let mut rep = sensor.replier("calibrate").unwrap();
    let mut publishes = sensor.publisher("measurements").unwrap();
    while publishes.try_send(&bytes("[]")).is_ok() {}
    vec![
        waiting(move || sub.recv_blocking().unwrap_err().into()),
        waiting(move || raw.recv_timeout(LONG).unwrap_err().into()),
        waiting(move || pull.recv_blocking().unwrap_err().into()),
        waiting(move || req.call_timeout(&bytes("7"), LONG).unwrap_err().into()),
        waiting(move || rep.recv_timeout(LONG).unwrap_err().into()),
        waiting(move || publishes.send_blocking(&bytes("[]")).unwrap_err().into()),
    ]
}

#[test]
fn every_waiting_call_ends() {
    for round in 0..50 {
        on_each_transport(|options| {
            // Nobody else opens these two: the folders differ.
            let other = tempfile::tempdir().unwrap();
            let mut controller = open("controller", &options);
            let mut sensor = open("sensor", &OpenOptions::new().runtime_dir(other.path()));
            let calls = every_call(&mut controller, &mut sensor);
            if round % 2 == 1 {
                thread::sleep(Duration::from_micros(100 * round));
            }
            controller.closer().end_calls();
            sensor.closer().end_calls();
            for call in calls {
                assert_closed(&*call.join().unwrap());
            }
            controller.close_blocking(LONG).unwrap();
            drop(sensor);
            // The gates went with the threads.
            open("controller", &options).close_blocking(LONG).unwrap();
        });
    }
}

#[test]
fn waits_for_the_whole_component_end() {
    on_each_transport(|options| {
        let mut controller = open("controller", &options);
        let (mut sub, mut pull) = (controller.subscriber("sensor").unwrap(), controller.puller("work").unwrap());
        let closer = controller.closer();
        thread::scope(|threads| {
            let ready = threads.spawn(|| controller.ready_blocking(LONG).unwrap_err());
            let any = threads.spawn(|| controller.wait_any_blocking(&mut [&mut sub, &mut pull], LONG).unwrap_err());
            closer.end_calls();
            assert_closed(ready.join().unwrap().inner());
            assert_closed(&any.join().unwrap());
        });
        // Later calls are refused.
        assert_closed(&sub.try_recv().unwrap_err());
        assert_closed(&pull.recv_timeout(LONG).unwrap_err());
    });
}

#[test]
fn what_was_sent_before_is_still_handed_over() {
    on_each_transport(|options| {
        let (mut sensor, mut controller) = (open("sensor", &options), open("controller", &options));
        let mut receives = controller.subscriber("sensor").unwrap();
        let mut sends = sensor.publisher("measurements").unwrap();
        sensor.ready_blocking(LONG).unwrap();
        let receiving = thread::spawn(move || {
            (0..1000).for_each(|number| assert_eq!(receives.recv_timeout(LONG).unwrap(), number.to_string()));
        });
        for number in 0..1000 {
            sends.send_blocking(&bytes(&number.to_string())).unwrap();
        }
        sensor.closer().end_calls();
        assert_closed(&sends.send_blocking(&bytes("refused")).unwrap_err());
        drop(sends);
        sensor.close_blocking(LONG).unwrap();
        receiving.join().unwrap();
    });
}

#[test]
fn futures_end_and_their_wakers_are_woken() {
    struct Woken(std::sync::atomic::AtomicBool);
    impl Wake for Woken {
        fn wake(self: Arc<Self>) {
            self.0.store(true, std::sync::atomic::Ordering::SeqCst);
        }
    }
    on_each_transport(|options| {
        let mut controller = open("controller", &options);
        let mut sub = controller.subscriber("sensor").unwrap();
        let mut pull = controller.puller("work").unwrap();
        let mut req = controller.requester("calibrate").unwrap();
        let wakers: Vec<_> = (0..3).map(|_| Arc::new(Woken(false.into()))).collect();
        let contexts: Vec<Waker> = wakers.iter().map(|woken| Arc::clone(woken).into()).collect();
        let question = bytes("7");
        let (mut receive, mut call) = (pin!(sub.recv()), pin!(req.call(&question)));
        // `call` waits with a timer, so it is polled inside the runtime of the component.
        assert!(receive.as_mut().poll(&mut Context::from_waker(&contexts[0])).is_pending());
        assert!(call.as_mut().poll(&mut Context::from_waker(&contexts[1])).is_pending());
        assert!(pull.poll_ready(&mut Context::from_waker(&contexts[2])).is_pending());
        controller.closer().end_calls();
        assert!(wakers.iter().all(|woken| woken.0.load(std::sync::atomic::Ordering::SeqCst)));
        let Poll::Ready(Err(error)) = receive.poll(&mut Context::from_waker(&contexts[0])) else { panic!("pending") };
        assert_closed(&error);
        let Poll::Ready(Err(error)) = call.poll(&mut Context::from_waker(&contexts[1])) else { panic!("pending") };
        assert_closed(&error);
        let Poll::Ready(Err(error)) = pull.poll_ready(&mut Context::from_waker(&contexts[2])) else {
            panic!("pending")
        };
        assert_closed(&error);
    });
}
