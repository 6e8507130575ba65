//! Monitors a component for tools: its figures, and whether its required peers are connected.

use crate::environment::{self, Variables};
use crate::error::OpenError;
use crate::figures::FigureSource;
use crate::registration::StatsWriter;
use crate::runtime_dir::ComponentStats;
use crate::spec::{ComponentSpec, ConnectionSpec};
use crate::sync::{AbortOnDrop, lock};
use std::sync::{Arc, Mutex, Weak};
use std::time::{Duration, SystemTime};
use tokio::runtime::Handle;

/// How often a component writes its figures if `SCL_STATS` is not set.
const PERIOD: Duration = Duration::from_millis(500);
const SHORTEST_PERIOD: Duration = Duration::from_millis(10);

/// The figures of a component's gates. Its gates do not depend on it, nor does it keep them open.
pub(crate) struct Monitor {
    spec: &'static ComponentSpec,
    followed: Mutex<Followed>,
}

struct Followed {
    /// By the index of the gate; `None` until it is opened.
    sources: Vec<Option<FigureSource>>,
    /// Whether the gate is open.
    open: Vec<bool>,
    stats: ComponentStats,
}

impl Monitor {
    /// Follows the gate at an index of the component's list.
    pub(crate) fn follow(&self, index: usize, source: FigureSource) {
        let mut followed = lock(&self.followed);
        followed.sources[index] = Some(source);
        followed.open[index] = true;
    }

    /// Updates the figures and passes them to `then`. Allocates nothing.
    pub(crate) fn refresh(&self, then: impl FnOnce(&ComponentStats)) {
        let mut followed = lock(&self.followed);
        let Followed { sources, open, stats } = &mut *followed;
        for ((source, open), figures) in sources.iter().zip(open).zip(&mut stats.gates) {
            *open = *open && source.as_ref().is_some_and(|source| source(figures));
            if !*open {
                figures.close();
            }
        }
        stats.written = SystemTime::now();
        followed.stats.ready = followed.all_opened() && followed.missing(self.spec).next().is_none();
        then(&followed.stats);
    }

    /// Returns the required peers that are not connected, or `None` while the gates are being opened.
    pub(crate) fn missing(&self) -> Option<Vec<String>> {
        self.refresh(|_| {});
        let followed = lock(&self.followed);
        let names = || {
            followed
                .missing(self.spec)
                .map(|connection| format!("{}.{}", connection.peer_component, connection.peer_gate))
        };
        followed.all_opened().then(|| names().collect())
    }
}

impl Followed {
    fn all_opened(&self) -> bool {
        self.sources.iter().all(Option::is_some)
    }

    /// Returns the required peers that are not connected. Gates that listen for any number of peers have none, and
    /// dropped gates wait for no peer.
    fn missing(&self, spec: &'static ComponentSpec) -> impl Iterator<Item = &'static ConnectionSpec> {
        let gates = spec.gates.iter().zip(&self.open).zip(&self.stats.gates);
        let waiting = gates.filter(|((gate, open), _)| gate.endpoint.is_empty() && **open);
        waiting.flat_map(|((gate, _), figures)| {
            let connections = gate.connections.iter().zip(&figures.connections);
            connections
                .filter(|(connection, found)| connection.required && !found.connected)
                .map(|(connection, _)| connection)
        })
    }
}

/// Creates the monitor of a component, and the task that writes its stats, if it writes any.
pub(super) fn start(
    spec: &'static ComponentSpec,
    stats: Option<(ComponentStats, StatsWriter)>,
    handle: &Handle,
) -> (Arc<Monitor>, Option<AbortOnDrop>) {
    let unwritten = || ComponentStats::initial(spec, std::process::id(), SystemTime::now(), Duration::ZERO);
    let (initial, writer) = stats.unzip();
    let (sources, open) = (spec.gates.iter().map(|_| None).collect(), vec![false; spec.gates.len()]);
    let followed = Followed { sources, open, stats: initial.unwrap_or_else(unwritten) };
    let monitor = Arc::new(Monitor { spec, followed: Mutex::new(followed) });
    let task = writer.map(|writer| AbortOnDrop::spawn(handle, write_stats(Arc::downgrade(&monitor), writer)));
    (monitor, task)
}

/// Writes the figures periodically, as long as the component is open. Runs as a task on the component's runtime: where
/// the program drives that only now and then, the component's own thread drives it while no call does.
async fn write_stats(monitor: Weak<Monitor>, writer: StatsWriter) {
    loop {
        let mut period = PERIOD;
        match monitor.upgrade() {
            Some(monitor) => monitor.refresh(|stats| {
                writer.write(stats);
                period = stats.period;
            }),
            None => return,
        }
        tokio::time::sleep(period).await;
    }
}

/// Reads `SCL_STATS`; `None` for `off`.
///
/// # Errors
/// [`OpenError::Environment`] if the value is neither `off` nor a period of 10 ms to a day.
pub(crate) fn stats_period(variables: Variables<'_>) -> Result<Option<Duration>, OpenError> {
    let parse = |text: &str| match text {
        "off" => Some(None),
        text => environment::duration(text).filter(|period| *period >= SHORTEST_PERIOD).map(Some),
    };
    let found =
        environment::read(variables, "SCL_STATS", "`off` or a period of at least `10ms`, such as `500ms`", parse)?;
    Ok(found.unwrap_or(Some(PERIOD)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::refused;

    #[test]
    fn the_period_is_read_or_refused() {
        let millis = |millis| Ok(Some(Duration::from_millis(millis)));
        let refuses =
            |value: &str| Err(format!("SCL_STATS={value}, not `off` or a period of at least `10ms`, such as `500ms`"));
        let cases = [("", millis(500)), ("off", Ok(None)), ("10ms", millis(10)), ("2s", millis(2000))];
        let bad = ["on", "OFF", "9ms", "0s", "500", "-1s", "86401s", "off "].map(|value| (value, refuses(value)));
        for (value, expected) in cases.into_iter().chain(bad) {
            let variables = |name: &str| (name == "SCL_STATS").then(|| value.into());
            assert_eq!(refused(stats_period(&variables)), expected, "{value}");
        }
    }
}
