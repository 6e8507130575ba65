//! Which components are played, and which run.

use super::ReplayOptions;
use crate::recording::type_and_codec;
use scl::runtime_dir::{AnnouncedEndpoint, Announcement, ComponentProcess, ComponentState, RuntimeDir, SystemDir};
use scl_observe::problem_of;
use scl_plan::{ConnectionPlan, GatePlan, Plan, SystemPlan};
use scl_terminal::{Problem, named_system, quoted_list};

/// The components that take part in a replay.
#[derive(Debug)]
pub(super) struct Participants {
    /// The name of the system in which the replay takes place.
    pub(super) system: String,
    pub(super) played: Vec<Plan>,
    pub(super) running: Vec<(String, ComponentProcess)>,
}

impl Participants {
    /// Chooses the components: the named ones, or all that are not running.
    ///
    /// # Errors
    /// A component is unknown or runs, all of them run, or a running one has another contract.
    pub(super) fn choose(plan: &SystemPlan, options: &ReplayOptions) -> Result<Self, Problem> {
        let variables = |name: &str| std::env::var_os(name);
        // Choose the name as the runtime does.
        let named = named_system(options.system.as_deref(), &variables)?;
        let system = named.unwrap_or_else(|| plan.system.clone());
        let dir = RuntimeDir::locate(&variables).and_then(|dir| dir.system(&system));
        let dir = dir.map_err(|error| problem_of(&error))?;
        let state = |plan: &Plan| match dir.state(&plan.component) {
            ComponentState::Running(holder) => Some((plan.component.clone(), holder)),
            _ => None,
        };
        let running: Vec<_> = plan.components.iter().filter_map(state).collect();
        let recorded = || {
            let names = plan.components.iter().map(|plan| plan.component.as_str());
            format!("the recording has {}", quoted_list(names))
        };
        let is_running = |name: &str| running.iter().find(|(running, _)| running == name);
        let played: Vec<Plan> = if options.components.is_empty() {
            plan.components.iter().filter(|plan| is_running(&plan.component).is_none()).cloned().collect()
        } else {
            let named = options.components.iter().map(|name| match is_running(name) {
                Some((_, holder)) => Err(Problem::new(format!("component `{name}` is already running as {holder}"))
                    .help("stop it first, or replay into another system with `--system`")),
                None => plan.component(name).cloned().map_err(|error| Problem::new(error.to_string()).note(recorded())),
            });
            named.collect::<Result<_, _>>()?
        };
        if played.is_empty() {
            return Err(Problem::new("nothing can be replayed: all recorded components are running")
                .help("stop the components to be replayed, or replay into another system with `--system`")
                .note(recorded()));
        }
        let cast = Self { system, played, running };
        for plan in &cast.played {
            for gate in &plan.gates {
                gate.connections.iter().try_for_each(|connection| check_contract(&dir, plan, gate, connection))?;
            }
        }
        Ok(cast)
    }

    /// Whether a component is played.
    pub(super) fn plays(&self, component: &str) -> bool {
        self.played.iter().any(|plan| plan.component == component)
    }

    /// Why a component is not played, for reports.
    pub(super) fn why_not(&self, component: &str) -> String {
        match self.running.iter().find(|(name, _)| name == component) {
            Some((name, holder)) => format!("`{name}` is running as {holder}"),
            None => format!("`{component}` is not played"),
        }
    }
}

/// Checks that the running peer of a connection announces the recorded contract. With different contracts, both ends
/// would wait for each other.
fn check_contract(dir: &SystemDir, plan: &Plan, gate: &GatePlan, connection: &ConnectionPlan) -> Result<(), Problem> {
    let ConnectionPlan { peer_component, peer_gate, contract, .. } = connection;
    if !matches!(dir.state(peer_component), ComponentState::Running(_)) {
        return Ok(());
    }
    let Some(announcement) = Announcement::read(dir, peer_component) else { return Ok(()) };
    let own = format!("{}.{}", plan.component, gate.name);
    let connects =
        |endpoint: &&AnnouncedEndpoint| !endpoint.tap && endpoint.gate == *peer_gate && endpoint.peers.contains(&own);
    let message = match announcement.endpoints.iter().find(connects) {
        Some(endpoint) if endpoint.contract == *contract => return Ok(()),
        Some(AnnouncedEndpoint { payload, codec, .. }) => format!(
            "`{own}` was recorded as {}, but the running `{peer_component}.{peer_gate}` was built for {}",
            type_and_codec(Some(&gate.payload.to_string()), &gate.codec),
            type_and_codec(Some(payload), codec),
        ),
        None => {
            format!("`{own}` was connected to `{peer_component}.{peer_gate}`, which the running program does not have")
        }
    };
    Err(Problem::new(message).help("run the program that was recorded, or make a new recording").note(format!(
        "process {} runs `{peer_component}`: {}",
        announcement.pid,
        announcement.program.display()
    )))
}
