//! The time until messages flow again after one side of a connection was killed and started again.

mod restarted;
mod survivor;

pub(crate) use restarted::run_restarted;

use crate::clock::now;
use crate::durations::Durations;
use crate::report::{Column, Report, Row, Table};
use crate::runtime::start_runtime;
use crate::scratch::ScratchFolder;
use crate::worker::Worker;
use std::pin::pin;
use std::time::Duration;
use survivor::Survivor;
use tokio::time::timeout;

/// If no message has arrived until then, this time is recorded.
const TIMEOUT: Duration = Duration::from_secs(10);

/// How often a side sends.
const PERIOD: Duration = Duration::from_millis(1);

const COLUMNS: [Column; 2] = [Column::compared("p50_ms"), Column::compared("max_ms")];

/// The restarted side: its name between the processes, and in the report.
struct Variant {
    id: &'static str,
    name: &'static str,
}

const UNIX: &str = "Unix socket, connecting side";

const VARIANTS: &[Variant] = &[
    Variant { id: "scl-publisher", name: "SCL pub" },
    Variant { id: "scl-subscriber", name: "SCL sub" },
    Variant { id: "scl-pusher", name: "SCL push" },
    Variant { id: "scl-puller", name: "SCL pull" },
    Variant { id: "scl-requester", name: "SCL req" },
    Variant { id: "scl-replier", name: "SCL rep" },
    #[cfg(feature = "libzmq")]
    Variant { id: "libzmq-publisher", name: "libzmq PUB" },
    #[cfg(feature = "libzmq")]
    Variant { id: "libzmq-subscriber", name: "libzmq SUB" },
    // A surviving SUB socket of `zeromq` reconnects only after many seconds, so that restarting its PUB is left out.
    Variant { id: "zeromq-subscriber", name: "zeromq SUB" },
    Variant { id: "unix", name: UNIX },
];

/// Options of [`measure_restart`].
#[derive(Debug, Clone)]
pub struct RestartOptions {
    /// How often each side is restarted.
    pub restarts: usize,
}

/// The surviving side of a variant, and what was measured.
struct Measurement {
    variant: &'static Variant,
    survivor: Survivor,
    durations: Durations,
}

/// Kills and restarts every side, and measures the time from its start to the first message that one side receives from
/// the other.
///
/// # Errors
///
/// The folder for temporary files cannot be used, a process cannot be started, or a socket cannot be opened.
pub fn measure_restart(options: &RestartOptions) -> scl::Result<Report> {
    let folder = ScratchFolder::new()?;
    let durations = start_runtime()?.block_on(run(folder.path(), options.restarts.max(1)))?;
    let mut report = Report::new("restart");
    report.add(table(options, &durations));
    report.note("measured from the start of the new process to the first message between both sides");
    Ok(report)
}

async fn run(folder: &str, restarts: usize) -> scl::Result<Vec<Durations>> {
    let mut measurements = Vec::new();
    for variant in VARIANTS {
        let survivor = Survivor::open(variant.id, folder).await?;
        measurements.push(Measurement { variant, survivor, durations: Durations::new()? });
    }
    // Run 0 is the first connection, not a restart.
    for run in 0..=u32::try_from(restarts)? {
        for measurement in &mut measurements {
            measurement.restart(folder, run).await?;
        }
    }
    Ok(measurements.into_iter().map(|measurement| measurement.durations).collect())
}

impl Measurement {
    /// Starts the restarted side, waits until messages flow, and kills it.
    async fn restart(&mut self, folder: &str, run: u32) -> scl::Result<()> {
        // One future throughout: a call that starts together with the other side would connect in step with it.
        let mut exchange = pin!(self.survivor.exchange(run));
        if let Ok(ended) = timeout(downtime(run), &mut exchange).await {
            ended?;
        }
        let started = now();
        let mut restarted = Worker::start(&["restart", self.variant.id, folder, &run.to_string()])?;
        let flow = async {
            tokio::select! {
                received = exchange => received,
                line = restarted.next_line() => Ok(line?.parse()?),
            }
        };
        let duration = match timeout(TIMEOUT, flow).await {
            Ok(received) => received?.saturating_sub(started),
            Err(_elapsed) => TIMEOUT.as_nanos().try_into()?,
        };
        if run > 0 {
            self.durations.record(duration);
        }
        Ok(())
    }
}

/// How long the survivor goes on alone before the other side starts again: different times, so that the start does not
/// fall into the same part of an interval between two attempts to connect.
fn downtime(run: u32) -> Duration {
    Duration::from_millis(50 + u64::from(run) * 7 % 20)
}

fn table(options: &RestartOptions, durations: &[Durations]) -> Table {
    let title =
        format!("time until messages flow after one side was killed and restarted ({} restarts)", options.restarts);
    let mut table = Table::new(title, &COLUMNS);
    for (variant, durations) in VARIANTS.iter().zip(durations) {
        let values = vec![durations.quantile(0.5) / 1e3, durations.max() / 1e3];
        let baselines: &[&str] = if variant.id.starts_with("scl-") { &[UNIX] } else { &[] };
        table.add(Row::new(variant.name, values).with_baselines(baselines).with_durations(durations));
    }
    table
}
