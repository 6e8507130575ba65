//! Plays `talker` of `events.yaml`, which sends events of `info` and above, or, as `talker debug`, of `debug`:
//! `info TEXT`, `debug TEXT` and `warn TEXT` log an event, `flood COUNT` logs numbers,
//! and `level` says what is enabled at all.

use scl_tests::{Commands, say};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;
use tracing::Level;
use tracing::level_filters::LevelFilter;

scl::topology!("topologies/events.yaml", only = [talker]);

/// The number of messages made of events.
static MADE: AtomicU64 = AtomicU64::new(0);

/// Logs when the program ends, however that is.
struct LastWords;

impl Drop for LastWords {
    fn drop(&mut self) {
        tracing::info!("last words");
    }
}

#[scl::main]
async fn main(talker: Talker) -> scl::Result<()> {
    let level = if std::env::args().any(|word| word == "debug") { Level::DEBUG } else { Level::INFO };
    scl::events::send(talker.log, level, |event| {
        MADE.fetch_add(1, Ordering::Relaxed);
        tracing::info!("an event of the thread that sends");
        format!("{} {} {}", event.level, event.target, event.text)
    })?;
    let _last_words = LastWords;
    say("open");
    let mut commands = Commands::listen();
    while let Some(words) = commands.next().await {
        match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
            ["info", text] => tracing::info!(answer = 42, "{text}"),
            ["debug", text] => tracing::debug!("{text}"),
            ["warn", text] => tracing::warn!("{text}"),
            ["level"] => say(LevelFilter::current()),
            ["flood", count] => {
                (0..count.parse().unwrap_or(0)).for_each(|number: u32| tracing::info!("{number}"));
                assert!(scl::events::flush(Duration::from_secs(300)));
                say(format!("made {}", MADE.load(Ordering::Relaxed)));
            }
            _ => say("unknown command"),
        }
    }
    Ok(())
}
