//! Gates that receive: they take all messages and count them, or reply.

use super::TICK;
use crate::receipts::Receipts;
use bytes::Bytes;
use scl::{GateStats, Pull, RecvTimeoutError, Rep, Sub};
use std::sync::mpsc::{Receiver, TryRecvError};

/// What `sub` and `pull` have in common.
pub(super) trait Receives {
    fn recv_timeout(&mut self) -> Result<Bytes, RecvTimeoutError>;
    fn figures(&self) -> GateStats;
}

impl Receives for Sub<Bytes> {
    fn recv_timeout(&mut self) -> Result<Bytes, RecvTimeoutError> {
        self.recv_timeout(TICK)
    }

    fn figures(&self) -> GateStats {
        self.stats()
    }
}

impl Receives for Pull<Bytes> {
    fn recv_timeout(&mut self) -> Result<Bytes, RecvTimeoutError> {
        self.recv_timeout(TICK)
    }

    fn figures(&self) -> GateStats {
        self.stats()
    }
}

/// Takes messages until there are no more commands:
/// - `report`: the counts so far;
/// - `next`: answers when the next message has come;
/// - `hold`: takes nothing until the next command.
pub(super) fn play(name: &str, mut gate: impl Receives, commands: &Receiver<String>) {
    let (mut receipts, mut asked_for_next) = (Receipts::default(), false);
    loop {
        match commands.try_recv().as_deref() {
            Ok("report") => report(name, &gate, &receipts),
            Ok("next") => asked_for_next = true,
            Ok("hold") => {
                println!("= {name} holds");
                let Ok(_released) = commands.recv() else { return };
                report(name, &gate, &receipts);
            }
            Ok(command) => panic!("{command}"),
            Err(TryRecvError::Empty) => {}
            Err(TryRecvError::Disconnected) => return,
        }
        match gate.recv_timeout() {
            Ok(message) => receipts.take(&message),
            Err(RecvTimeoutError::Timeout { .. }) => continue,
            Err(error) => panic!("{error}"),
        }
        if std::mem::take(&mut asked_for_next) {
            report(name, &gate, &receipts);
        }
    }
}

fn report(name: &str, gate: &impl Receives, receipts: &Receipts) {
    let GateStats { replaced, dropped_oldest, dropped_newest, waiting, .. } = gate.figures();
    println!("= {name} {receipts} dropped={} waiting={waiting}", replaced + dropped_oldest + dropped_newest);
}

/// Replies to each request with the request.
pub(super) fn reply(name: &str, mut gate: Rep<Bytes, Bytes>, commands: &Receiver<String>) {
    let mut count = 0;
    loop {
        match commands.try_recv().as_deref() {
            Ok("report") => println!("= {name} count={count}"),
            Ok(command) => panic!("{command}"),
            Err(TryRecvError::Empty) => {}
            Err(TryRecvError::Disconnected) => return,
        }
        match gate.recv_timeout(TICK) {
            Ok(request) => {
                count += 1;
                let reply = request.message().clone();
                // Who asked may be gone.
                let _unanswered = request.reply(&reply);
            }
            Err(RecvTimeoutError::Timeout { .. }) => {}
            Err(error) => panic!("{error}"),
        }
    }
}
