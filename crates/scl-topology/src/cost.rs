//! Checks that hostile files cost no more than their size allows, by counting steps, labels and printed bytes.
//! `cargo bench -p scl-topology --bench cost` measures the times.

#[path = "../tests/hostile/mod.rs"]
mod hostile;

use crate::advice::tries;
use crate::check::testing::problems;
use crate::diagnostic::{Diagnostic, MOST_LABELS, render};
use crate::source::Sources;
use crate::work::steps_of;

/// Size of the files. Whatever is quadratic exceeds the bounds by far.
const SIZE: usize = 1 << 17;

/// Maximum steps per byte of a file, to find its problems and for the excerpts of [`PRINTED`] of them.
const MOST_STEPS: usize = 80;

/// Problems printed of each file, from its start and from its end.
const PRINTED: usize = 200;

/// Maximum length of one printed problem, in bytes.
const LONGEST: usize = 8_000;

#[test]
fn no_file_makes_much_work() {
    for (name, text) in hostile::filled(SIZE).into_iter().chain(hostile::fixed()) {
        let size = text.len();
        let steps = steps_of(|| check(name, &text));
        println!("{name}: {size} bytes, {steps} steps");
        let checks = 1 + tries(text.len());
        assert!(steps <= MOST_STEPS * size * checks, "{name}: {steps} steps for {checks} checks of {size} bytes");
    }
}

fn check(name: &str, text: &str) {
    let (found, sources) = problems(text, None);
    for problem in &found {
        assert!(problem.secondary.len() <= MOST_LABELS, "{name}: {} labels", problem.secondary.len());
    }
    let (first, rest) = found.split_at(found.len().min(PRINTED));
    let last = &rest[rest.len().saturating_sub(PRINTED)..];
    first.iter().chain(last).for_each(|problem| print(name, problem, &sources));
}

fn print(name: &str, problem: &Diagnostic, sources: &Sources) {
    let text = render(problem, sources);
    assert!(text.len() <= LONGEST, "{name}: {} bytes for {}", text.len(), problem.code());
}
