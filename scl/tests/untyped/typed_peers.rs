//! A typed component on one side, an untyped one on the other, in one process.

use super::{Controller, LONG, Sensor, bytes, on_each_transport_async, plan};
use scl::untyped::Component;

#[test]
fn an_untyped_sensor_serves_a_typed_controller() {
    on_each_transport_async(|options| async {
        let mut sensor = Component::open_with(&plan("sensor"), options.clone()).await.unwrap();
        let mut controller = Controller::open_with(options).await.unwrap();
        sensor.ready(LONG).await.unwrap();
        controller.ready(LONG).await.unwrap();
        let mut publisher = sensor.publisher("measurements").unwrap();
        publisher.send(&bytes("[1.5,2.5]")).await.unwrap();
        assert_eq!(controller.sensor.recv().await.unwrap(), [1.5, 2.5]);
        publisher.send(&bytes("no JSON")).await.unwrap();
        publisher.send(&bytes("[3.5]")).await.unwrap();
        assert_eq!(controller.sensor.recv().await.unwrap(), [3.5], "the next that can be decoded");
        sensor.pusher("work").unwrap().send(&bytes("[7.0]")).await.unwrap();
        assert_eq!(controller.work.recv().await.unwrap(), [7.0]);
        let mut replier = sensor.replier("calibrate").unwrap();
        let (answer, ()) = tokio::join!(controller.calibrate.call(&42), async {
            let request = replier.recv().await.unwrap();
            assert_eq!(*request, "42");
            request.reply(&bytes("\"done\"")).unwrap();
        });
        assert_eq!(answer.unwrap(), "done");
    });
}

#[test]
fn a_typed_sensor_serves_an_untyped_controller() {
    on_each_transport_async(|options| async {
        let mut sensor = Sensor::open_with(options.clone()).await.unwrap();
        let mut controller = Component::open_with(&plan("controller"), options).await.unwrap();
        sensor.ready(LONG).await.unwrap();
        controller.ready(LONG).await.unwrap();
        sensor.measurements.send(&vec![1.5, 2.5]).await.unwrap();
        assert_eq!(controller.subscriber("sensor").unwrap().recv().await.unwrap(), "[1.5,2.5]");
        sensor.raw.send(&bytes("bytes")).await.unwrap();
        assert_eq!(controller.subscriber("raw").unwrap().recv().await.unwrap(), "bytes");
        sensor.work.send(&vec![7.0]).await.unwrap();
        assert_eq!(controller.puller("work").unwrap().recv().await.unwrap(), "[7.0]");
        let mut requester = controller.requester("calibrate").unwrap();
        let question = bytes("42");
        let (answer, ()) = tokio::join!(requester.call(&question), async {
            let request = sensor.calibrate.recv().await.unwrap();
            assert_eq!(*request, 42);
            request.reply(&"done".to_owned()).unwrap();
        });
        assert_eq!(answer.unwrap(), "\"done\"");
    });
}
