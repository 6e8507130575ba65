//! Plays `logger` of `events.yaml`: says what it receives.

use scl_tests::say;

scl::topology!("topologies/events.yaml", only = [logger]);

#[scl::main]
async fn main(mut logger: Logger) -> scl::Result<()> {
    say("open");
    loop {
        say(logger.records.recv().await?);
    }
}
