//! A component is unit tested with the other ends of its gates, without processes, sockets or files.

scl::topology!("../six_kinds.yaml");

/// Doubles what it is asked, and tells what it received.
async fn relay(mut sink: Sink) -> scl::Result<()> {
    loop {
        tokio::select! {
            question = sink.answer.recv() => {
                let question = question?;
                let doubled = test::Number { value: question.value * 2, padding: Vec::new() };
                question.reply(&doubled).await?;
            }
            job = sink.jobs.recv() => assert_eq!(job?.value, 5),
        }
    }
}

#[tokio::test(flavor = "current_thread")]
async fn a_component_meets_its_counterpart() {
    let (sink, mut peer) = Sink::test().await.expect("opened");
    let relay = tokio::spawn(relay(sink));
    let number = |value| test::Number { value, padding: Vec::new() };
    peer.jobs.send(&number(5)).await.expect("sent");
    let answer = peer.answer.call(&number(21)).await.expect("answered");
    assert_eq!(answer.value, 42);
    relay.abort();
}

#[tokio::test(flavor = "current_thread")]
async fn what_a_component_publishes_is_received() {
    let (mut source, mut peer) = Source::test().await.expect("opened");
    for value in 0..500 {
        source.lossless.send(&test::Number { value, padding: Vec::new() }).await.expect("sent");
        assert_eq!(peer.lossless.recv().await.expect("received").value, value);
    }
}

#[test]
fn a_component_without_async_meets_its_counterpart() {
    let (mut source, mut peer) = Source::test_blocking().expect("opened");
    let answering = std::thread::spawn(move || {
        let question = peer.question.recv_blocking().expect("asked");
        let answer = test::Number { value: question.value + 1, padding: Vec::new() };
        question.reply_now(&answer).expect("answered");
        peer
    });
    let answer = source.question.call_blocking(&test::Number { value: 1, padding: Vec::new() }).expect("answered");
    assert_eq!(answer.value, 2);
    drop(answering.join());
}
