//! Requests between components of two hosts.

use super::hosts::{Hosts, LONG, number, numbered};
use bytes::Bytes;
use scl::Rep;

async fn answer(mut commands: Rep<Bytes, Bytes>) {
    loop {
        let request = commands.recv().await.unwrap();
        let reply = numbered(number(request.message()) + 1);
        request.reply(&reply).unwrap();
    }
}

#[tokio::test]
async fn requests_are_answered_by_a_component_of_another_host() {
    let hosts = Hosts::start().await;
    let (mut controller, mut assistant) = (hosts.ground.open("controller").await, hosts.ground.open("assistant").await);
    let error = assistant.ready(std::time::Duration::ZERO).await.unwrap_err().to_string();
    assert!(error.contains("is not running"), "{error}");
    let mut sensor = hosts.board.open("sensor").await;
    let answering = tokio::spawn(answer(sensor.replier("commands").unwrap()));
    assistant.ready(LONG).await.unwrap();
    let (mut first, mut second) = (controller.requester("commands").unwrap(), assistant.requester("commands").unwrap());
    for sent in 0..100 {
        let (one, other) = (numbered(sent), numbered(1000 + sent));
        let (one, other) = tokio::join!(first.call(&one), second.call(&other));
        assert_eq!((number(&one.unwrap()), number(&other.unwrap())), (sent + 1, 1001 + sent));
    }
    answering.abort();
}

#[tokio::test]
async fn a_requester_notices_that_the_far_replier_is_gone() {
    let hosts = Hosts::start().await;
    let mut assistant = hosts.ground.open("assistant").await;
    let mut calls = assistant.requester("commands").unwrap();
    let mut sensor = hosts.board.open("sensor").await;
    let mut commands = sensor.replier("commands").unwrap();
    assistant.ready(LONG).await.unwrap();
    let message = numbered(1);
    let (called, ()) = tokio::join!(calls.call(&message), async {
        // Long before the caller's time is over.
        let _unanswered = commands.recv().await.unwrap();
        drop((commands, sensor));
    });
    let error = called.unwrap_err().to_string();
    assert!(error.contains("disconnected") || error.contains("lost") || error.contains("gone"), "{error}");
    // The next one is answered by the next run.
    let mut sensor = hosts.board.open("sensor").await;
    let answering = tokio::spawn(answer(sensor.replier("commands").unwrap()));
    assistant.ready(LONG).await.unwrap();
    assert_eq!(number(&calls.call(&message).await.unwrap()), 2);
    answering.abort();
}
