//! The calls without async.

use super::{LONG, bytes, on_each_transport, plan};
use scl::RecvTimeoutError;
use scl::untyped::Component;
use std::time::Duration;

#[test]
fn components_of_two_threads_exchange_everything() {
    on_each_transport(|options| {
        let for_sensor = options.clone();
        let sensor = std::thread::spawn(move || {
            let mut sensor = Component::open_blocking_with(&plan("sensor"), for_sensor).unwrap();
            sensor.ready_blocking(LONG).unwrap();
            let mut publisher = sensor.publisher("measurements").unwrap();
            let mut pusher = sensor.pusher("work").unwrap();
            let mut replier = sensor.replier("calibrate").unwrap();
            for number in 0..100 {
                let request = replier.recv_blocking().unwrap();
                assert_eq!(*request, number.to_string());
                publisher.send_blocking(&request).unwrap();
                pusher.send_blocking(&request).unwrap();
                request.reply(&bytes("ok")).unwrap();
            }
            drop((publisher, pusher, replier));
            sensor.close_blocking(LONG).unwrap();
        });
        let mut controller = Component::open_blocking_with(&plan("controller"), options.clone()).unwrap();
        controller.ready_blocking(LONG).unwrap();
        let mut subscriber = controller.subscriber("sensor").unwrap();
        let mut puller = controller.puller("work").unwrap();
        let mut requester = controller.requester("calibrate").unwrap();
        for number in 0..100 {
            let text = number.to_string();
            assert_eq!(requester.call_blocking(&bytes(&text)).unwrap(), "ok");
            assert_eq!(subscriber.recv_timeout(LONG).unwrap(), text);
            assert_eq!(puller.recv_blocking().unwrap(), text);
        }
        sensor.join().unwrap();
        let nothing = subscriber.recv_timeout(Duration::from_millis(1)).unwrap_err();
        assert!(matches!(nothing, RecvTimeoutError::Timeout { .. }), "{nothing}");
    });
}

#[test]
fn nobody_there_is_told_by_name() {
    on_each_transport(|options| {
        let mut controller = Component::open_blocking_with(&plan("controller"), options).unwrap();
        let error = controller.ready_blocking(Duration::from_millis(1)).unwrap_err().to_string();
        for name in ["component `controller`", "`sensor.measurements`", "`sensor.raw`", "`sensor.calibrate`"] {
            assert!(error.contains(name), "{error}");
        }
        // Nobody waits for the peers of a gate that is gone.
        for gate in ["sensor", "raw"] {
            drop(controller.subscriber(gate).unwrap());
        }
        let error = controller.ready_blocking(Duration::from_millis(1)).unwrap_err().to_string();
        assert!(error.contains("`sensor.calibrate`") && !error.contains("measurements"), "{error}");
        drop(controller.gate("calibrate").unwrap());
        controller.ready_blocking(LONG).unwrap();
    });
}
