//! Measures the cost of hostile files: reading, checking, trying the advice and printing
//! the first problems, as `scl check` does.
//!
//! `cargo bench -p scl-topology --bench cost` prints the following of all files, or, with a word at its end, of those
//! with this word in their names:
//!
//! ```text
//! input   KiB   problems   check ms   try ms   text ms   text KiB
//! ```

#[path = "../tests/hostile/mod.rs"]
mod hostile;

use scl_topology::advice::{Extent, Judged, try_advice};
use scl_topology::check::{Facts, check};
use scl_topology::diagnostic::{Diagnostics, MOST_LISTED, limit, render};
use scl_topology::parse::parse;
use scl_topology::source::{FileId, Sources};
use std::time::Instant;

/// The default size limit of a file.
const MEBIBYTE: usize = 1 << 20;

fn main() {
    println!(
        "{:<42} {:>6} {:>9} {:>9} {:>9} {:>9} {:>9}",
        "input", "KiB", "problems", "check ms", "try ms", "text ms", "text KiB"
    );
    let large = hostile::filled(MEBIBYTE).into_iter().map(|(name, text)| (format!("1 MiB: {name}"), text));
    let fixed = hostile::fixed().into_iter().map(|(name, text)| (name.to_owned(), text));
    let word = std::env::args().skip(1).find(|argument| argument != "--bench").unwrap_or_default();
    for (name, text) in fixed.chain(large).filter(|(name, _)| name.contains(&word)) {
        let kib = text.len() / 1024;
        let mut sources = Sources::new();
        let file = sources.add("topology.yaml", text);
        let start = Instant::now();
        let mut found = judge(&sources, file);
        let checked = milliseconds(start);
        let start = Instant::now();
        try_advice(&mut found, sources.file(file), |copy| judge(&sources.with_text(file, copy), file));
        let tried = milliseconds(start);
        let problems = found.problems.len();
        let start = Instant::now();
        let shown = limit(found.problems, MOST_LISTED, "topology.yaml");
        let bytes: usize = shown.iter().map(|problem| render(problem, &sources).len()).sum();
        let printed = milliseconds(start);
        let text = bytes / 1024;
        println!("{name:<42} {kib:>6} {problems:>9} {checked:>9.0} {tried:>9.0} {printed:>9.0} {text:>9}");
    }
}

fn judge(sources: &Sources, file: FileId) -> Judged {
    let mut problems = Diagnostics::new();
    let model = parse(sources, file, &mut problems);
    let facts = Facts { default_system: "cost".to_owned(), ..Facts::default() };
    check(&model, &facts, sources, &mut problems);
    Judged { problems: problems.into_sorted(), extent: Extent::of(&model) }
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}
