//! Records why other hosts cannot be reached. The network library only logs the reason, at every attempt; this module
//! keeps the newest reason for each endpoint, and the gateway logs it when it is new.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Mutex, MutexGuard};

use tracing::field::{Field, Visit};
use tracing::{Event, Subscriber};
use tracing_subscriber::Layer;
use tracing_subscriber::filter::{LevelFilter, Targets};
use tracing_subscriber::layer::Context;

/// The newest reason by endpoint. Global, as the log is.
static REASONS: Mutex<BTreeMap<String, String>> = Mutex::new(BTreeMap::new());
/// Maximum number of reasons. The configured endpoints are few, but the texts come from another library.
const MOST: usize = 1000;

/// Where the network library logs attempts to connect, at level `debug`.
const TARGET: &str = "zenoh::net::runtime::orchestrator";

/// A layer that catches what the network library logs about failed connections. Install it together with the program's
/// log.
#[derive(Debug, Clone, Copy, Default)]
pub struct ConnectionLog;

impl ConnectionLog {
    /// Returns the filter for the events that this layer needs; the program's log may leave them out.
    pub fn filter() -> Targets {
        Targets::new().with_target(TARGET, LevelFilter::DEBUG)
    }
}

impl<S: Subscriber> Layer<S> for ConnectionLog {
    fn on_event(&self, event: &Event<'_>, _: Context<'_, S>) {
        if event.metadata().target() != TARGET {
            return;
        }
        let mut text = Text(String::new());
        event.record(&mut text);
        if let Some((endpoint, reason)) = parse(&text.0) {
            let mut reasons = reasons();
            if reasons.len() < MOST || reasons.contains_key(endpoint) {
                reasons.insert(endpoint.to_owned(), reason);
            }
        }
    }
}

/// Takes the reason why the last attempt to connect to an endpoint failed, if it was not taken before.
pub(super) fn take(endpoint: &str) -> Option<String> {
    reasons().remove(endpoint)
}

fn reasons() -> MutexGuard<'static, BTreeMap<String, String>> {
    REASONS.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

struct Text(String);

impl Visit for Text {
    fn record_debug(&mut self, field: &Field, value: &dyn fmt::Debug) {
        if field.name() == "message" {
            self.0 = format!("{value:?}");
        }
    }
}

/// Extracts the endpoint and the reason from a log text, without locations in the library's source and without the
/// delay before the next attempt.
fn parse(text: &str) -> Option<(&str, String)> {
    let text = text.rsplit_once(". Retry in ").map_or(text, |(text, _)| text);
    let (endpoint, mut rest) = text.strip_prefix("Unable to connect to configured peer ")?.split_once("! ")?;
    let mut reason = String::new();
    while let Some((before, after)) = rest.split_once(" at /") {
        reason.push_str(before);
        let after = after.split_once(".rs:").map_or("", |(_, line)| line);
        rest = after.trim_start_matches(|character: char| character.is_ascii_digit());
        rest = rest.trim_start_matches('.');
    }
    reason.push_str(rest);
    Some((endpoint, reason))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reason_is_kept_without_places_in_source_code() {
        let text = "Unable to connect to configured peer tls/127.0.0.1:7447! Can not create a new TLS link: [refused: \
                    (os error 111) at /root/a/tcp.rs:61.] at /root/b/unicast.rs:338.. Retry in 250ms.";
        let reason = "Can not create a new TLS link: [refused: (os error 111)]".to_owned();
        assert_eq!(parse(text), Some(("tls/127.0.0.1:7447", reason)));
        assert_eq!(parse("Scouting delay elapsed"), None);
    }
}
