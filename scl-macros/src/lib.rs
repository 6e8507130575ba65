//! The macros of SCL. Use them through the crate `scl`, which also brings what the generated code needs.
//!
//! This crate holds no rule: what is wrong with a topology, `scl-topology` finds and words; here it only becomes compile
//! errors, and a topology without errors becomes structs.
#![cfg_attr(feature = "nightly", feature(proc_macro_expand, proc_macro_span))]
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod arguments;
mod expand;
mod locate;
mod main_attribute;
#[cfg(test)]
mod tests;

use proc_macro::{TokenStream, TokenTree};

/// What `scl::topology!` calls, with `$crate` as its first token.
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
/// The component is opened before the function runs. `async fn` runs on a current-thread runtime, `fn` on the plain main
/// thread. An error that the function returns is printed with its causes, and the program ends with exit code 1. SIGTERM
/// and SIGINT end an async program at its next `.await`, another one by an error of its next blocking call; both count as
/// a clean end, exit code 0, and what connected peers still take is handed over.
///
/// | environment | meaning |
/// |---|---|
/// | `SCL_LOG=debug` | how much is logged to standard error, unless the program has a log of its own: `error`, `warn` (default), `info`, `debug`, `trace` |
/// | `SCL_SCHED=fifo:80` | real-time priority, 1 to 99 |
/// | `SCL_CPU=1` | the one processor to run on; with either, memory is locked |
/// | `SCL_RUNTIME_DIR`, `SCL_SYSTEM`, `SCL_TRANSPORT` | as for `OpenOptions` |
///
/// Without the right to real-time priority the program warns and goes on.
#[proc_macro_attribute]
pub fn main(arguments: TokenStream, item: TokenStream) -> TokenStream {
    main_attribute::expand_main(arguments.into(), item.into()).into()
}

/// The source file with the path literal; unknown to some tools, rust-analyzer among them.
fn source_file(input: &TokenStream) -> Option<std::path::PathBuf> {
    let literal = input.clone().into_iter().find(|token| matches!(token, TokenTree::Literal(_)))?;
    literal.span().local_file()
}
