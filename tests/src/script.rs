//! The other side of [`Process`](crate::Process): commands come line by line, each is answered with a line.

use std::io::Write;
use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};

/// The commands that a test gives to this program.
pub struct Commands(UnboundedReceiver<String>);

impl Commands {
    /// Reads this program's input from now on.
    pub fn listen() -> Self {
        let (sender, receiver) = unbounded_channel();
        std::thread::spawn(move || {
            for line in std::io::stdin().lines().map_while(Result::ok) {
                let _program_ends = sender.send(line);
            }
        });
        Self(receiver)
    }

    /// The next command as words; `None` when the test is over.
    pub async fn next(&mut self) -> Option<Vec<String>> {
        self.0.recv().await.map(|line| line.split_whitespace().map(str::to_owned).collect())
    }
}

/// Answers the test.
pub fn say(line: impl std::fmt::Display) {
    println!("{line}");
    // The test may have ended.
    let _nobody_reads = std::io::stdout().flush();
}

/// Stops this program until the test lets it go on, as if nobody got around to it for a long time.
pub fn stand_still() {
    if rustix::process::kill_process(rustix::process::getpid(), rustix::process::Signal::STOP).is_err() {
        say("cannot stop");
    }
}
