//! Errors of other crates as problems.

use crate::Problem;
use std::error::Error;

/// An error with its causes.
pub fn problem_of(error: &dyn Error) -> Problem {
    let (message, help) = message_and_help(error);
    help.into_iter().fold(Problem::new(message), Problem::help)
}

/// What is wrong, with all causes, and what to do, which is in the second line of the error's text or of a cause's.
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
