//! Calls with a time limit: what timed out has happened not at all.

use super::{LONG, bytes, on_each_transport, plan};
use scl::untyped::Component;
use scl::{CallError, OpenOptions, RecvTimeoutError, SendTimeoutError};
use std::time::Duration;

const SHORT: Duration = Duration::from_millis(20);

fn open(options: OpenOptions) -> (Component, Component) {
    let sensor = Component::open_blocking_with(&plan("sensor"), options.clone()).unwrap();
    let controller = Component::open_blocking_with(&plan("controller"), options).unwrap();
    sensor.ready_blocking(LONG).unwrap();
    controller.ready_blocking(LONG).unwrap();
    (sensor, controller)
}

#[test]
fn a_send_that_timed_out_sent_nothing() {
    on_each_transport(|options| {
        let (mut sensor, mut controller) = open(options);
        let mut sends = sensor.publisher("measurements").unwrap();
        let mut receives = controller.subscriber("sensor").unwrap();
        let mut accepted = 0_u64;
        let timed_out = loop {
            match sends.send_timeout(&bytes(&accepted.to_string()), SHORT) {
                Ok(()) if accepted == 100_000 => panic!("the queue is never full"),
                Ok(()) => accepted += 1,
                Err(error) => break error,
            }
        };
        assert!(matches!(timed_out, SendTimeoutError::Timeout { waited: SHORT, .. }), "{timed_out:?}");
        let text = "gate `sensor.measurements` did not send the message within 20ms: \
                    the queue of `controller.sensor` is full";
        assert_eq!(timed_out.to_string(), text);
        // Only looks.
        assert!(sends.send_timeout(&bytes("lost"), Duration::ZERO).is_err());
        for number in 0..accepted {
            assert_eq!(receives.recv_timeout(LONG).unwrap(), number.to_string());
        }
        sends.send_timeout(&bytes("next"), LONG).unwrap();
        assert_eq!(receives.recv_timeout(LONG).unwrap(), "next");
        assert!(receives.recv_timeout(SHORT).is_err());
    });
}

#[test]
fn a_send_with_a_time_limit_waits_for_room() {
    on_each_transport(|options| {
        let (mut sensor, mut controller) = open(options);
        let mut sends = sensor.publisher("measurements").unwrap();
        let mut receives = controller.subscriber("sensor").unwrap();
        while sends.try_send(&bytes("[]")).is_ok() {}
        let receiving = std::thread::spawn(move || while receives.recv_timeout(LONG).unwrap() != "last" {});
        sends.send_timeout(&bytes("last"), LONG).unwrap();
        receiving.join().unwrap();
    });
}

#[test]
fn the_reply_to_a_call_that_timed_out_is_never_taken() {
    on_each_transport(|options| {
        let (mut sensor, mut controller) = open(options);
        let mut asks = controller.requester("calibrate").unwrap();
        let mut answers = sensor.replier("calibrate").unwrap();
        let timed_out = asks.call_timeout(&bytes("1"), SHORT).unwrap_err();
        assert!(matches!(timed_out, CallError::Timeout { .. }), "{timed_out:?}");
        assert_eq!(asks.timeout(), LONG, "the gate's own timeout did not count");
        let late = answers.recv_timeout(LONG).unwrap();
        assert_eq!(*late, "1");
        let asking = std::thread::spawn(move || asks.call_timeout(&bytes("2"), LONG).unwrap());
        let second = answers.recv_timeout(LONG).unwrap();
        assert_eq!(*second, "2");
        late.reply(&bytes("late")).unwrap();
        second.reply(&bytes("in time")).unwrap();
        assert_eq!(asking.join().unwrap(), "in time");
    });
}

#[test]
fn a_replier_waits_for_a_limited_time() {
    on_each_transport(|options| {
        let (mut sensor, _controller) = open(options);
        let mut answers = sensor.replier("calibrate").unwrap();
        let timed_out = answers.recv_timeout(SHORT).unwrap_err();
        assert!(matches!(timed_out, RecvTimeoutError::Timeout { waited: SHORT, .. }), "{timed_out:?}");
        let text = "gate `sensor.calibrate` received nothing from `controller.calibrate` within 20ms";
        assert_eq!(timed_out.to_string(), text);
    });
}
