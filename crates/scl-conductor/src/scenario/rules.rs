//! The keys of a scenario.

/// The keys at the top.
pub(super) const TOP: [&str; 5] = ["until", "delays", "takes", "faults", "expect"];
/// The keys that say when a fault happens; each fault has one.
pub(super) const WHEN: [&str; 2] = ["at", "every"];
/// The keys that say what happens; each fault has one.
pub(super) const WHAT: [&str; 3] = ["kill", "pause", "cut"];
/// The keys of faults.
pub(super) const FAULT: [&str; 8] = ["at", "every", "kill", "pause", "cut", "for", "from", "except"];
/// The keys that say what is expected; each expectation has one.
pub(super) const EXPECTED: [&str; 3] = ["always", "eventually", "exit"];
/// The keys of expectations.
pub(super) const EXPECTATION: [&str; 6] = ["always", "eventually", "exit", "where", "by", "code"];

/// All of them.
pub(super) fn keys() -> impl Iterator<Item = &'static str> {
    TOP.into_iter().chain(FAULT).chain(EXPECTATION)
}
