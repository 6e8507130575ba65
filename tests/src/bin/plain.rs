//! Plays a component of `six_kinds.yaml` without async, as it is told: `plain source` or `plain sink`.

use scl_tests::{say, stand_still};
use std::time::{Duration, Instant};

scl::topology!("six_kinds.yaml", only = [source, sink]);

/// Shorter than any pause after which somebody else looks after the gates.
const PERIOD: Duration = Duration::from_micros(300);

fn main() -> scl::Result<()> {
    match std::env::args().nth(1).unwrap_or_default().as_str() {
        "source" => play_source(Source::open_blocking()?),
        _ => play_sink(Sink::open_blocking()?),
    }
}

fn play_source(mut source: Source) -> scl::Result<()> {
    say("open");
    for command in std::io::stdin().lines() {
        match command?.as_str() {
            "ready" => {
                source.ready_blocking(Duration::from_secs(30))?;
                say("ready");
            }
            "publish_for_ever" => publish_for_ever(&mut source)?,
            "push_and_stop" => {
                source.jobs.send_blocking(&number(7))?;
                stand_still();
            }
            "push_and_close" => {
                for value in 0..1000 {
                    source.jobs.send_blocking(&number(value))?;
                }
                source.close_blocking(Duration::from_secs(30))?;
                return Ok(());
            }
            other => say(format!("unknown command `{other}`")),
        }
    }
    Ok(())
}

/// Keeps the thread busy between its calls, and never waits in one.
fn publish_for_ever(source: &mut Source) -> scl::Result<()> {
    for value in 0.. {
        source.readings.send_blocking(&number(value))?;
        let sent = Instant::now();
        while sent.elapsed() < PERIOD {}
    }
    Ok(())
}

fn play_sink(mut sink: Sink) -> scl::Result<()> {
    say("open");
    loop {
        let question = sink.answer.recv_blocking()?;
        let doubled = number(question.value * 2);
        question.reply_now(&doubled)?;
        stand_still();
    }
}

fn number(value: u64) -> test::Number {
    test::Number { value, padding: Vec::new() }
}
