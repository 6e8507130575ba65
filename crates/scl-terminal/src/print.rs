//! Text for the user. Unlike `println!`, it does not panic when the reader has gone (`scl check | head`).

use std::io::{self, Write};

/// Writes to standard output; the text brings its own line ends.
pub fn print_out(text: &str) {
    // A reader that closes our output does not need an error.
    let _ = io::stdout().lock().write_all(text.as_bytes());
}

/// Writes to standard error; the text brings its own line ends.
pub fn print_err(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}
