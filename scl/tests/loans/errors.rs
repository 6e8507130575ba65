//! Gates that lend nothing, and why.

use super::{Camera, Detector, LONG};
use scl::transport::memory::Memory;
use scl::untyped::Component;
use scl::{BlockingError, LoanError, OpenOptions, RecvError, SendError, TrySendError};
use zerocopy::FromBytes;

/// The same gates, with messages of another codec and of another length.
mod others {
    use super::super::Image;

    pub(super) type Text = u64;
    scl::topology!("others.yaml");
}

fn memory() -> OpenOptions {
    OpenOptions::new().transport(Memory::new())
}

#[tokio::test]
async fn only_raw_messages_are_written_and_read_in_place() {
    let mut sender = others::Sender::open_with(memory()).await.unwrap();
    let error = sender.text.loan().unwrap_err();
    assert_eq!(
        error.to_string(),
        "gate `sender.text` lends no memory for its messages: its codec is `json`; only messages with `codec: raw` are \
         written in place, use `send` for others"
    );
    let mut receiver = others::Receiver::open_with(memory()).await.unwrap();
    let error = receiver.text.recv_view().await.unwrap_err();
    assert_eq!(
        error.to_string(),
        "gate `receiver.text` has no views of its messages: its codec is `json`; only messages with `codec: raw` are read in \
         place, use `recv` for others"
    );
    assert!(matches!(receiver.text.try_recv_view(), Err(RecvError::NoViews { .. })));
}

#[tokio::test]
async fn nothing_is_lent_for_what_a_peer_does_not_accept() {
    let mut camera = Camera::open_with(memory()).await.unwrap();
    assert_eq!(camera.bytes.loan_bytes(1 << 20).unwrap().len(), 1 << 20);
    let error = camera.bytes.loan_bytes((1 << 20) + 1).unwrap_err();
    assert_eq!(
        error.to_string(),
        "gate `camera.bytes` cannot send a message of 1048577 bytes: `detector.bytes` accepts at most 1048576; raise its \
         `max_size`"
    );
}

#[tokio::test]
async fn a_view_needs_bytes_of_the_right_length() {
    let options = memory();
    let mut receiver = others::Receiver::open_with(options.clone()).await.unwrap();
    let plan = crate::untyped::system_plan("loans/others.yaml");
    let mut sender = Component::open_with(plan.component("sender").unwrap(), options).await.unwrap();
    let mut images = sender.publisher("images").unwrap();
    sender.ready(LONG).await.unwrap();
    for length in [7, 8] {
        // The bytes of an untyped gate may be written in place, whatever its codec is.
        let bytes = images.loan_bytes(length).unwrap();
        bytes.send().await.unwrap();
    }
    let error = receiver.images.recv_view().await.unwrap_err();
    let RecvError::Decode { source, .. } = &error else { panic!("{error}") };
    assert!(source.to_string().contains("received 7"), "{source}");
    assert!(matches!(receiver.images.recv_view().await, Err(RecvError::Decode { .. })));
    assert_eq!(receiver.images.stats().rejected, 2);
}

#[tokio::test]
async fn a_closed_component_neither_lends_nor_sends() {
    let options = memory();
    let plan = crate::untyped::system_plan("loans.yaml");
    let mut camera = Component::open_with(plan.component("camera").unwrap(), options.clone()).await.unwrap();
    let mut detector = Detector::open_with(options).await.unwrap();
    let mut bytes = camera.publisher("bytes").unwrap();
    let loaned = bytes.loan_bytes(10).unwrap();
    camera.closer().end_calls();
    let Err(SendError::Blocking { source: BlockingError::Closed, .. }) = loaned.send().await else {
        panic!("sent after the end")
    };
    let Err(LoanError::Blocking { source: BlockingError::Closed, .. }) = bytes.loan_bytes(10) else {
        panic!("lent after the end")
    };
    drop((bytes, camera));
    assert!(detector.bytes.try_recv().unwrap().is_none());
}

#[tokio::test]
async fn blocking_calls_are_refused_inside_async() {
    let mut camera = Camera::open_with(memory()).await.unwrap();
    let refused = camera.images.loan().unwrap().send_blocking();
    assert!(matches!(refused, Err(SendError::Blocking { source: BlockingError::InsideAsync, .. })), "{refused:?}");
    assert!(!matches!(camera.images.loan().unwrap().try_send(), Err(TrySendError::Send(_))), "it never blocks");
}

#[test]
fn the_image_is_as_long_as_it_looks() {
    assert!(super::Image::read_from_bytes(&vec![0; 64_008]).is_ok());
}
