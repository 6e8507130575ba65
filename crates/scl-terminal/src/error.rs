//! Errors of other crates as problems.

use crate::Problem;
use std::error::Error;

/// Converts an error and its causes into a problem.
pub fn problem_of(error: &dyn Error) -> Problem {
    let (message, help) = message_and_help(error);
    help.into_iter().fold(Problem::new(message), Problem::help)
}

/// Returns the messages of an error and all its causes, joined by colons, and the help: the first text that follows a
/// line break and `help: ` in one of these messages.
pub fn message_and_help(error: &dyn Error) -> (String, Option<String>) {
    let (mut messages, mut help) = (Vec::new(), None);
    let mut next = Some(error);
    while let Some(error) = next {
        let text = error.to_string();
        match text.split_once("\nhelp: ") {
            Some((message, way_out)) => {
                messages.push(message.to_owned());
                help.get_or_insert(way_out.to_owned());
            }
            None => messages.push(text),
        }
        next = error.source();
    }
    (messages.join(": "), help)
}
