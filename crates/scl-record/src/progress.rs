//! Progress of long work on a terminal; silent elsewhere.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::Duration;

/// How often a terminal is redrawn per second.
const REDRAWS: u8 = 10;

/// A bar or a line on standard error; invisible unless that is a terminal.
pub(crate) fn bar(length: Option<u64>, template: &str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(length, ProgressDrawTarget::stderr());
    // Cannot fail: the templates are constants.
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar
}

/// A bar on standard error that shows a position in a recording.
pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar for work on a recording of this length. Shows nothing unless standard error is a terminal.
    pub fn new(what: &'static str, length: Duration) -> Self {
        let target = ProgressDrawTarget::stderr_with_hz(REDRAWS);
        let bar = ProgressBar::with_draw_target(Some(milliseconds(length)), target).with_message(what);
        // Cannot fail: the template is a constant, and a test parses it.
        if let Ok(style) = ProgressStyle::with_template(TEMPLATE) {
            bar.set_style(style.with_key("at", |state: &indicatif::ProgressState, out: &mut dyn std::fmt::Write| {
                let seconds = |milliseconds: u64| milliseconds as f64 / 1e3;
                let (at, length) = (seconds(state.pos()), seconds(state.len().unwrap_or_default()));
                let _always_written = write!(out, "{at:.1} s of {length:.1} s");
            }));
        }
        Self { bar }
    }

    /// Moves the bar.
    pub fn set(&self, position: Duration) {
        let position = milliseconds(position);
        if position != self.bar.position() {
            self.bar.set_position(position);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

const TEMPLATE: &str = "{msg} {wide_bar} {at}";

fn milliseconds(time: Duration) -> u64 {
    u64::try_from(time.as_millis()).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_template_is_valid() {
        ProgressStyle::with_template(TEMPLATE).unwrap();
    }
}
