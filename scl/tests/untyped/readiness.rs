//! Waiting for several gates, and the descriptor for event loops.

use super::{LONG, bytes, on_each_transport, plan};
use rustix::event::{PollFd, PollFlags, poll};
use scl::untyped::{Component, Readiness, WaitError};
use scl::{OpenOptions, ReceivingGate};
use std::pin::pin;
use std::sync::mpsc;
use std::task::{Context, Poll};
use std::thread;
use std::time::Duration;

fn open(options: OpenOptions) -> (Component, Component) {
    let sensor = Component::open_blocking_with(&plan("sensor"), options.clone()).unwrap();
    let controller = Component::open_blocking_with(&plan("controller"), options).unwrap();
    sensor.ready_blocking(LONG).unwrap();
    controller.ready_blocking(LONG).unwrap();
    (sensor, controller)
}

fn is_readable_within(readiness: &Readiness, time: Duration) -> bool {
    let time = time.try_into().unwrap();
    poll(&mut [PollFd::new(readiness, PollFlags::IN)], Some(&time)).unwrap() == 1
}

fn is_readable(readiness: &Readiness) -> bool {
    is_readable_within(readiness, Duration::ZERO)
}

#[track_caller]
fn wait(readiness: &Readiness) {
    assert!(is_readable_within(readiness, LONG), "a wake-up was lost");
}

#[test]
fn the_gates_that_have_something_are_told() {
    on_each_transport(|options| {
        let (mut sensor, mut controller) = open(options);
        let (mut sub, mut pull) = (controller.subscriber("sensor").unwrap(), controller.puller("work").unwrap());
        let mut req = controller.requester("calibrate").unwrap();
        let mut rep = sensor.replier("calibrate").unwrap();
        let nothing = controller.wait_any_blocking(&mut [&mut sub, &mut pull], Duration::from_millis(1)).unwrap_err();
        assert!(matches!(nothing, WaitError::Timeout { .. }), "{nothing:?}");
        assert_eq!(
            nothing.to_string(),
            "component `controller` received nothing at `controller.sensor` or `controller.work` within 1ms"
        );
        sensor.pusher("work").unwrap().send_blocking(&bytes("1")).unwrap();
        for _ in 0..3 {
            let ready = controller.wait_any_blocking(&mut [&mut sub, &mut pull], LONG).unwrap();
            assert_eq!(ready, [1], "waiting takes nothing");
        }
        sensor.publisher("measurements").unwrap().send_blocking(&bytes("2")).unwrap();
        assert_eq!(controller.wait_any_blocking(&mut [&mut sub], LONG).unwrap(), [0]);
        assert_eq!(controller.wait_any_blocking(&mut [&mut sub, &mut pull], LONG).unwrap(), [0, 1]);
        assert_eq!(sub.try_recv().unwrap().unwrap(), "2");
        assert_eq!(pull.try_recv().unwrap().unwrap(), "1");
        assert_eq!((sub.try_recv().unwrap(), pull.try_recv().unwrap()), (None, None));
        let asking = thread::spawn(move || req.call_blocking(&bytes("7")).unwrap());
        assert_eq!(sensor.wait_any_blocking(&mut [&mut rep], LONG).unwrap(), [0]);
        assert_eq!(sensor.wait_any_blocking(&mut [&mut rep], LONG).unwrap(), [0]);
        rep.try_recv().unwrap().unwrap().reply(&bytes("8")).unwrap();
        assert_eq!(asking.join().unwrap(), "8");
        assert!(rep.try_recv().unwrap().is_none());
    });
}

#[test]
fn the_descriptor_is_readable_as_long_as_a_gate_has_something() {
    on_each_transport(|options| {
        let (mut sensor, mut controller) = open(options);
        let (mut sub, mut pull) = (controller.subscriber("sensor").unwrap(), controller.puller("work").unwrap());
        let (mut push, mut publish) = (sensor.pusher("work").unwrap(), sensor.publisher("measurements").unwrap());
        let readiness = controller.readiness().unwrap();
        assert!(!is_readable(&readiness));
        for round in 0..20 {
            for number in 0..3 {
                push.send_blocking(&bytes(&number.to_string())).unwrap();
            }
            publish.send_blocking(&bytes("published")).unwrap();
            for number in 0..3 {
                wait(&readiness);
                let mut poll_ready = || pull.poll_ready(&mut Context::from_waker(&readiness.waker()));
                while poll_ready().is_pending() {
                    thread::yield_now();
                }
                assert_eq!(pull.try_recv().unwrap().unwrap(), number.to_string(), "round {round}");
            }
            wait(&readiness);
            while sub.try_recv().unwrap().is_none() {}
            // Wakers of the polls above.
            readiness.acknowledge();
            assert!(!is_readable(&readiness), "round {round}");
        }
    });
}

/// More messages than the gate's queue takes in: the others wait in the connection and in the publisher.
#[test]
fn the_descriptor_stays_readable_while_messages_wait_outside_the_queue() {
    on_each_transport(|options| {
        let (mut sensor, mut controller) = open(options);
        let (mut sub, mut publish) =
            (controller.subscriber("sensor").unwrap(), sensor.publisher("measurements").unwrap());
        let readiness = controller.readiness().unwrap();
        let mut sent = 0;
        while publish.try_send(&bytes(&i32::to_string(&sent))).is_ok() {
            sent += 1;
        }
        for number in 0..sent {
            wait(&readiness);
            assert_eq!(sub.try_recv().unwrap().unwrap(), number.to_string());
        }
        assert!(!is_readable(&readiness));
    });
}

#[test]
fn requests_make_the_descriptor_readable() {
    on_each_transport(|options| {
        let (mut sensor, mut controller) = open(options);
        let mut rep = sensor.replier("calibrate").unwrap();
        let mut req = controller.requester("calibrate").unwrap();
        let readiness = sensor.readiness().unwrap();
        let asking = thread::spawn(move || {
            (0..100).for_each(|number: u32| {
                let number = bytes(&number.to_string());
                assert_eq!(req.call_blocking(&number).unwrap(), number);
            });
        });
        for _ in 0..100 {
            wait(&readiness);
            let request = rep.try_recv().unwrap().expect("a gate that is ready has a request");
            assert!(!is_readable(&readiness));
            let echo = request.message().clone();
            request.reply(&echo).unwrap();
        }
        asking.join().unwrap();
    });
}

#[test]
fn a_replier_that_is_gone_has_no_request() {
    on_each_transport(|options| {
        let (mut sensor, mut controller) = open(options);
        let rep = sensor.replier("calibrate").unwrap();
        let mut req = controller.requester("calibrate").unwrap();
        let readiness = sensor.readiness().unwrap();
        let asking = thread::spawn(move || req.call_timeout(&bytes("7"), LONG));
        wait(&readiness);
        drop(rep);
        assert!(!is_readable(&readiness));
        controller.closer().end_calls();
        asking.join().unwrap().unwrap_err();
    });
}

#[test]
fn only_chosen_gates_count_and_none_that_is_gone() {
    on_each_transport(|options| {
        let (mut sensor, mut controller) = open(options);
        let pull = controller.puller("work").unwrap();
        let (all, none) = (controller.readiness().unwrap(), controller.readiness_of(&[]).unwrap());
        let (work, other) =
            (controller.readiness_of(&["work"]).unwrap(), controller.readiness_of(&["sensor", "calibrate"]).unwrap());
        sensor.pusher("work").unwrap().send_blocking(&bytes("1")).unwrap();
        wait(&all);
        wait(&work);
        // One that is opened later is told what is there.
        assert!(is_readable(&controller.readiness().unwrap()));
        assert!(!is_readable(&none) && !is_readable(&other));
        drop(pull);
        assert!(!is_readable(&all) && !is_readable(&work));
        let error = controller.readiness_of(&["wrk"]).unwrap_err();
        assert_eq!(error.to_string(), "component `controller` has no gate `wrk`; did you mean `work`?");
    });
}

/// Each message is sent only after the one before was taken, so a lost wake-up leaves both sides waiting.
#[test]
fn no_wake_up_is_lost_by_a_program_that_waits_for_the_descriptor() {
    on_each_transport(|options| {
        let (mut sensor, mut controller) = open(options);
        let (mut push, mut pull) = (sensor.pusher("work").unwrap(), controller.puller("work").unwrap());
        let readiness = controller.readiness().unwrap();
        let (taken, may_send) = mpsc::channel();
        let sending = thread::spawn(move || {
            for number in may_send {
                push.send_blocking(&bytes(&i32::to_string(&number))).unwrap();
            }
        });
        for number in 0..3000 {
            taken.send(number).unwrap();
            let received = loop {
                match pull.try_recv().unwrap() {
                    Some(message) => break message,
                    None => wait(&readiness),
                }
            };
            assert_eq!(received, number.to_string());
        }
        drop(taken);
        sending.join().unwrap();
    });
}

#[test]
fn no_wake_up_is_lost_by_a_program_that_polls_futures() {
    on_each_transport(|options| {
        let (mut sensor, mut controller) = open(options);
        let (mut push, mut pull) = (sensor.pusher("work").unwrap(), controller.puller("work").unwrap());
        let (mut req, mut rep) = (controller.requester("calibrate").unwrap(), sensor.replier("calibrate").unwrap());
        let readiness = controller.readiness_of(&[]).unwrap();
        let serving = thread::spawn(move || {
            for number in 0..1500 {
                let request = rep.recv_timeout(LONG).unwrap();
                push.send_blocking(&bytes(&i32::to_string(&number))).unwrap();
                let echo = request.message().clone();
                request.reply(&echo).unwrap();
            }
        });
        for number in 0..1500 {
            let number = bytes(&i32::to_string(&number));
            let mut call = pin!(req.call(&number));
            let mut receive = pin!(pull.recv());
            let (mut replied, mut received) = (None, None);
            while replied.is_none() || received.is_none() {
                readiness.acknowledge();
                let waker = readiness.waker();
                let cx = &mut Context::from_waker(&waker);
                if replied.is_none()
                    && let Poll::Ready(reply) = call.as_mut().poll(cx)
                {
                    replied = Some(reply.unwrap());
                }
                if received.is_none()
                    && let Poll::Ready(message) = receive.as_mut().poll(cx)
                {
                    received = Some(message.unwrap());
                }
                if replied.is_none() || received.is_none() {
                    wait(&readiness);
                }
            }
            assert_eq!([replied, received], [Some(number.clone()), Some(number.clone())]);
        }
        serving.join().unwrap();
    });
}

/// Blocking calls at other gates share the runtime with the thread that works for the descriptor.
#[test]
fn blocking_calls_and_a_descriptor_work_side_by_side() {
    on_each_transport(|options| {
        let (mut sensor, mut controller) = open(options);
        let (mut push, mut pull) = (sensor.pusher("work").unwrap(), controller.puller("work").unwrap());
        let (mut req, mut rep) = (controller.requester("calibrate").unwrap(), sensor.replier("calibrate").unwrap());
        let readiness = controller.readiness_of(&["work"]).unwrap();
        let serving = thread::spawn(move || {
            while let Ok(request) = rep.recv_blocking() {
                push.send_blocking(&request).unwrap();
                let echo = request.message().clone();
                if request.reply(&echo).is_err() || echo == "299" {
                    return;
                }
            }
        });
        let asking = thread::spawn(move || {
            (0..300).for_each(|number: u32| drop(req.call_blocking(&bytes(&number.to_string())).unwrap()));
        });
        let mut last = None;
        while last.as_deref() != Some(&b"299"[..]) {
            wait(&readiness);
            last = pull.try_recv().unwrap().or(last);
        }
        asking.join().unwrap();
        serving.join().unwrap();
    });
}

#[test]
fn a_peer_that_comes_later_makes_the_descriptor_readable() {
    on_each_transport(|options| {
        let mut controller = Component::open_blocking_with(&plan("controller"), options.clone()).unwrap();
        let mut pull = controller.puller("work").unwrap();
        let readiness = controller.readiness().unwrap();
        let mut sensor = Component::open_blocking_with(&plan("sensor"), options).unwrap();
        let mut push = sensor.pusher("work").unwrap();
        push.send_blocking(&bytes("1")).unwrap();
        wait(&readiness);
        assert_eq!(pull.try_recv().unwrap().unwrap(), "1");
    });
}
