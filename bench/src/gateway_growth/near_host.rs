//! The near host: its components run in this process, and its gateway is measured.

use super::GatewayGrowthOptions;
use super::system::{ASKING, NEAR, REQUEST, hosts, plan, topology};
use crate::durations::Durations;
use crate::footprint::{processor_ms, resident_kib};
use crate::gateway::{runtime_dir, start_gateways};
use crate::report::{Column, Report, Row, Table};
use crate::runtime::start_runtime;
use crate::scratch::ScratchFolder;
use crate::worker::Worker;
use scl::bytes::Bytes;
use scl::plan::{GateKind, SystemPlan};
use scl::untyped::Component;
use scl::{Pub, Req};
use std::path::Path;
use std::time::{Duration, Instant};
use tokio::runtime::Runtime;
use tokio::time::sleep;

/// Long, because hundreds of connections are matched one after the other.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(120);

/// The size of every message.
const BYTES: usize = 100;

/// Messages per second of each connection that publishes, under load.
const RATE: u32 = 10;

const COLUMNS: [Column; 7] = [
    Column::plain("match_ms"),
    Column::plain("memory_kib"),
    Column::plain("far_memory_kib"),
    Column::plain("idle_cpu_percent"),
    Column::plain("loaded_cpu_percent"),
    Column::plain("p50_us"),
    Column::plain("p99_us"),
];

/// The components of the near host, with their gates.
struct NearHost {
    requests: Req<Bytes, Bytes>,
    publishers: Vec<Pub<Bytes>>,
    _components: Vec<Component>,
}

pub(super) fn measure(options: &GatewayGrowthOptions) -> scl::Result<Report> {
    let runtime = start_runtime()?;
    let mut table = Table::new(format!("a gateway with connections to {} other host(s)", options.hosts), &COLUMNS);
    for &connections in &options.connections {
        table.rows.push(measure_connections(&runtime, options, connections)?);
    }
    let mut report = Report::new("gateway-growth");
    report.tables.push(table);
    report.note("memory is the resident memory of the gateway, including the program's code");
    report.note(format!("under load, every connection carries {RATE} messages of {BYTES} bytes per second"));
    Ok(report)
}

fn measure_connections(runtime: &Runtime, options: &GatewayGrowthOptions, connections: usize) -> scl::Result<Row> {
    let scratch = ScratchFolder::new()?;
    let folder = Path::new(&scratch.path);
    let far_names: Vec<String> = (0..options.hosts.min(connections)).map(|far| format!("far{far}")).collect();
    let hosts = hosts(connections, &far_names);
    let gateways = start_gateways(folder, &topology(connections, options.hosts)?, &hosts)?;
    let [Some(gateway), Some(far_gateway)] = [0, 1].map(|index| gateways.get(index).map(Worker::id)) else {
        return Err(scl::Error::message("fewer than two gateways were started"));
    };
    let _far_hosts = start_far_hosts(runtime, folder, &far_names)?;
    let plan = plan(folder)?;
    runtime.block_on(async {
        let started = Instant::now();
        let mut near = NearHost::open(folder, &plan).await?;
        let matched = started.elapsed();
        let idle = near.processor_percent(gateway, options.seconds, 0).await?;
        let durations = near.exchange(options.messages).await?;
        let loaded = near.processor_percent(gateway, options.seconds, RATE).await?;
        let memory = [resident_kib(gateway)? as f64, resident_kib(far_gateway)? as f64];
        let values = vec![
            matched.as_secs_f64() * 1e3,
            memory[0],
            memory[1],
            idle,
            loaded,
            durations.quantile(0.5),
            durations.quantile(0.99),
        ];
        Ok(Row::new(format!("{connections} connection(s)"), values).with_durations(&durations))
    })
}

fn start_far_hosts(runtime: &Runtime, folder: &Path, names: &[String]) -> scl::Result<Vec<Worker>> {
    let mut workers = Vec::new();
    for name in names {
        let runtime_dir = runtime_dir(folder, name);
        let arguments = ["gateway-growth", &folder.to_string_lossy(), &runtime_dir.to_string_lossy(), name];
        let mut worker = Worker::start(&arguments)?;
        let _open = runtime.block_on(worker.next_line())?;
        workers.push(worker);
    }
    Ok(workers)
}

impl NearHost {
    /// Opens all components of the near host and waits until every peer is connected.
    async fn open(folder: &Path, system: &SystemPlan) -> scl::Result<Self> {
        let mut components = Vec::new();
        let mut publishers = Vec::new();
        for plan in system.components.iter().filter(|plan| plan.component.starts_with(NEAR)) {
            let options = scl::OpenOptions::new().runtime_dir(runtime_dir(folder, NEAR)).system(&system.system);
            let component = Component::open_with(plan, options).await?;
            components.push((component, plan));
        }
        for (component, _) in &components {
            component.ready(CONNECT_TIMEOUT).await?;
        }
        let mut requests = None;
        for (component, plan) in &mut components {
            for gate in plan.gates.iter().filter(|gate| gate.kind == GateKind::Pub) {
                publishers.push(component.publisher(&gate.name)?);
            }
            if plan.component == ASKING {
                requests = Some(component.requester(REQUEST)?);
            }
        }
        let requests = requests.ok_or_else(|| scl::Error::message(format!("there is no component `{ASKING}`")))?;
        let components = components.into_iter().map(|(component, _)| component).collect();
        Ok(Self { requests, publishers, _components: components })
    }

    /// Measures the processor time of a process, in percent of one core, while every publishing connection carries
    /// `rate` messages per second.
    async fn processor_percent(&mut self, process: u32, time: Duration, rate: u32) -> scl::Result<f64> {
        let (before, started) = (processor_ms(process)?, Instant::now());
        if rate == 0 {
            sleep(time).await;
        } else {
            let mut interval = scl::time::interval(Duration::from_secs(1) / rate)?;
            let message = Bytes::from(vec![7; BYTES]);
            while started.elapsed() < time {
                interval.tick().await?;
                for publisher in &mut self.publishers {
                    publisher.send(&message).await?;
                }
            }
        }
        Ok((processor_ms(process)? - before) / started.elapsed().as_secs_f64() / 10.0)
    }

    /// Makes requests, one after the other, and returns their durations.
    async fn exchange(&mut self, messages: usize) -> scl::Result<Durations> {
        let message = Bytes::from(vec![7; BYTES]);
        let mut durations = Durations::new()?;
        for _ in 0..messages {
            let started = Instant::now();
            self.requests.call(&message).await?;
            durations.record(started.elapsed().as_nanos().try_into().unwrap_or(u64::MAX));
        }
        Ok(durations)
    }
}
