//! Measures how long parsing and checking take, by the size of the file. Expected: linear, and under a second for
//! 10,000 components with 5 gates and 5 connections each.
//!
//! `cargo bench -p scl-topology` prints, for sound files and for files in which every connection is misspelt:
//!
//! ```text
//! components   KiB   parse ms   check ms   us/component
//! ```

use scl_topology::check::{Facts, check};
use scl_topology::diagnostic::Diagnostics;
use scl_topology::parse::parse;
use scl_topology::source::Sources;
use std::fmt::Write;
use std::time::{Duration, Instant};

const SIZES: [usize; 4] = [10, 100, 1_000, 10_000];
const RUNS: usize = 5;

/// The gates of each component.
const GATES: [&str; 5] = [
    "position: {pub: nav.Position}",
    "velocity: {pub: nav.Velocity, backpressure: true}",
    "position_in: {sub: nav.Position, queue: 1}",
    "velocity_in: {sub: nav.Velocity, when_full: wait}",
    "log: {push: log.Entry, codec: json, unconnected: ok}",
];

fn main() {
    for (title, misspelt) in [("sound files", false), ("every connection misspelt", true)] {
        println!(
            "{title}\n{:>10} {:>8} {:>10} {:>10} {:>13}",
            "components", "KiB", "parse ms", "check ms", "us/component"
        );
        for size in SIZES {
            let text = topology(size, misspelt);
            let best = (0..RUNS).map(|_| measure(&text, misspelt)).min_by_key(|(parse, check)| *parse + *check);
            let Some((parse, check)) = best else { continue };
            let each = (parse + check).as_secs_f64() * 1e6 / size as f64;
            let [parse, check] = [parse, check].map(|time| time.as_secs_f64() * 1e3);
            println!("{size:>10} {:>8} {parse:>10.2} {check:>10.2} {each:>13.1}", text.len() / 1024);
        }
    }
}

/// The time that parsing and checking take.
fn measure(text: &str, misspelt: bool) -> (Duration, Duration) {
    let mut sources = Sources::new();
    let file = sources.add("topology.yaml", text);
    let mut problems = Diagnostics::new();
    let start = Instant::now();
    let model = parse(&sources, file, &mut problems);
    let parsed = start.elapsed();
    let topology =
        check(&model, &Facts { default_system: "bench".to_owned(), ..Facts::default() }, &sources, &mut problems);
    let checked = start.elapsed() - parsed;
    assert_eq!(topology.is_none(), misspelt, "the file is not what it should be");
    let found = problems.into_sorted();
    assert_eq!(found.iter().any(|problem| problem.code() == "SCL0501"), misspelt);
    (parsed, checked)
}

/// Generates a ring of components with 5 gates and 5 connections each, in which each sends to the next three. The
/// waiting gates form a chain, as a ring of them would be a deadlock.
fn topology(size: usize, misspelt: bool) -> String {
    let mut text = "system: bench\ncomponents:\n".to_owned();
    for at in 0..size {
        let _ = write!(text, "  - name: component_{at}\n    doc: Number {at}.\n    gates:\n");
        for gate in GATES {
            let _ = writeln!(text, "      - {gate}");
        }
    }
    text.push_str("connections:\n");
    let peer = if misspelt { "komponent" } else { "component" };
    for at in 0..size {
        for (gate, step) in [("position", 1), ("position", 2), ("position", 3), ("velocity", 1), ("velocity", 2)] {
            if gate != "velocity" || at + step < size {
                let _ = writeln!(text, "  - [component_{at}.{gate}, {peer}_{}.{gate}_in]", (at + step) % size);
            }
        }
    }
    text
}
