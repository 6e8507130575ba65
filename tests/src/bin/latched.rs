//! Plays `setter` or `getter` of `topologies/latched.yaml` and follows commands: `latched COMPONENT`.

use scl::bytes::Bytes;
use scl::{Pub, Sub};
use scl_tests::{Commands, is_shared, say, say_error};
use std::process::ExitCode;

scl::topology!("topologies/latched.yaml");

#[tokio::main(flavor = "current_thread")]
async fn main() -> ExitCode {
    let result = match std::env::args().nth(1).unwrap_or_default().as_str() {
        "setter" => set().await,
        _ => get().await,
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            say_error(error);
            ExitCode::FAILURE
        }
    }
}

async fn set() -> scl::Result<()> {
    let mut setter = Setter::open().await?;
    say("open");
    let mut commands = Commands::listen();
    while let Some(words) = commands.next().await {
        let number = |index: usize| words.get(index).and_then(|word| word.parse::<usize>().ok()).unwrap_or_default();
        let gate = match words[1].as_str() {
            "mode" => &mut setter.mode,
            _ => &mut setter.plan,
        };
        match words[0].as_str() {
            "send" => {
                for value in number(2)..number(3) {
                    gate.send(&Bytes::from(vec![value as u8; number(4).max(1)])).await?;
                }
                say("sent");
            }
            // In memory of the connection, if there is any.
            "lend" => {
                let mut frame = gate.loan_bytes(number(3))?;
                frame.fill(number(2) as u8);
                let shared = is_shared(&frame);
                frame.send().await?;
                say(if shared { "shared" } else { "inline" });
            }
            "connected" => {
                until_connected(gate, number(2)).await;
                say("connected");
            }
            _ => say(accounts(gate)),
        }
    }
    Ok(())
}

/// Waits until so many subscribers of a gate are connected.
async fn until_connected(gate: &mut Pub<Bytes>, count: usize) {
    while gate.stats().peers != count {
        gate.peers_changed().await;
    }
}

/// For each connection whether the account adds up, and how many messages were sent once more, were dropped and were
/// lost.
fn accounts(gate: &Pub<Bytes>) -> String {
    let of = |peer: &scl::PeerStats| {
        let dropped = peer.dropped_oldest + peer.dropped_newest;
        let all = peer.taken + peer.replaced + dropped + peer.lost + peer.waiting;
        let adds_up = if peer.published == all { "" } else { " WRONG" };
        format!("{}{adds_up}: {} again, {dropped} dropped, {} lost", peer.peer, peer.latched, peer.lost)
    };
    gate.peer_stats().iter().map(of).collect::<Vec<_>>().join("; ")
}

async fn get() -> scl::Result<()> {
    let mut getter = Getter::open().await?;
    say("open");
    let mut commands = Commands::listen();
    while let Some(words) = commands.next().await {
        let gate = match words[1].as_str() {
            "mode" => &mut getter.mode,
            "newest" => &mut getter.newest,
            "oldest" => &mut getter.oldest,
            "plan" => &mut getter.plan,
            _ => &mut getter.step,
        };
        match words[0].as_str() {
            "take" => {
                let message = gate.recv().await?;
                say(described(gate, &message));
            }
            // Everything that has arrived.
            "latest" => match gate.latest()? {
                Some(message) => say(described(gate, &message)),
                None => say("nothing"),
            },
            _ => match gate.try_recv()? {
                Some(message) => say(described(gate, &message)),
                None => say("nothing"),
            },
        }
    }
    Ok(())
}

/// A message of equal bytes: its value, where it is, and whether it is latched.
fn described(gate: &Sub<Bytes>, message: &Bytes) -> String {
    let value = message[0];
    assert!(message.iter().all(|byte| *byte == value), "message {value} is damaged");
    let shared = if is_shared(message) { " shared" } else { "" };
    let latched = if gate.latched_age().is_some() { " latched" } else { "" };
    format!("{value}{shared}{latched}")
}
