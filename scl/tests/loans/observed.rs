//! Observers and plain programs see what was written in place.

use super::{Camera, Detector, LONG, on_each_transport_async, send};
use scl::runtime_dir::RuntimeDir;
use scl::tap::{Observer, TapEvent};
use scl::{OpenOptions, TransportKind};
use zerocopy::IntoBytes;

#[test]
fn an_observer_sees_loans() {
    for kind in [TransportKind::Ipc, TransportKind::Tcp] {
        let root = tempfile::tempdir().unwrap();
        let options = OpenOptions::new().runtime_dir(root.path()).transport_kind(kind);
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(async {
            let variable = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| root.path().into());
            let dir = RuntimeDir::locate(&variable).unwrap().system("loans").unwrap();
            let plan = crate::untyped::system_plan("loans.yaml");
            let tap = plan.component("camera").unwrap().gate("images").unwrap().tap.clone().unwrap();
            let mut observer = Observer::open(&dir, &tap);
            let mut camera = Camera::open_with(options.clone()).await.unwrap();
            let _detector = Detector::open_with(options).await.unwrap();
            camera.ready(LONG).await.unwrap();
            assert_eq!(observer.next().await, TapEvent::Connected);
            for number in 0..2 {
                send(&mut camera, number).await;
                let TapEvent::Observed(seen) = observer.next().await else { panic!("no message at the tap") };
                assert_eq!(seen.payload, super::Image::new(number).as_bytes());
            }
        });
    }
}

#[test]
fn nobody_observes_what_was_dropped() {
    on_each_transport_async(async |options| {
        let mut camera = Camera::open_with(options).await.unwrap();
        drop(camera.images.loan().unwrap());
        assert_eq!(camera.images.stats().dropped_for_observers, 0);
        assert_eq!(camera.images.peer_stats()[0].published, 0);
    });
}
