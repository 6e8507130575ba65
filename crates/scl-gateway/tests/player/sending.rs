//! Gates that send: numbered messages at a rate, or requests.

use super::TICK;
use super::pace::Pace;
use crate::receipts::message;
use bytes::Bytes;
use scl::{PeerStats, Pub, Push, Req, SendTimeoutError};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant, SystemTime};

/// What `pub` and `push` have in common.
pub(super) trait Sends {
    fn send_timeout(&mut self, message: &Bytes) -> Result<(), SendTimeoutError>;
    fn peers(&self) -> Vec<PeerStats>;
}

impl Sends for Pub<Bytes> {
    fn send_timeout(&mut self, message: &Bytes) -> Result<(), SendTimeoutError> {
        self.send_timeout(message, TICK)
    }

    fn peers(&self) -> Vec<PeerStats> {
        self.peer_stats()
    }
}

impl Sends for Push<Bytes> {
    fn send_timeout(&mut self, message: &Bytes) -> Result<(), SendTimeoutError> {
        self.send_timeout(message, TICK)
    }

    fn peers(&self) -> Vec<PeerStats> {
        self.peer_stats()
    }
}

struct Sender<'a, G> {
    name: &'a str,
    gate: G,
    mark: u64,
    number: u64,
    /// How many messages are still to be sent.
    left: u64,
    size: usize,
    pace: Option<Pace>,
    /// The longest call of `send`, without those that waited for a full queue.
    longest_call: Duration,
}

/// Sends what it is told until there are no more commands:
/// - `send COUNT RATE SIZE`: COUNT messages (0: without end), RATE of them per second (0: as fast as the gate takes
///   them);
/// - `stop`;
/// - `left`: how many are still to be sent, and the mark that all messages of this run have;
/// - `account PEER`: what has become of the messages to a peer;
/// - `pace`: how well the rate was kept since the last answer.
pub(super) fn play(name: &str, gate: impl Sends, commands: &Receiver<String>) {
    // Unlike that of any other run.
    let mark = SystemTime::UNIX_EPOCH.elapsed().unwrap().as_nanos() as u64 ^ u64::from(std::process::id());
    let (number, left, size, longest_call) = (0, 0, 0, Duration::ZERO);
    let mut sender = Sender { name, gate, mark, number, left, size, pace: None, longest_call };
    loop {
        let wait = if sender.left > 0 { Duration::ZERO } else { Duration::from_secs(3600) };
        match commands.recv_timeout(wait) {
            Ok(command) => sender.handle(&command),
            Err(RecvTimeoutError::Timeout) => sender.send(),
            Err(RecvTimeoutError::Disconnected) => return,
        }
    }
}

impl<G: Sends> Sender<'_, G> {
    fn handle(&mut self, command: &str) {
        let words: Vec<&str> = command.split(' ').collect();
        let answer = match words[0] {
            "send" => {
                let [count, rate, size] = [1, 2, 3].map(|index| words[index].parse::<u64>().unwrap());
                self.left = if count == 0 { u64::MAX } else { count };
                self.size = size as usize;
                self.pace = (rate > 0).then(|| Pace::new(Duration::from_nanos(1_000_000_000 / rate)));
                String::new()
            }
            "stop" => {
                self.left = 0;
                format!("sent={}", self.number)
            }
            "left" => format!("left={} mark={}", self.left, self.mark),
            "account" => account(&self.gate.peers(), words[1]),
            "pace" => {
                let call = std::mem::take(&mut self.longest_call).as_micros();
                let pace = self.pace.as_mut().map(|pace| pace.take().to_string());
                format!("{} longest_call_us={call}", pace.unwrap_or_default())
            }
            _ => panic!("{command}"),
        };
        println!("= {} {answer}", self.name);
    }

    fn send(&mut self) {
        self.pace.iter_mut().for_each(Pace::wait);
        let message = message(self.mark, self.number + 1, self.size).into();
        let called = Instant::now();
        match self.gate.send_timeout(&message) {
            // The queue is full and nothing may be dropped: the same message again, after a look at the commands.
            Err(SendTimeoutError::Timeout { .. }) => {}
            Err(error) => panic!("{error}"),
            Ok(()) => {
                self.longest_call = self.longest_call.max(called.elapsed());
                self.number += 1;
                self.left -= 1;
            }
        }
    }
}

fn account(peers: &[PeerStats], peer: &str) -> String {
    let names = || peers.iter().map(|peer| peer.peer.clone()).collect::<Vec<_>>();
    let found = peers.iter().find(|it| it.peer == peer);
    let PeerStats { connected, published, taken, replaced, dropped_oldest, dropped_newest, lost, waiting, .. } =
        found.unwrap_or_else(|| panic!("no `{peer}` in {:?}", names()));
    let (connected, dropped) = (u8::from(*connected), replaced + dropped_oldest + dropped_newest);
    format!("connected={connected} published={published} taken={taken} dropped={dropped} lost={lost} waiting={waiting}")
}

/// Calls when it is told: `call COUNT MILLISECONDS`, one after the other, with a time limit for each.
pub(super) fn request(name: &str, mut gate: Req<Bytes, Bytes>, commands: &Receiver<String>) {
    let mut number = 0;
    for command in commands {
        let words: Vec<&str> = command.split(' ').collect();
        assert_eq!(words[0], "call");
        let (count, limit) = (words[1].parse::<u64>().unwrap(), words[2].parse().unwrap());
        let (mut answered, mut failed, mut wrong, mut last) = (0, 0, 0, String::new());
        for _ in 0..count {
            number += 1;
            let request = Bytes::from(message(0, number, 0));
            match gate.call_timeout(&request, Duration::from_millis(limit)) {
                Ok(reply) if reply == request => answered += 1,
                Ok(_) => wrong += 1,
                Err(error) => {
                    failed += 1;
                    last = error.to_string();
                }
            }
        }
        println!("= {name} answered={answered} failed={failed} wrong={wrong} {last}");
    }
}
