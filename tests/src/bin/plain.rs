//! Plays a component of `six_kinds.yaml` without async and follows commands: `plain source` or `plain sink`.

use rustix::process::WaitOptions;
use scl_tests::{say, stop_self};
use std::time::{Duration, Instant};

scl::topology!("topologies/six_kinds.yaml", only = [source, sink]);

/// Shorter than any pause after which a background thread could take over.
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
                source.ready_blocking(Duration::from_secs(300))?;
                say("ready");
            }
            "reap" => {
                rustix::process::wait(WaitOptions::empty())?;
                say("reaped");
            }
            "publish_forever" => publish_forever(&mut source)?,
            "push_and_stop" => {
                source.jobs.send_blocking(&number(7))?;
                stop_self();
            }
            "push_and_close" => {
                for value in 0..1000 {
                    source.jobs.send_blocking(&number(value))?;
                }
                source.close_blocking(Duration::from_secs(300))?;
                return Ok(());
            }
            other => say(format!("unknown command `{other}`")),
        }
    }
    Ok(())
}

/// Keeps the thread busy between its calls, none of which waits.
fn publish_forever(source: &mut Source) -> scl::Result<()> {
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
        let request = sink.answer.recv_blocking()?;
        let doubled = number(request.value * 2);
        request.reply(&doubled)?;
        stop_self();
    }
}

fn number(value: u64) -> test::Number {
    test::Number { value, padding: Vec::new() }
}
