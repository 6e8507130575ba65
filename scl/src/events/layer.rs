//! The layer of the program's log that finds the events.

use super::sink;
use std::sync::atomic::{AtomicBool, Ordering};
use tracing::level_filters::LevelFilter;
use tracing::subscriber::Interest;
use tracing::{Dispatch, Event, Metadata, Subscriber};
use tracing_subscriber::Layer;
use tracing_subscriber::layer::{Context, Filter};
use tracing_subscriber::registry::LookupSpan;

/// Whether a log of the program has the layer.
static INSTALLED: AtomicBool = AtomicBool::new(false);

pub(super) fn is_installed() -> bool {
    INSTALLED.load(Ordering::Acquire)
}

/// The layer that [`send`](super::send) needs in a subscriber of the program's own. It costs nothing before events are
/// sent.
///
/// ```
/// use tracing_subscriber::prelude::*;
///
/// tracing_subscriber::registry().with(scl::events::layer()).with(tracing_subscriber::fmt::layer()).init();
/// ```
pub fn layer<S: Subscriber + for<'a> LookupSpan<'a>>() -> impl Layer<S> {
    Events.with_filter(Wanted)
}

struct Events;

impl<S: Subscriber> Layer<S> for Events {
    fn on_register_dispatch(&self, _log: &Dispatch) {
        INSTALLED.store(true, Ordering::Release);
    }

    fn on_event(&self, event: &Event<'_>, _context: Context<'_, S>) {
        sink::offer(event);
    }
}

fn is_wanted(metadata: &Metadata<'_>) -> bool {
    metadata.is_event() && *metadata.level() <= sink::level()
}

/// The events that a gate gets.
struct Wanted;

impl<S> Filter<S> for Wanted {
    fn enabled(&self, metadata: &Metadata<'_>, _context: &Context<'_, S>) -> bool {
        is_wanted(metadata)
    }

    fn callsite_enabled(&self, metadata: &'static Metadata<'static>) -> Interest {
        if is_wanted(metadata) { Interest::always() } else { Interest::never() }
    }

    fn max_level_hint(&self) -> Option<LevelFilter> {
        Some(sink::level())
    }
}
