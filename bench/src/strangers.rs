//! What others on the machine cost a component over TCP: users that connect and are refused, and a peer that was killed.

use crate::footprint::processor_ms;
use crate::report::{Column, Report, Row, Table};
use crate::restart::components::Requester;
use crate::runtime::start_runtime;
use crate::scratch::ScratchFolder;
use crate::worker::{Worker, unknown_arguments};
use scl::TransportKind;
use scl::bytes::Bytes;
use scl::time::interval;
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};

/// The user whose connections are refused: `nobody`.
const STRANGER: u32 = 65534;
/// A replier that is not there by then never will be.
const READY: Duration = Duration::from_secs(60);
/// How often each line is measured, in turn with the others.
const ROUNDS: u32 = 5;

/// Options of [`measure_strangers`].
#[derive(Debug, Clone)]
pub struct StrangersOptions {
    /// Refused connections per second, one line each.
    pub connections: Vec<usize>,
    /// How long each line is measured.
    pub time: Duration,
}

impl StrangersOptions {
    /// The numbers of connections per second that can be asked for.
    pub const CONNECTIONS: std::ops::RangeInclusive<usize> = 1..=100_000;
}

/// Measures calls over TCP while another user connects to the replier again and again, and what a process costs whose peer
/// was killed.
///
/// # Errors
///
/// The folder for temporary files cannot be used, a process cannot be started, or `/proc` cannot be read. Only root can
/// start a process of another user.
pub fn measure_strangers(options: &StrangersOptions) -> scl::Result<Report> {
    if !rustix::process::geteuid().is_root() {
        return Err(scl::Error::message("only root can start the process of another user: run this with `sudo`"));
    }
    let folder = ScratchFolder::new()?;
    let mut report = Report::new("strangers");
    start_runtime()?.block_on(async {
        report.add(measure_calls(&folder, options).await?);
        report.add(measure_dead_peer(&folder, options).await?);
        Ok::<(), scl::Error>(())
    })?;
    report.note_rounds();
    Ok(report)
}

async fn measure_calls(folder: &ScratchFolder, options: &StrangersOptions) -> scl::Result<Table> {
    const QUIET: &str = "no other user";
    let _replier = start_replier(folder, "tcp")?;
    let mut requester = open(folder, TransportKind::Tcp).await?;
    requester.ready(READY).await?;
    let address = address(folder)?;
    let mut rates: Vec<(usize, Vec<f64>)> =
        std::iter::once(0).chain(options.connections.iter().copied()).map(|rate| (rate, Vec::new())).collect();
    for _ in 0..ROUNDS {
        for (rate, calls_per_s) in &mut rates {
            let _stranger = if *rate > 0 { Some(start_stranger(address, *rate)?) } else { None };
            let (started, mut calls) = (Instant::now(), 0.0);
            while started.elapsed() < options.time / ROUNDS {
                requester.stream.call(&Bytes::new()).await?;
                calls += 1.0;
            }
            calls_per_s.push(calls / started.elapsed().as_secs_f64());
        }
    }
    let mut table =
        Table::new("calls over TCP while another user connects and is refused", &[Column::compared("calls_per_s")]);
    for (rate, rounds) in rates {
        let mean = rounds.iter().sum::<f64>() / f64::from(ROUNDS);
        let (name, baselines): (_, &[&str]) =
            if rate == 0 { (QUIET.to_owned(), &[]) } else { (format!("{rate} connections/s refused"), &[QUIET]) };
        table.add(Row::new(name, vec![mean]).with_baselines(baselines).with_rounds(&rounds));
    }
    Ok(table)
}

async fn measure_dead_peer(folder: &ScratchFolder, options: &StrangersOptions) -> scl::Result<Table> {
    let mut table = Table::new("a process whose peer was killed", &[Column::plain("processor_percent")]);
    for (name, kind) in [("tcp", TransportKind::Tcp), ("ipc", TransportKind::Ipc)] {
        let replier = start_replier(folder, name)?;
        let requester = open(folder, kind).await?;
        requester.ready(READY).await?;
        // Dropping it kills it.
        drop(replier);
        let (before, started) = (processor_ms(std::process::id())?, Instant::now());
        tokio::time::sleep(options.time).await;
        let busy = processor_ms(std::process::id())? - before;
        table.add(Row::new(name, vec![busy / started.elapsed().as_secs_f64() / 10.0]));
    }
    Ok(table)
}

const SYSTEM: &str = "scl-replier";

async fn open(folder: &ScratchFolder, kind: TransportKind) -> scl::Result<Requester> {
    let options = scl::OpenOptions::new().runtime_dir(folder.path()).system(SYSTEM).transport_kind(kind);
    Ok(Requester::open_with(options).await?)
}

/// Starts a process that replies, the one that `scl bench restart` restarts.
fn start_replier(folder: &ScratchFolder, transport: &str) -> scl::Result<Worker> {
    let launcher = ["env", &format!("SCL_TRANSPORT={transport}")];
    Worker::start_with(&launcher, &["restart", SYSTEM, folder.path(), "1"])
}

/// Where the replier listens.
fn address(folder: &ScratchFolder) -> scl::Result<SocketAddr> {
    for entry in std::fs::read_dir(format!("{}/{SYSTEM}", folder.path()))? {
        let name = entry?.file_name().into_string().unwrap_or_default();
        if name.starts_with("replier.stream.") && name.ends_with(".tcp") && !name.contains(".tap.") {
            return Ok(std::fs::read_to_string(format!("{}/{SYSTEM}/{name}", folder.path()))?.trim().parse()?);
        }
    }
    Err(scl::Error::message("the replier has no address"))
}

fn start_stranger(address: SocketAddr, rate: usize) -> scl::Result<Worker> {
    let user = format!("--reuid={STRANGER}");
    let launcher = ["setpriv", &user, "--regid=65534", "--clear-groups"];
    Worker::start_with(&launcher, &["strangers", &address.to_string(), &rate.to_string()])
}

/// Connects to an address again and again. The arguments are the address and the number of connections per second.
pub(crate) fn run_stranger(arguments: &[&str]) -> scl::Result<()> {
    let [address, rate] = arguments else { return Err(unknown_arguments(arguments)) };
    let (address, rate): (SocketAddr, u32) = (address.parse()?, rate.parse()?);
    let period = Duration::from_millis(1);
    start_runtime()?.block_on(async {
        let (mut interval, mut due) = (interval(period)?, 0.0);
        loop {
            interval.tick().await?;
            due += f64::from(rate) * period.as_secs_f64();
            while due >= 1.0 {
                // Fails if the component has too many to accept.
                let _refused = TcpStream::connect(address);
                due -= 1.0;
            }
        }
    })
}
