//! Texts that are not UTF-8, which libraries of C and C++ encode and receivers refuse: the sender is told.

use super::{LONG, system_plan};
use bytes::Bytes;
use scl::host::text_with_causes;
use scl::transport::memory::Memory;
use scl::untyped::Component;
use scl::{CallError, OpenOptions};

fn open() -> (Component, Component) {
    let options = OpenOptions::new().transport(Memory::new());
    let [source, sink] = ["source", "sink"].map(|name| {
        let plan = system_plan("texts.yaml").component(name).unwrap().clone();
        Component::open_blocking_with(&plan, options.clone()).unwrap()
    });
    source.ready_blocking(LONG).unwrap();
    (source, sink)
}

#[test]
fn a_sender_is_told_which_text_is_not_utf_8() {
    let (mut source, mut sink) = open();
    let (mut events, mut notes) = (source.publisher("events").unwrap(), source.pusher("notes").unwrap());
    let mut received = sink.subscriber("events").unwrap();
    let refused = |error: scl::SendError| text_with_causes(&error);
    let error = refused(events.send_blocking(&Bytes::from_static(b"\x1a\x03\x0a\x01\xff")).unwrap_err());
    assert_eq!(
        error,
        "gate `source.events` cannot encode this message: codec `protobuf` cannot encode this message: field \
         `inner.text` of `rover.Event` is not UTF-8, as a `string` must be; `bytes` may be anything"
    );
    let error = refused(notes.send_blocking(&Bytes::from_static(b"{\"text\":\"\xff\"}")).unwrap_err());
    assert!(error.ends_with(": byte 9 is not UTF-8, as JSON must be"), "{error}");
    // Nothing of it was sent, and bytes may be anything.
    let sound = Bytes::from_static(b"\x0a\x02\xc3\xa4\x12\x01\xff");
    events.send_blocking(&sound).unwrap();
    assert_eq!(received.recv_blocking().unwrap(), sound);
    let mut image = source.publisher("image").unwrap();
    image.send_blocking(&Bytes::from_static(b"\x0a\x01\xff")).unwrap();
}

#[test]
fn requests_and_replies_are_checked_too() {
    let (mut source, mut sink) = open();
    let mut ask = source.requester("ask").unwrap();
    let mut answers = sink.replier("ask").unwrap();
    let wrong = Bytes::from_static(b"\x0a\x01\xff");
    let error = text_with_causes(&ask.call_blocking(&wrong).unwrap_err());
    assert!(error.contains("field `text` of `rover.Event` is not UTF-8"), "{error}");
    let call = std::thread::spawn(move || ask.call_blocking(&Bytes::new()).unwrap_err());
    let request = answers.recv_blocking().unwrap();
    let error = text_with_causes(&request.reply(&wrong).unwrap_err());
    assert!(error.contains("field `text` of `rover.Event` is not UTF-8"), "{error}");
    drop((answers, sink));
    assert!(matches!(call.join().unwrap(), CallError::PeerLost { .. }));
}
