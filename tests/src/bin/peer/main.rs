//! Plays a component of `six_kinds.yaml` and follows commands: `peer source`, `peer sink` or `peer watcher`.

use scl_tests::{Commands, HANG_LIMIT, ranges, say, say_error, stop_self};
use std::fmt::Display;
use std::process::{ExitCode, Stdio};
use std::time::{Duration, Instant};

mod busy;

scl::topology!("topologies/six_kinds.yaml");

#[tokio::main(flavor = "current_thread")]
async fn main() -> ExitCode {
    let component = std::env::args().nth(1).unwrap_or_default();
    let result = match component.as_str() {
        "source" => play_source().await,
        "sink" => play_sink().await,
        "watcher" => play_watcher().await,
        other => Err(scl::Error::message(format!("there is no component `{other}`"))),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            say_error(error);
            ExitCode::FAILURE
        }
    }
}

async fn play_source() -> scl::Result<()> {
    let mut source = Source::open().await?;
    let mut values = 0;
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
            "publish_and_compute" => {
                for value in number(1)..number(2) {
                    source.readings.send(&message(value, 0)).await?;
                    // Like a loop that computes for each message and awaits nothing but `send`.
                    let sent = Instant::now();
                    while sent.elapsed() < Duration::from_micros(100) {}
                }
                stop_self();
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
            "busy" => busy::send(&mut source, &mut commands, number(1), &mut values, number(2)).await,
            "disconnected" => {
                while source.readings.is_connected() {
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
            // Until every gate has noticed that the sink is gone: later messages wait for the next one. The number is
            // that of watchers.
            "alone" => {
                while source.readings.stats().peers as u64 > number(1) {
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
            "account" => {
                let peer = format!("sink.{}", words.get(1).map_or("readings", String::as_str));
                let all =
                    [source.readings.peer_stats(), source.lossless.peer_stats(), source.jobs.peer_stats()].concat();
                let Some(one) = all.into_iter().find(|one| one.peer == peer) else { continue };
                let dropped = format!("{} {}", one.dropped_oldest, one.dropped_newest);
                let rest = format!("{} {} {}", one.lost, one.waiting, one.replaced);
                say(format!("{peer} {} {} {dropped} {rest}", one.published, one.taken));
            }
            "stats" => {
                let stats = source.readings.stats();
                say(format!("sent {} dropped {} waiting {}", stats.sent, stats.dropped_oldest, stats.waiting));
            }
            other => say(format!("unknown command `{other}`")),
        }
    }
    // Shorter than a test waits, which shows what this reports.
    source.close(HANG_LIMIT / 2).await?;
    Ok(())
}

async fn play_sink() -> scl::Result<()> {
    let mut sink = Sink::open().await?;
    say("open");
    let mut unanswered: Vec<scl::Request<test::Number, test::Number>> = Vec::new();
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
            // Until this number of messages waits in both gates.
            "waiting" => {
                while (sink.readings.stats().waiting.min(sink.jobs.stats().waiting) as u64) < count {
                    tokio::time::sleep(Duration::from_millis(1)).await;
                }
                say("waiting");
            }
            "answer_taken" => {
                for request in unanswered.drain(..) {
                    let doubled = message(request.value * 2, 0);
                    answer(request.reply(&doubled).map(|()| "answered"));
                }
            }
            "busy" => busy::receive(&mut sink, &mut commands).await?,
            "rejected" => say(sink.jobs.stats().rejected),
            // A child that outlives this program.
            "spawn" => {
                let mut command = std::process::Command::new("sleep");
                command.arg("600").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
                say(command.spawn()?.id());
            }
            "serve" => {
                for _ in 0..count {
                    match sink.answer.recv().await {
                        Ok(request) => {
                            let doubled = message(request.value * 2, 0);
                            answer(request.reply(&doubled).map(|()| "served"));
                        }
                        Err(error) => say_error(error),
                    }
                }
            }
            "take_request" => {
                unanswered.push(sink.answer.recv().await?);
                say("taken");
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

/// Receives at least one message; `more` gets the number of messages received and the last value.
async fn receive_while(gate: &mut scl::Sub<test::Number>, more: impl Fn(u64, u64) -> bool) {
    let mut values = Vec::new();
    loop {
        match gate.recv().await {
            Ok(number) => values.push(number.value),
            Err(error) => return say_error(error),
        }
        if !more(values.len() as u64, values[values.len() - 1]) {
            return say(ranges(&values));
        }
    }
}

fn message(value: u64, padding: u64) -> test::Number {
    test::Number { value, padding: vec![7; padding as usize] }
}

fn answer<T: Display, E: Into<scl::Error>>(result: Result<T, E>) {
    match result {
        Ok(value) => say(value),
        Err(error) => say_error(error),
    }
}
