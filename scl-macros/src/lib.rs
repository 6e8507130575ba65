//! The macros of SCL. Use them through the crate `scl`, which also provides what the generated code needs.
//!
//! This crate contains no rules about topologies: `scl-topology` finds and words every problem. Here, problems become
//! compile errors, and a topology without errors becomes structs.
#![cfg_attr(feature = "nightly", feature(proc_macro_expand, proc_macro_span))]
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod arguments;
mod component_stand_in;
mod editor;
mod expand;
mod extern_crates;
mod known_components;
mod locate;
mod main_attribute;
#[cfg(test)]
mod tests;

use proc_macro::{TokenStream, TokenTree};

/// The implementation of `scl::topology!`, which passes `$crate` as the first token.
#[doc(hidden)]
#[proc_macro]
pub fn __topology(input: TokenStream) -> TokenStream {
    let surroundings = locate::Surroundings::of_compiler(source_file(&input));
    expand::expand_topology(input.into(), &surroundings).into()
}

/// Turns a function that takes a component into the program's `main`.
///
/// ```text
/// #[scl::main]
/// async fn main(mut sensor: Sensor) -> scl::Result<()> {
///     sensor.measurements.send(&rover::Measurement { data: 7 }).await?;
///     Ok(())
/// }
/// ```
///
/// The component is opened before the function runs. `async fn` runs on a current-thread runtime, `fn` on the plain
/// main thread.
///
/// | the function | exit code |
/// |---|---|
/// | returns, and no messages are left after 1 s | 0 |
/// | returns, but messages are left | 1; the error names peers and counts |
/// | returns an error: `scl::Result`, `anyhow::Result`, `Result<(), Box<dyn Error>>` | 1; the error is printed with its causes |
/// | is stopped by SIGTERM or SIGINT | 0 |
/// | is still running `SCL_STOP_WITHIN` after the signal | 128 + the number of the signal |
/// | receives a second signal, half a second later or more | 128 + its number |
/// | panics | 101 |
///
/// Messages count as left if the peer is running or the connection has `when_full: wait`. For a peer that is not
/// running there is only a warning.
///
/// SIGTERM and SIGINT stop an async program at its next `.await`, which drops the function's future, and a program
/// without `async` at its next call to a gate, which fails. Messages that connected peers still receive are flushed. A
/// program that has something to do before it ends calls `scl::stop_requested()`, and then decides itself when to
/// return.
///
/// | environment | meaning |
/// |---|---|
/// | `SCL_LOG=debug` | log level: `off`, `error`, `warn` (default), `info`, `debug`, `trace` |
/// | `SCL_STOP_WITHIN=500ms` | how long the program may take to end after a signal, default `3s` |
/// | `SCL_SCHED=fifo:80` | real-time priority, 1 to 99 |
/// | `SCL_CPU=1` | the processor to run on; with this or `SCL_SCHED`, memory is locked |
/// | `SCL_RUNTIME_DIR`, `SCL_SYSTEM`, `SCL_TRANSPORT` | as for `OpenOptions` |
///
/// Without the privilege for real-time priority, the program logs a warning and continues.
#[proc_macro_attribute]
pub fn main(arguments: TokenStream, item: TokenStream) -> TokenStream {
    main_attribute::expand_main(arguments.into(), item.into(), editor::runs_macros()).into()
}

/// The source file that contains the path literal; `None` in some tools, for example rust-analyzer.
fn source_file(input: &TokenStream) -> Option<std::path::PathBuf> {
    let literal = input.clone().into_iter().find(|token| matches!(token, TokenTree::Literal(_)))?;
    literal.span().local_file()
}
