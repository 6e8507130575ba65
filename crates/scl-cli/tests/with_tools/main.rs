//! The tests of the command line that take more than Rust and a C compiler: other languages, editors, readers of
//! recordings, programs in Python that `scl run` starts, and the benchmarks, which are a feature.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[cfg(feature = "bench")]
mod bench;
#[cfg(feature = "bridge")]
mod bridge;
#[cfg(feature = "watch")]
mod browser;
#[cfg(feature = "watch")]
#[allow(dead_code, reason = "the other tests use the rest")]
#[path = "../watch/client.rs"]
mod client;
#[cfg(all(feature = "run", feature = "generate", feature = "record"))]
mod drive;
mod editor;
#[cfg(feature = "record")]
mod foxglove;
#[cfg(all(feature = "run", feature = "generate"))]
mod languages;
mod lsp;
#[cfg(feature = "record")]
mod mcap;
#[cfg(feature = "watch")]
mod metrics;
mod npm;
#[cfg(feature = "record")]
#[allow(dead_code, reason = "the other tests use the rest")]
#[path = "../rover/mod.rs"]
mod rover;
#[cfg(feature = "run")]
mod run_group;
#[cfg(feature = "run")]
mod run_hosts;
#[cfg(feature = "run")]
mod run_ready;
#[cfg(feature = "new")]
mod rust_analyzer;
mod schema;
#[cfg(feature = "simulate")]
mod simulate;
#[allow(dead_code, reason = "the other tests use the rest")]
#[path = "../system/mod.rs"]
mod system;
#[cfg(feature = "watch")]
mod watch;
