//! Messages that are written and read in place: over each transport, with every policy, and without copies where memory
//! is lent.
#![allow(clippy::unwrap_used)]

mod accounts;
mod errors;
mod observed;
mod without_copies;

use scl::transport::memory::Memory;
use scl::{OpenOptions, TransportKind};
use std::time::Duration;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

scl::topology!("loans.yaml");

/// Far longer than anything takes.
const LONG: Duration = Duration::from_secs(300);

#[derive(Debug, FromBytes, IntoBytes, KnownLayout, Immutable)]
#[repr(C)]
struct Image {
    number: u64,
    pixels: [u8; 64_000],
}

impl Image {
    /// Writes all of it.
    fn fill(&mut self, number: u64) {
        self.number = number;
        self.pixels.fill(number as u8);
    }

    /// The number of an image that is whole.
    fn number(&self) -> u64 {
        assert!(self.pixels.iter().all(|&pixel| pixel == self.number as u8), "image {} is damaged", self.number);
        self.number
    }

    fn address(&self) -> usize {
        std::ptr::from_ref(self).addr()
    }
}

/// Runs a test in memory, on Unix sockets and on TCP. All its components are to be opened with the same options.
fn on_each_transport(test: impl Fn(OpenOptions)) {
    test(OpenOptions::new().transport(Memory::new()));
    for kind in [TransportKind::Ipc, TransportKind::Tcp] {
        let folder = tempfile::tempdir().unwrap();
        test(OpenOptions::new().runtime_dir(folder.path()).transport_kind(kind));
    }
}

/// The same for async code.
fn on_each_transport_async<F: Future<Output = ()>>(test: impl Fn(OpenOptions) -> F) {
    on_each_transport(|options| {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(test(options));
    });
}

async fn send(camera: &mut Camera, number: u64) {
    let mut image = camera.images.loan().unwrap();
    image.fill(number);
    image.send().await.unwrap();
}

#[test]
fn every_call_carries_whole_messages() {
    on_each_transport_async(async |options| {
        let mut camera = Camera::open_with(options.clone()).await.unwrap();
        // From the heap, before a peer is connected.
        send(&mut camera, 1).await;
        let mut detector = Detector::open_with(options).await.unwrap();
        camera.ready(LONG).await.unwrap();
        send(&mut camera, 2).await;
        assert_eq!(detector.images.recv_view().await.unwrap().number(), 1);
        assert_eq!(detector.images.recv().await.unwrap().number(), 2, "a loan is an ordinary message to other calls");
        camera.images.send(&Image::new(3)).await.unwrap();
        let view = detector.images.recv_view().await.unwrap();
        send(&mut camera, 4).await;
        assert_eq!(detector.images.recv_view().await.unwrap().number(), 4);
        assert_eq!(view.number(), 3, "a view stays what it was");

        let mut job = camera.jobs.loan().unwrap();
        job.fill(5);
        job.send().await.unwrap();
        assert_eq!(detector.jobs.recv_view().await.unwrap().number(), 5);
        for length in [0, 1, 512, 513, 1 << 20] {
            let mut bytes = camera.bytes.loan_bytes(length).unwrap();
            bytes.fill(7);
            bytes.send().await.unwrap();
            assert_eq!(detector.bytes.recv().await.unwrap(), vec![7; length]);
        }
    });
}

#[test]
fn every_call_without_async_carries_whole_messages() {
    on_each_transport(|options| {
        let mut camera = Camera::open_blocking_with(options.clone()).unwrap();
        let mut detector = Detector::open_blocking_with(options).unwrap();
        camera.ready_blocking(LONG).unwrap();
        for number in 0..20 {
            let mut image = camera.images.loan().unwrap();
            image.fill(number);
            match number % 3 {
                0 => image.send_blocking().unwrap(),
                1 => image.send_timeout(LONG).unwrap(),
                _ => image.try_send().unwrap(),
            }
            if number % 2 == 0 {
                assert_eq!(detector.images.recv_view_blocking().unwrap().number(), number);
            } else {
                let view = std::iter::repeat_with(|| detector.images.try_recv_view().unwrap()).find_map(|view| view);
                assert_eq!(view.unwrap().number(), number);
            }
        }
    });
}

/// The message is given back to nobody, and its memory can be lent again.
#[test]
fn a_message_that_is_dropped_is_sent_to_nobody() {
    on_each_transport_async(async |options| {
        let mut camera = Camera::open_with(options.clone()).await.unwrap();
        let mut detector = Detector::open_with(options).await.unwrap();
        camera.ready(LONG).await.unwrap();
        for _ in 0..1000 {
            let mut image = camera.images.loan().unwrap();
            image.number = 1;
        }
        send(&mut camera, 2).await;
        assert_eq!(detector.images.recv_view().await.unwrap().number(), 2);
        assert_eq!(camera.images.peer_stats()[0].published, 1);
    });
}

impl Image {
    fn new(number: u64) -> Self {
        let mut image = Image { number: 0, pixels: [0; 64_000] };
        image.fill(number);
        image
    }
}
