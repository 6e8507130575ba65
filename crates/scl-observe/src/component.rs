//! A component of a system: whether it runs, what it announces, and its figures.

use scl::runtime_dir::{Announcement, ComponentState, ComponentStats, SystemDir};
use scl_plan::{GatePlan, ParameterPlan, Plan};
use serde_json::{Map, Value, json};
use std::time::{Duration, SystemTime};

/// How many periods a running component may miss before its figures count as old: a busy machine delays a write now and
/// then.
const MISSED_PERIODS: u32 = 4;

/// The shortest age at which figures count as old.
const SHORTEST_SILENCE: Duration = Duration::from_secs(2);

/// A component of a system.
#[derive(Debug, Clone)]
pub struct Component {
    /// Its name.
    pub name: String,
    /// Whether it runs.
    pub state: ComponentState,
    /// What it announced when it started, if it runs or was killed.
    pub announcement: Option<Announcement>,
    /// Its latest figures; `None` if it writes none (`SCL_STATS=off`).
    pub stats: Option<ComponentStats>,
    /// When it wrote them, by the clock of this machine.
    pub last_write: Option<SystemTime>,
    /// The values of its parameters, by name and as texts like in the topology file.
    pub values: Vec<(String, String)>,
}

impl Component {
    pub(crate) fn read(dir: &SystemDir, name: &str) -> Self {
        let state = dir.state(name);
        let announcement = Announcement::read(dir, name);
        let (stats, last_write) = (ComponentStats::read(dir, name), ComponentStats::last_write(dir, name));
        let mut component = Self { name: name.to_owned(), state, announcement, stats, last_write, values: Vec::new() };
        if component.plan().is_some_and(|plan| !plan.parameters.is_empty()) {
            component.values = scl::parameters::values(dir, name).unwrap_or_default();
        }
        component
    }

    /// A component known only from its peers' plans.
    pub(crate) fn stopped(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            state: ComponentState::Stopped,
            announcement: None,
            stats: None,
            last_write: None,
            values: Vec::new(),
        }
    }

    /// Whether a process runs it.
    pub fn is_running(&self) -> bool {
        matches!(self.state, ComponentState::Running(_))
    }

    /// Its plan, if it runs or was killed.
    pub fn plan(&self) -> Option<&Plan> {
        self.announcement.as_ref()?.plan.as_ref()
    }

    /// Its parameters, each with its value, in the order of the topology file. Those of a component of another host, or
    /// that a tool plays, have no values here.
    pub fn parameters(&self) -> impl Iterator<Item = (&ParameterPlan, Option<&str>)> {
        let value = |name: &str| self.values.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str());
        self.plan().into_iter().flat_map(|plan| &plan.parameters).map(move |plan| (plan, value(&plan.name)))
    }

    /// The values of its parameters as JSON, by name.
    pub fn parameters_to_json(&self) -> Value {
        self.parameters().map(|(plan, value)| (plan.name.to_string(), json!(value))).collect::<Map<_, _>>().into()
    }

    /// Its gates, in the order of the topology file.
    pub fn gates(&self) -> &[GatePlan] {
        self.plan().map_or(&[], |plan| &plan.gates)
    }

    /// Returns the transports on which a gate listens, `ipc`, `tcp` or `shm`, each with the peers that it serves. Empty
    /// for a gate that only connects.
    pub fn transports(&self, gate: &str) -> Vec<(&str, Vec<&str>)> {
        let endpoints = self.announcement.iter().flat_map(|announcement| &announcement.endpoints);
        let mut transports: Vec<(&str, Vec<&str>)> = Vec::new();
        for end in endpoints.filter(|end| end.gate == gate && !end.tap && !end.transport.is_empty()) {
            let peers = end.peers.iter().map(String::as_str);
            match transports.iter_mut().find(|(transport, _)| *transport == end.transport) {
                Some((_, known)) => known.extend(peers),
                None => transports.push((&end.transport, peers.collect())),
            }
        }
        transports
    }

    /// Returns for how long a running component has not written its figures, if that is long enough to conclude that it
    /// hangs: its runtime does not run, or the process is stopped.
    pub fn silent_for(&self, now: SystemTime) -> Option<Duration> {
        let stats = self.stats.as_ref().filter(|_| self.is_running())?;
        let age = now.duration_since(self.last_write?).ok()?;
        (age > SHORTEST_SILENCE.max(stats.period * MISSED_PERIODS)).then_some(age)
    }

    /// Returns what the component is doing now.
    pub fn activity(&self, now: SystemTime) -> Activity {
        match self.state {
            ComponentState::Stopped => Activity::Stopped,
            ComponentState::Dead => Activity::Dead,
            ComponentState::Running(_) => match (self.silent_for(now), &self.stats) {
                (Some(silence), _) => Activity::Hangs(silence),
                (None, None) => Activity::Running,
                (None, Some(stats)) if stats.ready => Activity::Ready,
                (None, Some(_)) => Activity::Waiting,
            },
        }
    }
}

/// What a component is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Activity {
    /// It runs. Whether all required peers are connected is unknown, because it writes no figures.
    Running,
    /// It runs, and all required peers are connected.
    Ready,
    /// It runs, and waits for peers.
    Waiting,
    /// It runs, and has not written its figures for this long.
    Hangs(Duration),
    /// It was killed or has crashed.
    Dead,
    /// It does not run.
    Stopped,
}

impl Activity {
    /// One word: `waiting`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Ready => "ready",
            Self::Waiting => "waiting",
            Self::Hangs(_) => "hangs",
            Self::Dead => "dead",
            Self::Stopped => "stopped",
        }
    }
}
