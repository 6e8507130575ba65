//! Measures how long the process `scl generate` takes, for comparison with the code generator of the paper: 2 s, or 0.1
//! s with its cache, on a 500 MHz ARMv7.
//!
//! `cargo bench -p scl-cli --bench generate` prints a line per output: the time into a fresh folder, and the time when
//! everything is up to date already. The system is about as large as the largest ones of the paper's authors: 26
//! components with 78 gates and 39 connections, and messages from a schema. `-- FILE` measures another topology.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const RUNS: usize = 50;
const COMPONENTS: usize = 26;
const MESSAGES: usize = 20;

fn main() -> std::io::Result<()> {
    let folder = tempfile::tempdir()?;
    let named = std::env::args().skip(1).find(|argument| !argument.starts_with('-')).map(PathBuf::from);
    let file = match named {
        Some(file) => file,
        None => write_system(folder.path())?,
    };
    println!(
        "{}: medians of {RUNS} processes\n{:>8} {:>12} {:>16}",
        file.display(),
        "for",
        "written ms",
        "up to date ms"
    );
    for target in ["zmq", "c", "cpp", "python"] {
        let fresh = median(|run| generate(&file, target, &folder.path().join(format!("{target}-{run}"))))?;
        let again = median(|_| generate(&file, target, &folder.path().join(format!("{target}-0"))))?;
        println!("{target:>8} {:>12.1} {:>16.1}", milliseconds(fresh), milliseconds(again));
    }
    let check = median(|_| time(scl().arg("check").arg(&file)))?;
    println!("{:>8} {:>12} {:>16.1}   (scl check, for comparison)", "-", "-", milliseconds(check));
    Ok(())
}

fn median(mut run: impl FnMut(usize) -> std::io::Result<Duration>) -> std::io::Result<Duration> {
    let mut times = (0..RUNS).map(&mut run).collect::<std::io::Result<Vec<_>>>()?;
    times.sort();
    Ok(times[RUNS / 2])
}

fn generate(file: &Path, target: &str, folder: &Path) -> std::io::Result<Duration> {
    time(scl().args(["generate", "--for", target, "-o"]).arg(folder).arg(file))
}

fn scl() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_scl"));
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

fn time(command: &mut Command) -> std::io::Result<Duration> {
    let start = Instant::now();
    let status = command.status()?;
    assert!(status.success(), "{command:?} fails; `scl check` says why");
    Ok(start.elapsed())
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

/// Writes a topology with a schema, and returns the topology's path. Each component publishes to the next, and every
/// second one also sends requests to the next.
fn write_system(folder: &Path) -> std::io::Result<PathBuf> {
    let mut schema = "syntax = \"proto3\";\npackage bench;\n".to_owned();
    for message in 0..MESSAGES {
        let fields = (1..=8).map(|field| format!("  double value_{field} = {field};\n"));
        let _ = write!(schema, "message Message{message} {{\n{}  string name = 9;\n}}\n", fields.collect::<String>());
    }
    let mut text = "system: bench\nschemas: [bench.proto]\ncomponents:\n".to_owned();
    let mut connections = String::new();
    for at in 0..COMPONENTS {
        let (next, own, other) = ((at + 1) % COMPONENTS, at % MESSAGES, (at + COMPONENTS - 1) % COMPONENTS % MESSAGES);
        let _ = write!(text, "  - name: component_{at}\n    doc: Number {at}.\n    gates:\n");
        let _ = writeln!(text, "      - values: {{pub: bench.Message{own}}}");
        let _ = writeln!(text, "      - values_in: {{sub: bench.Message{other}, queue: 1}}");
        let _ = writeln!(connections, "  - [component_{at}.values, component_{next}.values_in]");
        if at % 2 == 0 {
            let _ = writeln!(text, "      - ask: {{req: bench.Message{own} -> bench.Message{other}}}");
            let _ = writeln!(connections, "  - [component_{at}.ask, component_{next}.answer]");
        } else {
            text.push_str("      - answer: rep\n");
        }
    }
    text.push_str("connections:\n");
    text.push_str(&connections);
    std::fs::write(folder.join("bench.proto"), schema)?;
    let file = folder.join("bench.yaml");
    std::fs::write(&file, text)?;
    Ok(file)
}
