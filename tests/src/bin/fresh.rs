//! Plays a component of `fresh.yaml`: `fresh clock async|blocking` or `fresh viewer CALL async|blocking`.
//!
//! After each message the clock writes its number into the file `$NEWEST`. So the viewer knows, before it makes a call,
//! which message had been sent by then, whatever the machine does meanwhile. It prints that number and the number of
//! the last message that it has received, in this call or before. The clock also writes how often it did not run for a
//! while, so that the test knows.

use scl_tests::{Commands, say};
use std::fs::File;
use std::os::unix::fs::FileExt;
use std::time::{Duration, Instant};
use test::Number;
use tokio::runtime::Builder;

scl::topology!("topologies/fresh.yaml");

const PERIOD: Duration = Duration::from_millis(1);
const PADDING: usize = 50;
/// Half as long as a call waits for a publisher that is silent.
const LONG_GAP: Duration = Duration::from_millis(50);

fn main() -> scl::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["clock", "async"] => Builder::new_current_thread().enable_all().build()?.block_on(tick()),
        ["clock", _] => tick_blocking(),
        ["viewer", call, "async"] => Builder::new_current_thread().enable_all().build()?.block_on(view(call)),
        ["viewer", call, _] => view_blocking(call),
        _ => Err(scl::Error::message("usage: fresh clock|viewer ...")),
    }
}

async fn tick() -> scl::Result<()> {
    let mut newest = Newest::create()?;
    let mut clock = Clock::open().await?;
    let mut interval = scl::time::interval(PERIOD)?;
    for value in 1.. {
        interval.tick().await?;
        clock.ticks.send(&number(value)).await?;
        newest.write(value)?;
    }
    Ok(())
}

fn tick_blocking() -> scl::Result<()> {
    let mut newest = Newest::create()?;
    let mut clock = Clock::open_blocking()?;
    let started = Instant::now();
    for value in 1..u32::MAX {
        std::thread::sleep((PERIOD * value).saturating_sub(started.elapsed()));
        clock.ticks.send_blocking(&number(value.into()))?;
        newest.write(value.into())?;
    }
    Ok(())
}

async fn view(call: &str) -> scl::Result<()> {
    let newest = Newest::open()?;
    let mut viewer = Viewer::open().await?;
    let mut last = viewer.newest.recv().await?.value;
    say("receiving");
    let mut commands = Commands::listen();
    while let Some(words) = commands.next().await {
        pause(&words);
        let sent = newest.read()?;
        let received = match call {
            "recv" => Some(viewer.newest.recv().await?),
            "latest" => viewer.newest.latest()?,
            _ => viewer.newest.try_recv()?,
        };
        last = received.map_or(last, |received| received.value);
        say(format!("{sent} {last}"));
    }
    Ok(())
}

fn view_blocking(call: &str) -> scl::Result<()> {
    let newest = Newest::open()?;
    let mut viewer = Viewer::open_blocking()?;
    let mut last = viewer.newest.recv_blocking()?.value;
    say("receiving");
    let mut commands = Commands::listen();
    while let Some(words) = commands.next_blocking() {
        pause(&words);
        let sent = newest.read()?;
        let received = match call {
            "recv" => Some(viewer.newest.recv_blocking()?),
            "recv_timeout" => Some(viewer.newest.recv_timeout(Duration::from_secs(300))?),
            "latest" => viewer.newest.latest()?,
            _ => viewer.newest.try_recv()?,
        };
        last = received.map_or(last, |received| received.value);
        say(format!("{sent} {last}"));
    }
    Ok(())
}

/// Blocks the thread for a while, like a program that computes or waits for a disk.
fn pause(words: &[String]) {
    let milliseconds = words[0].parse().unwrap_or_default();
    std::thread::sleep(Duration::from_millis(milliseconds));
}

/// The number of the newest message for which `send` has returned, and the number of long gaps between messages.
struct Newest {
    file: File,
    written: Instant,
    long_gaps: u64,
}

impl Newest {
    fn create() -> std::io::Result<Self> {
        File::create(path()).map(Self::of)
    }

    fn open() -> std::io::Result<Self> {
        File::open(path()).map(Self::of)
    }

    fn of(file: File) -> Self {
        Self { file, written: Instant::now(), long_gaps: 0 }
    }

    fn write(&mut self, value: u64) -> std::io::Result<()> {
        let now = Instant::now();
        self.long_gaps += u64::from(now - std::mem::replace(&mut self.written, now) > LONG_GAP);
        let bytes = [value, self.long_gaps].map(u64::to_le_bytes);
        self.file.write_all_at(bytes.as_flattened(), 0)
    }

    fn read(&self) -> std::io::Result<u64> {
        let mut bytes = [0; 8];
        self.file.read_exact_at(&mut bytes, 0)?;
        Ok(u64::from_le_bytes(bytes))
    }
}

fn path() -> String {
    std::env::var("NEWEST").unwrap_or_default()
}

fn number(value: u64) -> Number {
    Number { value, padding: vec![7; PADDING] }
}
