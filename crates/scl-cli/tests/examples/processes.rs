//! The processes of an example in real time: the system, its recorder, and what looks at it.

use crate::example;
use crate::system::{ChildGuard, SpawnGuarded, System};
use std::fs::DirBuilder;
use std::io::{BufRead, BufReader, Read};
use std::os::unix::fs::DirBuilderExt;
use std::process::{Command, Stdio};
use std::sync::mpsc::Sender;
use std::time::Duration;

/// A test that hears nothing for longer has failed. Compilers print little.
pub(crate) const BUILD_LIMIT: Duration = Duration::from_secs(3600);
pub(crate) const HANG_LIMIT: Duration = Duration::from_secs(300);

/// A folder for a system that does not run yet, but can be recorded: `scl record` wants the system's runtime folder.
pub(crate) fn folder_of(name: &str) -> System {
    let system = System::of_files(&[]);
    let runtime_folder = system.path(&format!("runtime/{name}"));
    DirBuilder::new().recursive(true).mode(0o700).create(runtime_folder).unwrap();
    system
}

/// `scl` in the folder of an example, whose topology and launch file a recording gets.
pub(crate) fn command(name: &str, system: &System, arguments: &[&str]) -> Command {
    let mut command = system.scl(arguments);
    command.current_dir(example(name));
    for name in ["SCL_SYSTEM", "SCL_TRANSPORT", "SCL_STATS", "SCL_LOG"] {
        command.env_remove(name);
    }
    command
}

/// Starts a recorder, and waits until it records the system of this name.
pub(crate) fn spawn_recorder(name: &str, command: &mut Command) -> ChildGuard {
    let mut recorder = command.stderr(Stdio::piped()).stdout(Stdio::piped()).spawn_guarded();
    let mut lines = BufReader::new(recorder.stderr.take().unwrap()).lines().map(Result::unwrap);
    let first = lines.next().unwrap();
    assert!(first.starts_with(&format!("recording `{name}`")), "{first}");
    // So that it can print the others.
    std::thread::spawn(move || lines.for_each(drop));
    recorder
}

/// Sends the lines of a stream as events.
pub(crate) fn send_lines<E: Send + 'static>(
    stream: impl Read + Send + 'static,
    sender: &Sender<E>,
    event: fn(String) -> E,
) {
    let sender = sender.clone();
    std::thread::spawn(move || {
        for line in BufReader::new(stream).lines().map_while(Result::ok) {
            // The test may have ended.
            let _ = sender.send(event(line));
        }
    });
}
