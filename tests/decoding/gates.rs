//! What gates do with frames that would take too much memory.

use crate::decoding::Tree;
use crate::{MIB, Taker, turn};
use scl::RecvError;

/// Less than 2 MiB of protobuf, 200 MB of memory.
fn hostile() -> Tree {
    Tree { children: vec![Tree::default(); MIB - 100], ..Tree::default() }
}

fn refused(error: &(dyn std::error::Error + 'static), gate: &str, peer: &str) {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        text += &format!(": {cause}");
        source = cause.source();
    }
    for part in [
        gate,
        peer,
        "`decoding.Tree` would take about ",
        "allows 32 MiB (16 times `max_size`",
        "declare a larger `max_size`",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn frames_that_would_take_too_much_memory_are_refused_before_they_are_decoded() {
    let _turn = turn();
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
    runtime.block_on(refuse_hostile_frames());
}

async fn refuse_hostile_frames() {
    let (mut taker, mut peers) = Taker::test().await.expect("a component");
    let sent = hostile();

    peers.trees.send(&sent).await.expect("sent");
    refuses(taker.trees.recv(), "`taker.trees`", "`giver.trees`").await;
    peers.texts.send(&Tree { numbers: vec![1; 300_000], ..Tree::default() }).await.expect("sent");
    refuses(taker.texts.recv(), "`taker.texts`", "`giver.texts`").await;
    let (called, ()) = tokio::join!(peers.answer.call(&sent), async {
        refuses(taker.answer.recv(), "`taker.answer`", "`giver.question`").await;
    });
    assert!(called.is_err(), "a reply");

    // The next message arrives, and a long one that takes as much memory as its frame.
    let usual = Tree { text: "a".repeat(2 * MIB - 100), ..Tree::default() };
    peers.trees.send(&usual).await.expect("sent");
    assert_eq!(taker.trees.recv().await.expect("received"), usual);
    assert_eq!(taker.trees.stats().undecodable, 1);
}

async fn refuses<T>(receiving: impl Future<Output = Result<T, RecvError>>, gate: &str, peer: &str) {
    let mut receiving = Box::pin(receiving);
    let (received, allocated) = {
        let region = stats_alloc::Region::new(crate::ALLOCATOR);
        let received = receiving.as_mut().await;
        (received, region.change().bytes_allocated)
    };
    assert!(allocated < 8 * MIB, "{gate}: {} MiB", allocated / MIB);
    refused(&failed(received), gate, peer);
}

/// A program in another language gets no such frame either.
#[test]
fn untyped_gates_refuse_them_too() {
    let _turn = turn();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/topologies/decoding.yaml");
    let loaded = scl_loader::load(&scl_loader::Request::new(path));
    let system = loaded.system_plan().expect("a valid topology");
    let plan = system.component("taker").expect("a component");
    let (mut taker, mut peers) = scl::untyped::Component::test_blocking(plan).expect("a component");
    let (mut receives, mut sends) =
        (taker.subscriber("trees").expect("a gate"), peers.publisher("trees").expect("a gate"));
    // The second key has more than 32 bits, which `protobuf-c` ignores; the last is unknown, which C++ keeps.
    for field in [&b"\x0a\0"[..], b"\x8a\x80\x80\x80\x10\0", b"\xa2\x06\0"] {
        sends.send_blocking(&field.repeat((2 * MIB - 6) / field.len()).into()).expect("sent");
        let error = failed(receives.recv_blocking());
        refused(&error, "`taker.trees`", "`giver.trees`");
    }
    let (mut receives, mut sends) = (taker.puller("texts").expect("a gate"), peers.pusher("texts").expect("a gate"));
    sends.send_blocking(&format!(r#"{{"children":[{}{{}}]}}"#, "{},".repeat(300_000)).into()).expect("sent");
    refused(&failed(receives.recv_blocking()), "`taker.texts`", "`giver.texts`");
    // What this parser refuses, another one could read: after the number, objects that are not counted.
    sends
        .send_blocking(&format!(r#"{{"maybe":NaN,"children":[{}{{}}]}}"#, "{},".repeat(300_000)).into())
        .expect("sent");
    let error = failed(receives.recv_blocking());
    let error = std::error::Error::source(&error).expect("a cause").to_string();
    assert!(error.contains("is not a message of the expected type"), "{error}");
    sends.send_blocking(&"short".into()).expect("sent");
    assert_eq!(receives.recv_blocking().expect("received"), "short");
}

/// The error, without a text of megabytes if there is none.
fn failed<T>(received: Result<T, RecvError>) -> RecvError {
    received.err().expect("an error")
}
