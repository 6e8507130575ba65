//! The log of the gateway on standard error, as detailed as `SCL_LOG` says.

use scl_gateway::wire::ConnectionLog;
use scl_terminal::Problem;
use std::io::{self, IsTerminal};
use tracing_subscriber::Layer;
use tracing_subscriber::filter::{LevelFilter, Targets};
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;

/// Starts the log.
///
/// # Errors
///
/// `SCL_LOG` is not a level.
pub(crate) fn start() -> Result<(), Problem> {
    let level = match std::env::var("SCL_LOG") {
        Ok(word) if !word.is_empty() => word.parse().map_err(|_| {
            Problem::new(format!("`SCL_LOG` is `{word}`, which is not a level"))
                .help("set it to `error`, `warn`, `info`, `debug`, `trace` or `off`")
        })?,
        _ => LevelFilter::WARN,
    };
    // The network library warns about every attempt to reach a host that is off. The gateway itself logs what matters.
    let library = if level >= LevelFilter::DEBUG { level } else { LevelFilter::OFF };
    let filter = Targets::new().with_default(level).with_targets([("zenoh", library), ("rustls", library)]);
    let use_colour = io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let layer = tracing_subscriber::fmt::layer().with_writer(io::stderr).with_ansi(use_colour);
    let layer = layer.with_target(false).without_time().with_filter(filter);
    let reasons = ConnectionLog.with_filter(ConnectionLog::filter());
    let _already_set = tracing_subscriber::registry().with(layer).with(reasons).try_init();
    Ok(())
}
