//! A component is unit tested through the opposite ends of its gates, without processes, sockets or files.

scl::topology!("topologies/six_kinds.yaml");

/// Doubles what it is asked, and expects one job.
async fn relay(mut sink: Sink) -> scl::Result<()> {
    loop {
        tokio::select! {
            request = sink.answer.recv() => {
                let request = request?;
                let doubled = number(request.value * 2);
                request.reply(&doubled)?;
            }
            job = sink.jobs.recv() => assert_eq!(job?.value, 5),
        }
    }
}

#[tokio::test(flavor = "current_thread")]
async fn a_component_runs_against_its_peer() {
    let (sink, mut peer) = Sink::test().await.expect("opened");
    let relay = tokio::spawn(relay(sink));
    peer.jobs.send(&number(5)).await.expect("sent");
    let reply = peer.answer.call(&number(21)).await.expect("a reply");
    assert_eq!(reply.value, 42);
    relay.abort();
}

#[tokio::test(flavor = "current_thread")]
async fn what_a_component_publishes_is_received() {
    let (mut source, mut peer) = Source::test().await.expect("opened");
    for value in 0..500 {
        source.lossless.send(&number(value)).await.expect("sent");
        assert_eq!(peer.lossless.recv().await.expect("received").value, value);
    }
}

#[test]
fn a_component_without_async_runs_against_its_peer() {
    let (mut source, mut peer) = Source::test_blocking().expect("opened");
    let answering = std::thread::spawn(move || {
        let request = peer.question.recv_blocking().expect("a request");
        let reply = number(request.value + 1);
        request.reply(&reply).expect("replied");
        peer
    });
    let reply = source.question.call_blocking(&number(1)).expect("a reply");
    assert_eq!(reply.value, 2);
    drop(answering.join());
}

fn number(value: u64) -> test::Number {
    test::Number { value, padding: Vec::new() }
}
