//! The integration tests of the command line, in one binary.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[cfg(feature = "observe")]
mod bandwidth;
#[cfg(feature = "observe")]
mod call;
mod check;
mod check_fix;
mod check_formats;
mod check_inputs;
#[cfg(feature = "run")]
mod check_launch;
mod check_watch;
#[cfg(feature = "watch")]
#[path = "watch/client.rs"]
mod client;
#[cfg(feature = "record")]
mod compare;
#[cfg(feature = "observe")]
mod complete_names;
mod completions;
#[cfg(feature = "observe")]
mod delay;
#[cfg(feature = "run")]
mod deploy;
mod diff;
#[cfg(feature = "observe")]
mod doctor;
#[cfg(feature = "observe")]
mod due;
#[cfg(feature = "observe")]
mod echo;
mod expand;
mod explain;
mod external;
#[cfg(feature = "record")]
mod formats;
#[cfg(feature = "generate")]
mod generate;
mod graph;
#[cfg(all(feature = "run", feature = "record", feature = "observe"))]
mod groups;
#[cfg(feature = "observe")]
mod hz;
#[cfg(feature = "observe")]
mod info;
#[cfg(feature = "record")]
mod info_recording;
#[cfg(feature = "observe")]
mod json;
#[cfg(feature = "observe")]
mod list;
#[cfg(feature = "run")]
mod log;
#[cfg(feature = "watch")]
mod metrics;
#[cfg(feature = "new")]
mod new;
#[cfg(feature = "record")]
mod output;
#[cfg(feature = "observe")]
mod parameters;
mod plan;
#[cfg(feature = "observe")]
mod publish;
#[cfg(feature = "run")]
mod quickstart;
#[cfg(feature = "record")]
mod record;
#[cfg(feature = "record")]
mod replay;
#[cfg(feature = "observe")]
mod rover;
#[cfg(feature = "run")]
mod run_build;
#[cfg(feature = "run")]
mod run_completed;
#[cfg(feature = "run")]
mod run_control;
#[cfg(all(feature = "run", feature = "observe"))]
mod run_expected;
#[cfg(all(feature = "run", feature = "observe"))]
mod run_hang;
#[cfg(feature = "run")]
mod run_kinds;
#[cfg(feature = "run")]
mod run_mistakes;
#[cfg(feature = "run")]
mod run_orphans;
#[cfg(feature = "run")]
mod run_output;
#[cfg(feature = "run")]
mod run_package;
#[cfg(feature = "run")]
mod run_parameters;
#[cfg(feature = "run")]
mod run_placement;
#[cfg(feature = "run")]
mod run_profiles;
#[cfg(feature = "run")]
mod run_rebuild;
#[cfg(feature = "run")]
mod run_restart;
#[cfg(feature = "run")]
mod run_stop;
#[cfg(feature = "run")]
mod run_terminal;
#[cfg(feature = "run")]
mod run_transports;
#[cfg(feature = "run")]
mod run_twice;
#[cfg(feature = "simulate")]
mod simulate;
#[cfg(feature = "record")]
mod stop_signals;
mod system;
#[cfg(feature = "run")]
mod systemd;
#[cfg(feature = "observe")]
mod ticker;
#[cfg(feature = "observe")]
mod top;
#[cfg(feature = "watch")]
mod watch;
#[cfg(feature = "watch")]
mod watch_control;
#[cfg(feature = "watch")]
mod watch_replay;
mod workspace;
