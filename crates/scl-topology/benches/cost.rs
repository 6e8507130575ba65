//! Measures the cost of hostile files: reading, checking and printing every problem, as `scl check` does.
//!
//! `cargo bench -p scl-topology --bench cost` prints:
//!
//! ```text
//! input   KiB   problems   check ms   text ms   text KiB
//! ```

#[path = "../tests/hostile/mod.rs"]
mod hostile;

use scl_topology::check::{Facts, check};
use scl_topology::diagnostic::{Diagnostics, render};
use scl_topology::parse::parse;
use scl_topology::source::Sources;
use std::time::Instant;

/// The default size limit of a file.
const MEBIBYTE: usize = 1 << 20;

fn main() {
    println!("{:<42} {:>6} {:>9} {:>9} {:>9} {:>9}", "input", "KiB", "problems", "check ms", "text ms", "text KiB");
    let large = hostile::filled(MEBIBYTE).into_iter().map(|(name, text)| (format!("1 MiB: {name}"), text));
    let fixed = hostile::fixed().into_iter().map(|(name, text)| (name.to_owned(), text));
    for (name, text) in fixed.chain(large) {
        let kib = text.len() / 1024;
        let start = Instant::now();
        let mut sources = Sources::new();
        let file = sources.add("topology.yaml", text);
        let mut problems = Diagnostics::new();
        let model = parse(&sources, file, &mut problems);
        let facts = Facts { default_system: "cost".to_owned(), ..Facts::default() };
        check(&model, &facts, &sources, &mut problems);
        let found = problems.into_sorted();
        let checked = start.elapsed().as_secs_f64() * 1e3;
        let start = Instant::now();
        let bytes: usize = found.iter().map(|problem| render(problem, &sources).len()).sum();
        let printed = start.elapsed().as_secs_f64() * 1e3;
        println!("{name:<42} {kib:>6} {:>9} {checked:>9.0} {printed:>9.0} {:>9}", found.len(), bytes / 1024);
    }
}
