//! Ends of connections without a gate, for the rules about them.

use crate::diagnostic::Diagnostic;
use crate::source::Span;

/// Maximum number of places that one problem shows.
pub(super) const MOST_PLACES: usize = 9;

/// An end of a connection: the number of the connection, and 0 or 1.
pub(super) type End = [usize; 2];

/// What is wrong with an end.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Fault<'m> {
    /// Not `component.gate`.
    Shape,
    Swapped(&'m str, &'m str),
    Component(&'m str),
    Gate(&'m str, &'m str),
}

/// Adds the other places of a mistake, and their number.
pub(super) fn with_places(found: Diagnostic, places: &[Span]) -> Diagnostic {
    let others = places.iter().take(MOST_PLACES).skip(1);
    let found = found.labels(others.map(|place| (*place, "and here")));
    match places.len() {
        0 | 1 => found,
        count => found.note(format!("{count} connections name it")),
    }
}
