//! The other processes of a scenario: this program again, started with a hidden word.

use crate::cores::with_others;
use crate::{delay, fanout, one_way, open, roundtrip};
use rustix::process::{Pid, Signal, WaitId, WaitIdOptions, kill_process, waitid};
use std::io::{BufRead, BufReader, ErrorKind, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use tokio::runtime::{Builder, Runtime};
use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};

/// The first argument with which a program starts itself as another process of a scenario.
pub const OTHER_SIDE: &str = "bench-other-side";

/// Plays the part that the arguments after [`OTHER_SIDE`] name, until its input ends.
///
/// # Errors
///
/// No such part, or what it could not do.
pub fn play_other_side(arguments: &[String]) -> scl::Result<()> {
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let (part, rest): (Part, _) = match words.as_slice() {
        ["roundtrip", rest @ ..] => (roundtrip::play_wall, rest),
        ["one-way", rest @ ..] => (one_way::play_receiver, rest),
        ["delay", rest @ ..] => (delay::play_source, rest),
        ["fanout", rest @ ..] => (fanout::play_sink, rest),
        ["open", rest @ ..] => (open::play, rest),
        _ => return Err(wrong_words(&words)),
    };
    end_with_input();
    part(rest).or_else(|error| if says_peer_ended(&error) { Ok(()) } else { Err(error) })
}

/// Plays a part with the words that follow its name.
type Part = fn(&[&str]) -> scl::Result<()>;

/// A peer that ends while it is being listened to has all it wanted, or says itself what it lacked.
fn says_peer_ended(error: &scl::Error) -> bool {
    let kind = error.inner().downcast_ref().map(std::io::Error::kind);
    matches!(kind, Some(ErrorKind::UnexpectedEof | ErrorKind::BrokenPipe | ErrorKind::ConnectionReset))
}

/// The words of a process are not for people, so this is said only when somebody tries them.
pub(crate) fn wrong_words(words: &[&str]) -> scl::Error {
    scl::Error::message(format!("`{OTHER_SIDE} {}` is not for use by hand: run `scl bench`", words.join(" ")))
}

/// The single thread that everything of a process runs on.
pub(crate) fn start_runtime() -> scl::Result<Runtime> {
    Ok(Builder::new_current_thread().enable_all().build()?)
}

/// A folder that goes away with the scenario, as text, and the folder for raw sockets in it.
pub(crate) fn scratch_folder() -> scl::Result<tempfile::TempDir> {
    let folder = tempfile::Builder::new().prefix("scl-bench").tempdir()?;
    std::fs::create_dir(folder.path().join("raw"))?;
    Ok(folder)
}

pub(crate) fn as_text(folder: &Path) -> scl::Result<&str> {
    let refused = || scl::Error::message(format!("the folder `{}` has a name that is not UTF-8", folder.display()));
    folder.to_str().ok_or_else(refused)
}

/// Tells the starting process something.
pub(crate) fn say(line: &str) -> scl::Result<()> {
    let mut output = std::io::stdout().lock();
    writeln!(output, "{line}")?;
    Ok(output.flush()?)
}

/// Ends this process when the one that started it is gone.
fn end_with_input() {
    std::thread::spawn(|| {
        for line in std::io::stdin().lines() {
            if line.is_err() {
                break;
            }
        }
        std::process::exit(0);
    });
}

/// A process that plays a part; ended when dropped.
pub(crate) struct OtherProcess {
    child: Child,
    _input: Option<ChildStdin>,
    lines: UnboundedReceiver<String>,
}

impl OtherProcess {
    /// Starts this program as another part.
    pub(crate) fn start(words: &[&str]) -> scl::Result<Self> {
        Self::start_through(&[], words)
    }

    /// The same, by way of a program that starts another one (`chrt -f 80`).
    pub(crate) fn start_through(starter: &[&str], words: &[&str]) -> scl::Result<Self> {
        let program = std::env::current_exe()?;
        let mut command = match starter {
            [first, rest @ ..] => {
                let mut command = Command::new(first);
                command.args(rest).arg(program);
                command
            }
            [] => Command::new(program),
        };
        command.arg(OTHER_SIDE).args(words).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = with_others(|| command.spawn())??;
        let (sender, lines) = unbounded_channel();
        if let Some(output) = child.stdout.take() {
            std::thread::spawn(move || {
                // The scenario may have ended before its other process.
                BufReader::new(output).lines().map_while(Result::ok).all(|line| sender.send(line).is_ok())
            });
        }
        Ok(Self { _input: child.stdin.take(), child, lines })
    }

    pub(crate) fn id(&self) -> u32 {
        self.child.id()
    }

    /// Makes it stand still where it is; it does when this returns.
    pub(crate) fn stop(&self) -> scl::Result<()> {
        let process = Pid::from_child(&self.child);
        kill_process(process, Signal::STOP)?;
        // If it has ended instead, that is left for others to see.
        waitid(WaitId::Pid(process), WaitIdOptions::STOPPED | WaitIdOptions::EXITED | WaitIdOptions::NOWAIT)?;
        Ok(())
    }

    /// Lets it go on after [`stop`](Self::stop).
    pub(crate) fn go_on(&self) -> scl::Result<()> {
        Ok(kill_process(Pid::from_child(&self.child), Signal::CONT)?)
    }

    /// Whether it has said something that nobody has heard yet.
    pub(crate) fn has_said_more(&self) -> bool {
        !self.lines.is_empty()
    }

    /// The next thing that it says; the runtime goes on meanwhile.
    pub(crate) async fn line(&mut self) -> scl::Result<String> {
        let ended = || scl::Error::message("the other process of the measurement ended early; its own words are above");
        self.lines.recv().await.ok_or_else(ended)
    }
}

impl Drop for OtherProcess {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ended = self.child.kill();
        let _status = self.child.wait();
    }
}
