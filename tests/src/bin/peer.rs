//! Plays a component of `six_kinds.yaml` as it is told: `peer source`, `peer sink` or `peer watcher`.

use scl_tests::{Commands, say, stand_still};
use std::fmt::Display;
use std::time::{Duration, Instant};

scl::topology!("six_kinds.yaml");

#[tokio::main(flavor = "current_thread")]
async fn main() -> std::process::ExitCode {
    let role = std::env::args().nth(1).unwrap_or_default();
    let played = match role.as_str() {
        "source" => play_source().await,
        "sink" => play_sink().await,
        "watcher" => play_watcher().await,
        other => Err(scl::Error::message(format!("no component is called `{other}`"))),
    };
    match played {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            say(format!("failed: {error:?}"));
            std::process::ExitCode::FAILURE
        }
    }
}

async fn play_source() -> scl::Result<()> {
    let mut source = Source::open().await?;
    say("open");
    let mut commands = Commands::listen();
    while let Some(words) = commands.next().await {
        let number = |index: usize| words.get(index).and_then(|word| word.parse::<u64>().ok()).unwrap_or_default();
        match words.first().map_or("", String::as_str) {
            "ready" => answer(source.ready(Duration::from_millis(number(1))).await.map(|()| "ready")),
            "publish" => {
                for value in number(1)..number(2) {
                    source.readings.send(&message(value, number(3))).await?;
                }
                say("published");
            }
            "compute_and_publish" => {
                for value in number(1)..number(2) {
                    source.readings.send(&message(value, 0)).await?;
                    // As in a loop that computes for each message, and awaits nothing but sending.
                    let sent = Instant::now();
                    while sent.elapsed() < Duration::from_micros(100) {}
                }
                stand_still();
            }
            "lossless" => {
                for value in number(1)..number(2) {
                    source.lossless.send(&message(value, number(3))).await?;
                }
                say("published");
            }
            "try_lossless" => answer(source.lossless.try_send(&message(number(1), 0)).map(|()| "published")),
            "push" => {
                for value in number(1)..number(2) {
                    source.jobs.send(&message(value, number(3))).await?;
                }
                say("pushed");
            }
            "call" => answer(source.question.call(&message(number(1), 0)).await.map(|answer| answer.value)),
            "disconnected" => {
                while source.readings.connected() {
                    source.readings.peers_changed().await;
                }
                say("disconnected");
            }
            "peers" => {
                while source.readings.stats().peers as u64 != number(1) {
                    source.readings.peers_changed().await;
                }
                say("peers");
            }
            // Until every gate has seen that nobody is there: what is sent from now on waits for the next one.
            "alone" => {
                while source.readings.stats().peers > 0 {
                    source.readings.peers_changed().await;
                }
                while source.lossless.stats().peers > 0 {
                    source.lossless.peers_changed().await;
                }
                while source.jobs.stats().peers > 0 {
                    source.jobs.peers_changed().await;
                }
                say("alone");
            }
            "stats" => {
                let stats = source.readings.stats();
                say(format!("sent {} dropped {} waiting {}", stats.sent, stats.dropped_oldest, stats.waiting));
            }
            other => say(format!("unknown command `{other}`")),
        }
    }
    source.close(Duration::from_secs(10)).await?;
    Ok(())
}

async fn play_sink() -> scl::Result<()> {
    let mut sink = Sink::open().await?;
    say("open");
    // Requests that are never answered.
    let mut heard: Vec<scl::Request<test::Number, test::Number>> = Vec::new();
    let mut commands = Commands::listen();
    while let Some(words) = commands.next().await {
        let count = words.get(1).and_then(|word| word.parse::<u64>().ok()).unwrap_or(1);
        match words.first().map_or("", String::as_str) {
            "ready" => answer(sink.ready(Duration::from_millis(count)).await.map(|()| "ready")),
            "receive" => receive(&mut sink.readings, count).await,
            "receive_up_to" => receive_while(&mut sink.readings, |_, value| value != count).await,
            "receive_lossless" => receive(&mut sink.lossless, count).await,
            "lossless_up_to" => receive_while(&mut sink.lossless, |_, value| value != count).await,
            "newest" => answer(sink.newest.recv().await.map(|newest| newest.value)),
            "latest" => {
                answer(sink.newest.latest().map(|newest| newest.map_or("none".to_owned(), |n| n.value.to_string())))
            }
            "pull" => {
                let mut values = Vec::new();
                for _ in 0..count {
                    values.push(sink.jobs.recv().await?.value);
                }
                say(ranges(&values));
            }
            "pull_up_to" => {
                let mut values = vec![sink.jobs.recv().await?.value];
                while values.last() != Some(&count) {
                    values.push(sink.jobs.recv().await?.value);
                }
                say(ranges(&values));
            }
            "answer_heard" => {
                for question in heard.drain(..) {
                    let doubled = message(question.value * 2, 0);
                    answer(question.reply(&doubled).await.map(|()| "answered"));
                }
            }
            "rejected" => say(sink.jobs.stats().rejected),
            "serve" => {
                for _ in 0..count {
                    match sink.answer.recv().await {
                        Ok(question) => {
                            let doubled = message(question.value * 2, 0);
                            answer(question.reply(&doubled).await.map(|()| "served"));
                        }
                        Err(error) => say(format!("error: {error}")),
                    }
                }
            }
            "hear" => {
                heard.push(sink.answer.recv().await?);
                say("heard");
            }
            other => say(format!("unknown command `{other}`")),
        }
    }
    Ok(())
}

async fn play_watcher() -> scl::Result<()> {
    let mut watcher = Watcher::open().await?;
    say("open");
    let mut commands = Commands::listen();
    while let Some(words) = commands.next().await {
        let number = words.get(1).and_then(|word| word.parse::<u64>().ok()).unwrap_or(1);
        match words.first().map_or("", String::as_str) {
            "receive_up_to" => receive_while(&mut watcher.readings, |_, value| value != number).await,
            _ => receive(&mut watcher.readings, number).await,
        }
    }
    Ok(())
}

async fn receive(gate: &mut scl::Sub<test::Number>, count: u64) {
    receive_while(gate, |received, _| received < count).await;
}

/// Receives at least one message; `more` is asked with how many were received and the last one's value.
async fn receive_while(gate: &mut scl::Sub<test::Number>, more: impl Fn(u64, u64) -> bool) {
    let mut values = Vec::new();
    loop {
        match gate.recv().await {
            Ok(number) => values.push(number.value),
            Err(error) => return say(format!("error: {error}")),
        }
        if !more(values.len() as u64, values[values.len() - 1]) {
            return say(ranges(&values));
        }
    }
}

fn message(value: u64, padding: u64) -> test::Number {
    test::Number { value, padding: vec![7; padding as usize] }
}

fn answer<T: Display, E: Display>(result: Result<T, E>) {
    match result {
        Ok(value) => say(value),
        Err(error) => say(format!("error: {error}")),
    }
}

/// `0..10 12..13`: what arrived, in the order of its arrival, shortened where the numbers follow each other.
fn ranges(values: &[u64]) -> String {
    let mut ranges: Vec<std::ops::Range<u64>> = Vec::new();
    for &value in values {
        match ranges.last_mut() {
            Some(last) if last.end == value => last.end += 1,
            _ => ranges.push(value..value + 1),
        }
    }
    ranges.iter().map(|range| format!("{}..{}", range.start, range.end)).collect::<Vec<_>>().join(" ")
}
