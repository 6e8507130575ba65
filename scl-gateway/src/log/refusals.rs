//! Why certificates are refused, in handshakes with other hosts. The network library knows it, and writes it at every attempt
//! into its own log; here it is said once a minute.

use scl_terminal::{escape, print_err};
use std::collections::HashMap;
use std::fmt;
use std::sync::Mutex;
use std::time::{Duration, Instant};
use tracing::field::{Field, Visit};
use tracing::{Event, Subscriber};
use tracing_subscriber::Layer;
use tracing_subscriber::filter::{LevelFilter, Targets};
use tracing_subscriber::layer::Context;

/// Time between two lines with the same reason.
const PAUSE: Duration = Duration::from_secs(60);

/// Where the reasons begin in the texts of the library: this host refuses, and the other one does.
const REASONS: [&str; 2] = ["invalid peer certificate: ", "received fatal alert: "];

/// The modules of the library that connect and accept.
pub(super) fn filter() -> Targets {
    Targets::new()
        .with_target("zenoh::net::runtime::orchestrator", LevelFilter::DEBUG)
        .with_target("zenoh_link_tls", LevelFilter::WARN)
}

/// Writes the reasons.
#[derive(Debug, Default)]
pub(super) struct Refusals {
    written: Mutex<HashMap<String, Instant>>,
}

impl<S: Subscriber> Layer<S> for Refusals {
    fn on_event(&self, event: &Event<'_>, _context: Context<'_, S>) {
        let mut message = Message::default();
        event.record(&mut message);
        let Some(reason) = reason(&message.0) else { return };
        let Ok(mut written) = self.written.lock() else { return };
        if written.get(&reason).is_some_and(|at| at.elapsed() < PAUSE) {
            return;
        }
        let shown = escape(&reason);
        print_err(&format!(" WARN no connection to another host: {shown}; run `scl gateway check` on both hosts\n"));
        written.insert(reason, Instant::now());
    }
}

#[derive(Default)]
struct Message(String);

impl Visit for Message {
    fn record_debug(&mut self, field: &Field, value: &dyn fmt::Debug) {
        if field.name() == "message" {
            self.0 = format!("{value:?}");
        }
    }
}

/// The reason in a text of the library, without times, places in its code and its own hints, which change or mislead.
fn reason(text: &str) -> Option<String> {
    let start = REASONS.iter().filter_map(|start| text.find(start)).min()?;
    let text = &text[start..];
    let ends = [": verification time", " at /", ". Hint", " (", ". Retry"];
    let end = ends.iter().filter_map(|end| text.find(end)).min().unwrap_or(text.len());
    Some(text[..end].to_owned())
}

#[cfg(test)]
mod tests {
    use super::reason;

    #[test]
    fn reasons_are_found_in_the_texts_of_the_library() {
        for (text, expected) in [
            (
                "Unable to connect to configured peer tls/127.0.0.1:7448! Can not create a new TLS link bound to x: invalid peer \
                 certificate: UnknownIssuer at /src/unicast.rs:378.. Retry in 250ms",
                Some("invalid peer certificate: UnknownIssuer"),
            ),
            (
                "invalid peer certificate: certificate expired: verification time 2 (UNIX), but certificate is not valid after 1",
                Some("invalid peer certificate: certificate expired"),
            ),
            (
                "received fatal alert: DecryptError. Hint: increase the system open file limit.",
                Some("received fatal alert: DecryptError"),
            ),
            ("Connection refused", None),
        ] {
            assert_eq!(reason(text).as_deref(), expected, "{text}");
        }
    }
}
