//! The component `left`: `ready MS`, `send GATE FROM TO`, `call GATE FROM TO`, `gone GATE`, `account GATE`.

use crate::{Left, Message, commands, millis, number, say_account, with_gate};
use scl_tests::{ranges, say, say_error, wait_until};

#[scl::main]
pub(crate) fn main(mut left: Left) -> scl::Result<()> {
    say("open");
    commands(|words| {
        let gate = words.get(1).copied().unwrap_or_default();
        let range = number(words, 2)..number(words, 3);
        match words[0] {
            "ready" => match left.ready_blocking(millis(words)) {
                Ok(()) => say("ready"),
                Err(error) => say_error(error),
            },
            "send" => {
                with_gate!(
                    left.gate: [pub_protobuf, pub_json, pub_bytes, pub_latched_bytes, push_protobuf, push_json, push_bytes],
                    gate => for number in range { gate.send_blocking(&Message::of(number))?; }
                );
                say("sent");
            }
            "call" => {
                let mut numbers = Vec::new();
                with_gate!(
                    left.gate: [req_protobuf, req_json, req_bytes],
                    gate => for number in range {
                        numbers.extend(gate.call_blocking(&Message::of(number))?.number());
                    }
                );
                say(ranges(&numbers));
            }
            "gone" => {
                with_gate!(
                    left.gate: [pub_protobuf, pub_json, pub_bytes, pub_latched_bytes, push_protobuf, push_json, push_bytes, req_protobuf,
                        req_json, req_bytes],
                    gate => wait_until("the peer has gone", || !gate.is_connected())
                );
                say("gone");
            }
            _ => with_gate!(
                left.gate: [pub_protobuf, pub_json, pub_bytes, pub_latched_bytes, push_protobuf, push_json, push_bytes, req_protobuf,
                    req_json, req_bytes],
                gate => say_account(&gate.stats())
            ),
        }
        Ok(())
    })
}
