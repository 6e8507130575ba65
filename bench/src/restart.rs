//! The time until messages flow again after one side of a connection was killed and started again.

mod restarted;
mod side;
mod survivor;

pub(crate) use restarted::run_restarted;

use crate::clock::now;
use crate::durations::Durations;
use crate::report::{Column, Report, Row, Table};
use crate::runtime::start_runtime;
use crate::scratch::ScratchFolder;
use crate::variant::Variant;
use crate::worker::Worker;
use std::pin::pin;
use std::time::Duration;
use survivor::Survivor;
use tokio::time::timeout;

/// How long to wait for the first message; if none arrives, this time is recorded.
const TIMEOUT: Duration = Duration::from_secs(10);

/// How often a side sends.
const PERIOD: Duration = Duration::from_millis(1);

const COLUMNS: [Column; 2] = [Column::compared("p50_ms"), Column::compared("max_ms")];

const UNIX: &str = "Unix socket, connecting side";

/// The restarted sides.
const VARIANTS: &[Variant] = &[
    Variant { id: "scl-publisher", name: "SCL pub", baselines: &[UNIX] },
    Variant { id: "scl-subscriber", name: "SCL sub", baselines: &[UNIX] },
    Variant { id: "scl-pusher", name: "SCL push", baselines: &[UNIX] },
    Variant { id: "scl-puller", name: "SCL pull", baselines: &[UNIX] },
    Variant { id: "scl-requester", name: "SCL req", baselines: &[UNIX] },
    Variant { id: "scl-replier", name: "SCL rep", baselines: &[UNIX] },
    #[cfg(feature = "libzmq")]
    Variant { id: "libzmq-publisher", name: "libzmq PUB", baselines: &[] },
    #[cfg(feature = "libzmq")]
    Variant { id: "libzmq-subscriber", name: "libzmq SUB", baselines: &[] },
    // A surviving SUB socket of `zeromq` takes many seconds to reconnect, so restarting its PUB is not measured.
    Variant { id: "zeromq-subscriber", name: "zeromq SUB", baselines: &[] },
    Variant { id: "unix", name: UNIX, baselines: &[] },
];

/// The surviving side of a variant, and the measured durations.
struct Measurement {
    variant: &'static Variant,
    survivor: Survivor,
    durations: Durations,
}

/// Kills and restarts every side, and measures the time from its start to the first message that one side receives from
/// the other.
pub(crate) fn measure_restart(restarts: usize) -> scl::Result<Report> {
    let folder = ScratchFolder::new()?;
    let durations = start_runtime()?.block_on(run(&folder.path, restarts.max(1)))?;
    let mut report = Report::new("restart");
    report.tables.push(table(restarts, &durations));
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
        // Keep one future across the downtime: a call that starts together with the other side would always connect in
        // lockstep with it.
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

/// How long the survivor runs alone before the other side is restarted. It differs between runs, so that restarts do
/// not always fall at the same point between two connection attempts.
fn downtime(run: u32) -> Duration {
    Duration::from_millis(50 + u64::from(run) * 7 % 20)
}

fn table(restarts: usize, durations: &[Durations]) -> Table {
    let title = format!("time until messages flow after one side was killed and restarted ({restarts} restarts)");
    let mut table = Table::new(title, &COLUMNS);
    for (variant, durations) in VARIANTS.iter().zip(durations) {
        let values = vec![durations.quantile(0.5) / 1e3, durations.max() / 1e3];
        table.rows.push(Row::new(variant.name, values).with_baselines(variant.baselines).with_durations(durations));
    }
    table
}
