//! The component `right`: `ready MS`, `take GATE COUNT`, `serve GATE COUNT`, `age GATE`, `account GATE`.

use crate::{Message, Right, commands, millis, number, say_account, with_gate};
use scl::RecvError;
use scl_tests::{ranges, say, say_error};
use std::time::Duration;

/// What `left` adds to find out that a reply is one.
const REPLY: u64 = 1000;

#[scl::main]
pub(crate) fn main(mut right: Right) -> scl::Result<()> {
    say("open");
    commands(|words| {
        let (gate, count) = (words.get(1).copied().unwrap_or_default(), number(words, 2) as usize);
        match words[0] {
            "ready" => match right.ready_blocking(millis(words)) {
                Ok(()) => say("ready"),
                Err(error) => say_error(error),
            },
            "take" => with_gate!(
                right.gate: [sub_protobuf, sub_json, sub_bytes, sub_latched_bytes, pull_protobuf, pull_json, pull_bytes],
                gate => {
                    let mut numbers = Vec::new();
                    for _ in 0..count {
                        match gate.recv_blocking() {
                            Ok(message) => numbers.extend(message.number()),
                            Err(RecvError::Decode { .. }) => say("undecodable"),
                            Err(error) => return Err(error.into()),
                        }
                    }
                    say(ranges(&numbers));
                }
            ),
            "serve" => with_gate!(
                right.gate: [rep_protobuf, rep_json, rep_bytes],
                gate => {
                    let mut numbers = Vec::new();
                    for _ in 0..count {
                        match gate.recv_blocking() {
                            Ok(request) => {
                                let number = request.number().unwrap_or_default();
                                numbers.push(number);
                                request.reply(&Message::of(number + REPLY))?;
                            }
                            Err(RecvError::Decode { .. }) => say("undecodable"),
                            Err(error) => return Err(error.into()),
                        }
                    }
                    say(ranges(&numbers));
                }
            ),
            "age" => with_gate!(right.gate: [sub_latched_bytes], gate => say_age(gate.latched_age())),
            _ => with_gate!(
                right.gate: [sub_protobuf, sub_json, sub_bytes, sub_latched_bytes, pull_protobuf, pull_json, pull_bytes, rep_protobuf,
                    rep_json, rep_bytes],
                gate => say_account(&gate.stats())
            ),
        }
        Ok(())
    })
}

/// Whether the last message is latched. Its age is an hour at most, in the right unit.
fn say_age(age: Option<Duration>) {
    match age {
        None => say("new"),
        Some(age) if Duration::ZERO < age && age < Duration::from_secs(3600) => say("latched"),
        Some(age) => say(format!("{age:?} old")),
    }
}
