//! Each gate in a plain thread of its own, with blocking calls.

use crate::{Controlled, Controls, Gates, Number, Orders, doubled, messages, number};
use scl::{Pub, Pull, Push, RecvError, Rep, Req, Sub};
use scl_tests::{say, say_error, wait_until};
use std::thread;
use tokio::sync::mpsc::UnboundedSender;

/// Starts the threads.
pub(crate) fn start(gates: Gates) -> Controls {
    let (controls, ends) = Controls::new();
    let Controlled { values, jobs, question, values_in, jobs_in } = ends;
    thread::spawn(|| publish(gates.values, values));
    thread::spawn(|| push(gates.jobs, jobs));
    thread::spawn(|| call(gates.question, question));
    thread::spawn(|| subscribe(gates.values_in, values_in));
    thread::spawn(|| pull(gates.jobs_in, jobs_in));
    thread::spawn(|| serve(gates.answer));
    controls
}

fn publish(mut gate: Pub<Number>, mut orders: Orders) {
    while let Some(words) = orders.blocking_recv() {
        if words[0] == "peers" {
            wait_until("the peers are connected", || gate.stats().peers as u64 == number(&words, 1));
            say("peers");
            continue;
        }
        for message in messages(&words) {
            gate.send_blocking(&message).unwrap_or_else(say_error);
        }
        say("published");
    }
}

fn push(mut gate: Push<Number>, mut orders: Orders) {
    while let Some(words) = orders.blocking_recv() {
        for message in messages(&words) {
            gate.send_blocking(&message).unwrap_or_else(say_error);
        }
        say("pushed");
    }
}

fn call(mut gate: Req<Number, Number>, mut orders: Orders) {
    while let Some(words) = orders.blocking_recv() {
        match gate.call_blocking(&Number { value: number(&words, 1), padding: Vec::new() }) {
            Ok(reply) => say(reply.value),
            Err(error) => say_error(error),
        }
    }
}

fn subscribe(mut gate: Sub<Number>, received: UnboundedSender<u64>) {
    loop {
        match gate.recv_blocking() {
            Ok(message) => drop(received.send(message.value)),
            Err(RecvError::Decode { .. }) => {}
            Err(error) => return say_error(error),
        }
    }
}

fn pull(mut gate: Pull<Number>, received: UnboundedSender<u64>) {
    loop {
        match gate.recv_blocking() {
            Ok(message) => drop(received.send(message.value)),
            Err(RecvError::Decode { .. }) => {}
            Err(error) => return say_error(error),
        }
    }
}

fn serve(mut gate: Rep<Number, Number>) {
    loop {
        match gate.recv_blocking() {
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
