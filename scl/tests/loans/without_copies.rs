//! The address of a message is the same at both ends, where the transport lends memory or takes over that of the heap.

use super::{Camera, Detector, LONG, Viewer, send};
use scl::OpenOptions;
use scl::transport::memory::Memory;

async fn open() -> (OpenOptions, Camera, Detector) {
    let options = OpenOptions::new().transport(Memory::new());
    let camera = Camera::open_with(options.clone()).await.unwrap();
    let detector = Detector::open_with(options.clone()).await.unwrap();
    camera.ready(LONG).await.unwrap();
    (options, camera, detector)
}

#[tokio::test]
async fn a_message_is_read_where_it_was_written() {
    let (_, mut camera, mut detector) = open().await;
    let mut image = camera.images.loan().unwrap();
    image.fill(1);
    let written_at = image.address();
    image.send().await.unwrap();
    assert_eq!(detector.images.recv_view().await.unwrap().address(), written_at);

    let mut job = camera.jobs.loan().unwrap();
    job.fill(2);
    let written_at = job.address();
    job.send().await.unwrap();
    assert_eq!(detector.jobs.recv_view().await.unwrap().address(), written_at);

    let bytes = camera.bytes.loan_bytes(1000).unwrap();
    let written_at = bytes.as_ptr();
    bytes.send().await.unwrap();
    assert_eq!(detector.bytes.recv().await.unwrap().as_ptr(), written_at);
}

#[tokio::test]
async fn memory_of_the_heap_is_not_copied_either() {
    let options = OpenOptions::new().transport(Memory::new());
    let mut camera = Camera::open_with(options.clone()).await.unwrap();
    let mut image = camera.images.loan().unwrap();
    image.fill(1);
    let written_at = image.address();
    image.send().await.unwrap();
    let mut detector = Detector::open_with(options.clone()).await.unwrap();
    let mut viewer = Viewer::open_with(options).await.unwrap();
    assert_eq!(detector.images.recv_view().await.unwrap().address(), written_at);
    assert_eq!(viewer.images.recv_view().await.unwrap().address(), written_at, "shared by all peers");
}

#[tokio::test]
async fn only_the_peer_that_lent_the_memory_gets_it() {
    let (options, mut camera, mut detector) = open().await;
    let mut viewer = Viewer::open_with(options).await.unwrap();
    while camera.images.stats().peers < 2 {
        tokio::task::yield_now().await;
    }
    let mut image = camera.images.loan().unwrap();
    image.fill(1);
    let written_at = image.address();
    image.send().await.unwrap();
    let lent = detector.images.recv_view().await.unwrap();
    let copied = viewer.images.recv_view().await.unwrap();
    assert_eq!((lent.address(), lent.number(), copied.number()), (written_at, 1, 1));
    assert_ne!(copied.address(), written_at);
}

#[tokio::test]
async fn a_loan_that_outlives_its_connection_is_copied_for_the_next() {
    let (options, mut camera, detector) = open().await;
    let mut image = camera.images.loan().unwrap();
    image.fill(1);
    let written_at = image.address();
    drop(detector);
    let mut detector = Detector::open_with(options).await.unwrap();
    // The camera's tasks notice both.
    for _ in 0..100 {
        tokio::task::yield_now().await;
    }
    image.send().await.unwrap();
    let view = detector.images.recv_view().await.unwrap();
    assert_eq!(view.number(), 1);
    assert_ne!(view.address(), written_at, "the memory is that of a connection that is gone");
    drop(view);
    send(&mut camera, 2).await;
    assert_eq!(detector.images.recv_view().await.unwrap().number(), 2);
}

#[tokio::test]
async fn memory_is_lent_by_the_worker_whose_turn_it_is() {
    let (options, mut camera, mut detector) = open().await;
    let mut viewer = Viewer::open_with(options).await.unwrap();
    while camera.jobs.stats().peers < 2 {
        tokio::task::yield_now().await;
    }
    let mut written_at = Vec::new();
    for number in 0..4 {
        let mut job = camera.jobs.loan().unwrap();
        job.fill(number);
        written_at.push(job.address());
        job.send().await.unwrap();
    }
    let mut read_at = Vec::new();
    for _ in 0..2 {
        for view in [detector.jobs.recv_view().await.unwrap(), viewer.jobs.recv_view().await.unwrap()] {
            assert_eq!(view.number() as usize, read_at.len(), "they take turns");
            read_at.push(view.address());
        }
    }
    assert_eq!(read_at, written_at);
}
