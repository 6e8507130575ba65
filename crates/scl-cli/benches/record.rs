//! Measures the cost of `scl record`: its processor time for ten gates at 1 kHz, and the delay of the gates with and
//! without it.
//!
//! `cargo bench -p scl-cli --bench record`. Two processes, a source and a sink, are connected by ten gates; a recorder
//! runs in every second phase.
#![expect(clippy::disallowed_methods, reason = "what is left of a failed benchmark is seen")]

use scl::plan::SystemPlan;
use scl::untyped::Component;
use std::error::Error;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

const GATES: usize = 10;
const PERIOD: Duration = Duration::from_millis(1);
const PAYLOAD: usize = 64;
const PHASE: Duration = Duration::from_secs(5);
const PAIRS: usize = 6;
const SCL: &str = env!("CARGO_BIN_EXE_scl");

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn main() -> Result<()> {
    match std::env::args().nth(1).as_deref() {
        Some("source") => source(),
        Some("sink") => sink(),
        _ => measure(),
    }
}

fn measure() -> Result<()> {
    let folder = tempfile::tempdir()?;
    std::fs::write(folder.path().join("topology.yaml"), topology())?;
    let plan = scl(folder.path(), &["plan"]).output()?;
    std::fs::write(folder.path().join("plan.json"), plan.stdout)?;
    let mut sink = Role::start(folder.path(), "sink")?;
    let source = Role::start(folder.path(), "source")?;

    println!("{GATES} gates at 1 kHz, {PAYLOAD} bytes, {PAIRS} pairs of phases of {PHASE:?}; medians over the phases");
    let [mut without, mut with] = [Phases::default(), Phases::default()];
    let (mut share, mut bytes, mut lost) = (Vec::new(), Vec::new(), 0);
    for _ in 0..PAIRS {
        without.add(&mut sink, &source)?;
        let recorder = Recorder::start(folder.path())?;
        let before = processor_time(recorder.process.id())?;
        with.add(&mut sink, &source)?;
        share.push((processor_time(recorder.process.id())? - before).as_secs_f64() / PHASE.as_secs_f64());
        let (recorded, lost_now, size) = recorder.stop()?;
        bytes.push(size as f64 / recorded as f64);
        lost += lost_now;
    }
    for (name, phases) in [("without recorder", &mut without), ("with recorder", &mut with)] {
        let [p50, p99, source] = phases.medians();
        println!("{name:16}  delay p50 {p50:6.1} us, p99 {p99:6.1} us; processor of the source {source:4.1} %");
    }
    println!(
        "recorder          processor {:.1} %, {:.1} bytes a message, {lost} lost",
        100.0 * median(&mut share),
        median(&mut bytes)
    );
    Ok(())
}

/// Measurements from all phases of one kind: with the recorder, or without it.
#[derive(Default)]
struct Phases {
    p50: Vec<f64>,
    p99: Vec<f64>,
    source: Vec<f64>,
}

impl Phases {
    fn add(&mut self, sink: &mut Role, source: &Role) -> Result<()> {
        sink.ask("begin")?;
        let before = processor_time(source.process.id())?;
        thread::sleep(PHASE);
        let used = processor_time(source.process.id())? - before;
        let answer = sink.ask("end")?;
        let mut figures = answer.split_whitespace().map(str::parse::<f64>);
        self.p50.push(figures.next().ok_or("no figures")??);
        self.p99.push(figures.next().ok_or("no figures")??);
        self.source.push(100.0 * used.as_secs_f64() / PHASE.as_secs_f64());
        Ok(())
    }

    fn medians(&mut self) -> [f64; 3] {
        [median(&mut self.p50), median(&mut self.p99), median(&mut self.source)]
    }
}

/// A component that runs in a separate process.
struct Role {
    process: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
}

impl Role {
    fn start(folder: &Path, role: &str) -> Result<Self> {
        let mut command = Command::new(std::env::current_exe()?);
        command.arg(role).current_dir(folder).env("SCL_RUNTIME_DIR", folder.join("run"));
        let mut process = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()?;
        let input = process.stdin.take().ok_or("no input")?;
        let output = BufReader::new(process.stdout.take().ok_or("no output")?);
        Ok(Self { process, input, output })
    }

    fn ask(&mut self, question: &str) -> Result<String> {
        writeln!(self.input, "{question}")?;
        let mut answer = String::new();
        self.output.read_line(&mut answer)?;
        Ok(answer)
    }
}

impl Drop for Role {
    fn drop(&mut self) {
        // The process may have exited already.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

struct Recorder {
    process: Child,
    file: PathBuf,
}

impl Recorder {
    fn start(folder: &Path) -> Result<Self> {
        let mut command = scl(folder, &["record", "-o", "cost.mcap", "--overwrite", "--format", "json"]);
        let mut process = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
        let log = BufReader::new(process.stderr.take().ok_or("no log")?);
        log.lines().find(|line| line.as_ref().is_ok_and(|line| line.contains("connected"))).ok_or("no recorder")??;
        Ok(Self { process, file: folder.join("cost.mcap") })
    }

    /// Stops the recorder. Returns the numbers of messages recorded and lost, and the size of the file in bytes.
    fn stop(self) -> Result<(u64, u64, u64)> {
        Command::new("kill").args(["-INT", &self.process.id().to_string()]).status()?;
        let report: serde_json::Value = serde_json::from_slice(&self.process.wait_with_output()?.stdout)?;
        let gates = report["gates"].as_array().ok_or("no gates")?;
        let sum = |key: &str| gates.iter().filter_map(|gate| gate[key].as_u64()).sum();
        Ok((sum("recorded"), sum("lost"), std::fs::metadata(self.file)?.len()))
    }
}

/// Sends the time at all gates every millisecond.
fn source() -> Result<()> {
    let mut component = open("source")?;
    let mut gates = (0..GATES)
        .map(|number| component.publisher(&format!("g{number}")))
        .collect::<std::result::Result<Vec<_>, _>>()?;
    component.ready_blocking(Duration::from_secs(60))?;
    let started = Instant::now();
    for tick in 1.. {
        for gate in &mut gates {
            let mut payload = vec![0; PAYLOAD];
            payload[..8].copy_from_slice(&now_ns().to_le_bytes());
            gate.send_blocking(&payload.into())?;
        }
        thread::sleep((started + PERIOD * tick).saturating_duration_since(Instant::now()));
    }
    Ok(())
}

/// Receives from all gates. Prints the median and the 99th percentile of the delays between the commands `begin` and
/// `end`.
fn sink() -> Result<()> {
    let delays = Arc::new(Mutex::new(Vec::new()));
    let mut component = open("sink")?;
    for number in 0..GATES {
        let (mut gate, delays) = (component.subscriber(&format!("g{number}"))?, Arc::clone(&delays));
        thread::spawn(move || {
            while let Ok(message) = gate.recv_blocking() {
                let sent = message.first_chunk().map_or(0, |bytes| u64::from_le_bytes(*bytes));
                let delay = now_ns().saturating_sub(sent) as f64 / 1e3;
                delays.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(delay);
            }
        });
    }
    component.ready_blocking(Duration::from_secs(60))?;
    for command in std::io::stdin().lines() {
        let mut delays = std::mem::take(&mut *delays.lock().unwrap_or_else(|poisoned| poisoned.into_inner()));
        match command?.as_str() {
            "begin" => println!("begun"),
            _ => {
                delays.sort_by(f64::total_cmp);
                let at = |share: f64| delays[((delays.len() - 1) as f64 * share) as usize];
                println!("{} {}", at(0.5), at(0.99));
            }
        }
    }
    Ok(())
}

fn open(component: &str) -> Result<Component> {
    let plan = SystemPlan::from_json(&std::fs::read_to_string("plan.json")?)?;
    Ok(Component::open_blocking(plan.component(component)?)?)
}

fn topology() -> String {
    let lines = |line: &dyn Fn(usize) -> String| (0..GATES).map(line).collect::<String>();
    format!(
        "system: cost\ncomponents:\n  - name: source\n    gates:\n{}  - name: sink\n    gates:\n{}connections:\n{}",
        lines(&|number| format!("      - g{number}: pub\n")),
        lines(&|number| format!("      - g{number}: {{sub: , queue: 1000}}\n")),
        lines(&|number| format!("  - [source.g{number}, sink.g{number}]\n")),
    )
}

fn scl(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(SCL);
    command.args(arguments).current_dir(folder).env("SCL_RUNTIME_DIR", folder.join("run")).env_remove("SCL_SYSTEM");
    command
}

/// User and system time of all threads of a process.
fn processor_time(process: u32) -> Result<Duration> {
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat"))?;
    let (_, fields) = stat.rsplit_once(')').ok_or("no name")?;
    let ticks = |index: usize| fields.split_whitespace().nth(index).and_then(|field| field.parse::<u64>().ok());
    let (user, system) = (ticks(11).ok_or("no time")?, ticks(12).ok_or("no time")?);
    // In clock ticks. Linux has 100 per second (`USER_HZ`) on every architecture that Rust supports, except Alpha.
    Ok(Duration::from_millis(10 * (user + system)))
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn now_ns() -> u64 {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    u64::try_from(now.as_nanos()).unwrap_or(u64::MAX)
}
