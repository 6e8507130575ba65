//! Each gate in an asynchronous task of its own.

use crate::{Controlled, Controls, Gates, Number, Orders, doubled, messages, number};
use scl::{Pub, Pull, Push, RecvError, Rep, Req, Sub};
use scl_tests::{say, say_error};
use tokio::sync::mpsc::UnboundedSender;

/// Starts the tasks on the threads of the runtime.
pub(crate) fn start(gates: Gates) -> Controls {
    let (controls, ends) = Controls::new();
    let Controlled { values, jobs, question, values_in, jobs_in } = ends;
    tokio::spawn(publish(gates.values, values));
    tokio::spawn(push(gates.jobs, jobs));
    tokio::spawn(call(gates.question, question));
    tokio::spawn(subscribe(gates.values_in, values_in));
    tokio::spawn(pull(gates.jobs_in, jobs_in));
    tokio::spawn(serve(gates.answer));
    controls
}

/// Starts the tasks in the current `LocalSet`.
pub(crate) fn start_local(gates: Gates) -> Controls {
    let (controls, ends) = Controls::new();
    let Controlled { values, jobs, question, values_in, jobs_in } = ends;
    tokio::task::spawn_local(publish(gates.values, values));
    tokio::task::spawn_local(push(gates.jobs, jobs));
    tokio::task::spawn_local(call(gates.question, question));
    tokio::task::spawn_local(subscribe(gates.values_in, values_in));
    tokio::task::spawn_local(pull(gates.jobs_in, jobs_in));
    tokio::task::spawn_local(serve(gates.answer));
    controls
}

async fn publish(mut gate: Pub<Number>, mut orders: Orders) {
    while let Some(words) = orders.recv().await {
        if words[0] == "peers" {
            while gate.stats().peers as u64 != number(&words, 1) {
                gate.peers_changed().await;
            }
            say("peers");
            continue;
        }
        for message in messages(&words) {
            gate.send(&message).await.unwrap_or_else(say_error);
        }
        say("published");
    }
}

async fn push(mut gate: Push<Number>, mut orders: Orders) {
    while let Some(words) = orders.recv().await {
        for message in messages(&words) {
            gate.send(&message).await.unwrap_or_else(say_error);
        }
        say("pushed");
    }
}

async fn call(mut gate: Req<Number, Number>, mut orders: Orders) {
    while let Some(words) = orders.recv().await {
        match gate.call(&Number { value: number(&words, 1), padding: Vec::new() }).await {
            Ok(reply) => say(reply.value),
            Err(error) => say_error(error),
        }
    }
}

async fn subscribe(mut gate: Sub<Number>, received: UnboundedSender<u64>) {
    loop {
        match gate.recv().await {
            Ok(message) => drop(received.send(message.value)),
            Err(RecvError::Decode { .. }) => {}
            Err(error) => return say_error(error),
        }
    }
}

async fn pull(mut gate: Pull<Number>, received: UnboundedSender<u64>) {
    loop {
        match gate.recv().await {
            Ok(message) => drop(received.send(message.value)),
            Err(RecvError::Decode { .. }) => {}
            Err(error) => return say_error(error),
        }
    }
}

async fn serve(mut gate: Rep<Number, Number>) {
    loop {
        match gate.recv().await {
            Ok(request) => {
                let reply = doubled(&request);
                // A requester that has disconnected needs no reply.
                let _gone = request.reply(&reply);
            }
            Err(RecvError::Decode { .. }) => {}
            Err(error) => return say_error(error),
        }
    }
}
