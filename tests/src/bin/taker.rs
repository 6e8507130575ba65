//! Plays `taker` or `slow` of `exits.yaml` and follows commands.

use scl_tests::{Commands, ranges, say, say_error};
use test::Number;

scl::topology!("topologies/exits.yaml", only = [taker, slow]);

#[tokio::main(flavor = "current_thread")]
async fn main() -> scl::Result<()> {
    match std::env::args().nth(1).unwrap_or_default().as_str() {
        "slow" => play_slow(Slow::open().await?).await,
        _ => play_taker(Taker::open().await?).await,
    }
}

async fn play_taker(mut taker: Taker) -> scl::Result<()> {
    say("open");
    let mut commands = Commands::listen();
    while let Some(words) = commands.next().await {
        let number = words.get(1).and_then(|word| word.parse().ok()).unwrap_or_default();
        match words.first().map_or("", String::as_str) {
            "values" => {
                let mut values = Vec::new();
                while values.last() != Some(&number) {
                    values.push(taker.values.recv().await?.value);
                }
                say(ranges(&values));
            }
            "jobs" => {
                let mut values = Vec::new();
                while values.last() != Some(&number) {
                    values.push(taker.jobs.recv().await?.value);
                }
                say(ranges(&values));
            }
            _ => match taker.question.call(&Number { value: number, padding: Vec::new() }).await {
                Ok(reply) => say(reply.value),
                Err(error) => say_error(error),
            },
        }
    }
    Ok(())
}

async fn play_slow(mut slow: Slow) -> scl::Result<()> {
    say("open");
    let mut commands = Commands::listen();
    while commands.next().await.is_some() {
        say(slow.values.recv().await?.value);
    }
    Ok(())
}
